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
    AG_LAYER_ALPHA = 1 << 0,    /* A: how much of the background is hidden, [0, 1]: all by a surface, a part by media
                                   before the sky; R, G and B include the sky */
    AG_LAYER_DEPTH = 1 << 1,    /* Z: distance of the nearest surface along the camera's axis; 1e10 without one */
    AG_LAYER_ALBEDO = 1 << 2,   /* albedo.R, G, B: of the first surface, its mirror reflectance included, [0, 1] */
    AG_LAYER_NORMAL = 1 << 3,   /* N.X, Y, Z: its shading normal on the eye's side, world space, pixel mean */
    AG_LAYER_POSITION = 1 << 4, /* P.X, Y, Z: the first surface, world space, mean over the covered part of the pixel */
    AG_LAYER_UV = 1 << 5,       /* u, v: the first surface's parameters */
    /* The parts of light. R, G and B are their sum in this order, in floats, to the last bit. A pane whose light is
     * direct (ag_pane_light) does not count as a surface for the light that it transmits: the first surface is then the
     * one seen through it. A slab is a surface for the eye, but not for the light that shines through it. */
    AG_LAYER_EMISSION = 1 << 6,      /* straight from lamps and sky to the eye */
    AG_LAYER_DIRECT = 1 << 7,        /* straight from lamps, reflected by the first surface's diffuse lobes */
    AG_LAYER_INDIRECT = 1 << 8,      /* light of further bounces, reflected by these lobes, without caustics */
    AG_LAYER_CAUSTIC = 1 << 9,       /* light that reached these lobes from lamps by way of mirrors and glass alone */
    AG_LAYER_SPECULAR = 1 << 10,     /* all light by the first surface's other lobes, or a medium */
    AG_LAYER_IRRADIANCE = 1 << 11,   /* irradiance.R, G, B: of the photon map at the first surface, W/m^2 */
    AG_LAYER_VARIANCE = 1 << 12,     /* variance.R, G, B: of the pixel's samples (not of their mean) */
    AG_LAYER_SAMPLES = 1 << 13,      /* samples.V: the pixel's number of samples */
    AG_LAYER_ID = 1 << 14,           /* id.object.V, id.material.V: of the nearest surface, from 1 on; 0: none */
    AG_LAYER_LIGHT_GROUPS = 1 << 15, /* light_NAME.R, G, B: light of a group's lamps, direct or by way of mirrors and
                                        glass; light_photons: all light of the photon map */
    AG_LAYER_GBUFFER = 1 << 16,      /* the channels of pbrt-v4's film "gbuffer"; its P and N replace the above */
    /* The photon map at the first surface on the ray through the pixel's middle; 0 where that surface gathers no
     * light. */
    AG_LAYER_PHOTON_DENSITY = 1 << 17, /* photon_density.V: photons per area, 1/m^2 */
    AG_LAYER_CACHE_STATE = 1 << 18,    /* cache_state.V: of the nearest photon: 1 its irradiance was not requested, 2 it
                                          was; 0: no photon is near */
    AG_LAYER_PHOTON_DISTANCE = 1 << 19, /* photon_distance.V: distance of that photon, scene units */
    AG_LAYER_GATHER_DISTANCE = 1 << 20, /* gather_distance.V: length of the gather rays, harmonic mean, scene units */
    /* tile_time.V: seconds that the pixel's tile took; differs from run to run. */
    AG_LAYER_TILE_TIME = 1 << 21,
    /* Cryptomatte of objects (instances, glTF nodes, files of meshes) and of materials, by their names in the scene, or
     * by numbers where they have none; six ranks. */
    AG_LAYER_CRYPTO_OBJECT = 1 << 22,
    AG_LAYER_CRYPTO_MATERIAL = 1 << 23
} ag_layer;
#define AG_LAYERS_LIGHT (AG_LAYER_EMISSION | AG_LAYER_DIRECT | AG_LAYER_INDIRECT | AG_LAYER_CAUSTIC | AG_LAYER_SPECULAR)

/* Reads names of layers, separated by commas: "A,Z,albedo", "light" for the parts of light, "all" for those that are
 * the same from run to run and have this library's names. Errors: AG_ERROR_ARGUMENT (a name is unknown). */
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
