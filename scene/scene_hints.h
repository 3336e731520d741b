/* scene_hints.h: hints of a scene file about its picture: size, film, samples, filter, and integrator. The scene
 * itself depends on none of it; the renderer's settings begin with what is given here.
 * Flow: readers, which have checked all ranges -> [here] -> render_settings, pixel_filter. Threads: as the scene. */
#ifndef AFTERGLOW_SCENE_HINTS_H
#define AFTERGLOW_SCENE_HINTS_H

#include "text/file_location.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct integer_hint {
    bool is_given;
    int64_t value;
} integer_hint;

typedef struct float_hint {
    bool is_given;
    float value;
} float_hint;

typedef enum filter_kind { FILTER_GAUSSIAN, FILTER_BOX, FILTER_TRIANGLE, FILTER_MITCHELL, FILTER_SINC } filter_kind;

/* The pixel filter. Each kind reads its radius and its own numbers. */
typedef struct filter_hint {
    filter_kind kind;
    float radius[2];     /* pixels, x and y, (0, 64] */
    float sigma;         /* gaussian: pixels, above 0 */
    float b, c;          /* mitchell */
    float tau;           /* sinc: lobes, above 0 */
    file_location where; /* of what asks for it, for messages */
} filter_hint;

/* The values of the first surface that pixels keep beside their colour, and their space. */
typedef enum surface_layers_hint {
    SURFACE_LAYERS_NONE,
    SURFACE_LAYERS_CAMERA,
    SURFACE_LAYERS_WORLD
} surface_layers_hint;

typedef struct scene_hints {
    integer_hint width, height; /* pixels, 1 to 65536 */
    bool has_crop_window;
    double crop_window[4];  /* x0, x1, y0, y1 as fractions of the picture, within [0, 1], not empty */
    char *file_name;        /* of the picture; owned; NULL: none */
    bool has_float_samples; /* 32 bits for each value of an EXR file instead of 16 */
    surface_layers_hint surface_layers;
    float iso;                /* above 0; 100: the light as it is */
    float_hint white_balance; /* kelvin, 1000 to 25000, or 0: none */
    float max_component;      /* a sample's largest value, above 0; 0: no bound */

    bool has_sampler;               /* the samples are the file's, not a reader's default */
    integer_hint samples_per_pixel; /* 1 to 2^20 */
    integer_hint seed;
    bool disable_pixel_jitter; /* samples in the middle of pixel, lens and shutter */
    filter_hint filter;

    bool is_for_photon_map;                          /* whoever wrote the file had our integrator in mind */
    integer_hint photon_count, caustic_photon_count; /* below 2^32 - 1; the first is at least 1 */
    integer_hint nearest;                            /* photons of an estimate, 1 to 65536 */
    float_hint radius;                               /* m, of an estimate at most; 0: automatic */
    integer_hint gather_samples;                     /* 1 to 65536 */
    integer_hint max_depth;                          /* 0 to 100 */
} scene_hints;

/* Returns hints without any value but the filter, which is pbrt-v4's default, a Gaussian of radius 1.5 and sigma 0.5
 * pixels. */
scene_hints scene_hints_default(void);
void scene_hints_reset(scene_hints *hints); /* frees what it holds */

#endif
