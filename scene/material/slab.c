/* slab.c: see slab.h. Threads: pure functions. */
#include "material/slab.h"

#include "material/material_type.h"
#include "scene.h"

bool slab_may_be_of(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    const material_type *type = material_type_of(m->kind);
    if (m->is_textured || m->displacement_texture != SCENE_NO_TEXTURE || m->normal_map_texture != SCENE_NO_TEXTURE ||
        m->ior == 1.0f || !material_is_smooth(m->alpha_u, m->alpha_v))
        return false;
    return type->may_be_slab && type->may_be_slab(s, m);
}

/* One channel of the series: entering and leaving let `in` and `out` through, the inner side reflects `within`. */
static float sum_series(float in, float within, float left, float out)
{
    float to_and_fro = within * left;
    return in * left * out / float_max(1.0f - to_and_fro * to_and_fro, 1e-12f);
}

/* The way within is as long as the bent one, and lies where the straight one does. */
static rgb transmittance_within(const surface_hit *hit, float cosine_within, const medium *between)
{
    const medium_stretch way = {hit->position, vec3_normalize(vec3_sub(hit->slab.exit, hit->position)),
                                hit->slab.thickness / cosine_within};
    return medium_transmittance(between, &way);
}

slab_point slab_point_at(const material_point *face, float cosine, const surface_hit *hit, const medium *between)
{
    const material_type *type = material_type_of(face->kind);
    float ior = type->index(face), c = float_min(cosine, 1.0f), sin2_within = (1.0f - c * c) / (ior * ior);
    slab_point p = {.reflected = rgb_gray(1.0f), .through = rgb_gray(0.0f)};
    if (sin2_within >= 1.0f)
        return p;
    float cosine_within = sqrtf(1.0f - sin2_within);
    material_faces f = type->faces(face, c, cosine_within);
    rgb left = between ? transmittance_within(hit, cosine_within, between) : rgb_gray(1.0f);
    p.through.r = sum_series(f.in.r, f.inner.r, left.r, f.out.r);
    p.through.g = sum_series(f.in.g, f.inner.g, left.g, f.out.g);
    p.through.b = sum_series(f.in.b, f.inner.b, left.b, f.out.b);
    /* light that is reflected within once more, and leaves by the face that it entered by */
    p.reflected = rgb_add(f.outer, rgb_mul(p.through, rgb_mul(f.inner, left)));
    return p;
}
