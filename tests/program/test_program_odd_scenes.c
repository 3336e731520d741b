/* test_program_odd_scenes.c: scenes that hold a mistake, and the one warning at the end that names it; and scenes that
 * look like them and are right.
 *
 * Flow: tests of the whole program. Threads: the program's. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define QUICK "-v", "--size=24x24", "--spp=4", "--photons=2000", "--caustic-photons=2000", "--type=float", "-o", "a.exr"

#define CAMERA    "LookAt 0 0 3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 50\nWorldBegin\n"
#define SKY       "LightSource \"infinite\" \"rgb L\" [0.5 0.5 0.5]\n"
#define BALL      "Shape \"sphere\" \"float radius\" 1\n"
#define PLAIN     "Material \"diffuse\"\n"
#define ELSEWHERE "Translate 0 0 9\n"

static int count_of(const char *text, const char *part)
{
    int count = 0;
    for (const char *at = text; (at = strstr(at, part)) != NULL; at++)
        count++;
    return count;
}

/* The last thing but the noise that is said, and said once; NULL: no warning. */
static void expect_warning(const char *text, const char *option, const char *warning)
{
    for (int i = 0; i < 2; i++) { /* by both integrators */
        program_run run = RUN(QUICK, i == 0 ? "--integrator=photonmap" : "--integrator=path",
                              option ? option : "--seed=1", write_text("a.pbrt", text));
        expect_exit(&run, 0);
        if (count_of(run.err, "warning: ") != (warning ? 1 : 0) || (warning && !strstr(run.err, warning)))
            fail_msg("'%s' is not what is said once: %s", warning ? warning : "nothing", run.err);
        program_run_reset(&run);
    }
}

static void test_no_light(void **state)
{
    (void)state;
    expect_warning(CAMERA PLAIN BALL, NULL, "the scene has no light that emits: the picture is black");
    expect_warning(CAMERA "LightSource \"point\" \"rgb I\" [0 0 0]\n" PLAIN BALL, NULL,
                   "the scene has no light that emits");
    expect_warning(CAMERA SKY PLAIN BALL, NULL, NULL);
}

static void test_nothing_in_view(void **state)
{
    (void)state;
    expect_warning(CAMERA SKY, NULL, "nothing is in view: the scene has no shapes");
    expect_warning(CAMERA SKY PLAIN ELSEWHERE BALL, NULL,
                   "nothing is in view: the camera at (0, 0, 3) looks along (0, 0, -1), and the shapes lie between "
                   "(-1, -1, 8) and (1, 1, 10)");
    /* a part of a picture in which there is something elsewhere */
    expect_warning(CAMERA SKY PLAIN BALL, "--cropwindow=0,0.1,0,0.1", NULL);
}

static void test_all_black(void **state)
{
    (void)state;
    /* lit from behind alone, and not to be seen through */
    expect_warning(CAMERA "LightSource \"distant\" \"point3 from\" [0 0 -1] \"point3 to\" [0 0 0]\n" PLAIN
                          "Shape \"disk\" \"float radius\" 9\n",
                   NULL, "the picture is black: no light comes to what is in view");
    expect_warning(CAMERA "LightSource \"distant\" \"point3 from\" [0 0 -1] \"point3 to\" [0 0 0]\n" PLAIN
                          "Shape \"disk\" \"float radius\" 9\n",
                   "--tile=1/2", NULL);
}

/* A ball of glass full of fog, in the sun: no shadow ray leaves the fog through the glass, and no message says that no
 * light comes there. A fog that is told of and not used is none. */
static void test_sun_on_murky_glass(void **state)
{
    (void)state;
    static const char *const FOG = "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0 0 0]\n",
                             *const SUN = "LightSource \"distant\" \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]\n";
    static const struct {
        const char *inside;
        int with_fog; /* warnings that tell of fog, by both integrators together */
    } BALLS[] = {{"MediumInterface \"fog\" \"\"\n", 2}, {"", 0}};
    for (size_t i = 0; i < sizeof BALLS / sizeof *BALLS; i++) {
        char text[1024];
        int with_fog = 0;
        snprintf(text, sizeof text, CAMERA "%s%s%sMaterial \"dielectric\"\n" BALL, FOG, SUN, BALLS[i].inside);
        for (int k = 0; k < 2; k++) {
            bool is_map = k == 0, is_told = !is_map || BALLS[i].with_fog > 0;
            program_run run =
                RUN(QUICK, is_map ? "--integrator=photonmap" : "--integrator=path", write_text("a.pbrt", text));
            expect_exit(&run, 0);
            with_fog += count_of(run.err, "media scatter it");
            assert_int_equal(count_of(run.err, "by way of smooth glass is missing"), is_told);
            assert_int_equal(count_of(run.err, "black: no other light comes to what is in view"), is_told);
            assert_int_equal(count_of(run.err, "black: no light comes to what is in view"), !is_told);
            program_run_reset(&run);
        }
        assert_int_equal(with_fog, BALLS[i].with_fog);
    }
}

/* A panel behind the eye whose faces were turned round, and one whose faces are right. */
static void test_panel_turned_round(void **state)
{
    (void)state;
    static const struct {
        const char *panel;
        bool is_told;
    } PANELS[] = {
        {"Translate 0 0 5 Shape \"disk\" AttributeEnd\n", true},
        {"Translate 0 0 5 ReverseOrientation Shape \"disk\" AttributeEnd\n", false},
    };
    for (size_t i = 0; i < sizeof PANELS / sizeof *PANELS; i++) {
        char text[1024];
        snprintf(text, sizeof text, "%s%s", CAMERA PLAIN BALL "AttributeBegin AreaLightSource \"diffuse\"\n",
                 PANELS[i].panel);
        program_run run = RUN(QUICK, "--integrator=path", write_text("a.pbrt", text));
        expect_exit(&run, 0);
        assert_int_equal(strstr(run.err, "shines away from everything that there is") != NULL, PANELS[i].is_told);
        program_run_reset(&run);
    }
}

static void test_inside_solid(void **state)
{
    (void)state;
    expect_warning("LookAt 0 0 0.2  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\n" SKY PLAIN BALL, NULL,
                   "the camera is inside of a solid");
    /* glass lets light in, and a room whose walls look inwards is no solid */
    expect_warning("LookAt 0 0 0.2  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\n" SKY
                   "Material \"dielectric\"\n" BALL PLAIN "Translate 0 0 -9\nShape \"disk\" \"float radius\" 9\n",
                   NULL, NULL);
    expect_warning("LookAt 0 0 0.2  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\n" SKY PLAIN
                   "ReverseOrientation\n" BALL,
                   NULL, "the picture is black");
    /* that solid with a lamp in it is a room */
    expect_warning("LookAt 0 0 0.2  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\n"
                   "LightSource \"point\" \"rgb I\" [1 1 1]\n" PLAIN BALL,
                   NULL, NULL);
}

/* A hall of a thousand metres with the lamp of a room, measured in thousandths of that, and the other way round. */
static void test_scale(void **state)
{
    (void)state;
    const char *hall = "LookAt 0 0 1400  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 50\nWorldBegin\n"
                       "LightSource \"point\" \"point3 from\" [0 0 1000] \"rgb I\" [%g %g %g]\n" PLAIN
                       "Shape \"sphere\" \"float radius\" 500\n";
    static const struct {
        double intensity;
        const char *warning, *stops;
    } CASES[] = {
        {1.0, "too dark to be seen", "--exposure 20"}, {1e6, NULL, NULL}, {1e12, "too bright", "--exposure -15"}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[1024];
        double I = CASES[i].intensity;
        snprintf(text, sizeof text, hall, I, I, I);
        expect_warning(text, NULL, CASES[i].warning);
        if (!CASES[i].warning)
            continue;
        program_run run = RUN(QUICK, in_folder("a.pbrt"));
        expect_said(&run, "are both in the same units?");
        expect_said(&run, "across and its lights emit");
        expect_said(&run, CASES[i].stops);
        program_run_reset(&run);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_no_light),
        TEST_IN_FOLDER(test_nothing_in_view),
        TEST_IN_FOLDER(test_all_black),
        TEST_IN_FOLDER(test_sun_on_murky_glass),
        TEST_IN_FOLDER(test_panel_turned_round),
        TEST_IN_FOLDER(test_inside_solid),
        TEST_IN_FOLDER(test_scale),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
