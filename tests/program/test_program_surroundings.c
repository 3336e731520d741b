/* test_program_surroundings.c: what may be odd about where and how the program is started: standard files closed, names
 * too long for a mark beside them. No picture is wrong or lost, none is taken for what it is not.
 *
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"
#include "fixtures/sanitizer.h"

#define SPHERE PROGRAM_SCENES "sphere.pbrt"
#define ROOM   PROGRAM_SCENES "glass_and_metal.pbrt"
#define BOX    PROGRAM_SCENES "box_with_blocks.pbrt"
#define QUICK                                                                                                          \
    "--photons=2000", "--caustic-photons=300", "--spp=1", "--gather-samples=4", "--size=16x12", "--nthreads=2",        \
        "--type=float", "--reproducible", "--photon-aim=0"

static const program_setting USUAL = {0};

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
    "--reproducible --photon-aim=0 "

/* The map, the pictures and what assimp answers must stay free of messages. */
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
static program_run interrupt(const program_setting *setting, const char *name)
{
    program_process process = program_start(
        setting, ARGUMENTS("--progress=json", "--integrator=path", "--spp=100000", "--size=24x24", "-o", name, BOX));
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
    expect_end(interrupt(&USUAL, name), 128 + SIGTERM, "samples per pixel");
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

/* A mark that cannot be made leaves no partial picture. */
static void test_mark_that_cannot_be_made(void **state)
{
    (void)state;
    assert_int_equal(mkdir(in_folder("a.exr.afterglow-unfinished"), 0755), 0);
    write_text("a.exr", "what was there");
    expect_end(interrupt(&USUAL, "a.exr"), 3, "a.exr.afterglow-unfinished");
    expect_text(in_folder("a.exr"), "what was there");
}

/* --- one file for two things --- */

static void expect_refused(const char *const *arguments, const char *said)
{
    expect_end(program_execute(NULL, arguments), 2, said);
}

/* Before anything is rendered, a file that is named for two purposes is found by name, device and inode, and links. */
static void test_one_file_twice(void **state)
{
    (void)state;
    expect_refused(ARGUMENTS(QUICK, "-o", "q.exr", "--stats=./q.exr", SPHERE),
                   "one file, which is to be written twice");
    expect_refused(ARGUMENTS(QUICK, "-o", "q.exr", "-o", "././q.exr", SPHERE), "written twice");
    expect_refused(ARGUMENTS(QUICK, "-o", "q.exr", "--photon-map=.//q.exr", SPHERE), "written twice");
    expect_refused(ARGUMENTS(QUICK, "-o", "q.exr", "--stats=q.exr.afterglow-unfinished", SPHERE), "written twice");
    expect_refused(ARGUMENTS(QUICK, "-o", "q.exr", "--resume", "--dump-photons=./q.exr.afterglow-checkpoint", SPHERE),
                   "written twice");
    expect_listing("");
    /* links to what is not there yet, over one another too */
    assert_int_equal(mkdir(in_folder("f"), 0755), 0);
    assert_int_equal(symlink("../q.exr", in_folder("f/first")), 0);
    assert_int_equal(symlink("f/first", in_folder("second")), 0);
    expect_refused(ARGUMENTS(QUICK, "-o", "q.exr", "--stats=second", SPHERE), "'q.exr' and 'second' are one file");
    expect_refused(ARGUMENTS(QUICK, "-o", "q.exr", "--photon-map=f/first", SPHERE), "one file");
    expect_refused(ARGUMENTS(QUICK, "-o", "q.exr", "--stats=f/first", "--dump-photons=second", SPHERE), "one file");
    assert_int_equal(unlink(in_folder("second")), 0);
    assert_int_equal(unlink(in_folder("f/first")), 0);
    assert_int_equal(rmdir(in_folder("f")), 0);
    write_text("a.exr", "what was there");
    assert_int_equal(symlink("a.exr", in_folder("b.exr")), 0);
    assert_int_equal(link(in_folder("a.exr"), in_folder("c.exr")), 0);
    expect_refused(ARGUMENTS(QUICK, "-o", "a.exr", "-o", "b.exr", SPHERE), "'a.exr' and 'b.exr' are one file");
    expect_refused(ARGUMENTS(QUICK, "-o", "c.exr", "-o", "a.exr", SPHERE), "one file");
    expect_text(in_folder("a.exr"), "what was there");
    /* devices and pipes may be named twice */
    expect_end(RUN(QUICK, "-o", "d.exr", "--stats=/dev/null", "--dump-photons=/dev/null", "--progress=none", SPHERE), 0,
               NULL);
    expect_listing("a.exr b.exr c.exr d.exr");
}

static void test_output_that_is_input(void **state)
{
    (void)state;
    expect_end(RUN(QUICK, "-o", "picture.exr", SPHERE), 0, NULL);
    assert_int_equal(symlink("picture.exr", in_folder("link.exr")), 0);
    SCENE_WITH("sphere.pbrt", "WorldBegin", "WorldBegin\nInclude \"part.pbrt\"\n");
    write_text("part.pbrt", "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"picture.exr\"\n");
    write_text("mesh.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
               "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
               "3 0 1 2\n");
    size_t size;
    unsigned char *before = read_bytes(in_folder("picture.exr"), &size);
    expect_refused(ARGUMENTS(QUICK, "-o", "a.exr", "--stats=sphere.pbrt", "sphere.pbrt"), "'sphere.pbrt' is read");
    expect_refused(ARGUMENTS(QUICK, "-o", "a.exr", "--stats=./sphere.pbrt", "sphere.pbrt"), "is read");
    expect_refused(ARGUMENTS(QUICK, "-o", "a.exr", "--stats=part.pbrt", "sphere.pbrt"), "is a file of the scene");
    expect_refused(ARGUMENTS(QUICK, "-o", "./picture.exr", "sphere.pbrt"), "is a file of the scene");
    expect_refused(ARGUMENTS(QUICK, "-o", "link.exr", "sphere.pbrt"), "is a file of the scene");
    expect_refused(ARGUMENTS(QUICK, "-o", "a.exr", "--photon-map=part.pbrt", "sphere.pbrt"), "is a file of the scene");
    expect_refused(ARGUMENTS(QUICK, "-o", "a.exr", "--dump-photons=mesh.ply", "mesh.ply"), "is read");
    expect_refused(ARGUMENTS(QUICK, "-o", "a.png", "--stats=config.ocio", "--ocio=./config.ocio", SPHERE), "is read");
    expect_end(RUN(QUICK, "-o", "a.exr", "--progress=none", "sphere.pbrt"), 0, NULL);
    size_t size_after;
    unsigned char *after = read_bytes(in_folder("picture.exr"), &size_after);
    assert_int_equal(size_after, size);
    assert_memory_equal(after, before, size);
    free(before);
    free(after);
    expect_listing("a.exr link.exr mesh.ply part.pbrt picture.exr sphere.pbrt");
}

/* A glTF scene's buffers and pictures, and an OBJ scene's materials, are its files too. */
static void test_output_that_is_a_models_input(void **state)
{
    (void)state;
    write_text("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    write_text("a.mtl", "newmtl m\nKd 1 1 1\n");
    expect_refused(ARGUMENTS(QUICK, "-o", "a.exr", "--stats=a.mtl", "a.obj"), "is a file of the scene");
    expect_refused(ARGUMENTS(QUICK, "-o", "a.exr", "--stats=a.obj", "a.obj"), "is read");
    expect_listing("a.mtl a.obj");
}

/* A text file is not replaced by a map, whatever is asked for. */
static void test_refresh_of_what_is_no_map(void **state)
{
    (void)state;
    write_text("a.map", "a letter, of which there is no copy, and which is longer than a page of a map's header\n");
    expect_end(RUN(QUICK, "--photon-map=a.map", "--photon-map-refresh", "-o", "a.exr", ROOM), 1, "it is no photon map");
    expect_text(in_folder("a.map"),
                "a letter, of which there is no copy, and which is longer than a page of a map's header\n");
    write_text("a.map", "short");
    expect_end(RUN(QUICK, "--photon-map=a.map", "--photon-map-refresh", "-o", "a.exr", ROOM), 1, "it is no photon map");
    expect_text(in_folder("a.map"), "short");
    write_text("a.map", ""); /* nothing is lost */
    expect_end(RUN(QUICK, "--photon-map=a.map", "--photon-map-refresh", "-o", "a.exr", ROOM), 0, NULL);
    expect_listing("a.exr a.map");
}

/* --- what would be waited for --- */

#define EMPTY_SCENE "Camera \"perspective\"\nWorldBegin\nLightSource \"point\"\n"

/* A FIFO, a device or a folder is no file of a scene, wherever the scene names it. */
static void test_inputs_are_regular_files(void **state)
{
    (void)state;
    static const struct {
        const char *scene, *text, *said;
    } CASES[] = {
        {"a.pbrt", EMPTY_SCENE "Shape \"plymesh\" \"string filename\" \"fifo\"\n", "fifo: it is not a regular file"},
        {"b.pbrt", EMPTY_SCENE "Include \"fifo\"\n", "b.pbrt:4:9: error: cannot read the file \"fifo\""},
        {"c.pbrt", EMPTY_SCENE "Include \"/dev/zero\"\n", "c.pbrt:4:9: error: cannot read the file \"/dev/zero\""},
        {"d.pbrt", EMPTY_SCENE "Import \"/dev/zero\"\n", "d.pbrt:4:8: error: cannot read the file \"/dev/zero\""},
        {"e.pbrt", EMPTY_SCENE "LightSource \"point\" \"spectrum I\" \"fifo\"\n", "not a regular file"},
        {"f.pbrt", EMPTY_SCENE "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"fifo\"\n",
         "not a regular file"},
        {"g.pbrt", EMPTY_SCENE "LightSource \"infinite\" \"string filename\" \"fifo\"\n", "not a regular file"},
        {"h.gltf",
         "{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [{\"byteLength\": 36, \"uri\": \"fifo\"}],"
         "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}],"
         "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\"}],"
         "\"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}], \"nodes\": [{\"mesh\": 0}],"
         "\"scenes\": [{\"nodes\": [0]}]}",
         "not a regular file"},
    };
    assert_int_equal(mkfifo(in_folder("fifo"), 0600), 0);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        write_text(CASES[i].scene, CASES[i].text);
        expect_end(RUN(QUICK, "-o", "a.exr", CASES[i].scene), 1, CASES[i].said);
    }
    static const char *const WHOLE[] = {"fifo",     "fifo.ply", "fifo.obj", "fifo.gltf",
                                        "fifo.glb", "fifo.stl", "/dev/zero"};
    for (int i = 0; i < 7; i++) {
        if (i > 0 && i < 6)
            assert_int_equal(mkfifo(in_folder(WHOLE[i]), 0600), 0);
        expect_end(RUN(QUICK, "-o", "a.exr", WHOLE[i]), 1, "not a regular file");
    }
    /* a library that is not there is a warning, and one that cannot be read as well */
    write_text("a.obj", "mtllib fifo\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expect_end(RUN(QUICK, "-o", "b.exr", "a.obj"), 0, "not a regular file");
    expect_end(RUN(QUICK, "--ocio=fifo", "-o", "a.exr", SPHERE), 1, "not a regular file");
    assert_int_equal(mkfifo(in_folder("a.exr.afterglow-checkpoint"), 0600), 0);
    expect_end(RUN(QUICK, "--resume", "-o", "a.exr", SPHERE), 1, "not a regular file");
    assert_int_not_equal(access(in_folder("a.exr"), F_OK), 0);
}

/* Includes are bounded in size and in number, and the error has a location. */
static void test_includes_are_bounded(void **state)
{
    (void)state;
    char name[32], text[64];
    write_text("huge.pbrt", "");
    assert_int_equal(truncate(in_folder("huge.pbrt"), (off_t)17 << 30), 0);
    write_text("a.pbrt", EMPTY_SCENE "Include \"huge.pbrt\"\n");
    expect_end(RUN(QUICK, "-o", "a.exr", "a.pbrt"), 1,
               "a.pbrt:4:9: error: cannot read the file \"huge.pbrt\": it is larger");
    for (int i = 0; i < 20; i++) { /* a million empty files */
        snprintf(name, sizeof name, "double%d.pbrt", i);
        snprintf(text, sizeof text, "Include \"double%d.pbrt\" Include \"double%d.pbrt\"\n", i + 1, i + 1);
        write_text(name, text);
    }
    write_text("double20.pbrt", "");
    write_text("b.pbrt", EMPTY_SCENE "Include \"double0.pbrt\"\n");
    expect_end(RUN(QUICK, "-o", "a.exr", "b.pbrt"), 1, "error: more than 100000 files are included: double");
    assert_int_not_equal(access(in_folder("a.exr"), F_OK), 0);
}

/* The first signal ends the reading of a standard input that brings nothing, or no end. */
static void test_signal_ends_reading(void **state)
{
    (void)state;
    assert_int_equal(mkfifo(in_folder("pipe"), 0600), 0);
    int writer = open(in_folder("pipe"), O_RDWR);
    assert_true(writer >= 0);
    static const char *const INPUTS[] = {"pipe", "/dev/zero"};
    for (int i = 0; i < 2; i++) {
        char input[160];
        snprintf(input, sizeof input, "%s", INPUTS[i][0] == '/' ? INPUTS[i] : in_folder(INPUTS[i]));
        const program_setting piped = {.input = input};
        program_process process = program_start(&piped, ARGUMENTS("--progress=json", "-o", "a.exr", "-"));
        while (!program_catches(process.id, SIGTERM))
            program_pause();
        for (int k = 0; k < 20; k++) /* it has begun to read, most likely */
            program_pause();
        assert_int_equal(kill(process.id, SIGTERM), 0);
        expect_end(program_finish(&process), 128 + SIGTERM, "no picture was written");
    }
    close(writer);
    expect_listing("pipe");
}

/* A picture into a pipe waits for its reader; a signal ends the wait, and the exit code says that the picture is
 * lost. */
static void test_pipe_as_output(void **state)
{
    (void)state;
    const program_setting usual = {0};
    assert_int_equal(mkfifo(in_folder("pipe.exr"), 0600), 0);
    program_process process = program_start(&usual, ARGUMENTS(QUICK, "--progress=json", "-o", "pipe.exr", SPHERE));
    program_wait_for(&process, "'pipe.exr' is a pipe");
    assert_int_equal(kill(process.id, SIGTERM), 0);
    expect_end(program_finish(&process), 3, "cannot write 'pipe.exr': it is a pipe that nobody reads");

    /* a reader that reads nothing: more than a pipe holds */
    process = program_start(&usual, ARGUMENTS(QUICK, "--size=200x200", "--progress=json", "-o", "pipe.exr", SPHERE));
    program_wait_for(&process, "'pipe.exr' is a pipe");
    int reader = open(in_folder("pipe.exr"), O_RDONLY);
    assert_true(reader >= 0);
    char magic[4];
    assert_int_equal(read(reader, magic, 4), 4);
    assert_int_equal(kill(process.id, SIGTERM), 0);
    expect_end(program_finish(&process), 3, "cannot write 'pipe.exr'");
    close(reader);

    /* a reader that comes late, and takes all */
    expect_end(RUN(QUICK, "--size=200x200", "-o", "file.exr", SPHERE), 0, NULL);
    process = program_start(&usual, ARGUMENTS(QUICK, "--size=200x200", "--progress=json", "-o", "pipe.exr", SPHERE));
    program_wait_for(&process, "'pipe.exr' is a pipe");
    char command[256];
    snprintf(command, sizeof command, "cd '%s' && cat pipe.exr >copy.exr", folder);
    assert_int_equal(system(command), 0);
    expect_end(program_finish(&process), 0, NULL);
    expect_same_files("file.exr", "copy.exr");
}

/* --- what is short --- */

/* The picture of a shell that limits something. */
static void expect_limited_run(const char *limit, int code)
{
    char command[512];
    snprintf(command, sizeof command, "cd '%s' && ulimit %s && exec '%s' " SHELL_QUICK "--aov=all -o limited.exr " ROOM,
             folder, limit, program_path());
    int how = system(command);
    assert_true(WIFEXITED(how)); /* no signal ended it */
    assert_int_equal(WEXITSTATUS(how), code);
}

static void test_small_stack(void **state)
{
    (void)state;
    expect_end(RUN(QUICK, "--aov=all", "-o", "fresh.exr", ROOM), 0, NULL);
    /* below 32 the loader itself runs out of it at times: the kernel leaves up to 8 KiB unused, by chance */
    static const char *const LIMITS[] = {"-s 32", "-s 64", "-s 512"};
    for (int i = 0; i < 3; i++) {
        expect_limited_run(LIMITS[i], 0);
        expect_same_files("fresh.exr", "limited.exr");
    }
    write_text("a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                        "endfacet\nendsolid a\n");
    char command[512];
    snprintf(command, sizeof command, "cd '%s' && ulimit -s 64 && exec '%s' " SHELL_QUICK "-o stl.exr a.stl", folder,
             program_path());
    assert_int_equal(system(command), 0);
}

/* A signal that comes to a program on a small stack ends it in order all the same. */
static void test_signal_on_small_stack(void **state)
{
    (void)state;
    const program_setting small = {.stack_limit = 64 << 10};
    expect_end(interrupt(&small, "a.exr"), 128 + SIGTERM, "samples per pixel");
    expect_listing("a.exr a.exr.afterglow-unfinished");
}

/* Where no threads can be had, whoever wants them, the exit code is 3, and it is said why. As nobody, since root has no
 * such limit; what else nobody runs counts as well, so the limits that let the program begin are found by trying. */
static void test_few_threads(void **state)
{
    (void)state;
    if (geteuid() != 0) {
        print_message("SKIPPED: threads can be limited for another user alone, by root\n");
        return;
    }
    assert_int_equal(chmod(folder, 0777), 0);
    for (rlim_t limit = 1; limit <= 12; limit++) {
        const program_setting setting = {.is_nobody = true, .process_limit = limit};
        program_run run = program_execute(&setting, ARGUMENTS("-q", "-t4", "--spp=1", "--size=8x8", "--photons=300",
                                                              "--gather-samples=2", "-o", "a.exr", SPHERE));
        if (run.exit_code != 0) {
            expect_exit(&run, 3);
            expect_said(&run, "error: ");
        }
        program_run_reset(&run);
    }
}

/* Too little memory is called that, by whichever library it is that finds none. With the least limits the loader ends
 * the program, with its code 127. */
static void test_small_address_space(void **state)
{
    (void)state;
    if (IS_SANITIZED) {
        print_message("SKIPPED: sanitizers reserve more addresses than the limits allow\n");
        return;
    }
    for (int kib = 40000; kib <= 400000; kib += 20000) {
        char command[512];
        snprintf(command, sizeof command,
                 "cd '%s' && ulimit -v %d && exec '%s' -q " SHELL_QUICK "-o a.exr " SPHERE " 2>said", folder, kib,
                 program_path());
        const int how = system(command), code = WIFEXITED(how) ? WEXITSTATUS(how) : -1;
        size_t size;
        char *said = (char *)read_bytes(in_folder("said"), &size);
        const bool is_code = memmem(said, size, "(error", 6) != NULL;
        if ((code != 0 && code != 3 && code != 127) || is_code)
            fail_msg("%d KiB: exit code %d; it said: %.*s", kib, code, (int)size, said);
        free(said);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_closed_standard_files),
        TEST_IN_FOLDER(test_closed_standard_files_of_importer),
        TEST_IN_FOLDER(test_mark_of_long_name),
        TEST_IN_FOLDER(test_mark_that_cannot_be_made),
        TEST_IN_FOLDER(test_one_file_twice),
        TEST_IN_FOLDER(test_output_that_is_input),
        TEST_IN_FOLDER(test_output_that_is_a_models_input),
        TEST_IN_FOLDER(test_refresh_of_what_is_no_map),
        TEST_IN_FOLDER(test_inputs_are_regular_files),
        TEST_IN_FOLDER(test_includes_are_bounded),
        TEST_IN_FOLDER(test_signal_ends_reading),
        TEST_IN_FOLDER(test_pipe_as_output),
        TEST_IN_FOLDER(test_small_stack),
        TEST_IN_FOLDER(test_signal_on_small_stack),
        TEST_IN_FOLDER(test_few_threads),
        TEST_IN_FOLDER(test_small_address_space),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
