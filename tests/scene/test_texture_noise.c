/* test_texture_noise.c: Perlin's noise against values worked out apart, and the textures made of it.
 * Flow: tests of scene/texture/texture_noise.c. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/texture_fixture.h"
#include "texture/texture_noise.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

static void noise_is_perlins(void **state)
{
    (void)state;
    for (int i = -3; i < 3; i++)
        assert_near(texture_noise(vec3_make((float)i, 2.0f, (float)(5 * i))), 0.0, 0.0);
    /* worked out apart, in double precision, as a sum over the corners */
    assert_near(texture_noise(vec3_make(0.5f, 0.5f, 0.5f)), -0.125, 1e-7);
    assert_near(texture_noise(vec3_make(1.25f, 2.5f, 3.75f)), -0.03836345672607422, 1e-6);
    assert_near(texture_noise(vec3_make(-0.3125f, 10.125f, 255.875f)), -0.14796230907450125, 1e-6);
    assert_true(isfinite(texture_noise(vec3_make(INFINITY, NAN, 1e30f))));
    /* period, continuity across cells, bounds, and a mean of 0 */
    double sum = 0.0, sum_absolute = 0.0;
    enum { COUNT = 40 };
    for (int i = 0; i < COUNT; i++)
        for (int j = 0; j < COUNT; j++)
            for (int k = 0; k < COUNT; k++) {
                const vec3 p =
                    vec3_make((float)i * 0.78125f - 12.0f, (float)j * 0.828125f, (float)k * 0.734375f - 3.0f);
                const float value = texture_noise(p);
                assert_true(fabsf(value) <= 1.04f);
                assert_near(texture_noise(vec3_add(p, vec3_make(256.0f, -512.0f, 256.0f))), value, 0.0);
                assert_near(texture_noise(vec3_add(p, vec3_make(1e-3f, -1e-3f, 1e-3f))), value, 0.01);
                sum += (double)value;
                sum_absolute += fabs((double)value);
            }
    assert_near(sum / (COUNT * COUNT * COUNT), 0.0, 0.02);
    assert_near(sum_absolute / (COUNT * COUNT * COUNT), 0.2, 0.06);
    /* along an edge the noise is the two slopes there, faded into one another; slopes are -1, 0 or 1 */
    for (int i = 0; i < 200; i++) {
        const float x = (float)i;
        const double slope_here = (double)texture_noise(vec3_make(x + 0x1p-10f, 7.0f, 3.0f)) * 1024.0;
        const double slope_next = -(double)texture_noise(vec3_make(x + 1.0f - 0x1p-10f, 7.0f, 3.0f)) * 1024.0;
        const double a = round(slope_here), b = round(slope_next);
        assert_near(slope_here, a, 0.01);
        assert_near(slope_next, b, 0.01);
        assert_true(fabs(a) <= 1.0 && fabs(b) <= 1.0);
        assert_near(texture_noise(vec3_make(x + 0.5f, 7.0f, 3.0f)), 0.25 * (a - b), 1e-6);
    }
}

static void octaves_add_up(void **state)
{
    (void)state;
    const surface_hit hit = hit_at(0, 0, 1.3f, -0.4f, 2.7f);
    const vec3 p = vec3_make(0.65f, -0.2f, 1.35f); /* under Scale 2 2 2 */
    double fbm = 0.0, turbulence = 0.0, frequency = 1.0, height = 1.0;
    for (int i = 0; i < 3; i++) {
        const float value = texture_noise(vec3_scale(p, (float)frequency));
        fbm += height * (double)value;
        turbulence += height * fabs((double)value);
        frequency *= 1.99;
        height *= 0.7;
    }
    assert_near(
        float_of("Scale 2 2 2 Texture \"a\" \"float\" \"fbm\" \"integer octaves\" 3 \"float roughness\" 0.7", hit), fbm,
        2e-6);
    assert_near(
        float_of("Scale 2 2 2 Texture \"a\" \"float\" \"wrinkled\" \"integer octaves\" 3 \"float roughness\" 0.7", hit),
        turbulence + 0.2 * height, 2e-6);
    assert_near(float_of("Texture \"a\" \"float\" \"fbm\"", hit), texture_fbm(hit.position, 0.5f, 8), 0.0);
    assert_near(float_of("Texture \"a\" \"float\" \"fbm\" \"integer octaves\" 0", hit), 0.0, 0.0);
    assert_near(float_of("Texture \"a\" \"float\" \"windy\"", hit),
                fabsf(texture_fbm(vec3_scale(hit.position, 0.1f), 0.5f, 3)) * texture_fbm(hit.position, 0.5f, 6), 1e-7);
}

static void marble_follows_its_spline(void **state)
{
    (void)state;
    /* without variation the curve's parameter is 0.5 + 0.5 sin(y) */
    static const char WORLD[] = "Texture \"a\" \"spectrum\" \"marble\" \"float variation\" 0 \"float scale\" 2";
    assert_rgb(rgb_of(WORLD, hit_at(0, 0, 5, (float)(-PI / 4), 1)), 0.87, 0.87, 0.9, 1e-5);
    /* at the very end all of the last control point, at the end's middle (t = 11/12) Bernstein's 1 3 3 1 over 8 */
    assert_rgb(rgb_of(WORLD, hit_at(0, 0, 5, (float)(PI / 4), 1)), 0.87, 0.87, 0.9, 1e-5);
    const double y = asin(2.0 * 11.0 / 12.0 - 1.0) / 2.0;
    const double r = (0.58 + 3 * 0.58 + 3 * 0.2 + 0.58) / 8, b = (0.6 + 3 * 0.6 + 3 * 0.33 + 0.6) / 8;
    assert_rgb(rgb_of(WORLD, hit_at(0, 0, 5, (float)y, 1)), 1.5 * r, 1.5 * r, 1.5 * b, 2e-5);
    const rgb with = rgb_of("Texture \"a\" \"spectrum\" \"marble\"", hit_at(0, 0, 0.3f, 0.7f, 0.2f));
    const rgb without =
        rgb_of("Texture \"a\" \"spectrum\" \"marble\" \"float variation\" 0", hit_at(0, 0, 0.3f, 0.7f, 0.2f));
    assert_true(with.r > 0.3f && with.r < 1.0f && with.r != without.r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_is_perlins),
        TEST_IN_FOLDER(octaves_add_up),
        TEST_IN_FOLDER(marble_follows_its_spline),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
