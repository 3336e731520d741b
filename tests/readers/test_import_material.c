/* test_import_material.c: what becomes of the words of an MTL file: each line of the table in
 * scene/readers/model/import_material.c. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/model_fixture.h"

#include "output/image_file.h"

/* A triangle of the material that the words say. */
static reading material_of(const char *words)
{
    char text[1024];
    snprintf(text, sizeof text, "newmtl m\n%s\n", words);
    model_write_text("m.mtl", text);
    return model_of("a.obj",
                    "mtllib m.mtl\nv 0 0 0\nv 3 0 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n");
}

static reading quiet_material_of(const char *words)
{
    reading r = material_of(words);
    if (r.status != AG_OK || r.count[AG_LOG_WARNING] > 0)
        fail_msg("%s: %s%s", words, r.said[AG_LOG_ERROR] ? r.said[AG_LOG_ERROR] : "",
                 r.said[AG_LOG_WARNING] ? r.said[AG_LOG_WARNING] : "");
    return r;
}

static void write_picture(const char *name, int channel_count)
{
    static const char *const CHANNELS[] = {"R", "G", "B", "A"};
    const float pixels[8] = {.25f, .5f, .75f, .5f, .25f, .5f, .75f, .5f};
    const image_description description = {.width = 2,
                                           .height = 1,
                                           .full_width = 2,
                                           .full_height = 1,
                                           .channel_count = channel_count,
                                           .channel_names = CHANNELS,
                                           .type = IMAGE_FLOAT};
    if (image_file_write(NULL, in_folder(name), &description, pixels, message, sizeof message) != AG_OK)
        fail_msg("%s", message);
}

static void diffuse(void **state)
{
    (void)state;
    reading r = quiet_material_of("Ka 1 1 1\nKd .1 .2 .3\nKs 0 0 0\nNs 10\nillum 1");
    const material *m = model_material(&r, 0);
    assert_int_equal(m->kind, MATERIAL_DIFFUSE);
    assert_rgb(m->reflectance, .1, .2, .3, 1e-7);
    assert_near(r.scene->shapes[0].alpha, 1, 0);
    reading_destroy(&r);
    r = quiet_material_of("Kd 0.5");
    assert_rgb(model_material(&r, 0)->reflectance, .5, .5, .5, 0);
    reading_destroy(&r);
    r = quiet_material_of("Kd 7 -1 .5"); /* what no surface can do */
    assert_rgb(model_material(&r, 0)->reflectance, 1, 0, .5, 0);
    reading_destroy(&r);
}

static void glossy(void **state)
{
    (void)state;
    reading r = quiet_material_of("Kd .1 .2 .3\nKs .5 .5 .25\nNs 48\nillum 2");
    const material *m = model_material(&r, 0);
    assert_int_equal(m->kind, MATERIAL_PRINCIPLED);
    assert_rgb(m->reflectance, .1, .2, .3, 1e-7);
    assert_rgb(m->specular_color, 1, 1, .5, 1e-7);
    assert_near(m->alpha_u, 0.2, 1e-6); /* sqrt(2 / 50) */
    assert_near(m->roughness * m->roughness, m->alpha_u, 1e-6);
    assert_near(m->metallic, 0, 0);
    reading_destroy(&r);
}

static void extension_for_pbr(void **state)
{
    (void)state;
    reading r = quiet_material_of("Kd .1 .2 .3\nKs .9 .9 .9\nPr .5\nPm .25\nPc .75\nPcr .125\nNi 1.3");
    const material *m = model_material(&r, 0);
    assert_int_equal(m->kind, MATERIAL_PRINCIPLED);
    assert_near(m->roughness, .5, 0);
    assert_near(m->alpha_v, .25, 0);
    assert_near(m->metallic, .25, 0);
    assert_near(m->clearcoat, .75, 0);
    assert_near(m->clearcoat_roughness, .125, 0);
    assert_near(m->ior, 1.3, 1e-6);
    assert_rgb(m->specular_color, 1, 1, 1, 0);
    reading_destroy(&r);
}

static void mirrors(void **state)
{
    (void)state;
    static const int ILLUMINATIONS[] = {3, 5, 8};
    for (int k = 0; k < 3; k++) {
        char words[128];
        snprintf(words, sizeof words, "Kd 0 0 0\nKs .9 .8 .7\nillum %d", ILLUMINATIONS[k]);
        reading r = quiet_material_of(words);
        const material *m = model_material(&r, 0);
        assert_int_equal(m->kind, MATERIAL_PRINCIPLED);
        assert_near(m->metallic, 1, 0);
        assert_near(m->alpha_u, 0, 0);
        assert_rgb(m->reflectance, .9, .8, .7, 1e-6);
        reading_destroy(&r);
    }
    /* over a diffuse base: of the index that reflects Ks */
    reading r = quiet_material_of("Kd .5 .5 .5\nKs .25 .25 .125\nillum 3");
    const material *m = model_material(&r, 0);
    assert_near(m->metallic, 0, 0);
    double f0 = (m->ior - 1.0) / (m->ior + 1.0);
    assert_near(f0 * f0, .25, 1e-6);
    assert_rgb(m->specular_color, 1, 1, .5, 1e-6);
    reading_destroy(&r);
}

static void glass(void **state)
{
    (void)state;
    static const int ILLUMINATIONS[] = {4, 6, 7, 9};
    for (int k = 0; k < 4; k++) {
        char words[128];
        snprintf(words, sizeof words, "Kd 0 0 0\nKs 1 1 1\nTf 1 1 1\nd .1\nNi 1.33\nillum %d", ILLUMINATIONS[k]);
        reading r = quiet_material_of(words);
        const material *m = model_material(&r, 0);
        assert_int_equal(m->kind, MATERIAL_DIELECTRIC);
        assert_near(m->ior, 1.33, 1e-6);
        assert_near(m->alpha_u, 0, 0);
        assert_near(r.scene->shapes[0].alpha, 1, 0);
        reading_destroy(&r);
    }
    reading r = quiet_material_of("illum 7");
    assert_near(model_material(&r, 0)->ior, 1.5, 0);
    reading_destroy(&r);
    r = quiet_material_of("Tf .9 .5 .5\nNi 1.6\nillum 7");
    const material *m = model_material(&r, 0);
    assert_int_equal(m->kind, MATERIAL_PRINCIPLED);
    assert_near(m->transmission, 1, 0);
    assert_false(m->is_thin);
    assert_rgb(m->reflectance, .9, .5, .5, 1e-6);
    assert_near(m->ior, 1.6, 1e-6);
    reading_destroy(&r);
}

static void opacity(void **state)
{
    (void)state;
    static const struct {
        const char *words;
        double alpha;
    } CASES[] = {{"d .25", .25}, {"d -halo .25", .25}, {"Tr .25", .75}, {"d 1\nTr 1", 1}, {"Tr 1\nd 1", 1}, {"d 2", 1}};
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        reading r = quiet_material_of(CASES[k].words);
        assert_near(r.scene->shapes[0].alpha, CASES[k].alpha, 0);
        reading_destroy(&r);
    }
    reading r = material_of("d 0");
    model_said(&r, AG_LOG_WARNING, "a.obj",
               ": warning: material \"m\" has the opacity 0: what is made of it is not seen\n");
    reading_destroy(&r);
}

static void lamps(void **state)
{
    (void)state;
    reading r = quiet_material_of("Kd 0 0 0\nKe 3 2 1");
    assert_int_equal(r.scene->light_count, 1); /* the lamp alone: no light is made up */
    assert_int_equal(r.scene->lights[0].kind, LIGHT_AREA);
    assert_true(r.scene->lights[0].as.area.two_sided);
    assert_rgb(r.scene->lights[0].as.area.radiance, 3, 2, 1, 0);
    assert_int_equal(r.scene->shapes[0].light_index, 0);
    reading_destroy(&r);
    r = quiet_material_of("Ke 0 0 0");
    assert_int_equal(r.scene->shapes[0].light_index, SHAPE_NO_LIGHT);
    reading_destroy(&r);
}

static const texture *texture_of(const reading *r, uint32_t index)
{
    assert_true(index < r->scene->textures.count);
    return &r->scene->textures.items[index];
}

static void pictures(void **state)
{
    (void)state;
    assert_int_equal(mkdir(in_folder("sub dir"), 0755), 0);
    write_picture("sub dir/p q.exr", 3);
    reading r = quiet_material_of("Kd .5 .5 .5\nmap_Kd -s 2 3 1 -o .5 -clamp on sub dir\\p q.exr");
    const material *m = model_material(&r, 0);
    assert_int_equal(m->kind, MATERIAL_DIFFUSE);
    const texture *t = texture_of(&r, m->reflectance_texture);
    assert_int_equal(t->kind, TEXTURE_IMAGE);
    assert_true(t->is_spectrum);
    assert_near(t->scale, .5, 0);
    assert_near(t->mapping.scale.x, 2, 0);
    assert_near(t->mapping.scale.y, 3, 0);
    assert_near(t->mapping.delta.x, .5, 0);
    assert_int_equal(t->wraps.s, TEXTURE_WRAP_CLAMP);
    assert_int_equal(t->wraps.t, TEXTURE_WRAP_CLAMP);
    reading_destroy(&r);

    /* a colour that is none of grey multiplies; what is not said, or black, does not darken */
    r = quiet_material_of("Kd .5 .25 .5\nmap_Kd sub dir/p q.exr");
    m = model_material(&r, 0);
    assert_int_equal(m->kind, MATERIAL_PRINCIPLED);
    assert_near(m->specular, 0, 0);
    assert_rgb(m->reflectance, .5, .25, .5, 0);
    assert_int_equal(texture_of(&r, m->reflectance_texture)->wraps.s, TEXTURE_WRAP_REPEAT);
    reading_destroy(&r);
    static const char *const WHITE[] = {"map_Kd C:\\once\\upon\\p.exr", "Kd 0 0 0\nmap_Kd p.exr",
                                        "map_Kd /nowhere/p.exr"};
    write_picture("p.exr", 3);
    for (int k = 0; k < 3; k++) {
        r = quiet_material_of(WHITE[k]);
        assert_near(texture_of(&r, model_material(&r, 0)->reflectance_texture)->scale, 1, 0);
        reading_destroy(&r);
    }

    r = quiet_material_of("Pr .5\nmap_Pr p.exr\nmap_Pm p.exr\nnorm -bm 2 p.exr");
    m = model_material(&r, 0);
    assert_false(texture_of(&r, m->roughness_texture)->is_spectrum);
    assert_near(m->roughness, .5, 0);
    assert_near(m->metallic, 1, 0);
    assert_true(m->metallic_texture != SCENE_NO_TEXTURE);
    assert_true(texture_of(&r, m->normal_map_texture)->is_spectrum);
    assert_near(m->normal_scale, 2, 0);
    reading_destroy(&r);

    /* heights: 0.002 of the diagonal, which is 5 */
    r = quiet_material_of("map_Bump -bm .5 p.exr");
    m = model_material(&r, 0);
    assert_near(texture_of(&r, m->displacement_texture)->scale, .005, 1e-8);
    reading_destroy(&r);
    r = quiet_material_of("map_Ke p.exr");
    assert_rgb(r.scene->lights[0].as.area.radiance, 1, 1, 1, 0);
    assert_true(texture_of(&r, r.scene->lights[0].as.area.radiance_texture)->is_spectrum);
    reading_destroy(&r);
}

static void opacity_is_alpha_where_there_is_one(void **state)
{
    (void)state;
    write_picture("leaf.exr", 4);
    write_picture("gray.exr", 3);
    reading r = quiet_material_of("d .5\nmap_d leaf.exr");
    const texture *t = texture_of(&r, r.scene->shapes[0].alpha_texture);
    assert_int_equal(t->channel, TEXTURE_CHANNEL_A);
    assert_near(t->scale, .5, 0);
    reading_destroy(&r);
    r = quiet_material_of("map_d gray.exr");
    assert_int_equal(texture_of(&r, r.scene->shapes[0].alpha_texture)->channel, TEXTURE_CHANNEL_MEAN);
    reading_destroy(&r);
    write_picture("tiles.1001.exr", 3);
    write_picture("tiles.1012.exr", 4);
    r = quiet_material_of("map_d tiles.<UDIM>.exr");
    assert_int_equal(texture_of(&r, r.scene->shapes[0].alpha_texture)->channel, TEXTURE_CHANNEL_A);
    reading_destroy(&r);
}

static void pictures_that_are_not_there_are_warnings(void **state)
{
    (void)state;
    model_write_text("text.png", "no picture");
    reading r = material_of("Kd .1 .2 .3\nmap_Kd none.png");
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.count[AG_LOG_WARNING], 1);
    model_said(&r, AG_LOG_WARNING, "a.obj", ": warning: the picture \"none.png\" is not used: there is no such file\n");
    assert_rgb(model_material(&r, 0)->reflectance, .1, .2, .3, 1e-7);
    assert_int_equal(model_material(&r, 0)->reflectance_texture, SCENE_NO_TEXTURE);
    reading_destroy(&r);
    r = material_of("map_Kd text.png\nmap_d text.png");
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.count[AG_LOG_WARNING], 1);
    model_said(&r, AG_LOG_WARNING, "a.obj", ": warning: the picture \"text.png\" is not used: ");
    reading_destroy(&r);
}

static void words_that_are_not_supported_are_named(void **state)
{
    (void)state;
    reading r =
        material_of("aniso .5\nanisor 0\nmap_Ks a.png\nmap_Ks b.png\nmap_Kd -mm 0 1 -t 1 none.png\nKs spectral a.rfl");
    assert_int_equal(r.status, AG_OK);
    model_said(&r, AG_LOG_WARNING, "m.mtl",
               ":2:1: warning: \"aniso\" is not known, or not supported, and is ignored\n");
    model_said(&r, AG_LOG_WARNING, "m.mtl",
               ":4:1: warning: \"map_Ks\" is not known, or not supported, and is ignored\n");
    model_said(&r, AG_LOG_WARNING, "m.mtl",
               ":6:8: warning: the option \"-mm\" is not supported and is ignored, as are any others\n");
    model_said(&r, AG_LOG_WARNING, "m.mtl",
               ":7:4: warning: \"Ks spectral\" is not supported and is ignored, as are any others\n");
    assert_int_equal(r.count[AG_LOG_WARNING], 6);
    reading_destroy(&r);
    static const struct {
        const char *words, *expected;
    } WRONG[] = {{"Ns", ":2:3: error: Ns is missing"},
                 {"Kd 1 2", ":2:7: error: Kd is missing"},
                 {"illum two", ":2:7: error: illum should be a finite number"},
                 {"map_Kd -s 1 1 1", ":2:16: error: the picture's name is missing"}};
    for (size_t k = 0; k < sizeof WRONG / sizeof *WRONG; k++) {
        r = material_of(WRONG[k].words);
        assert_int_equal(r.status, AG_ERROR_SCENE);
        model_said(&r, AG_LOG_ERROR, "m.mtl", WRONG[k].expected);
        reading_destroy(&r);
    }
    model_write_text("m.mtl", "Kd 1 1 1\n");
    r = model_of("a.obj", "mtllib m.mtl\n");
    model_said(&r, AG_LOG_ERROR, "m.mtl", ":1:1: error: \"Kd\" stands before the first newmtl");
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(diffuse),
        TEST_IN_FOLDER(glossy),
        TEST_IN_FOLDER(extension_for_pbr),
        TEST_IN_FOLDER(mirrors),
        TEST_IN_FOLDER(glass),
        TEST_IN_FOLDER(opacity),
        TEST_IN_FOLDER(lamps),
        TEST_IN_FOLDER(pictures),
        TEST_IN_FOLDER(opacity_is_alpha_where_there_is_one),
        TEST_IN_FOLDER(pictures_that_are_not_there_are_warnings),
        TEST_IN_FOLDER(words_that_are_not_supported_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
