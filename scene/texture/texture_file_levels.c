/* texture_file_levels.c: see texture_file_levels.h. */
#define _POSIX_C_SOURCE 200809L
#include "texture/texture_file_levels_private.h"

#include "clock.h"
#include "status.h"
#include "text/input_file.h"
#include "texture/texture_set.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void texture_file_levels_destroy(texture_file_levels *l)
{
    if (!l)
        return;
    image_levels_close(l->file);
    free(l->curve);
    free(l);
}

const char *texture_file_levels_problem(const texture_file_levels *l)
{
    if (!image_levels_is_unchanged(l->file))
        return "has changed while tiles of it were read";
    return load_relaxed_u32(&l->has_failed) ? "holds tiles that cannot be read" : NULL;
}

hash128 texture_file_content(const char *path)
{
    enum { AT_ONCE = 1 << 20 };
    hash128 h = hash128_begin();
    FILE *file = input_file_stream(path);
    char *bytes = file ? malloc(AT_ONCE) : NULL;
    size_t count = 1;
    while (bytes && (count = fread(bytes, 1, AT_ONCE, file)) > 0)
        hash128_add(&h, bytes, count);
    if (!bytes || ferror(file)) {
        const double now = clock_seconds();
        HASH128_ADD(&h, now);
    }
    free(bytes);
    if (file)
        fclose(file);
    return h;
}

/* --- tiles --- */

ag_status texture_file_levels_fetch(const texture_file_levels *l, int level, uint32_t x, uint32_t y, bool is_alpha,
                                    void *out_pixels, uint64_t *out_bad_count)
{
    const int begin = is_alpha ? l->color_count : 0, end = l->color_count + (is_alpha ? 1 : 0);
    const size_t count = tile_values(l, level, end - begin);
    memset(out_pixels, 0, count * value_bytes(l)); /* what is beyond the picture */
    AG_TRY(image_levels_read(l->file, level, (int)x, (int)y, begin, end, l->as_bytes, out_pixels));
    float *values = out_pixels;
    for (size_t k = 0; k < count && !l->as_bytes; k++) {
        if (l->curve && !is_alpha)
            values[k] = l->curve[(size_t)(float_clamp(values[k], 0.0f, 1.0f) * 65535.0f + 0.5f)];
        if (!isfinite(values[k])) {
            values[k] = 0.0f;
            if (out_bad_count)
                ++*out_bad_count;
        }
    }
    return AG_OK;
}

static ag_status note(texture_file_levels *l, ag_status status)
{
    if (status == AG_ERROR_INPUT)
        store_relaxed_u32(&l->has_failed, 1);
    return status;
}

static ag_status fetch_colors(void *user, int level, uint32_t x, uint32_t y, unsigned char *out_pixels)
{
    return note(user, texture_file_levels_fetch(user, level, x, y, false, out_pixels, NULL));
}

static ag_status fetch_alpha(void *user, int level, uint32_t x, uint32_t y, unsigned char *out_pixels)
{
    return note(user, texture_file_levels_fetch(user, level, x, y, true, out_pixels, NULL));
}

/* --- whole levels --- */

/* The findings while a level is gone over. */
typedef struct level_look {
    float least, most;
    bool is_opaque; /* all values are the largest that a byte has, or 1 */
    uint64_t bad_count;
} level_look;

/* The part of a tile that lies in the picture: into the level's array, unless that is NULL, and looked at. */
static void take_tile(const texture_file_levels *l, int level, int channel_count, uint32_t x, uint32_t y,
                      const unsigned char *tile, unsigned char *out_level, level_look *look)
{
    const image_level *of = &l->header->levels[level];
    const uint32_t side = 1u << of->tile_width_bits, left = (uint32_t)of->width - x;
    const size_t count = (size_t)channel_count * (left < side ? left : side), size = value_bytes(l);
    for (uint32_t row = 0; row < 1u << of->tile_height_bits && y + row < (uint32_t)of->height; row++) {
        const unsigned char *from = tile + ((size_t)row << of->tile_width_bits) * (size_t)channel_count * size;
        const float *values = (const float *)(const void *)from;
        if (out_level)
            memcpy(out_level + ((size_t)(y + row) * (size_t)of->width + x) * (size_t)channel_count * size, from,
                   count * size);
        for (size_t k = 0; k < count; k++) {
            look->is_opaque = look->is_opaque && (l->as_bytes ? from[k] == 255 : values[k] == 1.0f);
            if (!l->as_bytes) {
                look->least = values[k] < look->least ? values[k] : look->least;
                look->most = values[k] > look->most ? values[k] : look->most;
            }
        }
    }
}

/* out_level: as large as the level, or NULL. */
static ag_status go_over(run_context *run, const texture_file_levels *l, int level, bool is_alpha,
                         unsigned char *out_level, level_look *out_look)
{
    const image_level *of = &l->header->levels[level];
    const int channel_count = is_alpha ? 1 : l->color_count;
    unsigned char *tile = malloc(tile_values(l, level, channel_count) * value_bytes(l));
    ag_status status = tile ? AG_OK : AG_ERROR_MEMORY;
    *out_look = (level_look){.least = FLT_MAX, .most = -FLT_MAX, .is_opaque = true};
    for (uint32_t y = 0; y < (uint32_t)of->height && status == AG_OK; y += 1u << of->tile_height_bits) {
        if (run && run_is_cancelled(run))
            status = AG_CANCELLED;
        for (uint32_t x = 0; x < (uint32_t)of->width && status == AG_OK; x += 1u << of->tile_width_bits) {
            status = texture_file_levels_fetch(l, level, x, y, is_alpha, tile, &out_look->bad_count);
            if (status == AG_OK)
                take_tile(l, level, channel_count, x, y, tile, out_level, out_look);
        }
    }
    free(tile);
    return status;
}

static texture_level describe(const texture_file_levels *l, const texture_image *i, int level)
{
    return (texture_level){.width = (uint32_t)l->header->levels[level].width,
                           .height = (uint32_t)l->header->levels[level].height,
                           .channel_count = (uint32_t)l->color_count,
                           .sample = l->as_bytes ? TEXTURE_BYTES : TEXTURE_FLOATS,
                           .table = l->as_bytes ? i->table : NULL};
}

/* The array is malloc'ed. */
static ag_status read_level(run_context *run, const texture_file_levels *l, int level, bool is_alpha,
                            unsigned char **out_bytes, float **out_values, level_look *out_look)
{
    const image_level *of = &l->header->levels[level];
    const size_t count = (size_t)of->width * (size_t)of->height * (size_t)(is_alpha ? 1 : l->color_count);
    void *pixels = malloc(count * value_bytes(l));
    if (!pixels)
        return AG_ERROR_MEMORY;
    const ag_status status = go_over(run, l, level, is_alpha, pixels, out_look);
    if (status != AG_OK)
        free(pixels);
    else if (l->as_bytes)
        *out_bytes = pixels;
    else
        *out_values = pixels;
    return status;
}

static bool has_alpha_channel(const texture_file_levels *l)
{
    return l->header->picture.channel_count > l->color_count;
}

static void take_look(texture_image *i, const level_look *look)
{
    i->bad_count += look->bad_count;
    if (look->least <= look->most) {
        i->least = look->least;
        i->most = look->most;
    }
}

static ag_status read_whole(run_context *run, const texture_file_levels *l, texture_image *i)
{
    level_look look;
    AG_TRY(read_level(run, l, 0, false, &i->bytes, &i->values, &look));
    take_look(i, &look);
    i->mips->levels[0] = texture_image_finest(i);
    for (int k = 1; k < l->header->level_count; k++) {
        unsigned char *bytes = NULL;
        texture_level *level = &i->mips->levels[k];
        *level = describe(l, i, k);
        AG_TRY(read_level(run, l, k, false, &bytes, &level->values, &look));
        level->bytes = bytes;
        i->mips->level_count = (uint32_t)k + 1;
    }
    if (!has_alpha_channel(l))
        return AG_OK;
    AG_TRY(read_level(run, l, 0, true, &i->alpha_bytes, &i->alpha_values, &look));
    i->bad_count += look.bad_count;
    if (look.is_opaque) {
        free(i->alpha_bytes);
        free(i->alpha_values);
        i->alpha_bytes = NULL;
        i->alpha_values = NULL;
    }
    return AG_OK;
}

/* --- in the store --- */

static ag_status lend_level(const texture_file_levels *l, texture_store *store, int level, texture_tile_fetch *fetch_it,
                            texture_level *in_out)
{
    const image_level *of = &l->header->levels[level];
    const texture_tile_source source = {.fetch = fetch_it,
                                        .user = (void *)l,
                                        .level = level,
                                        .tile_width_bits = (uint32_t)of->tile_width_bits,
                                        .tile_height_bits = (uint32_t)of->tile_height_bits};
    const texture_layout layout = {in_out->width, in_out->height, in_out->channel_count, (uint32_t)value_bytes(l)};
    return texture_store_lend(store, source, layout, &in_out->tiles);
}

static ag_status lend_tiles(run_context *run, const texture_file_levels *l, texture_store *store, texture_image *i)
{
    level_look look;
    i->is_stored = true;
    for (int k = 0; k < l->header->level_count; k++) {
        i->mips->levels[k] = describe(l, i, k);
        AG_TRY(lend_level(l, store, k, fetch_colors, &i->mips->levels[k]));
        i->mips->level_count = (uint32_t)k + 1;
    }
    if (!l->as_bytes) { /* of bytes the table says it */
        AG_TRY(go_over(run, l, 0, false, NULL, &look));
        take_look(i, &look);
    }
    if (!has_alpha_channel(l))
        return AG_OK;
    AG_TRY(go_over(run, l, 0, true, NULL, &look));
    i->bad_count += look.bad_count;
    if (look.is_opaque)
        return AG_OK;
    i->stored_alpha = describe(l, i, 0);
    i->stored_alpha.channel_count = 1;
    i->stored_alpha.table = NULL;
    return lend_level(l, store, 0, fetch_alpha, &i->stored_alpha);
}

static uint64_t whole_bytes(const texture_file_levels *l)
{
    uint64_t values = 0;
    for (int k = 0; k < l->header->level_count; k++)
        values += (uint64_t)l->header->levels[k].width * (uint64_t)l->header->levels[k].height *
                  (uint64_t)(l->color_count + (k == 0 && has_alpha_channel(l) ? 1 : 0));
    return values * value_bytes(l);
}

/* --- loading --- */

static ag_status find_curve(texture_file_levels *l, texture_image *i, char *message, size_t message_size)
{
    enum { WORDS = 65536 };
    const image_encoding linear = {.curve = IMAGE_CURVE_LINEAR};
    i->least = 0.0f; /* of integers */
    i->most = 1.0f;
    if (l->as_bytes)
        return image_encoding_table(i->colors.encoding, 256, i->table, message, message_size);
    if (l->header->picture.type != IMAGE_UINT16 || image_encoding_equal(i->colors.encoding, linear))
        return AG_OK;
    l->curve = malloc(WORDS * sizeof *l->curve);
    return l->curve ? image_encoding_table(i->colors.encoding, WORDS, l->curve, message, message_size)
                    : AG_ERROR_MEMORY;
}

/* maketx multiplies the colours by alpha, which those of PNG are not, and TIFF stores what it did. */
static void tell_of_alpha(run_context *run, const texture_file_levels *l, const texture_image *i)
{
    char key[4096];
    if (!run || !l->header->picture.is_multiplied_by_alpha || !texture_image_has_alpha(i))
        return;
    snprintf(key, sizeof key, "alpha:%s", i->path);
    log_once(run->log, AG_LOG_WARNING, key,
             "'%s': its colours are multiplied by its alpha, as maketx does, and used so: where alpha is below 1 they "
             "are darker than in the picture that it was made of (make it of one without alpha)",
             i->path);
}

static ag_status read_levels(run_context *run, const texture_set *set, texture_file_levels *l, texture_image *i,
                             char *message, size_t message_size)
{
    AG_TRY(find_curve(l, i, message, message_size));
    i->width = (uint32_t)l->header->levels[0].width;
    i->height = (uint32_t)l->header->levels[0].height;
    i->channel_count = (uint32_t)l->color_count;
    i->is_by_file = true;
    i->is_first_of_several = l->header->picture.is_first_of_several;
    i->mips = calloc(1, sizeof *i->mips);
    if (!i->mips)
        return AG_ERROR_MEMORY;
    const bool is_kept = !set->store || texture_store_keeps(set->store, whole_bytes(l));
    const ag_status status = is_kept ? read_whole(run, l, i) : lend_tiles(run, l, set->store, i);
    if (status == AG_OK && (l->as_bytes || l->curve))
        texture_file_levels_warn_of_loss(run, l, i);
    if (status == AG_OK)
        tell_of_alpha(run, l, i);
    if (status == AG_ERROR_INPUT)
        snprintf(message, message_size, "cannot read '%s': OpenImageIO cannot decode its tiles", i->path);
    return status;
}

ag_status texture_file_levels_read(run_context *run, const texture_set *set, texture_image *i, bool *out_is_read,
                                   char *message, size_t message_size)
{
    image_levels *file;
    *out_is_read = false;
    AG_TRY(image_levels_open(run, i->path, &file));
    if (!file)
        return AG_OK;
    texture_file_levels *l = calloc(1, sizeof *l);
    if (!l) {
        image_levels_close(file);
        return AG_ERROR_MEMORY;
    }
    i->file = l;
    l->file = file;
    l->header = image_levels_describe(file);
    l->color_count = l->header->picture.channel_count >= 3 ? 3 : 1;
    l->as_bytes = l->header->picture.type == IMAGE_UINT8;
    ag_status status =
        image_colors_find(&set->colors, i->encoding, &l->header->picture, &i->colors, message, message_size);
    *out_is_read = status == AG_OK && !i->colors.space;
    if (*out_is_read)
        status = read_levels(run, set, l, i, message, message_size);
    if (!i->is_stored) {
        texture_file_levels_destroy(l);
        i->file = NULL;
    }
    return status;
}
