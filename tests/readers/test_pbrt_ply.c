/* test_pbrt_ply.c: Shape "plymesh": as "trianglemesh" makes the same mesh, its errors and warnings by their locations.
 * Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/ply_fixture.h"

#include <sys/stat.h>

static reading read_scene(const char *name, const char *world)
{
    char scene_text[2048];
    snprintf(scene_text, sizeof scene_text, "WorldBegin\n%s\n", world);
    return reading_create(write_file(name, scene_text, strlen(scene_text)), NULL, 0);
}

#define CORNERS "0 0 0 1 0 0 0 1 0 0 0 2"
#define NORMALS "0 0 1 0 3 4 1 0 0 0 -2 0"
#define UVS     "0 0 1 0 0 1 .5 .25"

/* A mesh from a PLY file and the same one in the scene file, moved, mirrored and reversed, are the same to the last
 * bit. */
static void plymesh_is_as_trianglemesh(void **state)
{
    (void)state;
    static const char PLY[] = "ply\nformat ascii 1.0\n" VERTEX(
        4) "property float nx\nproperty float ny\nproperty float nz\n"
           "property float u\nproperty float v\n" FACE(
               2) "end_header\n"
                  "0 0 0 0 0 1 0 0\n1 0 0 0 3 4 1 0\n0 1 0 1 0 0 0 1\n0 0 2 0 -2 0 .5 .25\n3 0 1 2\n3 0 2 3\n";
    static const char *const STATES[] = {"", "Translate 1 2 3 Rotate 30 1 2 3 Scale 2 3 4", "Scale -1 1 1",
                                         "ReverseOrientation", "ReverseOrientation Rotate 90 0 1 0 Scale 1 -1 3"};
    write_file("a.ply", PLY, strlen(PLY));
    for (int i = 0; i < 5; i++) {
        char world[1024];
        snprintf(world, sizeof world,
                 "%s Shape \"plymesh\" \"string filename\" \"a.ply\" Shape \"trianglemesh\" \"point3 P\" [" CORNERS
                 "]\n"
                 "\"integer indices\" [0 1 2 0 2 3] \"normal N\" [" NORMALS "] \"point2 uv\" [" UVS "]",
                 STATES[i]);
        reading r = read_scene("s.pbrt", world);
        assert_int_equal(r.status, AG_OK);
        assert_int_equal(r.count[AG_LOG_WARNING], 0);
        assert_int_equal(r.scene->shape_count, 2);
        const shape *a = &r.scene->shapes[0], *b = &r.scene->shapes[1];
        assert_int_equal(a->flip_normal, b->flip_normal);
        assert_int_equal(a->as.mesh.vertex_count, 4);
        assert_int_equal(a->as.mesh.triangle_count, 2);
        assert_memory_equal(a->as.mesh.positions, b->as.mesh.positions, 5 * sizeof(vec3));
        for (int k = 0; k < 4; k++) {
            vec3 n = b->as.mesh.normals[k];
            assert_vec3(a->as.mesh.normals[k], n.x, n.y, n.z, 1e-7);
        }
        assert_memory_equal(a->as.mesh.uvs, b->as.mesh.uvs, 4 * sizeof(vec2));
        assert_memory_equal(a->as.mesh.indices, b->as.mesh.indices, 6 * sizeof(uint32_t));
        reading_destroy(&r);
    }
}

static void check_said(const char *world, ag_status status, ag_log_level level, const char *expected)
{
    char whole[1024];
    reading r = read_scene("s.pbrt", world);
    snprintf(whole, sizeof whole, "%s%s", in_folder("s.pbrt"), expected);
    assert_int_equal(r.status, status);
    if (!r.said[level] || strncmp(r.said[level], whole, strlen(whole)) != 0)
        fail_msg("%s was not said, but %s", whole, r.said[level] ? r.said[level] : "nothing");
    reading_destroy(&r);
}

#define PLYMESH "Shape \"plymesh\" \"string filename\" "

static void plymesh_says_what_is_wrong_and_where(void **state)
{
    (void)state;
    static const char DEGENERATE[] = HEAD "0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n";
    static const char LINE[] = "ply\nformat ascii 1.0\n" VERTEX(3) FACE(3) "end_header\n0 0 0\n1 0 0\n0 1 0\n"
                                                                           "2 0 1\n3 0 1 2\n3 0 0 1\n";
    static const char ODD[] = "ply\nformat binary_little_endian 1.0\n" VERTEX(
        3) "property float u\nproperty float v\n" FACE(1) "end_header\n";
    char expected[512];
    write_file("bad.ply", HEAD, strlen(HEAD));
    snprintf(
        expected, sizeof expected,
        ":2:2: error: Shape \"plymesh\": %s:3: the header promises 3 of element \"vertex\", but the file is cut short",
        in_folder("bad.ply"));
    check_said(" " PLYMESH "\"bad.ply\"", AG_ERROR_INPUT, AG_LOG_ERROR, expected);
    snprintf(expected, sizeof expected, ":2:1: error: Shape \"plymesh\": %s: No such file", in_folder("none.ply"));
    check_said(PLYMESH "\"none.ply\"", AG_ERROR_INPUT, AG_LOG_ERROR, expected);
    check_said("Shape \"plymesh\"", AG_ERROR_SCENE, AG_LOG_ERROR, ":2:1: error: \"string filename\" is missing");
    write_file("flat.ply", DEGENERATE, strlen(DEGENERATE));
    check_said(PLYMESH "\"flat.ply\"", AG_OK, AG_LOG_WARNING,
               ":2:1: warning: Shape \"plymesh\": 1 of 1 triangles have no area and are left out\n");
    write_file("line.ply", LINE, strlen(LINE));
    check_said(PLYMESH "\"line.ply\"", AG_OK, AG_LOG_WARNING,
               ":2:1: warning: Shape \"plymesh\": 2 of 3 triangles have no area and are left out, as are any others\n");
    check_said("Scale 1e30 1e30 1e30 " PLYMESH "\"line.ply\"", AG_ERROR_SCENE, AG_LOG_ERROR,
               ":2:22: error: a vertex lies beyond 1e18 units in world space");
    check_said(PLYMESH "\"line.ply\" \"float edgelength\" 2 \"texture displacement\" \"d\"", AG_OK, AG_LOG_WARNING,
               ":2:46: warning: Shape \"plymesh\": displacement is not supported yet: \"edgelength\" is ignored\n");
    check_said(PLYMESH "\"line.ply\" \"texture displacement\" \"d\"", AG_OK, AG_LOG_WARNING,
               ":2:46: warning: Shape \"plymesh\": displacement is not supported yet: \"displacement\" is ignored\n");
    text t = {NULL, 0, 0};
    append_text(&t, ODD);
    for (int i = 0; i < 15; i++)
        append_number(&t, LITTLE, "float", i == 8 ? (double)NAN : i * i % 7);
    append_number(&t, LITTLE, "uchar", 3);
    for (int i = 0; i < 3; i++)
        append_number(&t, LITTLE, "int", i);
    write_file("odd.ply", t.bytes, t.size);
    free(t.bytes);
    check_said(
        PLYMESH "\"odd.ply\"", AG_OK, AG_LOG_WARNING,
        ":2:1: warning: Shape \"plymesh\": 1 normals or texture coordinates in \"odd.ply\" are not finite, and are "
        "not used\n");
}

/* Names are looked up below the first file's directory, then beside the file that has them. */
static void plymesh_is_found_as_included_files_are(void **state)
{
    (void)state;
    static const char PLY[] = HEAD "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    static const char PART[] = PLYMESH "\"beside.ply\" " PLYMESH "\"top.ply\"";
    assert_int_equal(mkdir(in_folder("parts"), 0755), 0);
    write_file("top.ply", PLY, strlen(PLY));
    write_file("parts/beside.ply", PLY, strlen(PLY));
    write_file("parts/part.pbrt", PART, strlen(PART));
    reading r = read_scene("s.pbrt", "Include \"parts/part.pbrt\" " PLYMESH "\"parts/beside.ply\"");
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.scene->shape_count, 3);
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(plymesh_is_as_trianglemesh),
        TEST_IN_FOLDER(plymesh_says_what_is_wrong_and_where),
        TEST_IN_FOLDER(plymesh_is_found_as_included_files_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
