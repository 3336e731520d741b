/* lobes_diffuse.c: lobes that go by the cosine: diffuse ones, bare or under layers, and the light that a coat scatters.
 * Rests on: Lambert; Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, 5.3 (shading normals).
 * Threads: pure functions. */
#include "material/bsdf_lobe.h"

/* The cosine of a direction to the shading normal on the side of the surface that its lobe is on, 0 beyond the horizon
 * of either normal. i: the direction in the shading frame. */
static float diffuse_cosine(const bsdf *b, bool is_through, vec3 direction, vec3 i)
{
    if (bsdf_is_same_side(b, direction) == is_through)
        return 0.0f;
    float side = bsdf_is_below(b) != is_through ? -1.0f : 1.0f;
    return float_max(side * i.z, 0.0f);
}

/* diffuse_cosine to the geometric normal: by it flux leaves a diffuse lobe, whose radiance is the same all around. */
static float geometric_cosine(const bsdf *b, bool is_through, vec3 direction)
{
    bool is_there = bsdf_is_same_side(b, direction) != is_through;
    return is_there ? fabsf(vec3_dot(direction, b->geometric_normal)) : 0.0f;
}

static void evaluate_type(const bsdf *b, const bsdf_lobe_type *type, bsdf_transport transport, vec3 direction, vec3 o,
                          vec3 i, rgb *out_value, float *out_pdf)
{
    bool is_flux = transport == BSDF_FLUX, is_through = type->side == LOBE_TRANSMITS;
    float arrived = is_flux ? bsdf_arrival_factor(b) : bsdf_lobe_transmittance(type, &b->material, o.z);
    float cosine = is_flux ? geometric_cosine(b, is_through, direction) : diffuse_cosine(b, is_through, direction, i);
    if (is_flux && !(arrived > 0.0f))
        return;
    *out_pdf = cosine * AG_INV_PI;
    *out_value =
        rgb_scale(type->albedo(&b->material), *out_pdf * arrived * bsdf_lobe_transmittance(type, &b->material, i.z));
}

/* Samples the cosine lobe on the side of the surface that the lobe is on. */
static bool sample_cosine(const bsdf *b, bool is_through, vec2 u, vec3 *out_local)
{
    *out_local = sample_cosine_hemisphere(u);
    if (bsdf_is_below(b) != is_through)
        out_local->z = -out_local->z;
    return true;
}

static void evaluate_base(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                          float *out_pdf)
{
    evaluate_type(b, bsdf_base_of(b), transport, direction, o, i, out_value, out_pdf);
}

static bool sample_reflected(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    (void)transport, (void)o, (void)u_lobe;
    return sample_cosine(b, false, u, out_local);
}

static rgb bare_albedo(const material_point *m) { return m->diffuse.reflectance; }

const bsdf_lobe_type bsdf_lobe_diffuse = {
    .side = LOBE_REFLECTS,
    .evaluate = evaluate_base,
    .sample_rough = sample_reflected,
    .albedo = bare_albedo,
};

static rgb coated_albedo(const material_point *m) { return coat_diffuse_albedo(&m->coat); }

static float coat_transmittance(const material_point *m, float cosine) { return coat_entry(&m->coat, cosine); }

const bsdf_lobe_type bsdf_lobe_coated_base = {
    .side = LOBE_REFLECTS,
    .evaluate = evaluate_base,
    .sample_rough = sample_reflected,
    .albedo = coated_albedo,
    .transmittance = coat_transmittance,
};

static rgb principled_albedo(const material_point *m) { return principled_base_albedo(&m->principled); }

static float interface_transmittance(const material_point *m, float cosine)
{
    return principled_base_transmittance(&m->principled, cosine);
}

const bsdf_lobe_type bsdf_lobe_principled_base = {
    .side = LOBE_REFLECTS,
    .evaluate = evaluate_base,
    .sample_rough = sample_reflected,
    .albedo = principled_albedo,
    .transmittance = interface_transmittance,
};

static void evaluate_through(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                             float *out_pdf)
{
    evaluate_type(b, &bsdf_lobe_diffuse_through, transport, direction, o, i, out_value, out_pdf);
}

static bool sample_through(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec2 u, vec3 *out_local)
{
    (void)transport, (void)o, (void)u_lobe;
    return sample_cosine(b, true, u, out_local);
}

static rgb through_albedo(const material_point *m) { return m->diffuse.transmittance; }

const bsdf_lobe_type bsdf_lobe_diffuse_through = {
    .side = LOBE_TRANSMITS,
    .evaluate = evaluate_through,
    .sample_rough = sample_through,
    .passes = true,
    .albedo = through_albedo,
};

static void evaluate_coat_scattered(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i,
                                    rgb *out_value, float *out_pdf)
{
    (void)transport;
    *out_pdf = diffuse_cosine(b, false, direction, i) * AG_INV_PI;
    if (*out_pdf > 0.0f)
        *out_value = rgb_scale(coat_scattered(&b->material.coat, o, i), *out_pdf);
}

const bsdf_lobe_type bsdf_lobe_coat_scattered = {
    .side = LOBE_REFLECTS,
    .evaluate = evaluate_coat_scattered,
    .sample_rough = sample_reflected,
};
