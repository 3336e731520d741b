/* layers.h: the layers of a picture, by bit and by name.
 * Part of afterglow.h. Threads: any. */
#ifndef AFTERGLOW_PUBLIC_LAYERS_H
#define AFTERGLOW_PUBLIC_LAYERS_H

#include "afterglow/base.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Layers of a picture beside its R, G and B. Their channels have the names that other renderers give them. */
typedef enum ag_layer {
    AG_LAYER_ALPHA = 1 << 0,  /* A: the share of the pixel where there is something; R, G and B hold the sky as well */
    AG_LAYER_DEPTH = 1 << 1,  /* Z: the nearest surface's, along the camera's axis; 1e10 where there is none */
    AG_LAYER_ALBEDO = 1 << 2, /* albedo.R, G, B: of what is met first, with what it reflects like a mirror, [0, 1] */
    AG_LAYER_NORMAL = 1 << 3, /* N.X, Y, Z: its shading normal on the eye's side, world space, mean over the pixel */
    AG_LAYER_POSITION = 1 << 4, /* P.X, Y, Z: world space, mean over what of the pixel is not empty */
    AG_LAYER_UV = 1 << 5,       /* u, v */
    /* The parts of light. R, G and B are their sum in this order, in floats, to the last bit. A pane whose light is
     * direct (ag_pane_light) is no surface to what it lets through: behind it the first surface is the one that is seen
     * through it. Slabs are surfaces to the eye, and none to the light that shines through them. */
    AG_LAYER_EMISSION = 1 << 6,      /* straight from lamps and sky to the eye */
    AG_LAYER_DIRECT = 1 << 7,        /* straight from lamps, reflected by the first surface's diffuse lobes */
    AG_LAYER_INDIRECT = 1 << 8,      /* what else these reflect, but */
    AG_LAYER_CAUSTIC = 1 << 9,       /* what comes to them from lamps by way of mirrors and glass alone */
    AG_LAYER_SPECULAR = 1 << 10,     /* all that comes by the first surface's other lobes */
    AG_LAYER_IRRADIANCE = 1 << 11,   /* irradiance.R, G, B: of the photon map at the first surface, W/m^2 */
    AG_LAYER_VARIANCE = 1 << 12,     /* variance.R, G, B: of the pixel's samples (not of their mean) */
    AG_LAYER_SAMPLES = 1 << 13,      /* samples.V: how many */
    AG_LAYER_ID = 1 << 14,           /* id.object.V, id.material.V: of the nearest surface, from 1 on; 0: nothing */
    AG_LAYER_LIGHT_GROUPS = 1 << 15, /* light_NAME.R, G, B: what came from the lamps of a group to the first surface and
                                        by way of mirrors and glass; light_photons: through the photon map */
    AG_LAYER_GBUFFER = 1 << 16,      /* the channels of pbrt-v4's film "gbuffer"; its P and N instead of the above */
    /* How the photon map fared, at what the ray through the pixel's middle meets first; 0 where that gathers
     * nothing. */
    AG_LAYER_PHOTON_DENSITY = 1 << 17, /* photon_density.V: photons per area, 1/m^2 */
    AG_LAYER_CACHE_STATE = 1 << 18, /* cache_state.V: of the photon nearest there: 1 its irradiance was not demanded, 2
                                       it was; 0: no photon is near */
    AG_LAYER_PHOTON_DISTANCE = 1 << 19, /* photon_distance.V: how far that photon is */
    AG_LAYER_GATHER_DISTANCE = 1 << 20, /* gather_distance.V: how far gather rays go, harmonic mean */
    /* Cryptomatte for objects (instances, glTF nodes, files of meshes) and materials, by their names in the scene,
     * or by numbers; six ranks. */
    AG_LAYER_CRYPTO_OBJECT = 1 << 22,
    AG_LAYER_CRYPTO_MATERIAL = 1 << 23,
    AG_LAYER_TILE_TIME = 1 << 21 /* tile_time.V: seconds that the pixel's tile took: another number in each run */
} ag_layer;
#define AG_LAYERS_LIGHT (AG_LAYER_EMISSION | AG_LAYER_DIRECT | AG_LAYER_INDIRECT | AG_LAYER_CAUSTIC | AG_LAYER_SPECULAR)
/* All that is the same from run to run, in our names. */
#define AG_LAYERS_ALL                                                                                                  \
    (AG_LAYER_ALPHA | AG_LAYER_DEPTH | AG_LAYER_ALBEDO | AG_LAYER_NORMAL | AG_LAYER_POSITION | AG_LAYER_UV |           \
     AG_LAYERS_LIGHT | AG_LAYER_IRRADIANCE | AG_LAYER_VARIANCE | AG_LAYER_SAMPLES | AG_LAYER_ID |                      \
     AG_LAYER_LIGHT_GROUPS | AG_LAYER_PHOTON_DENSITY | AG_LAYER_CACHE_STATE | AG_LAYER_PHOTON_DISTANCE |               \
     AG_LAYER_GATHER_DISTANCE | AG_LAYER_CRYPTO_OBJECT | AG_LAYER_CRYPTO_MATERIAL)

/* Layers by name, separated by commas: "A,Z,albedo", "light" for the parts of light, "all". Errors:
 * AG_ERROR_ARGUMENT. */
AG_API ag_status ag_layers_parse(const char *list, uint32_t *out_layers);

/* A layer by its name, for command lines and their help. The strings are the library's. */
typedef struct ag_layer_info {
    ag_layer layer;
    const char *name, *group; /* as ag_layers_parse knows them; group: of several layers, or NULL */
    const char *about;        /* what it shows, with *bold* and _italic_ words */
    bool is_left_out_of_all;  /* "all" is not this one, too */
} ag_layer_info;

/* All layers by number, from 0 on; NULL: there are no more. */
AG_API const ag_layer_info *ag_layer_at(size_t index);

#ifdef __cplusplus
}
#endif
#endif
