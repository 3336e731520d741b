/* scaling_simulation_program.c: the program afterglow-scaling-simulation: how the rendering of a frame would scale to
 * so many workers, from the statistics of a run on one thread: scheduling and slots alone, without what more workers do
 * to caches and memory. CSV; rows beyond this machine's processors are marked as extrapolations. Use: afterglow -t 1
 * --stats one.json ...; afterglow-scaling-simulation one.json [SPREAD]. Flow: [here]. Threads: one. */
#include "bench/scaling_simulation.h"
#include "cpu_count.h"

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

/* Costs that no statistics tell: a cache line that another core has written, and an addition that all cores make. */
static const double CLAIM_S = 100e-9, TILE_CLAIM_S = 200e-9;

static double number_at(const json_t *root, const char *group, const char *name)
{
    return json_number_value(json_object_get(json_object_get(root, group), name));
}

static bool read_frame(const char *path, double spread, simulated_frame *out)
{
    json_error_t error;
    json_t *root = json_load_file(path, 0, &error);
    if (!root) {
        fprintf(stderr, "%s:%d:%d: error: %s\n", path, error.line, error.column, error.text);
        return false;
    }
    double requests = number_at(root, "irradiance", "requests"), computed = number_at(root, "irradiance", "computed");
    double estimates_s = number_at(root, "irradiance", "estimate_s"), all_s = number_at(root, "phase_cpu_s", "render");
    int width = (int)number_at(root, "image", "width"), height = (int)number_at(root, "image", "height");
    bool is_of_one = json_integer_value(json_object_get(root, "threads")) == 1;
    json_decref(root);
    if (!is_of_one || !(requests >= 1.0) || !(computed >= 1.0) || width < 1 || height < 1 || !(all_s > estimates_s)) {
        fprintf(stderr,
                "%s: error: these are not the statistics of a picture with irradiance on demand on one thread\n", path);
        return false;
    }
    *out = (simulated_frame){.width = width,
                             .height = height,
                             .requests_per_pixel = requests / ((double)width * height),
                             .photons = simulation_photons((uint64_t)requests, (uint64_t)computed),
                             .own_s = (all_s - estimates_s) / requests,
                             .estimate_s = estimates_s / computed,
                             .claim_s = CLAIM_S,
                             .tile_claim_s = TILE_CLAIM_S,
                             .tile_spread = spread};
    return true;
}

int main(int argc, char **argv)
{
    char *end = NULL;
    double spread = argc == 3 ? strtod(argv[2], &end) : 0.3;
    if (argc < 2 || argc > 3 || (end && *end) || !(spread >= 0.0 && spread <= 1.0)) {
        fputs("usage: afterglow-scaling-simulation STATS.json [SPREAD]\n"
              "STATS.json: of afterglow -t 1 --stats. SPREAD: of the tiles' costs, deviation over mean, [0, 1]; 0.3.\n",
              stderr);
        return 2;
    }
    simulated_frame frame;
    simulated_run one = {0}, run;
    if (!read_frame(argv[1], spread, &frame))
        return 1;
    puts("workers,seconds,speedup,efficiency,computed,deferred,waited,waiting_share,idle_share,kind");
    for (unsigned workers = 1; workers <= SIMULATION_WORKERS_MAX; workers *= 2) {
        ag_status status = simulation_run(&frame, workers, &run);
        if (status != AG_OK) {
            fprintf(stderr, "afterglow-scaling-simulation: error: %s\n", ag_status_text(status));
            return 3;
        }
        if (workers == 1)
            one = run;
        double all_s = run.seconds * workers;
        printf("%u,%.6f,%.2f,%.3f,%llu,%llu,%llu,%.2e,%.3f,%s\n", workers, run.seconds, one.seconds / run.seconds,
               one.seconds / all_s, (unsigned long long)run.computed, (unsigned long long)run.deferred,
               (unsigned long long)run.waited, run.waiting_s / all_s, run.idle_s / all_s,
               workers <= cpu_count_available() ? "simulation" : "extrapolation");
    }
    return 0;
}
