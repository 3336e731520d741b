/* renderer_run.c: posix_spawnp, wait4; then the statistics by jansson and the picture by image_file.
 * CPU time and peak memory are the kernel's own account of the child, so a start-up cost cannot hide.
 * Flow: forty_rooms -> [here] -> forty_rooms. Threads: one caller at a time. */
#define _GNU_SOURCE /* wait4, environ */
#include "rooms/renderer_run.h"

#include "image/image_reader.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <spawn.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

/* Names the statistic of each column; a missing one is an error. */
typedef struct statistic {
    const char *group, *name; /* group NULL: at the top */
    result_column column;
} statistic;

static const statistic statistics[] = {
    {NULL, "threads", RESULT_THREADS},
    {"time_s", "load", RESULT_LOAD_S},
    {"time_s", "bvh", RESULT_BVH_S},
    {"time_s", "photons", RESULT_PHOTONS_S},
    {"time_s", "map", RESULT_MAP_S},
    {"time_s", "precompute", RESULT_PRECOMPUTE_S},
    {"time_s", "render", RESULT_RENDER_S},
    {"time_s", "write", RESULT_WRITE_S},
    {"time_s", "total", RESULT_TOTAL_S},
    {"irradiance", "requests", RESULT_REQUESTS},
    {"irradiance", "computed", RESULT_COMPUTED},
    {"irradiance", "distinct", RESULT_DISTINCT},
    {"irradiance", "deferred", RESULT_DEFERRED},
    {"irradiance", "waited", RESULT_WAITED},
    {"irradiance", "duplicated", RESULT_DUPLICATED},
    {"irradiance", "uncached", RESULT_UNCACHED},
    {"photons", "emitted", RESULT_EMITTED},
    {"photons", "stored_global", RESULT_STORED},
    {"photons", "bytes", RESULT_PHOTON_BYTES},
};

static double seconds(struct timeval time) { return (double)time.tv_sec + 1e-6 * (double)time.tv_usec; }

/* 0, or an errno where the program could not be started. */
static int spawn_renderer(const renderer_run_settings *settings, pid_t *out_child)
{
    char gather[16], threads[16];
    snprintf(gather, sizeof gather, "%d", settings->gather_samples);
    snprintf(threads, sizeof threads, "%d", settings->thread_count);
    const char *arguments[24];
    int count = 0;
    arguments[count++] = settings->program;
    arguments[count++] = "-q";
    arguments[count++] = "--progress";
    arguments[count++] = "none";
    arguments[count++] = "--only";
    arguments[count++] = "indirect";
    arguments[count++] = "--seed";
    arguments[count++] = "1";
    arguments[count++] = "--cache";
    arguments[count++] = cache_mode_text(settings->cache);
    arguments[count++] = "--gather-samples";
    arguments[count++] = gather;
    if (settings->thread_count > 0) {
        arguments[count++] = "--nthreads";
        arguments[count++] = threads;
    }
    arguments[count++] = "-o";
    arguments[count++] = settings->picture_path;
    arguments[count++] = "--stats";
    arguments[count++] = settings->stats_path;
    arguments[count++] = settings->scene_path;
    arguments[count] = NULL;
    /* posix_spawnp promises not to change the strings; its type is older than const. */
    char *plain_arguments[24];
    memcpy(plain_arguments, arguments, sizeof arguments);
    return posix_spawnp(out_child, settings->program, NULL, NULL, plain_arguments, environ);
}

static ag_status run_child(const renderer_run_settings *settings, struct rusage *out_usage)
{
    pid_t child;
    const int error = spawn_renderer(settings, &child);
    if (error != 0) {
        fprintf(stderr, "%s: error: %s\n", settings->program, strerror(error));
        return AG_ERROR_SYSTEM;
    }
    int wait_status = 0;
    pid_t ended;
    do {
        ended = wait4(child, &wait_status, 0, out_usage);
    } while (ended < 0 && errno == EINTR);
    if (ended < 0) {
        fprintf(stderr, "%s: error: %s\n", settings->program, strerror(errno));
        return AG_ERROR_SYSTEM;
    }
    if (WIFSIGNALED(wait_status)) {
        fprintf(stderr, "%s: error: %s was ended by signal %d\n", settings->scene_path, settings->program,
                WTERMSIG(wait_status));
        return AG_ERROR_SYSTEM;
    }
    if (WEXITSTATUS(wait_status) != 0) {
        fprintf(stderr, "%s: error: %s ended with exit code %d\n", settings->scene_path, settings->program,
                WEXITSTATUS(wait_status));
        return AG_ERROR_SYSTEM;
    }
    return AG_OK;
}

/* The member's number; NaN when there is none. */
static double number_at(const json_t *root, const char *group, const char *name)
{
    const json_t *parent = group == NULL ? root : json_object_get(root, group);
    const json_t *value = json_object_get(parent, name);
    return json_is_number(value) ? json_number_value(value) : NAN;
}

static ag_status read_statistics(const char *path, result_row *row)
{
    json_error_t error;
    json_t *root = json_load_file(path, 0, &error);
    if (root == NULL) {
        fprintf(stderr, "%s:%d:%d: error: %s\n", path, error.line, error.column, error.text);
        return AG_ERROR_INPUT;
    }
    ag_status status = AG_OK;
    for (size_t i = 0; i < sizeof statistics / sizeof statistics[0]; ++i) {
        const statistic *item = &statistics[i];
        row->values[item->column] = number_at(root, item->group, item->name);
        if (isnan(row->values[item->column])) {
            fprintf(stderr, "%s: error: it has no number %s%s%s\n", path, item->group == NULL ? "" : item->group,
                    item->group == NULL ? "" : ".", item->name);
            status = AG_ERROR_INPUT;
        }
    }
    /* estimate_s covers both kinds: those kept at photons, and those at the hits themselves. */
    const double estimate_count = row->values[RESULT_COMPUTED] + row->values[RESULT_UNCACHED];
    const double estimate_s = number_at(root, "irradiance", "estimate_s");
    if (estimate_count > 0.0 && estimate_s > 0.0) {
        row->values[RESULT_US_PER_ESTIMATE] = 1e6 * estimate_s / estimate_count;
    }
    json_decref(root);
    return status;
}

static ag_status read_picture(const char *path, renderer_picture *out_picture)
{
    char message[512] = "";
    image read;
    const ag_status status = image_read(path, &read, message, sizeof message);
    out_picture->width = read.width;
    out_picture->height = read.height;
    out_picture->channel_count = read.channel_count;
    out_picture->pixels = read.pixels;
    if (status != AG_OK) {
        fprintf(stderr, "%s: error: %s\n", path, message);
        return AG_ERROR_INPUT;
    }
    return AG_OK;
}

static size_t sample_count(const renderer_picture *picture)
{
    return (size_t)picture->width * (size_t)picture->height * (size_t)picture->channel_count;
}

static double picture_mean(const renderer_picture *picture)
{
    double sum = 0.0;
    const size_t count = sample_count(picture);
    for (size_t i = 0; i < count; ++i) {
        sum += (double)picture->pixels[i];
    }
    return sum / (double)count;
}

ag_status renderer_run(const renderer_run_settings *settings, result_row *out_row, renderer_picture *out_picture)
{
    *out_picture = (renderer_picture){0, 0, 0, NULL};
    out_row->mode = settings->cache;
    for (int column = 0; column < RESULT_COLUMN_COUNT; ++column) {
        out_row->values[column] = NAN;
    }

    /* An old file must not pass for a new one. */
    (void)remove(settings->picture_path);
    (void)remove(settings->stats_path);
    struct rusage usage;
    ag_status status = run_child(settings, &usage);
    if (status == AG_OK) {
        status = read_statistics(settings->stats_path, out_row);
    }
    if (status == AG_OK) {
        status = read_picture(settings->picture_path, out_picture);
    }
    if (status != AG_OK) {
        return status;
    }

    double *values = out_row->values;
    values[RESULT_CPU_S] = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    values[RESULT_PEAK_MB] = 1024e-6 * (double)usage.ru_maxrss; /* ru_maxrss is in units of 1024 bytes */
    values[RESULT_SUM_S] =
        values[RESULT_PHOTONS_S] + values[RESULT_MAP_S] + values[RESULT_PRECOMPUTE_S] + values[RESULT_RENDER_S];
    if (settings->cache != CACHE_OFF && values[RESULT_STORED] > 0.0) {
        values[RESULT_SHARE] = values[RESULT_COMPUTED] / values[RESULT_STORED];
    }
    values[RESULT_PICTURE_MEAN] = picture_mean(out_picture);
    return AG_OK;
}

void renderer_picture_reset(renderer_picture *picture)
{
    free(picture->pixels);
    *picture = (renderer_picture){0, 0, 0, NULL};
}

size_t renderer_picture_difference_count(const renderer_picture *a, const renderer_picture *b)
{
    const size_t pixel_count = (size_t)a->width * (size_t)a->height;
    if (a->width != b->width || a->height != b->height || a->channel_count != b->channel_count) {
        return pixel_count;
    }
    const size_t channel_count = (size_t)a->channel_count;
    size_t count = 0;
    for (size_t i = 0; i < pixel_count; ++i) {
        /* Compared as bytes: -0 and 0 count as different, as do two kinds of NaN. */
        const float *pixel_a = a->pixels + i * channel_count;
        const float *pixel_b = b->pixels + i * channel_count;
        count += memcmp(pixel_a, pixel_b, channel_count * sizeof *pixel_a) != 0;
    }
    return count;
}
