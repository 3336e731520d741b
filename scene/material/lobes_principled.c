/* lobes_principled.c: the traced lobes of MATERIAL_PRINCIPLED: reflection and transmission by the interface, and the
 * coat. Directions o (out) and i are in the shading frame, z up to the outside. Rests on: Khronos, glTF 2.0 and
 * KHR_materials_transmission (of a thin wall: the lobe of reflection, mirrored); Walter et al., "Microfacet Models for
 * Refraction through Rough Surfaces", 2007. Threads: pure functions. */
#include "material/bsdf_lobe.h"
#include "material/fresnel.h"

static ggx coat_facets_of(const principled_point *m)
{
    float alpha = m->clearcoat_roughness * m->clearcoat_roughness;
    return (ggx){alpha, alpha};
}

/* --- the interface --- */

static bool is_inside(const principled_point *m, vec3 o) { return o.z < 0.0f && principled_is_solid(m); }

static float sum_of(rgb v) { return v.r + v.g + v.b; }

/* The shares of light that a facet reflects and lets through, and how often reflection is picked. */
typedef struct facet_shares {
    rgb reflected, through;
    float reflection_probability;
} facet_shares;

static facet_shares facet_at(const principled_point *m, vec3 o, float cosine)
{
    facet_shares f;
    principled_interface(m, cosine, is_inside(m, o), &f.reflected, &f.through);
    float r = sum_of(f.reflected), t = sum_of(f.through);
    f.reflection_probability = t > 0.0f ? r / (r + t) : 1.0f;
    return f;
}

static void reflection(const principled_point *m, vec3 o, vec3 i, rgb *out_value, float *out_pdf)
{
    ggx facets = m->facets;
    vec3 h = ggx_half_vector(o, i);
    float cosine = fabsf(vec3_dot(o, h)), value = ggx_reflection(facets, o, i, h);
    facet_shares f = facet_at(m, o, cosine);
    *out_value = rgb_scale(f.reflected, value * principled_cover_factor(m, o.z, i.z));
    *out_pdf = ggx_reflection_pdf(facets, o, h) * f.reflection_probability;
}

static void transmission(const principled_point *m, bsdf_transport transport, vec3 o, vec3 i, rgb *out_value,
                         float *out_pdf)
{
    ggx facets = m->facets;
    float value, cosine;
    if (m->is_thin) {
        vec3 mirrored = {i.x, i.y, -i.z}, h = ggx_half_vector(o, mirrored);
        cosine = fabsf(vec3_dot(o, h));
        value = ggx_reflection(facets, o, mirrored, h);
        *out_pdf = ggx_reflection_pdf(facets, o, h);
    } else if (!bsdf_lobe_refraction(facets, m->ior, transport, o, i, &cosine, &value, out_pdf)) {
        return;
    }
    facet_shares f = facet_at(m, o, cosine);
    *out_value = rgb_scale(f.through, value * principled_cover_factor(m, o.z, i.z));
    *out_pdf *= 1.0f - f.reflection_probability;
}

static void evaluate_principled(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                                float *out_pdf)
{
    const principled_point *m = &b->material.principled;
    (void)direction;
    if (o.z * i.z > 0.0f)
        reflection(m, o, i, out_value, out_pdf);
    else if (o.z * i.z < 0.0f && principled_transmits(m))
        transmission(m, transport, o, i, out_value, out_pdf);
}

/* Through a facet, or the surface, of normal n on o's side. */
static bool pass_through(const principled_point *m, vec3 o, vec3 n, vec3 *out_local)
{
    if (m->is_thin) {
        vec3 mirrored = reflect_about(o, n);
        *out_local = (vec3){mirrored.x, mirrored.y, -mirrored.z};
        return true;
    }
    return refract_through(o, n, o.z >= 0.0f ? m->ior : 1.0f / m->ior, out_local);
}

static float principled_reflection_share(const bsdf *b, vec3 o)
{
    return facet_at(&b->material.principled, o, fabsf(o.z)).reflection_probability;
}

static bool mirror_principled(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                              rgb *out_weight)
{
    const principled_point *m = &b->material.principled;
    vec3 n;
    *out_local = bsdf_lobe_mirror(o, &n);
    facet_shares f = facet_at(m, o, fabsf(o.z));
    if (u_lobe < f.reflection_probability) {
        *out_weight = rgb_scale(f.reflected, principled_cover_factor(m, o.z, o.z) / f.reflection_probability);
        return true;
    }
    if (!pass_through(m, o, n, out_local))
        return false;
    float scale = principled_cover_factor(m, o.z, out_local->z) / (1.0f - f.reflection_probability);
    if (transport == BSDF_RADIANCE && !m->is_thin)
        scale *= o.z >= 0.0f ? 1.0f / (m->ior * m->ior) : m->ior * m->ior;
    *out_weight = rgb_scale(f.through, scale);
    return true;
}

/* A facet that o sees, on o's side. */
static vec3 sample_facet_of(ggx facets, vec3 o, vec2 u)
{
    float side = o.z >= 0.0f ? 1.0f : -1.0f;
    return vec3_scale(ggx_sample_visible(facets, vec3_scale(o, side), u), side);
}

static bool sample_principled(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    (void)transport;
    const principled_point *m = &b->material.principled;
    vec3 h = sample_facet_of(m->facets, o, u);
    bool is_reflection = u_lobe < facet_at(m, o, fabsf(vec3_dot(o, h))).reflection_probability;
    if (is_reflection)
        *out_local = reflect_about(o, h);
    else if (!pass_through(m, o, h, out_local))
        return false;
    return is_reflection == (out_local->z * o.z > 0.0f); /* else another facet would meet it */
}

static bool passes_with(const material_point *m) { return principled_transmits(&m->principled); }

static float index_of(const material_point *m) { return m->principled.ior; }

const bsdf_lobe_type bsdf_lobe_principled = {
    .side = LOBE_BY_FACETS,
    .evaluate = evaluate_principled,
    .sample_smooth = mirror_principled,
    .reflection_share = principled_reflection_share,
    .sample_rough = sample_principled,
    .passes = true,
    .passes_with = passes_with,
    .index = index_of,
};

/* --- the coat --- */

static void evaluate_clearcoat(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                               float *out_pdf)
{
    const principled_point *m = &b->material.principled;
    (void)transport, (void)direction;
    float cosine, value;
    if (bsdf_lobe_reflection(coat_facets_of(m), o, i, &cosine, &value, out_pdf))
        *out_value = rgb_gray(value * principled_coat_reflectance(m, cosine));
}

static bool mirror_clearcoat(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                             rgb *out_weight)
{
    vec3 n;
    (void)transport, (void)u_lobe;
    *out_local = bsdf_lobe_mirror(o, &n);
    *out_weight = rgb_gray(principled_coat_reflectance(&b->material.principled, fabsf(o.z)));
    return true;
}

static bool sample_clearcoat(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    (void)transport, (void)u_lobe;
    return bsdf_lobe_sample_reflection(coat_facets_of(&b->material.principled), o, u, out_local);
}

const bsdf_lobe_type bsdf_lobe_clearcoat = {
    .side = LOBE_BY_FACETS,
    .evaluate = evaluate_clearcoat,
    .sample_smooth = mirror_clearcoat,
    .sample_rough = sample_clearcoat,
};
