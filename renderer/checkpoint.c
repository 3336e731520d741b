/* checkpoint.c: see checkpoint.h. */
#define _POSIX_C_SOURCE 200809L
#include "checkpoint.h"

#include "atomic_file.h"
#include "film/film_copy.h"
#include "integrator/integrator.h"
#include "rays/bvh.h"
#include "render_maps.h"
#include "scene_hash.h"
#include "settings_table.h"
#include "status.h"
#include "text/input_file.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

static const char MAGIC[8] = "AGCHKPT\n";
static const uint32_t BYTE_ORDER = 0x01020304u;
enum { READ_BLOCK = 1 << 18 };

/* --- headers --- */

static hash128 hash_filter(const pixel_filter *filter)
{
    hash128 hash = hash128_begin();
    HASH128_ADD(&hash, filter->radius);
    HASH128_ADD(&hash, filter->cdf);
    HASH128_ADD(&hash, filter->sign);
    return hash;
}

/* The photons whose irradiance has been demanded, so that layers and dumps that show it see no difference. */
static uint64_t words_of(const struct ag_rendering *r)
{
    return integrator_of(r->settings.integrator)->has_photon_map && r->settings.cache == AG_CACHE_ON_DEMAND
               ? r->maps->global.irradiance_photons.count
               : 0;
}

ag_status checkpoint_header_make(const struct ag_rendering *r, checkpoint_header *out)
{
    memset(out, 0, sizeof *out);
    if (integrator_of(r->settings.integrator)->has_photon_map) {
        AG_TRY(context_estimates(r->context, &out->estimates));
        out->photons = maps_photons_hash(r->maps);
    }
    memcpy(out->magic, MAGIC, sizeof out->magic);
    out->layout = CHECKPOINT_LAYOUT;
    out->byte_order = BYTE_ORDER;
    snprintf(out->program, sizeof out->program, "%s", ag_version());
    snprintf(out->isa, sizeof out->isa, "%s", bvh_isa(r->s->bvh));
    out->scene = scene_hash_of_light(r->s);
    out->view = scene_hash_of_view(r->s);
    out->filter = hash_filter(&r->film->filter);
    film_plane planes[FILM_PLANES_MAX];
    int count = film_planes(r->film, planes);
    for (int i = 0; i < count; i++)
        out->plane_sizes[i] = planes[i].size;
    out->photon_count = words_of(r);
    out->settings_size = (uint32_t)settings_of_picture(&r->settings, out->settings, sizeof out->settings);
    assert(out->settings_size <= sizeof out->settings);
    return AG_OK;
}

const char *checkpoint_header_difference(const checkpoint_header *file, const checkpoint_header *ours)
{
    if (memcmp(file->program, ours->program, sizeof file->program) != 0)
        return "version of the program";
    if (memcmp(file->isa, ours->isa, sizeof file->isa) != 0)
        return "instruction set (--isa)";
    const char *setting = settings_of_picture_difference(file->settings, ours->settings);
    if (setting)
        return setting;
    if (file->settings_size != ours->settings_size)
        return "set of settings";
    if (!hash128_is_equal(file->estimates, ours->estimates))
        return "build of the program, whose photon map has other light";
    if (!hash128_is_equal(file->filter, ours->filter))
        return "pixel filter";
    if (!hash128_is_equal(file->scene, ours->scene))
        return "scene (its shapes, materials, media or lights)";
    if (!hash128_is_equal(file->view, ours->view))
        return "camera, or other names or groups of lights";
    if (memcmp(file->plane_sizes, ours->plane_sizes, sizeof file->plane_sizes) != 0)
        return "film";
    if (!hash128_is_equal(file->photons, ours->photons))
        return "photon map, of other photons: by another build of the program, or of another file";
    return file->photon_count != ours->photon_count ? "number of irradiances" : NULL;
}

/* --- writing --- */

static uint32_t add_to_crc(uint32_t crc, const void *bytes, size_t size) { return (uint32_t)crc32_z(crc, bytes, size); }

static bool has_lost_map(const ag_rendering *r, const char *what)
{
    if (!r->maps || photon_file_is_intact(&r->maps->file))
        return false;
    log_message(r->context->log, AG_LOG_ERROR, "'%s': the photon map was cut short or overwritten: %s",
                r->map_name ? r->map_name : "", what);
    return true;
}

ag_status ag_rendering_write_checkpoint(const ag_rendering *r, const char *path)
{
    if (!r || !path)
        return AG_ERROR_ARGUMENT;
    checkpoint_header header;
    film_plane planes[FILM_PLANES_MAX];
    atomic_file_piece pieces[FILM_PLANES_MAX + 3];
    uint32_t *words = NULL, crc = 0;
    AG_TRY(checkpoint_header_make(r, &header));
    if (header.photon_count > 0) {
        words = malloc((size_t)header.photon_count * sizeof *words);
        if (!words)
            return AG_ERROR_MEMORY;
        irradiance_cache_save(&r->maps->cache, words);
    }
    if (has_lost_map(r, "no checkpoint is written")) {
        free(words);
        return AG_ERROR_SYSTEM;
    }
    int plane_count = film_planes(r->film, planes), count = 0;
    pieces[count++] = (atomic_file_piece){&header, sizeof header};
    for (int i = 0; i < plane_count; i++)
        pieces[count++] = (atomic_file_piece){planes[i].bytes, planes[i].size};
    if (words)
        pieces[count++] = (atomic_file_piece){words, (size_t)header.photon_count * sizeof *words};
    for (int i = 0; i < count; i++)
        crc = add_to_crc(crc, pieces[i].bytes, pieces[i].size);
    pieces[count++] = (atomic_file_piece){&crc, sizeof crc};

    char message[1024];
    ag_status status = atomic_file_write_pieces(&r->context->run, path, pieces, count, message, sizeof message);
    if (status != AG_OK && status != AG_CANCELLED)
        log_message(r->context->log, AG_LOG_ERROR, "%s", message);
    free(words);
    return status;
}

/* --- reading --- */

static ag_status refuse(const ag_rendering *r, const char *path, const char *why, const char *what)
{
    log_message(r->context->log, AG_LOG_ERROR, "cannot resume from '%s': %s%s", path, why, what);
    return AG_ERROR_INPUT;
}

/* The checksum of all but the last four bytes, which hold it. */
static bool is_whole(FILE *file)
{
    unsigned char *block = malloc(READ_BLOCK + sizeof(uint32_t));
    uint32_t crc = 0, told;
    size_t kept = 0, got; /* bytes at the beginning of the block that may be the last four */
    if (!block)
        return false;
    while ((got = fread(block + kept, 1, READ_BLOCK, file)) > 0) {
        size_t have = kept + got, known = have > sizeof told ? have - sizeof told : 0;
        crc = add_to_crc(crc, block, known);
        kept = have - known;
        memmove(block, block + known, kept);
    }
    memcpy(&told, block, sizeof told);
    free(block);
    return !ferror(file) && kept == sizeof told && told == crc;
}

/* Reads a film's planes and words, after the header, of a file that is known to be whole and ours. */
static bool read_contents(ag_rendering *r, FILE *file, const checkpoint_header *header)
{
    film_plane planes[FILM_PLANES_MAX];
    int count = film_planes(r->film, planes);
    for (int i = 0; i < count; i++)
        if (fread(planes[i].bytes, 1, planes[i].size, file) != planes[i].size)
            return false;
    if (header->photon_count == 0)
        return true;
    size_t words_count = (size_t)header->photon_count;
    uint32_t *words = malloc(words_count * sizeof *words);
    bool is_read = words && fread(words, sizeof *words, words_count, file) == words_count;
    if (is_read)
        irradiance_cache_restore(&r->maps->cache, words);
    free(words);
    return is_read;
}

ag_status ag_rendering_read_checkpoint(ag_rendering *r, const char *path)
{
    if (!r || !path)
        return AG_ERROR_ARGUMENT;
    char text[128] = "";
    int descriptor = input_file_open(NULL, path, text, sizeof text);
    if (descriptor < 0)
        return refuse(r, path, text, "");
    FILE *file = fdopen(descriptor, "rb");
    if (!file) {
        close(descriptor);
        return AG_ERROR_MEMORY;
    }
    checkpoint_header header, ours;
    ag_status status = checkpoint_header_make(r, &ours);
    if (status == AG_OK && has_lost_map(r, "no checkpoint is read"))
        status = AG_ERROR_SYSTEM;
    if (status != AG_OK) {
        fclose(file);
        return status;
    }
    bool has_header = fread(&header, sizeof header, 1, file) == 1;
    const char *why = NULL, *what = "";
    if (!has_header || memcmp(header.magic, MAGIC, sizeof MAGIC) != 0)
        why = "it is no checkpoint, or damaged";
    else if (header.byte_order != BYTE_ORDER)
        why = "it is of a machine with another order of bytes";
    else if (header.layout != CHECKPOINT_LAYOUT)
        why = "it is of another version of the program";
    else if (fseek(file, 0, SEEK_SET) != 0 || !is_whole(file))
        why = "it is damaged";
    else if ((what = checkpoint_header_difference(&header, &ours)) != NULL)
        why = "it is of a render with another ";
    else if (fseek(file, sizeof header, SEEK_SET) != 0 || !read_contents(r, file, &header))
        why = "it cannot be read", what = "";
    fclose(file);
    if (why)
        return refuse(r, path, why, what);
    film_resolve(r->film);
    return r->kept ? film_copy_take(r->film, &r->kept) : AG_OK; /* what a pass that is broken off falls back to */
}

ag_sample_counts ag_rendering_sample_counts(const ag_rendering *r)
{
    if (!r)
        return (ag_sample_counts){0};
    film_count count = film_count_samples(r->film);
    return (ag_sample_counts){(int)count.least, (int)count.most, count.mean};
}
