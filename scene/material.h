/* material.h: what a surface is made of, as the scene file says it; bsdf.h makes scattering of it.
 * The parameters and their defaults are pbrt-v4's (pbrt.org/fileformat-v4, "Materials").
 * Threads: read-only once the scene is committed. */
#ifndef AFTERGLOW_MATERIAL_H
#define AFTERGLOW_MATERIAL_H

#include "math/vec3.h"

typedef enum material_kind { MATERIAL_DIFFUSE, MATERIAL_CONDUCTOR, MATERIAL_DIELECTRIC } material_kind;

typedef struct material {
    material_kind kind;
    rgb reflectance;   /* diffuse: albedo, [0, 1] */
    rgb eta, k;        /* conductor: index of refraction (> 0) and absorption (>= 0) */
    float ior;         /* dielectric: inside over outside, > 0 */
    float alpha_u, alpha_v; /* GGX roughness after remapping, >= 0; below BSDF_SMOOTH_ALPHA the surface is smooth */
} material;

#endif
