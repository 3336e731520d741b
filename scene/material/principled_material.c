/* principled_material.c: glTF's metallic-roughness as a kind of material (principled.h). Threads: pure functions. */
#include "material/material_type.h"

static void init(material *m) { m->reflectance = rgb_gray(1.0f); }

/* --- by what the file says; textures are factors, and may take metal and roughness away --- */

static bool is_traced(const scene *s, const material *m)
{
    principled_point p = principled_point_of(m);
    (void)s;
    return principled_has_interface(&p) || m->clearcoat > 0.0f || p.has_sheen;
}

static bool is_clear_glass(const scene *s, const material *m)
{
    principled_point p = principled_point_of(m);
    (void)s;
    return material_is_smooth(m->alpha_u, m->alpha_v) && principled_transmits(&p);
}

static bool transmits(const scene *s, const material *m)
{
    principled_point p = principled_point_of(m);
    (void)s;
    return principled_transmits(&p);
}

/* A thin wall tints what passes it: it is a coloured sheet, unless it is nearly white. */
static bool is_transparent(const scene *s, const material *m)
{
    const rgb c = m->reflectance;
    const bool is_white = m->reflectance_texture == SCENE_NO_TEXTURE && float_min(c.r, float_min(c.g, c.b)) >= 0.9f;
    const bool is_uniform =
        m->transmission_texture == SCENE_NO_TEXTURE && (m->metallic == 0.0f || m->metallic_texture == SCENE_NO_TEXTURE);
    return transmits(s, m) && is_uniform && (1.0f - m->metallic) * m->transmission >= 0.5f && (!m->is_thin || is_white);
}

static bool has_base(const scene *s, const material *m)
{
    (void)s;
    return !rgb_is_black(m->reflectance) && (m->metallic < 1.0f || m->metallic_texture != SCENE_NO_TEXTURE) &&
           (m->transmission < 1.0f || m->transmission_texture != SCENE_NO_TEXTURE);
}

static bool is_straight(bool is_thin, float ior) { return is_thin || ior == 1.0f; }

static bool may_be_pane(const scene *s, const material *m)
{
    (void)s;
    return is_straight(m->is_thin, m->ior) && m->transmission > 0.0f &&
           (m->roughness_texture != SCENE_NO_TEXTURE || material_is_smooth(m->alpha_u, m->alpha_v));
}

static bool may_be_slab(const scene *s, const material *m)
{
    (void)s;
    return !m->is_thin && m->ior > 0.0f && m->transmission == 1.0f && m->metallic == 0.0f && m->clearcoat == 0.0f &&
           rgb_is_black(m->sheen);
}

/* A factor that varies goes along with the colour or against it: the mean of the product is another than the product of
 * the means. Roughness has hardly a part in how much is reflected. */
static bool is_filtered(const scene *s, const material *m)
{
    (void)s;
    const bool has_varying_factors = (m->metallic != 0.0f && m->metallic_texture != SCENE_NO_TEXTURE) ||
                                     (m->transmission != 0.0f && m->transmission_texture != SCENE_NO_TEXTURE) ||
                                     (m->specular != 0.0f && m->specular_texture != SCENE_NO_TEXTURE) ||
                                     m->specular_color_texture != SCENE_NO_TEXTURE ||
                                     (m->clearcoat != 0.0f && m->clearcoat_texture != SCENE_NO_TEXTURE) ||
                                     (!rgb_is_black(m->sheen) && (m->sheen_texture != SCENE_NO_TEXTURE ||
                                                                  m->sheen_roughness_texture != SCENE_NO_TEXTURE));
    return !has_varying_factors;
}

/* --- at a point --- */

/* The table rounds to 0 what the finest fibres reflect at a right angle. */
static const float SHEEN_SHARE_MIN = 1e-4f;

static void init_point(const material *m, material_point *p) { p->principled = principled_point_of(m); }

static void multiply(const material_lookup *at, uint32_t texture_index, float *in_out_factor)
{
    if (texture_index != SCENE_NO_TEXTURE && *in_out_factor != 0.0f)
        *in_out_factor *= texture_evaluate_float(&at->s->textures, texture_index, at->hit);
}

static void look_up(const material_lookup *at, const material *m, material_point *out)
{
    principled_point *p = &out->principled;
    rgb specular_color = m->specular_color;
    float roughness = m->roughness, roughness_v = m->roughness_v, anisotropy = m->anisotropy;
    if (m->reflectance_texture != SCENE_NO_TEXTURE)
        p->reflectance = rgb_mul(
            p->reflectance, texture_filtered_rgb(&at->s->textures, m->reflectance_texture, at->hit, at->footprint));
    if (m->specular_color_texture != SCENE_NO_TEXTURE)
        specular_color =
            rgb_mul(specular_color, texture_evaluate_rgb(&at->s->textures, m->specular_color_texture, at->hit));
    if (m->sheen_texture != SCENE_NO_TEXTURE && !rgb_is_black(m->sheen))
        p->sheen = rgb_mul(p->sheen, texture_evaluate_rgb(&at->s->textures, m->sheen_texture, at->hit));
#define MULTIPLY_SHARE(name) multiply(at, m->name##_texture, &p->name);
    PRINCIPLED_SHARE_LIST(MULTIPLY_SHARE)
#undef MULTIPLY_SHARE
    multiply(at, m->roughness_texture, &roughness);
    multiply(at, m->anisotropy_texture, &anisotropy);
    if (m->roughness_v_texture != SCENE_NO_TEXTURE && roughness_v > 0.0f)
        roughness_v =
            float_max(roughness_v * texture_evaluate_float(&at->s->textures, m->roughness_v_texture, at->hit), 0.0f);
    p->facets = principled_facets(roughness, roughness_v, anisotropy);
    principled_resolve(p, specular_color);
}

static bool is_pane(const material_point *m)
{
    const principled_point *p = &m->principled;
    return is_straight(p->is_thin, p->ior) && principled_transmits(p) && facets_are_smooth(p->facets);
}

static rgb pane_transmittance(const material_point *m, float cosine)
{
    const principled_point *p = &m->principled;
    rgb reflected, through;
    principled_interface(p, float_min(fabsf(cosine), 1.0f), cosine < 0.0f && principled_is_solid(p), &reflected,
                         &through);
    return rgb_scale(through, principled_cover_factor(p, cosine, -cosine));
}

static float index_of(const material_point *m) { return m->principled.ior; }

static material_faces faces(const material_point *m, float cosine, float cosine_within)
{
    material_faces f;
    principled_interface(&m->principled, cosine, false, &f.outer, &f.in);
    principled_interface(&m->principled, cosine_within, true, &f.inner, &f.out);
    return f;
}

static bool has_grain(const material_point *m) { return facets_have_grain(m->principled.facets); }

static void add_lobes(bsdf *b, const surface_hit *hit)
{
    const principled_point *m = &b->material.principled;
    (void)hit;
    float cosine = vec3_dot(b->out, b->shading.z);
    principled_shares shares = principled_shares_at(m, float_min(fabsf(cosine), 1.0f));
    const bool has_interface = principled_has_interface(m);
    const bool has_sheen = m->has_sheen && !(cosine < 0.0f && principled_is_solid(m));
    if (!rgb_is_black(principled_base_albedo(m)) || !(has_interface || has_sheen))
        bsdf_add_lobe(b, LOBE_PRINCIPLED_BASE, BSDF_GATHERED, false, shares.base);
    if (has_interface)
        bsdf_add_lobe(b, LOBE_PRINCIPLED, BSDF_TRACED, facets_are_smooth(m->facets), shares.interface);
    if (has_sheen)
        bsdf_add_lobe(b, LOBE_SHEEN, BSDF_TRACED, false, float_max(shares.sheen, SHEEN_SHARE_MIN));
    float coat_alpha = m->clearcoat_roughness * m->clearcoat_roughness;
    if (m->clearcoat > 0.0f && !(cosine < 0.0f && principled_is_solid(m)))
        bsdf_add_lobe(b, LOBE_CLEARCOAT, BSDF_TRACED, material_is_smooth(coat_alpha, coat_alpha), shares.coat);
}

const material_type principled_material = {.init = init,
                                           .prepare = principled_prepare,
                                           .is_traced = is_traced,
                                           .is_clear_glass = is_clear_glass,
                                           .transmits = transmits,
                                           .is_transparent = is_transparent,
                                           .has_base = has_base,
                                           .may_be_pane = may_be_pane,
                                           .may_be_slab = may_be_slab,
                                           .is_filtered = is_filtered,
                                           .init_point = init_point,
                                           .look_up = look_up,
                                           .has_grain = has_grain,
                                           .is_pane = is_pane,
                                           .pane_transmittance = pane_transmittance,
                                           .index = index_of,
                                           .faces = faces,
                                           .add_lobes = add_lobes,
                                           .base = LOBE_PRINCIPLED_BASE};
