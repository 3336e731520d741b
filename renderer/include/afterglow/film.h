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
/* Writes the CIE xy chromaticities of the working space: red, green, blue, white, each x and y. */
AG_API void ag_film_chromaticities(const ag_film *film, float out_chromaticities[8]);

/* The channels of picture and layers, by the names that they have in a file; R, G and B are the first three. */
AG_API int ag_film_channel_count(const ag_film *film);
AG_API const char *ag_film_channel_name(const ag_film *film, int channel); /* the film's; NULL: there is none */
/* Writes width * height values of a channel, top row first. Errors: AG_ERROR_ARGUMENT (there is no such channel). */
AG_API ag_status ag_film_read_channel(const ag_film *film, int channel, float *out_values);

/* The name of the object or material whose id a channel of AG_LAYER_CRYPTO_OBJECT or AG_LAYER_CRYPTO_MATERIAL holds;
 * longer ones are cut at size - 1 bytes. False: there is none of that id, or the film has no such layer. Any thread may
 * ask. */
AG_API bool ag_film_matte_name(const ag_film *film, ag_layer layer, float id, char *out_name, size_t size);

/* The three functions below show a picture while it is rendered. Any thread may call them, callbacks too, from
 * ag_rendering_film on until the film is destroyed. They copy R, G and B, as ag_film_pixels returns them, tile by tile:
 * each tile as it was when it was finished last, in this pass over the picture or the one before; at first it is black.
 * They wait no longer than a tile takes to be copied, except while the film is denoised. */
#define AG_TILE_SIZE 32
/* A part of the picture: AG_TILE_SIZE pixels wide and high, or less at the right and lower edges. This struct will not
 * change. */
typedef struct ag_tile {
    int x, y; /* of its upper left pixel, relative to the upper left of the pixels rendered */
    int width, height;
    uint64_t version; /* grows with each change of any tile; 0: not rendered yet, and black */
} ag_tile;
/* Tiles are numbered row by row from the upper left. */
AG_API size_t ag_film_tile_count(const ag_film *film);
/* Copies a tile if it has changed since a version, else returns false and writes nothing. tile: [0,
 * ag_film_tile_count). out_pixels: room for 3 * AG_TILE_SIZE * AG_TILE_SIZE floats; width * height pixels are written,
 * rows without gaps. */
AG_API bool ag_film_read_tile(const ag_film *film, size_t tile, uint64_t since_version, ag_tile *out_tile,
                              float *out_pixels);
/* Brings a copy of the whole picture up to date: writes the tiles that have changed since a version (0: every tile
 * rendered so far), and returns the version that the copy then has. out_pixels: the caller's, as large as
 * ag_film_pixels. */
AG_API uint64_t ag_film_read_picture(const ag_film *film, uint64_t since_version, float *out_pixels);

/* Denoises R, G and B with Open Image Denoise, which is loaded by this call; uses albedo and normals where the render
 * settings have denoise. The other channels stay as they are, so that the parts of light no longer add up. Errors:
 * AG_ERROR_SYSTEM (the library is not installed), AG_ERROR_MEMORY. */
AG_API ag_status ag_film_denoise(ag_context *context, ag_film *film);
/* Checks, before a long render, that Open Image Denoise can be loaded. Errors: AG_ERROR_SYSTEM. */
AG_API ag_status ag_denoise_check(ag_context *context);

#ifdef __cplusplus
}
#endif
#endif
