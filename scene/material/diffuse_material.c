/* diffuse_material.c: Lambertian reflection, and with it transmission, as kinds of material.
 * Threads: pure functions. */
#include "material/material_type.h"

static void init_point(const material *m, material_point *p)
{
    p->diffuse = (diffuse_point){m->reflectance, m->transmittance};
}

/* --- reflection alone --- */

static void prepare(material *m)
{
    m->is_lambertian =
        !m->is_textured && m->displacement_texture == SCENE_NO_TEXTURE && m->normal_map_texture == SCENE_NO_TEXTURE;
}

static void look_up(const material_lookup *at, const material *m, material_point *p)
{
    material_look_up_color(at, m->reflectance_texture, &p->diffuse.reflectance);
}

static void add_lobes(bsdf *b, const surface_hit *hit)
{
    (void)hit;
    bsdf_add_lobe(b, LOBE_DIFFUSE, BSDF_GATHERED, false, 1.0f);
}

const material_type diffuse_material = {.prepare = prepare,
                                        .has_base = material_always,
                                        .is_filtered = material_always,
                                        .init_point = init_point,
                                        .look_up = look_up,
                                        .add_lobes = add_lobes,
                                        .base = LOBE_DIFFUSE};

/* --- both --- */

static void init_both(material *m) { m->reflectance = m->transmittance = rgb_gray(0.25f); }

static bool both_have_base(const scene *s, const material *m)
{
    (void)s;
    return !rgb_is_black(m->reflectance) || m->reflectance_texture != SCENE_NO_TEXTURE ||
           !rgb_is_black(m->transmittance) || m->transmittance_texture != SCENE_NO_TEXTURE;
}

static bool both_transmit(const scene *s, const material *m)
{
    (void)s;
    return !rgb_is_black(m->transmittance) || m->transmittance_texture != SCENE_NO_TEXTURE;
}

static float bound_of_color(const scene *s, rgb color, uint32_t texture_index)
{
    return texture_index == SCENE_NO_TEXTURE ? rgb_max(color) : s->textures.items[texture_index].most;
}

/* Where reflectance and transmittance together are above 1 they are scaled down: the mean of that is not that of
 * means. */
static bool both_are_filtered(const scene *s, const material *m)
{
    return bound_of_color(s, m->reflectance, m->reflectance_texture) +
               bound_of_color(s, m->transmittance, m->transmittance_texture) <=
           1.0f;
}

static void look_up_both(const material_lookup *at, const material *m, material_point *p)
{
    diffuse_point *d = &p->diffuse;
    material_look_up_color(at, m->reflectance_texture, &d->reflectance);
    material_look_up_color(at, m->transmittance_texture, &d->transmittance);
    float sum = rgb_max(rgb_add(d->reflectance, d->transmittance));
    if (sum > 1.0f) {
        d->reflectance = rgb_scale(d->reflectance, 1.0f / sum);
        d->transmittance = rgb_scale(d->transmittance, 1.0f / sum);
    }
}

static void add_both_lobes(bsdf *b, const surface_hit *hit)
{
    (void)hit;
    bsdf_add_lobe(b, LOBE_DIFFUSE, BSDF_GATHERED, false, rgb_max(b->material.diffuse.reflectance));
    bsdf_add_lobe(b, LOBE_DIFFUSE_THROUGH, BSDF_GATHERED, false, rgb_max(b->material.diffuse.transmittance));
}

const material_type diffuse_transmission_material = {.init = init_both,
                                                     .transmits = both_transmit,
                                                     .has_base = both_have_base,
                                                     .is_filtered = both_are_filtered,
                                                     .init_point = init_point,
                                                     .look_up = look_up_both,
                                                     .add_lobes = add_both_lobes,
                                                     .base = LOBE_DIFFUSE};
