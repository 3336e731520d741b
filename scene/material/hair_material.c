/* hair_material.c: a fibre as a kind of material (hair.h). Threads: pure functions. */
#include "material/material_type.h"

#include <stdlib.h>

/* --- the constants of a fibre, which materials share --- */

/* The first member is what a hair_point refers to. */
typedef struct fibre_table {
    hair_fibre fibre;
    float ior, beta_m, beta_n, tilt_degrees; /* that it was made of */
} fibre_table;

static void *create_fibre(const material *m)
{
    fibre_table *t = malloc(sizeof *t);
    if (t)
        *t = (fibre_table){hair_fibre_make(m->ior, m->hair_beta_m, m->hair_beta_n, m->hair_tilt_degrees), m->ior,
                           m->hair_beta_m, m->hair_beta_n, m->hair_tilt_degrees};
    return t;
}

static bool fibre_serves(const void *content, const material *m)
{
    const fibre_table *t = content;
    return t->ior == m->ior && t->beta_m == m->hair_beta_m && t->beta_n == m->hair_beta_n &&
           t->tilt_degrees == m->hair_tilt_degrees;
}

static const material_table_type FIBRE = {.create = create_fibre, .serves = fibre_serves, .destroy = free};

/* --- at a point --- */

static void init_point(const material *m, material_point *p)
{
    p->hair.fibre = m->table;
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
    h->surface = hit->faces_rays ? HAIR_FACES_RAYS : hit->is_strand ? HAIR_RIBBON : HAIR_OTHER;
    bsdf_add_lobe(b, LOBE_HAIR, BSDF_TRACED, false, 1.0f);
}

const material_type hair_material = {.table = &FIBRE,
                                     .is_traced = material_always,
                                     .init_point = init_point,
                                     .look_up = look_up,
                                     .has_grain = has_grain,
                                     .add_lobes = add_lobes,
                                     .base = LOBE_DIFFUSE};
