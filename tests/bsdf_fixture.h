/* bsdf_fixture.h: materials for the tests of scattering, and the check that samples, density and value agree.
 * Threads: one. */
#ifndef AFTERGLOW_TESTS_BSDF_FIXTURE_H
#define AFTERGLOW_TESTS_BSDF_FIXTURE_H

#include "bsdf.h"

#include "test_scene.h"

static const vec3 UP = {0.0f, 0.0f, 1.0f};

static inline material diffuse(void)
{
    material m = material_make(MATERIAL_DIFFUSE);
    m.reflectance = (rgb){0.8f, 0.5f, 0.1f};
    return m;
}

static inline material conductor(float alpha_u, float alpha_v)
{
    material m = material_make(MATERIAL_CONDUCTOR);
    m.eta = (rgb){0.2f, 0.9f, 1.5f}, m.k = (rgb){3.9f, 2.4f, 1.9f};
    m.alpha_u = alpha_u, m.alpha_v = alpha_v;
    return m;
}

static inline material dielectric(float ior, float alpha_u, float alpha_v)
{
    material m = material_make(MATERIAL_DIELECTRIC);
    m.ior = ior, m.alpha_u = alpha_u, m.alpha_v = alpha_v;
    return m;
}

static inline material diffuse_transmission(void)
{
    material m = material_make(MATERIAL_DIFFUSE_TRANSMISSION);
    m.reflectance = (rgb){0.3f, 0.2f, 0.0f}, m.transmittance = (rgb){0.1f, 0.6f, 1.0f};
    return m;
}

static inline material coated_diffuse(float alpha_u, float alpha_v)
{
    material m = diffuse();
    m.kind = MATERIAL_COATED_DIFFUSE;
    m.alpha_u = alpha_u, m.alpha_v = alpha_v;
    return m;
}

/* coat: roughness of the coat, base: of the conductor. */
static inline material coated_conductor(float coat, float base_u, float base_v)
{
    material m = conductor(coat, coat);
    m.kind = MATERIAL_COATED_CONDUCTOR;
    m.ior = 1.5f;
    m.base_alpha_u = base_u, m.base_alpha_v = base_v;
    return m;
}

static inline material principled(float metallic, float roughness, float transmission, float clearcoat,
                                  float clearcoat_roughness)
{
    material m = material_make(MATERIAL_PRINCIPLED);
    m.reflectance = (rgb){0.9f, 0.6f, 0.2f};
    m.metallic = metallic, m.roughness = roughness, m.transmission = transmission;
    m.clearcoat = clearcoat, m.clearcoat_roughness = clearcoat_roughness;
    return m;
}

static inline material solid(material m, float ior)
{
    m.is_thin = false;
    m.ior = ior;
    return m;
}

/* All sorts: plastic, metal, coats, thin and solid glass, and much of each at once. */
enum { PRINCIPLED_SORTS = 14 };
static inline material principled_sort(int which)
{
    material colored = principled(0.2f, 0.7f, 0.3f, 0.6f, 0.4f);
    colored.specular = 0.7f, colored.specular_color = (rgb){0.3f, 2.0f, 9.0f};
    switch (which) {
    case 0: return principled(0.0f, 0.5f, 0.0f, 0.0f, 0.0f);
    case 1: return principled(0.0f, 0.0f, 0.0f, 0.0f, 0.0f);
    case 2: return principled(1.0f, 0.6f, 0.0f, 0.0f, 0.0f);
    case 3: return principled(0.5f, 1.0f, 0.0f, 0.0f, 0.0f);
    case 4: return principled(0.0f, 0.8f, 0.0f, 1.0f, 0.0f);
    case 5: return principled(1.0f, 0.5f, 0.0f, 0.8f, 0.5f);
    case 6: return principled(0.0f, 0.5f, 1.0f, 0.0f, 0.0f);
    case 7: return principled(0.0f, 0.0f, 0.6f, 0.0f, 0.0f);
    case 8: return solid(principled(0.0f, 0.6f, 1.0f, 0.0f, 0.0f), 1.5f);
    case 9: return solid(principled(0.0f, 0.0f, 0.7f, 0.5f, 0.0f), 1.33f);
    case 10: return solid(colored, 1.8f);
    case 11: return colored;
    case 12: return solid(principled(0.0f, 0.5f, 0.5f, 0.0f, 0.0f), 0.0f);
    default: return solid(principled(0.0f, 0.7f, 0.8f, 1.0f, 0.6f), 1.2f);
    }
}

/* Of a material that is prepared already. */
static inline bsdf bsdf_of(const material *prepared, vec3 shading_normal, vec3 out)
{
    surface_hit hit = {.geometric_normal = UP, .shading_normal = shading_normal};
    return bsdf_create_of(prepared, &hit, out);
}

static inline bsdf bsdf_at(const material *m, vec3 shading_normal, vec3 out)
{
    material prepared = *m;
    material_prepare(&prepared);
    return bsdf_of(&prepared, shading_normal, out);
}

/* A place whose normals are the z axis. */
static inline bsdf flat(const material *m, vec3 out) { return bsdf_at(m, UP, out); }

static inline vec3 direction_at(double degrees, double turn_degrees)
{
    double t = degrees * PI / 180.0, p = turn_degrees * PI / 180.0;
    return (vec3){(float)(sin(t) * cos(p)), (float)(sin(t) * sin(p)), (float)cos(t)};
}

/* --- sampling against density and value --- */

typedef struct view {
    const bsdf *b;
    bsdf_lobes lobes;
    double value[2]; /* sums of the values at all places of the density: red, green */
} view;

/* The bins' poles lie in the surface: round about its normal, where scattering may be narrow, they are even. */
static inline vec3 bins_from_world(vec3 d) { return (vec3){d.x, d.z, -d.y}; }

static inline double view_density(void *user, vec3 d)
{
    view *v = user;
    vec3 direction = {d.x, -d.z, d.y};
    rgb value = bsdf_evaluate(v->b, v->lobes, BSDF_FLUX, direction);
    v->value[0] += value.r, v->value[1] += value.g;
    double pdf = bsdf_pdf(v->b, v->lobes, direction);
    /* nothing is claimed that sampling cannot find */
    if (!(pdf >= 0.0 && rgb_is_finite(value)) || (pdf == 0.0 && !rgb_is_black(value)))
        fail_msg("value %g where the density is %g", (double)value.g, pdf);
    return pdf;
}

/* What a sample says of itself is what the other two functions say. */
static inline void check_sample(const bsdf *b, bsdf_lobes lobes, uint64_t index)
{
    for (int t = BSDF_RADIANCE; t <= BSDF_FLUX; t++) {
        bsdf_sample again;
        rng same = test_random(index);
        float lobe = rng_float(&same);
        if (!bsdf_sample_direction(b, lobes, (bsdf_transport)t, lobe, rng_vec2(&same), &again) || again.is_delta)
            continue;
        float pdf = bsdf_pdf(b, lobes, again.direction);
        rgb value = bsdf_evaluate(b, lobes, (bsdf_transport)t, again.direction);
        assert_relative(again.pdf_solid_angle, pdf, 1e-4);
        assert_relative(again.weight.r, value.r / pdf, 1e-3);
        assert_relative(again.weight.b, value.b / pdf, 1e-3);
    }
}

/* The probability, among the lobes, of those that are smooth or not, of one group. */
static inline double picked_share(const bsdf *b, bsdf_lobes lobes, bsdf_lobes group, bool is_delta)
{
    double sum = 0.0;
    for (int k = 0; k < b->lobe_count; k++)
        if ((b->lobes[k].group & lobes) && b->lobes[k].group == group && b->lobes[k].is_delta == is_delta)
            sum += (double)b->lobes[k].probability;
    return sum / (double)bsdf_probability(b, lobes);
}

/* Samples of some lobes: rough ones fall as the density says and weigh in all what the value's integral says; smooth
 * ones come as often as they should; is_closed: no channel gains. */
static inline void check_lobes(const bsdf *b, bsdf_lobes lobes, int samples, bool is_closed)
{
    static uint32_t counts[BIN_COUNT];
    static double bins[BIN_COUNT];
    memset(counts, 0, sizeof counts);
    rng random = test_random(1);
    uint32_t sampled = 0, smooth[4] = {0, 0, 0, 0};
    double n = samples, energy[3] = {0.0, 0.0, 0.0}, rough[2] = {0.0, 0.0}, squares[2] = {0.0, 0.0};
    for (int i = 0; i < samples; i++) {
        bsdf_sample s;
        float u_lobe = rng_float(&random);
        if (!bsdf_sample_direction(b, lobes, BSDF_FLUX, u_lobe, rng_vec2(&random), &s))
            continue;
        energy[0] += s.weight.r, energy[1] += s.weight.g, energy[2] += s.weight.b;
        assert_close(vec3_length(s.direction), 1.0, 1e-5);
        assert_true(s.group & lobes);
        if (s.is_delta) {
            smooth[s.group]++;
            continue;
        }
        sampled++;
        counts[direction_bin(bins_from_world(s.direction))]++;
        rough[0] += s.weight.r, squares[0] += (double)s.weight.r * (double)s.weight.r;
        rough[1] += s.weight.g, squares[1] += (double)s.weight.g * (double)s.weight.g;
        if (i % 50 == 0)
            check_sample(b, lobes, 2 + (uint64_t)i);
    }
    for (int c = 0; c < 3 && is_closed; c++)
        assert_true(energy[c] / n <= 1.0 + 4.0 / sqrt(n));
    for (int group = BSDF_GATHERED; group <= BSDF_TRACED; group++) {
        double share = picked_share(b, lobes, (bsdf_lobes)group, true);
        if (smooth[group] > 0 || is_closed) /* a leaning normal may turn the one direction into the surface */
            assert_close(smooth[group] / n, share, 5.0 * sqrt(share * (1.0 - share) / n));
    }
    view v = {b, lobes, {0.0, 0.0}};
    enum { STEPS = 9 };
    double whole = integrate_bins(view_density, &v, STEPS, bins), cell = 4.0 * PI / BIN_COUNT / STEPS / STEPS;
    for (int c = 0; c < 2; c++) { /* the mean of the weights is the integral of the value */
        double mean = rough[c] / n, variance = fmax(0.0, squares[c] / n - mean * mean);
        assert_close(v.value[c] * cell, mean, 0.004 * mean + 5.0 * sqrt(variance / n) + 1e-9);
    }
    if (!bsdf_is_sampled_from_light(b, lobes)) {
        assert_true(sampled == 0 && whole == 0.0);
        return;
    }
    double possible = 1.0 - picked_share(b, lobes, BSDF_GATHERED, true) - picked_share(b, lobes, BSDF_TRACED, true);
    assert_true(whole <= possible + 0.002);
    assert_close(whole, sampled / n, 0.003 + 4.0 * sqrt(whole * fmax(0.0, 1.0 - whole) / n)); /* binomial */
    if (whole * n >= 500.0) /* between the two horizons of a leaning normal there is little room */
        assert_chi_square(counts, bins, n, 0.01);
}

#endif
