/* map_file.c: see map_file.h.
 * Rests on: flock(2) on a file beside the map's, NAME.lock, which is there only while somebody traces; the kernel drops
 * the lock of a process that ends. Threads: one of each process. */
#define _GNU_SOURCE
#include "map_file.h"

#include "atomic_file.h"
#include "descriptor.h"
#include "scene_hash.h"
#include "settings_table.h"
#include "status.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>
#if defined(__x86_64__) || defined(__i386__)
#include <cpuid.h>
#endif

enum { POLL_NANOSECONDS = 20000000 };

#if defined(__clang__)
#define COMPILER "clang " __clang_version__
#else
#define COMPILER "gcc " __VERSION__
#endif

/* --- what the photons depend on --- */

/* Kind and maker of the processor, and what rays are traced with: other ones may give other bits. */
static void describe_machine(const char *isa, char *out, size_t size)
{
    struct utsname system;
    char maker[13] = "";
#if defined(__x86_64__) || defined(__i386__)
    unsigned level, words[3];
    if (__get_cpuid(0, &level, &words[0], &words[2], &words[1])) /* EBX, EDX, ECX spell the name */
        memcpy(maker, words, sizeof words);
#endif
    if (uname(&system) != 0)
        snprintf(system.machine, sizeof system.machine, "unknown");
    snprintf(out, size, "%.20s %s %s", system.machine, maker, isa);
}

/* Errors: those of context_estimates. */
static ag_status make_key(ag_context *context, const scene *s, const ag_render_settings *settings,
                          photon_file_key *out_key)
{
    photon_file_key key;
    memset(&key, 0, sizeof key);
    AG_TRY(context_estimates(context, &key.estimates));
    key.scene = scene_hash_of_light(s);
    size_t length = settings_of_photon_map(settings, key.settings, sizeof key.settings);
    assert(length < sizeof key.settings);
    (void)length;
    if (settings->photon_aim > 0.0f) {
        hash128 view = hash128_begin();
        hash128 of_scene = scene_hash_of_view(s);
        double frame_aspect = (double)settings->width / (double)settings->height;
        HASH128_ADD(&view, of_scene);
        HASH128_ADD(&view, frame_aspect);
        key.aim_view = view;
    }
    snprintf(key.program, sizeof key.program, "%s, %.30s", ag_version(), COMPILER);
    describe_machine(context->isa, key.machine, sizeof key.machine);
    *out_key = key;
    return AG_OK;
}

/* --- one traces --- */

typedef struct trace_lock {
    char *path;
    int descriptor; /* -1: none is held */
} trace_lock;

/* False: somebody else has it, or errno says why it cannot be had. */
static bool try_lock(trace_lock *lock)
{
    struct stat ours, named;
    int descriptor = open(lock->path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NOCTTY, 0666);
    descriptor = descriptor_beyond_standard(descriptor);
    if (descriptor < 0)
        return false;
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) {
        /* the one before us takes the name away: ours may be a file without a name, and another's have it */
        if (fstat(descriptor, &ours) == 0 && stat(lock->path, &named) == 0 && ours.st_ino == named.st_ino &&
            ours.st_dev == named.st_dev) {
            lock->descriptor = descriptor;
            return true;
        }
        errno = EWOULDBLOCK;
    }
    int error = errno;
    close(descriptor);
    errno = error == EINTR ? EWOULDBLOCK : error;
    return false;
}

static void unlock(trace_lock *lock)
{
    if (lock->descriptor >= 0) {
        unlink(lock->path);
        close(lock->descriptor);
    }
    free(lock->path);
    *lock = (trace_lock){.descriptor = -1};
}

/* --- obtaining --- */

typedef struct map_request {
    ag_context *context;
    const ag_render_settings *settings;
    photon_file_key key;
} map_request;

typedef struct opened_maps {
    photon_file file;
    photon_map global, caustic;
} opened_maps;

/* AG_OK with *out_is_open false: there is none, or one that is to be traced anew. */
static ag_status open_file(const map_request *r, opened_maps *out, bool *out_is_open)
{
    log_sink *log = r->context->log;
    const char *path = r->settings->photon_map_file;
    char why[512];
    *out_is_open = false;
    const phase_begin begin = context_begin_phase();
    const photon_file_result opened =
        photon_file_open(&r->context->run, path, &r->key, &out->file, &out->global, &out->caustic, why, sizeof why);
    context_add_to_phase(r->context, AG_PHASE_MAP, begin);
    switch (opened) {
    case PHOTON_FILE_OPEN:
        *out_is_open = true;
        if (out->file.damaged > 0)
            log_message(log, AG_LOG_WARNING, "'%s': %u irradiances in the map were damaged, and are computed again",
                        path, out->file.damaged);
        if (!out->file.is_shared)
            log_message(log, AG_LOG_WARNING, "'%s': the map is used, but what is computed is not kept: %s", path, why);
        return AG_OK;
    case PHOTON_FILE_ABSENT: return AG_OK;
    case PHOTON_FILE_REFUSED:
        if (r->settings->photon_map_refresh) {
            log_message(log, AG_LOG_INFO, "'%s': the map is traced anew: %s", path, why);
            return AG_OK;
        }
        log_message(log, AG_LOG_ERROR, "'%s': the map does not fit: %s (--photon-map-refresh replaces it)", path, why);
        return AG_ERROR_INPUT;
    case PHOTON_FILE_FOREIGN:
        log_message(log, AG_LOG_ERROR, "'%s': it is no photon map, and is never replaced by one: give another name",
                    path);
        return AG_ERROR_INPUT;
    case PHOTON_FILE_FAILED: log_message(log, AG_LOG_ERROR, "'%s': %s", path, why); return AG_ERROR_INPUT;
    case PHOTON_FILE_CANCELLED: break;
    }
    return AG_CANCELLED;
}

/* Opens the file that somebody else has made, or gets the right to make it. */
static ag_status open_or_lock(const map_request *r, trace_lock *lock, opened_maps *out, bool *out_is_open)
{
    const struct timespec poll = {0, POLL_NANOSECONDS};
    bool is_told = false;
    for (;;) {
        ag_status status = open_file(r, out, out_is_open);
        if (status != AG_OK || *out_is_open || lock->descriptor >= 0)
            return status;
        while (!try_lock(lock)) {
            if (errno != EWOULDBLOCK) {
                log_message(r->context->log, AG_LOG_ERROR, "cannot write '%s': %s", lock->path, strerror(errno));
                return AG_ERROR_OUTPUT;
            }
            if (!is_told)
                log_message(r->context->log, AG_LOG_WARNING, "'%s': another process traces the map: waiting for it",
                            r->settings->photon_map_file);
            is_told = true;
            if (run_is_cancelled(&r->context->run))
                return AG_CANCELLED;
            nanosleep(&poll, NULL);
        }
        /* the file may have been made just before the lock was free, so it is looked for once more */
    }
}

typedef struct write_job {
    const map_request *request;
    const photon_map *global, *caustic;
} write_job;

static int fill(void *user, int descriptor)
{
    const write_job *job = user;
    return photon_file_write(&job->request->context->run, descriptor, &job->request->key, job->global, job->caustic);
}

static ag_status write_file(const map_request *r, const photon_map *global, const photon_map *caustic)
{
    char message[1024];
    write_job job = {r, global, caustic};
    ag_status status =
        atomic_file_write_by(&r->context->run, r->settings->photon_map_file, fill, &job, message, sizeof message);
    if (status != AG_OK && run_is_cancelled(&r->context->run))
        return AG_CANCELLED;
    if (status != AG_OK)
        log_message(r->context->log, AG_LOG_ERROR, "%s", message);
    return status;
}

/* Counts the photons as if they had just been traced, but not their rays. */
static void count_photons(ag_context *context, const opened_maps *maps)
{
    ag_statistics *statistics = &context->statistics;
    statistics->photons_emitted += maps->global.set.emitted_paths + maps->caustic.set.emitted_paths;
    statistics->photons_stored_global += maps->global.set.count;
    statistics->photons_stored_caustic += maps->caustic.set.count;
    for (int phase = AG_PHASE_PHOTONS; phase <= AG_PHASE_MAP; phase++) {
        run_progress(&context->run, (ag_phase)phase, 0.0);
        run_progress(&context->run, (ag_phase)phase, 1.0);
    }
}

/* Traced maps become those of their own file; where that cannot be had (it was replaced at once, or may not be mapped)
 * they stay as they are: the picture is the same. */
static ag_status keep(const map_request *r, photon_map *global, photon_map *caustic, opened_maps *out)
{
    bool is_open = false;
    char why[512];
    ag_status status = write_file(r, global, caustic);
    if (status == AG_OK)
        is_open = photon_file_open(&r->context->run, r->settings->photon_map_file, &r->key, &out->file, &out->global,
                                   &out->caustic, why, sizeof why) == PHOTON_FILE_OPEN;
    if (status != AG_OK || is_open) {
        photon_map_reset(global);
        photon_map_reset(caustic);
    } else {
        *out = (opened_maps){.file = {.descriptor = -1, .guard = -1}, .global = *global, .caustic = *caustic};
    }
    return status;
}

ag_status map_file_obtain(ag_context *context, const scene *s, const ag_render_settings *settings,
                          map_file_trace *trace, photon_file *out_file, photon_map *out_global, photon_map *out_caustic)
{
    map_request r = {.context = context, .settings = settings};
    phase_begin begin = context_begin_phase();
    AG_TRY(make_key(context, s, settings, &r.key));
    context_add_to_phase(context, AG_PHASE_MAP, begin);
    trace_lock lock = {.descriptor = -1};
    if (asprintf(&lock.path, "%s.lock", settings->photon_map_file) < 0)
        return AG_ERROR_MEMORY;
    opened_maps maps;
    bool is_open;
    ag_status status = open_or_lock(&r, &lock, &maps, &is_open);
    if (status == AG_OK && is_open) {
        count_photons(context, &maps);
        context->statistics.map_file = maps.file.is_shared ? AG_MAP_FILE_OPENED : AG_MAP_FILE_PRIVATE;
        log_message(context->log, AG_LOG_INFO, "'%s': a map of %u and %u photons", settings->photon_map_file,
                    maps.global.set.count, maps.caustic.set.count);
    } else if (status == AG_OK) {
        photon_map global, caustic;
        status = trace(context, s, settings, &global, &caustic);
        if (status == AG_OK) {
            begin = context_begin_phase();
            status = keep(&r, &global, &caustic, &maps);
            context_add_to_phase(context, AG_PHASE_MAP, begin);
        }
        context->statistics.map_file = AG_MAP_FILE_TRACED;
    }
    unlock(&lock);
    if (status != AG_OK)
        return status;
    maps.global.surfaces = maps.caustic.surfaces = s;
    *out_file = maps.file;
    *out_global = maps.global;
    *out_caustic = maps.caustic;
    return AG_OK;
}

ag_status ag_photon_map_check(ag_context *context, const char *path)
{
    char message[1024];
    struct stat status;
    if (!context || !path)
        return AG_ERROR_ARGUMENT;
    if (stat(path, &status) == 0) {
        if (S_ISREG(status.st_mode))
            return AG_OK; /* what is in it is looked at when the scene is known */
        log_message(context->log, AG_LOG_ERROR, "'%s': a photon map is a regular file", path);
        return AG_ERROR_OUTPUT;
    }
    ag_status result = atomic_file_check(path, message, sizeof message);
    if (result != AG_OK)
        log_message(context->log, AG_LOG_ERROR, "%s", message);
    return result;
}
