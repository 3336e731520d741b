/* test_program_files.c: the files that the program writes: names, formats, sizes, parts of pictures; and that on a full
 * disk or in a closed folder it fails with 3, and leaves what was there.
 *
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#include <zlib.h>

#define SPHERE PROGRAM_SCENES "sphere.pbrt"
#define QUICK  "--photons=300", "--spp=1", "--gather-samples=2", "--size=8x6"

static void expect_begins(const char *name, const char *bytes, size_t count)
{
    size_t size;
    unsigned char *file = read_bytes(in_folder(name), &size);
    assert_true(size > count);
    assert_memory_equal(file, bytes, count);
    free(file);
}

/* A window of an EXR's header: x and y of the first and last pixel. */
static void exr_window(const char *name, const char *window, int out_window[4])
{
    char attribute[64];
    size_t size, length = (size_t)snprintf(attribute, sizeof attribute, "%s%cbox2i%c", window, 0, 0);
    unsigned char *file = read_bytes(in_folder(name), &size);
    const unsigned char *at = memmem(file, size, attribute, length);
    assert_non_null(at);
    memcpy(out_window, at + length + 4, 4 * sizeof *out_window); /* behind the attribute's size */
    free(file);
}

static void test_every_format_at_once(void **state)
{
    (void)state;
    program_run run = RUN("-q", QUICK, "-o", "a.exr", "-o", "b.png", "--outfile=c.tif", "-o", "d.jpg", "-o", "E.EXR",
                          "--stats=f.json", SPHERE);
    expect_exit(&run, 0);
    assert_string_equal(run.out, "");
    assert_string_equal(run.err, "");
    program_run_reset(&run);
    expect_listing("E.EXR a.exr b.png c.tif d.jpg f.json");
    expect_begins("a.exr", "\x76\x2f\x31\x01", 4);
    expect_begins("E.EXR", "\x76\x2f\x31\x01", 4);
    expect_begins("b.png", "\x89PNG\r\n\x1a\n", 8);
    expect_begins("c.tif", "II*\0", 4);
    expect_begins("d.jpg", "\xff\xd8\xff", 3);
    static const char *const NAMES[] = {"a.exr", "E.EXR", "b.png", "c.tif", "d.jpg"};
    for (int i = 0; i < 5; i++) {
        picture p = picture_read(in_folder(NAMES[i]));
        assert_int_equal(p.width, 8);
        assert_int_equal(p.height, 6);
        assert_true(picture_mean(&p, 0) > 0.1);
        picture_reset(&p);
    }
}

/* Float and half say the same; equal runs give equal files. */
static void test_types(void **state)
{
    (void)state;
    picture as_float = RENDER(SPHERE, QUICK);
    program_run run = RUN("-q", "--reproducible", QUICK, "-o", "half.exr", "-o", "again.exr", SPHERE);
    expect_exit(&run, 0);
    program_run_reset(&run);
    picture as_half = picture_read(in_folder("half.exr"));
    for (int i = 0; i < 3 * 8 * 6; i++)
        expect_near("half", (double)as_half.pixels[i], (double)as_float.pixels[i], 0.0005);
    expect_same_files("half.exr", "again.exr");
    picture_reset(&as_float);
    picture_reset(&as_half);
}

static void test_names_that_nobody_gave(void **state)
{
    (void)state;
    const char *scene = SCENE_WITH("sphere.pbrt", "Film \"rgb\"", "Film \"rgb\" \"string filename\" \"mine.exr\"");
    program_run run = RUN("-q", QUICK, scene);
    expect_exit(&run, 0);
    program_run_reset(&run);
    expect_listing("mine.exr sphere.pbrt");
    run = RUN("-q", QUICK, SPHERE); /* into the working folder, not to the scene's */
    expect_exit(&run, 0);
    program_run_reset(&run);
    expect_listing("mine.exr sphere.exr sphere.pbrt");
    const program_setting piped = {.input = SPHERE};
    run = program_execute(&piped, ARGUMENTS("-q", QUICK, "-"));
    expect_exit(&run, 0);
    program_run_reset(&run);
    expect_listing("afterglow.exr mine.exr sphere.exr sphere.pbrt");
    /* a name of the scene's that cannot be written is the scene's mistake */
    scene = SCENE_WITH("sphere.pbrt", "Film \"rgb\"", "Film \"rgb\" \"string filename\" \"mine.xyz\"");
    run = RUN("-q", QUICK, scene);
    expect_exit(&run, 1);
    expect_said(&run, "mine.xyz");
    program_run_reset(&run);
}

static void test_gzip_and_standard_input(void **state)
{
    (void)state;
    size_t size;
    unsigned char *text = read_bytes(SPHERE, &size);
    gzFile packed = gzopen(in_folder("packed.pbrt.gz"), "wb");
    assert_non_null(packed);
    assert_int_equal(gzwrite(packed, text, (unsigned)size), size);
    assert_int_equal(gzclose(packed), Z_OK);
    free(text);
    picture plain = RENDER(SPHERE, QUICK), from_packed = RENDER("packed.pbrt.gz", QUICK);
    const program_setting piped = {.input = in_folder("packed.pbrt.gz")};
    program_run run = program_execute(&piped, ARGUMENTS("-q", QUICK, "--type=float", "-o", "piped.exr", "-"));
    expect_exit(&run, 0);
    program_run_reset(&run);
    picture from_pipe = picture_read(in_folder("piped.exr"));
    assert_memory_equal(from_packed.pixels, plain.pixels, 3 * 8 * 6 * sizeof *plain.pixels);
    assert_memory_equal(from_pipe.pixels, plain.pixels, 3 * 8 * 6 * sizeof *plain.pixels);
    picture_reset(&plain);
    picture_reset(&from_packed);
    picture_reset(&from_pipe);
    run = RUN("-q", QUICK, "packed.pbrt.gz");
    expect_exit(&run, 0);
    program_run_reset(&run);
    expect_listing("packed.exr packed.pbrt.gz picture.exr piped.exr");
}

/* The pixels from ceil(x0 width) to ceil(x1 width) - 1, at their position in the full picture. */
static void test_size_and_crop(void **state)
{
    (void)state;
    static const char *const ONE_CAMERA_RAY[] = {"--gather-samples=4", "--integrator=path"}; /* of each sample */
    for (int k = 0; k < 2; k++) {
        program_run run = RUN("-q", "--photons=300", "--spp=1", ONE_CAMERA_RAY[k], "--size=50x40",
                              "--cropwindow=0.11,0.5,0.25,0.9", "-o", "a.exr", "-o", "a.png", "--stats=a.json", SPHERE);
        expect_exit(&run, 0);
        program_run_reset(&run);
        int data[4], display[4];
        exr_window("a.exr", "dataWindow", data);
        exr_window("a.exr", "displayWindow", display);
        static const int DATA[4] = {6, 10, 24, 35}, DISPLAY[4] = {0, 0, 49, 39};
        assert_memory_equal(data, DATA, sizeof data);
        assert_memory_equal(display, DISPLAY, sizeof display);
        picture p = picture_read(in_folder("a.png"));
        assert_int_equal(p.width, 19);
        assert_int_equal(p.height, 26);
        picture_reset(&p);
        json_t *stats = stats_read(in_folder("a.json"));
        assert_int_equal(stats_integer(stats, "image.width"), 50);
        assert_int_equal(stats_integer(stats, "image.height"), 40);
        assert_int_equal(stats_integer(stats, "rays.camera"), 19 * 26);
        json_decref(stats);
    }
}

/* ---- when files cannot be written ---- */

static void test_full_disk(void **state)
{
    (void)state;
    assert_int_equal(symlink("/dev/full", in_folder("full.exr")), 0);
    program_run run = RUN("-q", QUICK, "-o", "full.exr", SPHERE);
    expect_exit(&run, 3);
    expect_said(&run, "error: ");
    expect_said(&run, "full.exr");
    program_run_reset(&run);
    run = RUN("-q", QUICK, "-o", "a.exr", "--stats=/dev/full", SPHERE);
    expect_exit(&run, 3);
    expect_said(&run, "/dev/full");
    program_run_reset(&run);
    expect_listing("a.exr full.exr"); /* the picture was complete before */
}

/* A limit that falls into the middle of the file: what was there stays, nothing is left beside it. */
static void test_file_that_grows_too_large(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"a.exr", "a.png", "a.tif", "a.jpg"};
    for (int i = 0; i < 4; i++) {
        write_text(NAMES[i], "what was there");
        const program_setting limited = {.file_size_limit = 512};
        program_run run = program_execute(
            &limited, ARGUMENTS("-q", "--photons=300", "--spp=1", "--size=64x64", "-o", NAMES[i], SPHERE));
        expect_exit(&run, 3);
        expect_said(&run, "error: ");
        expect_said(&run, NAMES[i]);
        program_run_reset(&run);
        expect_text(in_folder(NAMES[i]), "what was there");
    }
    expect_listing("a.exr a.jpg a.png a.tif");
}

static void test_folder_that_is_closed(void **state)
{
    (void)state;
    assert_int_equal(mkdir(in_folder("closed"), 0755), 0);
    write_text("closed/a.exr", "what was there");
    assert_int_equal(chmod(in_folder("closed"), 0555), 0);
    const program_setting nobody = {.is_nobody = true};
    static const char *const WHERE[][2] = {{"-o", "closed/a.exr"},
                                           {"-o", "closed/b.exr"},
                                           {"-o", "none/a.exr"},
                                           {"-o", "."},
                                           {"--stats", "closed/a.json"}};
    for (int i = 0; i < 5; i++) {
        /* checked before the work: this would take hours */
        program_run run = program_execute(&nobody, ARGUMENTS("-q", "--spp=1000000", WHERE[i][0], WHERE[i][1], SPHERE));
        expect_exit(&run, i == 3 ? 2 : 3);
        expect_said(&run, "error: ");
        program_run_reset(&run);
    }
    expect_text(in_folder("closed/a.exr"), "what was there");
    assert_int_equal(chmod(in_folder("closed"), 0755), 0);
    expect_listing("closed");
}

/* Where one of several files fails the exit code is 3, and each other file is whole. */
static void test_one_of_several_fails(void **state)
{
    (void)state;
    assert_int_equal(symlink("/dev/full", in_folder("full.png")), 0);
    assert_int_equal(symlink("/dev/full", in_folder("full.ply")), 0);
    static const char *const ORDERS[][3] = {{"-oa.exr", "-ofull.png", "-t2"},
                                            {"-ofull.png", "-oa.exr", "-t2"},
                                            {"-oa.exr", "-t2", "--dump-photons=full.ply"}};
    for (int i = 0; i < 3; i++) {
        unlink(in_folder("a.exr"));
        unlink(in_folder("a.json"));
        program_run run =
            RUN(QUICK, "--progress=json", "--stats=a.json", ORDERS[i][0], ORDERS[i][1], ORDERS[i][2], SPHERE);
        expect_exit(&run, 3);
        expect_said(&run, i < 2 ? "'full.png': No space left on device" : "'full.ply': No space left on device");
        expect_said(&run, "{\"written\": [\"a.exr\"], ");
        program_run_reset(&run);
        picture p = picture_read(in_folder("a.exr"));
        assert_int_equal(p.width, 8);
        picture_reset(&p);
        expect_listing("a.exr a.json full.ply full.png");
    }
    program_run run = RUN(QUICK, "--progress=json", "-ofull.png", SPHERE);
    expect_exit(&run, 3);
    assert_null(strstr(run.err, "written"));
    program_run_reset(&run);

    const char *const photons[] = {"--photons=300",
                                   "--photons-only",
                                   "--dump-photons=full.ply",
                                   "--photon-map=a.map",
                                   "--stats=photons.json",
                                   SPHERE,
                                   NULL};
    run = program_execute(NULL, photons);
    expect_exit(&run, 3);
    program_run_reset(&run);
    json_t *stats = stats_read(in_folder("photons.json"));
    assert_string_equal(json_string_value(stats_find(stats, "end.reason")), "photons");
    json_decref(stats);
    expect_listing("a.exr a.json a.map full.ply full.png photons.json");
}

/* An error before the picture is made leaves a file of its name as it was. */
static void test_old_picture_outlives_an_error(void **state)
{
    (void)state;
    write_text("a.exr", "what was there");
    write_text("a.json", "and here");
    const char *scene = write_text("bad.pbrt", "WorldBegin\nShape\n");
    program_run run = RUN("-q", "-o", "a.exr", "--stats=a.json", scene);
    expect_exit(&run, 1);
    program_run_reset(&run);
    expect_text(in_folder("a.exr"), "what was there");
    expect_text(in_folder("a.json"), "and here");
    expect_listing("a.exr a.json bad.pbrt");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_every_format_at_once),
        TEST_IN_FOLDER(test_types),
        TEST_IN_FOLDER(test_names_that_nobody_gave),
        TEST_IN_FOLDER(test_gzip_and_standard_input),
        TEST_IN_FOLDER(test_size_and_crop),
        TEST_IN_FOLDER(test_full_disk),
        TEST_IN_FOLDER(test_file_that_grows_too_large),
        TEST_IN_FOLDER(test_folder_that_is_closed),
        TEST_IN_FOLDER(test_one_of_several_fails),
        TEST_IN_FOLDER(test_old_picture_outlives_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
