/* test_debug_views.c: the views of the photon map say what they say: as many photons demanded as were, density and
 * distances as evenly spread photons have them, gather rays as long as the room is wide.
 * Threads: the renderer's. */
#define _GNU_SOURCE
#include "fixtures/layers_fixture.h"

/* A sphere of radius 2 around the eye, lit from within: photons lie evenly, N / (4 pi r^2). */
#define SPHERE                                                                                                         \
    "Film \"rgb\" Camera \"perspective\" \"float fov\" 60 WorldBegin\n"                                                \
    "LightSource \"point\" \"point3 from\" [0 0 0] Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n"           \
    "Shape \"sphere\" \"float radius\" 2"

static void test_sphere(void **state)
{
    (void)state;
    studio *s = studio_open(SPHERE, 2);
    s->settings.photon_count = 20000;
    s->settings.layers = AG_LAYER_PHOTON_DENSITY | AG_LAYER_PHOTON_DISTANCE | AG_LAYER_GATHER_DISTANCE |
                         AG_LAYER_CACHE_STATE | AG_LAYER_TILE_TIME;
    ag_film *film = studio_render(s);
    double density = 20000.0 / (4.0 * 3.14159265 * 4.0);
    expect_within("density", film_mean(film, "photon_density.V") / density, 1.0, 0.03);
    /* the nearest of evenly spread points: 1 / (2 sqrt(density)) */
    expect_within("distance", film_mean(film, "photon_distance.V") * 2.0 * sqrt(density), 1.0, 0.15);
    /* chords of a sphere by the cosine's law: length 2 r cos, 1 / E[1 / (2 r cos)] = r */
    expect_within("gather", film_mean(film, "gather_distance.V"), 2.0, 0.1);
    assert_true(film_mean(film, "tile_time.V") > 0.0);

    float *states = film_channel_of(film, "cache_state.V");
    int demanded = 0, empty = 0;
    for (int i = 0; i < 256; i++) {
        assert_true(states[i] == 1.0f || states[i] == 2.0f);
        demanded += states[i] == 2.0f;
        empty += states[i] == 1.0f;
    }
    /* 256 pixels with 16 rays each ask for few of 20000 */
    assert_true(demanded > 0 && empty > 0);
    free(states);
    ag_film_destroy(film);

    s->settings.cache = AG_CACHE_PRECOMPUTE;
    film = studio_render(s);
    expect_within("all demanded", film_mean(film, "cache_state.V"), 2.0, 0.0);
    ag_film_destroy(film);

    s->settings.integrator = AG_INTEGRATOR_PATH;
    film = studio_render(s);
    assert_false(film_has(film, "cache_state.V"));
    ag_film_destroy(film);
    studio_close(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {TEST_IN_FOLDER(test_sphere)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
