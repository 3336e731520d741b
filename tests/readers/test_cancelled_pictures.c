/* test_cancelled_pictures.c: a run that is cancelled while a picture is read ends with AG_CANCELLED, and nothing more
 * is said. Flow: tests of the readers. Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/gltf_fixture.h"
#include "fixtures/model_fixture.h"
#include "fixtures/tiled_tiff.h"

static unsigned char gray(uint32_t level, uint32_t x, uint32_t y, uint32_t channel)
{
    (void)level, (void)x, (void)y, (void)channel;
    return 128;
}

typedef struct listener {
    run_context run;
    int count;
} listener;

static void cancel_at_first_word(void *user, ag_log_level level, const char *text)
{
    listener *l = user;
    (void)text;
    if (level > AG_LOG_WARNING)
        return;
    l->count++;
    run_cancel(&l->run);
}

/* The file is such that the reader warns of something right before it reads the picture. */
static void expect_cancelled(const char *path)
{
    listener l = {.count = 0};
    scene *s = scene_create();
    log_sink *log = log_create(cancel_at_first_word, &l);
    assert_true(s && log);
    run_context_init(&l.run, NULL, log, NULL, NULL);
    const ag_status status = scene_file_load(&l.run, path, s);
    if (status != AG_CANCELLED)
        fail_msg("%s: %s", path, ag_status_text(status));
    assert_int_equal(l.count, 1);
    scene_destroy(s);
    log_destroy(log);
    run_context_reset(&l.run);
}

static void cancelled_pictures_are_silent(void **state)
{
    (void)state;
    tiff_write_levels("a.tif", 128, 3, gray);
    expect_cancelled(model_write_text("a.pbrt", "Camera \"perspective\" WorldBegin "
                                                "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.tif\" "
                                                "\"float gamma\" 2 "
                                                "Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\""));
    expect_cancelled(model_write_text("l.pbrt", "Camera \"perspective\" WorldBegin Scale 1 2 3 "
                                                "LightSource \"goniometric\" \"string filename\" \"a.tif\""));
    expect_cancelled(model_write_text("p.pbrt", "Camera \"perspective\" WorldBegin Scale 1 2 3 "
                                                "LightSource \"projection\" \"string filename\" \"a.tif\""));
    model_write_text("m.mtl", "newmtl m\nd 0\nmap_d a.tif\n");
    expect_cancelled(model_write_text(
        "a.obj", "mtllib m.mtl\nv 0 0 0\nv 3 0 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n"));
    write_triangle();
    char *json = json_text(
        "{" GLTF_ASSET GLTF_TRIANGLE_BUFFER "'nodes': [{'mesh': 0}],"
        "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'},"
        "  {'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC2'}],"
        "'meshes': [{'primitives': [{'material': 0, 'attributes': {'POSITION': 0, 'TEXCOORD_0': 1}}]}],"
        "'materials': [{'pbrMetallicRoughness': {'metallicFactor': 7, 'metallicRoughnessTexture': {'index': 0}}}],"
        "'textures': [{'source': 0}], 'images': [{'uri': 'a.tif'}]}");
    expect_cancelled(model_write_text("a.gltf", json));
    free(json);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(cancelled_pictures_are_silent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
