/* test_import_scene.c: records become a scene; records that do not hold together, cut or damaged anywhere, are
 * errors. */
#define _POSIX_C_SOURCE 200809L
#include "model/import_scene.h"

#include "fixtures/model_fixture.h"
#include "model/import_model.h"

typedef struct buffer {
    unsigned char bytes[65536];
    size_t size;
} buffer;

static void put(buffer *b, import_record_kind kind, const void *bytes, size_t size)
{
    import_record head = {.kind = kind, .size = size};
    assert_true(b->size + sizeof head + size + 8 <= sizeof b->bytes);
    memcpy(b->bytes + b->size, &head, sizeof head);
    b->size += sizeof head;
    if (size > 0)
        memcpy(b->bytes + b->size, bytes, size);
    b->size += (size + 7) & ~(size_t)7;
}

static import_material plain_material(void)
{
    import_material m;
    memset(&m, 0, sizeof m);
    m.illumination = -1;
    m.diffuse = rgb_gray(.5f);
    m.filter = rgb_gray(1.0f);
    m.exponent = m.ior = m.roughness = m.metallic = -1.0f;
    m.opacity = 1.0f;
    return m;
}

typedef struct triangle {
    import_mesh head;
    vec3 positions[3];
    vec3 normals[3];
    vec2 uvs[3];
    uint32_t indices[3];
} triangle;

static triangle plain_triangle(void)
{
    triangle t = {.head = {.vertex_count = 3, .triangle_count = 1, .has_normals = 1, .has_uvs = 1, .left_out = 2},
                  .positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                  .normals = {{0, 0, 2}, {0, 0, 2}, {NAN, 0, 1}},
                  .uvs = {{0, 0}, {1, 0}, {INFINITY, 1}},
                  .indices = {0, 1, 2}};
    snprintf(t.head.name, sizeof t.head.name, "tri");
    return t;
}

static import_instance plain_instance(void)
{
    import_instance i = {.world_from_mesh = {{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 5}, {0, 0, 0, 1}}};
    return i;
}

static void put_all(buffer *b)
{
    import_material m = plain_material();
    triangle t = plain_triangle();
    import_instance i = plain_instance();
    import_camera c = {.forward = {0, 0, -1}, .up = {0, 1, 0}, .horizontal_fov = 1.0f};
    import_light l = {.kind = IMPORT_LIGHT_AREA,
                      .color = {1, 1, 1},
                      .direction = {0, -1, 0},
                      .up = {0, 0, 1},
                      .position = {0, 3, 0},
                      .attenuation = {0, 0, 1},
                      .size = {2, .5f}};
    b->size = 0;
    put(b, IMPORT_RECORD_WARNING, "mind this", 9);
    put(b, IMPORT_RECORD_MATERIAL, &m, sizeof m);
    put(b, IMPORT_RECORD_MESH, &t, sizeof t);
    put(b, IMPORT_RECORD_INSTANCE, &i, sizeof i);
    put(b, IMPORT_RECORD_CAMERA, &c, sizeof c);
    put(b, IMPORT_RECORD_LIGHT, &l, sizeof l);
    put(b, IMPORT_RECORD_END, NULL, 0);
}

static reading fill(const unsigned char *bytes, size_t size)
{
    reading r;
    run_context run;
    reading_begin(&r, &run);
    r.status = import_scene_fill(&run, "file", bytes, size, r.scene);
    reading_end(&run);
    return r;
}

static buffer b; /* large */

static void records_become_a_scene(void **state)
{
    (void)state;
    put_all(&b);
    reading r = fill(b.bytes, b.size);
    assert_int_equal(r.status, AG_OK);
    assert_string_equal(r.said[AG_LOG_WARNING],
                        "file: warning: mind this\nfile: warning: 2 points and lines are left out\n"
                        "file: warning: 2 normals or texture coordinates are not finite, and are not used\n");
    const mesh *m = model_mesh(&r, 0);
    assert_vec3(m->positions[1], 2, 0, 5, 0);
    assert_vec3(m->normals[0], 0, 0, 1, 0);
    assert_vec3(m->normals[2], 0, 0, 0, 0);
    assert_near(m->uvs[2].x, 0, 0);
    assert_true(r.scene->has_camera);

    /* the area light: a rectangle of 2 x 0.5 that shines down as pi on its axis does, pi c d^2 / q d^2 */
    assert_int_equal(r.scene->light_count, 1);
    const light *l = &r.scene->lights[0];
    assert_int_equal(l->kind, LIGHT_AREA);
    assert_false(l->as.area.two_sided);
    assert_near(l->as.area.radiance.r, 3.14159265, 1e-5);
    const shape *s = &r.scene->shapes[l->as.area.shape_index];
    assert_near(shape_area(s), 1.0, 1e-6);
    const mesh *q = &s->as.mesh;
    vec3 u = vec3_sub(q->positions[1], q->positions[0]), v = vec3_sub(q->positions[2], q->positions[0]);
    assert_true(vec3_cross(u, v).y < 0.0f);
    assert_near(vec3_length(u), 2, 1e-6);
    reading_destroy(&r);
}

/* Three units are half the width of a picture of 2:1. */
static void orthographic_cameras_are_as_wide_as_the_file_says(void **state)
{
    (void)state;
    triangle t = plain_triangle();
    import_instance i = plain_instance();
    import_camera c = {
        .position = {0, 0, 9}, .forward = {0, 0, -1}, .up = {0, 1, 0}, .aspect = 2, .orthographic_half_width = 3};
    b.size = 0;
    put(&b, IMPORT_RECORD_MESH, &t, sizeof t);
    put(&b, IMPORT_RECORD_INSTANCE, &i, sizeof i);
    put(&b, IMPORT_RECORD_CAMERA, &c, sizeof c);
    put(&b, IMPORT_RECORD_END, NULL, 0);
    reading r = fill(b.bytes, b.size);
    assert_int_equal(r.status, AG_OK);
    scene_ray ray = camera_generate_ray(&r.scene->camera, 1.0f, 0.0f, 2.0f, (vec2){.5f, .5f}, 0.0f);
    assert_vec3(ray.origin, 3, 1.5, 9, 1e-6);
    assert_vec3(ray.direction, 0, 0, -1, 1e-6);
    reading_destroy(&r);
}

/* The shift is a tenth to the right and a quarter down, of the longer side of a picture of 2:1 whose shorter one is 2.
 * Squares stay squares in pictures of any proportions. */
static void a_shift_does_not_stretch_the_picture(void **state)
{
    (void)state;
    static const float ASPECTS[] = {2, 1, .5f, 16.0f / 9.0f};
    triangle t = plain_triangle();
    import_instance i = plain_instance();
    import_camera c = {.position = {0, 0, 9},
                       .forward = {0, 0, -1},
                       .up = {0, 1, 0},
                       .aspect = 2,
                       .orthographic_half_width = 2,
                       .shift = {.1f, -.25f}};
    for (int is_perspective = 0; is_perspective < 2; is_perspective++) {
        if (is_perspective)
            c.orthographic_half_width = 0, c.horizontal_fov = 2 * (float)atan(2); /* 90 degrees high */
        b.size = 0;
        put(&b, IMPORT_RECORD_MESH, &t, sizeof t);
        put(&b, IMPORT_RECORD_INSTANCE, &i, sizeof i);
        put(&b, IMPORT_RECORD_CAMERA, &c, sizeof c);
        put(&b, IMPORT_RECORD_END, NULL, 0);
        reading r = fill(b.bytes, b.size);
        assert_int_equal(r.status, AG_OK);
        camera seen = r.scene->camera;
        seen.tan_half_fov = 1.0f; /* as scene_commit does */
        assert_float_equal(seen.fov_degrees, 90, 1e-4);
        for (int k = 0; k < 4; k++)
            for (int corner = 0; corner < 2; corner++) {
                const float aspect = ASPECTS[k], sign = corner ? 1.0f : -1.0f;
                const float x = .4f + sign * fmaxf(aspect, 1.0f), y = -1.0f - sign * fmaxf(1.0f / aspect, 1.0f);
                const float at = (float)corner;
                scene_ray ray = camera_generate_ray(&seen, at, at, aspect, (vec2){.5f, .5f}, 0.0f);
                if (is_perspective) {
                    const vec3 way = vec3_normalize(vec3_make(x, y, -1));
                    assert_vec3(ray.direction, way.x, way.y, way.z, 1e-6);
                } else {
                    assert_vec3(ray.origin, x, y, 9, 1e-5);
                }
            }
        reading_destroy(&r);
    }
}

/* A PNG of one red pixel, and one that is none. */
static void pictures_within_the_file(void **state)
{
    (void)state;
    static const unsigned char PNG[] = {
        0x89, 'P',  'N',  'G', '\r', '\n', 0x1a, '\n', 0,    0,    0,    13,   'I',  'H',  'D',  'R', 0, 0,
        0,    1,    0,    0,   0,    1,    8,    2,    0,    0,    0,    0x90, 0x77, 0x53, 0xde, 0,   0, 0,
        12,   'I',  'D',  'A', 'T',  0x08, 0xd7, 0x63, 0xf8, 0xcf, 0xc0, 0,    0,    3,    1,    1,   0, 0x18,
        0xdd, 0x8d, 0xb0, 0,   0,    0,    0,    'I',  'E',  'N',  'D',  0xae, 0x42, 0x60, 0x82};
    triangle t = plain_triangle();
    import_instance i = plain_instance();
    import_material m = plain_material();
    t.head.left_out = 0;
    t.normals[2].x = t.uvs[2].x = 0;
    for (int k = 0; k < 3; k++) {
        snprintf(m.pictures[IMPORT_COLOR].path, IMPORT_PATH_SIZE, "*%d", k);
        m.pictures[IMPORT_COLOR].wrap_t = IMPORT_IS_MIRRORED;
        b.size = 0;
        put(&b, IMPORT_RECORD_PICTURE, PNG, sizeof PNG);
        put(&b, IMPORT_RECORD_PICTURE, NULL, 0);
        put(&b, IMPORT_RECORD_MATERIAL, &m, sizeof m);
        put(&b, IMPORT_RECORD_MESH, &t, sizeof t);
        put(&b, IMPORT_RECORD_INSTANCE, &i, sizeof i);
        put(&b, IMPORT_RECORD_END, NULL, 0);
        reading r = fill(b.bytes, b.size);
        assert_int_equal(r.status, AG_OK);
        if (k == 0) {
            assert_null(r.said[AG_LOG_WARNING]);
            const texture *x = &r.scene->textures.items[model_material(&r, 0)->reflectance_texture];
            assert_int_equal(x->wraps.t, TEXTURE_WRAP_MIRROR);
            rgb c = texture_image_rgb(r.scene->textures.images[x->image_index], x->wraps, x->filter, .5f, .5f);
            assert_rgb(c, 1, 0, 0, 1e-6);
        } else {
            char expected[128];
            snprintf(expected, sizeof expected,
                     "file: warning: the picture \"*%d\" is not used: there is no such picture within the file\n", k);
            assert_string_equal(r.said[AG_LOG_WARNING], expected);
        }
        reading_destroy(&r);
    }
}

static void errors_of_the_process_are_told(void **state)
{
    (void)state;
    b.size = 0;
    put(&b, IMPORT_RECORD_ERROR, "it is no good", 13);
    reading r = fill(b.bytes, b.size);
    assert_int_equal(r.status, AG_ERROR_INPUT);
    assert_string_equal(r.said[AG_LOG_ERROR], "file: error: it is no good\n");
    reading_destroy(&r);
}

static void expect_refused(const char *text)
{
    reading r = fill(b.bytes, b.size);
    assert_int_equal(r.status, AG_ERROR_INPUT);
    assert_string_equal(r.said[AG_LOG_ERROR], text);
    reading_destroy(&r);
}

static void what_does_not_hold_together_is_refused(void **state)
{
    (void)state;
    static const char BROKEN[] = "file: error: what was read of the file does not hold together\n";
    triangle t = plain_triangle();
    import_instance i = plain_instance();
    for (int k = 0; k < 6; k++) {
        triangle wrong = t;
        import_instance other = i;
        const char *expected = BROKEN;
        switch (k) {
        case 0:
            wrong.indices[2] = 3,
            expected = "file: error: mesh \"tri\": triangle 0 refers to vertex 3, but there are 3\n";
            break;
        case 1:
            wrong.positions[1].y = INFINITY, expected = "file: error: mesh \"tri\": vertex 1 is not a finite number\n";
            break;
        case 2:
            other.world_from_mesh[0][0] = 1e20,
            expected = "file: error: mesh \"tri\": vertex 1 lies beyond 1e18 units\n";
            break;
        case 3: wrong.head.vertex_count = 4; break;
        case 4: wrong.head.triangle_count = UINT32_MAX, expected = "file: error: a mesh is too large\n"; break;
        default: other.mesh_index = 1; break;
        }
        b.size = 0;
        put(&b, IMPORT_RECORD_MESH, &wrong, sizeof wrong);
        put(&b, IMPORT_RECORD_INSTANCE, &other, sizeof other);
        put(&b, IMPORT_RECORD_END, NULL, 0);
        expect_refused(expected);
    }
    b.size = 0;
    put(&b, IMPORT_RECORD_END, NULL, 0);
    expect_refused("file: error: there is no triangle in the file: nothing to see\n");
    b.size = 0;
    put(&b, IMPORT_RECORD_CAMERA, &i, sizeof i);
    put(&b, IMPORT_RECORD_END, NULL, 0);
    expect_refused(BROKEN);
}

static void cut_anywhere_is_an_error(void **state)
{
    (void)state;
    put_all(&b);
    for (size_t size = 0; size < b.size; size += size < 256 ? 1 : 61) {
        unsigned char *bytes = malloc(size + 1); /* so that sanitizers see reads beyond */
        assert_non_null(bytes);
        memcpy(bytes, b.bytes, size);
        reading r = fill(bytes, size);
        assert_int_equal(r.status, AG_ERROR_INPUT);
        assert_int_equal(r.count[AG_LOG_ERROR], 1);
        reading_destroy(&r);
        free(bytes);
    }
}

static void damaged_anywhere_does_no_harm(void **state)
{
    (void)state;
    static const unsigned char VALUES[] = {0, 1, 0x7f, 0x80, 0xff};
    static buffer whole;
    put_all(&whole);
    int good = 0, bad = 0;
    for (size_t at = 0; at < whole.size; at += at % 1024 < 160 ? 1 : 31)
        for (size_t v = 0; v < sizeof VALUES; v++) {
            b = whole;
            b.bytes[at] = VALUES[v];
            reading r = fill(b.bytes, b.size);
            assert_true(r.status == AG_OK || (r.status == AG_ERROR_INPUT && r.count[AG_LOG_ERROR] == 1));
            good += r.status == AG_OK;
            bad += r.status != AG_OK;
            model_is_sound(&r);
            reading_destroy(&r);
        }
    assert_true(good > 100 && bad > 50);
}

static void cameras_and_lights_that_make_no_sense_are_left_out(void **state)
{
    (void)state;
    triangle t = plain_triangle();
    import_instance i = plain_instance();
    import_camera c = {.name = "c", .forward = {0, 0, -1}, .up = {0, 1, 0}, .horizontal_fov = 1.0f};
    import_light l = {.name = "l", .kind = IMPORT_LIGHT_SPOT, .color = {1, 1, 1}, .direction = {0, -1, 0}};
    for (int k = 0; k < 8; k++) {
        import_camera camera_of_k = c;
        import_light light_of_k = l;
        switch (k) {
        case 0: camera_of_k.up[1] = 0, camera_of_k.up[2] = 3; break;
        case 1: camera_of_k.horizontal_fov = 7.0f; break;
        case 2: camera_of_k.horizontal_fov = NAN; break;
        case 3: camera_of_k.forward[0] = (double)NAN; break;
        case 4: light_of_k.direction[1] = 0; break;
        case 5: light_of_k.color.g = -1; break;
        case 6: light_of_k.position[0] = (double)NAN; break;
        default: light_of_k.kind = 77; break;
        }
        b.size = 0;
        put(&b, IMPORT_RECORD_MESH, &t, sizeof t);
        put(&b, IMPORT_RECORD_INSTANCE, &i, sizeof i);
        if (k < 4)
            put(&b, IMPORT_RECORD_CAMERA, &camera_of_k, sizeof camera_of_k);
        else
            put(&b, IMPORT_RECORD_LIGHT, &light_of_k, sizeof light_of_k);
        put(&b, IMPORT_RECORD_END, NULL, 0);
        reading r = fill(b.bytes, b.size);
        assert_int_equal(r.status, AG_OK);
        assert_non_null(strstr(r.said[AG_LOG_WARNING],
                               k < 4 ? "file: warning: camera \"c\" makes no sense and is left out\n"
                                     : "file: warning: light \"l\" is dark or makes no sense, and is left out\n"));
        assert_int_equal(r.scene->light_count, 2); /* the two that are made up */
        reading_destroy(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(records_become_a_scene),
        cmocka_unit_test(orthographic_cameras_are_as_wide_as_the_file_says),
        cmocka_unit_test(a_shift_does_not_stretch_the_picture),
        cmocka_unit_test(pictures_within_the_file),
        cmocka_unit_test(errors_of_the_process_are_told),
        cmocka_unit_test(what_does_not_hold_together_is_refused),
        cmocka_unit_test(cut_anywhere_is_an_error),
        cmocka_unit_test(damaged_anywhere_does_no_harm),
        cmocka_unit_test(cameras_and_lights_that_make_no_sense_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
