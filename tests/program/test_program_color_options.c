/* test_program_color_options.c: the options about colour and what they refuse, the listing of configs, and what
 * OpenColorIO itself has to say. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define ACES AG_SOURCE_DIR "/tests/color/aces.ocio"

static void options_that_make_no_sense(void **state)
{
    (void)state;
    const char *scene = write_text("scene.pbrt", "Camera \"perspective\" WorldBegin\n");
    static const struct {
        const char *arguments[6], *said;
        int exit;
    } CASES[] = {
        {{"--view=Plain", "-o", "a.exr"}, "--view is for pictures that are not .exr", 2},
        {{"--display=Monitor", "-o", "a.exr"}, "--display is for", 2},
        {{"--look=Warm", "-o", "a.EXR"}, "--look is for", 2},
        {{"--exposure=1", "-o", "a.exr"}, "--exposure is for", 2},
        {{"--exposure=bright", "-o", "a.png"}, "'bright' is not valid", 2},
        {{"--exposure=nan", "-o", "a.png"}, "'nan' is not valid", 2},
        {{"--output-space=AP0", "-o", "a.png"}, "--output-space is for .exr, .hdr and .pfm files", 2},
        {{"--list-displays"}, "--list-displays renders nothing", 2},
        {{"--look=Cold", "-o", "a.png"}, "unknown look 'Cold'; the OpenColorIO config has: 'Warm', 'Flat'", 1},
        {{"--view=Bright", "-o", "a.png"}, "unknown view 'Bright'; display 'Monitor' has: ", 1},
        {{"--output-space=AP9", "-o", "a.exr"}, "unknown colour space 'AP9'; the OpenColorIO config has: ", 1},
        {{"--working-space=AP9", "-o", "a.exr"}, "unknown colour space 'AP9'; the OpenColorIO config has: ", 1},
        {{"--working-space=Log", "-o", "a.exr"}, "the working space 'Log' is not linear", 1},
        {{"--working-space=Numbers", "-o", "a.exr"}, "is of data", 1},
        {{"--display=Phone", "-o", "a.png"},
         "unknown display 'Phone'; the OpenColorIO config has: 'Monitor', 'Cinema'",
         1},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        const char *all[12] = {"-q", "--ocio", ACES};
        int count = 3;
        for (int k = 0; k < 6 && CASES[i].arguments[k]; k++)
            all[count++] = CASES[i].arguments[k];
        all[count++] = scene;
        program_run run = program_execute(NULL, all);
        expect_exit(&run, CASES[i].exit);
        expect_said(&run, CASES[i].said);
        program_run_reset(&run);
    }
    program_run run = RUN("--list-displays", "-o", "a.exr");
    expect_exit(&run, 2);
    program_run_reset(&run);
    expect_listing("scene.pbrt");
}

static void configs_and_their_listing(void **state)
{
    (void)state;
    program_run run = RUN("--list-displays", "--ocio", ACES);
    expect_exit(&run, 0);
    assert_string_equal(run.err, "");
    static const char *const TOLD[] = {"config: aces-for-tests\n",
                                       "working space: AP1\n",
                                       "  Monitor (default)\n    Plain (default)\n    Graded, with the looks Warm\n",
                                       "  Warm\n  Flat\n",
                                       "  AP1 (working)\n",
                                       "  scene_linear: AP1\n"};
    for (size_t i = 0; i < sizeof TOLD / sizeof *TOLD; i++)
        assert_non_null(strstr(run.out, TOLD[i]));
    program_run_reset(&run);
    static const program_setting EMPTY = {.ocio = ""}, GONE = {.ocio = "/nowhere/config.ocio"}, OWN = {.ocio = ACES};
    run = program_execute(&EMPTY, ARGUMENTS("--list-displays")); /* as if it were not set */
    expect_exit(&run, 0);
    assert_non_null(strstr(run.out, "working space: Linear Rec.709 (sRGB)\n"));
    program_run_reset(&run);
    run = program_execute(&OWN, ARGUMENTS("--list-displays"));
    assert_non_null(strstr(run.out, "config: aces-for-tests\n"));
    program_run_reset(&run);
    run = program_execute(&GONE, ARGUMENTS("--list-displays"));
    expect_exit(&run, 1);
    expect_said(&run, "$OCIO");
    assert_string_equal(run.out, "");
    program_run_reset(&run);

    /* damaged: every beginning of it is a config or an error, never an end */
    size_t size;
    unsigned char *whole = read_bytes(ACES, &size);
    for (size_t part = 0; part < size; part += size / 12 + 1) {
        FILE *file = fopen(in_folder("part.ocio"), "wb");
        assert_non_null(file);
        assert_int_equal(fwrite(whole, 1, part, file), part);
        assert_int_equal(fclose(file), 0);
        run = RUN("--list-displays", "--ocio=part.ocio");
        assert_true(run.exit_code == 0 || run.exit_code == 1);
        if (run.exit_code == 1)
            expect_said(&run, "afterglow: error: ");
        program_run_reset(&run);
    }
    free(whole);
}

static int occurrences(const char *text, const char *part)
{
    int count = 0;
    for (const char *at = strstr(text, part); at; at = strstr(at + 1, part))
        count++;
    return count;
}

/* Messages of OpenColorIO come as all others do: once, by level, and not at all where the program is to be quiet. */
static void what_the_library_says(void **state)
{
    (void)state;
    size_t size;
    char *text = (char *)read_bytes(ACES, &size), *more = malloc(size + 100);
    assert_non_null(more);
    sprintf(more, "%s\nmystery: 3\n", text);
    write_text("odd.ocio", more);
    free(text);
    free(more);
#define ODD "--size=8x8", "--spp=1", "--integrator=path", "--ocio=odd.ocio", "-o", "a.exr", "-o", "a.png", "-o", "b.png"
    program_run run = RUN("-q", ODD, PROGRAM_SCENES "floor.pbrt");
    expect_exit(&run, 0);
    assert_string_equal(run.err, "");
    program_run_reset(&run);
    run = RUN("--progress=off", ODD, PROGRAM_SCENES "floor.pbrt");
    expect_exit(&run, 0);
    expect_said(&run, "afterglow: warning: OpenColorIO: Unknown key in profile: 'mystery'.\n");
    assert_int_equal(occurrences(run.err, "OpenColorIO"), 1);
    program_run_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(what_the_library_says),
        TEST_IN_FOLDER(options_that_make_no_sense),
        TEST_IN_FOLDER(configs_and_their_listing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
