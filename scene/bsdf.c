/* bsdf.c: see bsdf.h. Directions are in the shading frame, z up to the outside.
 * Threads: pure functions. */
#include "bsdf.h"

#include "fresnel.h"
#include "math/rng.h"
#include "microfacet.h"
#include "scene.h"

#include <string.h>

/* The largest factor that shading normals may add to a photon: beyond it lie grazing silhouettes only. */
static const float CORRECTION_MAX = 8.0f;
/* No lobe of two is picked more rarely. */
static const float PROBABILITY_MIN = 0.1f;

/* --- materials --- */

static void make_rough_on_both_axes(float *alpha_u, float *alpha_v)
{
    /* rough along one axis only: the other must not divide by zero */
    if (*alpha_u >= MATERIAL_SMOOTH_ALPHA || *alpha_v >= MATERIAL_SMOOTH_ALPHA) {
        *alpha_u = fmaxf(*alpha_u, 1e-4f);
        *alpha_v = fmaxf(*alpha_v, 1e-4f);
    }
}

void material_prepare(material *m)
{
    make_rough_on_both_axes(&m->alpha_u, &m->alpha_v);
    make_rough_on_both_axes(&m->base_alpha_u, &m->base_alpha_v);
    if (m->kind == MATERIAL_COATED_DIFFUSE)
        m->coat_return = fresnel_dielectric_diffuse(1.0f / m->ior, m->coat_thickness);
}

static bool is_smooth(float alpha_u, float alpha_v)
{
    return alpha_u < MATERIAL_SMOOTH_ALPHA && alpha_v < MATERIAL_SMOOTH_ALPHA;
}

bool material_is_traced(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->kind == MATERIAL_MIX)
        return material_is_traced(s, m->mixed[0]) || material_is_traced(s, m->mixed[1]);
    return m->kind != MATERIAL_DIFFUSE && m->kind != MATERIAL_DIFFUSE_TRANSMISSION;
}

static ggx interface_of(const material *m) { return (ggx){m->alpha_u, m->alpha_v}; }

/* A mix picks one of its two by place alone, as pbrt-v4 does: the same for all rays, so photons and eye agree. */
static const material *resolve_mix(const scene *s, const material *m, const surface_hit *hit)
{
    uint32_t bits[3];
    memcpy(bits, &hit->position, sizeof bits);
    uint64_t hash = hash_combine(hash_combine(bits[0], bits[1]), bits[2]);
    while (m->kind == MATERIAL_MIX) {
        hash = hash_mix64(hash + 0x9e3779b97f4a7c15u);
        float u = (float)(hash >> 40) * 0x1p-24f;
        float amount = m->is_textured ? texture_evaluate_float(s, m->mix_amount_texture, hit) : m->mix_amount;
        m = &s->materials[m->mixed[u < amount ? 1 : 0]];
    }
    return m;
}

static rgb clamp_to_unit(rgb v)
{
    return (rgb){fminf(fmaxf(v.r, 0.0f), 1.0f), fminf(fmaxf(v.g, 0.0f), 1.0f), fminf(fmaxf(v.b, 0.0f), 1.0f)};
}

/* The material as it is at a place. */
static void look_up_textures(const scene *s, const surface_hit *hit, material *m)
{
    if (m->reflectance_texture != SCENE_NO_TEXTURE) {
        m->reflectance = clamp_to_unit(texture_evaluate_rgb(s, m->reflectance_texture, hit));
        rgb r = m->reflectance;
        float relative = m->kind == MATERIAL_COATED_CONDUCTOR ? 1.0f / m->ior : 1.0f;
        if (m->kind == MATERIAL_CONDUCTOR || m->kind == MATERIAL_COATED_CONDUCTOR) {
            m->eta = rgb_gray(relative);
            m->k = rgb_scale((rgb){material_k_from_reflectance(r.r), material_k_from_reflectance(r.g),
                                   material_k_from_reflectance(r.b)},
                             relative);
        }
    }
    if (m->transmittance_texture != SCENE_NO_TEXTURE)
        m->transmittance = clamp_to_unit(texture_evaluate_rgb(s, m->transmittance_texture, hit));
    if (m->kind == MATERIAL_DIFFUSE_TRANSMISSION) {
        float sum = rgb_max(rgb_add(m->reflectance, m->transmittance));
        if (sum > 1.0f) {
            m->reflectance = rgb_scale(m->reflectance, 1.0f / sum);
            m->transmittance = rgb_scale(m->transmittance, 1.0f / sum);
        }
    }
    const uint32_t alpha_textures[2] = {m->alpha_u_texture, m->alpha_v_texture};
    float *const alphas[2] = {&m->alpha_u, &m->alpha_v};
    for (int i = 0; i < 2; i++)
        if (alpha_textures[i] != SCENE_NO_TEXTURE) {
            float value = fmaxf(0.0f, texture_evaluate_float(s, alpha_textures[i], hit));
            *alphas[i] = m->remaps_roughness ? sqrtf(value) : value;
        }
    make_rough_on_both_axes(&m->alpha_u, &m->alpha_v);
}

/* --- lobes --- */

/* A direction refracted into the coat, on the same side of the base as it was. */
static vec3 into_coat(const material *m, vec3 v)
{
    float sin2 = fmaxf(0.0f, 1.0f - v.z * v.z) / (m->ior * m->ior);
    return (vec3){v.x / m->ior, v.y / m->ior, copysignf(sqrtf(fmaxf(0.0f, 1.0f - sin2)), v.z)};
}

/* What a coat lets through, once, of light at that cosine outside; 1 where there is none. */
static float coat_transmittance(const material *m, float cos_theta)
{
    if (m->kind != MATERIAL_COATED_DIFFUSE && m->kind != MATERIAL_COATED_CONDUCTOR)
        return 1.0f;
    float through = 1.0f - fresnel_dielectric(fabsf(cos_theta), m->ior);
    if (m->coat_thickness > 0.0f && through > 0.0f)
        through *= attenuation(m->coat_thickness / fabsf(into_coat(m, (vec3){0.0f, 0.0f, cos_theta}).z));
    return through;
}

/* r + r (r back) + r (r back)^2 + …: light that goes to and fro between base and coat. */
static float coat_sum(const material *m, float r)
{
    float again = r * m->coat_return, lost = 1.0f;
    for (int i = 0; i < m->coat_bounces; i++)
        lost *= again;
    return r * (m->coat_bounces > 0 ? 1.0f - lost : 1.0f) / (1.0f - again);
}

/* A of the diffuse reflection. What gets out of a coat is spread over a wider solid angle: the squared index. */
static rgb diffuse_albedo(const material *m)
{
    if (m->kind != MATERIAL_COATED_DIFFUSE)
        return m->reflectance;
    rgb r = m->reflectance;
    return rgb_scale((rgb){coat_sum(m, r.r), coat_sum(m, r.g), coat_sum(m, r.b)}, 1.0f / (m->ior * m->ior));
}

static void add_lobe(bsdf *b, bsdf_lobe_kind kind, bsdf_lobes group, bool is_delta, float share)
{
    b->lobes[b->lobe_count++] = (bsdf_lobe){kind, group, is_delta, share};
}

/* Shares become probabilities; a lobe that carries anything is not neglected. */
static void normalize_probabilities(bsdf *b)
{
    if (b->lobe_count == 1) {
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

static void add_lobes(bsdf *b)
{
    const material *m = &b->matter;
    bool smooth = is_smooth(m->alpha_u, m->alpha_v);
    float coat = m->kind == MATERIAL_COATED_DIFFUSE || m->kind == MATERIAL_COATED_CONDUCTOR
                     ? fresnel_dielectric(fabsf(vec3_dot(b->out, b->shading.z)), m->ior)
                     : 0.0f;
    switch (m->kind) {
    case MATERIAL_MIX: /* resolved before */
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
        add_lobe(b, LOBE_COAT, BSDF_TRACED, smooth, coat);
        break;
    case MATERIAL_COATED_CONDUCTOR:
        add_lobe(b, LOBE_CONDUCTOR_UNDER_COAT, BSDF_TRACED, is_smooth(m->base_alpha_u, m->base_alpha_v), 1.0f - coat);
        add_lobe(b, LOBE_COAT, BSDF_TRACED, smooth, coat);
        break;
    }
    normalize_probabilities(b);
}

bsdf bsdf_create_of(const material *matter, const surface_hit *hit, vec3 out)
{
    bsdf b;
    b.shading = frame_from_z(hit->shading_normal);
    b.geometric_normal = hit->geometric_normal;
    b.out = out;
    b.matter = *matter;
    b.lobe_count = 0;
    add_lobes(&b);
    return b;
}

bsdf bsdf_create(const scene *s, const surface_hit *hit, vec3 out)
{
    const material *m = &s->materials[s->shapes[hit->shape_index].material_index];
    if (m->kind == MATERIAL_MIX)
        m = resolve_mix(s, m, hit);
    if (!m->is_textured)
        return bsdf_create_of(m, hit, out);
    material here = *m;
    look_up_textures(s, hit, &here);
    return bsdf_create_of(&here, hit, out);
}

bool bsdf_has(const bsdf *b, bsdf_lobes lobes)
{
    for (int i = 0; i < b->lobe_count; i++)
        if (b->lobes[i].group & lobes)
            return true;
    return false;
}

bool bsdf_is_sampled_from_light(const bsdf *b, bsdf_lobes lobes)
{
    for (int i = 0; i < b->lobe_count; i++)
        if ((b->lobes[i].group & lobes) && !b->lobes[i].is_delta)
            return true;
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

/* --- diffuse light and its shading normals --- */

/* Judged by the geometry, which alone cannot leak. */
static bool is_same_side(const bsdf *b, vec3 direction)
{
    return vec3_dot(b->out, b->geometric_normal) * vec3_dot(direction, b->geometric_normal) > 0.0f;
}

/* The cosine of a direction to the shading normal on the side of the surface that its lobe is on, 0 beyond the horizon of
 * either normal. i: the direction in the shading frame. */
static float diffuse_cosine(const bsdf *b, bsdf_lobe_kind kind, vec3 direction, vec3 i)
{
    bool is_through = kind == LOBE_DIFFUSE_THROUGH;
    if (is_same_side(b, direction) == is_through)
        return 0.0f;
    float side = (vec3_dot(b->out, b->geometric_normal) < 0.0f) != is_through ? -1.0f : 1.0f;
    return fmaxf(0.0f, side * i.z);
}

rgb bsdf_gathered_reflection(const bsdf *b)
{
    const material *m = &b->matter;
    switch (m->kind) {
    case MATERIAL_DIFFUSE:
    case MATERIAL_DIFFUSE_TRANSMISSION: return m->reflectance;
    case MATERIAL_COATED_DIFFUSE:
        return rgb_scale(diffuse_albedo(m), coat_transmittance(m, vec3_dot(b->out, b->shading.z)));
    default: return rgb_gray(0.0f);
    }
}

rgb bsdf_gathered_transmission(const bsdf *b)
{
    return b->matter.kind == MATERIAL_DIFFUSE_TRANSMISSION ? b->matter.transmittance : rgb_gray(0.0f);
}

/* Shading normals bend the cosine of flux (Veach 1997, 5.3.2): the factor for flux that came from `out` and goes on to
 * `direction`. */
static float flux_correction(const bsdf *b, vec3 direction)
{
    float numerator = fabsf(vec3_dot(b->out, b->shading.z) * vec3_dot(direction, b->geometric_normal));
    float denominator = fabsf(vec3_dot(b->out, b->geometric_normal) * vec3_dot(direction, b->shading.z));
    return denominator > 0.0f ? fminf(numerator / denominator, CORRECTION_MAX) : 0.0f;
}

float bsdf_arrival_factor(const bsdf *b)
{
    float shading = vec3_dot(b->out, b->shading.z), geometric = vec3_dot(b->out, b->geometric_normal);
    if (shading * geometric <= 0.0f)
        return 0.0f; /* behind the horizon of one of the normals: no light by either reckoning */
    return fminf(shading / geometric, CORRECTION_MAX) * coat_transmittance(&b->matter, shading);
}

/* --- microfacet lobes --- */

/* Rough dielectric, one way: value (f |cos|) and density of scattering from o to i. Walter 2007, eq. 20, 21; the
 * density's factors follow Pharr et al., 9.7. */
static void rough_dielectric(const material *m, bsdf_transport transport, vec3 o, vec3 i, float *out_value,
                             float *out_pdf)
{
    bool is_reflection = o.z * i.z > 0.0f;
    float relative = o.z > 0.0f ? m->ior : 1.0f / m->ior, eta = is_reflection ? 1.0f : relative;
    vec3 h = vec3_add(vec3_scale(i, eta), o);
    *out_value = *out_pdf = 0.0f;
    float square = vec3_length_squared(h);
    if (o.z == 0.0f || i.z == 0.0f || square == 0.0f)
        return;
    h = vec3_scale(h, 1.0f / sqrtf(square));
    if (h.z < 0.0f)
        h = vec3_negate(h);
    float oh = vec3_dot(o, h), ih = vec3_dot(i, h);
    if (ih * i.z < 0.0f || oh * o.z < 0.0f)
        return; /* a back-facing microfacet */
    float reflectance = fresnel_dielectric(fabsf(oh), relative);
    ggx facets = interface_of(m);
    if (is_reflection) {
        *out_value = ggx_reflection(facets, o, i, h) * reflectance;
        *out_pdf = ggx_reflection_pdf(facets, o, h) * reflectance;
        return;
    }
    vec3 upper = o.z > 0.0f ? o : vec3_negate(o);
    float sum = ih + oh / eta, jacobian = fabsf(ih) / (sum * sum);
    *out_value = ggx_density(facets, h) * (1.0f - reflectance) * ggx_masking_shadowing(facets, o, i) *
                 fabsf(ih * oh / (o.z * sum * sum));
    if (transport == BSDF_RADIANCE)
        *out_value /= eta * eta;
    *out_pdf = ggx_visible_density(facets, upper, h) * jacobian * (1.0f - reflectance);
}

/* In through the coat, to and fro between conductor and coat, and out again: a geometric series. Of the coat's two
 * reflectances the lesser keeps light in, so that both ways are the same and no more leaves than got in. */
static rgb coat_series(const material *m, rgb metal, float cos_o, float cos_i)
{
    float through = coat_transmittance(m, cos_o) * coat_transmittance(m, cos_i);
    if (!(through > 0.0f))
        return rgb_gray(0.0f); /* total reflection, by a coat of a lesser index than what is around */
    float back = fminf(fresnel_dielectric(fabsf(cos_o), m->ior), fresnel_dielectric(fabsf(cos_i), m->ior));
    return (rgb){through * metal.r / (1.0f - metal.r * back), through * metal.g / (1.0f - metal.g * back),
                 through * metal.b / (1.0f - metal.b * back)};
}

/* Under a smooth coat: the conductor's value between the refracted directions; the squared index is the change of solid
 * angles. */
static void conductor_under_coat(const material *m, vec3 o, vec3 i, rgb *out_value, float *out_pdf)
{
    vec3 oc = into_coat(m, o), ic = into_coat(m, i);
    if (oc.z == 0.0f || ic.z == 0.0f)
        return; /* beyond total reflection, as above */
    vec3 h = ggx_half_vector(oc, ic);
    ggx facets = {m->base_alpha_u, m->base_alpha_v};
    rgb metal = fresnel_conductor(fabsf(vec3_dot(oc, h)), m->eta, m->k);
    rgb series = coat_series(m, metal, o.z, i.z);
    /* f |cos i|: reflection's value has |cos ic| in it */
    float cosines = fabsf(i.z / ic.z) / (m->ior * m->ior);
    *out_value = rgb_scale(series, ggx_reflection(facets, oc, ic, h) * cosines);
    *out_pdf = ggx_reflection_pdf(facets, oc, h) * cosines;
}

/* Value (f |cos|) and density of one lobe that is not smooth. */
static void evaluate_lobe(const bsdf *b, const bsdf_lobe *lobe, bsdf_transport transport, vec3 direction, vec3 o, vec3 i,
                          rgb *out_value, float *out_pdf)
{
    const material *m = &b->matter;
    *out_value = rgb_gray(0.0f);
    *out_pdf = 0.0f;
    switch (lobe->kind) {
    case LOBE_DIFFUSE:
    case LOBE_DIFFUSE_THROUGH: {
        float cosine = diffuse_cosine(b, lobe->kind, direction, i) * AG_INV_PI;
        rgb albedo = lobe->kind == LOBE_DIFFUSE ? diffuse_albedo(m) : m->transmittance;
        *out_pdf = cosine;
        *out_value = rgb_scale(albedo, cosine * coat_transmittance(m, o.z) * coat_transmittance(m, i.z));
        return;
    }
    case LOBE_DIELECTRIC: {
        float value;
        rough_dielectric(m, transport, o, i, &value, out_pdf);
        *out_value = rgb_gray(value);
        return;
    }
    case LOBE_CONDUCTOR:
    case LOBE_COAT: {
        if (!is_same_side(b, direction) || o.z * i.z <= 0.0f)
            return;
        ggx facets = interface_of(m);
        vec3 h = ggx_half_vector(o, i);
        float cosine = fabsf(vec3_dot(o, h));
        rgb reflected = lobe->kind == LOBE_CONDUCTOR ? fresnel_conductor(cosine, m->eta, m->k)
                                                     : rgb_gray(fresnel_dielectric(cosine, m->ior));
        *out_value = rgb_scale(reflected, ggx_reflection(facets, o, i, h));
        *out_pdf = ggx_reflection_pdf(facets, o, h);
        return;
    }
    case LOBE_CONDUCTOR_UNDER_COAT:
        if (is_same_side(b, direction) && o.z * i.z > 0.0f)
            conductor_under_coat(m, o, i, out_value, out_pdf);
        return;
    case LOBE_THIN_DIELECTRIC: return; /* always smooth */
    }
}

rgb bsdf_evaluate(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, vec3 direction)
{
    vec3 o = frame_to_local(&b->shading, b->out), i = frame_to_local(&b->shading, direction);
    rgb sum = rgb_gray(0.0f);
    for (int k = 0; k < b->lobe_count; k++) {
        rgb value;
        float pdf;
        if (!(b->lobes[k].group & lobes) || b->lobes[k].is_delta)
            continue;
        evaluate_lobe(b, &b->lobes[k], transport, direction, o, i, &value, &pdf);
        sum = rgb_add(sum, value);
    }
    return transport == BSDF_FLUX ? rgb_scale(sum, flux_correction(b, direction)) : sum;
}

float bsdf_pdf(const bsdf *b, bsdf_lobes lobes, vec3 direction)
{
    vec3 o = frame_to_local(&b->shading, b->out), i = frame_to_local(&b->shading, direction);
    float sum = 0.0f;
    for (int k = 0; k < b->lobe_count; k++) {
        rgb value;
        float pdf;
        if (!(b->lobes[k].group & lobes) || b->lobes[k].is_delta)
            continue;
        evaluate_lobe(b, &b->lobes[k], BSDF_FLUX, direction, o, i, &value, &pdf);
        sum += pdf * b->lobes[k].probability;
    }
    return sum > 0.0f ? sum / bsdf_probability(b, lobes) : 0.0f;
}

/* --- sampling --- */

/* A smooth lobe's one direction, and its weight once it has been picked. */
static bool sample_smooth(const bsdf *b, bsdf_lobe_kind kind, bsdf_transport transport, vec3 o, float u_lobe,
                          vec3 *out_local, rgb *out_weight)
{
    const material *m = &b->matter;
    vec3 n = {0.0f, 0.0f, o.z >= 0.0f ? 1.0f : -1.0f};
    float cosine = fabsf(o.z), eta = o.z >= 0.0f ? m->ior : 1.0f / m->ior;
    *out_local = reflect_about(o, n);
    *out_weight = rgb_gray(1.0f); /* reflection and refraction are picked by their own shares */
    switch (kind) {
    case LOBE_CONDUCTOR: *out_weight = fresnel_conductor(cosine, m->eta, m->k); return true;
    case LOBE_COAT: *out_weight = rgb_gray(fresnel_dielectric(cosine, m->ior)); return true;
    case LOBE_CONDUCTOR_UNDER_COAT: {
        rgb metal = fresnel_conductor(fabsf(into_coat(m, o).z), m->eta, m->k);
        *out_weight = coat_series(m, metal, o.z, o.z);
        return true;
    }
    case LOBE_THIN_DIELECTRIC: {
        /* to and fro between the two faces: a geometric series */
        float r = fresnel_dielectric(cosine, m->ior);
        if (r < 1.0f)
            r += (1.0f - r) * (1.0f - r) * r / (1.0f - r * r);
        if (u_lobe >= r)
            *out_local = vec3_negate(o);
        return true;
    }
    default: break;
    }
    if (u_lobe < fresnel_dielectric(cosine, eta))
        return true;
    if (!refract_through(o, n, eta, out_local))
        return false;
    if (transport == BSDF_RADIANCE)
        *out_weight = rgb_gray(1.0f / (eta * eta));
    return true;
}

/* A direction of a lobe that is not smooth, in the shading frame. */
static bool sample_rough(const bsdf *b, bsdf_lobe_kind kind, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    const material *m = &b->matter;
    if (kind == LOBE_DIFFUSE || kind == LOBE_DIFFUSE_THROUGH) {
        *out_local = sample_cosine_hemisphere(u);
        if ((vec3_dot(b->out, b->geometric_normal) < 0.0f) != (kind == LOBE_DIFFUSE_THROUGH))
            out_local->z = -out_local->z;
        return true;
    }
    float side = o.z >= 0.0f ? 1.0f : -1.0f;
    vec3 upper = vec3_scale(o, side), i;
    if (kind == LOBE_CONDUCTOR_UNDER_COAT) {
        vec3 oc = into_coat(m, upper);
        vec3 ic = reflect_about(oc, ggx_sample_visible((ggx){m->base_alpha_u, m->base_alpha_v}, oc, u));
        float sin2 = (1.0f - ic.z * ic.z) * m->ior * m->ior;
        if (ic.z <= 0.0f || sin2 >= 1.0f)
            return false; /* kept in by the coat */
        i = (vec3){ic.x * m->ior, ic.y * m->ior, sqrtf(1.0f - sin2)};
        *out_local = vec3_scale(i, side);
        return true;
    }
    vec3 h = ggx_sample_visible(interface_of(m), upper, u);
    float eta = side > 0.0f ? m->ior : 1.0f / m->ior;
    bool is_reflection = kind != LOBE_DIELECTRIC || u_lobe < fresnel_dielectric(fabsf(vec3_dot(upper, h)), eta);
    if (is_reflection)
        i = reflect_about(upper, h);
    else if (!refract_through(upper, h, eta, &i))
        return false;
    if (is_reflection != (i.z > 0.0f))
        return false; /* the facet sends it to the wrong side of the surface, where another facet would meet it */
    *out_local = vec3_scale(i, side);
    return true;
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

bool bsdf_sample_direction(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, float u_lobe, vec2 u,
                           bsdf_sample *out_sample)
{
    float probability;
    if (!(bsdf_probability(b, lobes) > 0.0f))
        return false;
    const bsdf_lobe *lobe = pick_lobe(b, lobes, &u_lobe, &probability);
    if (!lobe)
        return false;
    vec3 o = frame_to_local(&b->shading, b->out), i;
    bsdf_sample *out = out_sample;
    out->group = lobe->group;
    out->is_delta = lobe->is_delta;
    if (lobe->is_delta) {
        if (!sample_smooth(b, lobe->kind, transport, o, u_lobe, &i, &out->weight))
            return false;
        out->direction = vec3_normalize(frame_to_world(&b->shading, i));
        out->pdf_solid_angle = 0.0f;
        /* a shading normal may send it through the surface, or not: the geometry decides */
        if (is_same_side(b, out->direction) != (i.z * o.z > 0.0f))
            return false;
        out->weight = rgb_scale(out->weight, 1.0f / probability);
        if (transport == BSDF_FLUX)
            out->weight = rgb_scale(out->weight, flux_correction(b, out->direction));
        return true;
    }
    if (!sample_rough(b, lobe->kind, o, u_lobe, u, &i))
        return false;
    out->direction = vec3_normalize(frame_to_world(&b->shading, i));
    out->pdf_solid_angle = bsdf_pdf(b, lobes, out->direction);
    if (!(out->pdf_solid_angle > 0.0f))
        return false;
    out->weight = rgb_scale(bsdf_evaluate(b, lobes, transport, out->direction), 1.0f / out->pdf_solid_angle);
    return rgb_is_finite(out->weight);
}
