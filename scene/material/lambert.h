/* lambert.h: scattering at a plain Lambertian surface, the most common one, without a bsdf.
 * Rests on: Lambert; Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, 5.3 (shading
 * normals).
 * Flow: bvh -> [here] -> photon tracing. It says what bsdf.c says: tests/scene/test_bsdf.c holds the two together.
 * Measured: with a bsdf instead, photons of the Cornell box take 5 % more CPU time, those of veach-ajar 2 %
 * (shortcuts.md). Threads: pure functions. */
#ifndef AFTERGLOW_LAMBERT_H
#define AFTERGLOW_LAMBERT_H

#include "material/bsdf.h"
#include "math/sampling.h"

/* Returns the albedo where the only lobe is Lambertian, about the hit's own shading normal; else NULL. */
static inline const rgb *lambert_albedo(const scene *s, const surface_hit *hit)
{
    if (hit->is_strand)
        return NULL;
    return material_plain_albedo(&s->materials[s->shapes[hit->shape_index].material_index]);
}

static inline bool lambert_is_flat_shaded(const surface_hit *hit)
{
    vec3 n = hit->geometric_normal, ns = hit->shading_normal;
    return n.x == ns.x && n.y == ns.y && n.z == ns.z;
}

/* bsdf_arrival_factor of such a surface. direction: of the flux, unit. */
static inline float lambert_arrival_factor(const surface_hit *hit, vec3 direction)
{
    float geometric = vec3_dot(hit->geometric_normal, direction);
    if (lambert_is_flat_shaded(hit))
        return geometric * geometric > 0.0f ? 1.0f : 0.0f;
    float shading = vec3_dot(hit->shading_normal, direction);
    if (shading * geometric <= 0.0f)
        return 0.0f;
    float factor = shading / geometric;
    return factor < BSDF_SHADING_NORMAL_MAX ? factor : BSDF_SHADING_NORMAL_MAX;
}

/* bsdf_sample_direction of flux that arrived along `arrived`, unit. *out_correction: its weight over the albedo.
 * Returns false where it is absorbed. */
static inline bool lambert_sample_flux(const surface_hit *hit, vec3 arrived, vec2 u, vec3 *out_direction,
                                       float *out_correction)
{
    vec3 i = sample_cosine_hemisphere(u);
    frame around = frame_from_z(hit->geometric_normal);
    i.z = float_select(vec3_dot(arrived, hit->geometric_normal) > 0.0f, -i.z, i.z);
    *out_direction = vec3_normalize(frame_to_world(&around, i));
    *out_correction = lambert_arrival_factor(hit, arrived);
    return *out_correction > 0.0f;
}

#endif
