/* texture_image_load.c: see texture_image_load.h. */
#define _POSIX_C_SOURCE 200809L
#include "texture/texture_image_load.h"

#include "image/image_reader.h"
#include "status.h"
#include "text/input_file.h"
#include "texture/texture_cache.h"
#include "texture/texture_file_levels.h"
#include "texture/texture_set.h"
#include "texture/texture_udim.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The inputs that a picture is made of. */
typedef struct source {
    run_context *run;
    const char *path;
    const unsigned char *bytes; /* the file's; NULL: it is on disk */
    size_t size;
    const image *pixels; /* NULL: as above */
    uint64_t version;    /* of those, or of the file */
    image_encoding encoding;
} source;

static ag_status allow(const source *from, char *message, size_t message_size)
{
    char reason[128];
    if (from->bytes || from->pixels || input_file_allow(from->run, from->path, reason, sizeof reason))
        return AG_OK;
    snprintf(message, message_size, "cannot read '%s': %s", from->path, reason);
    return AG_ERROR_INPUT;
}

static void tell_of_others(run_context *run, const texture_image *i)
{
    char key[4096];
    if (!run || !i->is_first_of_several)
        return;
    snprintf(key, sizeof key, "several:%s", i->path);
    log_once(run->log, AG_LOG_WARNING, key,
             "'%s': the file holds several pictures (parts, pages or frames), of which the first alone is used",
             i->path);
}

/* *out_description: the picture without its pixels. */
static ag_status read_image(const texture_set *set, texture_image *i, const source *from, image *out_description,
                            char *message, size_t message_size)
{
    image picture = {0};
    ag_status status = AG_OK;
    if (from->pixels)
        status = image_copy(from->pixels, false, &picture) ? AG_OK : AG_ERROR_MEMORY;
    else if (from->bytes)
        status = image_read_memory(from->run, from->path, from->bytes, from->size, &picture, message, message_size);
    else
        status = image_read_compact(from->run, from->path, &picture, message, message_size);
    if (status == AG_OK)
        status = image_fill_window(&picture, from->path, message, message_size);
    *out_description = picture;
    out_description->pixels = NULL;
    out_description->bytes = NULL;
    i->is_first_of_several = picture.is_first_of_several;
    if (status == AG_OK)
        status = texture_image_take(&set->colors, i, &picture, message, message_size);
    image_reset(&picture);
    return status;
}

/* --- those that do not fit into memory --- */

/* The picture's bytes with its coarser levels, which may be made later, and alpha. */
static uint64_t whole_bytes(const texture_image *i)
{
    const uint64_t pixels = (uint64_t)i->width * i->height, values = pixels * i->channel_count;
    const uint64_t finest = i->bytes ? values : values * sizeof *i->values;
    const uint64_t coarser = values / 3 * (i->bytes ? sizeof(uint16_t) : sizeof(float));
    return finest + coarser + (i->alpha_bytes ? pixels : 0) + (i->alpha_values ? pixels * sizeof *i->alpha_values : 0);
}

/* Pixels, coarser levels and alpha, into a file, as of texture_store_put. */
static ag_status put_levels(run_context *run, texture_set *set, texture_image *i, tile_file *into, char *message,
                            size_t message_size)
{
    const texture_level finest = texture_image_finest(i);
    AG_TRY(texture_mips_create(run, &finest, &i->mips));
    AG_TRY(texture_mips_put(run, i->mips, set->store, into, message, message_size));
    if (!i->alpha_bytes && !i->alpha_values)
        return AG_OK;
    i->stored_alpha = texture_image_alpha(i, false);
    return texture_level_put(run, &i->stored_alpha, set->store, into, message, message_size);
}

/* put_levels into the folder where pictures are kept. A folder that is full, or cannot be written, is told; *out_is_put
 * is false, and nothing has happened to *i. */
static ag_status put_to_keep(run_context *run, texture_set *set, texture_image *i, const hash128 *key,
                             const image *description, bool *out_is_put, char *message, size_t message_size)
{
    *out_is_put = false;
    i->kept = texture_cache_begin(run, set);
    if (!i->kept)
        return AG_OK;
    const ag_status status = put_levels(run, set, i, texture_kept_file(i->kept), message, message_size);
    if (status != AG_ERROR_SYSTEM) {
        *out_is_put = status == AG_OK;
        if (status == AG_OK)
            texture_cache_finish(run, set, i->kept, *key, i, description, whole_bytes(i));
        return status;
    }
    log_once(run ? run->log : NULL, AG_LOG_WARNING, "texture cache", "%s", message);
    texture_image_drop_store(i);
    return AG_OK;
}

/* Moves what does not fit into the scene's store. key: to keep it by; NULL: it is not to be kept. */
static ag_status put_into_store(run_context *run, texture_set *set, texture_image *i, const hash128 *key,
                                const image *description, char *message, size_t message_size)
{
    bool is_put = false;
    i->stored_content = texture_image_content(i);
    if (key && !i->colors.space)
        AG_TRY(put_to_keep(run, set, i, key, description, &is_put, message, message_size));
    if (!is_put)
        AG_TRY(put_levels(run, set, i, NULL, message, message_size));
    free(i->bytes);
    free(i->values);
    free(i->alpha_bytes);
    free(i->alpha_values);
    i->bytes = i->alpha_bytes = NULL;
    i->values = i->alpha_values = NULL;
    i->is_stored = true;
    return AG_OK;
}

/* Where memory is limited. */
static ag_status make_store(texture_set *set)
{
    const uint64_t limit_bytes = set->limits.memory_bytes;
    if (limit_bytes > 0 && !set->store) {
        set->store = texture_store_create(limit_bytes);
        if (!set->store)
            return AG_ERROR_MEMORY;
    }
    return AG_OK;
}

/* A picture that is read whole; kept ones are not read, where they do not fit into memory. */
static ag_status read_and_hold(texture_set *set, texture_image *i, const source *from, char *message,
                               size_t message_size)
{
    image description;
    hash128 key;
    const bool is_to_keep = set->store && set->limits.cache && !from->pixels;
    if (is_to_keep) {
        bool is_found;
        key = texture_cache_key(from->path, from->bytes, from->size, i->encoding);
        AG_TRY(texture_cache_find(from->run, set, key, i, &is_found, message, message_size));
        if (is_found)
            return AG_OK;
    }
    AG_TRY(read_image(set, i, from, &description, message, message_size));
    if (!set->store || texture_store_keeps(set->store, whole_bytes(i)))
        return AG_OK;
    return put_into_store(from->run, set, i, is_to_keep ? &key : NULL, &description, message, message_size);
}

/* --- tiles --- */

static void add_tile(texture_image *i, uint32_t slot, texture_image *tile)
{
    i->udim->tiles[slot] = tile;
    i->width = tile->width > i->width ? tile->width : i->width;
    i->height = tile->height > i->height ? tile->height : i->height;
    i->channel_count = tile->channel_count > i->channel_count ? tile->channel_count : i->channel_count;
    i->bad_count += tile->bad_count;
    i->has_tile_alpha = i->has_tile_alpha || texture_image_has_alpha(tile);
}

static ag_status load(texture_set *set, const source *from, uint32_t *out_index, char *message, size_t message_size);

/* Slots ascend. */
static ag_status load_tiles(texture_set *set, texture_image *i, const source *from, const uint16_t *slots,
                            uint32_t count, char *message, size_t message_size)
{
    i->udim = calloc(1, sizeof *i->udim);
    if (!i->udim)
        return AG_ERROR_MEMORY;
    i->udim->slot_count = (uint32_t)slots[count - 1] + 1;
    i->udim->tiles = calloc(i->udim->slot_count, sizeof *i->udim->tiles);
    ag_status status = i->udim->tiles ? AG_OK : AG_ERROR_MEMORY;
    for (uint32_t k = 0; k < count && status == AG_OK; k++) {
        uint32_t index = 0;
        source tile = *from;
        char *path = texture_udim_file(from->path, slots[k]);
        tile.path = path;
        status = path ? load(set, &tile, &index, message, message_size) : AG_ERROR_MEMORY;
        free(path);
        if (status == AG_OK)
            add_tile(i, slots[k], set->images[index]);
    }
    return status;
}

static ag_status read_tiles(texture_set *set, texture_image *i, const source *from, char *message, size_t message_size)
{
    char reason[128] = "it holds more than one of <UDIM> and <UVTILE>";
    uint16_t *slots;
    uint32_t count;
    if (texture_udim_is_ambiguous(from->path) ||
        !input_file_may_ask(from->run, from->path, reason, sizeof reason)) { /* before its folder is searched */
        snprintf(message, message_size, "cannot read '%s': %s", from->path, reason);
        return AG_ERROR_INPUT;
    }
    AG_TRY(texture_udim_find(from->path, &slots, &count));
    ag_status status = AG_ERROR_INPUT;
    if (count > 0) {
        status = load_tiles(set, i, from, slots, count, message, message_size);
    } else {
        char *first = texture_udim_file(from->path, 0);
        snprintf(reason, sizeof reason, "No such file");
        if (first)
            input_file_allow(from->run, first, reason, sizeof reason); /* its folder may be missing, too */
        snprintf(message, message_size, "cannot read '%s': there is no file of any tile, such as '%s': %s", from->path,
                 first ? first : "", reason);
        free(first);
    }
    free(slots);
    return status;
}

bool texture_image_is_there(const run_context *run, const char *path)
{
    char reason[128];
    uint16_t *slots;
    uint32_t count;
    if (!input_file_may_ask(run, path, reason, sizeof reason))
        return false;
    if (!texture_udim_is_pattern(path))
        return access(path, F_OK) == 0;
    if (texture_udim_find(path, &slots, &count) != AG_OK)
        return false;
    free(slots);
    return count > 0;
}

/* --- each once --- */

/* Returns the same picture in the scene before, where both can share it; NULL: it must be read. */
static texture_image *find_kept(const texture_set *set, const source *from)
{
    for (uint32_t k = 0; set->before && k < set->before->image_count; k++) {
        texture_image *i = set->before->images[k];
        if (i->version != 0 && i->version == from->version && !i->is_stored && !i->file && !i->udim &&
            image_encoding_equal(i->encoding, from->encoding) && strcmp(i->path, from->path) == 0)
            return i;
    }
    return NULL;
}

static ag_status keep(texture_set *set, texture_image *kept, uint32_t *out_index)
{
    AG_TRY(make_store(set));
    if (set->store)
        (void)texture_store_keeps(set->store, whole_bytes(kept)); /* it counts, whatever the limit says */
    texture_image *i = texture_image_hold(kept);
    if (!i)
        return AG_ERROR_MEMORY;
    set->kept_count++;
    return texture_set_add_image(set, i, out_index);
}

static ag_status load(texture_set *set, const source *given, uint32_t *out_index, char *message, size_t message_size)
{
    source with_version = *given;
    const source *from = &with_version;
    for (uint32_t k = 0; k < set->image_count; k++)
        if (image_encoding_equal(set->images[k]->encoding, from->encoding) &&
            strcmp(set->images[k]->path, from->path) == 0) {
            *out_index = k;
            return AG_OK;
        }
    const bool is_on_disk = !from->bytes && !from->pixels, is_tiled = is_on_disk && texture_udim_is_pattern(from->path);
    if (!is_tiled)
        AG_TRY(allow(from, message, message_size));
    if (is_on_disk && !is_tiled)
        with_version.version = input_file_version(from->path);
    texture_image *kept = find_kept(set, from);
    if (kept)
        return keep(set, kept, out_index);
    texture_image *i = calloc(1, sizeof *i);
    if (!i)
        return AG_ERROR_MEMORY;
    set->read_count++;
    i->version = from->version;
    i->encoding = from->encoding;
    i->path = strdup(from->path);
    ag_status status = i->path ? AG_OK : AG_ERROR_MEMORY;
    if (status == AG_OK && is_tiled) {
        status = read_tiles(set, i, from, message, message_size);
    } else if (status == AG_OK) {
        bool is_read = false;
        status = make_store(set);
        if (status == AG_OK && is_on_disk)
            status = texture_file_levels_read(from->run, set, i, &is_read, message, message_size);
        if (status == AG_OK && !is_read)
            status = read_and_hold(set, i, from, message, message_size);
        if (status == AG_OK)
            tell_of_others(from->run, i);
    }
    if (status != AG_OK)
        texture_image_destroy(i);
    return status ? status : texture_set_add_image(set, i, out_index);
}

ag_status texture_image_load(run_context *run, texture_set *set, const char *path, image_encoding encoding,
                             uint32_t *out_index, char *message, size_t message_size)
{
    return load(set, &(source){.run = run, .path = path, .encoding = encoding}, out_index, message, message_size);
}

ag_status texture_image_load_memory(run_context *run, texture_set *set, const char *name, const unsigned char *bytes,
                                    size_t size, image_encoding encoding, uint32_t *out_index, char *message,
                                    size_t message_size)
{
    const source from = {.run = run, .path = name, .bytes = bytes, .size = size, .encoding = encoding};
    return load(set, &from, out_index, message, message_size);
}

ag_status texture_image_load_pixels(run_context *run, texture_set *set, const char *name, const image *pixels,
                                    uint64_t version, image_encoding encoding, uint32_t *out_index, char *message,
                                    size_t message_size)
{
    const source from = {.run = run, .path = name, .pixels = pixels, .version = version, .encoding = encoding};
    return load(set, &from, out_index, message, message_size);
}
