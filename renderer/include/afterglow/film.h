/* film.h: the picture in memory: its pixels and channels, the tiles of one that is under way, and taking noise out.
 * Part of afterglow.h, which tells about threads and errors. */
#ifndef AFTERGLOW_PUBLIC_FILM_H
#define AFTERGLOW_PUBLIC_FILM_H

#include "afterglow/context.h"
#include "afterglow/layers.h"

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ag_film ag_film;

AG_API void ag_film_destroy(ag_film *film); /* NULL is fine */

/* The pixels rendered (the crop), linear RGB of the working space, top row first, 3 floats a pixel. The film's. */
AG_API const float *ag_film_pixels(const ag_film *film, int *out_width, int *out_height);
/* Of the working space: red, green, blue, white, each x and y, as EXR files have them. */
AG_API void ag_film_chromaticities(const ag_film *film, float out_chromaticities[8]);

/* The channels of picture and layers, by the names that they have in a file; R, G and B are the first three. */
AG_API int ag_film_channel_count(const ag_film *film);
AG_API const char *ag_film_channel_name(const ag_film *film, int channel); /* the film's; NULL: there is none */
/* Width * height values, top row first. Errors: AG_ERROR_ARGUMENT. */
AG_API ag_status ag_film_read_channel(const ag_film *film, int channel, float *out_values);

/* The name of the object or material whose id a channel of AG_LAYER_CRYPTO_OBJECT or AG_LAYER_CRYPTO_MATERIAL holds;
 * longer ones are cut at size - 1 bytes. False: there is none of that id, or the film has no such layer. Any thread may
 * ask. */
AG_API bool ag_film_matte_name(const ag_film *film, ag_layer layer, float id, char *out_name, size_t size);

/* A picture can be watched while it is rendered: from ag_rendering_film on, and for as long as the film is there, any
 * thread may call the three functions below at any time, callbacks too. They copy the developed picture, R, G and B as
 * ag_film_pixels has them, tile by tile: each tile as it was when it was finished last, in this pass over the picture
 * or the one before. In the beginning it is black. None of them waits for longer than a tile takes to be copied, but
 * while the film is denoised. */
#define AG_TILE_SIZE 32
/* A part of the picture: AG_TILE_SIZE pixels wide and high, or less at its right and lower edges. */
typedef struct ag_tile {
    int x, y; /* of its upper left pixel, from the upper left of the pixels rendered */
    int width, height;
    uint64_t version; /* higher with each change of any tile; 0: never shown, and black */
} ag_tile;
/* Tiles are numbered row by row from the upper left. */
AG_API size_t ag_film_tile_count(const ag_film *film);
/* Copies the tile of that number if it has changed since a version, else gives false and writes nothing. out_pixels:
 * room for 3 * AG_TILE_SIZE * AG_TILE_SIZE floats; width * height pixels are written, rows without gaps. */
AG_API bool ag_film_read_tile(const ag_film *film, size_t tile, uint64_t since_version, ag_tile *out_tile,
                              float *out_pixels);
/* Brings a copy of the whole picture up to date: writes the tiles that have changed since a version, 0 for all that
 * have been shown, and gives the version that the copy then has. out_pixels: as large as ag_film_pixels, the
 * caller's. */
AG_API uint64_t ag_film_read_picture(const ag_film *film, uint64_t since_version, float *out_pixels);

/* Takes the noise out of R, G and B with Open Image Denoise, which is looked for when this is called; with albedo and
 * normals where the settings said denoise. The other channels stay, so the parts of light no longer add up. Errors:
 * AG_ERROR_SYSTEM (no such library), AG_ERROR_MEMORY. */
AG_API ag_status ag_film_denoise(ag_context *context, ag_film *film);
/* Whether the library is there. To be asked before a long render. Errors: AG_ERROR_SYSTEM. */
AG_API ag_status ag_denoise_check(ag_context *context);

#ifdef __cplusplus
}
#endif
#endif
