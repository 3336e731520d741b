/* test_program_same_bits.c: the same picture, bit for bit, whatever the number of threads, on demand and precomputed,
 * twice each, in a plain room, in one full of coincidences, in one that moves and in one
 * whose meshes bend; also where few photons keep
 * irradiance; and in no run is an irradiance computed twice.
 *
 * Flow: tests of the whole program. Threads: the program's, up to more than there are processors. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"
#include "fixtures/sanitizer.h"

/* Sanitizers make the program about ten times slower: once is enough for them, by three threads and by far more than
 * there are processors. */
enum { RUNS_EACH = IS_SANITIZED ? 1 : 2 };
#if IS_SANITIZED
static const char *const THREADS[] = {"--nthreads=1", "--nthreads=3", "--nthreads=64"};
#else
static const char *const THREADS[] = {"--nthreads=1", "--nthreads=2", "--nthreads=3", "--nthreads=8", "--nthreads=64"};
#endif
enum { THREADS_COUNT = sizeof THREADS / sizeof *THREADS };
#define SIZE    (IS_SANITIZED ? "--size=24x24" : "--size=48x48")
#define PHOTONS (IS_SANITIZED ? "--photons=5000" : "--photons=20000")
static const long long PHOTON_COUNT = IS_SANITIZED ? 5000 : 20000;

#define BOX          PROGRAM_SCENES "box_with_blocks.pbrt"
#define MOTION       PROGRAM_SCENES "moving_blocks.pbrt"
#define DEFORMATION  PROGRAM_SCENES "deforming_blocks.pbrt"
#define COINCIDENCES PROGRAM_SCENES "coincidences.pbrt"
#define FOG          PROGRAM_SCENES "foggy_room.pbrt"
#define GLINTS       PROGRAM_SCENES "glints.pbrt"
#define PRINCIPLED   PROGRAM_SCENES "principled.pbrt" /* coats and rough metal */

static void expect_same(const char *what, const picture *p, const picture *reference)
{
    assert_int_equal(p->width, reference->width);
    assert_int_equal(p->height, reference->height);
    for (int i = 0; i < 3 * p->width * p->height; i++)
        if (memcmp(&p->pixels[i], &reference->pixels[i], sizeof *p->pixels) != 0)
            fail_msg("%s: pixel %d, %d has %.9g, not %.9g", what, i / 3 % p->width, i / 3 / p->width,
                     (double)p->pixels[i], (double)reference->pixels[i]);
}

/* Checks what must hold of every picture by photon map. irradiance_photons: the most that a tree of their own may
 * hold. */
static void expect_balance(const char *stats_file, long long photons, long long irradiance_photons)
{
    json_t *stats = stats_read(in_folder(stats_file));
    long long global = stats_integer(stats, "photons.stored_global"),
              caustic = stats_integer(stats, "photons.stored_caustic");
    long long computed = stats_integer(stats, "irradiance.computed");
    assert_int_equal(global, photons);
    assert_true(stats_integer(stats, "photons.bytes") <= 34 * (global + caustic + irradiance_photons) + 2048);
    assert_true(computed > 0);
    assert_int_equal(computed, stats_integer(stats, "irradiance.distinct"));
    assert_int_equal(stats_integer(stats, "irradiance.duplicated"), 0);
    assert_true(computed <= global);
    assert_true(stats_integer(stats, "irradiance.requests") > 0);
    assert_true(stats_integer(stats, "irradiance.waited") <= stats_integer(stats, "irradiance.deferred"));
    assert_int_equal(stats_integer(stats, "samples_not_finite"), 0);
    json_decref(stats);
}

static picture render_map(const char *scene, const char *threads, const char *cache, const char *more)
{
    picture p = RENDER(scene, SIZE, "--spp=2", "--gather-samples=8", PHOTONS, "--caustic-photons=5000", threads, cache,
                       "--stats=stats.json", more);
    return p;
}

static void expect_same_for_all_threads(const char *scene, const char *more)
{
    picture reference = render_map(scene, THREADS[0], "--cache=on-demand", more);
    double brightest = 0.0;
    for (int i = 0; i < 3 * reference.width * reference.height; i++)
        brightest = fmax(brightest, (double)reference.pixels[i]);
    assert_true(brightest > 0.1); /* there is a picture */
    static const char *const CACHES[] = {"--cache=on-demand", "--cache=precompute"};
    for (int cache = 0; cache < 2; cache++)
        for (int i = 0; i < THREADS_COUNT; i++)
            for (int run = cache == 0 && i == 0 ? 1 : 0; run < RUNS_EACH; run++) { /* the reference is a run, too */
                char what[64];
                snprintf(what, sizeof what, "%s %s", THREADS[i], CACHES[cache]);
                picture p = render_map(scene, THREADS[i], CACHES[cache], more);
                expect_same(what, &p, &reference);
                expect_balance("stats.json", PHOTON_COUNT, more ? PHOTON_COUNT / 2 : 0);
                picture_reset(&p);
            }
    picture_reset(&reference);
}

static void test_plain_room(void **state)
{
    (void)state;
    expect_same_for_all_threads(BOX, NULL);
}

static void test_fog(void **state)
{
    (void)state;
    expect_same_for_all_threads(FOG, NULL);
}

static void test_coincidences(void **state)
{
    (void)state;
    expect_same_for_all_threads(COINCIDENCES, NULL);
}

static void test_few_irradiance_photons(void **state)
{
    (void)state;
    expect_same_for_all_threads(BOX, "--irradiance-fraction=0.125");
    json_t *stats = stats_read(in_folder("stats.json")); /* of the last picture, precomputed */
    long long computed = stats_integer(stats, "irradiance.computed");
    /* where few photons lie far apart, more of them are irradiance photons */
    assert_true(computed >= PHOTON_COUNT / 8 && computed < PHOTON_COUNT / 2);
    json_decref(stats);
}

static void test_motion(void **state)
{
    (void)state;
    expect_same_for_all_threads(MOTION, NULL);
}

static void test_deformation(void **state)
{
    (void)state;
    expect_same_for_all_threads(DEFORMATION, NULL);
}

/* Both maps are aimed there. */
static void test_coats_and_metal(void **state)
{
    (void)state;
    expect_same_for_all_threads(PRINCIPLED, NULL);
    expect_same_for_all_threads(GLINTS, NULL); /* whose caustic photons guide rays of the coat */
}

static void test_unguided(void **state)
{
    (void)state;
    expect_same_for_all_threads(BOX, "--gather-guiding=0");
}

/* All photons on one spot of a floor, and few of them asked for by many threads at once. */
static void test_few_photons_for_many_threads(void **state)
{
    (void)state;
    picture reference = {0};
    for (int i = 0; i < 4; i++) {
        picture p = RENDER(COINCIDENCES, SIZE, "--spp=2", "--gather-samples=16", "--photons=50", "--caustic-photons=10",
                           "--radius=3", "--stats=stats.json", i == 0 ? "--nthreads=1" : "--nthreads=64");
        expect_balance("stats.json", 50, 0);
        if (i == 0) {
            reference = p;
            continue;
        }
        expect_same("few photons", &p, &reference);
        picture_reset(&p);
    }
    picture_reset(&reference);
}

static void test_path_tracer(void **state)
{
    (void)state;
    static const char *const SCENES[] = {BOX, COINCIDENCES};
    for (int s = 0; s < 2; s++) {
        picture reference = {0};
        for (int i = 0; i < THREADS_COUNT; i++) {
            picture p = RENDER(SCENES[s], "--integrator=path", SIZE, "--spp=4", THREADS[i]);
            if (i == 0) {
                reference = p;
                continue;
            }
            expect_same(THREADS[i], &p, &reference);
            picture_reset(&p);
        }
        picture_reset(&reference);
    }
}

/* A part of the picture has the pixels that the whole has there. */
static void test_crop(void **state)
{
    (void)state;
    static const char *const INTEGRATORS[] = {"--integrator=photonmap", "--integrator=path"};
    for (int k = 0; k < 2; k++) {
        picture whole = render_map(COINCIDENCES, INTEGRATORS[k], "--cache=on-demand", NULL);
        picture part =
            render_map(COINCIDENCES, INTEGRATORS[k], "--cache=on-demand", "--cropwindow=0.25,0.75,0.5,0.625");
        int size = whole.width;
        assert_int_equal(part.width, size / 2);
        assert_int_equal(part.height, size / 8);
        for (int y = 0; y < part.height; y++)
            assert_memory_equal(part.pixels + 3 * y * part.width, whole.pixels + 3 * ((y + size / 2) * size + size / 4),
                                3 * (size_t)part.width * sizeof *part.pixels);
        picture_reset(&part);
        picture_reset(&whole);
    }
}

static void test_seed(void **state)
{
    (void)state;
    static const char *const INTEGRATORS[] = {"--integrator=photonmap", "--integrator=path"};
    for (int k = 0; k < 2; k++) {
        picture a = render_map(BOX, INTEGRATORS[k], "--seed=0", NULL),
                b = render_map(BOX, INTEGRATORS[k], "--seed=1", NULL);
        int different = 0;
        for (int i = 0; i < 3 * a.width * a.height; i++)
            different += a.pixels[i] != b.pixels[i];
        assert_true(different > 2 * a.width * a.height);
        picture_reset(&a);
        picture_reset(&b);
    }
}

/* `off` is another estimator: each block agrees within its noise, which the pictures of two seeds tell. */
static void test_cache_off(void **state)
{
    (void)state;
    if (IS_SANITIZED)
        skip();
    enum { BLOCK = 8 };
    picture on = render_map(BOX, "--only=indirect", "--cache=on-demand", NULL);
    picture off = render_map(BOX, "--only=indirect", "--cache=off", NULL);
    picture other = render_map(BOX, "--only=indirect", "--cache=on-demand", "--seed=1");
    expect_near("off", picture_mean(&off, 1), picture_mean(&on, 1), 0.02);
    double off_square = 0.0, seed_square = 0.0;
    int different = 0;
    for (int y = 0; y < on.height; y += BLOCK)
        for (int x = 0; x < on.width; x += BLOCK) {
            double a = picture_block(&on, x, y, BLOCK, 1), b = picture_block(&off, x, y, BLOCK, 1),
                   c = picture_block(&other, x, y, BLOCK, 1);
            different += a != b;
            off_square += (a - b) * (a - b);
            seed_square += (a - c) * (a - c);
        }
    assert_true(different > 0);
    assert_true(off_square <= seed_square);
    picture_reset(&on);
    picture_reset(&off);
    picture_reset(&other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_plain_room),
        TEST_IN_FOLDER(test_fog),
        TEST_IN_FOLDER(test_coincidences),
        TEST_IN_FOLDER(test_motion),
        TEST_IN_FOLDER(test_deformation),
        TEST_IN_FOLDER(test_coats_and_metal),
        TEST_IN_FOLDER(test_few_photons_for_many_threads),
        TEST_IN_FOLDER(test_path_tracer),
        TEST_IN_FOLDER(test_crop),
        TEST_IN_FOLDER(test_seed),
        TEST_IN_FOLDER(test_cache_off),
        TEST_IN_FOLDER(test_few_irradiance_photons),
        TEST_IN_FOLDER(test_unguided),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
