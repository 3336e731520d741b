/* test_coat.c: coats as pbrt-v4 makes them. Its figures: albedo under an even sky, and pictures of a sphere under a
 * distant light and a lamp, measured with its LayeredBxDF (commit 5f7a606, 512 samples a pixel, within 0.003). Threads:
 * one. */
/* ctest: serial */
#include "fixtures/bsdf_fixture.h"
#include "fixtures/layered_walk.h"

/* pbrt's defaults. */
static material as_pbrt(material m)
{
    m.coat_thickness = 0.01f;
    m.coat_bounces = 5;
    return m;
}

static material coat_on_diffuse(double roughness, double reflectance)
{
    material m = as_pbrt(coated_diffuse((float)roughness, (float)roughness));
    m.reflectance = rgb_gray((float)reflectance);
    return m;
}

/* A coat on a metal that reflects 0.8 at normal incidence in air. */
static material coat_on_metal(double roughness, double base_roughness)
{
    material m = as_pbrt(coated_conductor((float)roughness, (float)base_roughness, (float)base_roughness));
    m.eta = rgb_gray(1.0f / 1.5f), m.k = rgb_gray(material_k_from_reflectance(0.8f) / 1.5f);
    return m;
}

static void check_figure(const char *what, double got, double expected)
{
    print_message("%s: %.4f, pbrt %.4f\n", what, got, expected);
    if (!(fabs(got - expected) <= WIDER * fmax(0.02 * expected, 0.004)))
        fail_msg("%s: %.4f, not %.4f", what, got, expected);
}

/* Mean weight of what leaves to a point whose cosine is within 0.06 of the one named. */
static double albedo_about(const material *prepared, double cosine, int samples)
{
    rng random = test_random(41);
    double sum = 0.0;
    for (int k = 0; k < samples; k++) {
        double z = fmin(cosine + 0.12 * ((k + 0.5) / samples - 0.5), 0.9999);
        bsdf b = bsdf_of(prepared, UP, (vec3){(float)sqrt(1.0 - z * z), 0.0f, (float)z});
        bsdf_sample s;
        float u_lobe = rng_float(&random);
        if (bsdf_sample_direction(&b, BSDF_ALL, BSDF_RADIANCE, u_lobe, rng_vec2(&random), &s))
            sum += (double)s.weight.g;
    }
    return sum / samples;
}

static void rough_coats_on_diffuse_bases_are_pbrts(void **state)
{
    (void)state;
    static const double COSINES[4] = {0.95, 0.7, 0.5, 0.3};
    static const struct {
        double roughness, reflectance, albedo[4];
    } ROWS[] = {
        {0.0, 0.2, {0.126, 0.135, 0.170, 0.278}},  {0.0, 0.5, {0.304, 0.312, 0.340, 0.425}},
        {0.0, 0.8, {0.586, 0.587, 0.605, 0.659}},  {0.0, 1.0, {0.865, 0.866, 0.871, 0.887}},
        {0.1, 0.2, {0.125, 0.135, 0.167, 0.240}},  {0.1, 0.5, {0.299, 0.307, 0.331, 0.386}},
        {0.1, 0.8, {0.564, 0.567, 0.581, 0.609}},  {0.1, 1.0, {0.820, 0.822, 0.823, 0.824}},
        {0.25, 0.2, {0.120, 0.127, 0.144, 0.176}}, {0.25, 0.5, {0.279, 0.282, 0.293, 0.313}},
        {0.25, 0.8, {0.499, 0.500, 0.500, 0.502}}, {0.25, 1.0, {0.697, 0.693, 0.686, 0.672}},
        {0.5, 0.2, {0.104, 0.106, 0.113, 0.125}},  {0.5, 0.5, {0.237, 0.233, 0.234, 0.236}},
        {0.5, 0.8, {0.399, 0.389, 0.382, 0.373}},  {0.5, 1.0, {0.527, 0.513, 0.498, 0.480}},
        {1.0, 0.2, {0.073, 0.071, 0.074, 0.080}},  {1.0, 0.5, {0.169, 0.157, 0.153, 0.153}},
        {1.0, 0.8, {0.273, 0.252, 0.240, 0.232}},  {1.0, 1.0, {0.348, 0.319, 0.301, 0.289}},
    };
    for (size_t r = 0; r < sizeof ROWS / sizeof *ROWS; r++) {
        material m = coat_on_diffuse(ROWS[r].roughness, ROWS[r].reflectance);
        prepare(&m);
        for (int c = 0; c < 4; c++) {
            char what[80];
            snprintf(what, sizeof what, "coat %g on %g, cosine %g", ROWS[r].roughness, ROWS[r].reflectance, COSINES[c]);
            check_figure(what, albedo_about(&m, COSINES[c], 60000 / FEWER), ROWS[r].albedo[c]);
        }
    }
}

/* A unit sphere seen along -z, its face where the cosine is above 0.2, under each of three lights: an even sky of
 * radiance 1; a distant light of radiance 1 from (1 1 3); a sphere of radius 1 and radiance 10 about (2 2 4). */
typedef struct sphere_pictures {
    double sky, distant, lamp;
} sphere_pictures;

static double balanced(double pdf, double other) { return pdf / (pdf + other); }

static sphere_pictures picture_sphere(const material *prepared, int samples)
{
    const material_point point = point_of(prepared);
    sphere_pictures sum = {0.0, 0.0, 0.0};
    vec3 out = {0.0f, 0.0f, 1.0f}, sun = vec3_normalize((vec3){1.0f, 1.0f, 3.0f}), lamp = {2.0f, 2.0f, 4.0f};
    rng random = test_random(42);
    for (int k = 0; k < samples; k++) {
        float square = 0.04f + 0.96f * rng_float(&random), radius = sqrtf(1.0f - square), s, c;
        sincos_turns(rng_float(&random), &s, &c);
        vec3 n = {radius * c, radius * s, sqrtf(square)};
        surface_hit hit = {.geometric_normal = n, .shading_normal = n};
        bsdf b;
        bsdf_init_of(&point, &hit, out, &b);
        sum.distant += (double)bsdf_evaluate(&b, BSDF_ALL, BSDF_RADIANCE, sun).g;
        vec3 to_lamp = vec3_sub(lamp, n);
        float distance_squared = vec3_length_squared(to_lamp);
        float one_minus_cos = 1.0f - sqrtf(1.0f - 1.0f / distance_squared);
        to_lamp = vec3_normalize(to_lamp);
        frame f = frame_from_z(to_lamp);
        double pdf_lamp = 1.0 / (2.0 * PI * (double)one_minus_cos);
        vec3 at_lamp = frame_to_world(&f, sample_uniform_cone(rng_vec2(&random), one_minus_cos));
        double pdf = bsdf_pdf(&b, BSDF_ALL, BSDF_RADIANCE, at_lamp);
        sum.lamp +=
            10.0 * (double)bsdf_evaluate(&b, BSDF_ALL, BSDF_RADIANCE, at_lamp).g / pdf_lamp * balanced(pdf_lamp, pdf);
        bsdf_sample sample;
        float u_lobe = rng_float(&random);
        if (!bsdf_sample_direction(&b, BSDF_ALL, BSDF_RADIANCE, u_lobe, rng_vec2(&random), &sample))
            continue;
        sum.sky += (double)sample.weight.g;
        if (vec3_dot(sample.direction, to_lamp) > 1.0f - one_minus_cos)
            sum.lamp += 10.0 * (double)sample.weight.g *
                        (sample.is_delta ? 1.0 : balanced((double)sample.pdf_solid_angle, pdf_lamp));
    }
    return (sphere_pictures){sum.sky / samples, sum.distant / samples, sum.lamp / samples};
}

static void rough_coats_on_metals_are_pbrts(void **state)
{
    (void)state;
    static const struct {
        double coat, base, sky, distant, lamp;
    } ROWS[] = {
        {0.0, 0.0, 0.7209, 0.0, 0.0957},    {0.0, 0.2, 0.5443, 0.0554, 0.0914}, {0.1, 0.0, 0.6371, 0.0577, 0.0923},
        {0.1, 0.2, 0.5176, 0.0593, 0.0924}, {0.3, 0.0, 0.4941, 0.0519, 0.0812}, {0.3, 0.2, 0.4243, 0.0554, 0.0855},
        {0.6, 0.0, 0.3459, 0.0391, 0.0602}, {0.6, 0.2, 0.3086, 0.0443, 0.0678},
    };
    for (size_t r = 0; r < sizeof ROWS / sizeof *ROWS; r++) {
        material m = coat_on_metal(ROWS[r].coat, ROWS[r].base);
        prepare(&m);
        sphere_pictures got = picture_sphere(&m, 400000 / FEWER);
        char what[80];
        snprintf(what, sizeof what, "coat %g on metal %g, sky", ROWS[r].coat, ROWS[r].base);
        check_figure(what, got.sky, ROWS[r].sky);
        snprintf(what, sizeof what, "coat %g on metal %g, distant light", ROWS[r].coat, ROWS[r].base);
        check_figure(what, got.distant, ROWS[r].distant);
        snprintf(what, sizeof what, "coat %g on metal %g, lamp", ROWS[r].coat, ROWS[r].base);
        check_figure(what, got.lamp, ROWS[r].lamp);
    }
}

/* --- against walks --- */

static double red_albedo(const material *prepared, vec3 out, int samples)
{
    bsdf b = bsdf_of(prepared, UP, out);
    rng random = test_random(43);
    double sum = 0.0;
    for (int k = 0; k < samples; k++) {
        bsdf_sample s;
        float u_lobe = rng_float(&random);
        if (bsdf_sample_direction(&b, BSDF_ALL, BSDF_RADIANCE, u_lobe, rng_vec2(&random), &s))
            sum += (double)s.weight.r;
    }
    return sum / samples;
}

static material varied(int which)
{
    bool is_metal = which % 2 == 1;
    material m = is_metal ? coat_on_metal(0.3, 0.15) : coat_on_diffuse(0.3, 0.7);
    switch (which / 2) {
    case 0: break;
    case 1: m.ior = 1.2f; break;
    case 2: m.ior = 2.2f, m.alpha_u = m.alpha_v = 0.15f; break;
    case 3: m.coat_thickness = 0.3f; break;
    case 4: m.coat_bounces = 1; break;
    case 5: m.coat_bounces = 0, m.coat_thickness = 0.0f; break;
    case 6: m.coat_thickness = 0.5f, m.coat_albedo = rgb_make(0.9f, 0.5f, 0.1f), m.coat_g = 0.4f; break;
    case 7: m.coat_thickness = 0.2f, m.coat_albedo = rgb_make(1.0f, 0.0f, 0.3f), m.alpha_u = m.alpha_v = 0.0f; break;
    case 8: m.alpha_u = 0.1f, m.alpha_v = 0.5f; break;
    case 9: m.alpha_u = m.alpha_v = 0.8f, m.base_alpha_u = m.base_alpha_v = 0.5f; break;
    default: m.alpha_u = m.alpha_v = 0.02f, m.ior = 0.8f; break;
    }
    return m;
}
enum { VARIED = 22 };

/* A gap of colours that differ much, facets along a grain, an index below 1: where one shape serves all channels, all
 * turns, or both sides of total reflection. */
static bool is_hard(int which) { return (which >= 12 && which <= 17) || which >= 20; }

static void coats_have_the_albedo_of_walks(void **state)
{
    (void)state;
    static const double ANGLES[] = {5, 45, 65, 80};
    enum { WALKS = 30000 / FEWER };
    for (int which = 0; which < VARIED; which++) {
        material m = varied(which);
        prepare(&m);
        for (int k = 0; k < 4; k++) {
            vec3 out = direction_at(ANGLES[k], 30.0);
            double expected = walk_albedo(&m, out, WALKS), got = red_albedo(&m, out, WALKS);
            double share = is_hard(which) ? 0.08 : 0.012;
            if (!(fabs(got - expected) <= WIDER * (share * expected + 0.004)))
                fail_msg("sort %d, %g degrees: %.4f, walks %.4f", which, ANGLES[k], got, expected);
        }
    }
}

/* The light that coats send into cones of 15 degrees about a mirror's direction, beside it and elsewhere is that of
 * walks: over diffuse bases within the noise; of metals the lobe's shape stands in for another (coat.h). */
static void coats_send_light_where_walks_go(void **state)
{
    (void)state;
    enum { WALKS = 100000 / FEWER };
    static const double TO[5][2] = {{40, 180}, {10, 180}, {60, 180}, {40, 90}, {40, 0}};
    for (int which = 0; which < VARIED; which++) {
        material m = varied(which);
        prepare(&m);
        vec3 out = direction_at(40.0, 0.0);
        bsdf b = bsdf_of(&m, UP, out);
        float one_minus_cos = (float)(1.0 - cos(15.0 * PI / 180.0));
        double expected[5];
        vec3 axes[5];
        for (int k = 0; k < 5; k++)
            axes[k] = direction_at(TO[k][0], TO[k][1]);
        walk_into_cones(&m, out, axes, 5, 1.0 - (double)one_minus_cos, WALKS, expected);
        for (int k = 0; k < 5; k++) {
            if (k == 0 && material_is_smooth(m.alpha_u, m.alpha_v))
                continue; /* the mirror's own direction */
            double got = 0.0;
            rng random = test_random(44);
            frame f = frame_from_z(axes[k]);
            enum { RAYS = 4000 };
            for (int i = 0; i < RAYS; i++) {
                vec3 d = frame_to_world(&f, sample_uniform_cone(rng_vec2(&random), one_minus_cos));
                got += (double)bsdf_evaluate(&b, BSDF_ALL, BSDF_RADIANCE, d).r / RAYS;
            }
            got *= 2.0 * PI * (double)one_minus_cos;
            bool is_metal = m.kind == MATERIAL_COATED_CONDUCTOR;
            double share = is_metal ? 0.12 : is_hard(which) ? 0.2 : 0.04, least = is_metal ? 0.003 : 0.0008;
            if (!(fabs(got - expected[k]) <= WIDER * (share * expected[k] + least)))
                fail_msg("sort %d, to %g %g: %.4f, walks %.4f", which, TO[k][0], TO[k][1], got, expected[k]);
        }
    }
}

/* A roughness from a texture, between the cells of the table, gives what the table of that one roughness gives. */
static void textured_roughness_is_interpolated(void **state)
{
    (void)state;
    static const float ALPHAS[] = {0.0f, 0.02f, 0.07f, 0.13f, 0.25f, 0.37f, 0.6f, 0.8f};
    for (int which = 0; which < 3; which++) {
        material varying = which == 0 ? coat_on_diffuse(0.0, 0.8) : coat_on_metal(0.0, 0.3);
        varying.alpha_u_texture = 0;
        if (which == 2)
            varying.base_alpha_u_texture = 0;
        prepare(&varying);
        for (int k = 0; k < 8; k++)
            for (double degrees = 10.0; degrees < 90.0; degrees += 30.0) {
                material here = varying, one = which == 0 ? coat_on_diffuse(0.0, 0.8) : coat_on_metal(0.0, 0.3);
                here.alpha_u = here.alpha_v = one.alpha_u = one.alpha_v = ALPHAS[k];
                prepare(&one);
                vec3 out = direction_at(degrees, 20.0);
                double expected = red_albedo(&one, out, 20000 / FEWER), got = red_albedo(&here, out, 20000 / FEWER);
                if (!(fabs(got - expected) <= WIDER * ((which == 2 ? 0.03 : 0.02) * expected + 0.004)))
                    fail_msg("sort %d, roughness %g, %g degrees: %.4f, alone %.4f", which, (double)ALPHAS[k], degrees,
                             got, expected);
            }
    }
}

/* Colours of the base are no part of a table; roughness is. */
static void materials_of_one_coat_share_a_table(void **state)
{
    (void)state;
    test_run run;
    test_run_init(&run, 1);
    scene *s =
        test_scene_create(&run, "Material \"coatedconductor\" \"float interface.roughness\" .1 Shape \"sphere\" "
                                "Material \"coatedconductor\" \"float interface.roughness\" .1 \"rgb reflectance\" "
                                "[.2 .5 .9] Shape \"sphere\" "
                                "Material \"coatedconductor\" \"float interface.roughness\" .2 Shape \"sphere\" "
                                "Material \"coatedconductor\" \"float interface.roughness\" 0 \"float "
                                "conductor.roughness\" 0 Shape \"sphere\"");
    assert_int_equal(s->material_table_count, 2);
    const material *first = &s->materials[s->shapes[0].material_index];
    assert_ptr_equal(first->table, s->materials[s->shapes[1].material_index].table);
    assert_ptr_not_equal(first->table, s->materials[s->shapes[2].material_index].table);
    assert_null(s->materials[s->shapes[3].material_index].table);
    scene_destroy(s);
    test_run_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rough_coats_on_diffuse_bases_are_pbrts), cmocka_unit_test(rough_coats_on_metals_are_pbrts),
        cmocka_unit_test(coats_have_the_albedo_of_walks),         cmocka_unit_test(coats_send_light_where_walks_go),
        cmocka_unit_test(textured_roughness_is_interpolated),     cmocka_unit_test(materials_of_one_coat_share_a_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
