/* conductor_material.c: a metal's surface as a kind of material. Threads: pure functions. */
#include "material/material_type.h"

static void init_point(const material *m, material_point *p)
{
    p->metal = (metal_point){{m->alpha_u, m->alpha_v}, m->eta, m->k};
}

static void look_up(const material_lookup *at, const material *m, material_point *p)
{
    material_look_up_metal(at, m, 1.0f, &p->metal.eta, &p->metal.k);
    material_look_up_facets(at, m, m->alpha_u_texture, m->alpha_v_texture, &p->metal.facets);
}

static bool has_grain(const material_point *p) { return facets_have_grain(p->metal.facets); }

static void add_lobes(bsdf *b, const surface_hit *hit)
{
    (void)hit;
    bsdf_add_lobe(b, LOBE_CONDUCTOR, BSDF_TRACED, facets_are_smooth(b->material.metal.facets), 1.0f);
}

const material_type conductor_material = {.is_traced = material_always,
                                          .init_point = init_point,
                                          .look_up = look_up,
                                          .has_grain = has_grain,
                                          .add_lobes = add_lobes,
                                          .base = LOBE_DIFFUSE};
