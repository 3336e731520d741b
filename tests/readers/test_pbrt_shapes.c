/* test_pbrt_shapes.c: shapes as the pbrt reader makes them: defaults, world space, which side is outside, patches, and
 * what is dropped.
 * Threads: one. */
#include "fixtures/pbrt_fixture.h"

static const mesh *only_mesh(const reading *r)
{
    assert_int_equal(r->scene->shape_count, 1);
    assert_int_equal(r->scene->shapes[0].kind, SHAPE_MESH);
    return &r->scene->shapes[0].as.mesh;
}

/* The outside normal of a triangle without shading normals, as shape.h has it. */
static vec3 outside(const shape *s, uint32_t triangle)
{
    const mesh *m = &s->as.mesh;
    const uint32_t *i = m->indices + 3 * (size_t)triangle;
    vec3 a = m->positions[i[0]], n = vec3_cross(vec3_sub(m->positions[i[1]], a), vec3_sub(m->positions[i[2]], a));
    n = vec3_normalize(n);
    return s->flip_normal ? vec3_negate(n) : n;
}

static void spheres_and_disks_have_defaults(void **state)
{
    (void)state;
    reading r = reading_of(
        "WorldBegin Shape \"sphere\" Shape \"disk\"\n"
        "Shape \"sphere\" \"float radius\" [ 2.5 ] \"float zmin\" -2.5 \"float zmax\" 9 \"float phimax\" 360\n"
        "Shape \"disk\" \"float radius\" 3 \"float innerradius\" 1 \"float height\" -2");
    const shape *s = r.scene->shapes;
    assert_int_equal(r.scene->shape_count, 4);
    assert_int_equal(s[0].kind, SHAPE_SPHERE);
    assert_near(s[0].as.quadric.radius, 1, 0);
    assert_int_equal(s[1].kind, SHAPE_DISK);
    assert_true(s[1].as.quadric.radius == 1.0f && s[1].as.quadric.inner_radius == 0.0f);
    assert_near(s[1].as.quadric.height, 0, 0);
    assert_near(s[2].as.quadric.radius, 2.5, 0);
    assert_true(s[3].as.quadric.radius == 3.0f && s[3].as.quadric.inner_radius == 1.0f);
    assert_near(s[3].as.quadric.height, -2, 0);
    for (int i = 0; i < 4; i++) {
        assert_false(s[i].flip_normal);
        assert_int_equal(s[i].light_index, SHAPE_NO_LIGHT);
        assert_rgb(r.scene->materials[s[i].material_index].reflectance, .5, .5, .5, 0);
    }
    reading_destroy(&r);
}

/* pbrt's spheres and disks: a mirror leaves their outside where it is, ReverseOrientation turns it. */
static void quadrics_keep_their_outside_in_a_mirror(void **state)
{
    (void)state;
    reading r =
        reading_of("WorldBegin Scale -1 1 1 Shape \"sphere\" Shape \"disk\" ReverseOrientation Shape \"sphere\"\n"
                   "Shape \"disk\" ReverseOrientation Shape \"disk\"");
    const bool expected[] = {false, false, true, true, false};
    assert_int_equal(r.scene->shape_count, 5);
    for (int i = 0; i < 5; i++)
        assert_int_equal(r.scene->shapes[i].flip_normal, expected[i]);
    reading_destroy(&r);
}

static void meshes_come_to_world_space(void **state)
{
    (void)state;
    reading r = reading_of(
        "WorldBegin Translate 1 2 3 Scale 2 1 1\n"
        "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 0 0 1 ] \"integer indices\" [ 0 1 2 0 2 3 ]\n"
        "\"normal N\" [ 1 1 0 0 0 5 0 0 0 0 -1 0 ] \"point2 uv\" [ 0 0 1 0 0 1 .5 .25 ]\n"
        "\"vector3 S\" [ 1 0 0 1 0 0 1 0 0 1 0 0 ] \"integer faceIndices\" [ 0 1 ]");
    const mesh *m = only_mesh(&r);
    assert_int_equal(m->vertex_count, 4);
    assert_int_equal(m->triangle_count, 2);
    assert_vec3(m->positions[0], 1, 2, 3, 0);
    assert_vec3(m->positions[1], 3, 2, 3, 0);
    assert_vec3(m->positions[3], 1, 2, 4, 0);
    assert_vec3(m->positions[4], 0, 0, 0, 0); /* the room behind the last */
    const uint32_t indices[] = {0, 1, 2, 0, 2, 3};
    assert_memory_equal(m->indices, indices, sizeof indices);
    /* by the inverse transpose, then to unit length; none stays none */
    assert_vec3(m->normals[0], 0.5 / sqrt(1.25), 1 / sqrt(1.25), 0, 1e-6);
    assert_vec3(m->normals[1], 0, 0, 1, 0);
    assert_vec3(m->normals[2], 0, 0, 0, 0);
    assert_vec3(m->normals[3], 0, -1, 0, 0);
    assert_near(m->uvs[3].x, .5, 0);
    assert_near(m->uvs[3].y, .25, 0);
    reading_destroy(&r);
    /* three vertices do without indices, and without normals and uvs there are none */
    r = reading_of("WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]");
    m = only_mesh(&r);
    assert_int_equal(m->triangle_count, 1);
    assert_null(m->normals);
    assert_null(m->uvs);
    reading_destroy(&r);
}

#define TRIANGLE "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] "

static void meshes_have_the_outside_that_pbrt_gives_them(void **state)
{
    (void)state;
    /* without normals: p0 p1 p2 in object space, whatever mirrors it, and ReverseOrientation */
    reading r = reading_of("WorldBegin " TRIANGLE "ReverseOrientation " TRIANGLE "AttributeBegin Scale 1 1 -1 " TRIANGLE
                           "ReverseOrientation " TRIANGLE "AttributeEnd ReverseOrientation Scale -1 1 1 " TRIANGLE
                           "Scale 1 -1 1 " TRIANGLE);
    const bool flips[] = {false, true, false, true, true, false};
    const double z[] = {1,  -1, 1,
                        -1, 1,  1}; /* of the outside: (+-)z in object space, mirrored for the third and fourth */
    assert_int_equal(r.scene->shape_count, 6);
    for (uint32_t i = 0; i < 6; i++) {
        assert_int_equal(r.scene->shapes[i].flip_normal, flips[i]);
        assert_vec3(outside(&r.scene->shapes[i], 0), 0, 0, z[i], 0);
    }
    reading_destroy(&r);
    /* given normals: ReverseOrientation turns them over, a mirror moves them as normals */
    const char *text =
        "WorldBegin " TRIANGLE "\"normal N\" [ 0 0 -2 0 0 -2 0 0 -2 ] ReverseOrientation " TRIANGLE
        "\"normal N\" [ 0 0 -2 0 0 -2 0 0 -2 ] Scale 1 1 -1 " TRIANGLE "\"normal N\" [ 0 0 -2 0 0 -2 0 0 -2 ]";
    r = reading_of(text);
    const double normal_z[] = {-1, 1, -1};
    for (int i = 0; i < 3; i++)
        assert_vec3(r.scene->shapes[i].as.mesh.normals[0], 0, 0, normal_z[i], 0);
    reading_destroy(&r);
}

static void check_warnings(const char *text, uint32_t shape_count, const char *warnings)
{
    reading r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_OK);
    if (warnings)
        assert_string_equal(r.said[AG_LOG_WARNING], warnings);
    else
        assert_null(r.said[AG_LOG_WARNING]);
    assert_int_equal(r.scene->shape_count, shape_count);
    assert_int_equal(r.scene->light_count, 0);
    reading_destroy(&r);
}

static void triangles_without_area_are_dropped(void **state)
{
    (void)state;
    const char *text = "WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 2 0 0 ]\n"
                       "\"integer indices\" [ 0 1 3 0 1 2 2 2 1 1 3 2 ]";
    reading r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_OK);
    assert_string_equal(
        r.said[AG_LOG_WARNING],
        "t:1:12: warning: Shape \"trianglemesh\": 2 of 4 triangles have no area and are left out, as are any others\n");
    const mesh *m = only_mesh(&r);
    const uint32_t indices[] = {0, 1, 2, 1, 3, 2};
    assert_int_equal(m->triangle_count, 2);
    assert_memory_equal(m->indices, indices, sizeof indices);
    reading_destroy(&r);
    check_warnings("WorldBegin AreaLightSource \"diffuse\"\nShape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 1 1 2 2 2 ]",
                   0,
                   "t:2:1: warning: Shape \"trianglemesh\": 1 of 1 triangles have no area and are left out\n"
                   "t:2:1: warning: Shape \"trianglemesh\" is empty and is left out, and its area light with it\n");
    check_warnings("WorldBegin Shape \"trianglemesh\" \"point3 P\" [ ]", 0,
                   "t:1:12: warning: Shape \"trianglemesh\" is empty and is left out\n");
    check_warnings("WorldBegin Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 1 1 1 2 2 2 3 3 3 ]", 0,
                   "t:1:12: warning: Shape \"bilinearmesh\" is empty and is left out\n");
    check_warnings(
        "WorldBegin AreaLightSource \"diffuse\" Shape \"disk\" \"float radius\" 1e-17 \"float phimax\" 1e-15", 1,
        "t:1:38: warning: the area light has a shape of area 0 and is left out\n");
}

/* Their normals would be no numbers. */
static void quadrics_that_floats_cannot_tell_are_left_out(void **state)
{
    (void)state;
    static const char *const TEXTS[] = {
        "Shape \"sphere\" \"float radius\" 1e-19",
        "Scale 1e-19 1e-19 1e-19 Shape \"cylinder\"",
        "Scale 1 1 1e-19 Shape \"sphere\"",
        "Scale 1e-10 1e-10 1e-10 Shape \"sphere\" \"float radius\" 1e-9",
        "Scale 1e-20 1e-20 1e-20 Shape \"disk\" \"float radius\" 1e20",
        "AreaLightSource \"diffuse\" Shape \"disk\" \"float radius\" 1e-19",
    };
    for (size_t i = 0; i < sizeof TEXTS / sizeof *TEXTS; i++) {
        char text[256], warning[256];
        const char *kind = strstr(TEXTS[i], "disk") ? "disk" : strstr(TEXTS[i], "cylinder") ? "cylinder" : "sphere";
        snprintf(text, sizeof text, "WorldBegin %s", TEXTS[i]);
        snprintf(
            warning, sizeof warning,
            "t:1:%d: warning: Shape \"%s\" is too small, or scaled by too much or too little, for floats and is left "
            "out\n",
            (int)(strstr(text, "Shape") - text) + 1, kind);
        check_warnings(text, 0, warning);
    }
    check_warnings("WorldBegin Shape \"sphere\" \"float radius\" 1e-17 Shape \"disk\" \"float radius\" 1e17", 2, NULL);
}

static void vertex_data_that_does_not_fit_is_ignored(void **state)
{
    (void)state;
    const char *text = "WorldBegin " TRIANGLE "\"normal N\" [ 0 0 1 ] \"point2 uv\" [ 0 0 ]";
    reading r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_OK);
    assert_string_equal(r.said[AG_LOG_WARNING],
                        "t:1:66: warning: Shape \"trianglemesh\": \"N\" should have 9 numbers as "
                        "\"P\" goes, but has 3, and is ignored\n"
                        "t:1:87: warning: Shape \"trianglemesh\": \"uv\" should have 6 numbers as "
                        "\"P\" goes, but has 2, and is ignored\n");
    assert_null(only_mesh(&r)->normals);
    assert_null(only_mesh(&r)->uvs);
    reading_destroy(&r);
}

static void parallelograms_become_two_triangles(void **state)
{
    (void)state;
    /* p00 p10 p01 p11; outside is along dp/du x dp/dv */
    reading r = reading_of("WorldBegin Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 2 0 0 .5 1 0 2.5 1 0 ]\n"
                           "\"point2 uv\" [ 0 0 1 0 0 1 1 1 ] \"normal N\" [ 0 0 1 0 0 1 0 0 1 0 1 1 ]");
    const mesh *m = only_mesh(&r);
    const uint32_t indices[] = {0, 1, 3, 0, 3, 2};
    assert_int_equal(m->triangle_count, 2);
    assert_int_equal(m->vertex_count, 4);
    assert_memory_equal(m->indices, indices, sizeof indices);
    for (uint32_t i = 0; i < 2; i++)
        assert_vec3(outside(&r.scene->shapes[0], i), 0, 0, 1, 0);
    assert_near(shape_area(&r.scene->shapes[0]), 2, 1e-6);
    assert_int_equal(r.count[AG_LOG_INFO], 0);
    reading_destroy(&r);
    /* two of them, by indices, mirrored: the outside of each is still du x dv of the object */
    r = reading_of("WorldBegin Scale 1 -1 1 Shape \"bilinearmesh\" \"integer indices\" [ 0 1 2 3 1 0 3 2 ]\n"
                   "\"point3 P\" [ 0 0 0 2 0 0 0 1 0 2 1 0 ]");
    assert_int_equal(only_mesh(&r)->triangle_count, 4);
    for (uint32_t i = 0; i < 4; i++)
        assert_vec3(outside(&r.scene->shapes[0], i), 0, 0, i < 2 ? 1 : -1, 0);
    reading_destroy(&r);
}

static void flat_quadrilaterals_become_two_triangles(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 3 0 0 0 1 0 1 1 0 ]");
    assert_int_equal(only_mesh(&r)->triangle_count, 2);
    assert_near(shape_area(&r.scene->shapes[0]), 2, 1e-6);
    reading_destroy(&r);
    /* with two corners at one point it is one triangle, and no fault of the file */
    r = reading_of("WorldBegin Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 0 1 0 ]");
    assert_int_equal(only_mesh(&r)->triangle_count, 1);
    assert_near(shape_area(&r.scene->shapes[0]), 0.5, 1e-6);
    reading_destroy(&r);
    /* with uvs the two triangles would not be the patch */
    r = reading_of(
        "WorldBegin Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 3 0 0 0 1 0 1 1 0 ] \"point2 uv\" [ 0 0 1 0 0 1 1 1 ]");
    assert_int_equal(only_mesh(&r)->triangle_count, 2 * 32 * 32);
    assert_near(shape_area(&r.scene->shapes[0]), 2, 1e-5);
    reading_destroy(&r);
}

static void curved_patches_are_cut(void **state)
{
    (void)state;
    /* z = x y over [-1, 1]^2; its area is the integral of sqrt(1 + x^2 + y^2) */
    const char *text = "WorldBegin\n Shape \"bilinearmesh\" \"point3 P\" [ -1 -1 1  1 -1 -1  -1 1 -1  1 1 1 ]\n"
                       "\"normal N\" [ 0 0 1 0 0 1 0 0 1 0 0 1 ]";
    reading r = reading_of(text);
    const shape *s = &r.scene->shapes[0];
    const mesh *m = only_mesh(&r);
    assert_string_equal(r.said[AG_LOG_INFO],
                        "t:2:2: info: Shape \"bilinearmesh\": 1 curved patch is cut into 32 x 32 cells each\n");
    assert_int_equal(m->triangle_count, 2 * 32 * 32);
    assert_int_equal(m->vertex_count, 33 * 33);
    double area = 0.0;
    enum { STEPS = 1000 };
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < STEPS; j++) {
            double x = (2.0 * i + 1.0) / STEPS - 1.0, y = (2.0 * j + 1.0) / STEPS - 1.0;
            area += sqrt(1.0 + x * x + y * y) * 4.0 / ((double)STEPS * STEPS);
        }
    assert_near(shape_area(s), area, 5e-4 * area);
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        assert_near(m->positions[i].z, (double)m->positions[i].x * m->positions[i].y, 1e-6);
        assert_vec3(m->normals[i], 0, 0, 1, 1e-6);
    }
    for (uint32_t i = 0; i < m->triangle_count; i++)
        assert_true(outside(s, i).z > 0.5f);
    reading_destroy(&r);
}

static int compare_points(const void *a, const void *b) { return memcmp(a, b, sizeof(vec3)); }

/* A curved patch and a flat one side by side: along their common edge every point is there twice, bit for bit. */
static void neighbouring_patches_share_their_edge(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin Rotate 33 1 2 3 Shape \"bilinearmesh\" \"integer indices\" [ 0 1 2 3 5 3 4 1 ]\n"
                           "\"point3 P\" [ 0 0 0 1 0.1 0.3 0 1 0.7 1.1 1 0.1 2 0 0 2.1 0.9 -0.2 ]");
    const mesh *m = only_mesh(&r);
    size_t side = 1;
    while (2 * side * side < m->vertex_count)
        side++;
    assert_int_equal(2 * side * side, m->vertex_count);
    vec3 *edges = malloc(2 * side * sizeof *edges);
    assert_non_null(edges);
    for (size_t i = 0; i < side; i++) {
        edges[i] = m->positions[i * side + side - 1];                        /* u = 1 of the first: 1 to 3 */
        edges[side + i] = m->positions[side * side + i * side + (side - 1)]; /* u = 1 of the second: 3 to 1 */
    }
    qsort(edges, side, sizeof *edges, compare_points);
    qsort(edges + side, side, sizeof *edges, compare_points);
    assert_true(side > 2);
    assert_memory_equal(edges, edges + side, side * sizeof *edges);
    free(edges);
    reading_destroy(&r);
}

static void large_arrays_are_read(void **state)
{
    (void)state;
    enum { COUNT = 100000 };
    char *text = malloc(COUNT * 64);
    assert_non_null(text);
    size_t used = (size_t)sprintf(text, "WorldBegin Shape \"trianglemesh\" \"point3 P\" [");
    for (int i = 0; i < COUNT; i++)
        used += (size_t)sprintf(text + used, " %d.%d %d 0%s", i, i % 7, i & 1, i % 5 ? "" : " # five\n");
    used += (size_t)sprintf(text + used, "] \"integer indices\" [");
    for (int i = 0; i + 2 < COUNT; i++)
        used += (size_t)sprintf(text + used, "%d %d %d\n", i, i + 1, i + 2);
    used += (size_t)sprintf(text + used, "]");
    reading r = reading_of(text);
    const mesh *m = only_mesh(&r);
    assert_int_equal(m->vertex_count, COUNT);
    assert_int_equal(m->triangle_count, COUNT - 2);
    for (int i = 0; i < COUNT; i++)
        assert_near(m->positions[i].x, i + 0.1 * (i % 7), 0.005);
    assert_int_equal(m->indices[3 * (COUNT - 3) + 2], COUNT - 1);
    reading_destroy(&r);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres_and_disks_have_defaults),
        cmocka_unit_test(quadrics_keep_their_outside_in_a_mirror),
        cmocka_unit_test(meshes_come_to_world_space),
        cmocka_unit_test(meshes_have_the_outside_that_pbrt_gives_them),
        cmocka_unit_test(triangles_without_area_are_dropped),
        cmocka_unit_test(quadrics_that_floats_cannot_tell_are_left_out),
        cmocka_unit_test(vertex_data_that_does_not_fit_is_ignored),
        cmocka_unit_test(parallelograms_become_two_triangles),
        cmocka_unit_test(flat_quadrilaterals_become_two_triangles),
        cmocka_unit_test(curved_patches_are_cut),
        cmocka_unit_test(neighbouring_patches_share_their_edge),
        cmocka_unit_test(large_arrays_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
