/* material.c: what of a material can be worked out beforehand, and what is known of it without a point.
 * Threads: material_prepare while the scene is built; the rest read only. */
#include "material/material.h"

#include "material/principled.h"
#include "math/rng.h"
#include "scene.h"

#include <string.h>

void material_make_rough_on_both_axes(float *alpha_u, float *alpha_v)
{
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
        principled_prepare(m);
    material_make_rough_on_both_axes(&m->alpha_u, &m->alpha_v);
    material_make_rough_on_both_axes(&m->base_alpha_u, &m->base_alpha_v);
    m->is_lambertian = m->kind == MATERIAL_DIFFUSE && !m->is_textured && m->displacement_texture == SCENE_NO_TEXTURE &&
                       m->normal_map_texture == SCENE_NO_TEXTURE;
}

bool material_is_traced(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->kind == MATERIAL_MIX)
        return material_is_traced(s, m->mixed[0]) || material_is_traced(s, m->mixed[1]);
    if (m->kind == MATERIAL_PRINCIPLED) {
        principled_point p = principled_point_of(m);
        return principled_has_interface(&p) || m->clearcoat > 0.0f;
    }
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
    case MATERIAL_PRINCIPLED: {
        principled_point p = principled_point_of(m);
        return is_smooth && principled_transmits(&p);
    }
    default: return false;
    }
}

/* A mix picks one of its two by position alone, as pbrt-v4 does: the same for all rays, so photons and eye agree. */
const material *material_resolve_mix(const scene *s, const material *m, const surface_hit *hit)
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
        m = material_resolve_mix(s, m, hit);
    return m->kind == MATERIAL_INTERFACE;
}

bool material_may_be_interface(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->kind == MATERIAL_MIX)
        return material_may_be_interface(s, m->mixed[0]) || material_may_be_interface(s, m->mixed[1]);
    return m->kind == MATERIAL_INTERFACE;
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

const material *material_with_base(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->kind != MATERIAL_MIX)
        return has_base(m) ? m : NULL;
    const material *first = material_with_base(s, m->mixed[0]);
    return first ? first : material_with_base(s, m->mixed[1]);
}
