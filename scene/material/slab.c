/* slab.c: see slab.h. Threads: pure functions. */
#include "material/slab.h"

#include "material/fresnel.h"
#include "material/principled.h"
#include "scene.h"

bool slab_may_be_of(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->is_textured || m->displacement_texture != SCENE_NO_TEXTURE || m->normal_map_texture != SCENE_NO_TEXTURE ||
        m->ior == 1.0f || !material_is_smooth(m->alpha_u, m->alpha_v))
        return false;
    if (m->kind == MATERIAL_PRINCIPLED)
        return principled_is_solid(m) && m->transmission == 1.0f && m->metallic == 0.0f && m->clearcoat == 0.0f;
    return m->kind == MATERIAL_DIELECTRIC;
}

/* One channel of the series: entering and leaving let `in` and `out` through, the inner side reflects `within`. */
static float sum_series(float in, float within, float left, float out)
{
    float to_and_fro = within * left;
    return in * left * out / fmaxf(1.0f - to_and_fro * to_and_fro, 1e-12f);
}

void slab_find_shares(const material *m, float cosine, float thickness, const medium *between, rgb *out_reflected,
                      rgb *out_through)
{
    float c = fminf(cosine, 1.0f), sin2_within = (1.0f - c * c) / (m->ior * m->ior);
    *out_reflected = rgb_gray(1.0f);
    *out_through = rgb_gray(0.0f);
    if (sin2_within >= 1.0f)
        return;
    float cosine_within = sqrtf(1.0f - sin2_within);
    rgb outer = rgb_gray(fresnel_dielectric(c, m->ior)), inner = outer;
    rgb in = rgb_sub(rgb_gray(1.0f), outer), out = in, left = rgb_gray(1.0f);
    if (m->kind == MATERIAL_PRINCIPLED) {
        principled_interface(m, c, false, &outer, &in);
        principled_interface(m, cosine_within, true, &inner, &out);
    }
    if (between)
        left = medium_transmittance(between, thickness / cosine_within);
    out_through->r = sum_series(in.r, inner.r, left.r, out.r);
    out_through->g = sum_series(in.g, inner.g, left.g, out.g);
    out_through->b = sum_series(in.b, inner.b, left.b, out.b);
    /* what is reflected within once more, and leaves by the face that it came in by */
    *out_reflected = rgb_add(outer, rgb_mul(*out_through, rgb_mul(inner, left)));
}
