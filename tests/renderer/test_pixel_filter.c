/* test_pixel_filter.c: samples follow the filters' closed forms, signs included; what is even stays even.
 * Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "film/pixel_filter.h"
#include "fixtures/pbrt_fixture.h"
#include "integrator/sampler.h"

static const double PI = 3.14159265358979323846;

static ag_status create(const char *directive, bool is_centered, pixel_filter *out_filter, char *said, size_t size)
{
    char text[256];
    snprintf(text, sizeof text, "%s WorldBegin", directive);
    reading r = reading_create(NULL, text, strlen(text)), heard = {0};
    ag_status status = r.status;
    if (status == AG_OK) {
        log_sink *log = log_create(reading_hear, &heard);
        status = pixel_filter_create(&r.scene->hints.filter, is_centered, log, out_filter);
        log_destroy(log);
    }
    const reading *speaker = heard.said[AG_LOG_ERROR] ? &heard : &r;
    snprintf(said, size, "%s",
             speaker->said[AG_LOG_ERROR]     ? speaker->said[AG_LOG_ERROR]
             : speaker->said[AG_LOG_WARNING] ? speaker->said[AG_LOG_WARNING]
                                             : "");
    for (int i = 0; i < 4; i++)
        free(heard.said[i]);
    reading_destroy(&r);
    return status;
}

static pixel_filter filter_of(const char *directive)
{
    pixel_filter f;
    char said[256];
    assert_int_equal(create(directive, false, &f, said, sizeof said), AG_OK);
    assert_string_equal(said, "");
    return f;
}

static double sinc(double x) { return x == 0.0 ? 1.0 : sin(PI * x) / (PI * x); }

static double gaussian_1(double x, double radius)
{
    return exp(-x * x / 0.5) - exp(-radius * radius / 0.5); /* sigma 0.5 */
}
static double box_1(double x, double radius) { return fabs(x) <= radius; }
static double triangle_1(double x, double radius) { return fmax(0.0, radius - fabs(x)); }
static double sinc_1(double x, double radius) { return fabs(x) > radius ? 0.0 : sinc(x) * sinc(x / 3.0); }
/* B = C = 1/3, written out */
static double mitchell_1(double x, double radius)
{
    double t = fabs(2.0 * x / radius);
    if (t < 1.0)
        return (7.0 * t * t * t - 12.0 * t * t + 16.0 / 3.0) / 6.0;
    return t < 2.0 ? (-7.0 / 3.0 * t * t * t + 12.0 * t * t - 20.0 * t + 32.0 / 3.0) / 6.0 : 0.0;
}

/* The share of the signed samples in each column is the filter's share, along both axes. */
static void check_distribution(const char *directive, double radius_x, double radius_y, double (*value)(double, double))
{
    enum { COLUMNS = 16, SIDE = 256, FINE = 64 };
    const double radius[2] = {radius_x, radius_y};
    double expected[2][COLUMNS] = {{0}}, whole[2] = {0.0, 0.0}, magnitude[2] = {0.0, 0.0}, got[2][COLUMNS] = {{0}};
    pixel_filter f = filter_of(directive);
    for (int axis = 0; axis < 2; axis++) {
        assert_near(f.radius[axis], radius[axis], 0);
        for (int i = 0; i < COLUMNS * FINE; i++) {
            double v = value(radius[axis] * (2.0 * (i + 0.5) / (COLUMNS * FINE) - 1.0), radius[axis]);
            expected[axis][i / FINE] += v;
            whole[axis] += v;
            magnitude[axis] += fabs(v);
        }
    }
    double signs = 0.0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            int sign = 0;
            vec2 p = pixel_filter_sample(&f, (vec2){((float)x + 0.5f) / SIDE, ((float)y + 0.5f) / SIDE}, &sign);
            const double offset[2] = {p.x, p.y};
            assert_true(sign == 1 || sign == -1);
            signs += sign;
            for (int axis = 0; axis < 2; axis++) {
                assert_true(fabs(offset[axis]) <= radius[axis]);
                got[axis][(int)fmin((offset[axis] / radius[axis] + 1.0) / 2.0 * COLUMNS, COLUMNS - 1)] += sign;
            }
        }
    double mean_sign = whole[0] / magnitude[0] * whole[1] / magnitude[1];
    assert_near(f.mean_sign, mean_sign, 1e-3);
    assert_near(signs / (SIDE * SIDE), mean_sign, 0.01);
    assert_true(f.has_signs == (mean_sign < 1.0 - 1e-9));
    for (int axis = 0; axis < 2; axis++)
        for (int i = 0; i < COLUMNS; i++)
            assert_near(got[axis][i] / signs, expected[axis][i] / whole[axis], 0.012);
}

static void samples_follow_the_filter(void **state)
{
    (void)state;
    check_distribution("", 1.5, 1.5, gaussian_1);
    check_distribution("PixelFilter \"gaussian\" \"float xradius\" 1", 1, 1.5, gaussian_1);
    check_distribution("PixelFilter \"box\" \"float yradius\" 2", 0.5, 2, box_1);
    check_distribution("PixelFilter \"triangle\"", 2, 2, triangle_1);
    check_distribution("PixelFilter \"mitchell\"", 2, 2, mitchell_1);
    check_distribution("PixelFilter \"mitchell\" \"float xradius\" 3 \"float B\" 0.333333333 \"float C\" 0.333333333",
                       3, 2, mitchell_1);
    check_distribution("PixelFilter \"sinc\"", 4, 4, sinc_1);
    check_distribution("PixelFilter \"sinc\" \"float xradius\" 2 \"float tau\" 3", 2, 4, sinc_1);
}

/* With the sampler's own points and few of them: a pixel of an even picture has its value, and where the signs hardly
 * count, no value is beyond those of the samples. */
static void even_pictures_stay_even(void **state)
{
    (void)state;
    static const char *const KINDS[] = {"mitchell", "sinc"};
    for (int k = 0; k < 2; k++) {
        char text[64];
        snprintf(text, sizeof text, "PixelFilter \"%s\"", KINDS[k]);
        pixel_filter f = filter_of(text);
        for (uint32_t count = 1; count <= 16; count++)
            for (int pixel = 0; pixel < 64; pixel++) {
                pixel_sum sum = {0};
                for (uint32_t i = 0; i < count; i++) {
                    sampler s = sampler_make(1, pixel, 7, i, sampler_bits(count));
                    int sign;
                    (void)pixel_filter_sample(&f, sampler_2d(&s, SAMPLE_PIXEL, 0), &sign);
                    uint32_t *of_sign = sign > 0 ? &sum.positive_count : &sum.negative_count;
                    double *value = sign > 0 ? sum.positive : sum.negative;
                    ++*of_sign;
                    for (int c = 0; c < 3; c++)
                        value[c] += 0.25 * (c + 1);
                }
                double out[3];
                pixel_filter_resolve(&f, &sum, out);
                for (int c = 0; c < 3; c++)
                    assert_near(out[c], 0.25 * (c + 1), 1e-12);
            }
    }
}

/* Over many pixels the mean of a ramp is its value at the centre, as of every filter that is even. */
static void ramps_are_kept(void **state)
{
    (void)state;
    pixel_filter f = filter_of("PixelFilter \"sinc\"");
    double mean = 0.0;
    enum { PIXELS = 2000, COUNT = 64 };
    for (int pixel = 0; pixel < PIXELS; pixel++) {
        pixel_sum sum = {0};
        for (uint32_t i = 0; i < COUNT; i++) {
            sampler s = sampler_make(2, pixel, 3, i, sampler_bits(COUNT));
            int sign;
            vec2 p = pixel_filter_sample(&f, sampler_2d(&s, SAMPLE_PIXEL, 0), &sign);
            double *value = sign > 0 ? sum.positive : sum.negative;
            uint32_t *of_sign = sign > 0 ? &sum.positive_count : &sum.negative_count;
            ++*of_sign;
            value[0] += 5.0 + (double)p.x;
        }
        double out[3];
        pixel_filter_resolve(&f, &sum, out);
        mean += out[0] / PIXELS;
    }
    assert_near(mean, 5.0, 0.005);
}

static void signs_that_cancel_are_left_out(void **state)
{
    (void)state;
    pixel_filter f = filter_of("PixelFilter \"sinc\"");
    double out[3];
    pixel_sum sum = {.positive = {6, 6, 6}, .negative = {9, 9, 9}, .positive_count = 3, .negative_count = 3};
    pixel_filter_resolve(&f, &sum, out);
    assert_near(out[0], 2, 0);
    sum = (pixel_sum){.negative = {9, 9, 9}, .negative_count = 3};
    pixel_filter_resolve(&f, &sum, out);
    assert_near(out[0], 3, 0);
    sum = (pixel_sum){.positive = {6, 6, 6}, .negative = {1, 1, 1}, .positive_count = 3, .negative_count = 1};
    pixel_filter_resolve(&f, &sum, out);
    assert_near(out[0], 2.5, 0);
}

static void centred_samples_do_not_move(void **state)
{
    (void)state;
    pixel_filter f;
    char said[256];
    assert_int_equal(create("PixelFilter \"sinc\"", true, &f, said, sizeof said), AG_OK);
    assert_false(f.has_signs);
    for (int i = 0; i < 10; i++) {
        int sign;
        vec2 p = pixel_filter_sample(&f, (vec2){(float)i / 10.0f, 0.7f}, &sign);
        assert_true(p.x == 0.0f && p.y == 0.0f && sign == 1);
    }
}

static void mistakes_are_told(void **state)
{
    (void)state;
    static const struct {
        const char *directive, *message;
        ag_status status;
    } CASES[] = {
        {"PixelFilter \"cubic\"",
         "t:1:1: warning: PixelFilter \"cubic\" is not known; pbrt's default, \"gaussian\", stands in\n", AG_OK},
        {"PixelFilter \"box\" \"float xradius\" 0",
         "t:1:1: error: PixelFilter: radii must be in (0, 64], sigma and tau above 0", AG_ERROR_SCENE},
        {"PixelFilter \"sinc\" \"float tau\" 0",
         "t:1:1: error: PixelFilter: radii must be in (0, 64], sigma and tau above 0", AG_ERROR_SCENE},
        {"PixelFilter \"gaussian\" \"float sigma\" 1e-5",
         "t:1:1: error: PixelFilter: \"sigma\" is too small for the radius\n", AG_ERROR_SCENE},
        {"PixelFilter \"mitchell\" \"float B\" 0 \"float C\" 100",
         "t:1:1: error: PixelFilter: its negative lobes leave nothing of it\n", AG_ERROR_SCENE},
        {"PixelFilter \"sinc\" \"float sigma\" 1",
         "t:1:20: warning: PixelFilter \"sinc\": \"float sigma\" is not known, or not supported yet, and is ignored\n",
         AG_OK},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        pixel_filter f;
        char said[256];
        assert_int_equal(create(CASES[i].directive, false, &f, said, sizeof said), CASES[i].status);
        assert_true(strncmp(said, CASES[i].message, strlen(CASES[i].message)) == 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_follow_the_filter),
        cmocka_unit_test(even_pictures_stay_even),
        cmocka_unit_test(ramps_are_kept),
        cmocka_unit_test(signs_that_cancel_are_left_out),
        cmocka_unit_test(centred_samples_do_not_move),
        cmocka_unit_test(mistakes_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
