/* aov.h: what the film sums for the layers that are asked for, and the channels of a file that they become; which
 * layers there are is in layer_table. Flow: settings, layer_table -> [here] -> film, files. Threads: read-only once
 * made. */
#ifndef AFTERGLOW_AOV_H
#define AFTERGLOW_AOV_H

#include "afterglow/afterglow.h"
#include "film/cryptomatte.h"
#include "film/eye_sample.h"

/* The values that are summed over a pixel's samples: those of SAMPLE_VALUE_LIST and FIRST_HIT_LIST (eye_sample.h), in
 * rows as they stand there, and others, each with its number of channels and whether the sum alone needs what the
 * camera ray meets first. SUM_RADIANCE is always there, and at 0; of SUM_GROUPS there are 3 channels for each light
 * group, and 3 for what came through the photon map. */
#define FILM_SUM_LIST(X, OF_SAMPLE, OF_HIT)                                                                            \
    X(SUM_RADIANCE, 3, false)                                                                                          \
    SAMPLE_VALUE_LIST(OF_SAMPLE)                                                                                       \
    X(SUM_HITS, 1, true) /* the ray met a surface */                                                                   \
    X(SUM_PARTS, 3 * LIGHT_PART_COUNT, false)                                                                          \
    X(SUM_GROUPS, 0, false)                                                                                            \
    FIRST_HIT_LIST(OF_HIT)                                                                                             \
    X(SUM_SQUARES, 3, false)       /* squares of samples as the film develops them */                                  \
    X(SUM_DEVELOPED, 3, false)     /* these samples themselves */                                                      \
    X(SUM_HIT_SQUARES, 3, false)   /* squares of samples that met a surface: pbrt's Variance */                        \
    X(SUM_HIT_DEVELOPED, 3, false) /* these samples themselves */

typedef enum film_sum {
#define FILM_SUM_ENUM(sum, width, needs_first_hit)            sum,
#define SAMPLE_VALUE_ENUM(sum, type, member, needs_first_hit) sum,
    FILM_SUM_LIST(FILM_SUM_ENUM, SAMPLE_VALUE_ENUM, SAMPLE_VALUE_ENUM)
#undef FILM_SUM_ENUM
#undef SAMPLE_VALUE_ENUM
        FILM_SUM_COUNT
} film_sum;

/* The value that a channel of a file is made of. */
typedef enum channel_source {
    CHANNEL_BEAUTY,            /* component of the picture itself */
    CHANNEL_COLOR,             /* a radiance: component of its mean, developed as the beauty */
    CHANNEL_MEAN,              /* over all samples */
    CHANNEL_HIT_MEAN,          /* over those that met a surface */
    CHANNEL_DIRECTION,         /* normalised */
    CHANNEL_ABSOLUTE,          /* the hit mean's absolute value */
    CHANNEL_VARIANCE,          /* of the samples, not of their mean; sum: SUM_SQUARES or SUM_HIT_SQUARES */
    CHANNEL_RELATIVE_VARIANCE, /* that over the samples' mean */
    CHANNEL_SAMPLES,           /* the number of the pixel's samples */
    CHANNEL_DEPTH,             /* of film_nearest, as the next two */
    CHANNEL_OBJECT,
    CHANNEL_MATERIAL,
    CHANNEL_VIEW,           /* component: of film_view */
    CHANNEL_CRYPTO_ID,      /* component: rank + CRYPTOMATTE_RANKS * cryptomatte_kind */
    CHANNEL_CRYPTO_COVERAGE /* component: likewise */
} channel_source;

/* A value of a pixel as a whole: views of the photon map (debug_views.h), and how long its tile took. */
typedef enum film_view {
    VIEW_PHOTON_DENSITY,
    VIEW_CACHE_STATE,
    VIEW_PHOTON_DISTANCE,
    VIEW_GATHER_DISTANCE,
    VIEW_TILE_TIME,
    FILM_VIEW_COUNT
} film_view;

typedef struct film_channel {
    char name[64];
    channel_source source;
    film_sum sum;  /* that it is read from, of sources that read one */
    int component; /* see channel_source; of others 0 to 2 of a colour, direction or point */
    int offset;    /* of its component 0 among the pixel's sums */
    bool is_exact; /* floats in every file: half would spoil it */
} film_channel;

typedef struct aov_layout {
    uint32_t layers;            /* AG_LAYER_... */
    int offset[FILM_SUM_COUNT]; /* -1: not summed */
    int sum_count;              /* channels that are summed */
    int group_count;
    const char *const *group_names; /* borrowed */
    film_channel *channels;         /* owned; R, G, B first */
    int channel_count;
    bool has_view[FILM_VIEW_COUNT], has_matte[CRYPTOMATTE_KIND_COUNT];
    bool needs_layers; /* of each sample: more than its radiance */
    bool needs_first_hit, needs_nearest;
} aov_layout;

/* The sums that are needed even where they become no channels. */
typedef struct aov_needs {
    bool albedo_and_normal; /* for denoising */
    bool variance;          /* for adaptive sampling */
} aov_needs;

/* Lays out sums and channels of these layers (AG_LAYER_...), but for path tracing (is_path) those of the photon map.
 * group_names: of the scene's light groups, [group_count], the first "default"; borrowed as long as the layout is used.
 * Errors: AG_ERROR_MEMORY. */
ag_status aov_layout_create(uint32_t layers, aov_needs also, bool is_path, const char *const *group_names,
                            int group_count, aov_layout *out_layout);
void aov_layout_reset(aov_layout *layout);

static inline bool aov_has(const aov_layout *layout, film_sum sum) { return layout->offset[sum] >= 0; }

#endif
