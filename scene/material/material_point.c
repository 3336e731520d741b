/* material_point.c: see material_point.h. One row for each kind of material: its values as the file says them, and
 * those of its textures. Threads: pure functions. */
#include "material/material_point.h"

#include "material/material_mips.h"
#include "material/surface_footprint.h"
#include "math/rng.h"
#include "scene.h"

#include <string.h>

/* The least index of refraction: a texture of it may be black. */
static const float ETA_MIN = 1e-3f;

/* Where textures are looked up. footprint: NULL where they are not filtered. */
typedef struct lookup {
    const scene *s;
    const surface_hit *hit;
    const surface_footprint *footprint;
} lookup;

static rgb clamp_to_unit(rgb v)
{
    return (rgb){fminf(fmaxf(v.r, 0.0f), 1.0f), fminf(fmaxf(v.g, 0.0f), 1.0f), fminf(fmaxf(v.b, 0.0f), 1.0f)};
}

static void look_up_color(const lookup *at, uint32_t index, rgb *in_out_color)
{
    if (index != SCENE_NO_TEXTURE)
        *in_out_color = clamp_to_unit(texture_filtered_rgb(at->s, index, at->hit, at->footprint));
}

static void look_up_facets(const lookup *at, const material *m, uint32_t texture_u, uint32_t texture_v, ggx *facets)
{
    const uint32_t textures[] = {texture_u, texture_v};
    float *const alphas[] = {&facets->alpha_u, &facets->alpha_v};
    for (int i = 0; i < 2; i++)
        if (textures[i] != SCENE_NO_TEXTURE) {
            float value = fmaxf(0.0f, texture_evaluate_float(at->s, textures[i], at->hit));
            *alphas[i] = m->remaps_roughness ? sqrtf(value) : value;
        }
    material_make_rough_on_both_axes(&facets->alpha_u, &facets->alpha_v);
}

/* A metal's index; from_air: what the one from air is multiplied by. */
static void look_up_metal(const lookup *at, const material *m, float from_air, rgb *in_out_eta, rgb *in_out_k)
{
    if (m->reflectance_texture != SCENE_NO_TEXTURE) {
        rgb r = rgb_gray(0.0f);
        look_up_color(at, m->reflectance_texture, &r);
        *in_out_eta = rgb_gray(from_air);
        *in_out_k = rgb_scale(
            (rgb){material_k_from_reflectance(r.r), material_k_from_reflectance(r.g), material_k_from_reflectance(r.b)},
            from_air);
    }
    if (m->eta_texture != SCENE_NO_TEXTURE) {
        rgb eta = texture_evaluate_rgb(at->s, m->eta_texture, at->hit);
        *in_out_eta =
            rgb_scale(rgb_make(fmaxf(eta.r, ETA_MIN), fmaxf(eta.g, ETA_MIN), fmaxf(eta.b, ETA_MIN)), from_air);
    }
    if (m->k_texture != SCENE_NO_TEXTURE) {
        rgb k = texture_evaluate_rgb(at->s, m->k_texture, at->hit);
        *in_out_k = rgb_scale(rgb_make(fmaxf(k.r, 0.0f), fmaxf(k.g, 0.0f), fmaxf(k.b, 0.0f)), from_air);
    }
}

/* --- the kinds --- */

static void say_diffuse(const material *m, material_point *p)
{
    p->diffuse = (diffuse_point){m->reflectance, m->transmittance};
}

static void look_up_diffuse(const lookup *at, const material *m, material_point *p)
{
    look_up_color(at, m->reflectance_texture, &p->diffuse.reflectance);
}

static void look_up_diffuse_transmission(const lookup *at, const material *m, material_point *p)
{
    diffuse_point *d = &p->diffuse;
    look_up_color(at, m->reflectance_texture, &d->reflectance);
    look_up_color(at, m->transmittance_texture, &d->transmittance);
    float sum = rgb_max(rgb_add(d->reflectance, d->transmittance));
    if (sum > 1.0f) {
        d->reflectance = rgb_scale(d->reflectance, 1.0f / sum);
        d->transmittance = rgb_scale(d->transmittance, 1.0f / sum);
    }
}

static void say_metal(const material *m, material_point *p)
{
    p->metal = (metal_point){{m->alpha_u, m->alpha_v}, m->eta, m->k};
}

static void look_up_conductor(const lookup *at, const material *m, material_point *p)
{
    look_up_metal(at, m, 1.0f, &p->metal.eta, &p->metal.k);
    look_up_facets(at, m, m->alpha_u_texture, m->alpha_v_texture, &p->metal.facets);
}

static void say_glass(const material *m, material_point *p)
{
    p->glass = (glass_point){{m->alpha_u, m->alpha_v}, m->ior};
}

static void look_up_glass(const lookup *at, const material *m, material_point *p)
{
    look_up_facets(at, m, m->alpha_u_texture, m->alpha_v_texture, &p->glass.facets);
}

static void say_coat(const material *m, material_point *p) { p->coat = coat_point_of(m); }

static void look_up_coat(const lookup *at, const material *m, material_point *p)
{
    coat_point *c = &p->coat;
    if (c->has_metal)
        look_up_metal(at, m, 1.0f / m->ior, &c->eta, &c->k);
    else
        look_up_color(at, m->reflectance_texture, &c->reflectance);
    look_up_facets(at, m, m->alpha_u_texture, m->alpha_v_texture, &c->interface);
    look_up_facets(at, m, m->base_alpha_u_texture, m->base_alpha_v_texture, &c->base);
}

static void say_hair(const material *m, material_point *p)
{
    p->hair.fibre = m->fibre;
    p->hair.sigma_a = m->hair_sigma_a;
}

static void look_up_hair(const lookup *at, const material *m, material_point *p)
{
    rgb reflectance = m->reflectance;
    if (m->reflectance_texture == SCENE_NO_TEXTURE)
        return;
    look_up_color(at, m->reflectance_texture, &reflectance);
    p->hair.sigma_a = hair_absorption_from_reflectance(reflectance, m->hair_beta_n);
}

static void say_principled(const material *m, material_point *p) { p->principled = principled_point_of(m); }

/* glTF's textures multiply what is given for the whole. */
static void look_up_principled(const lookup *at, const material *m, material_point *out)
{
    principled_point *p = &out->principled;
    rgb specular_color = m->specular_color;
    float roughness = m->roughness;
    if (m->reflectance_texture != SCENE_NO_TEXTURE)
        p->reflectance =
            rgb_mul(p->reflectance, texture_filtered_rgb(at->s, m->reflectance_texture, at->hit, at->footprint));
    if (m->specular_color_texture != SCENE_NO_TEXTURE)
        specular_color = rgb_mul(specular_color, texture_evaluate_rgb(at->s, m->specular_color_texture, at->hit));
    const uint32_t textures[] = {m->metallic_texture, m->roughness_texture, m->transmission_texture,
                                 m->specular_texture, m->clearcoat_texture, m->clearcoat_roughness_texture};
    float *const factors[] = {&p->metallic, &roughness,    &p->transmission,
                              &p->specular, &p->clearcoat, &p->clearcoat_roughness};
    for (size_t i = 0; i < sizeof textures / sizeof *textures; i++)
        if (textures[i] != SCENE_NO_TEXTURE && *factors[i] != 0.0f)
            *factors[i] *= texture_evaluate_float(at->s, textures[i], at->hit);
    principled_resolve(p, specular_color, roughness);
}

/* say: the values that hold where there is no texture. look_up: puts those of textures in their place. NULL: none. */
typedef struct point_type {
    void (*say)(const material *m, material_point *p);
    void (*look_up)(const lookup *at, const material *m, material_point *p);
} point_type;

static const point_type TYPES[] = {
    [MATERIAL_DIFFUSE] = {say_diffuse, look_up_diffuse},
    [MATERIAL_DIFFUSE_TRANSMISSION] = {say_diffuse, look_up_diffuse_transmission},
    [MATERIAL_CONDUCTOR] = {say_metal, look_up_conductor},
    [MATERIAL_DIELECTRIC] = {say_glass, look_up_glass},
    [MATERIAL_THIN_DIELECTRIC] = {say_glass, look_up_glass},
    [MATERIAL_INTERFACE] = {NULL, NULL},
    [MATERIAL_COATED_DIFFUSE] = {say_coat, look_up_coat},
    [MATERIAL_COATED_CONDUCTOR] = {say_coat, look_up_coat},
    [MATERIAL_HAIR] = {say_hair, look_up_hair},
    [MATERIAL_PRINCIPLED] = {say_principled, look_up_principled},
    [MATERIAL_MIX] = {NULL, NULL}, /* one of two others has been picked before */
};
_Static_assert(sizeof TYPES / sizeof *TYPES == MATERIAL_KIND_COUNT, "a row for each kind of material");

void material_point_of(const material *m, material_point *out_point)
{
    out_point->kind = m->kind;
    if (TYPES[m->kind].say)
        TYPES[m->kind].say(m, out_point);
}

/* m is no mix; of one that a texture picks from, is_picked: beside the point the other may be, whose pixels are of any
 * colour in this one's pictures, so that none are filtered. */
static void evaluate_at(const scene *s, const material *m, const surface_hit *hit, bool is_picked,
                        material_point *out_point)
{
    material_point_of(m, out_point);
    if (!m->is_textured || !TYPES[m->kind].look_up)
        return;
    surface_footprint footprint;
    const bool filters = hit->footprint.width > 0.0f && s->has_mips && !is_picked && material_is_filtered(s, m) &&
                         surface_footprint_at(s, hit, &footprint);
    const lookup at = {s, hit, filters ? &footprint : NULL};
    TYPES[m->kind].look_up(&at, m, out_point);
}

const material *material_at(const scene *s, const surface_hit *hit, material_point *out_point)
{
    const material *m = &s->materials[s->shapes[hit->shape_index].material_index];
    const bool is_mix = m->kind == MATERIAL_MIX;
    if (is_mix)
        m = material_resolve_mix(s, m, hit);
    evaluate_at(s, m, hit, is_mix, out_point);
    return m;
}

bool material_gathering_at(const scene *s, const surface_hit *hit, material_point *out_point)
{
    const material *m = material_with_base(s, s->shapes[hit->shape_index].material_index);
    if (m)
        evaluate_at(s, m, hit, true, out_point);
    return m != NULL;
}

static bool is_anisotropic(ggx facets) { return facets.alpha_u != facets.alpha_v; }

bool material_point_has_grain(const material_point *p)
{
    switch (p->kind) {
    case MATERIAL_CONDUCTOR: return is_anisotropic(p->metal.facets);
    case MATERIAL_DIELECTRIC:
    case MATERIAL_THIN_DIELECTRIC: return is_anisotropic(p->glass.facets);
    case MATERIAL_COATED_DIFFUSE:
    case MATERIAL_COATED_CONDUCTOR: return is_anisotropic(p->coat.interface) || is_anisotropic(p->coat.base);
    case MATERIAL_HAIR: return true;
    default: return false;
    }
}
