/* glass_material.c: dielectrics as kinds of material: interfaces, and thin panes. Threads: pure functions. */
#include "material/fresnel.h"
#include "material/material_type.h"

static void init_point(const material *m, material_point *p)
{
    p->glass = (glass_point){{m->alpha_u, m->alpha_v}, m->ior};
}

static void look_up(const material_lookup *at, const material *m, material_point *p)
{
    material_look_up_facets(at, m, m->alpha_u_texture, m->alpha_v_texture, &p->glass.facets);
}

static bool has_grain(const material_point *p) { return facets_have_grain(p->glass.facets); }

/* --- an interface --- */

static bool is_clear(const scene *s, const material *m)
{
    (void)s;
    return material_is_smooth(m->alpha_u, m->alpha_v) || m->ior == 1.0f;
}

static bool may_be_pane(const scene *s, const material *m)
{
    (void)s;
    return m->ior == 1.0f;
}

static bool is_pane(const material_point *p) { return p->glass.ior == 1.0f; }

static rgb pane_transmittance(const material_point *p, float cosine)
{
    (void)p, (void)cosine;
    return rgb_gray(1.0f);
}

static float index_of(const material_point *p) { return p->glass.ior; }

static material_faces faces(const material_point *p, float cosine, float cosine_within)
{
    (void)cosine_within; /* from within it reflects as much */
    rgb reflected = rgb_gray(fresnel_dielectric(cosine, p->glass.ior)), through = rgb_sub(rgb_gray(1.0f), reflected);
    return (material_faces){reflected, through, reflected, through};
}

static void add_lobes(bsdf *b, const surface_hit *hit)
{
    const glass_point *m = &b->material.glass;
    (void)hit;
    /* where the index does not change nothing is bent, however rough: half vectors do not exist there */
    bsdf_add_lobe(b, LOBE_DIELECTRIC, BSDF_TRACED, facets_are_smooth(m->facets) || m->ior == 1.0f, 1.0f);
}

const material_type dielectric_material = {.is_traced = material_always,
                                           .is_clear_glass = is_clear,
                                           .transmits = material_always,
                                           .is_transparent = material_always,
                                           .may_be_pane = may_be_pane,
                                           .may_be_slab = material_always,
                                           .init_point = init_point,
                                           .look_up = look_up,
                                           .has_grain = has_grain,
                                           .is_pane = is_pane,
                                           .pane_transmittance = pane_transmittance,
                                           .index = index_of,
                                           .faces = faces,
                                           .add_lobes = add_lobes,
                                           .base = LOBE_DIFFUSE};

/* --- a thin pane --- */

static bool is_thin_pane(const material_point *p)
{
    (void)p;
    return true;
}

static rgb thin_transmittance(const material_point *p, float cosine)
{
    return rgb_gray(1.0f - fresnel_thin_dielectric(float_min(fabsf(cosine), 1.0f), p->glass.ior));
}

static void add_thin_lobes(bsdf *b, const surface_hit *hit)
{
    (void)hit;
    bsdf_add_lobe(b, LOBE_THIN_DIELECTRIC, BSDF_TRACED, true, 1.0f);
}

const material_type thin_dielectric_material = {.is_traced = material_always,
                                                .is_clear_glass = material_always,
                                                .transmits = material_always,
                                                .is_transparent = material_always,
                                                .may_be_pane = material_always,
                                                .init_point = init_point,
                                                .look_up = look_up,
                                                .has_grain = has_grain,
                                                .is_pane = is_thin_pane,
                                                .pane_transmittance = thin_transmittance,
                                                .add_lobes = add_thin_lobes,
                                                .base = LOBE_DIFFUSE};
