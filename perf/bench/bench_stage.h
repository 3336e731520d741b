/* bench_stage.h: a scene of afterglow-bench made ready: what the units of its phases work on, the same for all numbers
 * of threads. Flow: bench_scenes -> [here] -> bench_phases. Threads: made by one caller; in use by one at a time. */
#ifndef AFTERGLOW_BENCH_STAGE_H
#define AFTERGLOW_BENCH_STAGE_H

#include "bench/bench_scenes.h"
#include "irradiance_cache.h"
#include "rendering.h"

typedef struct bench_stage {
    bench_scene which;
    const bench_work *work; /* borrowed */
    ag_scene *scene;
    ag_render_settings frame, shading;
    photon_set photons; /* of the global map, as traced */
    photon_map_settings map_settings;
    photon_map map;            /* of the photons; all irradiances are ready, but while phase "estimates" is at work */
    scene_ray *rays;           /* [work->rays], by the cosine from photons' positions */
    uint32_t met_count;        /* rays that meet a surface */
    float *distances;          /* [work->rays]: how far they go */
    irradiance_query *queries; /* [query_count]: where they end near a photon */
    uint32_t query_count;
    rgb *irradiance; /* [query_count] */
    bool *holds;     /* [query_count] */
    float *colors;   /* [3 work->color_pixels]: a frame's, over and over */
    float *shown;    /* [3 work->color_pixels] */
    uint32_t *words; /* of the slots of the largest map */
    uint32_t word_count;
} bench_stage;

/* To be reset, on failure too. The context is not kept. Errors: those of ag_scene_load, ag_render,
 * photon_tracing_run. */
ag_status bench_stage_create(bench_scene which, const bench_work *work, ag_context *context, bench_stage *out_stage);
void bench_stage_reset(bench_stage *stage);

/* The settings by which photons of that kind are traced. */
photon_tracing_settings bench_stage_tracing(const bench_stage *stage, photon_kind kind);

#endif
