/* test_program_surroundings.c: what may be odd about where and how the program is started: standard files closed, names
 * too long for a mark beside them. No picture is wrong or lost, none is taken for what it is not.
 *
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define SPHERE PROGRAM_SCENES "sphere.pbrt"
#define ROOM   PROGRAM_SCENES "glass_and_metal.pbrt"
#define BOX    PROGRAM_SCENES "box_with_blocks.pbrt"
#define QUICK                                                                                                          \
    "--photons=2000", "--caustic-photons=300", "--spp=1", "--gather-samples=4", "--size=16x12", "--nthreads=2",        \
        "--type=float", "--reproducible"

/* The program run by a shell in the folder of the test; gives its exit code. */
static int run_in_shell(const char *options_and_redirections)
{
    char command[4096];
    snprintf(command, sizeof command, "cd '%s' && exec '%s' %s", folder, program_path(), options_and_redirections);
    int how = system(command);
    return WIFEXITED(how) ? WEXITSTATUS(how) : -1;
}

static void expect_end(program_run run, int code, const char *said)
{
    expect_exit(&run, code);
    if (said)
        expect_said(&run, said);
    program_run_reset(&run);
}

/* --- standard files --- */

#define SHELL_QUICK                                                                                                    \
    "--photons=2000 --caustic-photons=300 --spp=1 --gather-samples=4 --size=16x12 --nthreads=2 --type=float "          \
    "--reproducible "

/* The map, the pictures and what assimp answers are no place for messages. */
static void test_closed_standard_files(void **state)
{
    (void)state;
    static const char *const CLOSED[] = {"2>&-", ">&- 2>&-", "<&- >&- 2>&-", "<&-"};
    expect_end(RUN(QUICK, "-o", "fresh.exr", ROOM), 0, NULL);
    for (int i = 0; i < 4; i++) {
        char command[512];
        unlink(in_folder("a.map"));
        for (int k = 0; k < 2; k++) { /* traced, and opened */
            snprintf(command, sizeof command, SHELL_QUICK "-v --photon-map=a.map -o kept.exr " ROOM " %s", CLOSED[i]);
            assert_int_equal(run_in_shell(command), 0);
            expect_same_files("fresh.exr", "kept.exr");
        }
        expect_end(RUN(QUICK, "--photon-map=a.map", "-o", "kept.exr", ROOM), 0, NULL);
        expect_same_files("fresh.exr", "kept.exr");
    }
    /* what was closed can still not be used */
    assert_int_equal(run_in_shell(SHELL_QUICK "-o b.exr - <&- 2>/dev/null"), 1);
    assert_int_equal(run_in_shell("--help >&- 2>/dev/null"), 3);
    expect_listing("a.map fresh.exr kept.exr");
}

static void test_closed_standard_files_of_importer(void **state)
{
    (void)state;
    write_text("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                        "endfacet\nendsolid a\n");
    expect_end(RUN(QUICK, "-o", "fresh.exr", "a.stl"), 0, NULL);
    assert_int_equal(run_in_shell(SHELL_QUICK "-v -o closed.exr a.stl <&- >&- 2>&-"), 0);
    expect_same_files("fresh.exr", "closed.exr");
}

/* --- pictures that are not finished --- */

/* Whether every pixel has had a sample, as its progress tells. */
static bool has_samples(const program_process *process)
{
    static const char BEFORE[] = "\"phase\": \"render\", \"fraction\": ";
    char *said = program_said(process->err);
    bool has = false;
    for (const char *at = strstr(said, BEFORE); at && !has; at = strstr(at + 1, BEFORE))
        has = strtod(at + sizeof BEFORE - 1, NULL) > 0.0;
    free(said);
    return has;
}

/* Ends a render of minutes as soon as there is something to show. */
static program_run interrupt(const char *name)
{
    const program_setting usual = {0};
    program_process process = program_start(
        &usual, ARGUMENTS("--progress=json", "--integrator=path", "--spp=100000", "--size=24x24", "-o", name, BOX));
    while (!has_samples(&process)) {
        assert_int_equal(kill(process.id, 0), 0);
        program_pause();
    }
    assert_int_equal(kill(process.id, SIGTERM), 0);
    return program_finish(&process);
}

/* A name as long as names may be has its mark all the same. */
static void test_mark_of_long_name(void **state)
{
    (void)state;
    char name[256], path[512];
    memset(name, 'x', 255);
    memcpy(name + 251, ".exr", 5);
    expect_end(interrupt(name), 128 + SIGTERM, "samples per pixel");
    snprintf(path, sizeof path, "%s/%s", folder, name);
    assert_int_equal(access(path, F_OK), 0);
    assert_int_equal(entry_count(), 2);
    /* it is not taken for complete */
    expect_end(RUN("--integrator=path", "--spp=1", "--size=24x24", "--no-clobber", "--progress=none", "-o", name, BOX),
               0, NULL);
    assert_int_equal(entry_count(), 1);
    expect_end(RUN("--integrator=path", "--spp=1", "--size=24x24", "--no-clobber", "--progress=none", "-o", name, BOX),
               0, "skipped");
}

/* Without a mark no partial picture. */
static void test_mark_that_cannot_be_made(void **state)
{
    (void)state;
    assert_int_equal(mkdir(in_folder("a.exr.afterglow-unfinished"), 0755), 0);
    write_text("a.exr", "what was there");
    expect_end(interrupt("a.exr"), 3, "a.exr.afterglow-unfinished");
    expect_text(in_folder("a.exr"), "what was there");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_closed_standard_files),
        TEST_IN_FOLDER(test_closed_standard_files_of_importer),
        TEST_IN_FOLDER(test_mark_of_long_name),
        TEST_IN_FOLDER(test_mark_that_cannot_be_made),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
