/* rendering.h: renders a scene into a film, at once or in passes.
 * Part of afterglow.h, which tells about threads and errors. */
#ifndef AFTERGLOW_PUBLIC_RENDERING_H
#define AFTERGLOW_PUBLIC_RENDERING_H

#include "afterglow/film.h"
#include "afterglow/render_settings.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Traces photons, builds the photon maps and renders. The picture depends on scene, settings and seed alone. The caller
 * owns the film. The scene may have been made with another context whose isa, color_config and working_space are the
 * same; no other thread uses that meanwhile. Errors: AG_ERROR_ARGUMENT (settings out of range; a scene of a context
 * with others), AG_ERROR_SCENE (no camera), AG_ERROR_INPUT (the photon map's file is refused), AG_ERROR_OUTPUT (that
 * file cannot be written), AG_ERROR_SYSTEM (that file was truncated or overwritten meanwhile), AG_ERROR_MEMORY,
 * AG_CANCELLED. */
AG_API ag_status ag_render(ag_context *context, const ag_scene *scene, const ag_render_settings *settings,
                           ag_film **out_film);

/* A rendering is ag_render in passes over the whole picture, for previews, checkpoints and time limits. Samples [0, a)
 * followed by [a, b) give the same bits as [0, b) at once. The rendering borrows scene and context. */
typedef struct ag_rendering ag_rendering;

/* Traces photons and builds the photon maps; the picture has no samples yet. Errors: those of ag_render. */
AG_API ag_status ag_rendering_create(ag_context *context, const ag_scene *scene, const ag_render_settings *settings,
                                     ag_rendering **out_rendering);
/* Begins a picture of another rendering's scene, with its settings, from another viewpoint: a camera at `from` that
 * looks at `to`, both in world space, with the direction `up`. The new rendering shares the other one's photon map and
 * adds irradiances to it; either may be finished first, and they take turns in ag_rendering_continue. The other's bits
 * do not change; the new picture has the bits of a rendering by that camera on that map. Projection, lens and exposure
 * are those of the scene's camera, which does not move during the shutter. reduction: 1, or a factor by which width and
 * height are divided for a coarse preview. Progress is not reported for it. Errors: AG_ERROR_ARGUMENT (from and to are
 * the same, or up is parallel to the view), AG_ERROR_SYSTEM (the photon map's file was changed meanwhile),
 * AG_ERROR_MEMORY, AG_CANCELLED. */
AG_API ag_status ag_rendering_create_view(ag_rendering *beside, const float from[3], const float to[3],
                                          const float up[3], int reduction, ag_rendering **out_rendering);
/* Writes a rendering's camera at the opening of the shutter, as ag_rendering_create_view takes it. out_to: the point at
 * the middle of the picture, or a distant one where the ray meets nothing; out_right: the direction to the right in the
 * picture. out_fov_degrees: of a perspective camera across the shorter image axis, as camera_fov_degrees of
 * ag_scene_settings; 0 for any other camera. */
AG_API void ag_rendering_find_place(const ag_rendering *rendering, float out_from[3], float out_to[3], float out_up[3],
                                    float out_right[3], float *out_fov_degrees);
/* Renders until every pixel has samples_per_pixel samples in all, or fewer where the settings' noise level is reached
 * before; pixels that have as many already stay as they are. samples_per_pixel: [1, that of the settings]. Errors:
 * AG_ERROR_ARGUMENT; AG_CANCELLED and AG_PAUSED, where the film is valid and each pixel keeps the samples it has had;
 * AG_ERROR_SYSTEM (the photon map's file was truncated or overwritten meanwhile), where the film is that of the call
 * before. */
AG_API ag_status ag_rendering_continue(ag_rendering *rendering, int samples_per_pixel);
/* Keeps, from now on, a copy of the film each time ag_rendering_continue returns AG_OK, for ag_rendering_go_back. The
 * copy takes as much memory as the film, which predictions count only if ag_context_expect_host_memory is told of it;
 * where memory is short no copy is kept, and the log has a warning. Errors: AG_ERROR_ARGUMENT. */
AG_API ag_status ag_rendering_keep_passes(ag_rendering *rendering);
/* Restores the film as it was when ag_rendering_continue last returned AG_OK, and drops what was rendered since.
 * Rendering may continue from there, to the same bits. Errors: AG_ERROR_ARGUMENT (no pass was kept). */
AG_API ag_status ag_rendering_go_back(ag_rendering *rendering);
/* The numbers of samples that pixels have had so far. This struct will not change. */
typedef struct ag_sample_counts {
    int least, most;
    double mean;
} ag_sample_counts;
AG_API ag_sample_counts ag_rendering_sample_counts(const ag_rendering *rendering);
/* The sources of a picture's noise: kinds of light along the camera's rays. */
typedef enum ag_noise_source {
    AG_NOISE_EMISSION, /* lamps and sky that the camera sees: the noise of their edges */
    AG_NOISE_LAMPS,    /* direct light of all but infinite lights */
    AG_NOISE_SKY,      /* direct light of infinite lights */
    AG_NOISE_INDIRECT,
    AG_NOISE_CAUSTIC,
    AG_NOISE_SPECULAR /* light by way of mirrors, glass and glossy surfaces */
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

/* Writes the samples so far to a file, atomically. Another process that creates the same rendering can read it and
 * continue to the same bits. Errors: AG_ERROR_MEMORY, AG_ERROR_OUTPUT, AG_CANCELLED (while the reader of a FIFO was
 * waited for), AG_ERROR_SYSTEM (the photon map's file was truncated or overwritten: nothing is written),
 * AG_ERROR_RAY_TRACING (Embree has no memory for the small scene by which builds are told apart). */
AG_API ag_status ag_rendering_write_checkpoint(const ag_rendering *rendering, const char *path);
/* Reads a checkpoint; to be called before the first ag_rendering_continue. A file that is damaged, or of another scene,
 * other settings or another version is refused, as is one of a build that traces other photons or estimates other
 * irradiances: the log says why, and the rendering stays as it was. Errors: AG_ERROR_INPUT (it is refused),
 * AG_ERROR_MEMORY, AG_ERROR_RAY_TRACING, AG_ERROR_SYSTEM (the photon map's file was truncated or overwritten). */
AG_API ag_status ag_rendering_read_checkpoint(ag_rendering *rendering, const char *path);
/* Writes the photons as binary PLY, atomically, for viewers and scripts. Properties: x, y, z; the normal nx, ny, nz;
 * the direction of travel dx, dy, dz; red, green, blue in W; caustic (0 global map, 1 caustic map); demanded (1 where
 * irradiance was computed). Errors: AG_ERROR_ARGUMENT (the integrator has no photons), AG_ERROR_MEMORY,
 * AG_ERROR_OUTPUT, AG_CANCELLED (while the reader of a FIFO was waited for). */
AG_API ag_status ag_rendering_write_photons(const ag_rendering *rendering, const char *path);
/* Returns the film, which the rendering owns until ag_rendering_finish hands it over; it is the same object all along.
 * While ag_rendering_continue is under way, only its size, its channel names, ag_film_read_tile and
 * ag_film_read_picture may be used. */
AG_API const ag_film *ag_rendering_film(const ag_rendering *rendering);
/* Ends the rendering, adds its counts to the context's statistics, and hands the film over to the caller; out_film
 * NULL: destroys the film. rendering NULL is fine. */
AG_API void ag_rendering_finish(ag_rendering *rendering, ag_film **out_film);

#ifdef __cplusplus
}
#endif
#endif
