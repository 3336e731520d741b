/* test_medium.c: where media scatter light, and into which directions, is distributed as weights and densities say.
 * Threads: one. */
#include "medium/medium.h"

#include "fixtures/test_scene.h"
#include "material/bsdf.h"
#include "medium/medium_flight.h"
#include "medium/phase_function.h"
#include "rays/transmittance.h"

static const medium FOG = {.as.homogeneous = {{0.1f, 0.4f, 0.0f}, {0.5f, 0.2f, 2.0f}}};
static const medium TEA = {.as.homogeneous.sigma_a = {0.3f, 0.0f, 1.0f}};
static const medium MIST = {.as.homogeneous.sigma_s = {0.0f, 1.0f, 0.25f}};

/* medium_flight_pass along any line. */
static bool pass(medium_flight *f, const medium *m, float length, float *out_distance)
{
    return medium_flight_pass(f, m, &(medium_stretch){{1.0f, 2.0f, 3.0f}, {0.0f, 0.0f, 1.0f}, length}, out_distance);
}

/* Stretches of a way, and what is left of light at the end. */
typedef struct stretch {
    const medium *m;
    float length;
} stretch;

enum { SIDE = 600 };

/* Sums over a grid of random numbers: the mean weight of flights that reach the end is the transmittance; of those that
 * end in a stretch it is the integral of sigma_s times the transmittance to there; of their distance in it, its first
 * moment. */
static void expect_flights(const stretch *way, int count)
{
    double through[3] = {0}, scattered[4][3] = {{0}}, moments[4][3] = {{0}};
    const double share = 1.0 / (SIDE * 3.0);
    for (int i = 0; i < 3 * SIDE; i++) {
        medium_flight f =
            medium_flight_begin(rgb_gray(1.0f), (vec2){((float)(i % 3) + 0.5f) / 3.0f, ((float)(i / 3) + 0.5f) / SIDE});
        float distance = 0.0f;
        int k = 0;
        while (k < count && !pass(&f, way[k].m, way[k].length, &distance))
            k++;
        rgb weight = medium_flight_weight(&f);
        const double weights[3] = {weight.r, weight.g, weight.b};
        for (int c = 0; c < 3; c++) {
            assert_true(weights[c] >= 0.0 && isfinite(weights[c]));
            if (k == count)
                through[c] += weights[c] * share;
            else
                scattered[k][c] += weights[c] * share, moments[k][c] += (double)distance * weights[c] * share;
        }
        assert_true(k == count || (distance >= 0.0f && distance <= way[k].length));
    }
    for (int c = 0; c < 3; c++) {
        double left = 1.0;
        for (int k = 0; k < count; k++) {
            const rgb a = way[k].m->as.homogeneous.sigma_a, s = way[k].m->as.homogeneous.sigma_s;
            double sigma_s = c == 0 ? s.r : c == 1 ? s.g : s.b;
            double sigma_t = sigma_s + (double)(c == 0 ? a.r : c == 1 ? a.g : a.b), d = way[k].length;
            double after = sigma_t > 0.0 ? exp(-sigma_t * d) : 1.0;
            if (sigma_s > 0.0) {
                double moment = (1.0 - after) / (sigma_t * sigma_t) - (isinf(d) ? 0.0 : d * after / sigma_t);
                assert_close(scattered[k][c], left * sigma_s / sigma_t * (1.0 - after), 4e-3);
                assert_close(moments[k][c], left * sigma_s * moment, 1.5e-2);
            } else {
                assert_close(scattered[k][c], 0.0, 1e-7);
            }
            left *= after;
        }
        assert_close(through[c], left, 4e-3);
    }
}

static void flights_have_their_weights(void **state)
{
    (void)state;
    expect_flights((const stretch[]){{&FOG, 1.5f}}, 1);
    expect_flights((const stretch[]){{&FOG, INFINITY}}, 1);
    expect_flights((const stretch[]){{&TEA, 2.0f}}, 1);
    expect_flights((const stretch[]){{&TEA, 0.5f}, {&FOG, 0.7f}, {&TEA, 0.25f}, {&MIST, 1.0f}}, 4);
    expect_flights((const stretch[]){{&MIST, INFINITY}}, 1); /* red goes on for ever */
    expect_flights((const stretch[]){{&FOG, 0.0f}}, 1);
}

/* The last numbers below 1 give distances too, and nothing is left of what goes on for ever. */
static void flights_end_well(void **state)
{
    (void)state;
    const vec2 most = {0x1.fffffep-1f, 0x1.fffffep-1f};
    medium_flight f = medium_flight_begin(rgb_gray(1.0f), most);
    float distance = -1.0f;
    assert_int_equal(f.channel, 2);
    assert_true(pass(&f, &FOG, INFINITY, &distance) && distance > 7.0f && isfinite(distance));
    rgb weight = medium_flight_weight(&f);
    assert_true(rgb_is_finite(weight) && weight.b > 0.0f);
    f = medium_flight_begin(rgb_gray(2.0f), (vec2){0.0f, 0.0f}); /* red, at once; but red is not scattered */
    assert_false(pass(&f, &MIST, INFINITY, &distance));
    weight = medium_flight_weight(&f);
    assert_true(weight.r == 3.0f && weight.g == 0.0f && weight.b == 0.0f);
    f = medium_flight_begin(rgb_gray(1.0f), most); /* far beyond what floats hold */
    assert_false(pass(&f, &FOG, 8.0f, &distance));
    f.transmittance = f.density = rgb_gray(0.0f);
    assert_true(rgb_is_black(medium_flight_weight(&f)));
}

/* Light of all colours goes from scattering to scattering in a medium that scatters them very differently and absorbs
 * nothing: all colours together never carry more than they began with, and each has, in the mean over paths, what it
 * began with. */
static void no_colour_grows(void **state)
{
    (void)state;
    enum { PATHS = 20000, SCATTERINGS = 12 };
    static const medium MILK = {.as.homogeneous.sigma_s = {0.2f, 2.0f, 20.0f}};
    rng random = test_random(41);
    double sums[3] = {0}, squares[3] = {0};
    for (int i = 0; i < PATHS; i++) {
        rgb carried = rgb_gray(1.0f);
        for (int k = 0; k < SCATTERINGS; k++) {
            float distance;
            medium_flight f = medium_flight_begin(carried, rng_vec2(&random));
            assert_true(pass(&f, &MILK, INFINITY, &distance));
            carried = rgb_mul(carried, medium_flight_weight(&f));
            assert_true(carried.r + carried.g + carried.b <= 3.0f * (1.0f + 1e-5f * (float)(k + 1)));
        }
        const double ends[3] = {carried.r, carried.g, carried.b};
        for (int c = 0; c < 3; c++)
            sums[c] += ends[c], squares[c] += ends[c] * ends[c];
    }
    for (int c = 0; c < 3; c++) {
        double mean = sums[c] / PATHS, sigma = sqrt((squares[c] / PATHS - mean * mean) / PATHS);
        print_message("channel %d: %.4f +- %.4f\n", c, mean, sigma);
        assert_true(fabs(mean - 1.0) <= 4.0 * sigma && sigma < 0.02);
    }
}

/* A channel that carries nothing is never picked, and weighs nothing. */
static void empty_channels_are_not_picked(void **state)
{
    (void)state;
    static const medium MILK = {.as.homogeneous.sigma_s = {0.2f, 2.0f, 20.0f}};
    for (int i = 0; i < 1000; i++) {
        float distance;
        medium_flight f = medium_flight_begin((rgb){0.5f, 0.0f, 0.0f}, (vec2){((float)i + 0.5f) / 1000.0f, 0.5f});
        assert_int_equal(f.channel, 0);
        assert_true(pass(&f, &MILK, INFINITY, &distance));
        rgb weight = medium_flight_weight(&f);
        assert_close(weight.r, 1.0, 1e-5);
        assert_true(weight.g == 0.0f && weight.b == 0.0f);
    }
}

/* --- every kind --- */

/* Makes a medium of a kind that absorbs and scatters. Returns false where it does not know the kind. */
static bool make_murky(medium_kind kind, medium *out)
{
    *out = medium_make(kind);
    switch (kind) {
    case MEDIUM_HOMOGENEOUS: out->as.homogeneous = FOG.as.homogeneous; return true;
    case MEDIUM_KIND_COUNT: break;
    }
    return false;
}

/* On any line as many flights reach the end as the transmittance says, in the mean; the others end on the way. */
static void expect_flights_to_agree(const medium *m)
{
    enum { LINES = 100000 / FEWER };
    double through[3] = {0}, difference[3] = {0}, squares[3] = {0};
    rng random = test_random(5);
    for (int i = 0; i < LINES; i++) {
        vec3 direction = random_direction(&random);
        medium_stretch way = {{rng_float(&random), rng_float(&random), rng_float(&random)}, direction, 0.8f};
        medium_flight f = medium_flight_begin(rgb_gray(1.0f), rng_vec2(&random));
        float distance = -1.0f;
        bool is_scattered = medium_flight_pass(&f, m, &way, &distance);
        assert_true(!is_scattered || (distance >= 0.0f && distance < way.length));
        rgb left = medium_transmittance(m, &way), again = medium_transmittance(m, &way);
        rgb weight = is_scattered ? rgb_gray(0.0f) : medium_flight_weight(&f);
        const double t[3] = {left.r, left.g, left.b}, w[3] = {weight.r, weight.g, weight.b};
        assert_memory_equal(&left, &again, sizeof left);
        for (int c = 0; c < 3; c++) {
            assert_true(t[c] >= 0.0 && t[c] <= 1.0);
            through[c] += t[c] / LINES, difference[c] += (w[c] - t[c]) / LINES;
            squares[c] += (w[c] - t[c]) * (w[c] - t[c]) / LINES;
        }
    }
    for (int c = 0; c < 3; c++) {
        assert_true(through[c] > 0.0 && through[c] < 1.0);
        assert_true(fabs(difference[c]) <= 4.0 * sqrt(squares[c] / LINES));
    }
}

static void every_kind_does_what_a_medium_does(void **state)
{
    (void)state;
    const medium_stretch way = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f}, INFINITY};
    for (int kind = 0; kind < MEDIUM_KIND_COUNT; kind++) {
        medium m = medium_make((medium_kind)kind);
        rgb left = medium_transmittance(&m, &way);
        assert_true(m.kind == (medium_kind)kind && !medium_scatters(&m));
        assert_true(left.r == 1.0f && left.g == 1.0f && left.b == 1.0f);
        if (!make_murky((medium_kind)kind, &m))
            fail_msg("make_murky makes no medium of kind %d", kind);
        assert_true(medium_scatters(&m));
        expect_flights_to_agree(&m);
        medium_reset(&m);
        assert_true(m.kind == (medium_kind)kind && !medium_scatters(&m));
    }
}

static const float GS[] = {-0.999f, -0.9f, -0.5f, -1e-4f, 0.0f, 1e-4f, 0.3f, 0.85f, 0.99f};
enum { GS_COUNT = sizeof GS / sizeof *GS };

/* The phase function's integral is 1, and the mean cosine g; by midpoints, denser where it is large. */
static void phase_function_is_normalized(void **state)
{
    (void)state;
    enum { STEPS = 200000 };
    for (int i = 0; i < GS_COUNT; i++) {
        const phase_function phase = {GS[i]};
        double sum = 0.0, cosine_sum = 0.0, forward = GS[i] >= 0.0f ? 1.0 : -1.0;
        for (int k = 0; k < STEPS; k++) {
            double x = (k + 0.5) / STEPS, cosine = forward * (1.0 - 2.0 * x * x * x);
            double density = (double)phase_function_density(&phase, (float)cosine);
            sum += density * 2.0 * PI * 6.0 * x * x / STEPS;
            cosine_sum += density * cosine * 2.0 * PI * 6.0 * x * x / STEPS;
        }
        assert_close(sum, 1.0, 2e-3);
        assert_close(cosine_sum, (double)GS[i], 2e-3);
        /* the formula itself, where it loses nothing */
        double g = GS[i], square = 1.0 + g * g - 2.0 * g * 0.25;
        assert_relative(phase_function_density(&phase, 0.25f), (1.0 - g * g) / (4.0 * PI * square * sqrt(square)),
                        1e-5);
    }
}

typedef struct turned {
    phase_function phase;
    vec3 along;
} turned;

static double density_of(void *user, vec3 direction)
{
    const turned *t = user;
    return (double)phase_function_density(&t->phase, vec3_dot(t->along, direction));
}

static void phase_function_is_sampled_by_its_density(void **state)
{
    (void)state;
    enum { SAMPLES = 200000 / FEWER };
    for (int i = 0; i < GS_COUNT; i++) {
        static uint32_t counts[BIN_COUNT];
        static double bins[BIN_COUNT];
        rng random = test_random((uint64_t)i);
        turned t = {{GS[i]}, random_direction(&random)};
        double cosine_sum = 0.0;
        memset(counts, 0, sizeof counts);
        for (int k = 0; k < SAMPLES; k++) {
            vec3 d = phase_function_sample(&t.phase, t.along, rng_vec2(&random));
            assert_close(vec3_length(d), 1.0, 1e-6);
            counts[direction_bin(d)]++;
            cosine_sum += (double)vec3_dot(d, t.along) / SAMPLES;
        }
        assert_close(cosine_sum, (double)GS[i], 4.0 * sqrt((1.0 - (double)(GS[i] * GS[i])) / SAMPLES) + 1e-5);
        if (fabsf(GS[i]) < 0.95f) { /* midpoints cannot integrate a sharper one */
            assert_close(integrate_bins(density_of, &t, 16, bins), 1.0, 2e-2);
            assert_chi_square(counts, bins, SAMPLES, fabsf(GS[i]) > 0.8f ? 0.02 : 1e-3);
        }
    }
}

/* Integrators see a point in a medium as a bsdf: nothing is lost, its density is its value, and sampling it weighs
 * 1. */
static void bsdf_in_a_medium_is_the_phase_function(void **state)
{
    (void)state;
    rng random = test_random(77);
    for (int i = 0; i < GS_COUNT; i++) {
        medium m = FOG;
        m.phase.g = GS[i];
        vec3 out = random_direction(&random);
        bsdf b;
        bsdf_init_in_medium(&m, out, &b);
        assert_true(bsdf_has(&b, BSDF_TRACED) && !bsdf_has(&b, BSDF_GATHERED) && !b.is_pane);
        assert_true(bsdf_is_sampled_from_light(&b, BSDF_TRACED) && bsdf_scatters_through(&b, BSDF_TRACED));
        assert_true(bsdf_flux_gain(&b) == 1.0f && rgb_is_black(bsdf_gathered_reflection(&b)));
        for (int k = 0; k < 1000; k++) {
            static const bsdf_transport TRANSPORTS[] = {BSDF_RADIANCE, BSDF_FLUX};
            bsdf_sample next;
            vec2 u = rng_vec2(&random);
            for (int t = 0; t < 2; t++) {
                assert_true(bsdf_sample_direction(&b, BSDF_ALL, TRANSPORTS[t], 0.5f, u, &next));
                assert_true(next.group == BSDF_TRACED && !next.is_delta && !next.is_straight);
                assert_close(next.weight.r, 1.0, 1e-6);
                float density = phase_function_density(&m.phase, -vec3_dot(out, next.direction));
                assert_true(next.pdf_solid_angle == density);
                assert_true(bsdf_pdf(&b, BSDF_TRACED, TRANSPORTS[t], next.direction) == density);
                assert_true(bsdf_evaluate(&b, BSDF_ALL, TRANSPORTS[t], next.direction).g == density);
            }
        }
    }
}

/* A medium counts where something is in it, not where the file merely tells of it. */
static void media_that_are_not_used(void **state)
{
    (void)state;
    static const struct {
        const char *world;
        bool is_used;
    } SCENES[] = {
        {"Shape \"sphere\"\n", false},
        {"MediumInterface \"tea\" \"\" Shape \"sphere\"\n", false},
        {"MediumInterface \"fog\" \"\" Shape \"sphere\"\n", true},
        {"MediumInterface \"\" \"fog\" Material \"interface\" Shape \"sphere\"\n", true},
        {"MediumInterface \"\" \"fog\" LightSource \"point\" MediumInterface \"\" \"\" Shape \"sphere\"\n", true},
    };
    for (size_t i = 0; i < sizeof SCENES / sizeof *SCENES; i++) {
        char text[1024];
        snprintf(text, sizeof text,
                 "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [1 1 1]\n"
                 "MakeNamedMedium \"tea\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [0 0 0]\n%s",
                 SCENES[i].world);
        test_run r;
        test_run_init(&r, 1);
        scene *s = test_scene_create(&r, text);
        assert_int_equal(s->medium_count, 2);
        assert_int_equal(s->has_scattering_media, SCENES[i].is_used);
        scene_destroy(s);
        test_run_reset(&r);
    }
}

/* A ray through a ball of fog in another one, between walls: it ends in the fog or at the wall, as often as it
 * should, on its line, and knows the medium. */
static void rays_travel_across_interfaces(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    scene *s = test_scene_create(
        &r,
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.1 .4 0] \"rgb sigma_s\" [.5 .2 2]\n"
        "MakeNamedMedium \"tea\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.3 0 1] \"rgb sigma_s\" [0 0 0]\n"
        "MediumInterface \"tea\" \"\" Shape \"sphere\" \"float radius\" 2\n"
        "MediumInterface \"fog\" \"tea\" Material \"interface\" Shape \"sphere\" \"float radius\" 1\n");
    assert_true(s->has_scattering_media && s->has_interfaces);
    enum { RAYS = 60000 };
    double at_wall[3] = {0}, in_fog[3] = {0};
    for (int i = 0; i < RAYS; i++) {
        scene_ray ray = scene_ray_make((vec3){-1.5f, 0.0f, 0.0f}, (vec3){1.0f, 0.0f, 0.0f});
        surface_hit hit;
        rgb weight;
        uint64_t cut = 0;
        ray.medium = 1;
        vec2 u = {((float)(i % 3) + 0.5f) / 3.0f, ((float)(i / 3) + 0.5f) / (RAYS / 3)};
        ray_end end = transmittance_travel(s, &ray, rgb_gray(1.0f), u, &cut, &hit, &weight);
        assert_true(end != RAY_ENDS_NOWHERE && cut == 0);
        double *sums = end == RAY_ENDS_IN_MEDIUM ? in_fog : at_wall;
        assert_int_equal(ray.medium, end == RAY_ENDS_IN_MEDIUM ? 0 : 1);
        sums[0] += (double)weight.r / RAYS, sums[1] += (double)weight.g / RAYS, sums[2] += (double)weight.b / RAYS;
        assert_close(hit.position.y, 0.0, 1e-6);
        assert_close(hit.distance, (double)hit.position.x + 1.5, 1e-5);
        if (end == RAY_ENDS_IN_MEDIUM)
            assert_true(hit.position.x >= -1.0f && hit.position.x <= 1.0f && hit.epsilon == 0.0f);
        else
            assert_close(hit.position.x, 2.0, 1e-5);
    }
    static const double ABSORBED[3] = {0.3, 0.0, 1.0}, LOST[3] = {0.6, 0.6, 2.0}, SCATTERED[3] = {0.5, 0.2, 2.0};
    for (int c = 0; c < 3; c++) {
        double before = exp(-0.5 * ABSORBED[c]), in = exp(-2.0 * LOST[c]);
        assert_close(in_fog[c], before * SCATTERED[c] / LOST[c] * (1.0 - in), 1e-3);
        assert_close(at_wall[c], before * in * exp(-1.0 * ABSORBED[c]), 1e-3);
    }
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flights_have_their_weights),
        cmocka_unit_test(flights_end_well),
        cmocka_unit_test(no_colour_grows),
        cmocka_unit_test(empty_channels_are_not_picked),
        cmocka_unit_test(every_kind_does_what_a_medium_does),
        cmocka_unit_test(phase_function_is_normalized),
        cmocka_unit_test(phase_function_is_sampled_by_its_density),
        cmocka_unit_test(bsdf_in_a_medium_is_the_phase_function),
        cmocka_unit_test(media_that_are_not_used),
        cmocka_unit_test(rays_travel_across_interfaces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
