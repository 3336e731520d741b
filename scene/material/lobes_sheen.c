/* lobes_sheen.c: the sheen of fibres (sheen.h) as a lobe, below the coat of MATERIAL_PRINCIPLED and above all else of
 * it. Sampled evenly over the hemisphere, as Estevez and Kulla ("Production Friendly Microfacet Sheen BRDF", 2017, 4)
 * found best: the lobe is broad, and what it has of a peak is along the horizon. Directions o (out) and i are in the
 * shading frame. Threads: pure functions. */
#include "material/bsdf_lobe.h"

static const float PDF = 0.5f * AG_INV_PI;

/* +1 where out is outside, by the geometric normal, else -1. */
static float side_of(const bsdf *b) { return bsdf_is_below(b) ? -1.0f : 1.0f; }

static void evaluate_sheen(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                           float *out_pdf)
{
    const principled_point *m = &b->material.principled;
    const float side = side_of(b);
    (void)transport;
    if (!bsdf_is_same_side(b, direction) || !(side * i.z > 0.0f))
        return;
    *out_pdf = PDF;
    if (!(side * o.z > 0.0f))
        return;
    const vec3 upper_o = {o.x, o.y, side * o.z}, upper_i = {i.x, i.y, side * i.z};
    const float value = sheen_value((sheen_model)m->sheen_model, m->sheen_roughness, upper_o, upper_i) * upper_i.z;
    *out_value = rgb_scale(m->sheen, value * principled_sheen_factor(m, o.z, i.z));
}

static bool sample_sheen(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    float sine, cosine;
    const float radius = sqrtf(float_max(1.0f - u.x * u.x, 0.0f));
    (void)transport, (void)o, (void)u_lobe;
    sincos_turns(u.y, &sine, &cosine);
    *out_local = (vec3){radius * cosine, radius * sine, side_of(b) * u.x};
    return u.x > 0.0f;
}

const bsdf_lobe_type bsdf_lobe_sheen = {
    .side = LOBE_REFLECTS,
    .evaluate = evaluate_sheen,
    .sample_rough = sample_sheen,
};
