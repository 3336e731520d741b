/* test_photon_tracing_cancel.c: photon tracing that is cancelled leaves nothing, or all of it. Threads: those of the
 * tracing, and one that cancels. */
#include "photon_tracing.h"

#include "clock.h"

#include "fixtures/test_scene.h"

/* The unit sphere around a lamp; the whole of its light stays within. */
static scene *sphere_scene(test_run *r, double reflectance)
{
    char text[512];
    snprintf(text, sizeof text,
             "LightSource \"point\" \"rgb I\" [3 2 1] \"point3 from\" [0.3 -0.2 0.4]\n"
             "Material \"diffuse\" \"rgb reflectance\" [%g %g %g]\n"
             "Shape \"sphere\" \"float radius\" [1]\n",
             reflectance, reflectance, reflectance);
    return test_scene_create(r, text);
}

static void cancelling_ends_it(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 2);
    scene *s = sphere_scene(&r, 0.5);
    run_cancel(&r.run);
    photon_tracing_settings settings = {.kind = PHOTON_GLOBAL, .wanted = 100000, .max_scatterings = 100};
    photon_set set;
    assert_int_equal(photon_tracing_run(s, &r.run, &settings, &set), AG_CANCELLED);
    assert_null(set.photons);
    scene_destroy(s);
    test_run_reset(&r);
}

typedef struct canceller {
    run_context *run;
    atomic_u32 has_begun;
    double seconds; /* to wait then */
} canceller;

static void *cancel_later(void *user)
{
    canceller *c = user;
    while (!load_relaxed_u32(&c->has_begun))
        continue;
    for (double end = clock_seconds() + c->seconds; clock_seconds() < end;)
        continue;
    run_cancel(c->run);
    return NULL;
}

/* Cancelled at any moment, most often while the last of the blocks are traced: either there is nothing, or all of
 * it. */
static void cancelling_leaves_all_or_nothing(void **state)
{
    (void)state;
    enum { TRIES = 100, WORKERS = 16 }; /* a round is a block for each worker, and yields more than is wanted */
    test_run r;
    test_run_init(&r, WORKERS);
    scene *s = sphere_scene(&r, 0.9);
    photon_tracing_settings settings = {.kind = PHOTON_GLOBAL, .wanted = 15000, .max_scatterings = 100};
    photon_set whole, set;
    assert_int_equal(photon_tracing_run(s, &r.run, &settings, &whole), AG_OK);
    photon_set_reset(&whole);
    double begin = clock_seconds();
    assert_int_equal(photon_tracing_run(s, &r.run, &settings, &whole), AG_OK);
    double whole_seconds = clock_seconds() - begin; /* only so that the moments are worth while */
    rng random = test_random(31);
    int cancelled = 0;
    for (int k = 0; k < TRIES; k++) {
        canceller c = {.run = &r.run, .seconds = whole_seconds * (double)rng_float(&random)};
        pthread_t thread;
        assert_int_equal(pthread_create(&thread, NULL, cancel_later, &c), 0);
        store_relaxed_u32(&c.has_begun, 1);
        ag_status status = photon_tracing_run(s, &r.run, &settings, &set);
        pthread_join(thread, NULL);
        store_relaxed_u32(&r.run.stop, 0);
        if (status != AG_OK) {
            assert_int_equal(status, AG_CANCELLED);
            assert_null(set.photons);
            cancelled++;
            continue;
        }
        assert_int_equal(set.count, whole.count);
        assert_int_equal(set.emitted_paths, whole.emitted_paths);
        assert_int_equal(set.rays, whole.rays);
        assert_memory_equal(set.photons, whole.photons, whole.count * sizeof *whole.photons);
        photon_set_reset(&set);
    }
    assert_true(cancelled > 0);
    photon_set_reset(&whole);
    scene_destroy(s);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cancelling_ends_it),
        cmocka_unit_test(cancelling_leaves_all_or_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
