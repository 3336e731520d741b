/* bsdf_lobe.c: see bsdf_lobe.h. Directions o (out) and i are in the shading frame, z up to the outside.
 * Threads: pure functions. */
#include "material/bsdf_lobe.h"

#include "material/bsdf_principled.h"
#include "material/coat.h"
#include "material/fresnel.h"
#include "material/principled.h"

static ggx interface_of(const material *m) { return (ggx){m->alpha_u, m->alpha_v}; }

float bsdf_lobe_transmittance(const material *m, float cos_theta)
{
    if (m->kind == MATERIAL_PRINCIPLED)
        return principled_base_transmittance(m, cos_theta);
    return m->kind == MATERIAL_COATED_DIFFUSE ? coat_entry(m, cos_theta) : 1.0f;
}

rgb bsdf_lobe_diffuse_albedo(const material *m)
{
    if (m->kind == MATERIAL_PRINCIPLED)
        return principled_base_albedo(m);
    return m->kind == MATERIAL_COATED_DIFFUSE ? coat_diffuse_albedo(m) : m->reflectance;
}

/* Judged by the geometry, which alone cannot leak. */
bool bsdf_is_same_side(const bsdf *b, vec3 direction)
{
    return vec3_dot(b->out, b->geometric_normal) * vec3_dot(direction, b->geometric_normal) > 0.0f;
}

/* The cosine of a direction to the shading normal on the side of the surface that its lobe is on, 0 beyond the horizon
 * of either normal. i: the direction in the shading frame. */
static float diffuse_cosine(const bsdf *b, bsdf_lobe_kind kind, vec3 direction, vec3 i)
{
    bool is_through = kind == LOBE_DIFFUSE_THROUGH;
    if (bsdf_is_same_side(b, direction) == is_through)
        return 0.0f;
    float side = (vec3_dot(b->out, b->geometric_normal) < 0.0f) != is_through ? -1.0f : 1.0f;
    return fmaxf(0.0f, side * i.z);
}

/* diffuse_cosine to the geometric normal: by it flux leaves a diffuse lobe, whose radiance is the same all around. */
static float geometric_cosine(const bsdf *b, bsdf_lobe_kind kind, vec3 direction)
{
    bool is_there = bsdf_is_same_side(b, direction) != (kind == LOBE_DIFFUSE_THROUGH);
    return is_there ? fabsf(vec3_dot(direction, b->geometric_normal)) : 0.0f;
}

/* Walter 2007, eq. 20, 21; the density's factors follow Pharr et al., 9.7. */
bool bsdf_lobe_refraction(ggx facets, float ior, bsdf_transport transport, vec3 o, vec3 i, float *out_cosine,
                          float *out_value, float *out_pdf)
{
    float eta = o.z > 0.0f ? ior : 1.0f / ior;
    vec3 h = vec3_add(vec3_scale(i, eta), o);
    float square = vec3_length_squared(h);
    if (o.z == 0.0f || i.z == 0.0f || square == 0.0f)
        return false;
    h = vec3_scale(h, 1.0f / sqrtf(square));
    if (h.z < 0.0f)
        h = vec3_negate(h);
    float oh = vec3_dot(o, h), ih = vec3_dot(i, h);
    if (ih * i.z < 0.0f || oh * o.z < 0.0f)
        return false; /* a back-facing microfacet */
    vec3 upper = o.z > 0.0f ? o : vec3_negate(o);
    float sum = ih + oh / eta, jacobian = fabsf(ih) / (sum * sum);
    *out_cosine = fabsf(oh);
    *out_value = ggx_density(facets, h) * ggx_masking_shadowing(facets, o, i) * fabsf(ih * oh / (o.z * sum * sum));
    if (transport == BSDF_RADIANCE)
        *out_value /= eta * eta;
    *out_pdf = ggx_visible_density(facets, upper, h) * jacobian;
    return true;
}

/* Rough dielectric, one way: value (f |cos|) and density of scattering from o to i. */
static void rough_dielectric(const material *m, bsdf_transport transport, vec3 o, vec3 i, float *out_value,
                             float *out_pdf)
{
    ggx facets = interface_of(m);
    float relative = o.z > 0.0f ? m->ior : 1.0f / m->ior, share, cosine;
    *out_value = *out_pdf = 0.0f;
    if (o.z * i.z > 0.0f) {
        vec3 h = ggx_half_vector(o, i);
        share = fresnel_dielectric(fabsf(vec3_dot(o, h)), relative);
        *out_value = ggx_reflection(facets, o, i, h);
        *out_pdf = ggx_reflection_pdf(facets, o, h);
    } else {
        if (!bsdf_lobe_refraction(facets, m->ior, transport, o, i, &cosine, out_value, out_pdf))
            return;
        share = 1.0f - fresnel_dielectric(cosine, relative);
    }
    *out_value *= share;
    *out_pdf *= share;
}

/* --- the lobes, one row each --- */

/* Values (f |cos|) and densities come in as 0. Smooth lobes reflect and refract by shares of their own, so that their
 * weights are 1 but for what is absorbed. */

static void evaluate_diffuse_kind(const bsdf *b, bsdf_lobe_kind kind, rgb albedo, bsdf_transport transport,
                                  vec3 direction, vec3 o, vec3 i, rgb *out_value, float *out_pdf)
{
    const material *m = &b->parameters;
    bool is_flux = transport == BSDF_FLUX;
    float arrived = is_flux ? bsdf_arrival_factor(b) : bsdf_lobe_transmittance(m, o.z);
    float cosine = is_flux ? geometric_cosine(b, kind, direction) : diffuse_cosine(b, kind, direction, i);
    if (is_flux && !(arrived > 0.0f))
        return;
    *out_pdf = cosine * AG_INV_PI;
    *out_value = rgb_scale(albedo, *out_pdf * arrived * bsdf_lobe_transmittance(m, i.z));
}

static void evaluate_diffuse(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                             float *out_pdf)
{
    evaluate_diffuse_kind(b, LOBE_DIFFUSE, bsdf_lobe_diffuse_albedo(&b->parameters), transport, direction, o, i,
                          out_value, out_pdf);
}

static void evaluate_diffuse_through(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i,
                                     rgb *out_value, float *out_pdf)
{
    evaluate_diffuse_kind(b, LOBE_DIFFUSE_THROUGH, b->parameters.transmittance, transport, direction, o, i, out_value,
                          out_pdf);
}

/* Samples the cosine lobe on the side of the surface that the lobe is on. */
static bool sample_cosine(const bsdf *b, bool is_through, vec2 u, vec3 *out_local)
{
    *out_local = sample_cosine_hemisphere(u);
    if ((vec3_dot(b->out, b->geometric_normal) < 0.0f) != is_through)
        out_local->z = -out_local->z;
    return true;
}

static bool sample_diffuse(const bsdf *b, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    (void)o, (void)u_lobe;
    return sample_cosine(b, false, u, out_local);
}

static bool sample_diffuse_through(const bsdf *b, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    (void)o, (void)u_lobe;
    return sample_cosine(b, true, u, out_local);
}

static void evaluate_coat_scattered(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i,
                                    rgb *out_value, float *out_pdf)
{
    (void)transport;
    *out_pdf = diffuse_cosine(b, LOBE_COAT_SCATTERED, direction, i) * AG_INV_PI;
    if (*out_pdf > 0.0f)
        *out_value = rgb_scale(coat_scattered(&b->parameters, o, i), *out_pdf);
}

/* The normal on o's side, and the mirror's direction about it. */
static vec3 mirror(vec3 o, vec3 *out_normal)
{
    *out_normal = (vec3){0.0f, 0.0f, o.z >= 0.0f ? 1.0f : -1.0f};
    return reflect_about(o, *out_normal);
}

/* The share of light that facets reflect at that cosine. */
typedef rgb facet_reflectance(const material *m, float cosine);

static rgb metal_reflectance(const material *m, float cosine) { return fresnel_conductor(cosine, m->eta, m->k); }

static rgb coat_reflectance(const material *m, float cosine) { return rgb_gray(fresnel_dielectric(cosine, m->ior)); }

static void evaluate_facets(const bsdf *b, facet_reflectance *reflectance, vec3 o, vec3 i, rgb *out_value,
                            float *out_pdf)
{
    if (o.z * i.z <= 0.0f)
        return;
    ggx facets = interface_of(&b->parameters);
    vec3 h = ggx_half_vector(o, i);
    *out_value = rgb_scale(reflectance(&b->parameters, fabsf(vec3_dot(o, h))), ggx_reflection(facets, o, i, h));
    *out_pdf = ggx_reflection_pdf(facets, o, h);
}

static void evaluate_conductor(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                               float *out_pdf)
{
    (void)transport, (void)direction;
    evaluate_facets(b, metal_reflectance, o, i, out_value, out_pdf);
}

static void evaluate_coat(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                          float *out_pdf)
{
    (void)transport, (void)direction;
    evaluate_facets(b, coat_reflectance, o, i, out_value, out_pdf);
}

static bool mirror_conductor(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                             rgb *out_weight)
{
    vec3 n;
    (void)transport, (void)u_lobe;
    *out_local = mirror(o, &n);
    *out_weight = metal_reflectance(&b->parameters, fabsf(o.z));
    return true;
}

static bool mirror_coat(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local, rgb *out_weight)
{
    vec3 n;
    (void)transport, (void)u_lobe;
    *out_local = mirror(o, &n);
    *out_weight = coat_reflectance(&b->parameters, fabsf(o.z));
    return true;
}

/* A facet that o sees; its side, +1 or -1, and o on the upper side. false: facets have no density there. */
static bool sample_facet(const material *m, vec3 o, vec2 u, vec3 *out_upper, vec3 *out_facet, float *out_side)
{
    if (o.z == 0.0f)
        return false;
    *out_side = o.z >= 0.0f ? 1.0f : -1.0f;
    *out_upper = vec3_scale(o, *out_side);
    *out_facet = ggx_sample_visible(interface_of(m), *out_upper, u);
    return true;
}

static bool sample_facets(const bsdf *b, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    vec3 upper, h;
    float side;
    (void)u_lobe;
    if (!sample_facet(&b->parameters, o, u, &upper, &h, &side))
        return false;
    vec3 i = reflect_about(upper, h);
    *out_local = vec3_scale(i, side);
    return i.z > 0.0f; /* else the facet sends it below the surface, where another facet would meet it */
}

static void evaluate_dielectric(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                                float *out_pdf)
{
    float value;
    (void)direction;
    rough_dielectric(&b->parameters, transport, o, i, &value, out_pdf);
    *out_value = rgb_gray(value);
}

static bool mirror_dielectric(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                              rgb *out_weight)
{
    vec3 n;
    float ior = b->parameters.ior, eta = o.z >= 0.0f ? ior : 1.0f / ior;
    *out_local = mirror(o, &n);
    *out_weight = rgb_gray(1.0f);
    if (u_lobe < fresnel_dielectric(fabsf(o.z), eta))
        return true;
    if (!refract_through(o, n, eta, out_local))
        return false;
    if (transport == BSDF_RADIANCE)
        *out_weight = rgb_gray(1.0f / (eta * eta));
    return true;
}

static bool sample_dielectric(const bsdf *b, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    const material *m = &b->parameters;
    vec3 upper, h, i;
    float side;
    if (!sample_facet(m, o, u, &upper, &h, &side))
        return false;
    float eta = side > 0.0f ? m->ior : 1.0f / m->ior;
    bool is_reflection = u_lobe < fresnel_dielectric(fabsf(vec3_dot(upper, h)), eta);
    if (is_reflection)
        i = reflect_about(upper, h);
    else if (!refract_through(upper, h, eta, &i))
        return false;
    *out_local = vec3_scale(i, side);
    return is_reflection == (i.z > 0.0f); /* else another facet would meet it */
}

static bool mirror_thin_dielectric(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                                   rgb *out_weight)
{
    vec3 n;
    (void)transport;
    *out_local = u_lobe >= fresnel_thin_dielectric(fabsf(o.z), b->parameters.ior) ? vec3_negate(o) : mirror(o, &n);
    *out_weight = rgb_gray(1.0f);
    return true;
}

/* false: all is absorbed. */
static bool mirror_slab(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local, rgb *out_weight)
{
    vec3 n;
    float reflected = rgb_max(b->slab_reflected), all = reflected + rgb_max(b->slab_through);
    (void)transport;
    if (!(all > 0.0f))
        return false;
    float share = reflected / all;
    bool goes_through = u_lobe >= share;
    *out_local = goes_through ? vec3_negate(o) : mirror(o, &n);
    *out_weight =
        goes_through ? rgb_scale(b->slab_through, 1.0f / (1.0f - share)) : rgb_scale(b->slab_reflected, 1.0f / share);
    return true;
}

static void evaluate_coated_conductor(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i,
                                      rgb *out_value, float *out_pdf)
{
    (void)transport, (void)direction;
    coat_metal_lobe(&b->parameters, o, i, out_value, out_pdf);
}

static bool mirror_coated_conductor(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                                    rgb *out_weight)
{
    const material *m = &b->parameters;
    vec3 n;
    (void)transport, (void)u_lobe;
    *out_local = mirror(o, &n);
    *out_weight = coat_series(m, metal_reflectance(m, fabsf(coat_refract(m, o).z)), o.z);
    return true;
}

static bool sample_coated_conductor(const bsdf *b, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    float side = o.z >= 0.0f ? 1.0f : -1.0f;
    vec3 i;
    (void)u_lobe;
    if (o.z == 0.0f || !coat_sample_metal_lobe(&b->parameters, vec3_scale(o, side), u, &i))
        return false;
    *out_local = vec3_scale(i, side);
    return true;
}

static void evaluate_hair(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                          float *out_pdf)
{
    (void)direction, (void)o;
    hair_evaluate(&b->fibre, transport == BSDF_FLUX, i, out_value, out_pdf);
}

static bool sample_hair(const bsdf *b, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    (void)o;
    *out_local = hair_sample(&b->fibre, u_lobe, u);
    return true;
}

static void evaluate_principled(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                                float *out_pdf)
{
    (void)direction;
    bsdf_principled_evaluate(&b->parameters, LOBE_PRINCIPLED, transport, o, i, out_value, out_pdf);
}

static bool mirror_principled(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                              rgb *out_weight)
{
    return bsdf_principled_sample_smooth(&b->parameters, LOBE_PRINCIPLED, transport, o, u_lobe, out_local, out_weight);
}

static bool sample_principled(const bsdf *b, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    return bsdf_principled_sample_rough(&b->parameters, LOBE_PRINCIPLED, o, u_lobe, u, out_local);
}

static void evaluate_clearcoat(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                               float *out_pdf)
{
    (void)direction;
    bsdf_principled_evaluate(&b->parameters, LOBE_CLEARCOAT, transport, o, i, out_value, out_pdf);
}

static bool mirror_clearcoat(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                             rgb *out_weight)
{
    return bsdf_principled_sample_smooth(&b->parameters, LOBE_CLEARCOAT, transport, o, u_lobe, out_local, out_weight);
}

static bool sample_clearcoat(const bsdf *b, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    return bsdf_principled_sample_rough(&b->parameters, LOBE_CLEARCOAT, o, u_lobe, u, out_local);
}

static bool always(const material *m)
{
    (void)m;
    return true;
}

const bsdf_lobe_type *bsdf_lobe_type_of(bsdf_lobe_kind kind)
{
    static const bsdf_lobe_type TYPES[] = {
        [LOBE_DIFFUSE] = {.evaluate = evaluate_diffuse, .sample_rough = sample_diffuse},
        [LOBE_DIFFUSE_THROUGH] = {.evaluate = evaluate_diffuse_through,
                                  .sample_rough = sample_diffuse_through,
                                  .passes = always},
        [LOBE_CONDUCTOR] = {evaluate_conductor, mirror_conductor, sample_facets, NULL},
        [LOBE_DIELECTRIC] = {evaluate_dielectric, mirror_dielectric, sample_dielectric, always},
        [LOBE_THIN_DIELECTRIC] = {.sample_smooth = mirror_thin_dielectric, .passes = always},
        [LOBE_SLAB] = {.sample_smooth = mirror_slab, .passes = always},
        [LOBE_COAT] = {evaluate_coat, mirror_coat, sample_facets, NULL},
        [LOBE_CONDUCTOR_UNDER_COAT] = {evaluate_coated_conductor, mirror_coated_conductor, sample_coated_conductor,
                                       NULL},
        [LOBE_COAT_SCATTERED] = {.evaluate = evaluate_coat_scattered, .sample_rough = sample_diffuse},
        [LOBE_HAIR] = {.evaluate = evaluate_hair, .sample_rough = sample_hair, .passes = always},
        [LOBE_PRINCIPLED] = {evaluate_principled, mirror_principled, sample_principled, principled_transmits},
        [LOBE_CLEARCOAT] = {evaluate_clearcoat, mirror_clearcoat, sample_clearcoat, NULL},
    };
    _Static_assert(sizeof TYPES / sizeof *TYPES == LOBE_KIND_COUNT, "a row for each lobe");
    return &TYPES[kind];
}
