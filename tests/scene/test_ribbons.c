/* test_ribbons.c: ribbons that twist, lean and bend: where they are, by their definition; and that hair and cloth on
 * them send as much light from a lamp to the eye as from the eye to the lamp. Threads: one. */
#include "fixtures/test_scene.h"
#include "material/bsdf.h"

/* Ribbons by their definition: the middle line p, the normals' even turn from n[0] to n[1], and half the width. */
typedef struct ribbon {
    double p[4][3], n[2][3], half;
} ribbon;

/* p + v half (n x t): v goes from edge to edge, [-1, 1]. */
static void ribbon_point(const ribbon *r, double u, double v, double out[3])
{
    double w = 1.0 - u, length[2], cosine = 0.0, n[3], d[3], a[3];
    for (int k = 0; k < 2; k++)
        length[k] = sqrt(r->n[k][0] * r->n[k][0] + r->n[k][1] * r->n[k][1] + r->n[k][2] * r->n[k][2]);
    for (int i = 0; i < 3; i++)
        cosine += r->n[0][i] * r->n[1][i] / (length[0] * length[1]);
    double angle = acos(fmin(cosine, 1.0)), before = angle > 0.0 ? sin(w * angle) : w,
           behind = angle > 0.0 ? sin(u * angle) : u;
    for (int i = 0; i < 3; i++) {
        const double(*p)[3] = r->p;
        n[i] = before * r->n[0][i] / length[0] + behind * r->n[1][i] / length[1];
        d[i] = w * w * (p[1][i] - p[0][i]) + 2.0 * u * w * (p[2][i] - p[1][i]) + u * u * (p[3][i] - p[2][i]);
        out[i] = w * w * w * p[0][i] + 3.0 * u * w * w * p[1][i] + 3.0 * u * u * w * p[2][i] + u * u * u * p[3][i];
    }
    for (int i = 0; i < 3; i++)
        a[i] = n[(i + 1) % 3] * d[(i + 2) % 3] - n[(i + 2) % 3] * d[(i + 1) % 3];
    for (int i = 0; i < 3; i++)
        out[i] += v * r->half * a[i] / sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static vec3 ribbon_normal_at(const ribbon *r, double u, double v)
{
    static const double STEP = 1e-5;
    double a[3], b[3], c[3], d[3];
    ribbon_point(r, u - STEP, v, a), ribbon_point(r, u + STEP, v, b);
    ribbon_point(r, u, v - STEP, c), ribbon_point(r, u, v + STEP, d);
    vec3 along = {(float)((b[0] - a[0]) / STEP), (float)((b[1] - a[1]) / STEP), (float)((b[2] - a[2]) / STEP)};
    vec3 across = {(float)((d[0] - c[0]) / STEP), (float)((d[1] - c[1]) / STEP), (float)((d[2] - c[2]) / STEP)};
    return vec3_normalize(vec3_cross(along, across));
}

static const ribbon RIBBONS[] = {
    {{{0, -2, 0}, {0, -.7, 0}, {0, .7, 0}, {0, 2, 0}}, {{1, 0, 0}, {0, 0, 1}}, 0.3},   /* twists */
    {{{0, -2, 0}, {0, -.7, 0}, {0, .7, 0}, {0, 2, 0}}, {{1, 3, 0}, {0, 3, 1}}, 0.3},   /* twists and leans */
    {{{0, -2, 0}, {0, -.7, 0}, {0, .7, 0}, {0, 2, 0}}, {{1, 3, 0}, {0, -3, 1}}, 0.3},  /* leans to and fro */
    {{{0, -2, 0}, {0, -.7, 0}, {0, .7, .5}, {0, 2, 0}}, {{1, 3, 0}, {0, 3, 1}}, 0.3},  /* twists, leans and bends */
    {{{0, -2, 0}, {0, -1, 0}, {.4, .7, .5}, {1, 2, 0}}, {{0, 0, 1}, {0, 0, 1}}, 0.1}}; /* in its own plane */
enum { RIBBON_COUNT = sizeof RIBBONS / sizeof *RIBBONS };

static void ribbon_text(const ribbon *r, const char *before, const char *after, char *out, size_t bytes)
{
    const double(*p)[3] = r->p, (*n)[3] = r->n;
    snprintf(
        out, bytes,
        "%s Shape \"curve\" \"string type\" \"ribbon\" \"float width\" %g \"point3 P\" [%g %g %g %g %g %g %g %g %g %g %g %g] \"normal N\" "
        "[%g %g %g %g %g %g]%s",
        before, 2.0 * r->half, p[0][0], p[0][1], p[0][2], p[1][0], p[1][1], p[1][2], p[2][0], p[2][1], p[2][2], p[3][0],
        p[3][1], p[3][2], n[0][0], n[0][1], n[0][2], n[1][0], n[1][1], n[1][2], after);
}

/* A ribbon is met where it is by definition, with the normal of the surface there and not of its middle line, and not
 * beyond its edges. */
static void a_ribbon_turns_as_its_normals_do(void **state)
{
    (void)state;
    test_run run;
    test_run_init(&run, 1);
    for (int k = 0; k < RIBBON_COUNT; k++) {
        const ribbon *r = &RIBBONS[k];
        char text[1024];
        ribbon_text(r, "", "", text, sizeof text);
        scene *s = test_scene_create(&run, text);
        int met = 0, missed = 0, beyond = 0;
        for (int i = 0; i < 20000 / FEWER; i++) {
            rng random = test_random((uint64_t)i);
            double u = 0.02 + 0.96 * (double)rng_float(&random), v = 1.2 * (2.0 * (double)rng_float(&random) - 1.0),
                   x[3];
            vec3 d = random_direction(&random), n = ribbon_normal_at(r, u, v);
            double cosine = fabs((double)vec3_dot(n, d));
            if (cosine < 0.3 || (fabs(v) > 0.98 && fabs(v) < 1.02))
                continue;
            ribbon_point(r, u, v, x);
            vec3 to = {(float)x[0], (float)x[1], (float)x[2]};
            surface_hit h;
            bool is_met = scene_intersect(s, scene_ray_make(vec3_add_scaled(to, d, -0.1f), d), 0.2f, &h) &&
                          fabs((double)h.distance - 0.1) * cosine < 0.01 * r->half;
            if (fabs(v) > 1.0) {
                beyond += is_met;
                continue;
            }
            missed += !is_met;
            if (!is_met)
                continue;
            met++;
            assert_close(fabs((double)vec3_dot(h.geometric_normal, n)), 1.0, 2e-3);
            assert_close((double)h.uv.y, 0.5 + 0.5 * v, 0.02);
        }
        /* some of those that twist meet another part of themselves first */
        if (met < 4000 / FEWER || missed > met / 200 || beyond > met / 200)
            fail_msg("ribbon %d: %d met, %d missed, %d beyond its edges", k, met, missed, beyond);
        scene_destroy(s);
    }
    test_run_reset(&run);
}

/* --- light, both ways --- */

/* Where the ray meets the ribbon within a tolerance of a point, and how it scatters there. */
static bool scatters_at(const scene *s, vec3 point, vec3 toward, surface_hit *out_hit, bsdf *out_bsdf)
{
    scene_ray ray = scene_ray_make(vec3_add_scaled(point, toward, 0.1f), vec3_negate(toward));
    if (!scene_intersect(s, ray, 0.2f, out_hit) || fabsf(out_hit->distance - 0.1f) > 1e-4f)
        return false;
    bsdf_init(s, out_hit, toward, out_bsdf);
    return true;
}

static const char *const PLACEMENTS[] = {"", "ReverseOrientation ", "Scale 1 1 -1 ", "ObjectBegin \"o\" ",
                                         "ReverseOrientation ObjectBegin \"o\" "};
static const char *const AFTER[] = {"", "", "", " ObjectEnd Scale 1 -1 1 ObjectInstance \"o\"",
                                    " ObjectEnd Scale 1 1 1.5 ObjectInstance \"o\""};
enum { PLACEMENT_COUNT = sizeof PLACEMENTS / sizeof *PLACEMENTS };

/* Flux that meets a point from b and goes on to a, over its cosine, is the radiance that comes from b and leaves to a,
 * over that one's: on either side and through, whichever side is the outside (Veach 1997, 5.3). */
static void expect_same_both_ways(const char *of)
{
    test_run run;
    test_run_init(&run, 1);
    for (int k = 0; k < PLACEMENT_COUNT; k++) {
        int compared = 0, across = 0;
        char before[512], text[2048];
        snprintf(before, sizeof before, "%s %s", of, PLACEMENTS[k]);
        ribbon_text(&RIBBONS[3], before, AFTER[k], text, sizeof text);
        scene *s = test_scene_create(&run, text);
        for (int i = 0; i < 4000 / FEWER; i++) {
            rng random = test_random((uint64_t)i);
            vec3 a = random_direction(&random), b = random_direction(&random);
            vec3 to = random_in_box(&random, s->bounds_min, s->bounds_max);
            surface_hit of_photon, of_eye;
            bsdf photon, eye;
            scene_ray ray = scene_ray_make(vec3_add_scaled(to, b, 5.0f), vec3_negate(b));
            if (!scene_intersect(s, ray, INFINITY, &of_photon) ||
                !scatters_at(s, of_photon.position, b, &of_photon, &photon) ||
                !scatters_at(s, of_photon.position, a, &of_eye, &eye))
                continue;
            float met = fabsf(vec3_dot(b, of_photon.geometric_normal)),
                  left = fabsf(vec3_dot(a, of_eye.geometric_normal));
            if (met < 0.002f || left < 0.002f)
                continue;
            rgb flux = bsdf_evaluate(&photon, BSDF_ALL, BSDF_FLUX, a),
                radiance = bsdf_evaluate(&eye, BSDF_ALL, BSDF_RADIANCE, b);
            double expected = (double)radiance.g * (double)left;
            assert_close((double)flux.g * (double)met, expected, 2e-3 * expected + 1e-5);
            compared++;
            across += vec3_dot(a, of_eye.geometric_normal) * vec3_dot(b, of_photon.geometric_normal) < 0.0f;
        }
        if (compared < 200 / FEWER || across < 50 / FEWER || across > compared - 50 / FEWER)
            fail_msg("placement %d: %d compared, %d of them through the ribbon", k, compared, across);
        scene_destroy(s);
    }
    test_run_reset(&run);
}

static void hair_sends_as_much_both_ways(void **state)
{
    (void)state;
    expect_same_both_ways("Material \"hair\" \"rgb sigma_a\" [.1 .2 .4] \"float beta_m\" .5 \"float beta_n\" .4");
}

static void cloth_sends_as_much_both_ways(void **state)
{
    (void)state;
    expect_same_both_ways(
        "Material \"diffusetransmission\" \"rgb reflectance\" [.3 .5 .2] \"rgb transmittance\" [.2 .4 .1]");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ribbon_turns_as_its_normals_do),
        cmocka_unit_test(hair_sends_as_much_both_ways),
        cmocka_unit_test(cloth_sends_as_much_both_ways),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
