/* bsdf.c: see bsdf.h. Directions o (out) and i are in the shading frame, z up to the outside.
 * Threads: pure functions. */
#include "material/bsdf.h"

#include "material/bsdf_lobe.h"
#include "material/pane.h"
#include "math/sampling.h"

rgb bsdf_straight_transmittance(const bsdf *b)
{
    if (b->is_pane && b->lobes[0] == LOBE_SLAB)
        return b->material.slab.through;
    return b->is_pane ? pane_transmittance(&b->material, vec3_dot(b->out, b->shading.z)) : rgb_gray(0.0f);
}

/* Whether the lobe sends light to the other side too. */
static bool lobe_passes(const bsdf *b, int k)
{
    const bsdf_lobe_type *type = bsdf_lobe_type_of(b, k);
    return type->passes && (!type->passes_with || type->passes_with(&b->material));
}

bool bsdf_has_many_ways(const bsdf *b, bsdf_lobes lobes)
{
    const unsigned set = bsdf_lobe_set(b, lobes);
    for (int k = 0; set >> k; k++) {
        if (!(set >> k & 1) || !(b->probabilities[k] > 0.0f))
            continue;
        if (!(b->smooth_lobes >> k & 1) || lobe_passes(b, k)) /* all others are mirrors, and of the same normal */
            return true;
    }
    return false;
}

float bsdf_smooth_reflection_share(const bsdf *b, bsdf_lobes lobes)
{
    const unsigned set = bsdf_lobe_set(b, lobes);
    const bsdf_lobe_type *only = NULL;
    for (int k = 0; set >> k; k++) {
        if (!(set >> k & 1) || !(b->probabilities[k] > 0.0f))
            continue;
        if (only || !(b->smooth_lobes >> k & 1) || !lobe_passes(b, k))
            return -1.0f;
        only = bsdf_lobe_type_of(b, k);
    }
    return only ? only->reflection_share(b, frame_to_local(&b->shading, b->out)) : -1.0f;
}

/* Whether facets may send light through the surface: between the horizons of two normals that are apart. */
static bool facets_cross(const bsdf *b)
{
    static const float SAME = 0.9999f;
    return !b->is_tilted && fabsf(vec3_dot(b->shading.z, b->geometric_normal)) < SAME;
}

bool bsdf_scatters_through(const bsdf *b, bsdf_lobes lobes)
{
    for (unsigned left = bsdf_lobe_set(b, lobes) & ~(unsigned)b->smooth_lobes; left; left &= left - 1) {
        const int k = __builtin_ctz(left);
        if (lobe_passes(b, k) || (bsdf_lobe_type_of(b, k)->side == LOBE_BY_FACETS && facets_cross(b)))
            return true;
    }
    return false;
}

bool bsdf_is_rough_reflection(const bsdf *b, bsdf_lobes lobes)
{
    const unsigned set = bsdf_lobe_set(b, lobes);
    for (unsigned left = set; left; left &= left - 1)
        if (lobe_passes(b, __builtin_ctz(left)))
            return false;
    return set != 0 && (set & b->smooth_lobes) == 0;
}

static float probability_of(const bsdf *b, unsigned set)
{
    float sum = 0.0f;
    for (unsigned left = set; left; left &= left - 1)
        sum += b->probabilities[__builtin_ctz(left)];
    return sum;
}

float bsdf_probability(const bsdf *b, bsdf_lobes lobes) { return probability_of(b, bsdf_lobe_set(b, lobes)); }

rgb bsdf_gathered_reflection(const bsdf *b)
{
    const bsdf_lobe_type *base = bsdf_base_of(b);
    if (!base)
        return rgb_gray(0.0f);
    return rgb_scale(base->albedo(&b->material),
                     bsdf_lobe_transmittance(base, &b->material, vec3_dot(b->out, b->shading.z)));
}

rgb bsdf_gathered_transmission(const bsdf *b)
{
    for (int k = 0; k < b->lobe_count; k++) {
        const bsdf_lobe_type *type = bsdf_lobe_type_of(b, k);
        if (type->albedo && type->side == LOBE_TRANSMITS)
            return type->albedo(&b->material);
    }
    return rgb_gray(0.0f);
}

float bsdf_index(const bsdf *b)
{
    for (int k = 0; k < b->lobe_count; k++)
        if (bsdf_lobe_type_of(b, k)->index)
            return bsdf_lobe_type_of(b, k)->index(&b->material);
    return 1.0f;
}

/* Shading normals bend the cosine of flux (Veach 1997, 5.3.2): the factor for flux that came from `out` and goes on to
 * `direction` by a lobe that is not diffuse. */
static float flux_correction(const bsdf *b, vec3 direction)
{
    float numerator = fabsf(vec3_dot(b->out, b->shading.z) * vec3_dot(direction, b->geometric_normal));
    float denominator = fabsf(vec3_dot(b->out, b->geometric_normal) * vec3_dot(direction, b->shading.z));
    return denominator > 0.0f ? float_min(numerator / denominator, BSDF_SHADING_NORMAL_MAX) : 0.0f;
}

/* Of flux by a rough lobe. Diffuse lobes go by the geometric normal already; what hair sends on knows of no normal, and
 * the surface that it is on, unless it faces rays, is met by as much light as its geometric normal says. */
static float rough_flux_factor(const bsdf *b, const bsdf_lobe_type *type, vec3 direction)
{
    bool is_fibre = type->side == LOBE_BY_FIBRE;
    if (type->albedo || type->side == LOBE_BY_MEDIUM || (is_fibre && b->material.hair.surface == HAIR_FACES_RAYS))
        return 1.0f;
    if (!is_fibre)
        return flux_correction(b, direction);
    float met = fabsf(vec3_dot(b->out, b->geometric_normal));
    return met > 0.0f ? float_min(fabsf(vec3_dot(direction, b->geometric_normal)) / met, BSDF_FIBRE_FLUX_MAX) : 0.0f;
}

float bsdf_flux_gain(const bsdf *b)
{
    static const float LEFT = 0.5f; /* the mean cosine at which flux leaves */
    if (b->material.kind != MATERIAL_HAIR || b->material.hair.surface == HAIR_FACES_RAYS)
        return 1.0f;
    float met = fabsf(vec3_dot(b->out, b->geometric_normal));
    return float_clamp(LEFT / float_max(met, 1.0f / BSDF_FIBRE_FLUX_MAX), 1.0f, BSDF_FIBRE_FLUX_MAX);
}

/* base, m: a diffuse lobe, and the material that it is of. */
static float arrival_factor(const bsdf *b, const bsdf_lobe_type *base, const material_point *m)
{
    float shading = vec3_dot(b->out, b->shading.z), geometric = vec3_dot(b->out, b->geometric_normal);
    if (shading * geometric <= 0.0f)
        return 0.0f; /* behind the horizon of one of the normals: neither way of computing finds light */
    return float_min(shading / geometric, BSDF_SHADING_NORMAL_MAX) * bsdf_lobe_transmittance(base, m, shading);
}

float bsdf_arrival_factor(const bsdf *b)
{
    return arrival_factor(b, bsdf_base_of_kind(b->material.kind), &b->material);
}

bool bsdf_arrival_factor_beside(const scene *s, const surface_hit *hit, const bsdf *b, float *out_factor)
{
    material_point base;
    if (hit->is_strand || !material_gathering_at(s, hit, &base))
        return false;
    *out_factor = arrival_factor(b, bsdf_base_of_kind(base.kind), &base);
    return true;
}

/* Whether the lobe sends light from out to `direction` by the sides of the surface that they are on. o, i: the two in
 * the shading frame. */
static bool is_on_its_side(const bsdf *b, const bsdf_lobe_type *type, vec3 direction, vec3 o, vec3 i)
{
    switch (type->side) {
    case LOBE_REFLECTS: return bsdf_is_same_side(b, direction);
    case LOBE_TRANSMITS: return !bsdf_is_same_side(b, direction);
    case LOBE_BY_FACETS: return !b->is_tilted || bsdf_is_same_side(b, direction) == (o.z * i.z > 0.0f);
    case LOBE_BY_FIBRE:
    case LOBE_BY_MEDIUM: break;
    }
    return true;
}

/* The value of a set of lobes, and the density of sampling them. */
static rgb evaluate_set(const bsdf *b, unsigned set, bsdf_transport transport, vec3 direction, float *out_pdf)
{
    vec3 o = frame_to_local(&b->shading, b->out), i = frame_to_local(&b->shading, direction);
    rgb sum = rgb_gray(0.0f);
    float density = 0.0f;
    for (unsigned left = set & ~(unsigned)b->smooth_lobes; left; left &= left - 1) {
        const int k = __builtin_ctz(left);
        const bsdf_lobe_type *type = bsdf_lobe_type_of(b, k);
        rgb value = rgb_gray(0.0f);
        float pdf = 0.0f;
        if (b->is_tilted && !is_on_its_side(b, type, direction, o, i))
            continue;
        type->evaluate(b, transport, direction, o, i, &value, &pdf);
        if (transport == BSDF_FLUX)
            value = rgb_scale(value, rough_flux_factor(b, type, direction));
        sum = rgb_add(sum, value);
        density += pdf * b->probabilities[k];
    }
    *out_pdf = density > 0.0f ? density / probability_of(b, set) : 0.0f;
    return sum;
}

rgb bsdf_evaluate(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, vec3 direction)
{
    float pdf;
    return evaluate_set(b, bsdf_lobe_set(b, lobes), transport, direction, &pdf);
}

float bsdf_pdf(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, vec3 direction)
{
    float pdf;
    evaluate_set(b, bsdf_lobe_set(b, lobes), transport, direction, &pdf);
    return pdf;
}

/* Returns the number of a lobe of the set, picked, and rescales the random number to be uniform again. total: of their
 * probabilities. Returns -1 where none of them carries light. */
static int pick_lobe(const bsdf *b, unsigned set, float total, float *in_out_u, float *out_probability)
{
    float before = 0.0f;
    int last = -1;
    for (unsigned left = set; left; left &= left - 1) {
        const int k = __builtin_ctz(left);
        float p = b->probabilities[k] / total;
        if (p <= 0.0f)
            continue;
        last = k;
        *out_probability = p;
        if (*in_out_u < before + p) {
            *in_out_u = float_below_one((*in_out_u - before) / p);
            return last;
        }
        before += p;
    }
    return last;
}

/* f |cos| / pdf is the albedo, without evaluating any of them. Radiance comes by the cosine to the shading normal; flux
 * goes by that to the geometric one, as its radiance is the same all around (Veach 1997, 5.3). */
static bool sample_plain(const bsdf *b, bsdf_transport transport, vec2 u, bsdf_sample *out)
{
    bool is_flux = transport == BSDF_FLUX;
    frame around = is_flux ? frame_from_z(b->geometric_normal) : b->shading;
    float correction = is_flux ? bsdf_arrival_factor(b) : 1.0f;
    vec3 i = sample_cosine_hemisphere(u);
    out->pdf_solid_angle = i.z * AG_INV_PI;
    if (bsdf_is_below(b))
        i.z = -i.z;
    out->direction = frame_to_world(&around, i); /* unit to rounding, as the frame and i are */
    if (!(correction > 0.0f) || !bsdf_is_same_side(b, out->direction))
        return false;
    out->weight = rgb_scale(b->material.diffuse.reflectance, correction);
    out->is_delta = out->is_straight = false;
    out->group = BSDF_GATHERED;
    return true;
}

bool bsdf_sample_direction(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, float u_lobe, vec2 u,
                           bsdf_sample *out_sample)
{
    float probability;
    if (bsdf_is_plain(b))
        return (lobes & BSDF_GATHERED) && sample_plain(b, transport, u, out_sample);
    const unsigned set = bsdf_lobe_set(b, lobes);
    const float total = probability_of(b, set);
    if (!(total > 0.0f))
        return false;
    const int lobe = pick_lobe(b, set, total, &u_lobe, &probability);
    if (lobe < 0)
        return false;
    const bsdf_lobe_type *type = bsdf_lobe_type_of(b, lobe);
    vec3 o = frame_to_local(&b->shading, b->out), i;
    bsdf_sample *out = out_sample;
    out->group = b->gathered_lobes >> lobe & 1 ? BSDF_GATHERED : BSDF_TRACED;
    out->is_delta = b->smooth_lobes >> lobe & 1;
    out->is_straight = false;
    if (out->is_delta) {
        if (!type->sample_smooth(b, transport, o, u_lobe, &i, &out->weight))
            return false;
        out->direction = vec3_normalize(frame_to_world(&b->shading, i));
        if (!is_on_its_side(b, type, out->direction, o, i))
            return false;
        out->pdf_solid_angle = 0.0f;
        out->is_straight = b->is_pane && i.z * o.z < 0.0f;
        out->weight = rgb_scale(out->weight, 1.0f / probability);
        if (transport == BSDF_FLUX)
            out->weight = rgb_scale(out->weight, flux_correction(b, out->direction));
        return true;
    }
    bool is_by_geometry = transport == BSDF_FLUX && type->albedo;
    if ((is_by_geometry && !(bsdf_arrival_factor(b) > 0.0f)) || !type->sample_rough(b, transport, o, u_lobe, u, &i))
        return false;
    frame around = is_by_geometry ? frame_from_z(b->geometric_normal) : b->shading;
    out->direction = vec3_normalize(frame_to_world(&around, i));
    if (!is_by_geometry && !is_on_its_side(b, type, out->direction, o, i))
        return false;
    rgb value = evaluate_set(b, set, transport, out->direction, &out->pdf_solid_angle);
    if (!(out->pdf_solid_angle > 0.0f))
        return false;
    out->weight = rgb_scale(value, 1.0f / out->pdf_solid_angle);
    return rgb_is_finite(out->weight);
}
