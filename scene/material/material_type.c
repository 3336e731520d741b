/* material_type.c: the table of the kinds, and functions that several of them share: see material_type.h. */
#include "material/material_type.h"

#include "material/surface_footprint.h"

/* The least index of refraction: a texture of it may be black. */
static const float ETA_MIN = 1e-3f;

const material_type no_material = {.base = LOBE_DIFFUSE};

const material_type *const material_types[MATERIAL_KIND_COUNT] = {
#define MATERIAL_TYPE_ROW(kind, type, lobes) [kind] = &(type),
    MATERIAL_KIND_LIST(MATERIAL_TYPE_ROW)
#undef MATERIAL_TYPE_ROW
};

const uint8_t material_lobes_max[MATERIAL_KIND_COUNT] = {
#define MATERIAL_LOBES_ROW(kind, type, lobes) [kind] = (lobes),
    MATERIAL_KIND_LIST(MATERIAL_LOBES_ROW)
#undef MATERIAL_LOBES_ROW
};

bool material_always(const scene *s, const material *m)
{
    (void)s, (void)m;
    return true;
}

void material_look_up_color(const material_lookup *at, uint32_t texture_index, rgb *in_out_color)
{
    if (texture_index != SCENE_NO_TEXTURE)
        *in_out_color =
            rgb_clamp(texture_filtered_rgb(&at->s->textures, texture_index, at->hit, at->footprint), 0.0f, 1.0f);
}

void material_look_up_facets(const material_lookup *at, const material *m, uint32_t texture_u, uint32_t texture_v,
                             ggx *facets)
{
    const uint32_t textures[] = {texture_u, texture_v};
    float *const alphas[] = {&facets->alpha_u, &facets->alpha_v};
    for (int i = 0; i < 2; i++)
        if (textures[i] != SCENE_NO_TEXTURE) {
            float value = float_max(texture_evaluate_float(&at->s->textures, textures[i], at->hit), 0.0f);
            *alphas[i] = m->remaps_roughness ? sqrtf(value) : value;
        }
    material_make_rough_on_both_axes(&facets->alpha_u, &facets->alpha_v);
}

void material_look_up_metal(const material_lookup *at, const material *m, float from_air, rgb *in_out_eta,
                            rgb *in_out_k)
{
    if (m->reflectance_texture != SCENE_NO_TEXTURE) {
        rgb r = rgb_gray(0.0f);
        material_look_up_color(at, m->reflectance_texture, &r);
        *in_out_eta = rgb_gray(from_air);
        *in_out_k = rgb_scale(
            (rgb){material_k_from_reflectance(r.r), material_k_from_reflectance(r.g), material_k_from_reflectance(r.b)},
            from_air);
    }
    if (m->eta_texture != SCENE_NO_TEXTURE) {
        rgb eta = texture_evaluate_rgb(&at->s->textures, m->eta_texture, at->hit);
        *in_out_eta = rgb_scale(
            rgb_make(float_max(eta.r, ETA_MIN), float_max(eta.g, ETA_MIN), float_max(eta.b, ETA_MIN)), from_air);
    }
    if (m->k_texture != SCENE_NO_TEXTURE) {
        rgb k = texture_evaluate_rgb(&at->s->textures, m->k_texture, at->hit);
        *in_out_k = rgb_scale(rgb_make(float_max(k.r, 0.0f), float_max(k.g, 0.0f), float_max(k.b, 0.0f)), from_air);
    }
}
