/* hair_material.c: a fibre as a kind of material (hair.h). Threads: pure functions. */
#include "material/material_type.h"

static void say(const material *m, material_point *p)
{
    p->hair.fibre = m->fibre;
    p->hair.sigma_a = m->hair_sigma_a;
}

static void look_up(const material_lookup *at, const material *m, material_point *p)
{
    rgb reflectance = m->reflectance;
    if (m->reflectance_texture == SCENE_NO_TEXTURE)
        return;
    material_look_up_color(at, m->reflectance_texture, &reflectance);
    p->hair.sigma_a = hair_absorption_from_reflectance(reflectance, m->hair_beta_n);
}

static bool has_grain(const material_point *p)
{
    (void)p;
    return true;
}

static void add_lobes(bsdf *b, const surface_hit *hit)
{
    hair_point *h = &b->material.hair;
    float v = hit->is_mirrored ? 1.0f - hit->uv.y : hit->uv.y;
    *h = hair_point_at(h->fibre, h->sigma_a, v, frame_to_local(&b->shading, b->out));
    h->faces_rays = hit->faces_rays;
    bsdf_add_lobe(b, LOBE_HAIR, BSDF_TRACED, false, 1.0f);
}

const material_type hair_material = {.is_traced = material_always,
                                     .say = say,
                                     .look_up = look_up,
                                     .has_grain = has_grain,
                                     .add_lobes = add_lobes,
                                     .base = LOBE_DIFFUSE};
