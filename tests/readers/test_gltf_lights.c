/* test_gltf_lights.c: lamps in the units of whoever wrote the file, and cameras with the film of their proportions.
 * Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/gltf_fixture.h"

static const double PI_ = 3.14159265358979323846;

static const char *lamp_text(const char *generator, const char *lamp, const char *node)
{
    static char text[2048];
    snprintf(text, sizeof text,
             "{'asset': {'version': '2.0', 'generator': '%s'}, 'extensions': {'KHR_lights_punctual': {'lights': [%s]}},"
             "'nodes': [{%s 'extensions': {'KHR_lights_punctual': {'light': 0}}}]}",
             generator, lamp, node);
    return text;
}

static void lamps(void **state)
{
    (void)state;
    gltf_expect_warning(lamp_text("", "{'type': 'point', 'name': 'bulb', 'intensity': 8, 'range': 3}", ""),
                        "the range of lamp \"bulb\" is not heeded");
    reading r = gltf_of(lamp_text("", "{'type': 'point', 'color': [1, 0.5, 0.25], 'intensity': 8}",
                                  "'translation': [1, 2, 3], 'scale': [5, 5, 5],"));
    const light *l = &r.scene->lights[0];
    assert_int_equal(r.scene->light_count, 1);
    assert_int_equal(l->kind, LIGHT_POINT);
    assert_rgb(l->as.point.intensity, 8, 4, 2, 0);
    assert_vec3(l->as.point.position, 1, 2, 3, 0);
    reading_destroy(&r);

    r = gltf_of(
        lamp_text("", "{'type': 'directional', 'intensity': 3}", "'rotation': [0, 1, 0, 1], 'scale': [1, 1, 9],"));
    l = &r.scene->lights[0];
    assert_int_equal(l->kind, LIGHT_DISTANT);
    assert_rgb(l->as.distant.irradiance, 3, 3, 3, 0);
    assert_vec3(l->as.distant.direction, -1, 0, 0, 1e-6); /* -z turned by a quarter about y */
    reading_destroy(&r);

    r = gltf_of(lamp_text("", "{'type': 'spot', 'spot': {'innerConeAngle': 0.5, 'outerConeAngle': 0.75}}", ""));
    l = &r.scene->lights[0];
    assert_int_equal(l->kind, LIGHT_SPOT);
    assert_rgb(l->as.spot.intensity, 1, 1, 1, 0);
    assert_vec3(l->as.spot.direction, 0, 0, -1, 0);
    assert_near(l->as.spot.falloff_start, 1 - cos(0.5), 1e-7);
    assert_near(l->as.spot.falloff_end, 1 - cos(0.75), 1e-7);
    reading_destroy(&r);
    r = gltf_of(lamp_text("", "{'type': 'spot'}", ""));
    assert_near(r.scene->lights[0].as.spot.falloff_start, 0, 0);
    assert_near(r.scene->lights[0].as.spot.falloff_end, 1 - sqrt(0.5), 1e-7);
    reading_destroy(&r);

    r = gltf_of(lamp_text("", "{'type': 'point', 'intensity': 0}", "")); /* dark: as if there were none */
    expect_said(&r, AG_LOG_INFO, "the file has no light");
    reading_destroy(&r);
}

/* Cycles dimmed spots beside their axis, before 3.5. */
static void spots_of_old_blenders_dim(void **state)
{
    (void)state;
    static const struct {
        const char *generator;
        bool dims;
    } GENERATORS[] = {{"", false},
                      {"Khronos glTF Blender I/O v3.4.50", true},
                      {"Khronos glTF Blender I/O v2.83.9", true},
                      {"Khronos glTF Blender I/O v3.5.30", false},
                      {"Khronos glTF Blender I/O v4.0.1", false}};
    for (size_t k = 0; k < sizeof GENERATORS / sizeof *GENERATORS; k++) {
        reading r = gltf_of(lamp_text(GENERATORS[k].generator, "{'type': 'spot', 'spot': {}}", ""));
        assert_int_equal(r.scene->lights[0].as.spot.dims_by_cosine, GENERATORS[k].dims);
        reading_destroy(&r);
    }
}

static void units(void **state)
{
    (void)state;
    static const struct {
        const char *generator;
        double point, sun; /* of 683 cd and 683 lx */
    } GENERATORS[] = {
        {"", 683, 683},
        {"THREE.GLTFExporter r160", 683, 683},
        {"Khronos glTF Blender I/O v4.2.57", 1, 1},
        {"Khronos glTF Blender I/O v3.6.5", 1, 1},
        {"Khronos glTF Blender I/O v10.0.1", 1, 1},
        {"Khronos glTF Blender I/O v3.5.30", 1, 1},
        {"Khronos glTF Blender I/O v3.4.50", 1, 1},
        {"Khronos glTF Blender I/O v3.3.36", 683 / (4 * PI_), 683},
        {"Khronos glTF Blender I/O v1.8.19", 683 / (4 * PI_), 683},
        {"Khronos glTF Blender I/O", 683, 683},
    };
    for (size_t i = 0; i < sizeof GENERATORS / sizeof *GENERATORS; i++) {
        reading r = gltf_of(lamp_text(GENERATORS[i].generator, "{'type': 'point', 'intensity': 683}", ""));
        assert_near(r.scene->lights[0].as.point.intensity.r, GENERATORS[i].point, 1e-5 * GENERATORS[i].point);
        reading_destroy(&r);
        r = gltf_of(lamp_text(GENERATORS[i].generator, "{'type': 'directional', 'intensity': 683}", ""));
        assert_near(r.scene->lights[0].as.distant.irradiance.r, GENERATORS[i].sun, 1e-5 * GENERATORS[i].sun);
        expect_said(&r, AG_LOG_INFO,
                    GENERATORS[i].sun == 1 ? "lamps are read as standard (cd and lx at 683 lm/W)"
                    : GENERATORS[i].point == 683
                        ? "lamps are read as unitless (W/sr and W/m^2, or cd and lx where emission is in nit)"
                        : "lamps are read as raw (W, and W/m^2 of suns)");
        expect_said(&r, AG_LOG_INFO, GENERATORS[i].generator);
        reading_destroy(&r);
    }
}

static void lamp_errors(void **state)
{
    (void)state;
    static const struct {
        const char *lamp, *node, *error;
    } WRONG[] = {
        {"{}", "", "extensions.KHR_lights_punctual.lights[0].type: is missing"},
        {"{'type': 'area'}", "", "lights[0]: there is no light of type \"area\""},
        {"{'type': 'point', 'intensity': -1}", "", "lights[0]: its intensity is -1, which should be from 0 to 1e24"},
        {"{'type': 'point', 'color': [1, 1]}", "", "lights[0].color: should have 3 numbers, but has 2"},
        {"{'type': 'spot', 'spot': {'innerConeAngle': 1, 'outerConeAngle': 0.5}}", "",
         "lights[0].spot: its angles are 1 and 0.5, which should be 0 <= inner < outer <= pi / 2"},
        {"{'type': 'spot', 'spot': {'outerConeAngle': 2}}", "", "its angles are 0 and 2"},
        {"{'type': 'spot'}", "'scale': [0, 0, 0],", "lights[0]: its node leaves no direction"},
        {"{'type': 'point'}", "'translation': [1e30, 0, 0],", "lights[0]: it is beyond 1e18 units"},
    };
    for (size_t i = 0; i < sizeof WRONG / sizeof *WRONG; i++)
        gltf_expect_error(lamp_text("", WRONG[i].lamp, WRONG[i].node), AG_ERROR_SCENE, WRONG[i].error);
}

static const char *camera_text(const char *camera_json, const char *node)
{
    static char text[2048];
    snprintf(text, sizeof text, "{" GLTF_ASSET "'cameras': [%s], 'nodes': [{%s 'camera': 0}]}", camera_json, node);
    return text;
}

static void expect_film(const reading *r, double width, double height)
{
    const scene_hints *hints = &r->scene->hints;
    assert_true(hints->width.is_given && hints->height.is_given);
    assert_near((double)hints->width.value, width, 0);
    assert_near((double)hints->height.value, height, 0);
}

/* The direction of the ray through a point of the film, which lies in [0, 1]. */
static vec3 direction_at(const reading *r, float x, float y)
{
    camera c = r->scene->camera;
    const scene_hints *hints = &r->scene->hints;
    c.tan_half_fov = (float)tan((double)c.fov_degrees * PI_ / 360.0);
    scene_ray ray = camera_generate_ray(&c, x, y, (float)((double)hints->width.value / (double)hints->height.value),
                                        (vec2){0.5f, 0.5f}, 0.0f);
    return ray.direction;
}

/* The picture's upper edge is half of yfov above its middle, whatever its proportions. */
static void cameras(void **state)
{
    (void)state;
    static const struct {
        double aspect; /* 0: not given */
        double width, height;
    } SHAPES[] = {{0, 1280, 720}, {1, 1280, 1280}, {2, 1280, 640}, {0.5, 640, 1280}, {1000, 1280, 1}};
    for (size_t i = 0; i < sizeof SHAPES / sizeof *SHAPES; i++) {
        char text[256], aspect[64] = "";
        if (SHAPES[i].aspect > 0)
            snprintf(aspect, sizeof aspect, "'aspectRatio': %g,", SHAPES[i].aspect);
        snprintf(text, sizeof text, "{'type': 'perspective', 'perspective': {%s 'yfov': 0.8, 'znear': 0.1}}", aspect);
        reading r = gltf_of(camera_text(text, "'translation': [1, 2, 3], 'scale': [2, 2, 2],"));
        expect_film(&r, SHAPES[i].width, SHAPES[i].height);
        vec3 middle = direction_at(&r, 0.5f, 0.5f), upper = direction_at(&r, 0.5f, 0.0f),
             right = direction_at(&r, 1.0f, 0.5f);
        assert_vec3(middle, 0, 0, -1, 1e-6);
        assert_near(upper.y / -upper.z, tan(0.4), SHAPES[i].aspect == 1000 ? 0.2 : 1e-5); /* 1280 by 1.28 pixels */
        assert_near(upper.x, 0, 1e-6);
        assert_near(right.x / -right.z, tan(0.4) * SHAPES[i].width / SHAPES[i].height,
                    SHAPES[i].aspect == 1000 ? 1e9 : 1e-4);
        assert_vec3(transform_point(&r.scene->camera.world_from_camera, vec3_make(0, 0, 0)), 1, 2, 3, 0);
        reading_destroy(&r);
    }
    /* turned by a quarter about y it looks along -x, and -z is on its right */
    reading r =
        gltf_of(camera_text("{'type': 'perspective', 'perspective': {'yfov': 0.8}}", "'rotation': [0, 1, 0, 1],"));
    assert_vec3(direction_at(&r, 0.5f, 0.5f), -1, 0, 0, 1e-6);
    assert_true(direction_at(&r, 1.0f, 0.5f).z < -0.1f);
    reading_destroy(&r);
    /* a mirroring node's picture is mirrored */
    r = gltf_of(camera_text("{'type': 'perspective', 'perspective': {'yfov': 0.8}}", "'scale': [-1, 1, 1],"));
    assert_vec3(direction_at(&r, 0.5f, 0.5f), 0, 0, -1, 1e-6);
    assert_true(direction_at(&r, 1.0f, 0.5f).x < -0.1f);
    reading_destroy(&r);
}

/* Rays of an orthographic camera are parallel; those at the picture's edge are xmag and ymag off its middle. */
static void orthographic_camera(void **state)
{
    (void)state;
    reading r =
        gltf_of(camera_text("{'type': 'orthographic', 'orthographic': {'xmag': 3, 'ymag': 2, 'zfar': 9, 'znear': 0}}",
                            "'translation': [1, 2, 3], 'scale': [2, 2, 2],"));
    camera c = r.scene->camera;
    expect_film(&r, 1280, 853);
    c.tan_half_fov = 1.0f;
    scene_ray corner = camera_generate_ray(&c, 1.0f, 0.0f, 1.5f, (vec2){0.5f, 0.5f}, 0.0f);
    assert_vec3(corner.origin, 1 + 3, 2 + 2, 3, 1e-5);
    assert_vec3(corner.direction, 0, 0, -1, 1e-6);
    reading_destroy(&r);
}

static void several_cameras(void **state)
{
    (void)state;
    reading r = gltf_of("{" GLTF_ASSET "'cameras': [{'type': 'perspective', 'perspective': {'yfov': 0.8}},"
                        "{'name': 'wide', 'type': 'perspective', 'perspective': {'yfov': 1.6}}],"
                        "'nodes': [{'children': [1]}, {'camera': 1}, {'camera': 0}]}");
    assert_near(r.scene->camera.fov_degrees, 1.6 * 180 / PI_, 1e-4);
    expect_said(&r, AG_LOG_INFO, "camera \"cameras[0]\" is not used");
    reading_destroy(&r);
}

static void camera_errors(void **state)
{
    (void)state;
    static const struct {
        const char *camera_json, *node, *error;
    } WRONG[] = {
        {"{}", "", "cameras[0].type: is missing"},
        {"{'type': 'fisheye'}", "", "cameras[0]: there is no camera of type \"fisheye\""},
        {"{'type': 'perspective'}", "", "cameras[0].perspective: is missing"},
        {"{'type': 'perspective', 'perspective': {}}", "", "cameras[0].perspective.yfov: is missing"},
        {"{'type': 'perspective', 'perspective': {'yfov': 0}}", "", "its yfov is 0, which should be within (0, pi)"},
        {"{'type': 'perspective', 'perspective': {'yfov': 4}}", "", "its yfov is 4, which should be within (0, pi)"},
        {"{'type': 'perspective', 'perspective': {'yfov': 1, 'aspectRatio': -1}}", "", "its aspectRatio is -1"},
        {"{'type': 'orthographic', 'orthographic': {'xmag': 1}}", "", "cameras[0].orthographic.ymag: is missing"},
        {"{'type': 'orthographic', 'orthographic': {'xmag': 0, 'ymag': 1}}", "",
         "its xmag and ymag are 0 and 1, which should not be 0"},
        {"{'type': 'orthographic', 'orthographic': {'xmag': 1, 'ymag': 1e9}}", "", "its xmag over ymag is 1e-09"},
        {"{'type': 'perspective', 'perspective': {'yfov': 1}}", "'scale': [1, 0, 1],",
         "cameras[0]: its node leaves no room"},
    };
    for (size_t i = 0; i < sizeof WRONG / sizeof *WRONG; i++)
        gltf_expect_error(camera_text(WRONG[i].camera_json, WRONG[i].node), AG_ERROR_SCENE, WRONG[i].error);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(lamps),           TEST_IN_FOLDER(spots_of_old_blenders_dim),
        TEST_IN_FOLDER(units),           TEST_IN_FOLDER(lamp_errors),
        TEST_IN_FOLDER(cameras),         TEST_IN_FOLDER(orthographic_camera),
        TEST_IN_FOLDER(several_cameras), TEST_IN_FOLDER(camera_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
