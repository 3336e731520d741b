/* lobes_metal.c: reflection by facets: of a metal, of a coat, and of a metal under a coat. Directions o (out) and i are
 * in the shading frame, z up to the outside. Rests on: Walter et al., "Microfacet Models for Refraction through Rough
 * Surfaces", 2007; Weidlich, Wilkie, "Arbitrarily Layered Micro-Facet Surfaces", 2007. Threads: pure functions. */
#include "material/bsdf_lobe.h"
#include "material/fresnel.h"

/* --- a metal --- */

static rgb metal_reflectance(const metal_point *m, float cosine) { return fresnel_conductor(cosine, m->eta, m->k); }

static void evaluate_conductor(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                               float *out_pdf)
{
    const metal_point *m = &b->material.metal;
    (void)transport, (void)direction;
    float cosine, value;
    if (bsdf_lobe_reflection(m->facets, o, i, &cosine, &value, out_pdf))
        *out_value = rgb_scale(metal_reflectance(m, cosine), value);
}

static bool mirror_conductor(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                             rgb *out_weight)
{
    vec3 n;
    (void)transport, (void)u_lobe;
    *out_local = bsdf_lobe_mirror(o, &n);
    *out_weight = metal_reflectance(&b->material.metal, fabsf(o.z));
    return true;
}

static bool sample_conductor(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    (void)transport, (void)u_lobe;
    return bsdf_lobe_sample_reflection(b->material.metal.facets, o, u, out_local);
}

const bsdf_lobe_type bsdf_lobe_conductor = {
    .side = LOBE_BY_FACETS,
    .evaluate = evaluate_conductor,
    .sample_smooth = mirror_conductor,
    .sample_rough = sample_conductor,
};

/* --- a coat --- */

static rgb coat_reflectance(const coat_point *m, float cosine) { return rgb_gray(fresnel_dielectric(cosine, m->ior)); }

static void evaluate_coat(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                          float *out_pdf)
{
    const coat_point *m = &b->material.coat;
    (void)transport, (void)direction;
    float cosine, value;
    if (bsdf_lobe_reflection(m->interface, o, i, &cosine, &value, out_pdf))
        *out_value = rgb_scale(coat_reflectance(m, cosine), value);
}

static bool mirror_coat(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local, rgb *out_weight)
{
    vec3 n;
    (void)transport, (void)u_lobe;
    *out_local = bsdf_lobe_mirror(o, &n);
    *out_weight = coat_reflectance(&b->material.coat, fabsf(o.z));
    return true;
}

static bool sample_coat(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    (void)transport, (void)u_lobe;
    return bsdf_lobe_sample_reflection(b->material.coat.interface, o, u, out_local);
}

const bsdf_lobe_type bsdf_lobe_coat = {
    .side = LOBE_BY_FACETS,
    .evaluate = evaluate_coat,
    .sample_smooth = mirror_coat,
    .sample_rough = sample_coat,
};

/* --- a metal under a coat --- */

static void evaluate_coated_conductor(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i,
                                      rgb *out_value, float *out_pdf)
{
    (void)transport, (void)direction;
    coat_metal_lobe(&b->material.coat, o, i, out_value, out_pdf);
}

static bool mirror_coated_conductor(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                                    rgb *out_weight)
{
    const coat_point *m = &b->material.coat;
    vec3 n;
    (void)transport, (void)u_lobe;
    *out_local = bsdf_lobe_mirror(o, &n);
    *out_weight = coat_series(m, fresnel_conductor(fabsf(coat_refract(m, o).z), m->eta, m->k), o.z);
    return true;
}

static bool sample_coated_conductor(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec2 u,
                                    vec3 *out_local)
{
    (void)transport;
    float side = o.z >= 0.0f ? 1.0f : -1.0f;
    vec3 i;
    (void)u_lobe;
    if (o.z == 0.0f || !coat_sample_metal_lobe(&b->material.coat, vec3_scale(o, side), u, &i))
        return false;
    *out_local = vec3_scale(i, side);
    return true;
}

const bsdf_lobe_type bsdf_lobe_conductor_under_coat = {
    .side = LOBE_BY_FACETS,
    .evaluate = evaluate_coated_conductor,
    .sample_smooth = mirror_coated_conductor,
    .sample_rough = sample_coated_conductor,
};
