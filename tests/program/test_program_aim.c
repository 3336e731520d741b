/* test_program_aim.c: photons aimed at what the picture asks for: the same photons whatever part of the picture is
 * rendered, how large, with how many samples and threads; the same light as by power alone and as path tracing has; and
 * kept maps that say what they are aimed at.
 * Flow: tests of the whole program. Threads: the program's. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "fixtures/program_agreement.h"
#include "fixtures/sanitizer.h"

#define AIMED    "--photon-aim=0.8"
#define BY_POWER "--photon-aim=0"
#define SUN_AND_SKY                                                                                                    \
    "LightSource \"infinite\" \"rgb L\" [0.3 0.4 0.6] LightSource \"distant\" \"rgb L\" [6 5 4] \"point3 from\" [3 "   \
    "-1 3] \"point3 to\" [0 0 0]"
#define GROUND "Shape \"bilinearmesh\" \"point3 P\" [-12 -12 -0.1  12 -12 -0.1  -12 12 -0.1  12 12 -0.1]"

#define CEILING "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 2  1 -1 2"

/* A room with a window on wide ground, under sun and sky. */
static const char *room(void)
{
    return SCENE_WITH("window_room.pbrt", "THE_LIGHTS", SUN_AND_SKY, "block.pbrt", PROGRAM_SCENES "block.pbrt", CEILING,
                      GROUND "\n" CEILING);
}

static const char *room_from_beside(void)
{
    return SCENE_WITH("window_room.pbrt", "THE_LIGHTS", SUN_AND_SKY, "block.pbrt", PROGRAM_SCENES "block.pbrt", CEILING,
                      GROUND "\n" CEILING, "LookAt -0.9", "LookAt -0.8");
}

static void expect_end(program_run run, int code, const char *said)
{
    expect_exit(&run, code);
    if (said)
        expect_said(&run, said);
    program_run_reset(&run);
}

/* --- the same photons --- */

#define PHOTONS_OF(name, ...)                                                                                          \
    expect_end(RUN("--photons=20000", "--caustic-photons=2000", "--photons-only", "--progress=none",                   \
                   "--dump-photons=" name, __VA_ARGS__),                                                               \
               0, NULL)

static void test_parts_and_sizes_have_the_same_photons(void **state)
{
    (void)state;
    char scene[160]; /* what in_folder gives does not last */
    snprintf(scene, sizeof scene, "%s", room());
    PHOTONS_OF("whole.ply", "--nthreads=1", scene);
    PHOTONS_OF("2.ply", "--nthreads=2", scene);
    expect_same_files("whole.ply", "2.ply");
    PHOTONS_OF("3.ply", "--nthreads=3", "--cropwindow=0.2,0.6,0.5,0.9", scene);
    expect_same_files("whole.ply", "3.ply");
    PHOTONS_OF("tile.ply", "--tile=2/5", "--spp=7", scene);
    expect_same_files("whole.ply", "tile.ply");
    PHOTONS_OF("size.ply", "--size=50x50", "--noise=0.01", "--gather-samples=3", scene);
    expect_same_files("whole.ply", "size.ply");
    PHOTONS_OF("default.ply", AIMED, scene);
    expect_same_files("whole.ply", "default.ply");

    /* another aim, frame or view has other photons */
    PHOTONS_OF("none.ply", BY_POWER, scene);
    PHOTONS_OF("wide.ply", "--size=64x32", scene);
    PHOTONS_OF("moved.ply", room_from_beside());
    static const char *const OTHERS[] = {"none.ply", "wide.ply", "moved.ply"};
    size_t size, other_size;
    unsigned char *whole = read_bytes(in_folder("whole.ply"), &size);
    for (int i = 0; i < 3; i++) {
        unsigned char *other = read_bytes(in_folder(OTHERS[i]), &other_size);
        assert_true(size != other_size || memcmp(whole, other, size) != 0);
        free(other);
    }
    free(whole);
}

static void test_parts_have_the_bits_of_the_whole(void **state)
{
    (void)state;
    char scene[160];
    snprintf(scene, sizeof scene, "%s", room());
    picture whole = RENDER(scene, "--photons=20000", "--spp=2", "--gather-samples=4", "--size=24x24", "--nthreads=1");
    picture part = RENDER(scene, "--photons=20000", "--spp=2", "--gather-samples=4", "--size=24x24", "--nthreads=3",
                          "--cropwindow=0.25,0.75,0.5,1");
    assert_int_equal(part.width, 12);
    assert_int_equal(part.height, 12);
    for (int y = 0; y < 12; y++)
        assert_memory_equal(&part.pixels[3 * 12 * y], &whole.pixels[3 * (24 * (y + 12) + 6)], 12 * 3 * sizeof(float));
    picture_reset(&whole);
    picture_reset(&part);
}

/* --- the same light --- */

/* The share of irradiance photons that are asked for, with few photons and many gather rays. */
static double share_asked_for(const char *scene, const char *aim)
{
    picture p = RENDER(scene, aim, "--photons=4e4", "--spp=64", "--gather-samples=8", "--stats=stats.json");
    picture_reset(&p);
    json_t *stats = stats_read(in_folder("stats.json"));
    double share =
        (double)stats_integer(stats, "irradiance.computed") / (double)stats_integer(stats, "photons.stored_global");
    json_decref(stats);
    return share;
}

static void test_light_is_the_same_and_more_photons_are_of_use(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip(); /* statistics of what other tests run here */
    char scene[160];
    snprintf(scene, sizeof scene, "%s", room());
    const agreement_means path = agreement_render(scene, ARGUMENTS("--integrator=path", "--spp=256"));
    const agreement_means aimed = agreement_render(scene, ARGUMENTS(AGREEMENT_MAP, "--spp=16", AIMED));
    expect_agreement("aimed", &aimed, &path, (agreement_bounds){AGREEMENT_BLUR, 0.005, 0.03});
    double share = share_asked_for(scene, AIMED), share_by_power = share_asked_for(scene, BY_POWER);
    print_message("asked for: %.4f of the photons aimed, %.4f by power\n", share, share_by_power);
    assert_true(share > 0.3);
    assert_true(share > 5.0 * share_by_power);
}

/* A camera that sees the sky alone, and one in the dark. */
static void test_nothing_to_aim_at(void **state)
{
    (void)state;
    char scene[160];
    snprintf(scene, sizeof scene, "%s",
             SCENE_WITH("window_room.pbrt", "THE_LIGHTS", SUN_AND_SKY, "block.pbrt", PROGRAM_SCENES "block.pbrt",
                        "LookAt -0.9 -0.9 1.5  0.5 0.4 0.7", "LookAt 0 0 20  0 0 30", " 0 0 1\n", " 0 1 0\n"));
    picture sky = RENDER(scene, "--photons=5000", "--spp=1");
    expect_near("sky", picture_mean(&sky, 2), 0.6, 1e-3);
    picture_reset(&sky);
    snprintf(scene, sizeof scene, "%s",
             SCENE_WITH("window_room.pbrt", "THE_LIGHTS", SUN_AND_SKY, "block.pbrt", PROGRAM_SCENES "block.pbrt",
                        "LookAt -0.9 -0.9 1.5  0.5 0.4 0.7", "LookAt 50 50 50  51 51 50"));
    sky = RENDER(scene, "--photons=5000", "--spp=1");
    expect_near("beside", picture_mean(&sky, 2), 0.6, 1e-3);
    picture_reset(&sky);
}

/* --- kept maps --- */

#define QUICK                                                                                                          \
    "--photons=20000", "--spp=2", "--gather-samples=4", "--size=24x24", "--progress=none", "--type=float",             \
        "--reproducible"

static void test_kept_maps(void **state)
{
    (void)state;
    /* of itself a kept map is for all views alike */
    expect_end(RUN(QUICK, BY_POWER, "-o", "fresh.exr", room()), 0, NULL);
    expect_end(RUN(QUICK, "--photon-map=a.map", "-o", "kept.exr", room()), 0, NULL);
    expect_same_files("fresh.exr", "kept.exr");
    expect_end(RUN(QUICK, BY_POWER, "-o", "fresh.exr", room_from_beside()), 0, NULL);
    expect_end(RUN(QUICK, "--photon-map=a.map", "-o", "kept.exr", room_from_beside()), 0, NULL);
    expect_same_files("fresh.exr", "kept.exr");

    /* one that is aimed serves its view, in all sizes */
    expect_end(RUN(QUICK, "-o", "fresh.exr", room()), 0, NULL);
    for (int i = 0; i < 2; i++) {
        expect_end(RUN(QUICK, AIMED, "--photon-map=b.map", "-o", "kept.exr", room()), 0, NULL);
        expect_same_files("fresh.exr", "kept.exr");
    }
    expect_end(RUN(QUICK, "--size=12x12", "-o", "fresh.exr", room()), 0, NULL);
    expect_end(RUN(QUICK, "--size=12x12", AIMED, "--photon-map=b.map", "-o", "kept.exr", room()), 0, NULL);
    expect_same_files("fresh.exr", "kept.exr");
    expect_end(RUN(QUICK, AIMED, "--photon-map=b.map", "-o", "kept.exr", room_from_beside()), 1,
               "aimed at another view");
    expect_end(RUN(QUICK, "--photon-map=b.map", "-o", "kept.exr", room()), 1, "another aim of photons: 0.8, not 0");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_parts_and_sizes_have_the_same_photons),
        TEST_IN_FOLDER(test_parts_have_the_bits_of_the_whole),
        TEST_IN_FOLDER(test_light_is_the_same_and_more_photons_are_of_use),
        TEST_IN_FOLDER(test_nothing_to_aim_at),
        TEST_IN_FOLDER(test_kept_maps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
