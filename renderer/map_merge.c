/* map_merge.c: what a photon map's file holds, and files of one map that were filled apart, put together.
 * Flow: photon_file -> [here] -> photon_merge -> photon_file. Threads: one. */
#include "context.h"

#include "atomic_file.h"
#include "photon_file.h"
#include "photon_merge.h"
#include "public_structs.h"
#include "status.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

_Static_assert(sizeof((ag_photon_map_info *)0)->settings >= PHOTON_FILE_SETTINGS_MAX &&
                   sizeof((ag_photon_map_info *)0)->program >= sizeof((photon_file_key *)0)->program &&
                   sizeof((ag_photon_map_info *)0)->machine >= sizeof((photon_file_key *)0)->machine,
               "the public texts hold the file's");

/* A file that has been read; all zero: none. */
typedef struct read_map {
    photon_file file;
    photon_file_key key;
    hash128 fixed;
    photon_map global, caustic;
} read_map;

static void read_map_reset(read_map *m)
{
    if (!m->file.memory)
        return;
    photon_map_reset(&m->global);
    photon_map_reset(&m->caustic);
    photon_file_close(&m->file);
    *m = (read_map){0};
}

static ag_status read_map_open(ag_context *context, const char *path, read_map *out)
{
    char why[512];
    *out = (read_map){0};
    read_map m;
    switch (photon_file_read(&context->run, path, &m.key, &m.fixed, &m.file, &m.global, &m.caustic, why, sizeof why)) {
    case PHOTON_FILE_OPEN: *out = m; return AG_OK;
    case PHOTON_FILE_CANCELLED: return AG_CANCELLED;
    case PHOTON_FILE_ABSENT: snprintf(why, sizeof why, "there is no such file"); break;
    case PHOTON_FILE_FOREIGN:
    case PHOTON_FILE_REFUSED:
    case PHOTON_FILE_FAILED: break;
    }
    log_message(context->log, AG_LOG_ERROR, "%s: error: %s", path, why);
    return AG_ERROR_INPUT;
}

static void hash_text(hash128 hash, char out_text[33])
{
    snprintf(out_text, 33, "%016" PRIx64 "%016" PRIx64, hash.bits[0], hash.bits[1]);
}

static ag_photon_map_info info_of(const read_map *m)
{
    ag_photon_map_info info = {.file_bytes = m->file.size_bytes,
                               .paths_emitted = m->global.set.emitted_paths + m->caustic.set.emitted_paths,
                               .photons_global = m->global.set.count,
                               .photons_caustic = m->caustic.set.count,
                               .irradiance_photons = m->global.irradiance_photons.count,
                               .ready = photon_map_count_ready(&m->global),
                               .damaged = m->file.damaged};
    static const hash128 none;
    memcpy(info.program, m->key.program, sizeof m->key.program);
    memcpy(info.machine, m->key.machine, sizeof m->key.machine);
    memcpy(info.settings, m->key.settings, sizeof m->key.settings);
    hash_text(m->key.scene, info.scene);
    if (!hash128_is_equal(m->key.aim_view, none))
        hash_text(m->key.aim_view, info.view);
    return info;
}

ag_status ag_photon_map_read_info_fill(ag_context *context, const char *path, void *out_info, size_t struct_size)
{
    if (!context || !path || !out_info)
        return AG_ERROR_ARGUMENT;
    read_map m;
    ag_status status = read_map_open(context, path, &m);
    if (status == AG_OK) {
        const ag_photon_map_info info = info_of(&m);
        public_struct_write_part(&info, sizeof info, out_info, struct_size);
    }
    read_map_reset(&m);
    return status;
}

/* --- merging --- */

static bool is_one_of(const char *path, const char *const *paths, size_t count)
{
    struct stat ours, other;
    for (size_t i = 0; i < count && stat(path, &ours) == 0; i++)
        if (stat(paths[i], &other) == 0 && ours.st_dev == other.st_dev && ours.st_ino == other.st_ino)
            return true;
    return false;
}

/* A file that is there is replaced only where it is a photon map. out_is_sound: it can be read. */
static ag_status check_output(ag_context *context, const char *path, bool *out_is_sound)
{
    char why[1024];
    read_map m;
    ag_status status = AG_OK;
    switch (photon_file_read(&context->run, path, &m.key, &m.fixed, &m.file, &m.global, &m.caustic, why, sizeof why)) {
    case PHOTON_FILE_OPEN:
        read_map_reset(&m);
        *out_is_sound = true;
        break;
    case PHOTON_FILE_CANCELLED: return AG_CANCELLED;
    case PHOTON_FILE_FOREIGN:
    case PHOTON_FILE_FAILED:
        log_message(context->log, AG_LOG_ERROR, "%s: error: it is not replaced by a photon map: %s", path, why);
        return AG_ERROR_OUTPUT;
    case PHOTON_FILE_ABSENT:
    case PHOTON_FILE_REFUSED: break; /* a map that is damaged may be replaced */
    }
    status = atomic_file_check(path, why, sizeof why);
    if (status != AG_OK)
        log_message(context->log, AG_LOG_ERROR, "%s", why);
    return status;
}

/* Adds the irradiances of `from`, which was read from path. */
static ag_status take_irradiances(ag_context *context, const char *first_path, read_map *into, const char *path,
                                  read_map *from)
{
    uint64_t added = 0;
    uint32_t irradiance_photon;
    if (!hash128_is_equal(from->fixed, into->fixed)) {
        log_message(context->log, AG_LOG_ERROR,
                    "%s: error: it is another map than %s: scene, settings, view, program, machine or photons differ",
                    path, first_path);
        return AG_ERROR_INPUT;
    }
    if (photon_merge(&into->global, &from->global, &added, &irradiance_photon) != PHOTON_MERGE_DONE) {
        log_message(context->log, AG_LOG_ERROR,
                    "%s: error: irradiance %u is another one than in the files before: one of them is damaged", path,
                    irradiance_photon);
        return AG_ERROR_INPUT;
    }
    log_message(context->log, AG_LOG_INFO, "%s: %llu irradiances added", path, (unsigned long long)added);
    return AG_OK;
}

static ag_status add(ag_context *context, const char *first_path, read_map *into, const char *path)
{
    read_map m;
    ag_status status = read_map_open(context, path, &m);
    if (status == AG_OK)
        status = take_irradiances(context, first_path, into, path, &m);
    read_map_reset(&m);
    return status;
}

typedef struct write_job {
    const ag_context *context;
    const read_map *map;
} write_job;

static int fill(void *user, int descriptor)
{
    const write_job *job = user;
    return photon_file_write(&job->context->run, descriptor, &job->map->key, &job->map->global, &job->map->caustic);
}

static ag_status write_map(ag_context *context, const char *path, const read_map *map)
{
    char message[1024];
    write_job job = {context, map};
    ag_status status = atomic_file_write_by(&context->run, path, fill, &job, message, sizeof message);
    if (status == AG_OK)
        return AG_OK;
    if (run_is_cancelled(&context->run))
        return AG_CANCELLED;
    log_message(context->log, AG_LOG_ERROR, "%s", message);
    return status;
}

/* merged: reset by the caller, whatever is returned. */
static ag_status merge_files(ag_context *context, const char *out_path, const char *const *paths, size_t count,
                             read_map *merged)
{
    bool is_sound = false;
    AG_TRY(check_output(context, out_path, &is_sound));
    AG_TRY(read_map_open(context, paths[0], merged));
    for (size_t i = 1; i < count; i++)
        AG_TRY(add(context, paths[0], merged, paths[i]));
    if (is_sound && !is_one_of(out_path, paths, count)) { /* nothing that it holds is lost */
        AG_TRY(add(context, paths[0], merged, out_path));
    }
    return write_map(context, out_path, merged);
}

ag_status ag_photon_map_merge_fill(ag_context *context, const char *out_path, const char *const *paths, size_t count,
                                   void *out_info, size_t struct_size)
{
    if (!context || !out_path || !paths || count == 0)
        return AG_ERROR_ARGUMENT;
    read_map merged = {0};
    ag_status status = merge_files(context, out_path, paths, count, &merged);
    if (status == AG_OK && out_info) {
        ag_photon_map_info info = info_of(&merged);
        info.damaged = 0;
        public_struct_write_part(&info, sizeof info, out_info, struct_size);
    }
    read_map_reset(&merged);
    return status;
}
