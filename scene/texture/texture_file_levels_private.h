/* texture_file_levels_private.h: what reading a file's levels and judging them share.
 * Flow: texture_file_levels.c, texture_file_levels_loss.c. Threads: as the fields say. */
#ifndef AFTERGLOW_TEXTURE_FILE_LEVELS_PRIVATE_H
#define AFTERGLOW_TEXTURE_FILE_LEVELS_PRIVATE_H

#include "atomics.h"
#include "image/image_levels.h"
#include "texture/texture_file_levels.h"

struct texture_file_levels {
    image_levels *file;
    const image_levels_header *header;
    int color_count; /* channels that are colours: 1 or 3; alpha is the next one */
    bool as_bytes;
    atomic_u32 has_failed; /* relaxed: set by whoever reads a tile, read behind a barrier of the pass */
    float *curve;          /* [65536], linear values of 16-bit integers; NULL: they are linear */
};

static inline size_t tile_values(const texture_file_levels *l, int level, int channel_count)
{
    const image_level *of = &l->header->levels[level];
    return (size_t)channel_count << (of->tile_width_bits + of->tile_height_bits);
}

static inline size_t value_bytes(const texture_file_levels *l) { return l->as_bytes ? 1 : sizeof(float); }

/* Linear values, but for bytes. Values that are not finite become 0; out_bad_count, which may be NULL, is raised. */
ag_status texture_file_levels_fetch(const texture_file_levels *l, int level, uint32_t x, uint32_t y, bool is_alpha,
                                    void *out_pixels, uint64_t *out_bad_count);

/* Warns, once for each file in the life of the log, where the next level has lost light. */
void texture_file_levels_warn_of_loss(run_context *run, const texture_file_levels *l, const texture_image *i);

#endif
