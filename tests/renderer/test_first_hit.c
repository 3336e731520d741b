/* test_first_hit.c: the irradiance that a layer shows of what is met first, in closed form: in closed cubes, dark and
 * bright. Threads: the renderer's. */
#define _GNU_SOURCE
#include "fixtures/layers_fixture.h"
#include "fixtures/sanitizer.h"

/* Returns the mean irradiance over a wall of a closed cube of 4 m around a lamp of 10,000 W, by that seed. The camera
 * stands at the lamp and sees this wall alone, as much of it in each pixel. */
static double irradiance_in_a_cube(double reflectance, uint64_t seed)
{
    char text[1024];
    snprintf(
        text, sizeof text,
        "Film \"rgb\" PixelFilter \"box\" Camera \"perspective\" \"float fov\" 90 WorldBegin\n"
        "LightSource \"point\" \"float power\" 10000\n"
        "Material \"diffuse\" \"rgb reflectance\" [%g %g %g]\n"
        "Shape \"trianglemesh\" \"integer indices\" [0 1 3 0 3 2 4 7 5 4 6 7 0 5 1 0 4 5 2 3 7 2 7 6 0 2 6 0 6 4 1 5 "
        "7 1 7 3] \"point3 P\" [-2 -2 -2 2 -2 -2 -2 2 -2 2 2 -2 -2 -2 2 2 -2 2 -2 2 2 2 2 2]",
        reflectance, reflectance, reflectance);
    studio *s = studio_open(text, 2);
    s->settings.photon_count = 300000;
    s->settings.max_depth = 100; /* all light but 3e-5 of it */
    s->settings.photon_seed = seed;
    s->settings.width = s->settings.height = 64;
    s->settings.samples_per_pixel = 1;
    s->settings.layers = AG_LAYER_IRRADIANCE;
    ag_film *film = studio_render(s);
    double mean = film_mean(film, "irradiance.G");
    ag_film_destroy(film);
    studio_close(s);
    return mean;
}

/* In a closed box the walls take as much as the lamp gives: a mean irradiance of flux / area / (1 - reflectance), and
 * all walls of this one are alike. */
static void closed_cubes_have_the_irradiance_of_their_lamp(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip(); /* statistics of what test_aov runs */
    enum { SEEDS = 16 };
    static const double REFLECTANCES[] = {0.2, 0.5, 0.9};
    int wrong = 0;
    for (size_t i = 0; i < sizeof REFLECTANCES / sizeof *REFLECTANCES; i++) {
        double expected = 10000.0 / 96.0 / (1.0 - REFLECTANCES[i]), sum = 0.0, squares = 0.0;
        for (uint64_t seed = 1; seed <= SEEDS; seed++) {
            double one = irradiance_in_a_cube(REFLECTANCES[i], seed) / expected;
            sum += one;
            squares += one * one;
        }
        double mean = sum / SEEDS, sigma = sqrt(fmax(0.0, squares / SEEDS - mean * mean) / (SEEDS - 1));
        bool is_right = fabs(mean - 1.0) <= 0.004 + sigma;
        print_message("%s reflectance %g: irradiance %.4f +- %.4f of what the lamp gives\n",
                      is_right ? "right:" : "WRONG:", REFLECTANCES[i], mean, sigma);
        wrong += !is_right;
    }
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {TEST_IN_FOLDER(closed_cubes_have_the_irradiance_of_their_lamp)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
