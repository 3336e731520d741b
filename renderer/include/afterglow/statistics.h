/* statistics.h: the memory and time that a picture is expected to take, and what was done.
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

/* The memory and time that a picture is expected to take. */
typedef struct ag_prediction {
    size_t struct_size;
    /* of memory, bytes; without what --denoise takes */
    uint64_t memory_peak_bytes;   /* of the whole process, resident; no less than it has had already */
    uint64_t memory_needed_bytes; /* the most that is there at once of what follows */
    uint64_t memory_scene_bytes;  /* what the process has now: the program and the scene */
    uint64_t memory_photon_bytes; /* photon maps */
    uint64_t memory_thread_bytes; /* of all threads */
    uint64_t memory_film_bytes;
    uint64_t memory_host_bytes; /* what the host holds itself, as it has told by ag_context_expect_host_memory */
    uint64_t memory_file_bytes; /* a picture on its way to a file; maps and threads' memory are given back before */
    /* of time: on this machine, were it idle; 0: not predicted */
    double time_s[AG_PHASE_COUNT];
    double time_total_s;      /* since the context was created */
    double cpu_s;             /* of all threads */
    double samples_per_pixel; /* that it takes on average */
} ag_prediction;

/* Tells how many bytes the host itself will hold beside a rendering of this context, to show it say, and does not hold
 * yet; 0 at first. Predictions then count them. */
AG_API void ag_context_expect_host_memory(ag_context *context, uint64_t bytes);
/* The memory alone, without any work. To be asked before ag_render. struct_size: of the program's ag_prediction.
 * Errors: as ag_render. */
AG_API ag_status ag_predict_memory_fill(ag_context *context, const ag_scene *scene, const ag_render_settings *settings,
                                        void *out_prediction, size_t struct_size);
static inline ag_status ag_predict_memory(ag_context *context, const ag_scene *loaded,
                                          const ag_render_settings *settings, ag_prediction *out_prediction)
{
    return ag_predict_memory_fill(context, loaded, settings, out_prediction, sizeof *out_prediction);
}

/* Time and memory; for the time photons are traced, a million into each map at most, and a part of the picture's blocks
 * of 8 x 8 pixels is rendered: a half of small pictures, some hundred blocks of large ones. A photon map's file is left
 * alone. struct_size: of the program's ag_prediction. Errors: as ag_render. */
AG_API ag_status ag_predict_fill(ag_context *context, const ag_scene *scene, const ag_render_settings *settings,
                                 void *out_prediction, size_t struct_size);
static inline ag_status ag_predict(ag_context *context, const ag_scene *loaded, const ag_render_settings *settings,
                                   ag_prediction *out_prediction)
{
    return ag_predict_fill(context, loaded, settings, out_prediction, sizeof *out_prediction);
}

/* The last prediction that was made, of struct_size bytes; memory_peak_bytes is 0 where there is none. */
AG_API void ag_context_prediction_fill(const ag_context *context, void *out_prediction, size_t struct_size);
static inline ag_prediction ag_context_prediction(const ag_context *context)
{
    ag_prediction filled;
    ag_context_prediction_fill(context, &filled, sizeof filled);
    return filled;
}

/* Where a picture's photon map came from. */
typedef enum ag_map_file {
    AG_MAP_FILE_NONE,   /* traced, and not kept */
    AG_MAP_FILE_TRACED, /* traced, and kept */
    AG_MAP_FILE_OPENED, /* from the file, and filled further */
    AG_MAP_FILE_PRIVATE /* from a file that could not be shared: a copy, which is not kept */
} ag_map_file;

/* Why a picture ended, so that a farm knows what to do with it. */
typedef enum ag_end {
    AG_END_NONE,       /* not known */
    AG_END_SAMPLES,    /* pixels have had all samples that the settings allow */
    AG_END_NOISE,      /* the noise that was asked for was reached before that, everywhere */
    AG_END_PHOTONS,    /* only the photon map was wanted */
    AG_END_TIME_LIMIT, /* the time was up */
    AG_END_SIGNAL,     /* it was interrupted */
    AG_END_MEMORY,     /* it needs more memory than there is, or than it may have */
    AG_END_DRY_RUN,    /* it was only predicted */
    AG_END_KEPT        /* who watched it stopped it, and kept what there was */
} ag_end;

typedef struct ag_statistics {
    size_t struct_size;
    unsigned threads;
    uint64_t photons_emitted, photons_stored_global, photons_stored_caustic, photon_bytes;
    ag_map_file map_file; /* of the last picture */
    /* requests: points asked for; computed: estimates at photons; distinct: photons found ready afterwards that were
     * not before, counted by looking; deferred: set aside because another thread was computing; waited: had to wait in
     * the end; duplicated: computed twice, 0; uncached: estimates at hits themselves; refused:
     * requests for points where no estimate holds, whose light was followed by further bounces instead; ready: photons
     * of a map from a file that were ready when it was opened; reclaimed: claims taken over from other processes that
     * had died. Where other processes fill the map too, distinct counts what they computed as well. */
    uint64_t irradiance_requests, irradiance_computed, irradiance_distinct, irradiance_deferred, irradiance_waited,
        irradiance_duplicated, irradiance_uncached, irradiance_refused, irradiance_ready, irradiance_reclaimed;
    double irradiance_estimate_s; /* CPU seconds spent in estimates, all threads; from a sixteenth of them */
    double irradiance_wait_s;     /* CPU seconds spent in waiting for other threads' estimates, all threads */
    /* estimate: cast by estimates and lookups in the photon maps, to find where surfaces end and which photons are in
     * sight */
    uint64_t rays_camera, rays_shadow, rays_gather, rays_photon, rays_path, rays_estimate;
    uint64_t samples_not_finite; /* camera samples dropped because they were not numbers: 0 */
    double time_s[AG_PHASE_COUNT];
    double phase_cpu_s[AG_PHASE_COUNT]; /* user + system of the whole process meanwhile */
    double time_total_s;                /* since the context was created */
    double cpu_s;                       /* user + system of the whole process */
    uint64_t memory_peak_bytes;
    /* Of the scene loaded last: pictures of textures held whole, with what their coarser levels take, and the most that
     * tiles of the others took; their temporary file, and how many tiles were read from it. */
    uint64_t texture_whole_bytes, texture_tile_bytes, texture_file_bytes, texture_tiles_read;
    ag_end end;               /* of the last picture, as noted by ag_context_note_end */
    ag_sample_counts samples; /* of the pixels of the last picture */
    double noise;             /* of the last picture, as in ag_noise; below 0: not known */
} ag_statistics;

/* What was done so far. struct_size: of the program's ag_statistics. */
AG_API void ag_context_statistics_fill(const ag_context *context, void *out_statistics, size_t struct_size);
static inline ag_statistics ag_context_statistics(const ag_context *context)
{
    ag_statistics filled;
    ag_context_statistics_fill(context, &filled, sizeof filled);
    return filled;
}

/* ag_context_statistics, with the irradiances that a rendering under way has asked for so far, which count there only
 * when it is finished; without irradiance_distinct. */
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

/* To be called when a rendering is finished, by who ended it; for the statistics. */
AG_API void ag_context_note_end(ag_context *context, ag_end end);

/* Whether statistics could be written there. To be asked before a long render. */
AG_API ag_status ag_statistics_check(ag_context *context, const char *path);

/* The statistics as JSON, with the settings of the last ag_render; written atomically. */
AG_API ag_status ag_statistics_write(ag_context *context, const char *path);

#ifdef __cplusplus
}
#endif
#endif
