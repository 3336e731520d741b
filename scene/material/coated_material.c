/* coated_material.c: a dielectric coat over a diffuse base or over a metal, as kinds of material (coat.h).
 * Threads: pure functions. */
#include "material/coat_table.h"
#include "material/fresnel.h"
#include "material/material_type.h"

static void *create_table(const material *m) { return coat_table_create(m); }

static bool table_serves(const void *content, const material *m) { return coat_table_serves(content, m); }

static void destroy_table(void *content) { coat_table_destroy(content); }

static const material_table_type TABLE = {coat_needs_table, create_table, table_serves, destroy_table};

static void init_point(const material *m, material_point *p) { p->coat = coat_point_of(m); }

static void look_up(const material_lookup *at, const material *m, material_point *p)
{
    coat_point *c = &p->coat;
    if (c->has_metal)
        material_look_up_metal(at, m, 1.0f / m->ior, &c->eta, &c->k);
    else
        material_look_up_color(at, m->reflectance_texture, &c->reflectance);
    material_look_up_facets(at, m, m->alpha_u_texture, m->alpha_v_texture, &c->interface);
    material_look_up_facets(at, m, m->base_alpha_u_texture, m->base_alpha_v_texture, &c->base);
}

static bool has_grain(const material_point *p)
{
    return facets_have_grain(p->coat.interface) || facets_have_grain(p->coat.base);
}

/* The coat's own lobes, after that of its base. */
static void add_coat(bsdf *b, float reflected, float cosine)
{
    const coat_point *m = &b->material.coat;
    rgb scattered = coat_scattered_albedo(m, cosine);
    if (m->ior != 1.0f)
        bsdf_add_lobe(b, LOBE_COAT, BSDF_TRACED, facets_are_smooth(m->interface), reflected);
    if (!rgb_is_black(scattered))
        bsdf_add_lobe(b, LOBE_COAT_SCATTERED, BSDF_TRACED, false, rgb_max(scattered));
}

/* --- over a diffuse base --- */

static bool diffuse_is_traced(const scene *s, const material *m)
{
    (void)s;
    return m->ior != 1.0f || !rgb_is_black(m->coat_albedo); /* else the coat does not reflect */
}

static bool has_base(const scene *s, const material *m)
{
    (void)s;
    return !rgb_is_black(m->reflectance) || m->reflectance_texture != SCENE_NO_TEXTURE;
}

static void add_diffuse_lobes(bsdf *b, const surface_hit *hit)
{
    const coat_point *m = &b->material.coat;
    (void)hit;
    float cosine = vec3_dot(b->out, b->shading.z), reflected = fresnel_dielectric(fabsf(cosine), m->ior);
    bsdf_add_lobe(b, LOBE_COATED_BASE, BSDF_GATHERED, false, (1.0f - reflected) * rgb_max(m->reflectance));
    add_coat(b, reflected, cosine);
}

const material_type coated_diffuse_material = {.table = &TABLE,
                                               .is_traced = diffuse_is_traced,
                                               .has_base = has_base,
                                               .init_point = init_point,
                                               .look_up = look_up,
                                               .has_grain = has_grain,
                                               .add_lobes = add_diffuse_lobes,
                                               .base = LOBE_COATED_BASE};

/* --- over a metal --- */

static void add_conductor_lobes(bsdf *b, const surface_hit *hit)
{
    const coat_point *m = &b->material.coat;
    (void)hit;
    float cosine = vec3_dot(b->out, b->shading.z);
    bsdf_add_lobe(b, LOBE_CONDUCTOR_UNDER_COAT, BSDF_TRACED, coat_is_smooth(m) && facets_are_smooth(m->base),
                  rgb_max(coat_metal_lobe_albedo(m, cosine)));
    add_coat(b, fresnel_dielectric(fabsf(cosine), m->ior), cosine);
}

const material_type coated_conductor_material = {.table = &TABLE,
                                                 .is_traced = material_always,
                                                 .init_point = init_point,
                                                 .look_up = look_up,
                                                 .has_grain = has_grain,
                                                 .add_lobes = add_conductor_lobes,
                                                 .base = LOBE_DIFFUSE};
