/* camera_sample.h: a camera sample that an integrator is asked for: its ray, its random numbers, how it is split.
 * Flow: render_tiles -> [here] -> integrators. Threads: a value. */
#ifndef AFTERGLOW_CAMERA_SAMPLE_H
#define AFTERGLOW_CAMERA_SAMPLE_H

#include "film/eye_sample.h"
#include "integrator/sampler.h"
#include "rays/ray.h"

typedef struct camera_sample {
    scene_ray ray; /* of unit direction */
    sampler where; /* keys its random numbers */
    split_counts split;
    bool is_further; /* one of the split's further camera rays, not the sample's own */
    uint32_t number; /* among the worker's samples under way: gather_batch keeps its gathered light by it */
} camera_sample;

#endif
