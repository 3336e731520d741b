/* ggx_albedo.h: directional albedo of a rough interface, single scattering.
 * Rests on: Karis, "Real Shading in Unreal Engine 4", 2013 (the two terms of Schlick's Fresnel); Kulla, Conty,
 * "Revisiting Physically Based Shading at Imageworks", 2017 (what it is good for: what is below gets the rest).
 * Flow: a table -> [here] -> principled. Threads: pure functions. */
#ifndef AFTERGLOW_GGX_ALBEDO_H
#define AFTERGLOW_GGX_ALBEDO_H

/* The albedo of facets with reflectance f0 + (f90 - f0) (1 - cos)^5 is f0 of_f0 + f90 of_f90; of perfect mirrors, the
 * sum. */
typedef struct ggx_albedo {
    float of_f0, of_f90;
} ggx_albedo;

/* Returns both terms. cosine: to the normal, [0, 1]; alpha: [0, 1], below MATERIAL_SMOOTH_ALPHA a mirror. Within 0.007
 * where the cosine is above 0.05. */
ggx_albedo ggx_albedo_of(float alpha, float cosine);

#endif
