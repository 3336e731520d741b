/* room_bench.c: see room_bench.h. */
#define _GNU_SOURCE
#include "room_bench.h"

#include "pbrt_parser.h"
#include "room_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { ROOM = 20 };
static const float RADIUS = 3.0f;

void room_bench_say(void *user, ag_log_level level, const char *message)
{
    (void)user;
    if (level <= AG_LOG_WARNING)
        fprintf(stderr, "%s\n", message);
}

static ag_status parse(run_context *run, const char *path, scene **out_scene)
{
    *out_scene = scene_create();
    return *out_scene ? pbrt_parse_file(run, path, *out_scene) : AG_ERROR_MEMORY;
}

static ag_status parse_room(run_context *run, scene **out_scene)
{
    char path[] = "/tmp/afterglow-room-XXXXXX";
    room_sphere spheres[ROOM_COUNT];
    int file = mkstemp(path);
    if (file < 0)
        return AG_ERROR_OUTPUT;
    close(file);
    ag_status status = room_layout_place(ROOM_SEED, spheres);
    if (status == AG_OK)
        status = room_file_write(path, spheres, ROOM, ROOM_BENCH_GATHER_RAYS);
    if (status == AG_OK)
        status = parse(run, path, out_scene);
    unlink(path);
    return status;
}

ag_status room_bench_load(run_context *run, const char *path, scene **out_scene)
{
    *out_scene = NULL;
    ag_status status = path ? parse(run, path, out_scene) : parse_room(run, out_scene);
    return status == AG_OK ? scene_commit(*out_scene, run, NULL) : status;
}

ag_status room_bench_map(run_context *run, const scene *s, photon_map *out_map)
{
    photon_set set = {0};
    photon_tracing_settings tracing = {.kind = PHOTON_GLOBAL, .wanted = ROOM_PHOTON_COUNT, .max_scatterings = 98};
    ag_status status = photon_tracing_run(s, run, &tracing, &set);
    photon_map_settings settings = {
        .nearest = ROOM_BENCH_NEAREST, .max_radius = RADIUS, .surface_area = s->surface_area, .surfaces = s};
    return status == AG_OK ? photon_map_create(run, &set, &settings, 0.0, 1.0, out_map) : status;
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

double room_bench_median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, by_value);
    return values[count / 2];
}
