/* principled.c: see principled.h. Threads: pure functions. */
#include "material/principled.h"

#include "material/fresnel.h"
#include "material/ggx_albedo.h"
#include "material/material.h"
#include "material/sheen.h"

/* glTF's coat has an index of 1.5. */
static const float COAT_F0 = 0.04f;
/* Refraction by rough facets needs half vectors, which are lost where the index does not change. */
static const float ROUGH_IOR_MIN = 1.001f;

static float clamp_to_unit(float x) { return float_clamp(x, 0.0f, 1.0f); }

static float coat_alpha(const principled_point *m) { return m->clearcoat_roughness * m->clearcoat_roughness; }

/* The shares of the light at the interface that may enter, and go through. */
static float through_share(const principled_point *m)
{
    return m->ior > 0.0f ? (1.0f - m->metallic) * m->transmission : 0.0f;
}

static float base_share(const principled_point *m) { return (1.0f - m->metallic) * (1.0f - m->transmission); }

bool principled_transmits(const principled_point *m) { return through_share(m) > 0.0f; }

bool principled_is_solid(const principled_point *m) { return !m->is_thin && principled_transmits(m); }

bool principled_has_interface(const principled_point *m)
{
    return m->metallic > 0.0f || m->specular > 0.0f || principled_transmits(m);
}

static rgb schlick(rgb f0, float f90, float weight)
{
    return rgb_add(rgb_scale(f0, 1.0f - weight), rgb_gray(f90 * weight));
}

static float coat_through(const principled_point *m, float cosine)
{
    if (m->clearcoat == 0.0f)
        return 1.0f;
    ggx_albedo coat = ggx_albedo_of(coat_alpha(m), cosine);
    return 1.0f - m->clearcoat * (COAT_F0 * coat.of_f0 + coat.of_f90);
}

/* The material has a sheen. What lies below it gets what it leaves of the colour that it reflects most, as
 * KHR_materials_sheen has it. */
static float sheen_through(const principled_point *m, float cosine)
{
    return float_max(1.0f - rgb_max(m->sheen) * sheen_albedo((sheen_model)m->sheen_model, m->sheen_roughness, cosine),
                     0.0f);
}

static float cover_through(const principled_point *m, float cosine)
{
    const float through = coat_through(m, cosine);
    return m->has_sheen ? through * sheen_through(m, cosine) : through;
}

static float interface_reflectance_of(const principled_point *m, float alpha, float cosine)
{
    const ggx_albedo interface = ggx_albedo_of(alpha, cosine);
    /* the colour that is reflected most: the base gets no light twice, whatever its own colour */
    return rgb_max(m->dielectric_f0) * interface.of_f0 + m->specular * interface.of_f90;
}

/* Returns the share of the light at a cosine that a dielectric interface reflects. Brushed facets reflect more in some
 * directions about the normal than in others: they count as rough as on that of their axes which reflects more. */
static float interface_reflectance(const principled_point *m, float cosine)
{
    const float u = interface_reflectance_of(m, m->facets.alpha_u, cosine);
    return m->facets.alpha_u == m->facets.alpha_v
               ? u
               : float_max(u, interface_reflectance_of(m, m->facets.alpha_v, cosine));
}

float principled_base_transmittance(const principled_point *m, float cosine)
{
    cosine = fabsf(cosine);
    return float_max(1.0f - interface_reflectance(m, cosine), 0.0f) * cover_through(m, cosine);
}

/* The mean of t over the hemisphere, by Gauss's rule of 6 points. */
static float mean_base_transmittance(const principled_point *m)
{
    static const float NODES[3] = {0.2386191861f, 0.6612093865f, 0.9324695142f};
    static const float WEIGHTS[3] = {0.4679139346f, 0.3607615730f, 0.1713244924f};
    float sum = 0.0f;
    for (int i = 0; i < 3; i++)
        for (int side = -1; side <= 1; side += 2) {
            float cosine = 0.5f + 0.5f * (float)side * NODES[i];
            sum += WEIGHTS[i] * cosine * principled_base_transmittance(m, cosine);
        }
    return sum; /* twice the integral of t cos over cos */
}

static rgb bound_below(rgb v) { return rgb_make(float_max(v.r, 0.0f), float_max(v.g, 0.0f), float_max(v.b, 0.0f)); }

static rgb bound_above(rgb v) { return rgb_make(float_min(v.r, 1.0f), float_min(v.g, 1.0f), float_min(v.b, 1.0f)); }

/* Khronos, KHR_materials_anisotropy: along the grain the roughness goes from that across it to 1. */
ggx principled_facets(float roughness_u, float roughness_v, float anisotropy)
{
    const float u = clamp_to_unit(roughness_u), v = roughness_v < 0.0f ? u : clamp_to_unit(roughness_v);
    const float strength = clamp_to_unit(anisotropy);
    ggx facets = {u * u, v * v};
    if (strength > 0.0f)
        facets.alpha_u += (1.0f - facets.alpha_u) * (strength * strength);
    material_make_rough_on_both_axes(&facets.alpha_u, &facets.alpha_v);
    return facets;
}

void principled_resolve(principled_point *p, rgb specular_color)
{
    p->reflectance = bound_above(bound_below(p->reflectance));
#define CLAMP_SHARE(name) p->name = clamp_to_unit(p->name);
    PRINCIPLED_SHARE_LIST(CLAMP_SHARE)
#undef CLAMP_SHARE
    p->sheen = rgb_clamp(p->sheen, 0.0f, sheen_factor_max((sheen_model)p->sheen_model));
    p->has_sheen = !rgb_is_black(p->sheen);
    float f0 = 1.0f; /* ior 0 is glTF's word for an infinite one */
    if (p->ior > 0.0f) {
        p->ior = float_max(p->ior, 1.0f);
        if (!material_is_smooth(p->facets.alpha_u, p->facets.alpha_v) && principled_is_solid(p))
            p->ior = float_max(p->ior, ROUGH_IOR_MIN);
        float root = (p->ior - 1.0f) / (p->ior + 1.0f);
        f0 = root * root;
    }
    rgb color = rgb_scale(bound_below(specular_color), f0);
    p->dielectric_f0 = rgb_scale(bound_above(color), p->specular);
    p->base_through = base_share(p) > 0.0f ? mean_base_transmittance(p) : 0.0f;
}

principled_point principled_point_of(const material *m)
{
    return (principled_point){.reflectance = m->reflectance,
                              .dielectric_f0 = m->dielectric_f0,
                              .ior = m->ior,
                              .facets = {m->alpha_u, m->alpha_v},
#define SHARE_OF_MATERIAL(name) .name = m->name,
                              PRINCIPLED_SHARE_LIST(SHARE_OF_MATERIAL)
#undef SHARE_OF_MATERIAL
                                  .base_through = m->base_through,
                              .sheen = m->sheen,
                              .has_sheen = !rgb_is_black(m->sheen),
                              .sheen_model = (uint8_t)m->sheen_model,
                              .is_thin = m->is_thin};
}

void principled_prepare(material *m)
{
    principled_point p = principled_point_of(m);
    p.facets = principled_facets(m->roughness, m->roughness_v, m->anisotropy);
    principled_resolve(&p, m->specular_color);
    m->reflectance = p.reflectance;
    m->specular_color = bound_below(m->specular_color);
#define RESOLVED_SHARE(name) m->name = p.name;
    PRINCIPLED_SHARE_LIST(RESOLVED_SHARE)
#undef RESOLVED_SHARE
    m->roughness = clamp_to_unit(m->roughness);
    m->roughness_v = float_min(m->roughness_v, 1.0f);
    m->anisotropy = clamp_to_unit(m->anisotropy);
    m->sheen = p.sheen;
    m->ior = p.ior;
    m->alpha_u = p.facets.alpha_u;
    m->alpha_v = p.facets.alpha_v;
    m->dielectric_f0 = p.dielectric_f0;
    m->base_through = p.base_through;
}

rgb principled_base_albedo(const principled_point *m)
{
    /* nothing gets through worth a base: 0 over 0 */
    if (m->base_through < 1e-4f)
        return rgb_gray(0.0f);
    return rgb_scale(m->reflectance, base_share(m) / m->base_through);
}

void principled_interface(const principled_point *m, float cosine, bool is_inside, rgb *out_reflected, rgb *out_through)
{
    float weight = fresnel_schlick_weight(cosine), through = through_share(m);
    rgb dielectric = schlick(m->dielectric_f0, m->specular, weight), from_within = dielectric;
    if (is_inside) {
        /* the value at the refracted angle outside, so that both directions are the same; total reflection is 1 */
        float sin2 = (1.0f - float_min(cosine * cosine, 1.0f)) * m->ior * m->ior;
        from_within = sin2 >= 1.0f ? rgb_gray(1.0f)
                                   : schlick(m->dielectric_f0, m->specular, fresnel_schlick_weight(sqrtf(1.0f - sin2)));
    }
    *out_reflected =
        rgb_add(rgb_scale(dielectric, float_max(1.0f - m->metallic - through, 0.0f)), rgb_scale(from_within, through));
    if (m->metallic > 0.0f)
        *out_reflected = rgb_add(*out_reflected, rgb_scale(schlick(m->reflectance, 1.0f, weight), m->metallic));
    *out_through = rgb_scale(m->reflectance, through * (1.0f - rgb_max(from_within)));
}

float principled_coat_reflectance(const principled_point *m, float cosine)
{
    return m->clearcoat * (COAT_F0 + (1.0f - COAT_F0) * fresnel_schlick_weight(cosine));
}

float principled_sheen_factor(const principled_point *m, float cos_o, float cos_i)
{
    return float_min(coat_through(m, fabsf(cos_o)), coat_through(m, fabsf(cos_i)));
}

float principled_cover_factor(const principled_point *m, float cos_o, float cos_i)
{
    if (m->clearcoat == 0.0f && !m->has_sheen)
        return 1.0f;
    /* the lesser of both ways: reciprocal, and no more than what coat and sheen leave of the light that comes */
    bool is_solid = principled_is_solid(m);
    float o = is_solid && cos_o < 0.0f ? 1.0f : cover_through(m, fabsf(cos_o));
    float i = is_solid && cos_i < 0.0f ? 1.0f : cover_through(m, fabsf(cos_i));
    return float_min(o, i);
}

principled_shares principled_shares_at(const principled_point *m, float cosine)
{
    ggx_albedo albedo = ggx_albedo_of(m->facets.alpha_u, cosine);
    float coat = coat_through(m, cosine), sheen = m->has_sheen ? 1.0f - sheen_through(m, cosine) : 0.0f;
    float under_both = coat * (1.0f - sheen), base = rgb_max(m->reflectance);
    float dielectric = rgb_max(m->dielectric_f0) * albedo.of_f0 + m->specular * albedo.of_f90;
    float metal = base * albedo.of_f0 + albedo.of_f90, entered = base * (1.0f - dielectric);
    return (principled_shares){
        1.0f - coat,
        under_both * (m->metallic * metal + (1.0f - m->metallic) * dielectric + through_share(m) * entered),
        under_both * base_share(m) * entered, coat * sheen};
}
