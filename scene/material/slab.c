/* slab.c: see slab.h. Threads: pure functions. */
#include "material/slab.h"

#include "material/fresnel.h"
#include "scene.h"

bool slab_may_be_of(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->is_textured || m->displacement_texture != SCENE_NO_TEXTURE || m->normal_map_texture != SCENE_NO_TEXTURE ||
        m->ior == 1.0f || !material_is_smooth(m->alpha_u, m->alpha_v))
        return false;
    if (m->kind == MATERIAL_PRINCIPLED)
        return !m->is_thin && m->ior > 0.0f && m->transmission == 1.0f && m->metallic == 0.0f && m->clearcoat == 0.0f;
    return m->kind == MATERIAL_DIELECTRIC;
}

/* One channel of the series: entering and leaving let `in` and `out` through, the inner side reflects `within`. */
static float sum_series(float in, float within, float left, float out)
{
    float to_and_fro = within * left;
    return in * left * out / fmaxf(1.0f - to_and_fro * to_and_fro, 1e-12f);
}

slab_point slab_point_at(const material_point *face, float cosine, float thickness, const medium *between)
{
    bool is_principled = face->kind == MATERIAL_PRINCIPLED;
    float ior = is_principled ? face->principled.ior : face->glass.ior;
    float c = fminf(cosine, 1.0f), sin2_within = (1.0f - c * c) / (ior * ior);
    slab_point p = {.reflected = rgb_gray(1.0f), .through = rgb_gray(0.0f)};
    if (sin2_within >= 1.0f)
        return p;
    float cosine_within = sqrtf(1.0f - sin2_within);
    rgb outer = rgb_gray(fresnel_dielectric(c, ior)), inner = outer;
    rgb in = rgb_sub(rgb_gray(1.0f), outer), out = in, left = rgb_gray(1.0f);
    if (is_principled) {
        principled_interface(&face->principled, c, false, &outer, &in);
        principled_interface(&face->principled, cosine_within, true, &inner, &out);
    }
    if (between)
        left = medium_transmittance(between, thickness / cosine_within);
    p.through.r = sum_series(in.r, inner.r, left.r, out.r);
    p.through.g = sum_series(in.g, inner.g, left.g, out.g);
    p.through.b = sum_series(in.b, inner.b, left.b, out.b);
    /* what is reflected within once more, and leaves by the face that it came in by */
    p.reflected = rgb_add(outer, rgb_mul(p.through, rgb_mul(inner, left)));
    return p;
}
