/* photon_memory.c: the program afterglow-photon-memory: what a photon map of so many photons takes, once built and at
 * the peak on the way there, and how much time; nothing else is in the process, no picture and no OpenImageIO. As CSV.
 * Flow: memory.sh -> [here]. Threads: its own pool. */
#include "bench/room_bench.h"
#include "clock.h"
#include "pbrt/pbrt_parser.h"

#include <stdio.h>
#include <stdlib.h>

static ag_status measure(run_context *run, const char *path, uint32_t count)
{
    scene *s = scene_create();
    ag_status status = s ? pbrt_parse_file(run, path, s) : AG_ERROR_MEMORY;
    if (status == AG_OK)
        status = scene_commit(s, run, NULL);
    photon_set set = {0};
    photon_map map = {0};
    uint64_t peak_before = peak_memory_bytes();
    double begin = clock_process_cpu_seconds(), traced = 0.0, built = 0.0;
    if (status == AG_OK) {
        photon_tracing_settings tracing = {.kind = PHOTON_GLOBAL, .wanted = count, .max_scatterings = 98};
        status = photon_tracing_run(s, run, &tracing, &set);
        traced = clock_process_cpu_seconds();
    }
    if (status == AG_OK) {
        photon_map_settings settings = {.nearest = 50, .surface_area = s->surface_area, .surfaces = s};
        status = photon_map_create(run, &set, &settings, 0.0, 1.0, &map);
        built = clock_process_cpu_seconds();
    }
    if (status == AG_OK && map.set.count > 0) {
        double each = 1.0 / map.set.count;
        printf("%u,%.3f,%.3f,%.6f,%.6f\n", map.set.count, (double)photon_map_bytes(&map) * each,
               (double)(peak_memory_bytes() - peak_before) * each, (traced - begin) * each * 1e6,
               (built - traced) * each * 1e6);
    }
    photon_set_reset(&set);
    photon_map_reset(&map);
    scene_destroy(s);
    return status;
}

int main(int argc, char **argv)
{
    char *end = NULL;
    unsigned long count = argc == 4 ? strtoul(argv[2], &end, 10) : 0, threads = 0;
    bool is_good = count >= 1 && count <= UINT32_MAX && *end == '\0';
    if (is_good)
        threads = strtoul(argv[3], &end, 10);
    if (!is_good || *end != '\0' || threads > 4096) {
        fputs(
            "usage: afterglow-photon-memory SCENE.pbrt PHOTONS THREADS\n"
            "Prints: photons, bytes each once built, bytes each at the peak, CPU microseconds each of tracing, of the "
            "map. THREADS 0: all.\n",
            stderr);
        return 2;
    }
    thread_pool *pool = NULL;
    log_sink *log = log_create(room_bench_say, NULL);
    ag_status status = log ? thread_pool_create((unsigned)threads, &pool) : AG_ERROR_MEMORY;
    if (status == AG_OK) {
        run_context run;
        run_context_init(&run, pool, log, NULL, NULL);
        status = measure(&run, argv[1], (uint32_t)count);
        run_context_reset(&run);
    }
    thread_pool_destroy(pool);
    log_destroy(log);
    if (status != AG_OK)
        fprintf(stderr, "afterglow-photon-memory: error: %s\n", ag_status_text(status));
    return status == AG_OK ? 0 : 1;
}
