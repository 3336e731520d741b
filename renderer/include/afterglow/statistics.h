/* statistics.h: predictions of a picture's memory and time, and statistics of the work done.
 * Part of afterglow.h, which tells about threads and errors. */
#ifndef AFTERGLOW_PUBLIC_STATISTICS_H
#define AFTERGLOW_PUBLIC_STATISTICS_H

#include "afterglow/rendering.h"
#include "afterglow/structs.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Structs that the library writes begin with struct_size too, and the functions that write them get it from the
 * program, by the inline functions beside them: a program that was compiled with the headers of an older release gets
 * the members that it knows, and one with those of a newer release zeros in the members that the library does not know.
 * Later releases add members at the end. */

/* The predicted memory and time of a picture. */
typedef struct ag_prediction {
    size_t struct_size;
    /* Memory in bytes, without that of ag_film_denoise: */
    uint64_t memory_peak_bytes;   /* resident peak of the whole process; no less than its peak so far */
    uint64_t memory_needed_bytes; /* the largest sum of the following that is allocated at once */
    uint64_t memory_scene_bytes;  /* resident now: the program and the scene */
    uint64_t memory_photon_bytes; /* photon maps, and what is known of the space around the photons */
    uint64_t memory_thread_bytes; /* scratch memory of all threads */
    uint64_t memory_film_bytes;
    uint64_t memory_host_bytes; /* of the host itself, from ag_context_expect_host_memory */
    uint64_t memory_file_bytes; /* for writing a picture; photon maps and scratch memory are freed before */
    /* Time on this machine, if it is otherwise idle; 0: not predicted: */
    double time_s[AG_PHASE_COUNT];
    double time_total_s;            /* since the context was created */
    double cpu_s;                   /* of all threads */
    double samples_per_pixel;       /* average */
    uint64_t memory_optional_bytes; /* of memory_needed_bytes: what there is not where it cannot be had; the picture is
                                     * the same, but takes more time */
} ag_prediction;

/* Tells predictions how many bytes the host will allocate itself beside a rendering, for instance to show it, and has
 * not allocated yet; 0 at first. */
AG_API void ag_context_expect_host_memory(ag_context *context, uint64_t bytes);
/* Predicts memory alone, without rendering anything but, for the default number of photons, a few thousand rays; to be
 * called before ag_render. struct_size: of the program's
 * ag_prediction. Errors: those of ag_render. */
AG_API ag_status ag_predict_memory_fill(ag_context *context, const ag_scene *scene, const ag_render_settings *settings,
                                        void *out_prediction, size_t struct_size);
static inline ag_status ag_predict_memory(ag_context *context, const ag_scene *loaded,
                                          const ag_render_settings *settings, ag_prediction *out_prediction)
{
    return ag_predict_memory_fill(context, loaded, settings, out_prediction, sizeof *out_prediction);
}

/* Predicts time and memory. It traces photons, a million into each map at most, and where more are wanted half a
 * million before that, and renders a part of the picture's blocks of 8 x 8 pixels: half of them in small pictures, some
 * hundred in large ones. A photon map's file is neither read nor written. struct_size: of the program's ag_prediction.
 * Errors: those of ag_render. */
AG_API ag_status ag_predict_fill(ag_context *context, const ag_scene *scene, const ag_render_settings *settings,
                                 void *out_prediction, size_t struct_size);
static inline ag_status ag_predict(ag_context *context, const ag_scene *loaded, const ag_render_settings *settings,
                                   ag_prediction *out_prediction)
{
    return ag_predict_fill(context, loaded, settings, out_prediction, sizeof *out_prediction);
}

/* Writes the context's last prediction; memory_peak_bytes is 0 where there is none. struct_size: of the program's
 * ag_prediction. */
AG_API void ag_context_prediction_fill(const ag_context *context, void *out_prediction, size_t struct_size);
static inline ag_prediction ag_context_prediction(const ag_context *context)
{
    ag_prediction filled;
    ag_context_prediction_fill(context, &filled, sizeof filled);
    return filled;
}

/* The origin of a picture's photon map. */
typedef enum ag_map_file {
    AG_MAP_FILE_NONE,   /* traced, and not kept */
    AG_MAP_FILE_TRACED, /* traced, and kept */
    AG_MAP_FILE_OPENED, /* from the file, and filled further */
    AG_MAP_FILE_PRIVATE /* from a file that cannot be shared: a copy in memory, which is not written back */
} ag_map_file;

/* The reason why a picture ended, for render farms. */
typedef enum ag_end {
    AG_END_NONE,       /* not known */
    AG_END_SAMPLES,    /* pixels have all samples that the settings allow */
    AG_END_NOISE,      /* the noise level was reached everywhere before that */
    AG_END_PHOTONS,    /* only the photon map was requested */
    AG_END_TIME_LIMIT, /* its time limit was reached */
    AG_END_SIGNAL,     /* it was interrupted */
    AG_END_MEMORY,     /* it needs more memory than is free, or than is allowed */
    AG_END_DRY_RUN,    /* it was only predicted */
    AG_END_KEPT        /* a viewer stopped it and kept the picture so far */
} ag_end;

typedef struct ag_statistics {
    size_t struct_size;
    unsigned threads;
    uint64_t photons_emitted, photons_stored_global, photons_stored_caustic, photon_bytes;
    ag_map_file map_file; /* of the last picture */
    /* Of the irradiance cache. requests: points at which irradiance was requested; computed: estimates at photons;
     * distinct: photons whose slots became ready, counted in the slots afterwards, those of other processes that fill
     * the map included; deferred: requests set aside because another thread was computing; waited: those of them that
     * had to wait in the end; duplicated: estimates computed twice, 0 but where a claim of a map's file was taken over
     * from a thread that had stood still for seconds and then went on; uncached: estimates at gather hits themselves;
     * refused: requests at points where no estimate holds, whose light was followed by further bounces instead; ready:
     * photons that were ready before, in a file's map or from the frame before; reclaimed: claims taken over from
     * processes that had died, or from who had stood still for seconds. */
    uint64_t irradiance_requests, irradiance_computed, irradiance_distinct, irradiance_deferred, irradiance_waited,
        irradiance_duplicated, irradiance_uncached, irradiance_refused, irradiance_ready, irradiance_reclaimed;
    double irradiance_estimate_s; /* CPU seconds of estimates, all threads; extrapolated from every sixteenth */
    double irradiance_wait_s;     /* CPU seconds of waiting for other threads' estimates, all threads */
    /* Rays by purpose. camera: where samples choose how they are split they may have several each. estimate: cast by
     * estimates and lookups in the photon maps, to find where surfaces end and which photons are visible; those whose
     * answer is known are not cast, and the ray and the queries that find out what is near a leaf of a map, once for
     * each leaf, are not counted. */
    uint64_t rays_camera, rays_shadow, rays_gather, rays_photon, rays_path, rays_estimate;
    uint64_t samples_not_finite; /* camera samples dropped because a component was not finite: 0 */
    double time_s[AG_PHASE_COUNT];
    double phase_cpu_s[AG_PHASE_COUNT]; /* user + system time of the whole process during each phase */
    double time_total_s;                /* since the context was created */
    double cpu_s;                       /* user + system time of the whole process */
    uint64_t memory_peak_bytes;
    /* Textures of the scene loaded last: bytes of pictures in memory with their coarser levels; peak of the tiles of
     * all others; size of the temporary file; number of tiles read from it. */
    uint64_t texture_whole_bytes, texture_tile_bytes, texture_file_bytes, texture_tiles_read;
    ag_end end;               /* of the last picture, as noted by ag_context_note_end */
    ag_sample_counts samples; /* of the pixels of the last picture */
    double noise;             /* of the last picture, as in ag_noise; below 0: not known */
    /* With photon_paths, each picture against the one before it. came: photons of the global map that only the later
     * picture has; went: those that only the earlier one has; kept: photons whose irradiance was taken over. */
    uint64_t photons_came, photons_went, irradiance_kept;
} ag_statistics;

/* Writes the statistics of the context so far. struct_size: of the program's ag_statistics. */
AG_API void ag_context_statistics_fill(const ag_context *context, void *out_statistics, size_t struct_size);
static inline ag_statistics ag_context_statistics(const ag_context *context)
{
    ag_statistics filled;
    ag_context_statistics_fill(context, &filled, sizeof filled);
    return filled;
}

/* Writes ag_context_statistics with the irradiance counters of a rendering under way added, which the context gets only
 * when the rendering is finished; irradiance_distinct is left out. struct_size: of the program's ag_statistics. */
AG_API void ag_rendering_statistics_fill(const ag_rendering *rendering, void *out_statistics, size_t struct_size);
static inline ag_statistics ag_rendering_statistics(const ag_rendering *rendering)
{
    ag_statistics filled;
    ag_rendering_statistics_fill(rendering, &filled, sizeof filled);
    return filled;
}

/* The state of a rendering's photon map while it is filled. All members but the size are 0 where it has no map. */
typedef struct ag_growth {
    size_t struct_size;
    uint64_t irradiance_requests; /* points that irradiance was asked for at, by all renderings that share the map */
    uint64_t irradiance_computed; /* photons whose irradiance these renderings have computed */
    uint64_t irradiance_photons;  /* photons of the global map that irradiance can be kept at */
    double photon_density;        /* photons of the global map per area of all surfaces, 1/m^2 */
} ag_growth;

/* Any thread may call this, from ag_rendering_create on until the rendering is finished. struct_size: of the program's
 * ag_growth. */
AG_API void ag_rendering_growth_fill(const ag_rendering *rendering, void *out_growth, size_t struct_size);
static inline ag_growth ag_rendering_growth(const ag_rendering *rendering)
{
    ag_growth filled;
    ag_rendering_growth_fill(rendering, &filled, sizeof filled);
    return filled;
}

/* Records in the statistics why a rendering ended; to be called when it is finished. */
AG_API void ag_context_note_end(ag_context *context, ag_end end);

/* Checks, before a long render, that statistics could be written to path. Errors: AG_ERROR_ARGUMENT,
 * AG_ERROR_OUTPUT. */
AG_API ag_status ag_statistics_check(ag_context *context, const char *path);

/* Writes the statistics as JSON, with the settings of the last ag_render, atomically. Errors: AG_ERROR_ARGUMENT,
 * AG_ERROR_OUTPUT, AG_ERROR_MEMORY, AG_CANCELLED. */
AG_API ag_status ag_statistics_write(ag_context *context, const char *path);

#ifdef __cplusplus
}
#endif
#endif
