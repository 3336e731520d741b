/* test_loop_subdivision.c: Loop subdivision: closed meshes stay closed, planes stay planes, limit points are the same
 * from every level and as the masks have them; what is no manifold is refused; Shape "loopsubdiv". Threads: one. */
#include "fixtures/pbrt_fixture.h"
#include "shape/loop_subdivision.h"

static const double ICOSAHEDRON[36] = {-1,
                                       1.6180339887498949,
                                       0,
                                       1,
                                       1.6180339887498949,
                                       0,
                                       -1,
                                       -1.6180339887498949,
                                       0,
                                       1,
                                       -1.6180339887498949,
                                       0,
                                       0,
                                       -1,
                                       1.6180339887498949,
                                       0,
                                       1,
                                       1.6180339887498949,
                                       0,
                                       -1,
                                       -1.6180339887498949,
                                       0,
                                       1,
                                       -1.6180339887498949,
                                       1.6180339887498949,
                                       0,
                                       -1,
                                       1.6180339887498949,
                                       0,
                                       1,
                                       -1.6180339887498949,
                                       0,
                                       -1,
                                       -1.6180339887498949,
                                       0,
                                       1};
static const uint32_t ICOSAHEDRON_INDICES[60] = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                                                 4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                                                 6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};

static loop_mesh subdivide(const double *positions, size_t vertex_count, const uint32_t *indices, size_t triangle_count,
                           int levels)
{
    char error[256] = "";
    loop_mesh m;
    ag_status status =
        loop_subdivide(positions, vertex_count, indices, triangle_count, levels, error, sizeof error, &m);
    if (status != AG_OK)
        fail_msg("%s: %s", ag_status_text(status), error);
    return m;
}

static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Half-edges that nothing goes back along. */
static size_t count_open_edges(const loop_mesh *m)
{
    size_t open = 0, count = 3 * m->triangle_count;
    uint64_t *seen = calloc(count, sizeof *seen);
    assert_non_null(seen);
    /* a table of the directed edges, open addressing */
    size_t size = 4 * count + 1;
    uint64_t *table = calloc(size, sizeof *table);
    assert_non_null(table);
    for (size_t h = 0; h < count; h++) {
        uint64_t a = m->indices[h], b = m->indices[h % 3 == 2 ? h - 2 : h + 1], key = (a << 32 | b) + 1;
        size_t at = (size_t)(key * 0x9e3779b97f4a7c15u % size);
        for (; table[at]; at = (at + 1) % size)
            assert_true(table[at] != key); /* no directed edge is there twice */
        table[at] = key;
        seen[h] = (b << 32 | a) + 1;
    }
    for (size_t h = 0; h < count; h++) {
        size_t at = (size_t)(seen[h] * 0x9e3779b97f4a7c15u % size);
        while (table[at] && table[at] != seen[h])
            at = (at + 1) % size;
        open += table[at] == 0;
    }
    free(seen);
    free(table);
    return open;
}

static void a_closed_mesh_stays_closed_and_becomes_round(void **state)
{
    (void)state;
    for (int levels = 0; levels <= 5; levels++) {
        loop_mesh m = subdivide(ICOSAHEDRON, 12, ICOSAHEDRON_INDICES, 20, levels);
        assert_int_equal(m.triangle_count, 20u << (2 * levels));
        assert_int_equal(m.vertex_count, m.triangle_count / 2 + 2); /* Euler: V - E + F = 2 */
        assert_int_equal(count_open_edges(&m), 0);
        double low = INFINITY, high = 0.0, volume = 0.0;
        for (size_t v = 0; v < m.vertex_count; v++) {
            const double *p = m.positions + 3 * v, *n = m.normals + 3 * v;
            double r = sqrt(dot(p, p));
            low = fmin(low, r);
            high = fmax(high, r);
            /* the normals too are those of a sphere, nearly */
            assert_true(dot(p, n) > 0.99 * r * sqrt(dot(n, n)));
        }
        assert_true(high < 1.035 * low);
        for (size_t t = 0; t < m.triangle_count; t++) {
            const double *a = m.positions + 3 * m.indices[3 * t], *b = m.positions + 3 * m.indices[3 * t + 1];
            const double *c = m.positions + 3 * m.indices[3 * t + 2];
            const double cross[3] = {b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]};
            volume += dot(a, cross) / 6.0;
        }
        double ball = 4.0 / 3.0 * 3.14159265358979 * pow((low + high) / 2.0, 3);
        if (levels >= 3)
            assert_near(volume, ball, 0.03 * ball);
        loop_mesh_reset(&m);
    }
}

/* All vertices of the icosahedron have five neighbours: limit = (1 - 5 g) p + g sum, g = 1 / (5 + 3 / (8 b)), b = 3
 * / 40. */
static void limit_points_do_not_depend_on_the_level(void **state)
{
    (void)state;
    loop_mesh coarse = subdivide(ICOSAHEDRON, 12, ICOSAHEDRON_INDICES, 20, 0);
    for (int i = 0; i < 12; i++)
        for (int c = 0; c < 3; c++) {
            const double *p = ICOSAHEDRON + 3 * i;
            /* the ring's sum is sqrt(5) p */
            assert_near(coarse.positions[3 * i + c], p[c] * (0.5 + 0.1 * sqrt(5.0)), 1e-12);
        }
    for (int levels = 1; levels <= 4; levels++) {
        loop_mesh fine = subdivide(ICOSAHEDRON, 12, ICOSAHEDRON_INDICES, 20, levels);
        for (int i = 0; i < 12; i++) {
            const double *a = coarse.normals + 3 * i, *b = fine.normals + 3 * i;
            assert_near(dot(a, b) / sqrt(dot(a, a) * dot(b, b)), 1, 1e-12);
            for (int c = 0; c < 3; c++)
                assert_near(fine.positions[3 * i + c], coarse.positions[3 * i + c], 1e-12);
        }
        loop_mesh_reset(&fine);
    }
    loop_mesh_reset(&coarse);
}

/* A grid of N x N vertices, cut along the diagonals so that inner vertices are regular; z = height(x, y). */
enum { SIDE = 6 };
static size_t make_grid(double positions[3 * SIDE * SIDE], uint32_t indices[6 * SIDE * SIDE], int bent)
{
    size_t count = 0;
    for (uint32_t j = 0; j < SIDE; j++)
        for (uint32_t i = 0; i < SIDE; i++) {
            double *p = positions + 3 * (j * SIDE + i);
            p[0] = i;
            p[1] = j;
            p[2] = bent ? sin(2.0 * i) * cos(1.5 * j) : 0.5 * i - 0.25 * j;
            uint32_t a = j * SIDE + i, b = a + 1, c = a + SIDE, d = c + 1;
            if (i + 1 < SIDE && j + 1 < SIDE) {
                const uint32_t cell[6] = {a, b, d, a, d, c};
                memcpy(indices + 3 * count, cell, sizeof cell);
                count += 2;
            }
        }
    return count;
}

static void a_plane_stays_a_plane(void **state)
{
    (void)state;
    double positions[3 * SIDE * SIDE];
    uint32_t indices[6 * SIDE * SIDE];
    size_t count = make_grid(positions, indices, 0);
    const double up[3] = {-0.5, 0.25, 1.0};
    for (int levels = 0; levels <= 3; levels++) {
        loop_mesh m = subdivide(positions, SIDE * SIDE, indices, count, levels);
        assert_int_equal(count_open_edges(&m), (size_t)(4 * (SIDE - 1)) << levels);
        for (size_t v = 0; v < m.vertex_count; v++) {
            const double *p = m.positions + 3 * v, *n = m.normals + 3 * v;
            assert_near(p[2], 0.5 * p[0] - 0.25 * p[1], 1e-12);
            assert_near(dot(n, up) / sqrt(dot(n, n) * dot(up, up)), 1, 1e-12); /* corners and edges too */
            assert_true(p[0] > -1e-12 && p[0] < SIDE - 1 + 1e-12 && p[1] > -1e-12 && p[1] < SIDE - 1 + 1e-12);
        }
        loop_mesh_reset(&m);
    }
}

/* Half of a regular vertex and a twelfth of each of its six; on the boundary 4/6 and 1/6 of each of two. */
static void limit_points_are_as_the_masks_have_them(void **state)
{
    (void)state;
    double positions[3 * SIDE * SIDE];
    uint32_t indices[6 * SIDE * SIDE];
    size_t count = make_grid(positions, indices, 1);
    loop_mesh fine = subdivide(positions, SIDE * SIDE, indices, count, 3);
    for (int j = 1; j + 1 < SIDE; j++)
        for (int i = 1; i + 1 < SIDE; i++) {
            int v = j * SIDE + i;
            const int ring[6] = {1, SIDE + 1, SIDE, -1, -SIDE - 1, -SIDE};
            for (int c = 0; c < 3; c++) {
                double expected = positions[3 * v + c] / 2.0;
                for (int k = 0; k < 6; k++)
                    expected += positions[3 * (v + ring[k]) + c] / 12.0;
                assert_near(fine.positions[3 * v + c], expected, 1e-12);
            }
        }
    for (int i = 1; i + 1 < SIDE; i++)
        for (int c = 0; c < 3; c++)
            assert_near(fine.positions[3 * i + c],
                        (positions[3 * (i - 1) + c] + 4.0 * positions[3 * i + c] + positions[3 * (i + 1) + c]) / 6.0,
                        1e-12);
    loop_mesh_reset(&fine);
}

/* At a fine level the normals are nearly those of the triangles around. */
static void normals_are_those_of_the_surface(void **state)
{
    (void)state;
    double positions[3 * SIDE * SIDE];
    uint32_t indices[6 * SIDE * SIDE];
    size_t count = make_grid(positions, indices, 1);
    loop_mesh m = subdivide(positions, SIDE * SIDE, indices, count, 5);
    double worst = 1.0;
    for (size_t t = 0; t < m.triangle_count; t++) {
        const double *p[3];
        double u[3], v[3];
        for (int c = 0; c < 3; c++)
            p[c] = m.positions + 3 * m.indices[3 * t + (size_t)c];
        for (int c = 0; c < 3; c++) {
            u[c] = p[1][c] - p[0][c];
            v[c] = p[2][c] - p[0][c];
        }
        const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
        for (int c = 0; c < 3; c++) {
            const double *normal = m.normals + 3 * m.indices[3 * t + (size_t)c];
            worst = fmin(worst, dot(n, normal) / sqrt(dot(n, n) * dot(normal, normal)));
        }
    }
    assert_true(worst > 0.97);
    loop_mesh_reset(&m);
}

static void check_refused(const uint32_t *indices, size_t triangle_count, const char *expected)
{
    static const double POINTS[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0, 1, 0, 1, 0, 1, 1, 1, 1, 1};
    char error[256] = "";
    loop_mesh m;
    assert_int_equal(loop_subdivide(POINTS, 8, indices, triangle_count, 1, error, sizeof error, &m), AG_ERROR_SCENE);
    assert_string_equal(error, expected);
    assert_null(m.positions);
}

static void what_is_no_manifold_is_refused(void **state)
{
    (void)state;
    check_refused((const uint32_t[]){1, 2, 3, 4, 5, 4}, 2, "triangle 1 has vertex 4 twice");
    check_refused((const uint32_t[]){1, 2, 3, 2, 1, 4, 1, 2, 5}, 3,
                  "the edge between vertices 1 and 2 has 3 triangles: the mesh is not manifold");
    check_refused(
        (const uint32_t[]){1, 2, 3, 1, 2, 4}, 2,
        "triangles 0 and 1 go the same way along the edge between vertices 1 and 2: they are not turned alike");
    check_refused((const uint32_t[]){7, 1, 2, 7, 3, 4}, 2,
                  "the triangles around vertex 7 are not one fan: the mesh is not manifold");
    loop_mesh m;
    char error[64];
    assert_int_equal(loop_subdivide(ICOSAHEDRON, 12, ICOSAHEDRON_INDICES, 20, 13, error, sizeof error, &m),
                     AG_ERROR_ARGUMENT);
}

static void loopsubdiv_makes_a_mesh(void **state)
{
    (void)state;
    /* vertex 2 is not used */
    reading r = reading_of("WorldBegin Translate 5 0 0 Shape \"loopsubdiv\" \"integer levels\" 2\n"
                           "\"integer indices\" [ 0 1 3 0 4 1 1 4 3 3 4 0 ] "
                           "\"point3 P\" [ 1 1 1 -1 1 -1 9 9 9 1 -1 -1 -1 -1 1 ]\n"
                           "Shape \"loopsubdiv\" \"string scheme\" \"loop\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]\n"
                           "\"integer indices\" [ 0 1 2 ]\n"
                           "Shape \"loopsubdiv\" \"integer levels\" 0 \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]\n"
                           "\"integer indices\" [ 0 1 2 ]");
    assert_int_equal(r.scene->shape_count, 3);
    const mesh *m = &r.scene->shapes[0].as.mesh;
    assert_int_equal(m->triangle_count, 64);
    assert_int_equal(m->vertex_count, 34);
    /* where the file's triangles look clockwise is outside, as in pbrt; triangles and normals agree */
    const vec3 *p = m->positions;
    const uint32_t *c = m->indices;
    vec3 n = vec3_cross(vec3_sub(p[c[1]], p[c[0]]), vec3_sub(p[c[2]], p[c[0]]));
    for (int i = 0; i < 3; i++)
        assert_true(vec3_dot(n, m->normals[c[i]]) > 0.0f);
    assert_false(r.scene->shapes[0].flip_normal);
    assert_int_equal(r.scene->shapes[1].as.mesh.triangle_count, 64); /* three levels unless told otherwise */
    assert_int_equal(r.scene->shapes[2].as.mesh.triangle_count, 1);
    for (int i = 0; i < 3; i++)
        assert_vec3(r.scene->shapes[2].as.mesh.normals[i], 0, 0, -1, 1e-6);
    reading_destroy(&r);
}

static void check_scene_error(const char *text, const char *expected)
{
    reading r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_ERROR_SCENE);
    if (strncmp(r.said[AG_LOG_ERROR], expected, strlen(expected)) != 0)
        fail_msg("%s was not said, but %s", expected, r.said[AG_LOG_ERROR]);
    reading_destroy(&r);
}

static void loopsubdiv_says_what_is_wrong_and_where(void **state)
{
    (void)state;
    check_scene_error("WorldBegin Shape \"loopsubdiv\"", "t:1:12: error: \"point3 P\" is missing");
    check_scene_error("WorldBegin Shape \"loopsubdiv\" \"integer levels\" -1 \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]",
                      "t:1:31: error: \"levels\" should be 0 or above");
    check_scene_error("WorldBegin Shape \"loopsubdiv\" \"integer levels\" 40 \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]",
                      "t:1:31: error: 1 triangles subdivided 40 times are more than 67108864");
    check_scene_error("WorldBegin Shape \"loopsubdiv\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 1 ]\n"
                      "\"integer indices\" [ 0 1 2 0 1 3 ]",
                      "t:2:1: error: triangles 0 and 1 go the same way along the edge between vertices 0 and 1");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_closed_mesh_stays_closed_and_becomes_round),
        cmocka_unit_test(limit_points_do_not_depend_on_the_level),
        cmocka_unit_test(a_plane_stays_a_plane),
        cmocka_unit_test(limit_points_are_as_the_masks_have_them),
        cmocka_unit_test(normals_are_those_of_the_surface),
        cmocka_unit_test(what_is_no_manifold_is_refused),
        cmocka_unit_test(loopsubdiv_makes_a_mesh),
        cmocka_unit_test(loopsubdiv_says_what_is_wrong_and_where),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
