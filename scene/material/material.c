/* material.c: what of a material can be worked out beforehand, and what it is at a point.
 * Threads: material_prepare while the scene is built; the rest read only. */
#include "material/material.h"

#include "material/hair.h"
#include "material/material_mips.h"
#include "material/principled.h"
#include "material/surface_footprint.h"
#include "math/rng.h"
#include "scene.h"

#include <string.h>

/* The least index of refraction: a texture of it may be black. */
#define ETA_MIN 1e-3f

static void make_rough_on_both_axes(float *alpha_u, float *alpha_v)
{
    /* rough along one axis only: the other must not divide by zero */
    if (*alpha_u >= MATERIAL_SMOOTH_ALPHA || *alpha_v >= MATERIAL_SMOOTH_ALPHA) {
        *alpha_u = fmaxf(*alpha_u, 1e-4f);
        *alpha_v = fmaxf(*alpha_v, 1e-4f);
    }
}

material material_make(material_kind kind)
{
    material m;
    memset(&m, 0, sizeof m);
    m.kind = kind;
    m.reflectance = rgb_gray(0.5f);
    m.ior = 1.5f;
    m.specular_color = rgb_gray(1.0f);
    m.specular = m.metallic = m.roughness = 1.0f;
    m.is_thin = true;
    if (kind == MATERIAL_PRINCIPLED)
        m.reflectance = rgb_gray(1.0f);
    if (kind == MATERIAL_DIFFUSE_TRANSMISSION)
        m.reflectance = m.transmittance = rgb_gray(0.25f);
    m.hair_beta_m = m.hair_beta_n = 0.3f;
    m.hair_tilt_degrees = 2.0f;
    m.mix_amount = 0.5f;
    m.reflectance_texture = m.transmittance_texture = m.alpha_u_texture = m.alpha_v_texture = m.mix_amount_texture =
        m.metallic_texture = m.roughness_texture = m.transmission_texture = m.specular_texture =
            m.specular_color_texture = m.clearcoat_texture = m.clearcoat_roughness_texture = SCENE_NO_TEXTURE;
    m.eta_texture = m.k_texture = m.base_alpha_u_texture = m.base_alpha_v_texture = SCENE_NO_TEXTURE;
    m.displacement_texture = m.normal_map_texture = SCENE_NO_TEXTURE;
    m.normal_scale = 1.0f;
    return m;
}

static bool has_textures(const material *m)
{
    const uint32_t textures[] = {m->reflectance_texture,  m->transmittance_texture,
                                 m->alpha_u_texture,      m->alpha_v_texture,
                                 m->mix_amount_texture,   m->metallic_texture,
                                 m->roughness_texture,    m->transmission_texture,
                                 m->specular_texture,     m->specular_color_texture,
                                 m->clearcoat_texture,    m->clearcoat_roughness_texture,
                                 m->eta_texture,          m->k_texture,
                                 m->base_alpha_u_texture, m->base_alpha_v_texture};
    for (size_t i = 0; i < sizeof textures / sizeof *textures; i++)
        if (textures[i] != SCENE_NO_TEXTURE)
            return true;
    return false;
}

void material_prepare(material *m)
{
    m->is_textured = has_textures(m);
    if (m->kind == MATERIAL_PRINCIPLED)
        principled_resolve(m);
    make_rough_on_both_axes(&m->alpha_u, &m->alpha_v);
    make_rough_on_both_axes(&m->base_alpha_u, &m->base_alpha_v);
    m->is_lambertian = m->kind == MATERIAL_DIFFUSE && !m->is_textured && m->alpha_u == m->alpha_v &&
                       m->base_alpha_u == m->base_alpha_v && m->displacement_texture == SCENE_NO_TEXTURE &&
                       m->normal_map_texture == SCENE_NO_TEXTURE;
}

bool material_is_traced(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->kind == MATERIAL_MIX)
        return material_is_traced(s, m->mixed[0]) || material_is_traced(s, m->mixed[1]);
    if (m->kind == MATERIAL_PRINCIPLED)
        return principled_has_interface(m) || m->clearcoat > 0.0f;
    if (m->kind == MATERIAL_COATED_DIFFUSE && m->ior == 1.0f && rgb_is_black(m->coat_albedo))
        return false; /* a coat that does not reflect */
    return m->kind != MATERIAL_DIFFUSE && m->kind != MATERIAL_DIFFUSE_TRANSMISSION && m->kind != MATERIAL_INTERFACE;
}

bool material_is_clear_glass(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    bool is_smooth = material_is_smooth(m->alpha_u, m->alpha_v);
    switch (m->kind) {
    case MATERIAL_MIX: return material_is_clear_glass(s, m->mixed[0]) || material_is_clear_glass(s, m->mixed[1]);
    case MATERIAL_THIN_DIELECTRIC: return true;
    case MATERIAL_DIELECTRIC: return is_smooth || m->ior == 1.0f;
    case MATERIAL_PRINCIPLED: return is_smooth && principled_transmits(m);
    default: return false;
    }
}

/* A mix picks one of its two by position alone, as pbrt-v4 does: the same for all rays, so photons and eye agree. */
static const material *resolve_mix(const scene *s, const material *m, const surface_hit *hit)
{
    uint32_t bits[3];
    memcpy(bits, &hit->position, sizeof bits);
    uint64_t hash = hash_combine(hash_combine(bits[0], bits[1]), bits[2]);
    while (m->kind == MATERIAL_MIX) {
        hash = hash_mix64(hash + 0x9e3779b97f4a7c15u);
        float u = (float)(hash >> 40) * 0x1p-24f;
        float amount = m->mix_amount;
        if (m->mix_amount_texture != SCENE_NO_TEXTURE)
            amount = texture_evaluate_float(s, m->mix_amount_texture, hit);
        m = &s->materials[m->mixed[u < amount ? 1 : 0]];
    }
    return m;
}

bool material_is_interface(const scene *s, const surface_hit *hit)
{
    const material *m = &s->materials[s->shapes[hit->shape_index].material_index];
    if (m->kind == MATERIAL_MIX)
        m = resolve_mix(s, m, hit);
    return m->kind == MATERIAL_INTERFACE;
}

const rgb *material_plain_albedo(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    return m->kind == MATERIAL_DIFFUSE && !m->is_textured ? &m->reflectance : NULL;
}

bool material_may_be_interface(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->kind == MATERIAL_MIX)
        return material_may_be_interface(s, m->mixed[0]) || material_may_be_interface(s, m->mixed[1]);
    return m->kind == MATERIAL_INTERFACE;
}

static rgb clamp_to_unit(rgb v)
{
    return (rgb){fminf(fmaxf(v.r, 0.0f), 1.0f), fminf(fmaxf(v.g, 0.0f), 1.0f), fminf(fmaxf(v.b, 0.0f), 1.0f)};
}

/* The material as it is at a point. */
static void look_up_textures(const scene *s, const surface_hit *hit, const surface_footprint *footprint, material *m)
{
    if (m->reflectance_texture != SCENE_NO_TEXTURE) {
        m->reflectance = clamp_to_unit(texture_filtered_rgb(s, m->reflectance_texture, hit, footprint));
        rgb r = m->reflectance;
        float relative = m->kind == MATERIAL_COATED_CONDUCTOR ? 1.0f / m->ior : 1.0f;
        if (m->kind == MATERIAL_CONDUCTOR || m->kind == MATERIAL_COATED_CONDUCTOR) {
            m->eta = rgb_gray(relative);
            m->k = rgb_scale((rgb){material_k_from_reflectance(r.r), material_k_from_reflectance(r.g),
                                   material_k_from_reflectance(r.b)},
                             relative);
        }
    }
    if (m->kind == MATERIAL_HAIR && m->reflectance_texture != SCENE_NO_TEXTURE)
        m->hair_sigma_a = hair_absorption_from_reflectance(m->reflectance, m->hair_beta_n);
    if (m->transmittance_texture != SCENE_NO_TEXTURE)
        m->transmittance = clamp_to_unit(texture_filtered_rgb(s, m->transmittance_texture, hit, footprint));
    if (m->kind == MATERIAL_DIFFUSE_TRANSMISSION) {
        float sum = rgb_max(rgb_add(m->reflectance, m->transmittance));
        if (sum > 1.0f) {
            m->reflectance = rgb_scale(m->reflectance, 1.0f / sum);
            m->transmittance = rgb_scale(m->transmittance, 1.0f / sum);
        }
    }
    float to_air = m->kind == MATERIAL_COATED_CONDUCTOR ? 1.0f / m->ior : 1.0f;
    if (m->eta_texture != SCENE_NO_TEXTURE) {
        rgb eta = texture_evaluate_rgb(s, m->eta_texture, hit);
        m->eta = rgb_scale(rgb_make(fmaxf(eta.r, ETA_MIN), fmaxf(eta.g, ETA_MIN), fmaxf(eta.b, ETA_MIN)), to_air);
    }
    if (m->k_texture != SCENE_NO_TEXTURE) {
        rgb k = texture_evaluate_rgb(s, m->k_texture, hit);
        m->k = rgb_scale(rgb_make(fmaxf(k.r, 0.0f), fmaxf(k.g, 0.0f), fmaxf(k.b, 0.0f)), to_air);
    }
    const uint32_t alpha_textures[] = {m->alpha_u_texture, m->alpha_v_texture, m->base_alpha_u_texture,
                                       m->base_alpha_v_texture};
    float *const alphas[] = {&m->alpha_u, &m->alpha_v, &m->base_alpha_u, &m->base_alpha_v};
    for (int i = 0; i < 4; i++)
        if (alpha_textures[i] != SCENE_NO_TEXTURE) {
            float value = fmaxf(0.0f, texture_evaluate_float(s, alpha_textures[i], hit));
            *alphas[i] = m->remaps_roughness ? sqrtf(value) : value;
        }
    make_rough_on_both_axes(&m->alpha_u, &m->alpha_v);
    make_rough_on_both_axes(&m->base_alpha_u, &m->base_alpha_v);
}

/* glTF's textures multiply what is given for the whole. */
static void look_up_principled(const scene *s, const surface_hit *hit, const surface_footprint *footprint, material *m)
{
    if (m->reflectance_texture != SCENE_NO_TEXTURE)
        m->reflectance = rgb_mul(m->reflectance, texture_filtered_rgb(s, m->reflectance_texture, hit, footprint));
    if (m->specular_color_texture != SCENE_NO_TEXTURE)
        m->specular_color = rgb_mul(m->specular_color, texture_evaluate_rgb(s, m->specular_color_texture, hit));
    const uint32_t textures[] = {m->metallic_texture, m->roughness_texture, m->transmission_texture,
                                 m->specular_texture, m->clearcoat_texture, m->clearcoat_roughness_texture};
    float *const factors[] = {&m->metallic, &m->roughness, &m->transmission,
                              &m->specular, &m->clearcoat, &m->clearcoat_roughness};
    for (size_t i = 0; i < sizeof textures / sizeof *textures; i++)
        if (textures[i] != SCENE_NO_TEXTURE && *factors[i] != 0.0f)
            *factors[i] *= texture_evaluate_float(s, textures[i], hit);
    principled_resolve(m);
}

enum { HALF = sizeof(material) / 2 };

/* m is no mix; of one that a texture picks from, is_picked: beside the point the other may be, whose pixels are of any
 * colour in this one's pictures, so that none are filtered. */
static void evaluate_at(const scene *s, const material *m, const surface_hit *hit, bool is_picked,
                        material *out_material)
{
    /* in two pieces: compilers make one string instruction of so much, which takes longer to begin than to do */
    memcpy(out_material, m, HALF);
    memcpy((char *)out_material + HALF, (const char *)m + HALF, sizeof *m - HALF);
    if (!m->is_textured)
        return;
    surface_footprint footprint;
    const bool filters = hit->footprint.width > 0.0f && s->has_mips && !is_picked && material_is_filtered(s, m) &&
                         surface_footprint_at(s, hit, &footprint);
    if (m->kind == MATERIAL_PRINCIPLED)
        look_up_principled(s, hit, filters ? &footprint : NULL, out_material);
    else
        look_up_textures(s, hit, filters ? &footprint : NULL, out_material);
}

void material_at(const scene *s, const surface_hit *hit, material *out_material)
{
    const material *m = &s->materials[s->shapes[hit->shape_index].material_index];
    const bool is_mix = m->kind == MATERIAL_MIX;
    if (is_mix)
        m = resolve_mix(s, m, hit);
    evaluate_at(s, m, hit, is_mix, out_material);
}

static bool has_base(const material *m)
{
    bool is_black = rgb_is_black(m->reflectance), is_textured = m->reflectance_texture != SCENE_NO_TEXTURE;
    switch (m->kind) {
    case MATERIAL_DIFFUSE: return true;
    case MATERIAL_DIFFUSE_TRANSMISSION:
        return !is_black || is_textured || !rgb_is_black(m->transmittance) ||
               m->transmittance_texture != SCENE_NO_TEXTURE;
    case MATERIAL_COATED_DIFFUSE: return !is_black || is_textured;
    case MATERIAL_PRINCIPLED: /* whose textures are factors */
        return !is_black && (m->metallic < 1.0f || m->metallic_texture != SCENE_NO_TEXTURE) &&
               (m->transmission < 1.0f || m->transmission_texture != SCENE_NO_TEXTURE);
    default: return false;
    }
}

/* NULL: nothing in it has a diffuse base. */
static const material *find_with_base(const scene *s, const material *m)
{
    if (m->kind != MATERIAL_MIX)
        return has_base(m) ? m : NULL;
    const material *first = find_with_base(s, &s->materials[m->mixed[0]]);
    return first ? first : find_with_base(s, &s->materials[m->mixed[1]]);
}

bool material_gathering_at(const scene *s, const surface_hit *hit, material *out_material)
{
    const material *m = find_with_base(s, &s->materials[s->shapes[hit->shape_index].material_index]);
    if (m)
        evaluate_at(s, m, hit, true, out_material);
    return m != NULL;
}
