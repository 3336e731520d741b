/* lobes_glass.c: reflection and transmission by glass: a surface of it, a thin pane, and a slab met at once. Smooth
 * lobes reflect and refract by shares of their own, so that their weights are 1 but for what is absorbed. Directions o
 * (out) and i are in the shading frame, z up to the outside. Rests on: Walter et al., "Microfacet Models for Refraction
 * through Rough Surfaces", 2007; Pharr, Jakob, Humphreys, 4th ed., 2023, ch. 9. Threads: pure functions. */
#include "material/bsdf_lobe.h"
#include "material/fresnel.h"

static void evaluate_dielectric(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                                float *out_pdf)
{
    const glass_point *m = &b->material.glass;
    float relative = o.z > 0.0f ? m->ior : 1.0f / m->ior, share, cosine, value;
    (void)direction;
    if (o.z * i.z > 0.0f) {
        vec3 h = ggx_half_vector(o, i);
        share = fresnel_dielectric(fabsf(vec3_dot(o, h)), relative);
        value = ggx_reflection(m->facets, o, i, h);
        *out_pdf = ggx_reflection_pdf(m->facets, o, h);
    } else {
        if (!bsdf_lobe_refraction(m->facets, m->ior, transport, o, i, &cosine, &value, out_pdf))
            return;
        share = 1.0f - fresnel_dielectric(cosine, relative);
    }
    *out_value = rgb_gray(value * share);
    *out_pdf *= share;
}

static float dielectric_reflection_share(const bsdf *b, vec3 o)
{
    float ior = b->material.glass.ior;
    return fresnel_dielectric(fabsf(o.z), o.z >= 0.0f ? ior : 1.0f / ior);
}

static bool mirror_dielectric(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                              rgb *out_weight)
{
    vec3 n;
    float ior = b->material.glass.ior, eta = o.z >= 0.0f ? ior : 1.0f / ior;
    *out_local = bsdf_lobe_mirror(o, &n);
    *out_weight = rgb_gray(1.0f);
    if (u_lobe < dielectric_reflection_share(b, o))
        return true;
    if (!refract_through(o, n, eta, out_local))
        return false;
    if (transport == BSDF_RADIANCE)
        *out_weight = rgb_gray(1.0f / (eta * eta));
    return true;
}

static bool sample_dielectric(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    (void)transport;
    const glass_point *m = &b->material.glass;
    vec3 upper, h, i;
    float side;
    if (!bsdf_lobe_sample_facet(m->facets, o, u, &upper, &h, &side))
        return false;
    float eta = side > 0.0f ? m->ior : 1.0f / m->ior;
    bool is_reflection = u_lobe < fresnel_dielectric(fabsf(vec3_dot(upper, h)), eta);
    if (is_reflection)
        i = reflect_about(upper, h);
    else if (!refract_through(upper, h, eta, &i))
        return false;
    *out_local = vec3_scale(i, side);
    return is_reflection == (i.z > 0.0f); /* else another facet would meet it */
}

static float glass_index(const material_point *m) { return m->glass.ior; }

const bsdf_lobe_type bsdf_lobe_dielectric = {
    .side = LOBE_BY_FACETS,
    .evaluate = evaluate_dielectric,
    .sample_smooth = mirror_dielectric,
    .reflection_share = dielectric_reflection_share,
    .sample_rough = sample_dielectric,
    .passes = true,
    .index = glass_index,
};

static float thin_dielectric_reflection_share(const bsdf *b, vec3 o)
{
    return fresnel_thin_dielectric(fabsf(o.z), b->material.glass.ior);
}

static bool mirror_thin_dielectric(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                                   rgb *out_weight)
{
    vec3 n;
    (void)transport;
    *out_local = u_lobe < thin_dielectric_reflection_share(b, o) ? bsdf_lobe_mirror(o, &n) : vec3_negate(o);
    *out_weight = rgb_gray(1.0f);
    return true;
}

const bsdf_lobe_type bsdf_lobe_thin_dielectric = {
    .side = LOBE_BY_FACETS,
    .sample_smooth = mirror_thin_dielectric,
    .reflection_share = thin_dielectric_reflection_share,
    .passes = true,
};

static float slab_reflection_share(const bsdf *b, vec3 o)
{
    const slab_point *m = &b->material.slab;
    float reflected = rgb_max(m->reflected), all = reflected + rgb_max(m->through);
    (void)o;
    return all > 0.0f ? reflected / all : 0.0f;
}

/* false: all is absorbed. */
static bool mirror_slab(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local, rgb *out_weight)
{
    vec3 n;
    const slab_point *m = &b->material.slab;
    (void)transport;
    if (rgb_is_black(m->reflected) && rgb_is_black(m->through))
        return false;
    float share = slab_reflection_share(b, o);
    bool goes_through = u_lobe >= share;
    *out_local = goes_through ? vec3_negate(o) : bsdf_lobe_mirror(o, &n);
    *out_weight = goes_through ? rgb_scale(m->through, 1.0f / (1.0f - share)) : rgb_scale(m->reflected, 1.0f / share);
    return true;
}

const bsdf_lobe_type bsdf_lobe_slab = {
    .side = LOBE_BY_FACETS,
    .sample_smooth = mirror_slab,
    .reflection_share = slab_reflection_share,
    .passes = true,
};
