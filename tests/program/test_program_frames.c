/* test_program_frames.c: sequences of frames, what is skipped of them, tiles that are the picture's pixels, and
 * progress as render farms read it.
 *
 * Flow: tests of the whole program. Threads: the program's. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define BOX  PROGRAM_SCENES "box_with_blocks.pbrt"
#define TINY "--integrator=path", "--size=8x8", "--spp=1", "--type=float"

static void expect_end(const char *const *arguments, int code, const char *said)
{
    program_run run = program_execute(NULL, arguments);
    expect_exit(&run, code);
    expect_said(&run, said);
    program_run_reset(&run);
}

static void test_frames(void **state)
{
    (void)state;
    expect_end(
        ARGUMENTS(TINY, "--frames=1-5x2,8,11-10", "-o", "a.####.exr", "-o", "b%d.tif", "--stats=s%03d.json", BOX), 0,
        "");
    expect_listing("a.0001.exr a.0003.exr a.0005.exr a.0008.exr a.0010.exr a.0011.exr b1.tif b10.tif b11.tif b3.tif "
                   "b5.tif b8.tif s001.json s003.json s005.json s008.json s010.json s011.json");
    json_t *stats = stats_read(in_folder("s011.json")); /* of its own frame alone */
    assert_int_equal(stats_integer(stats, "rays.camera"), 64);
    json_decref(stats);
    /* the scene's name has a placeholder too; a film that names its file gets one */
    SCENE_WITH("floor.pbrt", "Film \"rgb\"", "Film \"rgb\" \"string filename\" \"f.exr\"");
    assert_int_equal(rename(in_folder("floor.pbrt"), in_folder("floor.7.pbrt")), 0);
    expect_end(ARGUMENTS(TINY, "--frames=7", "floor.#.pbrt"), 0, "");
    assert_int_equal(access(in_folder("f.0007.exr"), F_OK), 0);
    expect_end(ARGUMENTS(TINY, "--frames=7-8", "floor.#.pbrt"), 1, "floor.8.pbrt");
    static const char *const wrong[] = {"--frames=",   "--frames=1-",        "--frames=x", "--frames=1-5x0",
                                        "--frames=1,", "--frames=0-9999999", "--frames=-1"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        expect_end(ARGUMENTS(TINY, wrong[i], "-o", "a.#.exr", BOX), 2, "frames");
    expect_end(ARGUMENTS(TINY, "--frames=1-2", "-o", "a.exr", BOX), 2,
               "'a.exr' has no placeholder for the frame's number");
}

/* A run in which one frame would write over a file that another frame reads or writes is refused before its first
 * frame. */
static void test_frames_in_each_others_files(void **state)
{
    (void)state;
    write_text("sky.2.exr", "a sky");
    expect_end(ARGUMENTS(TINY, "--frames=1-3", "--sky=sky.2.exr", "-o", "sky.#.exr", BOX), 2,
               "'sky.2.exr' is to be written in frame 2, and read in frame 1");
    expect_end(ARGUMENTS(TINY, "--frames=2-3", "--sky=sky.0%d.exr", "-o", "sky.0#.exr", BOX), 2, "in frame");
    expect_end(ARGUMENTS(TINY, "--frames=1-11x5,1", "-o", "a%d.exr", "-o", "a1%d.exr", BOX), 2,
               "' is to be written in frame 1, and written in frame 11, as 'a11.exr");
    SCENE_WITH("floor.pbrt", "WorldBegin",
               "WorldBegin Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"b.3.exr\"");
    picture p = RENDER(BOX, TINY);
    picture_reset(&p);
    expect_end(ARGUMENTS(TINY, "-o", "b.3.exr", BOX), 0, "");
    expect_end(ARGUMENTS(TINY, "--frames=1-3", "-o", "b.#.exr", "floor.pbrt"), 2, "'b.3.exr' is a file of the scene");
    expect_text(in_folder("sky.2.exr"), "a sky");
    assert_int_not_equal(access(in_folder("sky.1.exr"), F_OK), 0);
    assert_int_not_equal(access(in_folder("b.1.exr"), F_OK), 0);
    /* a picture that is there already is skipped: it is not written again, and other frames may read it */
    expect_end(ARGUMENTS(TINY, "--frames=2-3", "--no-clobber", "-o", "b.#.exr", "floor.pbrt"), 0,
               "skipped: 'b.3.exr' is there");
    expect_end(ARGUMENTS(TINY, "--frames=1-3", "--no-clobber", "--sky=b.3.exr", "-o", "b.#.exr", BOX), 0,
               "skipped: 'b.3.exr' is there");
    /* the sky of a frame that is skipped is not read, so that another frame may write it; one of all frames is */
    p = RENDER(BOX, TINY);
    picture_reset(&p);
    expect_end(ARGUMENTS(TINY, "-o", "d.2.exr", BOX), 0, "");
    assert_int_equal(symlink("d.3.exr", in_folder("sky2.exr")), 0);
    assert_int_equal(symlink("b.3.exr", in_folder("sky3.exr")), 0);
    expect_end(ARGUMENTS(TINY, "--frames=2-4", "--no-clobber", "--sky=d.3.exr", "-o", "d.#.exr", BOX), 2,
               "'d.3.exr' is to be written in frame 3, and read in frame 3");
    expect_end(ARGUMENTS(TINY, "--frames=2-3", "--no-clobber", "--sky=sky%d.exr", "-o", "d.#.exr", BOX), 0,
               "skipped: 'd.2.exr' is there");
    expect_end(ARGUMENTS(TINY, "--frames=2-3", "--sky=sky%d.exr", "-o", "d.#.exr", BOX), 2,
               "'d.3.exr' is to be written in frame 3, and read in frame 2");
    /* one map for all frames is no conflict */
    expect_end(ARGUMENTS("--size=8x8", "--spp=1", "--photons=2000", "--frames=1-2", "--photon-map=all.map", "-o",
                         "c.#.exr", BOX),
               0, "");
}

/* Frames without a name for their pictures have one each. */
static void test_frames_without_names(void **state)
{
    (void)state;
    SCENE_WITH("floor.pbrt", "Film \"rgb\"", "Film \"rgb\" ");
    expect_end(ARGUMENTS(TINY, "--frames=7-8", "floor.pbrt"), 0, "");
    expect_listing("floor.0007.exr floor.0008.exr floor.pbrt");
}

static void test_no_clobber(void **state)
{
    (void)state;
    write_text("a.2.exr", "anything");
    write_text("a.3.exr", "a part");
    write_text("a.3.exr.afterglow-unfinished", "");
    expect_end(ARGUMENTS(TINY, "--frames=1-3", "--no-clobber", "-o", "a.#.exr", BOX), 0, "skipped: 'a.2.exr' is there");
    expect_text(in_folder("a.2.exr"), "anything");
    picture p = picture_read(in_folder("a.3.exr"));
    picture_reset(&p);
    expect_listing("a.1.exr a.2.exr a.3.exr");
    /* all of them must be there */
    expect_end(ARGUMENTS(TINY, "--no-clobber", "-o", "a.2.exr", "-o", "b.exr", BOX), 0, "");
    p = picture_read(in_folder("a.2.exr"));
    picture_reset(&p);
}

static void test_tiles(void **state)
{
    (void)state;
#define TILED "--photons=3000", "--gather-samples=4", "--size=16x13", "--spp=2"
    picture whole = RENDER(BOX, TILED, "--cropwindow=0.25,1,0,1");
    int row = 0;
    for (int i = 1; i <= 4; i++) {
        char tile[32];
        snprintf(tile, sizeof tile, "--tile=%d/4", i);
        picture part = RENDER(BOX, TILED, "--cropwindow=0.25,1,0,1", tile);
        assert_int_equal(part.width, whole.width);
        assert_memory_equal(part.pixels, whole.pixels + 3 * row * whole.width,
                            (size_t)(3 * part.width * part.height) * sizeof *part.pixels);
        row += part.height;
        picture_reset(&part);
    }
    assert_int_equal(row, 13);
    picture_reset(&whole);
    expect_end(ARGUMENTS(TINY, "--tile=1/9", "-o", "a.exr", BOX), 2, "more tiles than rows");
    static const char *const wrong[] = {"--tile=0/2", "--tile=3/2", "--tile=1", "--tile=1/2x"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        expect_end(ARGUMENTS(TINY, wrong[i], "-o", "a.exr", BOX), 2, "tile");
}

static void test_progress_for_farms(void **state)
{
    (void)state;
    program_run run = RUN(TINY, "--progress=alf", "--frames=1-2", "-o", "a.#.exr", BOX);
    expect_exit(&run, 0);
    assert_string_equal(run.err, "");
    int before = -1, percent, count = 0;
    for (char *line = strtok(run.out, "\n"); line; line = strtok(NULL, "\n")) {
        int used = 0;
        assert_int_equal(sscanf(line, "ALF_PROGRESS %d%%%n", &percent, &used), 1);
        assert_int_equal(line[used], '\0');
        assert_true(percent > before);
        before = percent;
        count++;
    }
    assert_true(count >= 3);
    assert_int_equal(before, 100);
    program_run_reset(&run);
    run = RUN(TINY, "--progress=lines", "-o", "a.exr", BOX);
    expect_said(&run, "Progress: 100% (write)\n");
    program_run_reset(&run);
    run = RUN(TINY, "--progress=lines", "--frames=7-8", "-o", "a.#.exr", "-o", "b.#.png:uint8", BOX);
    expect_said(&run, "(frame 1 of 2, ");
    expect_said(&run, "Progress: 100% (frame 2 of 2, write)\n");
    expect_said(&run, "afterglow: wrote a.7.exr, b.7.png in 0:0");
    expect_said(&run, "(frame 2 of 2)\n");
    program_run_reset(&run);
    run = RUN(TINY, "--progress=json", "--frames=7-8", "-o", "a.#.exr", BOX);
    expect_said(&run, "\"frame\": 7, \"frame_index\": 1, \"frame_count\": 2");
    expect_said(&run, "{\"written\": [\"a.8.exr\"], \"percent\": 100, ");
    expect_said(&run, "\"frame\": 8, \"frame_index\": 2, \"frame_count\": 2}\n");
    program_run_reset(&run);
    /* a byte that is not UTF-8, and a surrogate, which is none either */
    run = RUN(TINY, "--progress=json", "-o", "a\xff\"\xc3\xa9\xed\xa0\x80.exr", BOX);
    expect_said(&run, "{\"written\": [\"a\\ufffd\\\"\xc3\xa9\\ufffd\\ufffd\\ufffd.exr\"]");
    program_run_reset(&run);
    run = RUN(TINY, "--progress=off", "-o", "a.exr", BOX);
    assert_string_equal(run.err, "");
    program_run_reset(&run);
    run = RUN("--photons=2000", "--size=8x8", "--spp=1", "-v", "--progress=off", "-o", "a.exr", BOX);
    static const char *const rows[] = {
        "time\n",       "  photons ",           "  render ", "  total ", "rays\n", "  gather ", "irradiance\n",
        "  asked for ", "  in the global map ", "  peak "};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        expect_said(&run, rows[i]);
    program_run_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_frames),
        TEST_IN_FOLDER(test_frames_in_each_others_files),
        TEST_IN_FOLDER(test_frames_without_names),
        TEST_IN_FOLDER(test_no_clobber),
        TEST_IN_FOLDER(test_tiles),
        TEST_IN_FOLDER(test_progress_for_farms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
