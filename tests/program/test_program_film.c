/* test_program_film.c: cameras, filters, film and options through the whole program: what is even all around looks even
 * through every camera and filter, exposure multiplies, samples are bounded, files have the samples asked for.
 * Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

static const char *scene_of(const char *head, const char *world)
{
    char text[2048];
    snprintf(text, sizeof text, "%s\nWorldBegin\n%s\n", head, world);
    return write_text("scene.pbrt", text);
}

#define FILM(parameters) "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32 " parameters "\n"
#define SKY              "LightSource \"infinite\" \"rgb L\" [1.5 1.5 1.5]"

static void check_even(const char *head, const char *world, double expected)
{
    picture p = RENDER(scene_of(head, world), "--integrator=path", "--spp=4");
    for (int i = 0; i < p.width * p.height * 3; i++)
        expect_near(head, (double)p.pixels[i], expected, 1e-6);
    picture_reset(&p);
}

static void test_even_light_through_all(void **state)
{
    (void)state;
    check_even(FILM("") "Camera \"orthographic\"", SKY, 1.5);
    check_even(FILM("") "Camera \"spherical\"", SKY, 1.5);
    check_even(FILM("") "Camera \"spherical\" \"string mapping\" \"equirectangular\"", SKY, 1.5);
    check_even(FILM("") "Camera \"perspective\" PixelFilter \"mitchell\"", SKY, 1.5);
    check_even(FILM("") "Camera \"perspective\" PixelFilter \"sinc\"", SKY, 1.5);
    check_even(FILM("") "Camera \"perspective\" \"float lensradius\" 1 Option \"disablepixeljitter\" true", SKY, 1.5);
}

/* Seen from the middle of a white ball that shines, direct light is the same on all sides, by both integrators. */
static void test_inside_a_lamp(void **state)
{
    (void)state;
    check_even(FILM("") "Camera \"spherical\"",
               "ReverseOrientation Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
               "AreaLightSource \"diffuse\" \"rgb L\" [ 0.7 0.7 0.7 ] Shape \"sphere\" \"float radius\" 3",
               0.7);
}

static void test_exposure(void **state)
{
    (void)state;
    check_even(FILM("\"float iso\" 100") "Camera \"perspective\" \"float shutterclose\" 1", SKY, 1.5);
    check_even(
        FILM("\"float iso\" 400") "Camera \"perspective\" \"float shutteropen\" 0.25 \"float shutterclose\" 0.75", SKY,
        1.5 * 0.5 * 4.0);
    check_even(FILM("\"string sensor\" \"cie1931\" \"float iso\" 50") "Camera \"perspective\"", SKY, 0.75);
}

static void test_bound(void **state)
{
    (void)state;
    /* white of 1.5: its largest component in XYZ is Z, (1 - .3127 - .3290) / .3290 times its luminance */
    check_even(FILM("\"float maxcomponentvalue\" 0.5") "Camera \"perspective\"", SKY, 0.5 * 0.3290 / 0.3583);
    check_even(FILM("\"float maxcomponentvalue\" 2 \"float iso\" 400") "Camera \"perspective\"", SKY,
               2.0 * 0.3290 / 0.3583);
    check_even(FILM("\"float maxcomponentvalue\" 2") "Camera \"perspective\"", SKY, 1.5);
}

/* Under the light that it is balanced to, white is white, of the luminance that it had. */
static void test_white_balance(void **state)
{
    (void)state;
    static const char *const CASES[][2] = {
        {"\"float whitebalance\" 5000", "LightSource \"infinite\" \"spectrum L\" \"stdillum-D50\""},
        {"\"float whitebalance\" 2854", "LightSource \"infinite\" \"blackbody L\" 2855.6"},
        {"\"float whitebalance\" 6500", "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char head[512];
        snprintf(head, sizeof head,
                 "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 %s\nCamera \"perspective\"",
                 CASES[i][0]);
        picture p = RENDER(scene_of(head, CASES[i][1]), "--integrator=path", "--spp=1");
        for (int c = 0; c < 3; c++)
            expect_near(CASES[i][0], picture_mean(&p, c), 1.0, 2e-3);
        picture_reset(&p);
    }
}

/* Two lamps of the same spectrum but for a factor are the same lamp: "scale" says how bright. */
static void test_spectrum_of_light(void **state)
{
    (void)state;
    picture p = RENDER(scene_of(FILM("") "Camera \"perspective\"",
                                "LightSource \"infinite\" \"spectrum L\" [ 300 9 900 9 ] \"float scale\" 2"),
                       "--integrator=path", "--spp=1");
    double luminance = 0.2126 * picture_mean(&p, 0) + 0.7152 * picture_mean(&p, 1) + 0.0722 * picture_mean(&p, 2);
    expect_near("luminance", luminance, 2.0, 1e-3);
    expect_near("equal energy", picture_mean(&p, 0) / picture_mean(&p, 1), 1.2050673 / 0.9482163, 1e-4);
    picture_reset(&p);
}

static void test_seeds(void **state)
{
    (void)state;
    static const char *const SEEDS[][2] = {
        {"", ""}, {"Option \"seed\" 5", ""}, {"", "\"integer seed\" 5"}, {"Option \"seed\" 9", "\"integer seed\" 5"}};
    static const char *const WORLD = "LightSource \"infinite\" Material \"diffuse\"\n"
                                     "Shape \"sphere\" AttributeBegin Translate 0 -2 0 Shape \"sphere\" AttributeEnd";
    picture pictures[5];
    for (int i = 0; i < 5; i++) {
        char head[512];
        snprintf(head, sizeof head, "%s LookAt 0 0 4 0 0 0 0 1 0\n%sCamera \"perspective\" Sampler \"halton\" %s",
                 SEEDS[i % 4][0], FILM(""), SEEDS[i % 4][1]);
        pictures[i] = i < 4 ? RENDER(scene_of(head, WORLD), "--integrator=path", "--spp=2")
                            : RENDER(scene_of(head, WORLD), "--integrator=path", "--spp=2", "--seed=5");
    }
    size_t bytes = 32 * 32 * 3 * sizeof(float);
    assert_memory_not_equal(pictures[0].pixels, pictures[1].pixels, bytes);
    assert_memory_equal(pictures[1].pixels, pictures[2].pixels, bytes);
    assert_memory_equal(pictures[1].pixels, pictures[3].pixels, bytes);
    assert_memory_equal(pictures[1].pixels, pictures[4].pixels, bytes);
    for (int i = 0; i < 5; i++)
        picture_reset(&pictures[i]);
}

/* The program's warnings and errors about film and sampler, in one line each. */
static void check_said(const char *head, int exit_code, const char *expected)
{
    const char *const arguments[] = {
        "--spp", "1", "-o", "p.exr", "--integrator", "path", "--progress", "none", scene_of(head, SKY), NULL};
    program_run run = program_execute(NULL, arguments);
    if (run.exit_code != exit_code || !strstr(run.err, expected))
        fail_msg("%s\n    exit %d, should say %s, but says %s", head, run.exit_code, expected, run.err);
    program_run_reset(&run);
}

static void test_what_is_said(void **state)
{
    (void)state;
#define CAMERA "Camera \"perspective\" Film "
#define SMALL  " \"integer xresolution\" 4 \"integer yresolution\" 4 "
    check_said(CAMERA "\"gbuffer\"" SMALL "\"string coordinatesystem\" \"camera\"", 0, "");
    check_said(CAMERA "\"gbuffer\"" SMALL "\"string coordinatesystem\" \"render\"", 1,
               "error: Film: \"coordinatesystem\" is \"render\", it must be \"camera\" or \"world\"");
    check_said(CAMERA "\"spectral\"" SMALL "\"integer nbuckets\" 8 \"float lambdamin\" 400", 0,
               "warning: Film \"spectral\" is not supported; \"rgb\" stands in");
    check_said(CAMERA "\"rgb\"" SMALL "\"string sensor\" \"nikon_d850\"", 0,
               "warning: Film: the sensor \"nikon_d850\" is not supported; \"cie1931\" stands in");
    check_said(CAMERA "\"rgb\"" SMALL "\"string sensor\" \"eye\"", 0,
               "warning: Film: the sensor \"eye\" is not known; \"cie1931\" stands in");
    check_said(CAMERA "\"rgb\"" SMALL "\"float iso\" 0", 1, "error: Film: \"iso\" is 0, it must be above 0");
    check_said(CAMERA "\"rgb\"" SMALL "\"float whitebalance\" 10", 1,
               "error: Film: \"whitebalance\" is 10, it must be from 1000 to 25000 kelvin, or 0");
    check_said(CAMERA "\"rgb\"" SMALL "\"float maxcomponentvalue\" -1", 1,
               "error: Film: \"maxcomponentvalue\" is -1, it must be above 0");
    check_said(CAMERA "\"rgb\"" SMALL "\"float cropwindow\" [ 0 1 0 1 ] \"integer pixelbounds\" [ 0 4 0 4 ]", 0,
               "warning: Film: \"pixelbounds\" is ignored, as there is a \"cropwindow\"");
    check_said(CAMERA "\"rgb\"" SMALL "Sampler \"magic\"", 0,
               "warning: Sampler \"magic\" is not known; our own stands in");
    check_said(CAMERA "\"rgb\"" SMALL "Sampler \"sobol\" \"integer xsamples\" 3", 0,
               "warning: Sampler \"sobol\": \"integer xsamples\" is not known");
    check_said(CAMERA "\"rgb\"" SMALL
                      "Integrator \"sppm\" \"integer photonsperiteration\" 9 \"float radius\" 1 \"integer maxdepth\" 5",
               0,
               "warning: Integrator \"sppm\" is another renderer's: rendering with our own defaults; its "
               "\"photonsperiteration\", \"radius\" and \"maxdepth\" are ignored, paths end by roulette");
}

/* A window whose ends are the wrong way round, as pbrt takes it; and the samples of EXR files. */
static void test_film(void **state)
{
    (void)state;
    static const char *const CASES[][2] = {{"", "half"}, {"\"bool savefp16\" false", "float"}};
    for (int i = 0; i < 2; i++) {
        char head[512];
        snprintf(head, sizeof head,
                 "Camera \"perspective\" Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 64 %s\n"
                 "\"float cropwindow\" [ 0.75 0.25 -1 0.5 ]",
                 CASES[i][0]);
        const char *const arguments[] = {
            "-q",   "--spp", "1",     "--integrator",
            "path", "-o",    "p.exr", scene_of(head, "LightSource \"infinite\" \"rgb L\" [ 0.1 0.1 0.1 ]"),
            NULL};
        program_run run = program_execute(NULL, arguments);
        expect_exit(&run, 0);
        program_run_reset(&run);
        picture p = picture_read(in_folder("p.exr"));
        assert_int_equal(p.width, 32);
        assert_int_equal(p.height, 32);
        bool is_exact = p.pixels[0] == 0.1f; /* half a float cannot hold it */
        assert_int_equal(is_exact, i == 1);
        picture_reset(&p);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_even_light_through_all),
        TEST_IN_FOLDER(test_inside_a_lamp),
        TEST_IN_FOLDER(test_exposure),
        TEST_IN_FOLDER(test_bound),
        TEST_IN_FOLDER(test_white_balance),
        TEST_IN_FOLDER(test_spectrum_of_light),
        TEST_IN_FOLDER(test_seeds),
        TEST_IN_FOLDER(test_what_is_said),
        TEST_IN_FOLDER(test_film),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
