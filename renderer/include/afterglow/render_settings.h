/* render_settings.h: how a scene is rendered, as a struct and by the names of its settings.
 * Part of afterglow.h, which tells about threads and errors. */
#ifndef AFTERGLOW_PUBLIC_RENDER_SETTINGS_H
#define AFTERGLOW_PUBLIC_RENDER_SETTINGS_H

#include "afterglow/layers.h"
#include "afterglow/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum ag_integrator { AG_INTEGRATOR_PHOTONMAP, AG_INTEGRATOR_PATH } ag_integrator;

/* Whether it traces photons, so that their settings, layers and statistics mean something; false for a number that is
 * no integrator's. */
AG_API bool ag_integrator_has_photons(ag_integrator integrator);

typedef enum ag_cache_mode {
    AG_CACHE_ON_DEMAND,  /* irradiance at a photon is computed when it is first asked for */
    AG_CACHE_PRECOMPUTE, /* at every photon, before rendering; the picture is the same, bit for bit */
    AG_CACHE_OFF         /* an estimate at every gather hit: another estimator */
} ag_cache_mode;

/* Light that passes panes: thin glass and smooth interfaces of index 1, which do not bend it, and slabs of smooth solid
 * glass, whose parallel faces do no more than shift it by about a third of their thickness. A slab's faces are flat and
 * at least sixteen times as wide (area over diagonal) as it is thick. */
typedef enum ag_pane_light {
    AG_PANE_LIGHT_DIRECT, /* as if nothing were in its way: sampled at its lamp, by both integrators. Suns, points and
                             spots shine through windows in the path tracer too; no caustic. What the eye sees through
                             a slab, directly or in mirrors, is bent all the same */
    AG_PANE_LIGHT_TRACED  /* like light by way of any other glass */
} ag_pane_light;

/* Pictures of colours are filtered over the footprints of rays: along the eye's over their share of a pixel, also by
 * way of mirrors and glass, along gather rays' and photons' more coarsely. */
typedef enum ag_texture_filter { AG_TEXTURE_FILTER_ON, AG_TEXTURE_FILTER_OFF } ag_texture_filter;

typedef enum ag_only { AG_ONLY_ALL, AG_ONLY_INDIRECT } ag_only;

typedef struct ag_render_settings {
    size_t struct_size;
    ag_integrator integrator;         /* default: photonmap */
    ag_cache_mode cache;              /* default: on demand */
    ag_pane_light pane_light;         /* default: direct */
    ag_texture_filter texture_filter; /* default: on */
    ag_only only;  /* AG_ONLY_INDIRECT: less emission and direct light at the first non-specular hit */
    uint64_t seed; /* default 0; statistics show it as a signed number */

    int width, height;     /* pixels of the full picture, [1, 65536] */
    double crop_window[4]; /* x0, x1, y0, y1 in [0, 1]: the part to render, from the left and from the top, as
                              pbrt's cropwindow: pixels from ceil(x0 width) up to ceil(x1 width) - 1; default 0 1 0 1 */
    int samples_per_pixel; /* [1, 2^20] */
    float exposure;        /* pixels are the radiance times this: pbrt's imaging ratio, the shutter's time * iso / 100;
                              > 0, default 1 */
    float max_component;   /* no component of a sample in CIE XYZ, which is pbrt's sensor, is above it: brighter samples
                              are scaled down; 0: unbounded, the default */
    float white_balance;   /* K, [1000, 25000]: daylight of this temperature (below 4000: a black body) becomes white;
                              0: none, the default */
    bool float_samples;    /* EXR files of the film hold floats where ag_output_settings leaves it open; default half */
    int max_depth;         /* scatterings between lamp and eye, [0, 100]; 100: roulette alone ends paths. Path tracing
                              keeps it exactly. The photon map bounds light's part (to max_depth - 2 before a
                              gather ray ends, max_depth - 1 before a caustic) and the eye's part apart: behind
                              mirrors and glass there may be some more. */

    uint64_t photon_count; /* photons to store in the global map, [1, 2^32 - 2] */
    uint64_t photon_paths; /* paths of light that the global map's photons come from, [0, 10^15]. 0, the default: as
                              many as fill the map. A fixed number is for the frames of an animation: what moves then
                              changes the photons of the paths that meet it and no others, and what all irradiances
                              depend on is rounded so that it stays the same. photon_count is then the most that are
                              stored; where the map is full before, a warning says so. See ag_context_take_frame */
    uint64_t caustic_photon_count; /* photons to store in the caustic map; only where anything is specular; [0, …] */
    int nearest;                   /* photons of an estimate, [1, 65536] */
    float radius;                  /* largest radius of an estimate, scene units; 0: from the photons' density */
    float irradiance_fraction;     /* share of the photons that irradiance is kept at, (0, 1]: gather rays look for the
                                      nearest of these irradiance photons, and each estimate is still of all photons.
                                      Less is faster, and blurs by about their spacing. Where photons lie far apart,
                                      and where surfaces turn, more photons are taken, so that each has an irradiance
                                      photon nearby. Default 1 */
    float gather_guiding; /* how much the photons' directions decide where gather rays go, [0, 1]: the share of the
                             rays that goes where light comes from, where photons are many; the rest goes by the
                             cosine. 0: all. Less noise or more, the same light. Default
                             AG_DEFAULT_GATHER_GUIDING */
    uint64_t photon_seed; /* of the photons, so that pictures of other seeds can share a kept photon map. Default
                             AG_PHOTON_SEED_AUTOMATIC: seed */
    float photon_aim;     /* share of the photon paths that begin where a pilot has found that they bring light to where
                             this picture asks for it, [0, 0.8]: the others begin by power alone, so that no photon is more
                             than five times as bright as without. The same light, with less noise in this picture and more
                             in others; the pilot depends on the whole frame's view and shape, and on nothing else of the
                             picture. Default AG_PHOTON_AIM_AUTOMATIC: AG_DEFAULT_PHOTON_AIM, but 0 for a photon_map_file,
                             which serves all views alike, and with photon_paths; one that is aimed is refused for another
                             view */
    float direct_guiding; /* share of the samples of direct light that go to the lights, and the parts of the sky, that
                             a pilot has seen from about there, [0, 0.8]: the others go to all alike, so that none
                             counts more than five times as much as if all did. The same light, with less noise where it
                             comes through windows; the pilot depends on the whole frame's view and shape, on depth,
                             light through panes and seed, and on nothing else of the picture. Scenes without a distant
                             or infinite light have none. Default AG_DIRECT_GUIDING_AUTOMATIC:
                             AG_DEFAULT_DIRECT_GUIDING, but 0 for AG_INTEGRATOR_PATH, which others are held against */
    uint32_t layers;      /* AG_LAYER_..., or-ed; default 0, of a scene with film "gbuffer" AG_LAYER_GBUFFER */
    bool denoise;         /* ag_film_denoise will be asked for: the film keeps what it needs */
    bool layers_in_camera_space; /* P and normals of AG_LAYER_GBUFFER: the camera's, else the world's */
    float clamp_direct; /* no component of what a sample gets from a lamp by way of at most one surface is above it; 0:
                           unbounded, the default */
    float clamp_indirect; /* as clamp_direct, for all other contributions */
    float noise_level;    /* adaptive sampling: a block of 8 by 8 pixels gets no more samples when the standard error of
                             what is shown of it (its square root, where white is 1; what is brighter, by its share), root
                             mean square over the block, is below this; samples_per_pixel is the most then; 0: all pixels
                             get as many, the default. The program takes AG_DEFAULT_NOISE_LEVEL and
                             AG_DEFAULT_SAMPLES_MOST where neither options nor ag_scene_has_own_samples say otherwise */
    int noise_min_samples;      /* of each pixel then, [2, 2^20]; default 16 */
    float shown_exposure_stops; /* by which the picture will be made brighter when it is shown, [-100, 100]: noise and
                                   warnings are of what is shown; default 0 */
    int gather_samples;         /* gather rays for each camera sample, [1, 65536], where it meets a diffuse surface
                                   first; what is reflected shares about as many; 0, the default: each block of 8 by
                                   8 pixels chooses by the noise of its samples, and so it does the light samples;
                                   the first ones have so many that samples times gather rays are about
                                   AG_DEFAULT_GATHER_RAYS_PER_PIXEL (with a noise level for 64 samples at most), at
                                   least 4 */
    /* A file that holds the photon map from one picture to the next, with the irradiances computed so far; NULL, the
     * default: none. Traced where there is none yet; other processes on this machine that use it meanwhile fill it
     * together with this one. The picture is the same. Borrowed until ag_rendering_create or ag_render returns. One
     * that is damaged, or was made of another scene or with other settings than the photons depend on, is refused:
     * camera, film, samples and gather rays may differ, but the view may not where the photons are aimed. */
    const char *photon_map_file;
    bool photon_map_refresh; /* one that would be refused is traced anew, and replaced */
} ag_render_settings;

/* ag_struct_fill (structs.h) with the scene's own settings, and our defaults for what it leaves open. Loading the scene
 * has checked what its file says. Errors: AG_ERROR_ARGUMENT, where nothing is written. */
AG_API ag_status ag_render_settings_fill(ag_context *context, const ag_scene *scene, void *out_settings,
                                         size_t struct_size);
static inline ag_status ag_render_settings_from_scene(ag_context *context, const ag_scene *loaded,
                                                      ag_render_settings *out_settings)
{
    return ag_render_settings_fill(context, loaded, out_settings, sizeof *out_settings);
}

/* Our defaults alone. */
AG_DEFAULT_STRUCT(render_settings, AG_STRUCT_RENDER_SETTINGS)

/* A setting that has a name, for command lines, dialogs and their help. The strings are the library's. */
typedef struct ag_setting {
    const char *name;      /* "photon-aim" */
    const char *argument;  /* what stands for its value in help, "F"; NULL: it takes none, and is switched on */
    const char *section;   /* "Output", "Picture" or "Light" */
    const char *help;      /* what it does, its range and default, in a sentence without an end */
    const char *manual;    /* help at length, with *bold* and _italic_ words; NULL: help says it all */
    bool is_of_photon_map; /* a kept photon map was made with one value of it, and is refused for another */
} ag_setting;

/* All of them by number, from 0 on; NULL: there are no more. */
AG_API const ag_setting *ag_setting_at(size_t index);
/* Sets one by its name to what a text says; numbers have a point in every locale. "aov" adds to the layers that are
 * set. value: NULL where it takes none; "photon-map" borrows it. Errors: AG_ERROR_ARGUMENT (there is no such setting,
 * or the text is no value of it; settings are then as they were). */
AG_API ag_status ag_render_settings_set(ag_render_settings *settings, const char *name, const char *value);

#define AG_DEFAULT_NOISE_LEVEL           0.02f
#define AG_DEFAULT_SAMPLES_MOST          1024
#define AG_DEFAULT_GATHER_RAYS_PER_PIXEL 256
#define AG_DEFAULT_GATHER_GUIDING        0.5f
#define AG_PHOTON_SEED_AUTOMATIC         0x8000000000000000u
#define AG_DEFAULT_PHOTON_AIM            0.8f
#define AG_PHOTON_AIM_AUTOMATIC          (-1.0f)
#define AG_DEFAULT_DIRECT_GUIDING        0.8f
#define AG_DIRECT_GUIDING_AUTOMATIC      (-1.0f)

#ifdef __cplusplus
}
#endif
#endif
