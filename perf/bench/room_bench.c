/* room_bench.c: see room_bench.h. */
#define _GNU_SOURCE
#include "bench/room_bench.h"

#include "pbrt/pbrt_parser.h"
#include "rooms/room_file.h"

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

ag_status room_bench_trace(run_context *run, const scene *s, photon_set *out_set)
{
    photon_tracing_settings settings = {.kind = PHOTON_GLOBAL, .wanted = ROOM_PHOTON_COUNT, .max_scatterings = 98};
    return photon_tracing_run(s, run, &settings, out_set);
}

ag_status room_bench_map(run_context *run, const scene *s, photon_map *out_map)
{
    photon_set set = {0};
    ag_status status = room_bench_trace(run, s, &set);
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

void room_bench_report(const room_bench_row *rows, size_t count)
{
    printf("what,us,us_least,ratio,of,at_most,holds\n");
    for (const room_bench_row *row = rows; row < rows + count; row++) {
        double us[ROOM_BENCH_ROUNDS], ratios[ROOM_BENCH_ROUNDS];
        for (int r = 0; r < ROOM_BENCH_ROUNDS; r++) {
            us[r] = row->us[r];
            ratios[r] = row->us[r] / rows[row->rival].us[r];
        }
        double ratio = room_bench_median(ratios, ROOM_BENCH_ROUNDS), middle = room_bench_median(us, ROOM_BENCH_ROUNDS);
        printf("%s,%.4f,%.4f,%.3f,%s,", row->name, middle, us[0], ratio, rows[row->rival].name);
        if (row->most_ratio > 0.0)
            printf("%.3f,%s\n", row->most_ratio, ratio <= row->most_ratio ? "yes" : "no");
        else if (row->most_us > 0.0)
            printf("%.2f us,%s\n", row->most_us, middle <= row->most_us ? "yes" : "no");
        else
            printf(",\n");
    }
}
