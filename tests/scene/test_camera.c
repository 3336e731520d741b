/* test_camera.c: rays of all cameras against closed forms, and the Camera directive.
 * Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/pbrt_fixture.h"

#include <unistd.h>

static const double PI = 3.14159265358979323846;

/* The camera of a scene, ready for rays. */
static camera camera_of(const char *text)
{
    char whole[512];
    snprintf(whole, sizeof whole, "%s WorldBegin", text);
    reading r = reading_of(whole);
    assert_true(r.scene->has_camera);
    camera c = r.scene->camera;
    c.tan_half_fov = (float)tan((double)c.fov_degrees * PI / 360.0); /* as scene_commit does */
    reading_destroy(&r);
    return c;
}

static const vec2 MIDDLE = {0.5f, 0.5f};

static void check_ray(const camera *c, double x, double y, double aspect, vec3 origin, vec3 direction)
{
    scene_ray ray = camera_generate_ray(c, (float)x, (float)y, (float)aspect, MIDDLE, 0.0f);
    direction = vec3_normalize(direction);
    assert_vec3(ray.origin, origin.x, origin.y, origin.z, 1e-6);
    assert_vec3(ray.direction, direction.x, direction.y, direction.z, 1e-6);
}

static const vec3 ZERO = {0.0f, 0.0f, 0.0f};

static void perspective(void **state)
{
    (void)state;
    camera c = camera_of("Camera \"perspective\" \"float fov\" 60");
    float t = (float)tan(PI / 6.0); /* to the edges of the shorter axis */
    check_ray(&c, 0.5, 0.5, 2.0, ZERO, vec3_make(0, 0, 1));
    check_ray(&c, 0.5, 0.0, 2.0, ZERO, vec3_make(0, t, 1));
    check_ray(&c, 1.0, 0.5, 2.0, ZERO, vec3_make(2 * t, 0, 1));
    check_ray(&c, 1.0, 1.0, 0.5, ZERO, vec3_make(t, -2 * t, 1));
    c = camera_of("LookAt 1 2 3 2 2 3 0 0 1 Camera \"perspective\" \"float frameaspectratio\" 1");
    check_ray(&c, 0.5, 0.0, 2.0, vec3_make(1, 2, 3), vec3_make(1, 0, 1));
}

static void orthographic(void **state)
{
    (void)state;
    camera c = camera_of("Camera \"orthographic\"");
    check_ray(&c, 0.5, 0.5, 2.0, ZERO, vec3_make(0, 0, 1));
    check_ray(&c, 1.0, 0.0, 2.0, vec3_make(2, 1, 0), vec3_make(0, 0, 1));
    check_ray(&c, 0.0, 1.0, 0.5, vec3_make(-1, -2, 0), vec3_make(0, 0, 1));
    c = camera_of("Camera \"orthographic\" \"float screenwindow\" [ -3 1 0 5 ]");
    check_ray(&c, 0.0, 0.0, 2.0, vec3_make(-3, 5, 0), vec3_make(0, 0, 1));
    check_ray(&c, 1.0, 1.0, 2.0, vec3_make(1, 0, 0), vec3_make(0, 0, 1));
    c.screen_shift[0] = 2.0f, c.screen_shift[1] = -1.0f;
    check_ray(&c, 0.0, 0.0, 2.0, vec3_make(-1, 4, 0), vec3_make(0, 0, 1));
    check_ray(&c, 1.0, 1.0, 2.0, vec3_make(3, -1, 0), vec3_make(0, 0, 1));
    c = camera_of("Translate 1 0 0 Scale 2 2 2 Camera \"orthographic\" \"float frameaspectratio\" 1");
    check_ray(&c, 1.0, 0.5, 2.0, vec3_make(0, 0, 0), vec3_make(0, 0, 1));
}

/* From all over the lens, rays of one point on the film meet where the plane in focus is. The lens is around the
 * camera, and around each point of an orthographic one's film. */
static void lenses(void **state)
{
    (void)state;
    static const char *const KINDS[] = {"perspective", "orthographic"};
    for (int k = 0; k < 2; k++) {
        char text[160];
        snprintf(text, sizeof text, "Camera \"%s\" \"float lensradius\" 0.5 \"float focaldistance\" 4", KINDS[k]);
        camera c = camera_of(text);
        float x = k == 0 ? 4.0f * 0.5f : 0.5f, y = k == 0 ? 4.0f * -1.0f : -1.0f;
        float middle_x = k == 0 ? 0.0f : x, middle_y = k == 0 ? 0.0f : y;
        double spread = 0.0;
        for (int i = 0; i < 16; i++) {
            scene_ray ray = camera_generate_ray(
                &c, 0.75f, 1.0f, 1.0f, (vec2){((float)(i % 4) + 0.5f) / 4.0f, ((float)(i / 4) + 0.5f) / 4.0f}, 0.0f);
            assert_near(ray.origin.z, 0, 1e-6);
            double radius = hypot((double)(ray.origin.x - middle_x), (double)(ray.origin.y - middle_y));
            assert_true(radius <= 0.5 + 1e-6);
            spread = fmax(spread, radius);
            vec3 met = vec3_add_scaled(ray.origin, ray.direction, 4.0f / ray.direction.z);
            assert_vec3(met, x, y, 4, 1e-5);
        }
        assert_true(spread > 0.3);
    }
}

static void equirectangular(void **state)
{
    (void)state;
    camera c = camera_of("Camera \"spherical\" \"string mapping\" \"equirectangular\"");
    check_ray(&c, 0.3, 0.0, 2.0, ZERO, vec3_make(0, 1, 0));
    check_ray(&c, 0.3, 1.0, 2.0, ZERO, vec3_make(0, -1, 0));
    for (int i = 0; i < 20; i++) {
        double u = (i + 0.5) / 20.0, v = ((i * 7) % 20 + 0.5) / 20.0, theta = PI * v, phi = 2.0 * PI * u;
        check_ray(&c, u, v, 2.0, ZERO,
                  vec3_make((float)(sin(theta) * cos(phi)), (float)cos(theta), (float)(sin(theta) * sin(phi))));
        /* to the left of the left edge is the right one */
        check_ray(&c, u - 1.0, v, 2.0, ZERO,
                  vec3_make((float)(sin(theta) * cos(phi)), (float)cos(theta), (float)(sin(theta) * sin(phi))));
    }
}

/* Equal areas of the film are equal solid angles: each sixteenth of the sphere by height gets a sixteenth of the rays;
 * and the film goes on over its edges. */
static void equal_area(void **state)
{
    (void)state;
    enum { COUNT = 1 << 16, BANDS = 16 };
    int count[BANDS] = {0};
    vec3 sum = ZERO;
    camera c = camera_of("Camera \"spherical\" \"float lensradius\" 3");
    assert_int_equal(c.kind, CAMERA_EQUAL_AREA);
    for (int i = 0; i < COUNT; i++) {
        double x =
            fmod(i * 0.61803398874989485, 1.0); /* spread without rows, which would fall along the bands' edges */
        vec3 d = camera_generate_ray(&c, (float)x, ((float)i + 0.5f) / COUNT, 1.0f, MIDDLE, 0.0f).direction;
        int band = (int)((d.y + 1.0f) / 2.0f * BANDS);
        count[band < BANDS ? band : BANDS - 1]++;
        sum = vec3_add(sum, d);
    }
    for (int i = 0; i < BANDS; i++)
        assert_near(count[i], COUNT / BANDS, 0.005 * COUNT / BANDS);
    assert_vec3(sum, 0, 0, 0, 20);
    check_ray(&c, 0.5, 0.5, 1.0, ZERO, vec3_make(0, 1, 0));
    check_ray(&c, 0.0, 0.0, 1.0, ZERO, vec3_make(0, -1, 0));
    check_ray(&c, 1.0, 0.5, 1.0, ZERO, vec3_make(1, 0, 0));
    check_ray(&c, 0.5, 1.0, 1.0, ZERO, vec3_make(0, 0, 1));
    static const float OVER[][2] = {{-0.01f, 0.3f}, {1.01f, 0.3f}, {0.3f, -0.01f}, {0.3f, 1.01f}, {-0.01f, -0.01f}};
    for (int i = 0; i < 5; i++) {
        vec3 beyond = camera_generate_ray(&c, OVER[i][0], OVER[i][1], 1.0f, MIDDLE, 0.0f).direction;
        vec3 within = camera_generate_ray(&c, fminf(fmaxf(OVER[i][0], 0.0f), 1.0f),
                                          fminf(fmaxf(OVER[i][1], 0.0f), 1.0f), 1.0f, MIDDLE, 0.0f)
                          .direction;
        assert_true(vec3_dot(beyond, within) > 0.998f && vec3_dot(beyond, within) < 0.99999f);
    }
}

static void directive(void **state)
{
    (void)state;
    camera c = camera_of("Camera \"perspective\"");
    assert_near(c.fov_degrees, 90, 0);
    assert_near(c.frame_aspect_ratio, 0, 0);
    assert_false(c.has_screen_window);
    assert_near(c.lens_radius, 0, 0);
    assert_near(c.focal_distance, 1e6, 0);
    assert_near(c.exposure, 1, 0);
    c = camera_of(
        "Translate 0 0 7 LookAt 1 2 3 1 2 9 0 1 0 Camera \"perspective\" \"float fov\" 40 \"float lensradius\" .1\n"
        "\"float focaldistance\" 5 \"float frameaspectratio\" 1.5 \"float screenwindow\" [ -1 2 -3 4 ]\n"
        "\"float shutteropen\" 1 \"float shutterclose\" 1.25");
    assert_near(c.fov_degrees, 40, 0);
    assert_near(c.lens_radius, .1, 1e-8);
    assert_near(c.focal_distance, 5, 0);
    assert_near(c.frame_aspect_ratio, 1.5, 0);
    assert_near(c.exposure, .25, 0);
    assert_true(c.has_screen_window && c.screen_window[1] == 2.0f && c.screen_window[2] == -3.0f);
    assert_vec3(transform_point(&c.world_from_camera, vec3_make(0, 0, 0)), 1, 2, -4, 1e-6);
    assert_vec3(transform_vector(&c.world_from_camera, vec3_make(0, 0, 1)), 0, 0, 1, 1e-6);
    c = camera_of("Camera \"perspective\" \"float halffov\" 30");
    assert_near(c.fov_degrees, 60, 0);
}

static reading read_realistic(const char *path, const char *parameters)
{
    char text[512];
    snprintf(text, sizeof text,
             "Camera \"realistic\" \"string lensfile\" \"%s\" %s\n"
             "Film \"rgb\" \"integer xresolution\" 400 \"integer yresolution\" 300 \"float diagonal\" 50 WorldBegin",
             path, parameters);
    return reading_create(NULL, text, strlen(text));
}

/* A lens without thickness, with a stop behind it: the lens maker's equation says f = 50 mm; the stop is as wide as it
 * looks. Then the same with the stop 10 mm behind: from before it looks 50 / 40 as wide. */
static void realistic(void **state)
{
    (void)state;
    char path[] = "/tmp/ag_lens_XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    for (int gap = 0; gap <= 10; gap += 10) {
        FILE *f = fopen(path, "w");
        assert_non_null(f);
        fprintf(f, "# radius thickness index diameter\n50 0 1.5 30\n-50 %d 1 30\n0 40 0 20\n", gap);
        fclose(f);
        reading r = read_realistic(path, "\"float aperturediameter\" 8 \"float focusdistance\" 2");
        assert_int_equal(r.status, AG_OK);
        assert_int_equal(r.count[AG_LOG_WARNING], 1);
        assert_non_null(strstr(r.said[AG_LOG_WARNING], "a thin lens stands in, with its focal length of 50 mm"));
        const camera *c = &r.scene->camera;
        double behind = (2.0 - sqrt(4.0 - 8.0 * 0.05)) / 2.0, radius = gap ? 0.005 : 0.004;
        assert_near(1.0 / behind + 1.0 / (double)c->focal_distance, 1.0 / 0.05, 1e-4);
        assert_near(c->focal_distance + behind, 2.0, 1e-6);
        assert_near(c->lens_radius, radius, 1e-8);
        assert_near(c->exposure, PI * radius * radius / (behind * behind), 1e-8);
        /* the film is 40 by 30 mm */
        assert_near(tan((double)c->fov_degrees * PI / 360.0), 0.015 / behind, 1e-6);
        reading_destroy(&r);
    }
    static const struct {
        const char *file, *parameters, *message;
    } BAD[] = {
        {"50 0 1.5", "", "has 3 numbers: it should have four for each surface"},
        {"-50 0 1.5 30 50 5 1 30", "", "does not focus light"},
        {"50 0 1.5 30 -50 5 1 30", "\"float focusdistance\" 0.1",
         "\"focusdistance\" should be at least 4 focal lengths, 0.2 m"},
        {"50 0 1.5 30 -50 5 1 30", "\"float aperturediameter\" 0", "\"aperturediameter\" should be above 0"},
        {"50 0 1.5 thirty", "", "a number should stand here"},
    };
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++) {
        FILE *f = fopen(path, "w");
        assert_non_null(f);
        fputs(BAD[i].file, f);
        fclose(f);
        reading r = read_realistic(path, BAD[i].parameters);
        assert_int_equal(r.status, AG_ERROR_SCENE);
        assert_int_equal(r.count[AG_LOG_ERROR], 1);
        if (!strstr(r.said[AG_LOG_ERROR], BAD[i].message))
            fail_msg("%s\n%s", BAD[i].message, r.said[AG_LOG_ERROR]);
        reading_destroy(&r);
    }
    close(file);
    remove(path);
    reading r = read_realistic(path, "");
    assert_int_equal(r.status, AG_ERROR_INPUT);
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(perspective), cmocka_unit_test(orthographic),    cmocka_unit_test(lenses),
        cmocka_unit_test(equal_area),  cmocka_unit_test(equirectangular), cmocka_unit_test(directive),
        cmocka_unit_test(realistic),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
