/* bsdf.c: see bsdf.h. Directions are in the shading frame, z up to the outside.
 * Rests on: Walter et al. 2007; Heitz 2018; Pharr, Jakob, Humphreys, 4th ed., 2023, ch. 9 (Fresnel terms, refraction).
 * Threads: pure functions. */
#include "bsdf.h"

#include "math/sampling.h"

/* The largest factor that shading normals may add to a photon: beyond it lie grazing silhouettes only. */
static const float CORRECTION_MAX = 8.0f;

/* --- Fresnel --- */

/* Unpolarised reflectance of a dielectric; eta: index on the far side over the near one. */
static float fresnel_dielectric(float cos_in, float eta)
{
    float sin2_through = (1.0f - cos_in * cos_in) / (eta * eta);
    if (sin2_through >= 1.0f)
        return 1.0f;
    float cos_through = sqrtf(1.0f - sin2_through);
    float parallel = (eta * cos_in - cos_through) / (eta * cos_in + cos_through);
    float perpendicular = (cos_in - eta * cos_through) / (cos_in + eta * cos_through);
    return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

/* Unpolarised reflectance of a conductor from air (Born, Wolf, "Principles of Optics", 14.2), written without complex
 * numbers. */
static float fresnel_conductor_channel(float cos_in, float eta, float k)
{
    float c2 = cos_in * cos_in, s2 = 1.0f - c2;
    float t0 = eta * eta - k * k - s2;
    float a2b2 = sqrtf(t0 * t0 + 4.0f * eta * eta * k * k);
    float a = sqrtf(fmaxf(0.0f, 0.5f * (a2b2 + t0)));
    float t1 = a2b2 + c2, t2 = 2.0f * a * cos_in;
    float perpendicular = (t1 - t2) / (t1 + t2);
    float t3 = c2 * a2b2 + s2 * s2, t4 = t2 * s2;
    float parallel = perpendicular * (t3 - t4) / (t3 + t4);
    return 0.5f * (parallel + perpendicular);
}

static rgb fresnel_conductor(float cos_in, const material *m)
{
    return (rgb){fresnel_conductor_channel(cos_in, m->eta.r, m->k.r), fresnel_conductor_channel(cos_in, m->eta.g, m->k.g),
                 fresnel_conductor_channel(cos_in, m->eta.b, m->k.b)};
}

/* --- GGX --- */

static float ggx_density(const material *m, vec3 n)
{
    float x = n.x / m->alpha_u, y = n.y / m->alpha_v, t = x * x + y * y + n.z * n.z;
    return 1.0f / (AG_PI * m->alpha_u * m->alpha_v * t * t);
}

/* Smith's Lambda: masked over visible microsurface. */
static float ggx_lambda(const material *m, vec3 v)
{
    if (v.z == 0.0f)
        return INFINITY;
    float x = m->alpha_u * v.x, y = m->alpha_v * v.y;
    return 0.5f * (sqrtf(1.0f + (x * x + y * y) / (v.z * v.z)) - 1.0f);
}

static float ggx_masking(const material *m, vec3 v) { return 1.0f / (1.0f + ggx_lambda(m, v)); }
static float ggx_masking_shadowing(const material *m, vec3 a, vec3 b)
{
    return 1.0f / (1.0f + ggx_lambda(m, a) + ggx_lambda(m, b));
}

/* Density of the normals that are visible from v. */
static float ggx_visible_density(const material *m, vec3 v, vec3 n)
{
    return ggx_masking(m, v) / fabsf(v.z) * ggx_density(m, n) * fabsf(vec3_dot(v, n));
}

/* A visible normal, in the upper half; Heitz 2018. */
static vec3 ggx_sample_visible(const material *m, vec3 v, vec2 u)
{
    vec3 vh = vec3_normalize((vec3){m->alpha_u * v.x, m->alpha_v * v.y, v.z});
    if (vh.z < 0.0f)
        vh = vec3_negate(vh);
    float square = vh.x * vh.x + vh.y * vh.y;
    vec3 t1 = square > 0.0f ? vec3_scale((vec3){-vh.y, vh.x, 0.0f}, 1.0f / sqrtf(square)) : (vec3){1.0f, 0.0f, 0.0f};
    vec3 t2 = vec3_cross(vh, t1);
    float r = sqrtf(u.x), sine, cosine;
    sincos_turns(u.y, &sine, &cosine);
    float p1 = r * cosine, p2 = r * sine, blend = 0.5f * (1.0f + vh.z);
    p2 = (1.0f - blend) * sqrtf(fmaxf(0.0f, 1.0f - p1 * p1)) + blend * p2;
    float p3 = sqrtf(fmaxf(0.0f, 1.0f - p1 * p1 - p2 * p2));
    vec3 nh = vec3_add(vec3_add(vec3_scale(t1, p1), vec3_scale(t2, p2)), vec3_scale(vh, p3));
    return vec3_normalize((vec3){m->alpha_u * nh.x, m->alpha_v * nh.y, fmaxf(1e-6f, nh.z)});
}

/* Through an interface with normal n on the side of v; eta: far over near index. false: total reflection. */
static bool refract(vec3 v, vec3 n, float eta, vec3 *out_through)
{
    float cos_in = vec3_dot(v, n);
    float sin2_through = fmaxf(0.0f, 1.0f - cos_in * cos_in) / (eta * eta);
    if (sin2_through >= 1.0f)
        return false;
    float cos_through = sqrtf(1.0f - sin2_through);
    *out_through = vec3_add(vec3_scale(v, -1.0f / eta), vec3_scale(n, cos_in / eta - cos_through));
    return true;
}

static vec3 reflect(vec3 v, vec3 n) { return vec3_sub(vec3_scale(n, 2.0f * vec3_dot(v, n)), v); }

/* --- the whole --- */

bsdf bsdf_create(const material *matter, const surface_hit *hit)
{
    bsdf b = {frame_from_z(hit->shading_normal), hit->geometric_normal, matter, false};
    /* where the index does not change nothing is bent, however rough: half vectors do not exist there */
    b.is_smooth = (matter->alpha_u < BSDF_SMOOTH_ALPHA && matter->alpha_v < BSDF_SMOOTH_ALPHA) ||
                  (matter->kind == MATERIAL_DIELECTRIC && matter->ior == 1.0f);
    return b;
}

bool bsdf_has(const bsdf *b, bsdf_lobes lobes)
{
    return (lobes & (b->matter->kind == MATERIAL_DIFFUSE ? BSDF_GATHERED : BSDF_TRACED)) != 0;
}

bool bsdf_is_sampled_from_light(const bsdf *b, bsdf_lobes lobes)
{
    return bsdf_has(b, lobes) && (b->matter->kind == MATERIAL_DIFFUSE || !b->is_smooth);
}

rgb bsdf_gathered_albedo(const bsdf *b)
{
    return b->matter->kind == MATERIAL_DIFFUSE ? b->matter->reflectance : rgb_gray(0.0f);
}

/* Shading normals bend the cosine of flux (Veach 1997, 5.3.2): the factor for flux that came from `out` and goes on to
 * `direction`. */
static float flux_correction(const bsdf *b, vec3 out, vec3 direction)
{
    float numerator = fabsf(vec3_dot(out, b->shading.z) * vec3_dot(direction, b->geometric_normal));
    float denominator = fabsf(vec3_dot(out, b->geometric_normal) * vec3_dot(direction, b->shading.z));
    return denominator > 0.0f ? fminf(numerator / denominator, CORRECTION_MAX) : 0.0f;
}

float bsdf_arrival_correction(const bsdf *b, vec3 direction)
{
    float geometric = fabsf(vec3_dot(direction, b->geometric_normal));
    return geometric > 0.0f ? fminf(fabsf(vec3_dot(direction, b->shading.z)) / geometric, CORRECTION_MAX) : 1.0f;
}

/* Diffuse: light stays on the side it came from, judged by the geometry, which alone cannot leak. */
static bool is_same_side(const bsdf *b, vec3 out, vec3 direction)
{
    return vec3_dot(out, b->geometric_normal) * vec3_dot(direction, b->geometric_normal) > 0.0f;
}

/* Rough dielectric, one way: value (f |cos|) and density of scattering from o to i. Walter 2007, eq. 20, 21; the
 * density's factors follow Pharr et al., 9.7. */
static void rough_dielectric(const material *m, bsdf_transport transport, vec3 o, vec3 i, float *out_value,
                             float *out_pdf)
{
    bool is_reflection = o.z * i.z > 0.0f;
    float eta = is_reflection ? 1.0f : (o.z > 0.0f ? m->ior : 1.0f / m->ior);
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
    float relative = o.z > 0.0f ? m->ior : 1.0f / m->ior;
    float reflectance = fresnel_dielectric(fabsf(oh), relative);
    float density = ggx_density(m, h), g = ggx_masking_shadowing(m, o, i);
    vec3 upper = o.z > 0.0f ? o : vec3_negate(o);
    float visible = ggx_visible_density(m, upper, h);
    if (is_reflection) {
        *out_value = density * g * reflectance / (4.0f * fabsf(o.z));
        *out_pdf = visible / (4.0f * fabsf(oh)) * reflectance;
        return;
    }
    float sum = ih + oh / eta, jacobian = fabsf(ih) / (sum * sum);
    *out_value = density * (1.0f - reflectance) * g * fabsf(ih * oh / (o.z * sum * sum));
    if (transport == BSDF_RADIANCE)
        *out_value /= eta * eta;
    *out_pdf = visible * jacobian * (1.0f - reflectance);
}

rgb bsdf_evaluate(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, vec3 out, vec3 direction)
{
    const material *m = b->matter;
    if (!bsdf_is_sampled_from_light(b, lobes))
        return rgb_gray(0.0f);
    vec3 o = frame_to_local(&b->shading, out), i = frame_to_local(&b->shading, direction);
    rgb value = rgb_gray(0.0f);
    switch (m->kind) {
    case MATERIAL_DIFFUSE:
        if (is_same_side(b, out, direction))
            value = rgb_scale(m->reflectance, AG_INV_PI * fabsf(i.z));
        break;
    case MATERIAL_CONDUCTOR:
        if (is_same_side(b, out, direction) && o.z * i.z > 0.0f) {
            vec3 h = vec3_normalize(vec3_add(o, i));
            float scale = ggx_density(m, h) * ggx_masking_shadowing(m, o, i) / (4.0f * fabsf(o.z));
            value = rgb_scale(fresnel_conductor(fabsf(vec3_dot(o, h)), m), scale);
        }
        break;
    case MATERIAL_DIELECTRIC: {
        float scale, pdf;
        rough_dielectric(m, transport, o, i, &scale, &pdf);
        value = rgb_gray(scale);
        break;
    }
    }
    return transport == BSDF_FLUX ? rgb_scale(value, flux_correction(b, out, direction)) : value;
}

float bsdf_pdf(const bsdf *b, bsdf_lobes lobes, vec3 out, vec3 direction)
{
    const material *m = b->matter;
    if (!bsdf_is_sampled_from_light(b, lobes))
        return 0.0f;
    vec3 o = frame_to_local(&b->shading, out), i = frame_to_local(&b->shading, direction);
    switch (m->kind) {
    case MATERIAL_DIFFUSE: return is_same_side(b, out, direction) ? AG_INV_PI * fabsf(i.z) : 0.0f;
    case MATERIAL_CONDUCTOR: {
        if (!is_same_side(b, out, direction) || o.z * i.z <= 0.0f)
            return 0.0f;
        vec3 h = vec3_normalize(vec3_add(o, i));
        if (h.z < 0.0f)
            h = vec3_negate(h), o = vec3_negate(o);
        return ggx_visible_density(m, o, h) / (4.0f * fabsf(vec3_dot(o, h)));
    }
    case MATERIAL_DIELECTRIC: {
        float value, pdf;
        rough_dielectric(m, BSDF_FLUX, o, i, &value, &pdf);
        return pdf;
    }
    }
    return 0.0f;
}

static bool sample_smooth(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                          rgb *out_weight)
{
    const material *m = b->matter;
    vec3 n = {0.0f, 0.0f, o.z >= 0.0f ? 1.0f : -1.0f};
    *out_local = reflect(o, n);
    if (m->kind == MATERIAL_CONDUCTOR) {
        *out_weight = fresnel_conductor(fabsf(o.z), m);
        return true;
    }
    float eta = o.z >= 0.0f ? m->ior : 1.0f / m->ior;
    *out_weight = rgb_gray(1.0f); /* reflection and refraction are picked by their own shares */
    if (u_lobe < fresnel_dielectric(fabsf(o.z), eta))
        return true;
    if (!refract(o, n, eta, out_local))
        return false;
    if (transport == BSDF_RADIANCE)
        *out_weight = rgb_gray(1.0f / (eta * eta));
    return true;
}

bool bsdf_sample_direction(const bsdf *b, bsdf_lobes lobes, bsdf_transport transport, vec3 out, float u_lobe, vec2 u,
                           bsdf_sample *out_sample)
{
    const material *m = b->matter;
    if (!bsdf_has(b, lobes))
        return false;
    vec3 o = frame_to_local(&b->shading, out), i;
    out_sample->is_delta = m->kind != MATERIAL_DIFFUSE && b->is_smooth;
    if (out_sample->is_delta) {
        if (!sample_smooth(b, transport, o, u_lobe, &i, &out_sample->weight))
            return false;
        out_sample->direction = vec3_normalize(frame_to_world(&b->shading, i));
        out_sample->pdf_solid_angle = 0.0f;
        /* a shading normal may send it through the surface, or not: the geometry decides */
        if (is_same_side(b, out, out_sample->direction) != (i.z * o.z > 0.0f))
            return false;
        if (transport == BSDF_FLUX)
            out_sample->weight = rgb_scale(out_sample->weight, flux_correction(b, out, out_sample->direction));
        return true;
    }
    if (m->kind == MATERIAL_DIFFUSE) {
        i = sample_cosine_hemisphere(u);
        if (vec3_dot(out, b->geometric_normal) < 0.0f)
            i.z = -i.z;
    } else {
        float side = o.z >= 0.0f ? 1.0f : -1.0f;
        vec3 upper = vec3_scale(o, side);
        vec3 h = ggx_sample_visible(m, upper, u);
        float eta = side > 0.0f ? m->ior : 1.0f / m->ior;
        bool is_reflection =
            m->kind == MATERIAL_CONDUCTOR || u_lobe < fresnel_dielectric(fabsf(vec3_dot(upper, h)), eta);
        if (is_reflection)
            i = reflect(upper, h);
        else if (!refract(upper, h, eta, &i))
            return false;
        if (is_reflection != (i.z > 0.0f))
            return false; /* the facet sends it to the wrong side of the surface, where another facet would meet it */
        i = vec3_scale(i, side);
    }
    out_sample->direction = vec3_normalize(frame_to_world(&b->shading, i));
    out_sample->pdf_solid_angle = bsdf_pdf(b, lobes, out, out_sample->direction);
    if (!(out_sample->pdf_solid_angle > 0.0f))
        return false;
    out_sample->weight = rgb_scale(bsdf_evaluate(b, lobes, transport, out, out_sample->direction),
                                   1.0f / out_sample->pdf_solid_angle);
    return rgb_is_finite(out_sample->weight);
}
