/* image_layout.h: how picture files lay out what they hold: which channels are the picture, which rows OpenEXR packs
 * together, which tiles and levels are worth reading one by one.
 * Rests on: OpenEXR, "The OpenEXR File Format" (compressions, names of channels and layers).
 * Flow: image_oiio.cpp -> [here]. Threads: pure functions. */
#ifndef AFTERGLOW_IMAGE_LAYOUT_H
#define AFTERGLOW_IMAGE_LAYOUT_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Returns how many channels are the picture, from *out_begin on: of many layers the first that has red, green and blue,
 * with alpha where that layer has it. 0: none has. names: [count]. */
int image_layout_find_colors(const char *const *names, int count, int *out_begin);

/* Returns the rows that OpenEXR packs together, by the name of the compression; of one that is not known the most that
 * any packs, 256. */
int image_layout_exr_rows(const char *compression);

/* Returns the power of two that a tile's side is, or -1: it is none, or beyond what is held at once. */
int image_layout_tile_bits(int side);

/* Returns whether tiles of that side are worth reading one by one, of a level so wide or high. */
bool image_layout_is_usable_tile(int tile_side, int level_side);

/* Returns whether a level's side is half of that of the level before, rounded either way, and at least 1. */
bool image_layout_is_half(int side, int before);

#ifdef __cplusplus
}
#endif

#endif
