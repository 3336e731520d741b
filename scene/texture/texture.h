/* texture.h: values that vary over a surface, as nodes of a graph: a texture refers only to earlier ones.
 * The kinds, their parameters and defaults are pbrt-v4's (pbrt.org/fileformat-v4, "Textures"); Pharr, Jakob, Humphreys,
 * "Physically Based Rendering", 4th ed., 2023, ch. 10. Pictures of colours and checkerboards of two colours are
 * filtered over the footprints of rays that have one; of all else many samples a pixel take the mean.
 * Flow: the scene file makes textures; materials, lights and shapes look them up at a hit.
 * Threads: read-only once the scene is committed; looking up is pure. */
#ifndef AFTERGLOW_TEXTURE_H
#define AFTERGLOW_TEXTURE_H

#include "texture/texture_image.h"
#include "texture/texture_mapping.h"

typedef struct texture_set texture_set; /* texture_set.h */
struct surface_hit;

#define SCENE_NO_TEXTURE UINT32_MAX

enum { TEXTURE_MAX_COST = 4096 };  /* nodes met in one look-up, each as often as it is met */
enum { TEXTURE_MAX_OCTAVES = 32 }; /* finer ones are beyond a float's resolution */

/* The inputs' meaning, in their order. */
typedef enum texture_kind {
    TEXTURE_CONSTANT,      /* value */
    TEXTURE_SCALE,         /* texture, float factor */
    TEXTURE_MIX,           /* at amount 0, at amount 1, float amount */
    TEXTURE_DIRECTION_MIX, /* where the surface faces `direction` or away from it, where it stands along it */
    TEXTURE_CHECKERBOARD,  /* even cells of size 1, odd cells; on the plane, or in space by a solid mapping */
    TEXTURE_IMAGE,         /* none */
    TEXTURE_BILERP,        /* values at (s, t) = (0, 0), (0, 1), (1, 0), (1, 1) */
    TEXTURE_DOTS,          /* inside dots, outside */
    TEXTURE_FBM,           /* none; this and those that follow are solid */
    TEXTURE_WRINKLED,
    TEXTURE_WINDY,
    TEXTURE_MARBLE
} texture_kind;

/* Another texture's value, or one that is the same everywhere. */
typedef struct texture_input {
    uint32_t texture_index; /* SCENE_NO_TEXTURE: value */
    rgb value;              /* of float textures all three are the same */
} texture_input;

typedef struct texture {
    texture_kind kind;
    bool is_spectrum; /* a colour; else a float */
    texture_mapping mapping;
    texture_input inputs[4];
    vec3 direction; /* direction mix: unit, world */
    uint32_t image_index;
    texture_channel channel; /* image, float textures: which of the picture's */
    texture_wraps wraps;
    texture_filter filter;
    bool is_data;    /* image: three numbers, not a colour */
    bool invert;     /* image: 1 - value, after scale */
    float scale;     /* image: of values; marble: of the point */
    int octaves;     /* fbm, wrinkled, marble; [0, TEXTURE_MAX_OCTAVES] */
    float roughness; /* fbm, wrinkled, marble: of an octave over the one before */
    float variation; /* marble */
    uint32_t cost;   /* set by texture_set_add */
    float step;      /* of u and v, over which its slope is to be taken; set by texture_set_add, as all below */
    bool has_pictures, is_linear_in_pictures; /* linear: the mean of its values is the value of its pictures' means;
                                                 a checkerboard counts as a picture, linear if of constant values */
    float most;                               /* no value is larger; infinite where that is not known, or some may be
                                                 below 0, where values are cut */
} texture;

/* The footprint of a ray's cone on a surface, see material/surface_footprint.h. */
typedef struct surface_footprint {
    vec3 axes[2];    /* diameters of an ellipse, world space */
    vec2 uv_axes[2]; /* these diameters in the surface's u and v */
    bool is_coarse;
} surface_footprint;

/* A texture of that kind, without inputs, by the surface's own u and v; a picture as it is, bilinear, repeated. */
texture texture_make(texture_kind kind);

/* The value at a hit. Of a float texture all components are the same. */
rgb texture_evaluate_rgb(const texture_set *set, uint32_t texture_index, const struct surface_hit *hit);
/* The mean value over a footprint, where it is to be had from the mean of the texture's pictures and none of its values
 * is above 1, where reflectances are cut. footprint NULL: the value at the hit. */
rgb texture_filtered_rgb(const texture_set *set, uint32_t texture_index, const struct surface_hit *hit,
                         const surface_footprint *footprint);
/* The value of a float texture at a hit. */
float texture_evaluate_float(const texture_set *set, uint32_t texture_index, const struct surface_hit *hit);

/* Whether texture_filtered_rgb heeds a footprint. */
static inline bool texture_is_filtered(const texture *t)
{
    return t->has_pictures && t->is_spectrum && t->is_linear_in_pictures && t->most <= 1.0f;
}

/* Sets has_pictures, is_linear_in_pictures and most. */
void texture_find_pictures(const texture_set *set, texture *in_out);

#endif
