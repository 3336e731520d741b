/* bsdf.c: see bsdf.h. Directions o (out) and i are in the shading frame, z up to the outside.
 * Threads: pure functions. */
#include "material/bsdf.h"

#include "material/bsdf_lobe.h"
#include "material/coat.h"
#include "material/fresnel.h"
#include "material/pane.h"
#include "material/principled.h"
#include "material/shading_frame.h"
#include "material/slab.h"
#include "math/sampling.h"
#include "scene.h"

/* No lobe of two is picked more rarely. */
static const float PROBABILITY_MIN = 0.1f;

static void add_lobe(bsdf *b, bsdf_lobe_kind kind, bsdf_lobes group, bool is_delta, float share)
{
    b->lobes[b->lobe_count++] = (bsdf_lobe){kind, group, is_delta, share};
}

/* Gives each of three lobes that carries anything the least share, at the cost of the others. */
static void normalize_many(bsdf *b)
{
    float sum = 0.0f, free_sum = 0.0f, left = 1.0f;
    for (int k = 0; k < b->lobe_count; k++)
        sum += b->lobes[k].probability;
    for (int k = 0; k < b->lobe_count; k++) {
        float *p = &b->lobes[k].probability;
        *p = sum > 0.0f ? *p / sum : 1.0f / (float)b->lobe_count;
        if (*p > 0.0f && *p <= PROBABILITY_MIN) {
            *p = PROBABILITY_MIN;
            left -= PROBABILITY_MIN;
        } else {
            free_sum += *p;
        }
    }
    for (int k = 0; k < b->lobe_count; k++)
        if (b->lobes[k].probability > PROBABILITY_MIN)
            b->lobes[k].probability *= left / free_sum;
}

/* Shares become probabilities; a lobe that carries anything is not neglected. */
static void normalize_probabilities(bsdf *b)
{
    if (b->lobe_count > 2) {
        normalize_many(b);
        return;
    }
    if (b->lobe_count < 2) {
        b->lobes[0].probability = 1.0f;
        return;
    }
    float a = b->lobes[0].probability, sum = a + b->lobes[1].probability;
    float p = sum > 0.0f ? a / sum : 0.5f;
    if (p > 0.0f && p < 1.0f)
        p = fminf(fmaxf(p, PROBABILITY_MIN), 1.0f - PROBABILITY_MIN);
    b->lobes[0].probability = p;
    b->lobes[1].probability = 1.0f - p;
}

static void add_principled(bsdf *b)
{
    const material *m = &b->parameters;
    float cosine = vec3_dot(b->out, b->shading.z);
    principled_shares shares = principled_shares_at(m, fminf(fabsf(cosine), 1.0f));
    bool has_interface = principled_has_interface(m);
    if (!rgb_is_black(principled_base_albedo(m)) || !has_interface)
        add_lobe(b, LOBE_DIFFUSE, BSDF_GATHERED, false, shares.base);
    if (has_interface)
        add_lobe(b, LOBE_PRINCIPLED, BSDF_TRACED, material_is_smooth(m->alpha_u, m->alpha_v), shares.interface);
    float coat_alpha = m->clearcoat_roughness * m->clearcoat_roughness;
    if (m->clearcoat > 0.0f && !(cosine < 0.0f && principled_is_solid(m)))
        add_lobe(b, LOBE_CLEARCOAT, BSDF_TRACED, material_is_smooth(coat_alpha, coat_alpha), shares.coat);
}

static void add_lobes(bsdf *b)
{
    const material *m = &b->parameters;
    bool smooth = material_is_smooth(m->alpha_u, m->alpha_v);
    float coat = m->kind == MATERIAL_COATED_DIFFUSE || m->kind == MATERIAL_COATED_CONDUCTOR
                     ? fresnel_dielectric(fabsf(vec3_dot(b->out, b->shading.z)), m->ior)
                     : 0.0f;
    rgb scattered = m->kind == MATERIAL_COATED_DIFFUSE || m->kind == MATERIAL_COATED_CONDUCTOR
                        ? coat_scattered_albedo(m, vec3_dot(b->out, b->shading.z))
                        : rgb_gray(0.0f);
    switch (m->kind) {
    case MATERIAL_INTERFACE: break; /* none: rays do not stop here */
    case MATERIAL_MIX:              /* resolved before */
    case MATERIAL_DIFFUSE: add_lobe(b, LOBE_DIFFUSE, BSDF_GATHERED, false, 1.0f); break;
    case MATERIAL_DIFFUSE_TRANSMISSION:
        add_lobe(b, LOBE_DIFFUSE, BSDF_GATHERED, false, rgb_max(m->reflectance));
        add_lobe(b, LOBE_DIFFUSE_THROUGH, BSDF_GATHERED, false, rgb_max(m->transmittance));
        break;
    case MATERIAL_CONDUCTOR: add_lobe(b, LOBE_CONDUCTOR, BSDF_TRACED, smooth, 1.0f); break;
    case MATERIAL_DIELECTRIC:
        /* where the index does not change nothing is bent, however rough: half vectors do not exist there */
        add_lobe(b, LOBE_DIELECTRIC, BSDF_TRACED, smooth || m->ior == 1.0f, 1.0f);
        break;
    case MATERIAL_THIN_DIELECTRIC: add_lobe(b, LOBE_THIN_DIELECTRIC, BSDF_TRACED, true, 1.0f); break;
    case MATERIAL_COATED_DIFFUSE:
        add_lobe(b, LOBE_DIFFUSE, BSDF_GATHERED, false, (1.0f - coat) * rgb_max(m->reflectance));
        if (m->ior != 1.0f)
            add_lobe(b, LOBE_COAT, BSDF_TRACED, smooth, coat);
        if (!rgb_is_black(scattered))
            add_lobe(b, LOBE_COAT_SCATTERED, BSDF_TRACED, false, rgb_max(scattered));
        break;
    case MATERIAL_COATED_CONDUCTOR:
        add_lobe(b, LOBE_CONDUCTOR_UNDER_COAT, BSDF_TRACED,
                 coat_is_smooth(m) && material_is_smooth(m->base_alpha_u, m->base_alpha_v),
                 rgb_max(coat_metal_lobe_albedo(m, vec3_dot(b->out, b->shading.z))));
        if (m->ior != 1.0f)
            add_lobe(b, LOBE_COAT, BSDF_TRACED, smooth, coat);
        if (!rgb_is_black(scattered))
            add_lobe(b, LOBE_COAT_SCATTERED, BSDF_TRACED, false, rgb_max(scattered));
        break;
    case MATERIAL_HAIR: add_lobe(b, LOBE_HAIR, BSDF_TRACED, false, 1.0f); break;
    case MATERIAL_PRINCIPLED: add_principled(b); break;
    }
    normalize_probabilities(b);
}

/* The parameters are there already: they are large, and copied once. */
static void set_up(bsdf *b, frame shading, const surface_hit *hit, vec3 out)
{
    b->shading = shading;
    b->geometric_normal = hit->geometric_normal;
    b->out = out;
    b->is_pane = pane_is_of(&b->parameters);
    b->is_tilted = shading_frame_is_tilted(&b->parameters);
    b->lobe_count = 0;
    if (b->parameters.kind == MATERIAL_HAIR) {
        float v = hit->is_mirrored ? 1.0f - hit->uv.y : hit->uv.y;
        b->fibre = hair_fibre_at(&b->parameters, v, frame_to_local(&b->shading, out));
        b->fibre.faces_rays = hit->faces_rays;
    }
    add_lobes(b);
    for (int k = 0; hit->is_strand && k < b->lobe_count; k++)
        b->lobes[k].group = BSDF_TRACED;
}

bsdf bsdf_create_of(const material *parameters, const surface_hit *hit, vec3 out)
{
    bsdf b;
    b.parameters = *parameters;
    set_up(&b, frame_from_z(hit->shading_normal), hit, out);
    return b;
}

/* Makes one hit of both faces of a slab and what is between them. */
static void make_slab(const scene *s, const surface_hit *hit, bsdf *b)
{
    const medium *between = hit->slab.medium < s->medium_count ? &s->media[hit->slab.medium] : NULL;
    b->is_pane = true;
    b->lobe_count = 0;
    add_lobe(b, LOBE_SLAB, BSDF_TRACED, true, 1.0f);
    slab_find_shares(&b->parameters, fabsf(vec3_dot(b->out, b->geometric_normal)), hit->slab.thickness, between,
                     &b->slab_reflected, &b->slab_through);
}

bsdf bsdf_create(const scene *s, const surface_hit *hit, vec3 out)
{
    bsdf b;
    material_at(s, hit, &b.parameters);
    set_up(&b, shading_frame_at(s, hit, &b.parameters), hit, out);
    b.is_pane = b.is_pane && s->shapes[hit->shape_index].light_index == SHAPE_NO_LIGHT;
    if (hit->slab.thickness > 0.0f)
        make_slab(s, hit, &b);
    return b;
}

bool bsdf_has(const bsdf *b, bsdf_lobes lobes)
{
    for (int i = 0; i < b->lobe_count; i++)
        if (b->lobes[i].group & lobes)
            return true;
    return false;
}

rgb bsdf_straight_transmittance(const bsdf *b)
{
    if (b->is_pane && b->lobes[0].kind == LOBE_SLAB)
        return b->slab_through;
    return b->is_pane ? pane_transmittance(&b->parameters, vec3_dot(b->out, b->shading.z)) : rgb_gray(0.0f);
}

bool bsdf_is_sampled_from_light(const bsdf *b, bsdf_lobes lobes)
{
    for (int i = 0; i < b->lobe_count; i++)
        if ((b->lobes[i].group & lobes) && !b->lobes[i].is_delta)
            return true;
    return false;
}

/* Whether the lobe sends light to the other side too. */
static bool lobe_passes(const bsdf *b, const bsdf_lobe *lobe)
{
    const bsdf_lobe_type *type = bsdf_lobe_type_of(lobe->kind);
    return type->passes && type->passes(&b->parameters);
}

bool bsdf_has_many_ways(const bsdf *b, bsdf_lobes lobes)
{
    for (int i = 0; i < b->lobe_count; i++) {
        const bsdf_lobe *lobe = &b->lobes[i];
        if (!(lobe->group & lobes) || !(lobe->probability > 0.0f))
            continue;
        if (!lobe->is_delta || lobe_passes(b, lobe)) /* all others are mirrors, and of the same normal */
            return true;
    }
    return false;
}

/* Whether facets may send light through the surface: between the horizons of two normals that are apart. */
static bool facets_cross(const bsdf *b)
{
    static const float SAME = 0.9999f;
    return !b->is_tilted && fabsf(vec3_dot(b->shading.z, b->geometric_normal)) < SAME;
}

bool bsdf_scatters_through(const bsdf *b, bsdf_lobes lobes)
{
    for (int i = 0; i < b->lobe_count; i++) {
        const bsdf_lobe *lobe = &b->lobes[i];
        if ((lobe->group & lobes) && !lobe->is_delta &&
            (lobe_passes(b, lobe) || (bsdf_lobe_has_facets(lobe->kind) && facets_cross(b))))
            return true;
    }
    return false;
}

float bsdf_probability(const bsdf *b, bsdf_lobes lobes)
{
    float sum = 0.0f;
    for (int i = 0; i < b->lobe_count; i++)
        if (b->lobes[i].group & lobes)
            sum += b->lobes[i].probability;
    return sum;
}

rgb bsdf_gathered_reflection(const bsdf *b)
{
    const material *m = &b->parameters;
    switch (m->kind) {
    case MATERIAL_DIFFUSE:
    case MATERIAL_DIFFUSE_TRANSMISSION: return m->reflectance;
    case MATERIAL_COATED_DIFFUSE:
    case MATERIAL_PRINCIPLED:
        return rgb_scale(bsdf_lobe_diffuse_albedo(m), bsdf_lobe_transmittance(m, vec3_dot(b->out, b->shading.z)));
    default: return rgb_gray(0.0f);
    }
}

rgb bsdf_gathered_transmission(const bsdf *b)
{
    return b->parameters.kind == MATERIAL_DIFFUSE_TRANSMISSION ? b->parameters.transmittance : rgb_gray(0.0f);
}

/* Shading normals bend the cosine of flux (Veach 1997, 5.3.2): the factor for flux that came from `out` and goes on to
 * `direction` by a lobe that is not diffuse. */
static float flux_correction(const bsdf *b, vec3 direction)
{
    float numerator = fabsf(vec3_dot(b->out, b->shading.z) * vec3_dot(direction, b->geometric_normal));
    float denominator = fabsf(vec3_dot(b->out, b->geometric_normal) * vec3_dot(direction, b->shading.z));
    return denominator > 0.0f ? fminf(numerator / denominator, BSDF_SHADING_NORMAL_MAX) : 0.0f;
}

/* Of flux by a rough lobe. Diffuse lobes go by the geometric normal already; what hair sends on knows of no normal, and
 * the surface that it is on, unless it faces rays, is met by as much light as its geometric normal says. */
static float rough_flux_factor(const bsdf *b, bsdf_lobe_kind kind, vec3 direction)
{
    if (bsdf_lobe_is_diffuse(kind) || (kind == LOBE_HAIR && b->fibre.faces_rays))
        return 1.0f;
    if (kind != LOBE_HAIR)
        return flux_correction(b, direction);
    float met = fabsf(vec3_dot(b->out, b->geometric_normal));
    return met > 0.0f ? fminf(fabsf(vec3_dot(direction, b->geometric_normal)) / met, BSDF_SHADING_NORMAL_MAX) : 0.0f;
}

static float arrival_factor(const bsdf *b, const material *base)
{
    float shading = vec3_dot(b->out, b->shading.z), geometric = vec3_dot(b->out, b->geometric_normal);
    if (shading * geometric <= 0.0f)
        return 0.0f; /* behind the horizon of one of the normals: neither way of computing finds light */
    return fminf(shading / geometric, BSDF_SHADING_NORMAL_MAX) * bsdf_lobe_transmittance(base, shading);
}

float bsdf_arrival_factor(const bsdf *b) { return arrival_factor(b, &b->parameters); }

bool bsdf_arrival_factor_beside(const scene *s, const surface_hit *hit, const bsdf *b, float *out_factor)
{
    material base;
    if (hit->is_strand || !material_gathering_at(s, hit, &base))
        return false;
    *out_factor = arrival_factor(b, &base);
    return true;
}

/* Whether the lobe sends light from out to `direction` by the sides of the surface that they are on. o, i: the two in
 * the shading frame. */
static bool is_on_its_side(const bsdf *b, bsdf_lobe_kind kind, vec3 direction, vec3 o, vec3 i)
{
    if (kind == LOBE_HAIR || (bsdf_lobe_has_facets(kind) && !b->is_tilted))
        return true;
    bool is_reflection = bsdf_lobe_has_facets(kind) ? o.z * i.z > 0.0f : kind != LOBE_DIFFUSE_THROUGH;
    return bsdf_is_same_side(b, direction) == is_reflection;
}

/* The value, and the density of sampling. */
static rgb evaluate_all(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, vec3 direction, float *out_pdf)
{
    vec3 o = frame_to_local(&b->shading, b->out), i = frame_to_local(&b->shading, direction);
    rgb sum = rgb_gray(0.0f);
    float density = 0.0f;
    for (int k = 0; k < b->lobe_count; k++) {
        rgb value = rgb_gray(0.0f);
        float pdf = 0.0f;
        if (!(b->lobes[k].group & lobes) || b->lobes[k].is_delta ||
            (b->is_tilted && !is_on_its_side(b, b->lobes[k].kind, direction, o, i)))
            continue;
        bsdf_lobe_type_of(b->lobes[k].kind)->evaluate(b, transport, direction, o, i, &value, &pdf);
        if (transport == BSDF_FLUX)
            value = rgb_scale(value, rough_flux_factor(b, b->lobes[k].kind, direction));
        sum = rgb_add(sum, value);
        density += pdf * b->lobes[k].probability;
    }
    *out_pdf = density > 0.0f ? density / bsdf_probability(b, lobes) : 0.0f;
    return sum;
}

rgb bsdf_evaluate(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, vec3 direction)
{
    float pdf;
    return evaluate_all(b, lobes, transport, direction, &pdf);
}

float bsdf_pdf(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, vec3 direction)
{
    float pdf;
    evaluate_all(b, lobes, transport, direction, &pdf);
    return pdf;
}

/* Picks among the lobes asked for, and makes the random number fresh again. */
static const bsdf_lobe *pick_lobe(const bsdf *b, bsdf_lobes lobes, float *in_out_u, float *out_probability)
{
    float total = bsdf_probability(b, lobes), before = 0.0f;
    const bsdf_lobe *last = NULL;
    for (int k = 0; k < b->lobe_count; k++) {
        float p = b->lobes[k].probability / total;
        if (!(b->lobes[k].group & lobes) || p <= 0.0f)
            continue;
        last = &b->lobes[k];
        *out_probability = p;
        if (*in_out_u < before + p) {
            *in_out_u = fminf((*in_out_u - before) / p, 0x1.fffffep-1f);
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
    out->weight = rgb_scale(b->parameters.reflectance, correction);
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
    if (!(bsdf_probability(b, lobes) > 0.0f))
        return false;
    const bsdf_lobe *lobe = pick_lobe(b, lobes, &u_lobe, &probability);
    if (!lobe)
        return false;
    const bsdf_lobe_type *type = bsdf_lobe_type_of(lobe->kind);
    vec3 o = frame_to_local(&b->shading, b->out), i;
    bsdf_sample *out = out_sample;
    out->group = lobe->group;
    out->is_delta = lobe->is_delta;
    out->is_straight = false;
    if (lobe->is_delta) {
        if (!type->sample_smooth(b, transport, o, u_lobe, &i, &out->weight))
            return false;
        out->direction = vec3_normalize(frame_to_world(&b->shading, i));
        if (!is_on_its_side(b, lobe->kind, out->direction, o, i))
            return false;
        out->pdf_solid_angle = 0.0f;
        out->is_straight = b->is_pane && i.z * o.z < 0.0f;
        out->weight = rgb_scale(out->weight, 1.0f / probability);
        if (transport == BSDF_FLUX)
            out->weight = rgb_scale(out->weight, flux_correction(b, out->direction));
        return true;
    }
    bool is_by_geometry = transport == BSDF_FLUX && bsdf_lobe_is_diffuse(lobe->kind);
    if ((is_by_geometry && !(bsdf_arrival_factor(b) > 0.0f)) || !type->sample_rough(b, o, u_lobe, u, &i))
        return false;
    frame around = is_by_geometry ? frame_from_z(b->geometric_normal) : b->shading;
    out->direction = vec3_normalize(frame_to_world(&around, i));
    if (!is_by_geometry && !is_on_its_side(b, lobe->kind, out->direction, o, i))
        return false;
    rgb value = evaluate_all(b, lobes, transport, out->direction, &out->pdf_solid_angle);
    if (!(out->pdf_solid_angle > 0.0f))
        return false;
    out->weight = rgb_scale(value, 1.0f / out->pdf_solid_angle);
    return rgb_is_finite(out->weight);
}
