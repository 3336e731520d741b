/* texture_cache.c: see texture_cache.h.
 *
 *     header     what the picture is; a fingerprint of header and parts
 *     tiles      as texture_store packs them, level by level, alpha last, in any order within a level
 *     parts      where each tile lies, and its checksum
 *
 * The layout is the machine's own; the key says which program wrote it. */
#define _GNU_SOURCE
#include "texture/texture_cache.h"

#include "descriptor.h"
#include "image/image.h"
#include "status.h"
#include "texture/texture_cache_folder.h"
#include "texture/texture_file_levels.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FORMAT = 1, OPEN_MAX_COUNT = 256, PATH_SIZE = 4096 };
static const uint64_t SIDE_MAX = 1u << 28;

/* Without gaps; zeroed before it is filled. */
typedef struct kept_header {
    char magic[8];
    hash128 key, check, content; /* check: of all else here, and the parts */
    uint64_t whole_bytes, bad_count, parts_offset, part_count;
    uint32_t width, height, channel_count, level_count;
    int32_t type, curve; /* of the file; that its values were made linear by */
    float gamma, least, most;
    float chromaticities[8];
    uint8_t as_bytes, has_alpha, has_chromaticities, is_first_of_several;
} kept_header;

/* Another one for each layout; files with an earlier one are made anew. */
static const char MAGIC[8] = "AGTILE3";

struct texture_kept {
    tile_file file;
    char path[PATH_SIZE]; /* empty: it has no name */
};

/* Of all scenes; relaxed: it only limits how many files are open. */
static atomic_u64 open_count;

hash128 texture_cache_key(const char *path, const unsigned char *bytes, size_t size, image_encoding encoding)
{
    const int32_t numbers[] = {FORMAT, (int32_t)encoding.curve, (int32_t)sizeof(kept_header), (int32_t)sizeof(size_t)};
    hash128 h = bytes ? hash128_begin() : texture_file_content(path);
    if (bytes)
        hash128_add(&h, bytes, size);
    HASH128_ADD(&h, numbers);
    HASH128_ADD(&h, encoding.gamma);
    hash128_add_text(&h, encoding.space);
    hash128_add_text(&h, ag_version());
    hash128_add_text(&h, __VERSION__); /* the compiler: coarser levels are sums of floats */
    return h;
}

static void path_of(char out_path[PATH_SIZE], const char *folder, hash128 key)
{
    const int length = snprintf(out_path, PATH_SIZE, "%s/%016llx%016llx" TEXTURE_CACHE_ENDING, folder,
                                (unsigned long long)key.bits[0], (unsigned long long)key.bits[1]);
    if (length >= PATH_SIZE)
        out_path[0] = '\0';
}

/* Takes the descriptor over; NULL: too many are open, or out of memory. */
static texture_kept *hold(int descriptor, const char *path)
{
    texture_kept *k = fetch_add_relaxed_u64(&open_count, 1) < OPEN_MAX_COUNT ? calloc(1, sizeof *k) : NULL;
    if (!k) {
        fetch_add_relaxed_u64(&open_count, UINT64_MAX);
        close(descriptor);
        return NULL;
    }
    k->file.descriptor = descriptor;
    k->file.is_checked = true;
    store_relaxed_u64(&k->file.size_bytes, sizeof(kept_header));
    snprintf(k->path, sizeof k->path, "%s", path);
    return k;
}

tile_file *texture_kept_file(texture_kept *k) { return &k->file; }

bool texture_kept_is_damaged(const texture_kept *k) { return load_relaxed_u32(&k->file.is_damaged) != 0; }

void texture_kept_destroy(texture_kept *k)
{
    if (!k)
        return;
    if (texture_kept_is_damaged(k) && k->path[0] != '\0')
        unlink(k->path);
    close(k->file.descriptor);
    fetch_add_relaxed_u64(&open_count, UINT64_MAX);
    free(k);
}

/* --- the levels and their parts --- */

/* The levels and alpha of a picture, in the order of the file. */
typedef struct kept_levels {
    texture_level *items[TEXTURE_LEVELS_MAX + 1];
    uint32_t count;
} kept_levels;

static kept_levels levels_of(const texture_image *i)
{
    kept_levels l = {.count = i->mips->level_count};
    for (uint32_t k = 0; k < l.count; k++)
        l.items[k] = &i->mips->levels[k];
    if (i->stored_alpha.width > 0)
        l.items[l.count++] = (texture_level *)&i->stored_alpha;
    return l;
}

static size_t part_count_of(const kept_levels *l)
{
    size_t count = 0;
    for (uint32_t k = 0; k < l->count; k++)
        count += texture_layout_tile_count(texture_level_layout(l->items[k]));
    return count;
}

static hash128 check_of(const kept_header *h, const texture_tile_part *parts)
{
    kept_header without = *h;
    memset(&without.check, 0, sizeof without.check);
    hash128 check = hash128_begin();
    HASH128_ADD(&check, without);
    hash128_add(&check, parts, h->part_count * sizeof *parts);
    return check;
}

/* Levels without pixels; false: out of memory. */
static bool describe_levels(const kept_header *h, texture_image *i)
{
    i->mips = calloc(1, sizeof *i->mips);
    if (!i->mips)
        return false;
    texture_level level = {.width = h->width,
                           .height = h->height,
                           .channel_count = h->channel_count,
                           .sample = h->as_bytes ? TEXTURE_BYTES : TEXTURE_FLOATS,
                           .table = h->as_bytes ? i->table : NULL};
    if (h->has_alpha) {
        i->stored_alpha = level;
        i->stored_alpha.channel_count = 1;
        i->stored_alpha.table = NULL;
    }
    i->mips->level_count = h->level_count;
    for (uint32_t k = 0; k < h->level_count; k++) {
        i->mips->levels[k] = level;
        level.width = (level.width + 1) / 2;
        level.height = (level.height + 1) / 2;
        level.sample = h->as_bytes ? TEXTURE_PACKED : TEXTURE_FLOATS;
        level.table = NULL;
    }
    return true;
}

/* --- finding --- */

static bool is_sound(const kept_header *h, hash128 key, uint64_t file_size)
{
    uint32_t levels = 1;
    if (memcmp(h->magic, MAGIC, sizeof MAGIC) != 0 || !hash128_is_equal(h->key, key) || h->width < 1 || h->height < 1 ||
        h->width > SIDE_MAX || h->height > SIDE_MAX || (h->channel_count != 1 && h->channel_count != 3))
        return false;
    for (uint32_t side = h->width > h->height ? h->width : h->height; side > 1; side = (side + 1) / 2)
        levels++;
    return h->level_count == levels && h->part_count <= file_size / sizeof(texture_tile_part) &&
           h->parts_offset == file_size - h->part_count * sizeof(texture_tile_part);
}

/* The file's parts, where they are as many as *i has and lie in the file; NULL: they do not. */
static texture_tile_part *read_parts(int descriptor, const kept_header *h, const texture_image *i)
{
    const kept_levels l = levels_of(i);
    if (part_count_of(&l) != h->part_count)
        return NULL;
    texture_tile_part *parts = malloc(h->part_count * sizeof *parts);
    bool is_good =
        parts && tile_file_read(descriptor, (unsigned char *)parts, h->part_count * sizeof *parts, h->parts_offset);
    is_good = is_good && hash128_is_equal(check_of(h, parts), h->check);
    size_t at = 0;
    for (uint32_t k = 0; k < l.count && is_good; k++) {
        const texture_layout layout = texture_level_layout(l.items[k]);
        const size_t most = texture_layout_tile_bytes(layout), count = texture_layout_tile_count(layout);
        for (size_t end = at + count; at < end && is_good; at++)
            is_good = parts[at].size_bytes >= 1 && parts[at].size_bytes <= most && parts[at].offset < h->parts_offset &&
                      parts[at].size_bytes <= h->parts_offset - parts[at].offset;
    }
    if (is_good)
        return parts;
    free(parts);
    return NULL;
}

static ag_status take_levels(const texture_set *set, const texture_tile_part *parts, texture_image *i)
{
    const kept_levels l = levels_of(i);
    ag_status status = AG_OK;
    for (uint32_t k = 0; k < l.count && status == AG_OK; k++) {
        const texture_layout layout = texture_level_layout(l.items[k]);
        status = texture_store_take(set->store, texture_kept_file(i->kept), layout, parts, &l.items[k]->tiles);
        parts += texture_layout_tile_count(layout);
    }
    return status;
}

/* The conversion that is left depends on the scene; so does the way in which values were made linear, in part. */
static ag_status find_colors(const texture_set *set, const kept_header *h, texture_image *i, bool *out_is_same,
                             char *message, size_t message_size)
{
    image description = {.type = (image_sample_type)h->type, .has_chromaticities = h->has_chromaticities};
    memcpy(description.chromaticities, h->chromaticities, sizeof description.chromaticities);
    AG_TRY(image_colors_find(&set->colors, i->encoding, &description, &i->colors, message, message_size));
    *out_is_same =
        !i->colors.space && (int32_t)i->colors.encoding.curve == h->curve && i->colors.encoding.gamma == h->gamma;
    if (!*out_is_same || !h->as_bytes)
        return AG_OK;
    return image_encoding_table(i->colors.encoding, 256, i->table, message, message_size);
}

static ag_status take(const texture_set *set, const kept_header *h, texture_image *i, bool *out_is_taken, char *message,
                      size_t message_size)
{
    bool is_same;
    AG_TRY(find_colors(set, h, i, &is_same, message, message_size));
    if (!is_same)
        return AG_OK;
    if (!describe_levels(h, i))
        return AG_ERROR_MEMORY;
    texture_tile_part *parts = read_parts(i->kept->file.descriptor, h, i);
    if (!parts) {
        store_relaxed_u32(&i->kept->file.is_damaged, 1);
        return AG_OK;
    }
    const ag_status status = take_levels(set, parts, i);
    free(parts);
    i->width = h->width;
    i->height = h->height;
    i->channel_count = h->channel_count;
    i->bad_count = h->bad_count;
    i->is_first_of_several = h->is_first_of_several;
    i->least = h->least;
    i->most = h->most;
    i->stored_content = h->content;
    i->is_stored = *out_is_taken = true;
    return status;
}

ag_status texture_cache_find(run_context *run, const texture_set *set, hash128 key, texture_image *i,
                             bool *out_is_found, char *message, size_t message_size)
{
    char path[PATH_SIZE];
    struct stat file;
    kept_header h;
    *out_is_found = false;
    path_of(path, set->limits.cache, key);
    const int descriptor = descriptor_beyond_standard(open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW));
    if (descriptor < 0)
        return AG_OK;
    const bool is_good = fstat(descriptor, &file) == 0 && S_ISREG(file.st_mode) &&
                         tile_file_read(descriptor, (unsigned char *)&h, sizeof h, 0) &&
                         is_sound(&h, key, (uint64_t)file.st_size);
    if (!is_good)
        unlink(path); /* for a good one to take its place */
    if (!is_good || texture_store_has_room(set->store, h.whole_bytes)) {
        close(descriptor);
        return AG_OK;
    }
    i->kept = hold(descriptor, path);
    if (!i->kept)
        return AG_OK;
    ag_status status = take(set, &h, i, out_is_found, message, message_size);
    if (status == AG_OK && *out_is_found) {
        futimens(descriptor, NULL);
        log_message(run ? run->log : NULL, AG_LOG_INFO, "'%s': %.1f MB of tiles are in '%s'", i->path,
                    (double)file.st_size / 1e6, path);
    } else {
        *out_is_found = false;
        texture_image_drop_store(i);
    }
    return status;
}

/* --- keeping --- */

texture_kept *texture_cache_begin(run_context *run, const texture_set *set)
{
    const char *folder = set->limits.cache;
    const int descriptor = texture_cache_folder_open(folder);
    if (descriptor >= 0)
        return hold(descriptor, "");
    log_once(run ? run->log : NULL, AG_LOG_WARNING, "texture cache",
             "textures cannot be kept in the folder '%s' (--texture-cache): %s", folder, strerror(errno));
    return NULL;
}

static kept_header header_of(hash128 key, const texture_image *i, const image *description, uint64_t whole_bytes)
{
    kept_header h;
    memset(&h, 0, sizeof h);
    memcpy(h.magic, MAGIC, sizeof h.magic);
    h.key = key;
    h.content = i->stored_content;
    h.whole_bytes = whole_bytes;
    h.bad_count = i->bad_count;
    h.width = i->width;
    h.height = i->height;
    h.channel_count = i->channel_count;
    h.level_count = i->mips->level_count;
    h.type = (int32_t)description->type;
    h.curve = (int32_t)i->colors.encoding.curve;
    h.gamma = i->colors.encoding.gamma;
    h.least = i->least;
    h.most = i->most;
    h.has_chromaticities = description->has_chromaticities;
    memcpy(h.chromaticities, description->chromaticities, sizeof h.chromaticities);
    h.as_bytes = i->mips->levels[0].sample == TEXTURE_BYTES;
    h.has_alpha = i->stored_alpha.width > 0;
    h.is_first_of_several = i->is_first_of_several;
    return h;
}

/* Writes header and parts; gives 0 or an errno. */
static int complete(texture_kept *k, kept_header *h, const texture_image *i)
{
    const kept_levels l = levels_of(i);
    h->part_count = part_count_of(&l);
    h->parts_offset = load_relaxed_u64(&k->file.size_bytes);
    texture_tile_part *parts = malloc(h->part_count * sizeof *parts), *next = parts;
    if (!parts)
        return ENOMEM;
    for (uint32_t level = 0; level < l.count; level++) {
        texture_tiles_parts(l.items[level]->tiles, next);
        next += texture_layout_tile_count(texture_level_layout(l.items[level]));
    }
    h->check = check_of(h, parts);
    const bool is_written = tile_file_write(k->file.descriptor, (const unsigned char *)parts,
                                            h->part_count * sizeof *parts, h->parts_offset) &&
                            tile_file_write(k->file.descriptor, (const unsigned char *)h, sizeof *h, 0);
    const int failure = is_written ? 0 : errno;
    free(parts);
    return failure;
}

void texture_cache_finish(run_context *run, const texture_set *set, texture_kept *k, hash128 key,
                          const texture_image *i, const struct image *description, uint64_t whole_bytes)
{
    log_sink *log = run ? run->log : NULL;
    const texture_limits *limits = &set->limits;
    kept_header h = header_of(key, i, description, whole_bytes);
    char path[PATH_SIZE];
    path_of(path, limits->cache, key);
    int failure = complete(k, &h, i);
    const uint64_t size = h.parts_offset + h.part_count * sizeof(texture_tile_part);
    if (failure == 0 && size > limits->cache_bytes)
        failure = EFBIG;
    if (failure == 0)
        failure = texture_cache_folder_name(k->file.descriptor, path);
    if (failure) {
        log_message(log, AG_LOG_WARNING, "'%s': its %.1f MB of tiles are not kept in '%s' (--texture-cache): %s",
                    i->path, (double)size / 1e6, limits->cache,
                    failure == EFBIG ? "they are more than --texture-cache-size" : strerror(failure));
        return;
    }
    snprintf(k->path, sizeof k->path, "%s", path);
    log_message(log, AG_LOG_INFO, "'%s': %.1f MB of tiles are kept in '%s'", i->path, (double)size / 1e6, path);
    texture_cache_folder_bound(limits->cache, limits->cache_bytes, path);
}
