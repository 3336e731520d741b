/* test_import_defaults.c: the camera that is made for files without one shows all there is, from the right side and
 * with up upwards, in pictures of any proportions; the light that is made shines on what it sees. */
#include "import_defaults.h"
#include "scene_extent.h"

#include "fixtures/pbrt_fixture.h"

/* A reading of a pbrt scene without a camera, as an importer would leave it; what is said goes on into it. */
typedef struct importing {
    reading r;
    log_sink *log;
} importing;

static void importing_init(importing *i, const char *world)
{
    char text[1024];
    snprintf(text, sizeof text, "WorldBegin\n%s\n", world);
    i->r = reading_of(text);
    i->log = log_create(reading_hear, &i->r);
    assert_non_null(i->log);
}

static void importing_reset(importing *i)
{
    log_destroy(i->log);
    reading_destroy(&i->r);
}

static double tan_half(const camera *c) { return tan((double)c->fov_degrees * (3.14159265358979323846 / 360.0)); }

/* The point in camera space; z is the depth, x and y are 1 at the edges of a square picture. */
static vec3 on_screen(const camera *c, vec3 world)
{
    transform camera_from_world = transform_invert(&c->world_from_camera);
    vec3 p = transform_point(&camera_from_world, world);
    float scale = (float)tan_half(c) * p.z;
    return vec3_make(p.x / scale, p.y / scale, p.z);
}

static void all_is_in_the_picture(void **state)
{
    (void)state;
    static const char *const WORLDS[] = {
        "Shape \"sphere\"",
        "Translate 1000 -20 3 Scale .1 .2 .3 Shape \"sphere\" Translate 40 0 0 Shape \"sphere\"",
        "Scale 1e6 1e6 1e6 Shape \"disk\"",
        "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1e-3 0 0 0 1e-3 0 1e-3 1e-3 0]",
        "Scale 1 100 1 Shape \"cylinder\"",
    };
    for (size_t w = 0; w < sizeof WORLDS / sizeof *WORLDS; w++) {
        importing i;
        importing_init(&i, WORLDS[w]);
        assert_int_equal(import_add_default_camera(i.r.scene, i.log), AG_OK);
        const camera *c = &i.r.scene->camera;
        vec3 low, high;
        assert_int_equal(scene_find_bounds(i.r.scene, NULL, &low, &high), AG_OK);
        assert_true(i.r.scene->has_camera);
        float largest = 0.0f;
        for (int corner = 0; corner < 8; corner++) {
            vec3 p = on_screen(
                c, vec3_make(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z));
            assert_true(p.z > 0.0f);
            largest = fmaxf(largest, fmaxf(fabsf(p.x), fabsf(p.y)));
        }
        if (!(largest > 0.9f && largest < 1.0f))
            fail_msg("world %zu: the outermost corner is at %g of the picture's half", w, (double)largest);
        assert_non_null(strstr(i.r.said[AG_LOG_INFO], "the file has no camera: one is set at ("));
        importing_reset(&i);
    }
}

static void front_is_in_front_and_nothing_is_mirrored(void **state)
{
    (void)state;
    importing i;
    importing_init(&i, "Shape \"sphere\"");
    import_add_default_camera(i.r.scene, i.log);
    const camera *c = &i.r.scene->camera;
    vec3 x = on_screen(c, vec3_make(1, 0, 0)), y = on_screen(c, vec3_make(0, 1, 0)),
         z = on_screen(c, vec3_make(0, 0, 1));
    vec3 center = on_screen(c, vec3_make(0, 0, 0));
    assert_near(center.x, 0, 1e-6);
    assert_near(center.y, 0, 1e-6);
    assert_true(x.x > 0.1f);                                /* x goes to the right */
    assert_true(y.y > 0.1f && fabsf(y.x) < 1e-6f);          /* y straight up */
    assert_true(z.z < center.z && z.z < x.z && z.y < 0.0f); /* z comes towards the eye, seen from above */
    importing_reset(&i);
}

static void points_and_nothing_have_a_camera_too(void **state)
{
    (void)state;
    importing i;
    importing_init(&i, "");
    assert_int_equal(import_add_default_camera(i.r.scene, i.log), AG_OK);
    assert_true(on_screen(&i.r.scene->camera, vec3_make(0, 0, 0)).z > 1.0f);
    importing_reset(&i);

    importing_init(&i, "Translate 1 2 3 Scale 1e-5 1e-5 1e-5 Shape \"sphere\"");
    assert_int_equal(import_add_default_camera(i.r.scene, i.log), AG_OK);
    assert_true(on_screen(&i.r.scene->camera, vec3_make(1, 2, 3)).z > 0.0f);
    importing_reset(&i);
}

/* An even sky, and a sun that shines on the left, the upper, and the near side of what the camera sees. */
static void light_comes_over_the_left_shoulder(void **state)
{
    (void)state;
    static const bool HAS_OWN_CAMERA[] = {false, true};
    for (int k = 0; k < 2; k++) {
        importing i;
        importing_init(&i, "Shape \"sphere\"");
        if (HAS_OWN_CAMERA[k]) { /* from behind: looks along +z, x to the left */
            i.r.scene->camera = (camera){.world_from_camera = transform_translate(0, 0, -5), .fov_degrees = 40.0f};
            i.r.scene->has_camera = true;
        } else {
            import_add_default_camera(i.r.scene, i.log);
        }
        assert_int_equal(import_add_default_light(i.r.scene, i.log), AG_OK);
        assert_int_equal(i.r.scene->light_count, 2);
        const light *sky = &i.r.scene->lights[0], *sun = &i.r.scene->lights[1];
        assert_int_equal(sky->kind, LIGHT_INFINITE);
        assert_int_equal(sun->kind, LIGHT_DISTANT);
        assert_near(vec3_length(sun->as.distant.direction), 1.0, 1e-6);
        transform camera_from_world = transform_invert(&i.r.scene->camera.world_from_camera);
        vec3 way = transform_vector(&camera_from_world, sun->as.distant.direction);
        assert_true(way.x > 0.2f && way.y < -0.2f && way.z > 0.2f);
        /* a white surface that faces the sun stays below 1 */
        assert_true(sky->as.infinite.radiance.value.r + sun->as.distant.irradiance.r * AG_INV_PI < 1.0f);
        assert_non_null(strstr(i.r.said[AG_LOG_INFO], "the file has no light: an even sky and a sun light it"));

        log_sink *log = log_create(NULL, NULL);
        run_context run;
        run_context_init(&run, NULL, log, NULL, NULL);
        thread_pool *pool;
        assert_int_equal(thread_pool_create(1, &pool), AG_OK);
        run.pool = pool;
        assert_int_equal(scene_commit(i.r.scene, &run, NULL), AG_OK);
        assert_true(sky->power.r > 0.0f && sun->power.r > 0.0f);
        thread_pool_destroy(pool);
        run_context_reset(&run);
        log_destroy(log);
        importing_reset(&i);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_is_in_the_picture),
        cmocka_unit_test(front_is_in_front_and_nothing_is_mirrored),
        cmocka_unit_test(points_and_nothing_have_a_camera_too),
        cmocka_unit_test(light_comes_over_the_left_shoulder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
