/* sheen.h: what the fibres on a surface of cloth reflect: the value of the lobe, and its directional albedo.
 * Rests on: Estevez, Kulla, "Production Friendly Microfacet Sheen BRDF", 2017, as Khronos, KHR_materials_sheen has it
 * (SHEEN_CHARLIE); Burley, "Physically Based Shading at Disney", 2012, 5.4, as Blender's Principled BSDF has it
 * (SHEEN_SCHLICK); Ashikhmin, Premoze, Shirley, "A Microfacet-based BRDF Generator", 2000, as Blender's Velvet BSDF has
 * it (SHEEN_VELVET).
 * Flow: material -> principled -> [here] <- lobes_sheen. Threads: pure functions.
 *
 * Three models, since none is another's special case: Charlie's fibres reflect back to where light comes from as well
 * as on beyond it, Burley's term is strongest where light goes on beyond the surface, and Ashikhmin's rim is far
 * brighter than either. */
#ifndef AFTERGLOW_SHEEN_H
#define AFTERGLOW_SHEEN_H

#include "math/vec3.h"

typedef enum sheen_model { SHEEN_CHARLIE, SHEEN_SCHLICK, SHEEN_VELVET } sheen_model;

/* The least roughness of fibres; smaller ones are taken for this one: below it almost all of the lobe is within a few
 * degrees of the surface. */
#define SHEEN_ROUGHNESS_MIN 0.07f

/* Returns the BRDF, 1/sr, for a factor of 1. o, i: unit, in the shading frame, with z > 0. roughness: [0, 1], of
 * SHEEN_SCHLICK without meaning. It is symmetric in o and i. */
float sheen_value(sheen_model model, float roughness, vec3 o, vec3 i);

/* Returns the share of light at a cosine in [0, 1] to the normal that is reflected in all, at most 1 /
 * sheen_factor_max. It is within 0.01 of the integral of sheen_value where the cosine is above 0.02, but for
 * SHEEN_CHARLIE below a roughness of 0.3, where it is an upper bound. */
float sheen_albedo(sheen_model model, float roughness, float cosine);

/* Returns the largest factor by which the lobe may be multiplied: with it none reflects more light than it gets. */
float sheen_factor_max(sheen_model model);

#endif
