/* test_program_outputs.c: several files of one picture, each with samples of its own type; Radiance and PFM; seeds of
 * frames; what was meant by an option that there is not.
 *
 * Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"

#define BOX  PROGRAM_SCENES "box_with_blocks.pbrt"
#define TINY "-q", "--integrator=path", "--size=9x7", "--spp=1"

static void expect_end(const char *const *arguments, int code, const char *said)
{
    program_run run = program_execute(NULL, arguments);
    expect_exit(&run, code);
    expect_said(&run, said);
    program_run_reset(&run);
}

/* 1 half, 2 float: of the first channel in an EXR file. */
static int exr_type(const char *name)
{
    unsigned char *channels = attribute_of(name, "channels", "chlist");
    assert_non_null(channels);
    int type = channels[strlen((char *)channels) + 1];
    free(channels);
    return type;
}

static void each_file_has_its_type(void **state)
{
    (void)state;
    expect_end(ARGUMENTS(TINY, "-o", "a.exr:float", "-o", "b.exr", "-o", "c.png", "-o", "d.png:uint16", BOX), 0, "");
    expect_listing("a.exr b.exr c.png d.png");
    assert_int_equal(exr_type("a.exr"), 2);
    assert_int_equal(exr_type("b.exr"), 1);
    size_t size;
    unsigned char *png = read_bytes(in_folder("c.png"), &size);
    assert_int_equal(png[24], 8); /* the header's bit depth */
    free(png);
    png = read_bytes(in_folder("d.png"), &size);
    assert_int_equal(png[24], 16);
    free(png);
    /* --type is of those that name none, wherever it stands */
    expect_end(ARGUMENTS(TINY, "-o", "a.exr", "-o", "b.exr:half", "--type=float", BOX), 0, "");
    assert_int_equal(exr_type("a.exr"), 2);
    assert_int_equal(exr_type("b.exr"), 1);
    expect_end(ARGUMENTS(TINY, "-o", "a.exr:uint8", BOX), 2, ".exr cannot hold samples of the type asked for");
    expect_end(ARGUMENTS(TINY, "-o", "a.png:odd", BOX), 2, "a.png:odd: the name must end in");
    expect_end(ARGUMENTS(TINY, "-o", "a.exr:float", "-o", "a.exr:half", BOX), 2, "is to be written twice");
    expect_end(ARGUMENTS(TINY, "--frames=3", "-o", "f#.exr:float", BOX), 0, "");
    assert_int_equal(exr_type("f3.exr"), 2);
}

/* PFM holds the floats of the EXR to the last bit, Radiance to the eight bits of its mantissas. */
static void other_linear_files_hold_the_same(void **state)
{
    (void)state;
    expect_end(ARGUMENTS(TINY, "--aov=N", "-o", "a.exr:float", "-o", "a.pfm", "-o", "a.hdr", "-o", "b.exr:float", BOX),
               0, "");
    expect_end(ARGUMENTS(TINY, "-o", "plain.exr:float", BOX), 0, "");
    picture exr = picture_read(in_folder("plain.exr"));
    size_t size;
    unsigned char *pfm = read_bytes(in_folder("a.pfm"), &size);
    static const char HEADER[] = "PF\n9 7\n-1.0\n";
    assert_int_equal(size, sizeof HEADER - 1 + 9 * 7 * 3 * sizeof(float));
    assert_memory_equal(pfm, HEADER, sizeof HEADER - 1);
    for (int y = 0; y < 7; y++)
        assert_memory_equal(pfm + sizeof HEADER - 1 + (size_t)(6 - y) * 27 * sizeof(float), exr.pixels + 27 * y,
                            27 * sizeof(float));
    free(pfm);
    picture hdr = picture_read(in_folder("a.hdr"));
    assert_int_equal(hdr.width, 9);
    assert_int_equal(hdr.height, 7);
    for (int i = 0; i < 9 * 7; i++) {
        const float *a = exr.pixels + 3 * i, *b = hdr.pixels + 3 * i;
        const float most = fmaxf(a[0], fmaxf(a[1], a[2]));
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(a[c] - b[c]) <= most / 127.0f);
    }
    picture_reset(&hdr);
    picture_reset(&exr);
    expect_end(ARGUMENTS(TINY, "--exposure=1", "-o", "a.hdr", "-o", "a.pfm", BOX), 2,
               "--exposure is for pictures that");
    expect_end(ARGUMENTS(TINY, "--aov=N", "-o", "a.hdr", BOX), 2, "--aov is for .exr files");
    expect_end(ARGUMENTS(TINY, "-o", "a.hdr:half", BOX), 2, "cannot hold samples of the type");
}

static void expect_equal(const char *name, const char *other, bool is_equal)
{
    picture a = picture_read(in_folder(name)), b = picture_read(in_folder(other));
    assert_int_equal(a.width * a.height, b.width * b.height);
    assert_int_equal(memcmp(a.pixels, b.pixels, (size_t)(3 * a.width * a.height) * sizeof *a.pixels) == 0, is_equal);
    picture_reset(&a);
    picture_reset(&b);
}

static void frames_may_have_seeds_of_their_own(void **state)
{
    (void)state;
    expect_end(ARGUMENTS(TINY, "--seed=13", "-o", "13.exr:float", BOX), 0, "");
    expect_end(ARGUMENTS(TINY, "--seed=10", "-o", "10.exr:float", BOX), 0, "");
    expect_end(ARGUMENTS(TINY, "--seed=10", "--frames=3-4", "-o", "one.#.exr:float", BOX), 0, "");
    expect_equal("one.3.exr", "one.4.exr", true);
    expect_equal("one.3.exr", "10.exr", true);
    expect_end(ARGUMENTS(TINY, "--seed=10", "--seed-per-frame", "--frames=3-4", "-o", "own.#.exr:float", BOX), 0, "");
    expect_equal("own.3.exr", "13.exr", true);
    expect_equal("own.4.exr", "13.exr", false);
    expect_end(ARGUMENTS(TINY, "--seed=%d", "--frames=13", "-o", "named.#.exr:float", BOX), 0, "");
    expect_equal("named.13.exr", "13.exr", true);
    expect_end(ARGUMENTS(TINY, "--seed=1#", "--frames=0,3", "-o", "named.#.exr:float", BOX), 0, "");
    expect_equal("named.0.exr", "10.exr", true);
    expect_equal("named.3.exr", "13.exr", true);
    expect_end(ARGUMENTS(TINY, "--seed=%d", "-o", "a.exr", BOX), 2, "is for --frames, which is not given");
    expect_end(ARGUMENTS(TINY, "--seed-per-frame", "-o", "a.exr", BOX), 2, "--seed-per-frame is for --frames");
    expect_end(ARGUMENTS(TINY, "--seed=x%d", "--frames=1", "-o", "a.#.exr", BOX), 2, "--seed: 'x%d' is not valid");
}

#define SMALL "--photons=2000", "--caustic-photons=100", "--gather-samples=2", "--size=9x7", "--noise=0", "--spp=2"

static void frames_of_one_photon_map_may_have_seeds_of_their_own(void **state)
{
    (void)state;
    expect_end(ARGUMENTS(SMALL, "--seed=10", "--seed-per-frame", "--photon-map=one.map", "--frames=3-4", "-v", "-o",
                         "kept.#.exr:float", BOX),
               0, "'one.map': a map of");
    expect_equal("kept.3.exr", "kept.4.exr", false);
    expect_end(ARGUMENTS(SMALL, "-q", "--seed=14", "--photon-seed=10", "--photon-aim=0", "-o", "fresh.exr:float", BOX),
               0, "");
    expect_equal("kept.4.exr", "fresh.exr", true);
    expect_end(ARGUMENTS(SMALL, "-q", "--seed=14", "--photon-map=one.map", "-o", "other.exr", BOX), 1,
               "another seed of photons: 10, not 14");
}

static void frames_may_have_maps_and_skies_of_their_own(void **state)
{
    (void)state;
    expect_end(ARGUMENTS(SMALL, "-q", "--photon-map=m#.map", "--frames=3-4", "-o", "a.%d.exr", BOX), 0, "");
    expect_listing("a.3.exr a.4.exr m3.map m4.map");
    expect_end(ARGUMENTS(SMALL, "-q", "--size=8x4", "-o", "sky.03.exr", BOX), 0, "");
    expect_end(ARGUMENTS(SMALL, "-q", "--sky=sky.%02d.exr", "--frames=3", "-o", "b.#.exr", BOX), 0, "");
    expect_end(ARGUMENTS(SMALL, "-q", "--sky=sky.%02d.exr", "--frames=4", "-o", "b.#.exr", BOX), 1, "sky.04.exr");
}

static void what_was_meant_is_named(void **state)
{
    (void)state;
    static const char *const MEANT[][2] = {
        {"--samples", "there is no option --samples: did you mean --spp?"},
        {"--samples=4", "there is no option --samples: did you mean --spp?"},
        {"--sampels=4", "there is no option --sampels: did you mean --spp?"},
        {"--resoluton=4x4", "did you mean --size?"},
        {"--resolution=4x4", "did you mean --size?"},
        {"--threds=2", "did you mean --nthreads?"},
        {"--nhtreads=2", "did you mean --nthreads?"},
        {"--threads=2", "did you mean --nthreads?"},
        {"--hdri=a.exr", "did you mean --sky?"},
        {"--max-bounces=2", "did you mean --max-depth?"},
        {"--denoize", "did you mean --denoise?"},
        {"--integrater=path", "did you mean --integrator?"},
        {"--job=2", "did you mean --nthreads?"},
        {"--logs=a.txt", "there is no option --logs\n"}, /* two slips of four letters are another word */
        {"--zyxwvutsr", "there is no option --zyxwvutsr\n"},
        {"--camera-", "--camera- is the beginning of several options: --camera-from, --camera-to, --camera-up"},
        {"-Z", "there is no option -Z"},
        {"--no-lights=1", "--no-lights takes no value"},
        {"--spp", "--spp needs a value: "},
    };
    for (size_t i = 0; i < sizeof MEANT / sizeof *MEANT; i++)
        expect_end(ARGUMENTS("a.pbrt", MEANT[i][0]), 2, MEANT[i][1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(each_file_has_its_type),
        TEST_IN_FOLDER(other_linear_files_hold_the_same),
        TEST_IN_FOLDER(frames_may_have_seeds_of_their_own),
        TEST_IN_FOLDER(frames_of_one_photon_map_may_have_seeds_of_their_own),
        TEST_IN_FOLDER(frames_may_have_maps_and_skies_of_their_own),
        TEST_IN_FOLDER(what_was_meant_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
