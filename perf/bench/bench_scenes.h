/* bench_scenes.h: the three scenes of afterglow-bench, written by code, and how much work each size is. A change of
 * anything here is another benchmark: BENCH_FORMAT goes up. Flow: [here] -> bench_stage. Threads: one. */
#ifndef AFTERGLOW_BENCH_SCENES_H
#define AFTERGLOW_BENCH_SCENES_H

#include "afterglow/base.h"

#include <stdint.h>

enum { BENCH_FORMAT = 1 };

typedef enum bench_scene {
    BENCH_SCENE_ROOM,     /* room 20 of the paper: diffuse spheres in a closed box */
    BENCH_SCENE_INTERIOR, /* sun and sky through two glazed windows, shelves of books */
    BENCH_SCENE_GLASS,    /* glass, metal, and their caustics */
    BENCH_SCENE_COUNT
} bench_scene;

const char *bench_scene_name(bench_scene which);

/* The scene as a file in the pbrt-v4 format, in memory: its descriptor, to be closed, whose name is
 * /proc/self/fd/DESCRIPTOR. Errors: AG_ERROR_SYSTEM, AG_ERROR_OUTPUT. */
ag_status bench_scene_open(bench_scene which, int *out_descriptor);

typedef enum bench_size { BENCH_QUICK, BENCH_SMALL, BENCH_LARGE, BENCH_SIZE_COUNT } bench_size;

const char *bench_size_name(bench_size size);

/* The work of one unit of each phase, and how long phases are measured. */
typedef struct bench_work {
    uint32_t photons;                           /* in the global map, and where there are caustics as many in theirs */
    uint32_t rays;                              /* cast one by one; where they end irradiance is looked up */
    int frame_side;                             /* pixels of a frame in width and height */
    int gather_rays;                            /* a pixel */
    int shading_side;                           /* pixels of the path traced picture, direct light alone */
    int shading_samples;                        /* a pixel */
    uint32_t color_pixels;                      /* put through the default view */
    uint64_t arithmetic_units;                  /* for each thread */
    uint64_t stream_bytes, stream_thread_bytes; /* in all, and for each thread besides */
    unsigned stream_passes;
    unsigned turns; /* that all phases take, one after the other, on all numbers of threads */
    double turn_s;  /* units of a phase are repeated for so long in each turn; turns * turn_s >= 2 */
} bench_work;

const bench_work *bench_work_of(bench_size size);

#endif
