/* rendering.h: renders a scene into a film, at once or in passes.
 * Part of afterglow.h, which tells about threads and errors. */
#ifndef AFTERGLOW_PUBLIC_RENDERING_H
#define AFTERGLOW_PUBLIC_RENDERING_H

#include "afterglow/film.h"
#include "afterglow/render_settings.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Traces photons, builds the maps, renders. The picture depends on scene, settings and seed alone.
 * Errors: AG_ERROR_ARGUMENT (settings out of range), AG_ERROR_SCENE (no camera), AG_ERROR_INPUT (the photon map's file
 * is refused), AG_ERROR_OUTPUT (it cannot be written), AG_ERROR_MEMORY, AG_CANCELLED. */
AG_API ag_status ag_render(ag_context *context, const ag_scene *scene, const ag_render_settings *settings,
                           ag_film **out_film);

/* ag_render in passes over the whole picture: previews, checkpoints and limits of time are built on it. Samples [0, a)
 * and then [a, b) give the bits of [0, b) at once. The rendering borrows scene and context. */
typedef struct ag_rendering ag_rendering;

/* Traces photons and builds the maps. Errors as ag_render. */
AG_API ag_status ag_rendering_create(ag_context *context, const ag_scene *scene, const ag_render_settings *settings,
                                     ag_rendering **out_rendering);
/* Begins a picture of the same scene and settings as another rendering's, seen from elsewhere: from one point to
 * another, in world space, with a direction that is up. It shares that one's photon map and irradiances, to which it
 * adds; either may be finished first, and they take turns in ag_rendering_continue. The other's bits stay; its own
 * are those of a rendering of that camera on that map. The camera is the scene's but for its place: projection, lens
 * and exposure stay, and it stands still. reduction: 1, or more for a coarse picture first, of so many times fewer
 * pixels in width and in height. No progress is told of it. Errors: AG_ERROR_ARGUMENT (up is along the way, or
 * there is none), AG_ERROR_SYSTEM (the photon map's file was changed meanwhile), AG_ERROR_MEMORY, AG_CANCELLED. */
AG_API ag_status ag_rendering_create_view(ag_rendering *beside, const float from[3], const float to[3],
                                          const float up[3], int reduction, ag_rendering **out_rendering);
/* Tells where a rendering's camera is when the shutter opens, as ag_rendering_create_view takes it: out_to is what the
 * middle of the picture shows, or far away where that is nothing; out_right: to the right in the picture.
 * out_fov_degrees: of a pinhole, across the shorter image axis, as camera_fov_degrees of ag_scene_settings; 0: the
 * camera is no plain one. */
AG_API void ag_rendering_find_place(const ag_rendering *rendering, float out_from[3], float out_to[3], float out_up[3],
                                    float out_right[3], float *out_fov_degrees);
/* Brings every pixel to so many samples, or to fewer where the settings' noise level is reached before; those that have
 * them already stay as they are. samples_per_pixel: [1, that of the settings]. Errors: AG_ERROR_ARGUMENT; AG_CANCELLED,
 * AG_PAUSED: the film is then as good as it is, each pixel with the samples that it has had; AG_ERROR_SYSTEM: the
 * photon map's file was cut short or overwritten meanwhile, and the film is that of the call before. */
AG_API ag_status ag_rendering_continue(ag_rendering *rendering, int samples_per_pixel);
/* From now on the film is put aside whenever ag_rendering_continue gives AG_OK, which takes as much memory as it does,
 * that predictions know by ag_context_expect_host_memory alone; without that memory it is not, and the log has a
 * warning. Errors: AG_ERROR_ARGUMENT. */
AG_API ag_status ag_rendering_keep_passes(ag_rendering *rendering);
/* The film is as it was when ag_rendering_continue gave AG_OK last; what was rendered since is dropped. Rendering may
 * go on from there, to the same bits. Errors: AG_ERROR_ARGUMENT (there has been no such pass since it was asked for).
 */
AG_API ag_status ag_rendering_go_back(ag_rendering *rendering);
/* The numbers of samples that pixels have had so far. This struct will not change. */
typedef struct ag_sample_counts {
    int least, most;
    double mean;
} ag_sample_counts;
AG_API ag_sample_counts ag_rendering_sample_counts(const ag_rendering *rendering);
/* Where a picture's noise comes from: the light that the camera's rays bring, by its way. */
typedef enum ag_noise_source {
    AG_NOISE_EMISSION, /* straight from lamps and sky to the eye: their edges */
    AG_NOISE_LAMPS,    /* direct light of all lights but the infinite ones */
    AG_NOISE_SKY,      /* direct light of infinite ones */
    AG_NOISE_INDIRECT,
    AG_NOISE_CAUSTIC,
    AG_NOISE_SPECULAR /* by way of mirrors, glass and glossy surfaces */
} ag_noise_source;
#define AG_NOISE_SOURCE_COUNT 6

/* The noise of a picture so far. */
typedef struct ag_noise {
    size_t struct_size;
    double level; /* the standard error of what is shown (see noise_level), root mean square over the picture; below 0:
                     not known, since pixels have had fewer than two samples */
    double share[AG_NOISE_SOURCE_COUNT]; /* of the variance, by ag_noise_source; the sum is 1, or 0 without noise */
    char hint[256];                      /* one line: the largest source, and what lessens it most; may be empty */
} ag_noise;
/* Measures the noise at up to 16,384 of the picture's pixels, spread evenly. The caustics' share includes the grain of
 * their photons, which more samples do not lessen. struct_size: of the program's ag_noise. */
AG_API void ag_rendering_noise_fill(const ag_rendering *rendering, void *out_noise, size_t struct_size);
static inline ag_noise ag_rendering_noise(const ag_rendering *rendering)
{
    ag_noise filled;
    ag_rendering_noise_fill(rendering, &filled, sizeof filled);
    return filled;
}

/* All that samples have brought so far, as a file; written atomically. Another process that makes the same rendering
 * reads it, and goes on to the same bits. Errors: AG_ERROR_MEMORY, AG_ERROR_OUTPUT. */
AG_API ag_status ag_rendering_write_checkpoint(const ag_rendering *rendering, const char *path);
/* To be called before the first ag_rendering_continue. The log says why a file is refused: damaged, or of another
 * scene, other settings, another version. The rendering is then as it was. Errors: AG_ERROR_INPUT. */
AG_API ag_status ag_rendering_read_checkpoint(ag_rendering *rendering, const char *path);
/* The photons as binary PLY, for viewers and scripts: x, y, z, nx, ny, nz, the way the light went dx, dy, dz, red,
 * green, blue in W, caustic (0 global map, 1 caustic map), demanded (whether irradiance was computed there); written
 * atomically. Errors: AG_ERROR_ARGUMENT (path tracing has none), AG_ERROR_MEMORY, AG_ERROR_OUTPUT. */
AG_API ag_status ag_rendering_write_photons(const ag_rendering *rendering, const char *path);
/* The film as it is now, the rendering's; and the same one all along, which ag_rendering_finish hands over. While the
 * rendering is at work, its size and names may be asked for, and it may be watched with ag_film_read_tile and
 * ag_film_read_picture; all else waits until the call has returned. */
AG_API const ag_film *ag_rendering_film(const ag_rendering *rendering);
/* Ends the rendering, counts what was done, and hands its film over; out_film NULL: destroys that too. rendering NULL
 * is fine. */
AG_API void ag_rendering_finish(ag_rendering *rendering, ag_film **out_film);

#ifdef __cplusplus
}
#endif
#endif
