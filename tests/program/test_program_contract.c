/* test_program_contract.c: what the program promises to who calls it: exit codes, what is said where and how, and that
 * a run that fails leaves nothing behind.
 *
 * Flow: tests of the whole program. Threads: the program's. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define SPHERE PROGRAM_SCENES "sphere.pbrt"
/* A picture in next to no time. */
#define QUICK "--photons=300", "--spp=1", "--gather-samples=2", "--size=8x6"

static const program_setting USUAL = {0};

static int line_count(const char *text)
{
    int count = 0;
    for (; *text; text++)
        count += *text == '\n';
    return count;
}

/* ---- the command line ---- */

static void test_usage(void **state)
{
    (void)state;
    static const char *const WRONG[][3] = {
        {NULL},
        {"scene.pbrt", "other.pbrt"},
        {"--unknown", "scene.pbrt"},
        {"-z", "scene.pbrt"},
        {"scene.pbrt", "-o"},
        {"scene.pbrt", "--spp"},
        {"--spp=0", "scene.pbrt"},
        {"--spp=1.5", "scene.pbrt"},
        {"--spp=-3", "scene.pbrt"},
        {"--spp=99999999999999999999", "scene.pbrt"},
        {"-t0", "scene.pbrt"},
        {"--nthreads=none", "scene.pbrt"},
        {"--nthreads=", "scene.pbrt"},
        {"--seed=-1", "scene.pbrt"},
        {"--seed=x", "scene.pbrt"},
        {"--size=100", "scene.pbrt"},
        {"--size=0x10", "scene.pbrt"},
        {"--size=10x70000", "scene.pbrt"},
        {"--size=10x10x10", "scene.pbrt"},
        {"--cropwindow=0,1,0", "scene.pbrt"},
        {"--cropwindow=0.5,0.5,0,1", "scene.pbrt"},
        {"--cropwindow=0,1,0,1.5", "scene.pbrt"},
        {"--cropwindow=nan,1,0,1", "scene.pbrt"},
        {"--integrator=bdpt", "scene.pbrt"},
        {"--cache=some", "scene.pbrt"},
        {"--only=direct", "scene.pbrt"},
        {"--photons=0", "scene.pbrt"},
        {"--photons=1e10", "scene.pbrt"},
        {"--photons=0.5", "scene.pbrt"},
        {"--caustic-photons=-1", "scene.pbrt"},
        {"--nearest=0", "scene.pbrt"},
        {"--radius=-1", "scene.pbrt"},
        {"--radius=nan", "scene.pbrt"},
        {"--radius=inf", "scene.pbrt"},
        {"--irradiance-fraction=0", "scene.pbrt"},
        {"--irradiance-fraction=-0.5", "scene.pbrt"},
        {"--irradiance-fraction=1.01", "scene.pbrt"},
        {"--irradiance-fraction=nan", "scene.pbrt"},
        {"--irradiance-fraction=half", "scene.pbrt"},
        {"--gather-samples=0", "scene.pbrt"},
        {"--gather-guiding=-0.1", "scene.pbrt"},
        {"--gather-guiding=1.01", "scene.pbrt"},
        {"--gather-guiding=nan", "scene.pbrt"},
        {"--gather-guiding=much", "scene.pbrt"},
        {"--pane-light=on", "scene.pbrt"},
        {"--direct-guiding=-0.1", "scene.pbrt"},
        {"--direct-guiding=0.81", "scene.pbrt"},
        {"--direct-guiding=nan", "scene.pbrt"},
        {"--photon-aim=-0.1", "scene.pbrt"},
        {"--photon-aim=0.81", "scene.pbrt"},
        {"--photon-aim=nan", "scene.pbrt"},
        {"--photon-aim=all", "scene.pbrt"},
        {"--max-depth=-1", "scene.pbrt"},
        {"--max-depth=101", "scene.pbrt"},
        {"--type=double", "scene.pbrt"},
        {"--progress=yes", "scene.pbrt"},
        {"--isa=mmx", "scene.pbrt"},
        {"-o", "picture.gif", SPHERE},
        {"-o", "picture", SPHERE},
        {"-o", "", SPHERE},
        {"--outfile=picture.png", "--type=half", SPHERE},
        {"-osame.png", "-osame.png", SPHERE},
        {"-osame.png", "--stats=same.png", SPHERE},
    };
    for (size_t i = 0; i < sizeof WRONG / sizeof *WRONG; i++) {
        program_run run = program_execute(&USUAL, ARGUMENTS(WRONG[i][0], WRONG[i][1], WRONG[i][2]));
        expect_exit(&run, 2);
        assert_string_equal(run.out, "");
        assert_true(strlen(run.err) > 10);
        /* what is wrong is named: the value where there is one */
        const char *value = WRONG[i][0] ? strchr(WRONG[i][0], '=') : NULL;
        if (value)
            expect_said(&run, value + 1);
        program_run_reset(&run);
    }
    expect_listing("");
}

static void test_help_and_version(void **state)
{
    (void)state;
    program_run help = RUN("--help"); /* only two of the three modes give one picture, bit for bit */
    assert_non_null(strstr(help.out, "same bits"));
    assert_non_null(strstr(help.out, "with other bits"));
    program_run_reset(&help);
    static const char *const OPTIONS[] = {"-o, --outfile",
                                          "-t, --nthreads",
                                          "--seed",
                                          "--spp",
                                          "--size",
                                          "--cropwindow",
                                          "--integrator",
                                          "--cache",
                                          "--confine",
                                          "--confine-to",
                                          "--only",
                                          "--photons",
                                          "--caustic-photons",
                                          "--nearest",
                                          "--radius",
                                          "--irradiance-fraction",
                                          "--gather-samples",
                                          "--gather-guiding",
                                          "--pane-light",
                                          "--photon-aim",
                                          "--direct-guiding",
                                          "--max-depth",
                                          "--ocio",
                                          "--display",
                                          "--view",
                                          "--stats",
                                          "--progress",
                                          "--isa",
                                          "-q, --quiet",
                                          "-v, --verbose",
                                          "--help",
                                          "--version"};
    program_run run = RUN("--help");
    expect_exit(&run, 0);
    assert_string_equal(run.err, "");
    for (size_t i = 0; i < sizeof OPTIONS / sizeof *OPTIONS; i++)
        if (!strstr(run.out, OPTIONS[i]))
            fail_msg("--help does not tell of %s", OPTIONS[i]);
    program_run_reset(&run);

    char version[64];
    snprintf(version, sizeof version, "afterglow %s\n", ag_version());
    run = RUN("--version");
    expect_exit(&run, 0);
    assert_string_equal(run.out, version);
    assert_string_equal(run.err, "");
    program_run_reset(&run);

    const program_setting full = {.output = "/dev/full"};
    run = program_execute(&full, ARGUMENTS("--help"));
    expect_exit(&run, 3);
    program_run_reset(&run);
}

/* ---- scenes ---- */

static void test_scene_errors_name_the_location(void **state)
{
    (void)state;
    write_text("inner.pbrt", "# a comment\n\n    Shape \"banana\"\n");
    const char *outer = write_text("outer.pbrt", "Camera \"perspective\"\nWorldBegin\nInclude \"inner.pbrt\"\n");
    const char *direct =
        write_text("direct.pbrt",
                   "Camera \"perspective\"\nWorldBegin\n  Material \"diffuse\" \"rgb reflectance\" [0.1 oops 0.3]\n");
    write_text("late.pbrt", "Film \"rgb\" \"integer xresolution\" 0\nCamera \"perspective\"\nWorldBegin\n");
    static const char *const QUIET[] = {NULL, "-q"};
    for (int i = 0; i < 2; i++) {
        program_run run = RUN("-o", "a.exr", "--stats=a.json", outer, QUIET[i]);
        expect_exit(&run, 1);
        expect_said(&run, "inner.pbrt:3:5: error: ");
        expect_said(&run, "banana");
        assert_string_equal(run.out, "");
        program_run_reset(&run);
        run = RUN("-o", "a.exr", direct, QUIET[i]);
        expect_exit(&run, 1);
        expect_said(&run, "direct.pbrt:3:45: error: ");
        expect_said(&run, "oops");
        program_run_reset(&run);
        run = RUN("-o", "a.exr", "late.pbrt", QUIET[i]);
        expect_exit(&run, 1);
        expect_said(&run, "late.pbrt:1:12: error: ");
        program_run_reset(&run);
    }
    /* standard input has a name too */
    const program_setting piped = {.input = direct};
    program_run run = program_execute(&piped, ARGUMENTS("-q", "-o", "a.exr", "-"));
    expect_exit(&run, 1);
    expect_said(&run, ":3:45: error: ");
    program_run_reset(&run);
    expect_listing("direct.pbrt inner.pbrt late.pbrt outer.pbrt");
}

static void test_scenes_that_cannot_be_read(void **state)
{
    (void)state;
    static const char *const SCENES[] = {"none.pbrt", ".", "cut.pbrt.gz"};
    write_text("cut.pbrt.gz", "\x1f\x8b\x08");
    for (int i = 0; i < 3; i++) {
        program_run run = RUN("-q", "-o", "a.exr", SCENES[i]);
        expect_exit(&run, 1);
        expect_said(&run, SCENES[i]);
        expect_said(&run, ": error: ");
        program_run_reset(&run);
    }
    expect_listing("cut.pbrt.gz");
}

static void test_scene_without_camera(void **state)
{
    (void)state;
    const char *scene = write_text("scene.pbrt", "WorldBegin\nLightSource \"point\"\nShape \"sphere\"\n");
    program_run run = RUN("-q", "-o", "a.exr", scene);
    expect_exit(&run, 1);
    expect_said(&run, "error: ");
    expect_said(&run, "Camera");
    program_run_reset(&run);
    expect_listing("scene.pbrt");
}

/* A scene without light is no error: the picture is black, and a warning says why. */
static void test_scene_without_light(void **state)
{
    (void)state;
    const char *scene =
        write_text("scene.pbrt", "Camera \"perspective\"\nWorldBegin\nTranslate 0 0 3\nShape \"sphere\"\n");
    static const char *const INTEGRATORS[] = {"--integrator=photonmap", "--integrator=path"};
    for (int k = 0; k < 2; k++) {
        program_run run = RUN(QUICK, "--progress=none", INTEGRATORS[k], "-o", "a.exr", "--stats=a.json", scene);
        expect_exit(&run, 0);
        expect_said(&run, "warning: ");
        expect_said(&run, "no light");
        assert_int_equal(line_count(run.err), 1);
        program_run_reset(&run);
        picture p = picture_read(in_folder("a.exr"));
        for (int i = 0; i < 3 * p.width * p.height; i++)
            assert_true(p.pixels[i] == 0.0f);
        picture_reset(&p);
    }
    expect_listing("a.exr a.json scene.pbrt");
}

/* A scene with nothing to see still gives a picture. */
static void test_empty_scene(void **state)
{
    (void)state;
    const char *scene = write_text("scene.pbrt", "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\n");
    static const char *const INTEGRATORS[] = {"--integrator=photonmap", "--integrator=path"};
    for (int k = 0; k < 2; k++) {
        program_run run = RUN(QUICK, "-q", INTEGRATORS[k], "-o", "a.exr", scene);
        expect_exit(&run, 0);
        program_run_reset(&run);
    }
    expect_listing("a.exr scene.pbrt");
}

/* A scene that names another renderer's integrator gets one line of warning; neither of our integrators heeds its
 * depth. */
static void test_other_integrators(void **state)
{
    (void)state;
    const char *scene =
        write_text("scene.pbrt", "Integrator \"volpath\" \"integer maxdepth\" 1\nInclude \"" SPHERE "\"\n");
    static const char *const INTEGRATORS[] = {"photonmap", "path"};
    for (int k = 0; k < 2; k++) {
        program_run run = RUN("--photons=2000", "--spp=16", "--size=8x8", "--progress=none", "--integrator",
                              INTEGRATORS[k], "-o", "a.exr", scene);
        expect_exit(&run, 0);
        assert_int_equal(line_count(run.err), 1);
        expect_said(&run, "scene.pbrt:1:1: warning: ");
        expect_said(&run, "volpath");
        expect_said(&run, "maxdepth");
        program_run_reset(&run);
        picture p = picture_read(in_folder("a.exr"));
        /* 0.796 in all; to depth 1 it would be half of that */
        expect_near(INTEGRATORS[k], picture_mean(&p, 1), 0.795775, 0.1);
        picture_reset(&p);
    }
}

/* The scene's own integrator counts, and the command line counts more. */
static void test_own_integrator(void **state)
{
    (void)state;
    const char *scene = SCENE_WITH("sphere.pbrt", "Camera ",
                                   "Integrator \"photonmap\" \"integer indirectphotons\" 700 \"integer nused\" 20"
                                   " \"integer finalgathersamples\" 3 \"integer maxdepth\" 4\n"
                                   "Sampler \"independent\" \"integer pixelsamples\" 5\nCamera ");
    program_run run = RUN("--progress=none", "--size=4x4", "-o", "a.exr", "--stats=a.json", scene);
    expect_exit(&run, 0);
    assert_string_equal(run.err, "");
    program_run_reset(&run);
    json_t *stats = stats_read(in_folder("a.json"));
    assert_int_equal(stats_integer(stats, "photons.stored_global"), 700);
    assert_int_equal(stats_integer(stats, "settings.nearest"), 20);
    assert_int_equal(stats_integer(stats, "settings.gather_samples"), 3);
    assert_int_equal(stats_integer(stats, "settings.max_depth"), 4);
    assert_int_equal(stats_integer(stats, "image.samples_per_pixel"), 5);
    json_decref(stats);
    run = RUN(QUICK, "--progress=none", "--nearest=30", "--max-depth=7", "-o", "a.exr", "--stats=a.json", scene);
    expect_exit(&run, 0);
    program_run_reset(&run);
    stats = stats_read(in_folder("a.json"));
    assert_int_equal(stats_integer(stats, "photons.stored_global"), 300);
    assert_int_equal(stats_integer(stats, "settings.nearest"), 30);
    assert_int_equal(stats_integer(stats, "settings.gather_samples"), 2);
    assert_int_equal(stats_integer(stats, "settings.max_depth"), 7);
    assert_int_equal(stats_integer(stats, "image.samples_per_pixel"), 1);
    json_decref(stats);
}

/* ---- colour ---- */

static void test_color_config_errors(void **state)
{
    (void)state;
    const program_setting own = {.ocio = "/nonexistent/config.ocio"};
    program_run run = program_execute(&own, ARGUMENTS("-q", QUICK, "-o", "a.png", SPHERE));
    expect_exit(&run, 1);
    expect_said(&run, "error: ");
    expect_said(&run, "/nonexistent/config.ocio");
    expect_said(&run, "$OCIO");
    program_run_reset(&run);
    run = RUN("-q", QUICK, "--ocio=none.ocio", "-o", "a.png", SPHERE);
    expect_exit(&run, 1);
    expect_said(&run, "none.ocio");
    program_run_reset(&run);
    /* --ocio is stronger than $OCIO */
    write_text("bad.ocio", "this is no config");
    run = program_execute(&own, ARGUMENTS("-q", QUICK, "--ocio=bad.ocio", "-o", "a.png", SPHERE));
    expect_exit(&run, 1);
    expect_said(&run, "bad.ocio");
    program_run_reset(&run);
    expect_listing("bad.ocio");
}

static void test_unknown_display_and_view(void **state)
{
    (void)state;
    program_run run = RUN("-q", QUICK, "--display=none", "-o", "a.png", SPHERE);
    expect_exit(&run, 1);
    expect_said(&run, "'none'");
    expect_said(&run, "sRGB"); /* the spaces that there are */
    program_run_reset(&run);
    run = RUN("-q", QUICK, "--view=none", "-o", "a.png", SPHERE);
    expect_exit(&run, 1);
    expect_said(&run, "'none'");
    expect_said(&run, "'Raw'");
    program_run_reset(&run);
    expect_listing("");
}

static void test_own_color_config(void **state)
{
    (void)state;
    static const char *const CONFIG = AG_SOURCE_DIR "/scene/color/config.ocio";
    static const char *const OLD_CONFIG = AG_SOURCE_DIR "/renderer/config.ocio";
    const char *config = access(CONFIG, R_OK) == 0 ? CONFIG : OLD_CONFIG;
    const program_setting own = {.ocio = config};
    program_run run = program_execute(&own, ARGUMENTS("-q", QUICK, "--view=Raw", "-o", "a.png", SPHERE));
    expect_exit(&run, 0);
    assert_string_equal(run.err, "");
    program_run_reset(&run);
    const program_setting bad = {.ocio = "/nonexistent/config.ocio"};
    run = program_execute(&bad, ARGUMENTS("-q", QUICK, "--ocio", config, "--view=Raw", "-o", "b.png", SPHERE));
    expect_exit(&run, 0);
    program_run_reset(&run);
    size_t a_size, b_size;
    unsigned char *a = read_bytes(in_folder("a.png"), &a_size), *b = read_bytes(in_folder("b.png"), &b_size);
    assert_int_equal(a_size, b_size);
    assert_memory_equal(a, b, a_size);
    free(a);
    free(b);
    expect_listing("a.png b.png");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_usage),
        TEST_IN_FOLDER(test_help_and_version),
        TEST_IN_FOLDER(test_scene_errors_name_the_location),
        TEST_IN_FOLDER(test_scenes_that_cannot_be_read),
        TEST_IN_FOLDER(test_scene_without_camera),
        TEST_IN_FOLDER(test_scene_without_light),
        TEST_IN_FOLDER(test_empty_scene),
        TEST_IN_FOLDER(test_other_integrators),
        TEST_IN_FOLDER(test_own_integrator),
        TEST_IN_FOLDER(test_color_config_errors),
        TEST_IN_FOLDER(test_unknown_display_and_view),
        TEST_IN_FOLDER(test_own_color_config),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
