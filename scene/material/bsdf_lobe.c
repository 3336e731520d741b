/* bsdf_lobe.c: see bsdf_lobe.h. Directions o (out) and i are in the shading frame, z up to the outside.
 * Threads: pure functions. */
#include "material/bsdf_lobe.h"

#include "material/bsdf_principled.h"
#include "material/coat.h"
#include "material/fresnel.h"
#include "material/principled.h"

static ggx interface_of(const material *m) { return (ggx){m->alpha_u, m->alpha_v}; }

float bsdf_lobe_transmittance(const material *m, float cos_theta)
{
    if (m->kind == MATERIAL_PRINCIPLED)
        return principled_base_transmittance(m, cos_theta);
    return m->kind == MATERIAL_COATED_DIFFUSE ? coat_entry(m, cos_theta) : 1.0f;
}

rgb bsdf_lobe_diffuse_albedo(const material *m)
{
    if (m->kind == MATERIAL_PRINCIPLED)
        return principled_base_albedo(m);
    return m->kind == MATERIAL_COATED_DIFFUSE ? coat_diffuse_albedo(m) : m->reflectance;
}

/* Judged by the geometry, which alone cannot leak. */
bool bsdf_is_same_side(const bsdf *b, vec3 direction)
{
    return vec3_dot(b->out, b->geometric_normal) * vec3_dot(direction, b->geometric_normal) > 0.0f;
}

/* The cosine of a direction to the shading normal on the side of the surface that its lobe is on, 0 beyond the horizon
 * of either normal. i: the direction in the shading frame. */
static float diffuse_cosine(const bsdf *b, bsdf_lobe_kind kind, vec3 direction, vec3 i)
{
    bool is_through = kind == LOBE_DIFFUSE_THROUGH;
    if (bsdf_is_same_side(b, direction) == is_through)
        return 0.0f;
    float side = (vec3_dot(b->out, b->geometric_normal) < 0.0f) != is_through ? -1.0f : 1.0f;
    return fmaxf(0.0f, side * i.z);
}

/* diffuse_cosine to the geometric normal: by it flux leaves a diffuse lobe, whose radiance is the same all around. */
static float geometric_cosine(const bsdf *b, bsdf_lobe_kind kind, vec3 direction)
{
    bool is_there = bsdf_is_same_side(b, direction) != (kind == LOBE_DIFFUSE_THROUGH);
    return is_there ? fabsf(vec3_dot(direction, b->geometric_normal)) : 0.0f;
}

/* Walter 2007, eq. 20, 21; the density's factors follow Pharr et al., 9.7. */
bool bsdf_lobe_refraction(ggx facets, float ior, bsdf_transport transport, vec3 o, vec3 i, float *out_cosine,
                          float *out_value, float *out_pdf)
{
    float eta = o.z > 0.0f ? ior : 1.0f / ior;
    vec3 h = vec3_add(vec3_scale(i, eta), o);
    float square = vec3_length_squared(h);
    if (o.z == 0.0f || i.z == 0.0f || square == 0.0f)
        return false;
    h = vec3_scale(h, 1.0f / sqrtf(square));
    if (h.z < 0.0f)
        h = vec3_negate(h);
    float oh = vec3_dot(o, h), ih = vec3_dot(i, h);
    if (ih * i.z < 0.0f || oh * o.z < 0.0f)
        return false; /* a back-facing microfacet */
    vec3 upper = o.z > 0.0f ? o : vec3_negate(o);
    float sum = ih + oh / eta, jacobian = fabsf(ih) / (sum * sum);
    *out_cosine = fabsf(oh);
    *out_value = ggx_density(facets, h) * ggx_masking_shadowing(facets, o, i) * fabsf(ih * oh / (o.z * sum * sum));
    if (transport == BSDF_RADIANCE)
        *out_value /= eta * eta;
    *out_pdf = ggx_visible_density(facets, upper, h) * jacobian;
    return true;
}

/* Rough dielectric, one way: value (f |cos|) and density of scattering from o to i. */
static void rough_dielectric(const material *m, bsdf_transport transport, vec3 o, vec3 i, float *out_value,
                             float *out_pdf)
{
    ggx facets = interface_of(m);
    float relative = o.z > 0.0f ? m->ior : 1.0f / m->ior, share, cosine;
    *out_value = *out_pdf = 0.0f;
    if (o.z * i.z > 0.0f) {
        vec3 h = ggx_half_vector(o, i);
        share = fresnel_dielectric(fabsf(vec3_dot(o, h)), relative);
        *out_value = ggx_reflection(facets, o, i, h);
        *out_pdf = ggx_reflection_pdf(facets, o, h);
    } else {
        if (!bsdf_lobe_refraction(facets, m->ior, transport, o, i, &cosine, out_value, out_pdf))
            return;
        share = 1.0f - fresnel_dielectric(cosine, relative);
    }
    *out_value *= share;
    *out_pdf *= share;
}

/* Value (f |cos|) and density of one lobe that is not smooth. */
void bsdf_lobe_evaluate(const bsdf *b, const bsdf_lobe *lobe, bsdf_transport transport, vec3 direction, vec3 o, vec3 i,
                        rgb *out_value, float *out_pdf)
{
    const material *m = &b->parameters;
    *out_value = rgb_gray(0.0f);
    *out_pdf = 0.0f;
    switch (lobe->kind) {
    case LOBE_DIFFUSE:
    case LOBE_DIFFUSE_THROUGH: {
        bool is_flux = transport == BSDF_FLUX;
        float arrived = is_flux ? bsdf_arrival_factor(b) : bsdf_lobe_transmittance(m, o.z);
        float cosine =
            is_flux ? geometric_cosine(b, lobe->kind, direction) : diffuse_cosine(b, lobe->kind, direction, i);
        rgb albedo = lobe->kind == LOBE_DIFFUSE ? bsdf_lobe_diffuse_albedo(m) : m->transmittance;
        if (is_flux && !(arrived > 0.0f))
            return;
        *out_pdf = cosine * AG_INV_PI;
        *out_value = rgb_scale(albedo, *out_pdf * arrived * bsdf_lobe_transmittance(m, i.z));
        return;
    }
    case LOBE_DIELECTRIC: {
        float value;
        rough_dielectric(m, transport, o, i, &value, out_pdf);
        *out_value = rgb_gray(value);
        return;
    }
    case LOBE_COAT_SCATTERED:
        *out_pdf = diffuse_cosine(b, lobe->kind, direction, i) * AG_INV_PI;
        if (*out_pdf > 0.0f)
            *out_value = rgb_scale(coat_scattered(m, o, i), *out_pdf);
        return;
    case LOBE_CONDUCTOR:
    case LOBE_COAT: {
        if (o.z * i.z <= 0.0f)
            return;
        ggx facets = interface_of(m);
        vec3 h = ggx_half_vector(o, i);
        float cosine = fabsf(vec3_dot(o, h));
        rgb reflected = lobe->kind == LOBE_CONDUCTOR ? fresnel_conductor(cosine, m->eta, m->k)
                                                     : rgb_gray(fresnel_dielectric(cosine, m->ior));
        *out_value = rgb_scale(reflected, ggx_reflection(facets, o, i, h));
        *out_pdf = ggx_reflection_pdf(facets, o, h);
        return;
    }
    case LOBE_CONDUCTOR_UNDER_COAT:
        coat_metal_lobe(m, o, i, out_value, out_pdf);
        return;
    case LOBE_HAIR: hair_evaluate(&b->fibre, transport == BSDF_FLUX, i, out_value, out_pdf); return;
    case LOBE_PRINCIPLED:
    case LOBE_CLEARCOAT:
        bsdf_principled_evaluate(m, lobe->kind, transport, o, i, out_value, out_pdf);
        return;
    case LOBE_THIN_DIELECTRIC:
    case LOBE_SLAB: return; /* always smooth */
    }
}

/* --- sampling --- */

/* A smooth lobe's one direction, and its weight once it has been picked. */
/* *in_out_local is the mirror's direction. false: all is absorbed. */
static bool sample_slab(const bsdf *b, vec3 o, float u_lobe, vec3 *in_out_local, rgb *out_weight)
{
    float reflected = rgb_max(b->slab_reflected), all = reflected + rgb_max(b->slab_through);
    if (!(all > 0.0f))
        return false;
    float share = reflected / all;
    bool goes_through = u_lobe >= share;
    if (goes_through)
        *in_out_local = vec3_negate(o);
    *out_weight =
        goes_through ? rgb_scale(b->slab_through, 1.0f / (1.0f - share)) : rgb_scale(b->slab_reflected, 1.0f / share);
    return true;
}

bool bsdf_lobe_sample_smooth(const bsdf *b, bsdf_lobe_kind kind, bsdf_transport transport, vec3 o, float u_lobe,
                             vec3 *out_local, rgb *out_weight)
{
    const material *m = &b->parameters;
    if (kind == LOBE_PRINCIPLED || kind == LOBE_CLEARCOAT)
        return bsdf_principled_sample_smooth(m, kind, transport, o, u_lobe, out_local, out_weight);
    vec3 n = {0.0f, 0.0f, o.z >= 0.0f ? 1.0f : -1.0f};
    float cosine = fabsf(o.z), eta = o.z >= 0.0f ? m->ior : 1.0f / m->ior;
    *out_local = reflect_about(o, n);
    *out_weight = rgb_gray(1.0f); /* reflection and refraction are picked by their own shares */
    switch (kind) {
    case LOBE_CONDUCTOR: *out_weight = fresnel_conductor(cosine, m->eta, m->k); return true;
    case LOBE_COAT: *out_weight = rgb_gray(fresnel_dielectric(cosine, m->ior)); return true;
    case LOBE_CONDUCTOR_UNDER_COAT: {
        rgb metal = fresnel_conductor(fabsf(coat_refract(m, o).z), m->eta, m->k);
        *out_weight = coat_series(m, metal, o.z);
        return true;
    }
    case LOBE_THIN_DIELECTRIC:
        if (u_lobe >= fresnel_thin_dielectric(cosine, m->ior))
            *out_local = vec3_negate(o);
        return true;
    case LOBE_SLAB: return sample_slab(b, o, u_lobe, out_local, out_weight);
    default: break;
    }
    if (u_lobe < fresnel_dielectric(cosine, eta))
        return true;
    if (!refract_through(o, n, eta, out_local))
        return false;
    if (transport == BSDF_RADIANCE)
        *out_weight = rgb_gray(1.0f / (eta * eta));
    return true;
}

/* A direction of a lobe that is not smooth, in the shading frame. */
bool bsdf_lobe_sample_rough(const bsdf *b, bsdf_lobe_kind kind, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    const material *m = &b->parameters;
    if (kind == LOBE_DIFFUSE || kind == LOBE_DIFFUSE_THROUGH || kind == LOBE_COAT_SCATTERED) {
        *out_local = sample_cosine_hemisphere(u);
        if ((vec3_dot(b->out, b->geometric_normal) < 0.0f) != (kind == LOBE_DIFFUSE_THROUGH))
            out_local->z = -out_local->z;
        return true;
    }
    if (kind == LOBE_PRINCIPLED || kind == LOBE_CLEARCOAT)
        return bsdf_principled_sample_rough(m, kind, o, u_lobe, u, out_local);
    if (kind == LOBE_HAIR) {
        *out_local = hair_sample(&b->fibre, u_lobe, u);
        return true;
    }
    if (o.z == 0.0f)
        return false; /* facets have no density there */
    float side = o.z >= 0.0f ? 1.0f : -1.0f;
    vec3 upper = vec3_scale(o, side), i;
    if (kind == LOBE_CONDUCTOR_UNDER_COAT) {
        if (!coat_sample_metal_lobe(m, upper, u, &i))
            return false;
        *out_local = vec3_scale(i, side);
        return true;
    }
    vec3 h = ggx_sample_visible(interface_of(m), upper, u);
    float eta = side > 0.0f ? m->ior : 1.0f / m->ior;
    bool is_reflection = kind != LOBE_DIELECTRIC || u_lobe < fresnel_dielectric(fabsf(vec3_dot(upper, h)), eta);
    if (is_reflection)
        i = reflect_about(upper, h);
    else if (!refract_through(upper, h, eta, &i))
        return false;
    if (is_reflection != (i.z > 0.0f))
        return false; /* the facet sends it to the wrong side of the surface, where another facet would meet it */
    *out_local = vec3_scale(i, side);
    return true;
}
