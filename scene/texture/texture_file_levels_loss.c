/* texture_file_levels_loss.c: coarser levels that were made of encoded values have lost light: told.
 * Flow: texture_file_levels.c -> [here]. Threads: one loads. */
#include "log.h"
#include "texture/texture_file_levels_private.h"

#include <stdio.h>
#include <stdlib.h>

/* The sum over a part of a tile, which its table or curve has made linear. */
static double sum_part(const texture_file_levels *l, const texture_image *i, int level, const unsigned char *tile,
                       uint32_t x, uint32_t y, uint32_t width, uint32_t height)
{
    const uint32_t channels = (uint32_t)l->color_count;
    double sum = 0.0;
    for (uint32_t row = y; row < y + height; row++) {
        const size_t first = (((size_t)row << l->header->levels[level].tile_width_bits) + x) * channels;
        for (size_t k = first; k < first + (size_t)width * channels; k++)
            sum += (double)(l->as_bytes ? i->table[tile[k]] : ((const float *)(const void *)tile)[k]);
    }
    return sum;
}

/* Means of encoded values are darker than the encoded mean. Gives how much of the light of some of the picture's tiles
 * the next level has; 1 where that cannot be found out. */
static double next_level_share(const texture_file_levels *l, const texture_image *i)
{
    enum { TILES = 16 };
    const image_level *fine = &l->header->levels[0], *coarse = &l->header->levels[1];
    const uint32_t across = (uint32_t)fine->width >> fine->tile_width_bits,
                   down = (uint32_t)fine->height >> fine->tile_height_bits; /* whole ones */
    const size_t bytes = tile_values(l, 0, l->color_count) * value_bytes(l);
    double fine_sum = 0.0, coarse_sum = 0.0;
    if (across == 0 || down == 0 || fine->tile_width_bits == 0 || fine->tile_height_bits == 0 ||
        fine->tile_width_bits != coarse->tile_width_bits || fine->tile_height_bits != coarse->tile_height_bits)
        return 1.0;
    unsigned char *tile = malloc(bytes);
    ag_status status = tile ? AG_OK : AG_ERROR_MEMORY;
    for (uint32_t k = 0; k < TILES && status == AG_OK; k++) {
        const uint32_t width = 1u << fine->tile_width_bits, height = 1u << fine->tile_height_bits;
        const uint32_t x = (k * 5 % TILES * across / TILES) * width, y = (k * down / TILES) * height;
        status = texture_file_levels_fetch(l, 0, x, y, false, tile, NULL);
        if (status != AG_OK)
            break;
        fine_sum += sum_part(l, i, 0, tile, 0, 0, width, height);
        status = texture_file_levels_fetch(l, 1, x / 2 & ~(width - 1), y / 2 & ~(height - 1), false, tile, NULL);
        if (status == AG_OK)
            coarse_sum +=
                4.0 * sum_part(l, i, 1, tile, x / 2 & (width - 1), y / 2 & (height - 1), width / 2, height / 2);
    }
    free(tile);
    return status == AG_OK && fine_sum > 0.0 ? coarse_sum / fine_sum : 1.0;
}

void texture_file_levels_warn_of_loss(run_context *run, const texture_file_levels *l, const texture_image *i)
{
    static const double TOLERANCE = 0.02;
    const double share = next_level_share(l, i);
    char key[4096];
    if (!run || share >= 1.0 - TOLERANCE)
        return;
    snprintf(key, sizeof key, "levels:%s", i->path);
    log_once(
        run->log, AG_LOG_WARNING, key,
        "'%s': from afar it is too dark: its second level has %.0f %% of the light of the first, as means of encoded "
        "values have (make it of linear values, or without levels)",
        i->path, 100.0 * share);
}
