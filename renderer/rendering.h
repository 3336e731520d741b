/* rendering.h: a rendering under way: its maps, its film, its workers, from pass to pass.
 * Flow: render.c makes and continues it, checkpoint.c writes it down. Threads: as in afterglow.h. */
#ifndef AFTERGLOW_RENDERING_H
#define AFTERGLOW_RENDERING_H

#include "context.h"
#include "incident_light.h"
#include "integrator/direct_guide.h"
#include "integrator/transport.h"
#include "photon_file.h"
#include "scene_forms.h"

typedef struct maps {
    photon_map global, caustic;
    irradiance_cache cache;
    incident_light incident;     /* over the global map */
    photon_file file;            /* that the maps are in, where they last */
    ag_context *context;         /* borrowed: is left what a next frame can use */
    scene_forms forms;           /* of the scene, where the map's paths are fixed */
    unsigned holders;            /* renderings: the maps go with the last of them */
    irradiance_counters counted; /* what the statistics have of the cache already */
    uint64_t counted_distinct;
    hash128 photons; /* of maps_photons_hash, where has_photons_hash */
    bool has_photons_hash;
} maps;

struct ag_rendering {
    ag_context *context; /* borrowed */
    ag_scene *loaded;    /* borrowed; knows of it */
    const scene *s;      /* its scene */
    scene *seen;         /* owned: that scene with a camera of our own, which s then is; NULL: it is the scene's */
    ag_render_settings settings;
    maps *maps; /* owned, with others that see the scene from elsewhere; NULL: there are none */
    direct_guide direct_guide;
    transport t;
    eye_worker *workers;
    ag_film *film;
    ag_film *pilot; /* see split_pilot.h; NULL before and behind it */
    bool is_pilot;  /* this is not the picture itself, whose progress stays at 0 */
    bool is_view;   /* this is a picture beside another, whose progress is told */
    float aspect;   /* of the frame: width over height */
    uint64_t not_finite_before;
    uint64_t camera_rays, camera_rays_met; /* of all passes; those that met a surface */
    double seconds;                        /* of all passes */
    char *map_name;                        /* of the photon map's file, owned, or NULL */
    unsigned char *kept;                   /* the film's planes as of the last pass that saw that file whole, or NULL */
    unsigned char *whole;                  /* the film's planes as of the last pass that was completed, or NULL */
    bool keeps_passes;                     /* that is wanted */
};

/* Makes r->film, by context, scene and settings. Errors: AG_ERROR_MEMORY, AG_ERROR_ARGUMENT (the crop holds no pixel).
 * (rendering_film.c) */
ag_status rendering_create_film(ag_rendering *r);

/* Settings with nothing left open; says in the log what is out of range. (render.c) */
ag_status rendering_settle(ag_context *context, const scene *s, const ag_render_settings *wanted,
                           ag_render_settings *out_settings);

#endif
