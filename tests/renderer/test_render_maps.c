/* test_render_maps.c: of all irradiances that the maps of a public scene serve beside a step of 1 mm, under a sky of
 * radiance 1, none is above a Poisson bound. Threads: two workers; the questions are asked by one. */
#include "render_maps.h"

#include "afterglow/afterglow.h"
#include "fixtures/served_points.h"
#include "fixtures/shared_folder.h"

/* An estimate holds on this share of a disc at least, as irradiance_estimate.c has it. */
static const double LEAST_SHARE = 0.2;

/* Under that sky no surface with a reflectance below 1 has more. W/m^2. */
static const double LARGEST_IRRADIANCE = 3.14159265358979323846;

static const double RUNS_WITHOUT_ALARM = 1000.0;

typedef struct view {
    ag_context *context;
    ag_scene *scene;
    ag_render_settings settings;
    char said[512];
} view;

static void hear(void *user, ag_log_level level, const char *text)
{
    view *v = user;
    if (level <= AG_LOG_WARNING)
        snprintf(v->said, sizeof v->said, "%s", text);
}

static void view_open(view *v, const char *path)
{
    *v = (view){0};
    ag_context_settings settings = ag_default_context_settings();
    settings.thread_count = 2;
    settings.log = hear;
    settings.user = v;
    assert_int_equal(ag_context_create(&settings, &v->context), AG_OK);
    if (ag_scene_load(v->context, path, &v->scene) != AG_OK ||
        ag_render_settings_from_scene(v->context, v->scene, &v->settings) != AG_OK)
        fail_msg("%s", v->said);
}

static void view_close(view *v)
{
    ag_scene_destroy(v->scene);
    ag_context_destroy(v->context);
}

/* The number of values that were served, and the largest of them. */
typedef struct served_values {
    uint64_t count;
    double largest;
} served_values;

static void serve(served_values *served, rgb irradiance)
{
    served->count++;
    served->largest = fmax(served->largest, (double)rgb_max(irradiance));
}

/* The values that all photons keep. */
static void serve_slots(const photon_map *map, served_values *served)
{
    for (uint32_t i = 0; i < map->irradiance_photons.count; i++) {
        uint32_t word = irradiance_slot_read(photon_map_slot(map, i));
        assert_true(irradiance_word_is_ready(word));
        if ((word & IRRADIANCE_VALUE_MASK) != PHOTON_NO_IRRADIANCE)
            serve(served, photon_map_decode_irradiance(map, word & IRRADIANCE_VALUE_MASK));
    }
}

/* Asks for the irradiance at points that are drawn evenly from all surfaces. */
static void serve_points(const scene *s, photon_map *map, irradiance_cache_mode mode, served_values *served)
{
    enum { POINTS = 200000 / FEWER };
    const served_case all = {.center = vec3_scale(vec3_add(s->bounds_min, s->bounds_max), 0.5f),
                             .reach = s->bounding_radius,
                             .light_count = 1,
                             .lights = {{1.0f, 1.0f}}};
    irradiance_cache cache;
    assert_int_equal(irradiance_cache_create(map, mode, 1, &cache), AG_OK);
    point_series p = {.s = s, .c = &all, .random = test_random(1)};
    for (int points = 0; points < POINTS;) {
        field_point at;
        draw_line(&p);
        for (; cross(&p, &at); points++) {
            irradiance_request request;
            irradiance_cache_get(&cache, at.position, at.normal, 0, &request);
            if (request.holds)
                serve(served, request.irradiance);
        }
    }
    irradiance_cache_reset(&cache);
}

/* Returns the largest photon's flux over their mean. */
static double largest_weight(const photon_map *map)
{
    double sum = 0.0, largest = 0.0;
    for (uint32_t i = 0; i < map->set.count; i++) {
        double flux = (double)flux_largest(photon_block_flux(map->blocks, i));
        sum += flux;
        largest = fmax(largest, flux);
    }
    return largest / (sum / map->set.count);
}

/* Returns the largest irradiance that so many values have, but for one run in RUNS_WITHOUT_ALARM: an estimate is the
 * flux of a Poisson number of photons, and of the one that it is made at, over the surface on which there are
 * LEAST_SHARE of the nearest ones in the mean. Where some photons are brighter than the mean, no sum has a wider
 * spread than that of fewer photons which are all as bright as the brightest. */
static double irradiance_bound(uint32_t nearest, double weight, uint64_t values)
{
    double least = LEAST_SHARE * nearest;
    return LARGEST_IRRADIANCE * weight * (1.0 + poisson_bound(least / weight, RUNS_WITHOUT_ALARM * (double)values)) /
           least;
}

static void no_irradiance_beside_a_step_is_above_its_bound(void **state)
{
    (void)state;
    char path[512];
    view v;
    if (!shared_folder()) {
        print_message("SKIPPED: narrow-strip is in the folder shared, which is not beside the source folder\n");
        skip();
    }
    snprintf(path, sizeof path, "%s/scenes/narrow-strip.pbrt", shared_folder());
    view_open(&v, path);
    int wrong = 0;
    static const float AIMS[] = {0.0f, AG_DEFAULT_PHOTON_AIM};
    for (int a = 0; a < 2; a++)
        for (uint64_t seed = 1; seed <= 2; seed++) {
            ag_render_settings settings;
            maps *m;
            v.settings.photon_aim = AIMS[a];
            v.settings.photon_seed = seed;
            v.settings.photon_count = 131072 / FEWER;
            v.settings.cache = AG_CACHE_PRECOMPUTE;
            assert_int_equal(rendering_settle(v.context, v.scene->s, &v.settings, &settings), AG_OK);
            assert_int_equal(maps_create(v.context, v.scene->s, &settings, &m), AG_OK);
            served_values served = {0};
            serve_slots(&m->global, &served);
            serve_points(v.scene->s, &m->global, IRRADIANCE_ON_DEMAND, &served);
            serve_points(v.scene->s, &m->global, IRRADIANCE_UNCACHED, &served);
            double weight = largest_weight(&m->global);
            double bound = irradiance_bound(m->global.nearest, weight, served.count);
            bool is_right = served.largest <= bound;
            print_message("%s aim %g, %u photons, the brightest %.2f of the mean: of %llu irradiances the largest is "
                          "%.3f of at most %.3f\n",
                          is_right ? "right:" : "WRONG:", (double)AIMS[a], m->global.set.count, weight,
                          (unsigned long long)served.count, served.largest, bound);
            wrong += !is_right;
            maps_release(m);
        }
    assert_int_equal(wrong, 0);
    view_close(&v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_irradiance_beside_a_step_is_above_its_bound)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
