/* test_scene_file.c: which reader reads what; PLY files that are a scene by themselves. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/model_fixture.h"

#include "image/module_folders.h"

#include <zlib.h>

#define TRIANGLE                                                                                                       \
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"                  \
    "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
#define PBRT "WorldBegin Shape \"sphere\"\n"
#define OBJ  "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"

static void the_name_picks_the_reader(void **state)
{
    (void)state;
    static const struct {
        const char *name, *text;
        shape_kind kind;
    } FILES[] = {{"a.pbrt", PBRT, SHAPE_SPHERE},
                 {"a.PBRT", PBRT, SHAPE_SPHERE},
                 {"a", PBRT, SHAPE_SPHERE},
                 {"a.txt", PBRT, SHAPE_SPHERE},
                 {"a.", PBRT, SHAPE_SPHERE},
                 {"obj", PBRT, SHAPE_SPHERE},
                 {"a.obj", OBJ, SHAPE_MESH},
                 {"b.pbrt.OBJ", OBJ, SHAPE_MESH},
                 {"a.ply", TRIANGLE, SHAPE_MESH},
                 {"A.PLY", TRIANGLE, SHAPE_MESH},
                 {"a.stl",
                  "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                  "endfacet\nendsolid a\n",
                  SHAPE_MESH}};
    for (size_t k = 0; k < sizeof FILES / sizeof *FILES; k++) {
        reading r = model_of(FILES[k].name, FILES[k].text);
        if (r.status != AG_OK)
            fail_msg("%s: %s", FILES[k].name, r.said[AG_LOG_ERROR]);
        assert_int_equal(r.scene->shape_count, 1);
        assert_int_equal(r.scene->shapes[0].kind, FILES[k].kind);
        assert_int_equal(r.scene->has_camera, FILES[k].kind == SHAPE_MESH);
        reading_destroy(&r);
    }
}

/* Without the program that imports, every file whose name no reader knows may be pbrt text; one that is not is told
 * with the reason. */
static void pbrt_text_needs_no_program_that_imports(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"a", "a.txt", "a.scene", "a.fbx"};
    const char *before = getenv("AFTERGLOW_MODULE_DIR");
    char *saved = before ? strdup(before) : NULL;
    module_folders folders;
    assert_int_equal(setenv("AFTERGLOW_MODULE_DIR", folder, 1), 0);
    module_folders_find(&folders);
    for (int k = 0; k < folders.count; k++) {
        char path[MODULE_PATH_MAX];
        snprintf(path, sizeof path, "%s/afterglow-import", folders.paths[k]);
        if (access(path, X_OK) == 0) {
            printf("SKIPPED: '%s' is installed\n", path);
            skip();
        }
    }
    for (int k = 0; k < 4; k++) {
        reading r = model_quietly(NAMES[k], PBRT);
        assert_int_equal(r.scene->shape_count, 1);
        reading_destroy(&r);
    }
    reading r = model_of("a.stl", "solid a\n");
    assert_int_equal(r.status, AG_ERROR_SCENE);
    assert_non_null(r.said[AG_LOG_WARNING]);
    assert_non_null(strstr(r.said[AG_LOG_WARNING], "the program afterglow-import, which reads other formats, is not"));
    reading_destroy(&r);
    assert_int_equal(saved ? setenv("AFTERGLOW_MODULE_DIR", saved, 1) : unsetenv("AFTERGLOW_MODULE_DIR"), 0);
    free(saved);
}

static void gzip_is_read_where_the_reader_is_ours(void **state)
{
    (void)state;
    static const char *const FILES[][2] = {
        {"a.pbrt.gz", PBRT}, {"a.ply.gz", TRIANGLE}, {"a.obj.gz", OBJ}, {"a.gz", PBRT}};
    for (int k = 0; k < 4; k++) {
        gzFile file = gzopen(in_folder(FILES[k][0]), "wb");
        assert_non_null(file);
        assert_true(gzputs(file, FILES[k][1]) > 0);
        assert_int_equal(gzclose(file), Z_OK);
        reading r = model_read(in_folder(FILES[k][0]));
        assert_int_equal(r.status, AG_OK);
        assert_int_equal(r.scene->shape_count, 1);
        reading_destroy(&r);
    }
}

static void a_ply_file_alone_is_grey_and_lit(void **state)
{
    (void)state;
    reading r = model_quietly("a.ply", TRIANGLE);
    assert_int_equal(model_mesh(&r, 0)->triangle_count, 1);
    assert_vec3(model_mesh(&r, 0)->positions[1], 1, 0, 0, 0);
    assert_int_equal(model_material(&r, 0)->kind, MATERIAL_DIFFUSE);
    assert_rgb(model_material(&r, 0)->reflectance, .5, .5, .5, 0);
    assert_true(r.scene->has_camera);
    assert_int_equal(r.scene->light_count, 2);
    model_said(&r, AG_LOG_INFO, "a.ply", ": info: a PLY file has no materials: the mesh is grey\n");
    assert_non_null(strstr(r.said[AG_LOG_INFO], "the file has no camera"));
    assert_non_null(strstr(r.said[AG_LOG_INFO], "the file has no light"));
    reading_destroy(&r);
}

static void ply_errors_name_the_file(void **state)
{
    (void)state;
    model_refused("a.ply", "", AG_ERROR_INPUT, ":");
    char cut[sizeof TRIANGLE];
    for (size_t length = 0; length + 2 < sizeof TRIANGLE; length += 3) {
        memcpy(cut, TRIANGLE, length);
        cut[length] = '\0';
        reading r = model_of("a.ply", cut);
        assert_int_equal(r.status, AG_ERROR_INPUT);
        assert_int_equal(r.count[AG_LOG_ERROR], 1);
        model_said(&r, AG_LOG_ERROR, "a.ply", ":");
        reading_destroy(&r);
    }
    reading r = model_read(in_folder("none.ply"));
    assert_int_equal(r.status, AG_ERROR_INPUT);
    model_said(&r, AG_LOG_ERROR, "none.ply", ": No such file or directory");
    reading_destroy(&r);
}

static void files_that_are_not_there_are_errors(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"none.pbrt", "none.obj", "none.ply", "none.stl", "none", "none.dae"};
    for (int k = 0; k < 6; k++) {
        reading r = model_read(in_folder(NAMES[k]));
        assert_int_equal(r.status, AG_ERROR_INPUT);
        assert_int_equal(r.count[AG_LOG_ERROR], 1);
        model_said(&r, AG_LOG_ERROR, NAMES[k], ":");
        reading_destroy(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(the_name_picks_the_reader),
        TEST_IN_FOLDER(gzip_is_read_where_the_reader_is_ours),
        TEST_IN_FOLDER(pbrt_text_needs_no_program_that_imports),
        TEST_IN_FOLDER(a_ply_file_alone_is_grey_and_lit),
        TEST_IN_FOLDER(ply_errors_name_the_file),
        TEST_IN_FOLDER(files_that_are_not_there_are_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
