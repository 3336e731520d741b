/* test_obj_file.c: OBJ files: vertices, references of all forms, polygons, smoothing groups, materials; every error by
 * its message and location; files cut short or damaged anywhere. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/model_fixture.h"

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static void triangles_and_quads(void **state)
{
    (void)state;
    reading r = model_quietly("a.obj", "# a square and a triangle\no thing\ng group\n" SQUARE "v 0 0 1 1.0\n"
                                       "f 1 2 3 4\nf 1 2 5\n");
    assert_int_equal(r.scene->shape_count, 1);
    const mesh *m = model_mesh(&r, 0);
    assert_int_equal(m->vertex_count, 5); /* shared */
    assert_int_equal(m->triangle_count, 3);
    assert_null(m->normals);
    assert_null(m->uvs);
    static const uint32_t INDICES[] = {0, 1, 2, 0, 2, 3, 0, 1, 4};
    assert_memory_equal(m->indices, INDICES, sizeof INDICES);
    assert_vec3(m->positions[2], 1, 1, 0, 0);
    assert_false(r.scene->shapes[0].flip_normal);
    assert_true(r.scene->has_camera);
    assert_int_equal(r.scene->light_count, 2);
    assert_int_equal(model_material(&r, 0)->kind, MATERIAL_DIFFUSE);
    reading_destroy(&r);
}

/* Forms of corners, from the front and from the back, before and after the vertices. */
static void references_of_all_forms(void **state)
{
    (void)state;
    static const char *const FACES[] = {"f 1/1/1 2/2/1 3/3/1\n", "f -4/-3/-1 -3/-2/-1 -2/-1/-1\n",
                                        "f\t1/1/1  2/2/1 \\\n 3/3/1\r\n"};
    for (int k = 0; k < 3; k++) {
        char text[512];
        snprintf(text, sizeof text, SQUARE "vt 0 0\nvt .5 0\nvt .5 .25 0\nvn 0 0 2\n%s", FACES[k]);
        reading r = model_quietly("a.obj", text);
        const mesh *m = model_mesh(&r, 0);
        assert_int_equal(m->vertex_count, 3);
        assert_non_null(m->uvs);
        assert_non_null(m->normals);
        assert_near(m->uvs[2].x, .5, 0);
        assert_near(m->uvs[2].y, .25, 0);
        assert_vec3(m->normals[1], 0, 0, 1, 1e-7);
        assert_vec3(m->positions[2], 1, 1, 0, 0);
        reading_destroy(&r);
    }
    reading r = model_quietly("a.obj", "f 1 2 3\n" SQUARE "f 1//1 2//1 3//1\nvn 1 0 0\nf 1/1 2/1 4/1\nvt 1 1\n");
    const mesh *m = model_mesh(&r, 0);
    assert_int_equal(m->triangle_count, 3);
    assert_int_equal(m->vertex_count, 9); /* none agrees in all */
    reading_destroy(&r);
}

static double mesh_area(const mesh *m)
{
    double sum = 0.0;
    for (uint32_t k = 0; k < m->triangle_count; k++) {
        vec3 a = m->positions[m->indices[3 * k]], b = m->positions[m->indices[3 * k + 1]],
             c = m->positions[m->indices[3 * k + 2]];
        sum += 0.5 * (double)vec3_cross(vec3_sub(b, a), vec3_sub(c, a)).z;
    }
    return sum;
}

/* The sum of areas that face forward is the polygon's where nothing is cut beyond its edge. */
static void concave_polygons_are_cut_inside(void **state)
{
    (void)state;
    static const struct {
        const char *vertices;
        int corners;
        double area;
    } SHAPES[] = {
        {"v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\n", 5, 16.0 - 6.0},                     /* a notch */
        {"v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\n", 6, 5.0},                   /* an L */
        {"v 2 1 0\nv 0 4 0\nv 0 0 0\nv 4 0 0\nv 4 4 0\n", 5, 10.0},                           /* the notch first */
        {"v 0 0 0\nv 1 0 0\nv 1 2 0\nv 2 2 0\nv 2 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\n", 8, 7.0}, /* a U */
        {"v 0 0 0\nv 1 .25 0\nv 2 0 0\nv 1 2 0\n", 4, 1.75},                                  /* an arrow */
    };
    for (size_t k = 0; k < sizeof SHAPES / sizeof *SHAPES; k++) {
        char text[512], faces[64] = "f";
        for (int c = 1; c <= SHAPES[k].corners; c++)
            snprintf(faces + strlen(faces), sizeof faces - strlen(faces), " %d", c);
        snprintf(text, sizeof text, "%s%s\n", SHAPES[k].vertices, faces);
        reading r = model_quietly("a.obj", text);
        const mesh *m = model_mesh(&r, 0);
        assert_int_equal(m->triangle_count, SHAPES[k].corners - 2);
        assert_near(mesh_area(m), SHAPES[k].area, 1e-6);
        for (uint32_t t = 0; t < m->triangle_count; t++) { /* none is turned over */
            vec3 a = m->positions[m->indices[3 * t]], b = m->positions[m->indices[3 * t + 1]],
                 c = m->positions[m->indices[3 * t + 2]];
            assert_true(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)).z > 0.0f);
        }
        reading_destroy(&r);
    }
}

/* A roof of two squares: smooth over the ridge in one group, flat without, its own in two groups. */
static void smoothing_groups(void **state)
{
    (void)state;
#define ROOF "v 0 0 0\nv 1 1 0\nv 1 1 -1\nv 0 0 -1\nv 2 0 0\nv 2 0 -1\n"
    reading r = model_quietly("a.obj", ROOF "s 1\nf 1 2 3 4\nf 2 5 6 3\n");
    const mesh *m = model_mesh(&r, 0);
    assert_int_equal(m->vertex_count, 6);
    assert_vec3(m->normals[1], 0, 1, 0, 1e-6); /* the ridge */
    assert_vec3(m->normals[0], -sqrt(0.5), sqrt(0.5), 0, 1e-6);
    reading_destroy(&r);

    r = model_quietly("a.obj", ROOF "s 1\nf 1 2 3 4\ns 2\nf 2 5 6 3\n");
    m = model_mesh(&r, 0);
    assert_int_equal(m->vertex_count, 8);
    assert_vec3(m->normals[1], -sqrt(0.5), sqrt(0.5), 0, 1e-6);
    reading_destroy(&r);

    r = model_quietly("a.obj", ROOF "s off\nf 1 2 3 4\ns 0\nf 2 5 6 3\n");
    assert_null(model_mesh(&r, 0)->normals);
    reading_destroy(&r);

    /* normals of the file count more; flat faces beside smooth ones have none */
    r = model_quietly("a.obj", ROOF "vn 0 0 1\ns 1\nf 1//1 2//1 3//1\ns off\nf 2 5 6 3\n");
    m = model_mesh(&r, 0);
    assert_vec3(m->normals[0], 0, 0, 1, 0);
    assert_vec3(m->normals[3], 0, 0, 0, 0);
    reading_destroy(&r);
}

static void one_mesh_for_each_material(void **state)
{
    (void)state;
    model_write_text("m.mtl", "newmtl red wine\nKd .5 0 0\nnewmtl b\nKd 0 0 1\n");
    reading r = model_of("a.obj", "mtllib m.mtl\n" SQUARE "usemtl red wine\nf 1 2 3\nusemtl b\nf 1 3 4\n"
                                  "usemtl red wine\nf 1 2 4\nusemtl nowhere\nf 2 3 4\nusemtl unused\n");
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.scene->shape_count, 3);
    assert_int_equal(model_mesh(&r, 0)->triangle_count, 2);
    assert_rgb(model_material(&r, 0)->reflectance, .5, 0, 0, 0);
    assert_rgb(model_material(&r, 1)->reflectance, 0, 0, 1, 0);
    assert_rgb(model_material(&r, 2)->reflectance, .6, .6, .6, 1e-7);
    assert_int_equal(r.count[AG_LOG_WARNING], 1);
    model_said(&r, AG_LOG_WARNING, "a.obj", ": warning: material \"nowhere\" is not defined: grey stands in\n");
    reading_destroy(&r);
}

static void libraries_have_blanks_or_are_several(void **state)
{
    (void)state;
    model_write_text("a b.mtl", "newmtl x\nKd 1 0 0\n");
    model_write_text("c.mtl", "newmtl y\nKd 0 1 0\n");
    reading r =
        model_quietly("a.obj", "mtllib a b.mtl\nmtllib c.mtl c.mtl\n" SQUARE "usemtl x\nf 1 2 3\nusemtl y\nf 1 2 4\n");
    assert_rgb(model_material(&r, 0)->reflectance, 1, 0, 0, 0);
    assert_rgb(model_material(&r, 1)->reflectance, 0, 1, 0, 0);
    reading_destroy(&r);
    r = model_of("a.obj", "mtllib none.mtl\n" SQUARE "f 1 2 3\n");
    assert_int_equal(r.status, AG_OK);
    model_said(&r, AG_LOG_WARNING, "a.obj",
               ":1:8: warning: the material library \"none.mtl\" cannot be read: No such file or directory\n");
    reading_destroy(&r);
    model_write_text("bad.mtl", "newmtl x\n  Kd 1 0 green\n");
    r = model_of("a.obj", "mtllib bad.mtl\n" SQUARE "f 1 2 3\n");
    assert_int_equal(r.status, AG_ERROR_SCENE);
    model_said(&r, AG_LOG_ERROR, "bad.mtl",
               ":2:10: error: Kd should be a finite number\n      Kd 1 0 green\n             ^~~~~\n");
    reading_destroy(&r);
}

static void what_is_not_supported_is_named(void **state)
{
    (void)state;
    reading r = model_of("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\nf 1 2\nl 1 2\np 1\n"
                                  "curv 0 1 1 2\nsurf 1\n");
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.count[AG_LOG_WARNING], 3);
    model_said(&r, AG_LOG_WARNING, "a.obj", ":1:1: warning: colours of vertices are not supported and are ignored\n");
    model_said(&r, AG_LOG_WARNING, "a.obj",
               ":8:1: warning: \"curv\" is not known, or not supported, and is ignored, as are any others\n");
    model_said(&r, AG_LOG_WARNING, "a.obj", ": warning: 3 points and lines are left out\n");
    reading_destroy(&r);
    r = model_of("a.obj", SQUARE "f 1 2 3\nf 1 2 2\n");
    model_said(&r, AG_LOG_WARNING, "a.obj", ": warning: 1 of 2 triangles have no area and are left out\n");
    reading_destroy(&r);
}

static void errors_name_their_location(void **state)
{
    (void)state;
    model_refused("a.obj", SQUARE "f 1 2 9\n", AG_ERROR_SCENE,
                  ":5:7: error: the corner refers to vertex 9, but there are 4\n    f 1 2 9\n          ^\n");
    model_refused("a.obj", SQUARE "f 1 2 0\n", AG_ERROR_SCENE,
                  ":5:7: error: the corner refers to vertex 0, but there are 4");
    model_refused("a.obj", SQUARE "f 1 2 -5\n", AG_ERROR_SCENE,
                  ":5:7: error: the corner refers to vertex -5, but there are 4");
    model_refused("a.obj", SQUARE "f 1/1 2 3\n", AG_ERROR_SCENE,
                  ":5:3: error: the corner refers to texture vertex 1, but there are 0");
    model_refused("a.obj", SQUARE "f 1//1 2 3\n", AG_ERROR_SCENE,
                  ":5:3: error: the corner refers to normal 1, but there are 0");
    model_refused("a.obj", SQUARE "f 1 2 99999999999999999999\n", AG_ERROR_SCENE,
                  ":5:7: error: the corner refers to vertex");
    model_refused("a.obj", SQUARE "f 1 2 x\n", AG_ERROR_SCENE, ":5:7: error: a corner should be V, V/T, V//N or V/T/N");
    model_refused("a.obj", SQUARE "f 1 2 3/-\n", AG_ERROR_SCENE,
                  ":5:7: error: a corner should be V, V/T, V//N or V/T/N");
    model_refused("a.obj", "v 0 0\n", AG_ERROR_SCENE, ":1:6: error: z is missing");
    model_refused("a.obj", "v 0 nan 0\n", AG_ERROR_SCENE,
                  ":1:5: error: y should be a finite number\n    v 0 nan 0\n        ^~~\n");
    model_refused("a.obj", "v 0 0 1e999\n", AG_ERROR_SCENE, ":1:7: error: z should be a finite number");
    model_refused("a.obj", "v 0 \\\n 0 zero\n", AG_ERROR_SCENE, ":2:4: error: z should be a finite number");
    model_refused("a.obj", "s smooth\n", AG_ERROR_SCENE, ":1:3: error: a smoothing group should be a number or off");
    model_refused("a.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n", AG_ERROR_INPUT,
                  ": error: mesh \"\": vertex 1 lies beyond 1e18 units");
    model_refused("a.obj", "v 0 0 0\nv 1e300 0 0\nv 0 1 0\nf 1 2 3\n", AG_ERROR_INPUT,
                  ": error: mesh \"\": vertex 1 is not a finite number");
    model_refused("a.obj", "", AG_ERROR_INPUT, ": error: there is no triangle in the file: nothing to see\n");
    model_refused("a.obj", SQUARE "f 1 1 2\n", AG_ERROR_INPUT,
                  ": error: there is no triangle in the file: nothing to see\n");
    reading r = model_read(in_folder("none.obj"));
    assert_int_equal(r.status, AG_ERROR_INPUT);
    model_said(&r, AG_LOG_ERROR, "none.obj", ": error: cannot read the file: No such file or directory\n");
    reading_destroy(&r);
}

static const char WHOLE[] = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n"
                            "usemtl a\ns 1\nf 1/1/1 2/2/1 3/3/1 4/1/1\nf 1 2 -1\nusemtl b\nf 1 \\\n 3 4\nl 1 2\n";
static const char LIBRARY[] =
    "newmtl a\nKd .5 .5 .5\nKs 1 1 1\nNs 10\nillum 2\nd .5\nmap_Kd -s 2 2 x.png\nnewmtl b\nKe 1 1 1\n";

static void files_cut_anywhere_do_no_harm(void **state)
{
    (void)state;
    model_write("m.mtl", LIBRARY, sizeof LIBRARY - 1);
    for (size_t length = 0; length < sizeof WHOLE; length += 3) {
        reading r = model_read(model_write("a.obj", WHOLE, length));
        assert_true(r.status == AG_OK ? r.scene->shape_count > 0 : r.count[AG_LOG_ERROR] == 1);
        model_is_sound(&r);
        reading_destroy(&r);
    }
    model_write("a.obj", WHOLE, sizeof WHOLE - 1);
    for (size_t length = 0; length < sizeof LIBRARY; length += 2) {
        model_write("m.mtl", LIBRARY, length);
        reading r = model_read(in_folder("a.obj"));
        assert_true(r.status == AG_OK || r.count[AG_LOG_ERROR] == 1);
        model_is_sound(&r);
        reading_destroy(&r);
    }
}

static void files_damaged_anywhere_do_no_harm(void **state)
{
    (void)state;
    static const unsigned char VALUES[] = {0, '-', '9', '/', '\n', 0xff}; /* in turn */
    unsigned char bytes[sizeof WHOLE], library[sizeof LIBRARY];
    int good = 0, bad = 0;
    for (size_t i = 0; i < sizeof WHOLE - 1 + sizeof LIBRARY - 1; i++)
        for (size_t v = i % 3; v < sizeof VALUES; v += 3) {
            memcpy(bytes, WHOLE, sizeof WHOLE);
            memcpy(library, LIBRARY, sizeof LIBRARY);
            if (i < sizeof WHOLE - 1)
                bytes[i] = VALUES[v];
            else
                library[i - (sizeof WHOLE - 1)] = VALUES[v];
            model_write("m.mtl", library, sizeof LIBRARY - 1);
            reading r = model_read(model_write("a.obj", bytes, sizeof WHOLE - 1));
            good += r.status == AG_OK;
            bad += r.status != AG_OK && r.count[AG_LOG_ERROR] == 1;
            model_is_sound(&r);
            reading_destroy(&r);
        }
    assert_int_equal(good + bad, (sizeof WHOLE - 1 + sizeof LIBRARY - 1) * 2);
    assert_true(good > 100 && bad > 50);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(triangles_and_quads),
        TEST_IN_FOLDER(references_of_all_forms),
        TEST_IN_FOLDER(concave_polygons_are_cut_inside),
        TEST_IN_FOLDER(smoothing_groups),
        TEST_IN_FOLDER(one_mesh_for_each_material),
        TEST_IN_FOLDER(libraries_have_blanks_or_are_several),
        TEST_IN_FOLDER(what_is_not_supported_is_named),
        TEST_IN_FOLDER(errors_name_their_location),
        TEST_IN_FOLDER(files_cut_anywhere_do_no_harm),
        TEST_IN_FOLDER(files_damaged_anywhere_do_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
