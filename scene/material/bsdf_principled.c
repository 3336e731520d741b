/* bsdf_principled.c: see bsdf_principled.h. Directions o (out) and i are in the shading frame, z up to the outside.
 * Threads: pure functions. */
#include "material/bsdf_principled.h"

#include "material/bsdf_lobe.h"
#include "material/fresnel.h"
#include "material/microfacet.h"
#include "material/principled.h"

static ggx facets_of(const material *m, bsdf_lobe_kind kind)
{
    if (kind == LOBE_PRINCIPLED)
        return (ggx){m->alpha_u, m->alpha_v};
    float alpha = m->clearcoat_roughness * m->clearcoat_roughness;
    return (ggx){alpha, alpha};
}

static bool is_inside(const material *m, vec3 o) { return o.z < 0.0f && principled_is_solid(m); }

static float sum_of(rgb v) { return v.r + v.g + v.b; }

/* The shares of light that a facet reflects and lets through, and how often reflection is picked. */
typedef struct facet_shares {
    rgb reflected, through;
    float reflection_probability;
} facet_shares;

static facet_shares facet_at(const material *m, vec3 o, float cosine)
{
    facet_shares f;
    principled_interface(m, cosine, is_inside(m, o), &f.reflected, &f.through);
    float r = sum_of(f.reflected), t = sum_of(f.through);
    f.reflection_probability = t > 0.0f ? r / (r + t) : 1.0f;
    return f;
}

static void reflection(const material *m, bsdf_lobe_kind kind, vec3 o, vec3 i, rgb *out_value, float *out_pdf)
{
    ggx facets = facets_of(m, kind);
    vec3 h = ggx_half_vector(o, i);
    float cosine = fabsf(vec3_dot(o, h)), value = ggx_reflection(facets, o, i, h);
    *out_pdf = ggx_reflection_pdf(facets, o, h);
    if (kind == LOBE_CLEARCOAT) {
        *out_value = rgb_gray(value * principled_coat_reflectance(m, cosine));
        return;
    }
    facet_shares f = facet_at(m, o, cosine);
    *out_value = rgb_scale(f.reflected, value * principled_coat_factor(m, o.z, i.z));
    *out_pdf *= f.reflection_probability;
}

static void transmission(const material *m, bsdf_transport transport, vec3 o, vec3 i, rgb *out_value, float *out_pdf)
{
    ggx facets = facets_of(m, LOBE_PRINCIPLED);
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
    *out_value = rgb_scale(f.through, value * principled_coat_factor(m, o.z, i.z));
    *out_pdf *= 1.0f - f.reflection_probability;
}

void bsdf_principled_evaluate(const material *m, bsdf_lobe_kind kind, bsdf_transport transport, vec3 o, vec3 i,
                              rgb *out_value, float *out_pdf)
{
    if (o.z * i.z > 0.0f)
        reflection(m, kind, o, i, out_value, out_pdf);
    else if (o.z * i.z < 0.0f && kind == LOBE_PRINCIPLED && principled_transmits(m))
        transmission(m, transport, o, i, out_value, out_pdf);
}

/* Through a facet, or the surface, of normal n on o's side. */
static bool pass_through(const material *m, vec3 o, vec3 n, vec3 *out_local)
{
    if (m->is_thin) {
        vec3 mirrored = reflect_about(o, n);
        *out_local = (vec3){mirrored.x, mirrored.y, -mirrored.z};
        return true;
    }
    return refract_through(o, n, o.z >= 0.0f ? m->ior : 1.0f / m->ior, out_local);
}

bool bsdf_principled_sample_smooth(const material *m, bsdf_lobe_kind kind, bsdf_transport transport, vec3 o,
                                   float u_lobe, vec3 *out_local, rgb *out_weight)
{
    vec3 n = {0.0f, 0.0f, o.z >= 0.0f ? 1.0f : -1.0f};
    *out_local = reflect_about(o, n);
    if (kind == LOBE_CLEARCOAT) {
        *out_weight = rgb_gray(principled_coat_reflectance(m, fabsf(o.z)));
        return true;
    }
    facet_shares f = facet_at(m, o, fabsf(o.z));
    if (u_lobe < f.reflection_probability) {
        *out_weight = rgb_scale(f.reflected, principled_coat_factor(m, o.z, o.z) / f.reflection_probability);
        return true;
    }
    if (!pass_through(m, o, n, out_local))
        return false;
    float scale = principled_coat_factor(m, o.z, out_local->z) / (1.0f - f.reflection_probability);
    if (transport == BSDF_RADIANCE && !m->is_thin)
        scale *= o.z >= 0.0f ? 1.0f / (m->ior * m->ior) : m->ior * m->ior;
    *out_weight = rgb_scale(f.through, scale);
    return true;
}

bool bsdf_principled_sample_rough(const material *m, bsdf_lobe_kind kind, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    float side = o.z >= 0.0f ? 1.0f : -1.0f;
    vec3 h = ggx_sample_visible(facets_of(m, kind), vec3_scale(o, side), u);
    h = vec3_scale(h, side);
    bool is_reflection =
        kind == LOBE_CLEARCOAT || u_lobe < facet_at(m, o, fabsf(vec3_dot(o, h))).reflection_probability;
    if (is_reflection)
        *out_local = reflect_about(o, h);
    else if (!pass_through(m, o, h, out_local))
        return false;
    return is_reflection == (out_local->z * o.z > 0.0f); /* else another facet would meet it */
}
