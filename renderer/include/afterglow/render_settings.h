/* render_settings.h: how a scene is rendered, as a struct and by the names of its settings.
 * Part of afterglow.h, which tells about threads and errors. */
#ifndef AFTERGLOW_PUBLIC_RENDER_SETTINGS_H
#define AFTERGLOW_PUBLIC_RENDER_SETTINGS_H

#include "afterglow/layers.h"
#include "afterglow/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Every integrator with its word as a setting, and what it is, for help and man page. */
#define AG_INTEGRATOR_LIST(X)                                                                                          \
    X(AG_INTEGRATOR_PHOTONMAP, photonmap, "a photon map, seen by final gathering")                                     \
    X(AG_INTEGRATOR_PATH, path, "plain path tracing of the same scene")

typedef enum ag_integrator {
#define AG_INTEGRATOR_ENUM(value, word, about) value,
    AG_INTEGRATOR_LIST(AG_INTEGRATOR_ENUM)
#undef AG_INTEGRATOR_ENUM
} ag_integrator;

/* Returns whether an integrator traces photons, so that settings, layers and statistics of photons apply to it; false
 * for a value that is no integrator. */
AG_API bool ag_integrator_has_photons(ag_integrator integrator);

typedef enum ag_cache_mode {
    AG_CACHE_ON_DEMAND,  /* irradiance at a photon is computed when it is first requested */
    AG_CACHE_PRECOMPUTE, /* irradiance is computed at every photon before rendering; the picture has the same bits */
    AG_CACHE_OFF         /* irradiance is estimated at every gather hit: another estimator, slower */
} ag_cache_mode;

/* How light that panes transmit is computed. Panes are thin glass and smooth interfaces of index 1, which do not
 * refract, and slabs of smooth solid glass, whose parallel faces only shift light, by about a third of their thickness.
 * A slab's faces are flat, and at least sixteen times as wide (area over diagonal) as the slab is thick. */
typedef enum ag_pane_light {
    AG_PANE_LIGHT_DIRECT, /* as direct light: both integrators sample it at its lamp, so that suns, points and spots
                             shine through windows in the path tracer too; it is no caustic. What the eye sees
                             through a slab, directly or in mirrors, is refracted nevertheless */
    AG_PANE_LIGHT_TRACED  /* as light through any other glass */
} ag_pane_light;

/* Whether image textures of colours are filtered over the footprints of rays: of camera rays over a sample's share of a
 * pixel, also behind mirrors and glass, of gather rays and photons more coarsely. */
typedef enum ag_texture_filter { AG_TEXTURE_FILTER_ON, AG_TEXTURE_FILTER_OFF } ag_texture_filter;

typedef enum ag_only { AG_ONLY_ALL, AG_ONLY_INDIRECT } ag_only;

typedef struct ag_render_settings {
    size_t struct_size;
    ag_integrator integrator;         /* default: photonmap */
    ag_cache_mode cache;              /* default: on demand */
    ag_pane_light pane_light;         /* default: direct */
    ag_texture_filter texture_filter; /* default: on */
    ag_only only;  /* AG_ONLY_INDIRECT: without emission, and without direct light at the first non-specular hit */
    uint64_t seed; /* default 0; statistics show it as a signed number */

    int width, height;     /* pixels of the full picture, [1, 65536] */
    double crop_window[4]; /* x0, x1, y0, y1 in [0, 1], from the left and from the top: the part to render, as
                              pbrt's cropwindow: pixels from ceil(x0 width) to ceil(x1 width) - 1; default 0 1 0 1 */
    int samples_per_pixel; /* [1, 2^20] */
    float exposure;        /* pixels are the radiance times this: pbrt's imaging ratio, the shutter's time * iso / 100;
                              > 0, default 1 */
    float max_component;   /* bound of a sample's components in CIE XYZ, which is pbrt's sensor: brighter samples are
                              scaled down to it; 0: unbounded, the default */
    float white_balance;   /* K, [1000, 25000]: daylight of this temperature (below 4000: a black body) becomes white;
                              0: none, the default */
    bool float_samples;    /* EXR files of the film hold floats where ag_output_settings leaves it open; default half */
    int max_depth;         /* most scatterings between lamp and eye, [0, 100]; 100: roulette ends paths, and surfaces
                              alone have the bound; less bounds scatterings in media too. Path tracing keeps the bound
                              exactly. With the photon map it bounds the photon's part of a path (to max_depth - 2
                              before a gather ray, max_depth - 1 before a caustic) and the eye's part separately, so
                              that there may be a few more behind mirrors and glass. */

    uint64_t photon_count; /* photons to store in the global map, [1, 2^32 - 2]. Default AG_PHOTON_COUNT_AUTOMATIC:
                              two for each camera sample of the whole frame (with a level of noise, for each of the
                              noise_min_samples at most), from 131072 to AG_DEFAULT_PHOTONS_MOST, and in small
                              pictures of open views fewer, down to 16384, by how many gather rays meet anything
                              (which depends on the camera, so that frames may differ); that most with a photon_map_file
                              or photon_paths, whose photons are not of one picture alone */
    uint64_t photon_paths; /* light paths that the photons of the global map come from, [0, 10^15]; 0, the default: as
                              many as it takes to store photon_count photons. A fixed number is for the frames of an
                              animation: a path that meets nothing new then has the same photons in each frame, and
                              its irradiances can be kept (ag_context_take_frame). At most photon_count photons are
                              stored; a warning tells where that ends the tracing early. photon_aim and
                              gather_guiding are then 0 unless set */
    uint64_t caustic_photon_count; /* photons to store in the caustic map, [0, 2^32 - 2]. Default
                                      AG_PHOTON_COUNT_AUTOMATIC: half of what that means for photon_count in a
                                      room. A few that are far stronger than the others are divided, so that a
                                      few more are kept */
    int nearest;                   /* photons of an estimate, [1, 65536] */
    float radius;              /* largest radius of an estimate, scene units; 0: derived from the photons' density */
    float irradiance_fraction; /* share of the photons at which irradiance is kept, (0, 1]: gather rays look up the
                                  nearest of these irradiance photons; each estimate still uses all photons. A
                                  smaller share is faster and blurs by about the spacing of irradiance photons.
                                  Where photons are sparse, and where surfaces curve, more are taken, so that each
                                  photon has an irradiance photon nearby. Default 1 */
    float gather_guiding; /* share of the gather rays, [0, 1], whose directions follow the incident directions of the
                             photons nearby, where there are many; the others are sampled by the cosine. A quarter
                             of it is the share of rough reflections' rays that follow caustic photons. It changes the
                             noise, not the light. Default
                             AG_GATHER_GUIDING_AUTOMATIC: AG_DEFAULT_GATHER_GUIDING, but 0 with photon_paths, since
                             each photon that comes or goes changes the directions around it */
    uint64_t photon_seed; /* seed of the photons, so that pictures with different seeds can share a kept photon map.
                             Default AG_PHOTON_SEED_AUTOMATIC: seed */
    float photon_aim;     /* share of the photon paths, [0, 0.8], whose emission follows what a pilot pass has learned
                             about which paths reach the points where this picture looks up light; the others are
                             emitted by power alone, so that no photon is more than five times as bright as by
                             that. It lowers the noise of this picture and raises that of other views; the light is
                             the same. The pilot depends on view and shape of the whole frame alone. Default
                             AG_PHOTON_AIM_AUTOMATIC: AG_DEFAULT_PHOTON_AIM, but 0 with a photon_map_file, which
                             serves all views alike; an aimed file is refused for another view */
    float direct_guiding; /* share of the direct light samples, [0, 0.8], that go to those lights and parts of the sky
                             which a pilot pass has found visible from nearby points; the others are distributed
                             without it, so that no sample weighs more than five times as much as without guiding.
                             It lowers noise where light comes through windows; the light is the same. The pilot
                             depends on view and shape of the whole frame, max_depth, pane_light and seed. Scenes
                             without a distant or infinite light are not guided. Default
                             AG_DIRECT_GUIDING_AUTOMATIC: AG_DEFAULT_DIRECT_GUIDING, but 0 for AG_INTEGRATOR_PATH,
                             the reference */
    uint32_t layers;      /* AG_LAYER_..., or-ed; default 0, of a scene with film "gbuffer" AG_LAYER_GBUFFER */
    bool denoise;         /* the film keeps the albedo and normals that ag_film_denoise uses; default false */
    bool layers_in_camera_space; /* P and normals of AG_LAYER_GBUFFER are in camera space, else in world space */
    float clamp_direct;    /* bound of each component of the light that a sample gets from a lamp by way of at most one
                              surface; 0: unbounded, the default */
    float clamp_indirect;  /* bound of each component of all other light in a sample; 0: unbounded, the default */
    float noise_level;     /* adaptive sampling: a block of 8 by 8 pixels gets no more samples once its standard error,
                              root mean square over the block, is below this level. The error is that of the square
                              root of the value, where white is 1, and relative for brighter values.
                              samples_per_pixel is then the maximum. 0, the default: all pixels get as many samples.
                              The program uses AG_DEFAULT_NOISE_LEVEL and AG_DEFAULT_SAMPLES_MOST where neither
                              options nor ag_scene_has_own_samples say otherwise */
    int noise_min_samples; /* least samples of each pixel with a noise level, [2, 2^20]; default 16 */
    float shown_exposure_stops; /* exposure that will be added when the picture is shown, [-100, 100], stops: noise and
                                   warnings refer to the picture as shown; default 0 */
    int gather_samples;         /* gather rays of each camera sample that meets a diffuse surface first, [1, 65536];
                                   hits behind glossy surfaces share about as many. 0, the default: each block of 8
                                   by 8 pixels chooses the numbers of gather rays, light samples and camera rays of
                                   a sample (these bring all light but gathered light and caustics), and how often
                                   caustics are asked for, by the noise of its samples and what they cost; samples
                                   times gather rays are AG_DEFAULT_GATHER_RAYS_PER_PIXEL at most, or 4 gather rays a
                                   sample (with a noise level: 64) */
    /* Path of a file that keeps the photon map from one picture to the next, with the irradiances computed so far;
     * NULL, the default: none. Where the file is missing, photons are traced and it is written. Processes on one
     * machine that use the file at the same time fill it together. The picture is the same with and without it. The
     * path is borrowed until ag_rendering_create or ag_render returns. A file that is damaged, or was made for another
     * scene or with other settings of photons, is refused: camera, film, samples and gather rays may differ, but the
     * view may not where the photons are aimed. */
    const char *photon_map_file;
    bool photon_map_refresh; /* a file that would be refused is replaced by newly traced photons; default false */
} ag_render_settings;

/* Fills settings with those that the scene's file gives, which loading has checked, and with the defaults for all
 * others. struct_size: of the program's ag_render_settings. Errors: AG_ERROR_ARGUMENT, where nothing is written. */
AG_API ag_status ag_render_settings_fill(ag_context *context, const ag_scene *scene, void *out_settings,
                                         size_t struct_size);
static inline ag_status ag_render_settings_from_scene(ag_context *context, const ag_scene *loaded,
                                                      ag_render_settings *out_settings)
{
    return ag_render_settings_fill(context, loaded, out_settings, sizeof *out_settings);
}

/* The defaults, without a scene's own settings. */
AG_DEFAULT_STRUCT(render_settings, AG_STRUCT_RENDER_SETTINGS)

/* A setting that has a name, for command lines, dialogs and their help. The strings are the library's. */
typedef struct ag_setting {
    const char *name;      /* "photon-aim" */
    const char *argument;  /* placeholder of its value in help texts, "F"; NULL: a switch, without a value */
    const char *section;   /* "Output", "Picture" or "Light" */
    const char *help;      /* its effect, range and default, without a final stop */
    const char *manual;    /* a longer help text, with *bold* and _italic_ words; NULL: help is complete */
    bool is_of_photon_map; /* a kept photon map is refused for another value of it */
} ag_setting;

/* Returns a setting by number, from 0 on; NULL past the last one. */
AG_API const ag_setting *ag_setting_at(size_t index);
/* Sets the setting of that name from a text; numbers use a decimal point in every locale. "aov" adds to the layers that
 * are set. value: NULL for a switch; "photon-map" borrows it. Errors: AG_ERROR_ARGUMENT (there is no such setting, or
 * the text is not a valid value; settings are then unchanged). */
AG_API ag_status ag_render_settings_set(ag_render_settings *settings, const char *name, const char *value);

#define AG_DEFAULT_NOISE_LEVEL           0.02f
#define AG_DEFAULT_SAMPLES_MOST          1024
#define AG_DEFAULT_GATHER_RAYS_PER_PIXEL 256
#define AG_DEFAULT_GATHER_GUIDING        0.5f
#define AG_GATHER_GUIDING_AUTOMATIC      (-1.0f)
#define AG_DEFAULT_PHOTONS_MOST          1000000
#define AG_PHOTON_COUNT_AUTOMATIC        0x8000000000000000u
#define AG_PHOTON_SEED_AUTOMATIC         0x8000000000000000u
#define AG_DEFAULT_PHOTON_AIM            0.8f
#define AG_PHOTON_AIM_AUTOMATIC          (-1.0f)
#define AG_DEFAULT_DIRECT_GUIDING        0.8f
#define AG_DIRECT_GUIDING_AUTOMATIC      (-1.0f)

#ifdef __cplusplus
}
#endif
#endif
