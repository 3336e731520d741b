/* test_pbrt_surfaces.c: surface detail as the pbrt reader makes it: alpha, bump and normal maps, textures of a metal,
 * of its roughness and of what a sheet transmits; pbrt-v3's materials and those that are not supported, with what
 * stands in. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/pbrt_fixture.h"
#include "material/material_point.h"

#include "color/spectra.h"
#include "fixtures/environment_picture.h"
#include "shape/alpha.h"

/* The material of the only shape, and the warnings; text is freed by reading_destroy. */
static reading read_world(const char *text)
{
    char whole[2048];
    int length = snprintf(whole, sizeof whole, "WorldBegin %s", text);
    assert_true(length < (int)sizeof whole);
    reading r = reading_create(NULL, whole, (size_t)length);
    if (r.status != AG_OK)
        fail_msg("%s", r.said[AG_LOG_ERROR]);
    return r;
}

static material last_material(const reading *r) { return r->scene->materials[r->scene->material_count - 1]; }

static void expect_silence(const reading *r)
{
    if (r->count[AG_LOG_WARNING] != 0)
        fail_msg("%s", r->said[AG_LOG_WARNING]);
}

static material silent_material(const char *text)
{
    reading r = read_world(text);
    expect_silence(&r);
    material m = last_material(&r);
    reading_destroy(&r);
    return m;
}

/* The material that the text makes, and the warnings that come with it, each without its location, and a line end
 * behind. */
static material warned_material(const char *text, const char *warnings)
{
    reading r = read_world(text);
    char said[2048] = "";
    for (const char *line = r.said[AG_LOG_WARNING]; line && *line; line = strchr(line, '\n') + 1) {
        const char *warning = strstr(line, "warning: ") + strlen("warning: ");
        snprintf(said + strlen(said), sizeof said - strlen(said), "%.*s", (int)(strchr(warning, '\n') + 1 - warning),
                 warning);
    }
    assert_string_equal(said, warnings);
    material m = last_material(&r);
    reading_destroy(&r);
    return m;
}

static void assert_same_rgb(rgb a, rgb b) { assert_rgb(a, (double)b.r, (double)b.g, (double)b.b, 1e-6); }

static void refuses(const char *text, const char *expected)
{
    char whole[1024];
    int length = snprintf(whole, sizeof whole, "WorldBegin %s", text);
    reading r = reading_create(NULL, whole, (size_t)length);
    if (r.status == AG_OK || !r.said[AG_LOG_ERROR] || !strstr(r.said[AG_LOG_ERROR], expected))
        fail_msg("%s\n    should say: %s    but says: %s", text, expected,
                 r.said[AG_LOG_ERROR] ? r.said[AG_LOG_ERROR] : "nothing");
    reading_destroy(&r);
}

/* ---- alpha ---- */

#define FLOATS "Texture \"f\" \"float\" \"checkerboard\" Texture \"c\" \"float\" \"constant\" \"float value\" 0.25 "

static void alpha_of_every_shape(void **state)
{
    (void)state;
    static const char *const SHAPES[] = {
        "\"sphere\"",
        "\"disk\"",
        "\"cylinder\"",
        "\"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]",
        "\"bilinearmesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]",
        "\"loopsubdiv\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 ]"};
    for (size_t i = 0; i < sizeof SHAPES / sizeof *SHAPES; i++) {
        char text[1024];
        snprintf(text, sizeof text,
                 FLOATS
                 "Shape %s Shape %s \"float alpha\" 0.5 Shape %s \"texture alpha\" \"f\" Shape %s \"texture alpha\" "
                 "\"c\" Shape %s",
                 SHAPES[i], SHAPES[i], SHAPES[i], SHAPES[i], SHAPES[i]);
        reading r = read_world(text);
        expect_silence(&r);
        const shape *s = r.scene->shapes;
        assert_true(shape_is_opaque(&s[0]) && s[0].alpha == 1.0f && s[0].alpha_cutoff == 0.0f);
        assert_true(s[1].alpha == 0.5f && s[1].alpha_texture == SCENE_NO_TEXTURE);
        assert_true(s[2].alpha == 1.0f && s[2].alpha_texture == 0 && !shape_is_opaque(&s[2]));
        assert_true(s[3].alpha == 0.25f && s[3].alpha_texture == SCENE_NO_TEXTURE);
        assert_true(shape_is_opaque(&s[4])); /* of one shape alone */
        reading_destroy(&r);
    }
    refuses("Shape \"sphere\" \"texture alpha\" \"f\"", "no float texture is named \"f\"");
    refuses("Shape \"sphere\" \"string alpha\" \"f\"", "\"string alpha\" should be \"float alpha\"");
}

/* ---- maps ---- */

static void displacement(void **state)
{
    (void)state;
    static const char *const KINDS[] = {"diffuse",    "coateddiffuse",  "coatedconductor", "diffusetransmission",
                                        "dielectric", "thindielectric", "conductor"};
    for (size_t i = 0; i < sizeof KINDS / sizeof *KINDS; i++) {
        char text[256];
        snprintf(text, sizeof text, FLOATS "Material \"%s\" \"texture displacement\" \"f\"", KINDS[i]);
        material m = silent_material(text);
        assert_int_equal(m.displacement_texture, 0);
        assert_int_equal(m.normal_map_texture, SCENE_NO_TEXTURE);
        /* what is everywhere as high tilts nothing */
        snprintf(text, sizeof text, FLOATS "Material \"%s\" \"texture displacement\" \"c\"", KINDS[i]);
        assert_int_equal(silent_material(text).displacement_texture, SCENE_NO_TEXTURE);
        snprintf(text, sizeof text, "Material \"%s\" \"float displacement\" 2", KINDS[i]);
        assert_int_equal(silent_material(text).displacement_texture, SCENE_NO_TEXTURE);
    }
}

static void normal_maps(void **state)
{
    (void)state;
    /* two pixels of 8 bits, not to be decoded: 0.5 stays 128/255 */
    static const float PIXELS[6] = {0.5f, 0.5f, 1.0f, 0.75f, 0.5f, 0.9f}, GREY[3] = {0.5f, 0.5f, 0.5f};
    static const char *const Y[1] = {"Y"};
    char text[512];
    const char *path = write_environment("normals.png", 2, 1, IMAGE_UINT8, PIXELS);
    snprintf(text, sizeof text,
             FLOATS "Material \"conductor\" \"string normalmap\" \"%s\"\n"
                    "Material \"diffuse\" \"string normalmap\" \"%s\"",
             path, path);
    reading r = read_world(text);
    expect_silence(&r);
    material m = last_material(&r);
    assert_int_equal(r.scene->textures.image_count, 1);
    assert_true(m.normal_scale == 1.0f);
    surface_hit hit = {.uv = {0.25f, 0.5f}};
    assert_rgb(texture_evaluate_rgb(&r.scene->textures, m.normal_map_texture, &hit), 128 / 255.0, 128 / 255.0, 1, 1e-6);
    hit.uv.x = 1.75f; /* it repeats */
    assert_rgb(texture_evaluate_rgb(&r.scene->textures, m.normal_map_texture, &hit), 191 / 255.0, 128 / 255.0,
               230 / 255.0, 1e-6);
    reading_destroy(&r);
    snprintf(text, sizeof text,
             FLOATS "Material \"diffuse\" \"string normalmap\" \"%s\" \"texture displacement\" \"f\"", path);
    m = warned_material(text, "of \"displacement\" and \"normalmap\" together only the latter is used\n");
    assert_true(m.normal_map_texture != SCENE_NO_TEXTURE);

    const image_description description = {.width = 3,
                                           .height = 1,
                                           .full_width = 3,
                                           .full_height = 1,
                                           .channel_count = 1,
                                           .channel_names = Y,
                                           .type = IMAGE_UINT8};
    const char *grey = in_folder("grey.png");
    if (image_file_write(NULL, grey, &description, GREY, message, sizeof message) != AG_OK)
        fail_msg("%s", message);
    snprintf(text, sizeof text, "Material \"diffuse\" \"string normalmap\" \"%s\"", grey);
    refuses(text, "is no normal map: it has no red, green and blue");
    refuses("Material \"diffuse\" \"string normalmap\" \"no such file.png\"", "no such file.png");
    refuses("Material \"diffuse\" \"float normalmap\" 1", "\"float normalmap\" should be \"string normalmap\"");
}

/* A displacement's slope is taken over half a pixel of the finest picture in it. */
static void slopes_are_as_fine_as_pictures(void **state)
{
    (void)state;
    static const float PIXELS[3 * 8] = {0.0f};
    char text[1024];
    const char *path = write_environment("bumps.png", 8, 1, IMAGE_UINT8, PIXELS);
    snprintf(text, sizeof text,
             "Texture \"i\" \"float\" \"imagemap\" \"string filename\" \"%s\" \"float uscale\" 2\n"
             "Texture \"s\" \"float\" \"scale\" \"texture tex\" \"i\" \"float scale\" 0.1\n"
             "Texture \"n\" \"float\" \"fbm\"\n"
             "Texture \"m\" \"float\" \"mix\" \"texture tex1\" \"s\" \"texture tex2\" \"n\"",
             path);
    reading r = read_world(text);
    assert_near(r.scene->textures.items[0].step, 0.5 / 16, 1e-7);
    assert_near(r.scene->textures.items[1].step, 0.5 / 16, 1e-7);
    assert_near(r.scene->textures.items[3].step, 0.0005, 1e-9);
    reading_destroy(&r);
}

/* ---- textures of what was a number ---- */

static void metals_from_textures(void **state)
{
    (void)state;
    const char *const colors =
        "Texture \"e\" \"spectrum\" \"bilerp\" \"rgb v00\" [ .2 .4 .6 ] \"rgb v01\" [ .2 .4 .6 ]\n"
        "\"rgb v10\" [ 2 3 4 ] \"rgb v11\" [ 2 3 4 ]\n"
        "Texture \"r\" \"float\" \"bilerp\" \"float v00\" .04 \"float v01\" .04 \"float v10\" .16 "
        "\"float v11\" .16\n";
    char text[1024];
    surface_hit hit = {.uv = {0.0f, 0.5f}};
    material_point m;
    snprintf(text, sizeof text, "%s Material \"conductor\" \"texture eta\" \"e\" \"texture k\" \"e\" Shape \"sphere\"",
             colors);
    reading r = read_world(text);
    expect_silence(&r);
    material_at(r.scene, &hit, &m);
    assert_rgb(m.metal.eta, .2, .4, .6, 1e-6);
    assert_rgb(m.metal.k, .2, .4, .6, 1e-6);
    reading_destroy(&r);
    /* relative to the coat; the base's roughness is its own */
    snprintf(
        text, sizeof text,
        "%s Material \"coatedconductor\" \"texture conductor.eta\" \"e\" \"float interface.eta\" 2 \"rgb conductor.k\" "
        "[ 3 3 3 ]\n\"texture conductor.roughness\" \"r\" \"float interface.roughness\" .09 Shape \"sphere\"",
        colors);
    r = read_world(text);
    expect_silence(&r);
    hit.uv.x = 1.0f;
    material_at(r.scene, &hit, &m);
    assert_rgb(m.coat.eta, 1, 1.5, 2, 1e-6);
    assert_rgb(m.coat.k, 1.5, 1.5, 1.5, 1e-6);
    assert_near(m.coat.base.alpha_u, .4, 1e-6);
    assert_near(m.coat.base.alpha_v, .4, 1e-6);
    assert_near(m.coat.interface.alpha_u, .3, 1e-6);
    reading_destroy(&r);
}

/* Roughness may have a texture for both axes, and one for a single axis. */
static void roughness_from_textures(void **state)
{
    (void)state;
    material m = silent_material(FLOATS "Material \"dielectric\" \"texture roughness\" \"f\"");
    assert_int_equal(m.alpha_u_texture, 0);
    assert_int_equal(m.alpha_v_texture, 0);
    m = silent_material(FLOATS "Material \"conductor\" \"float vroughness\" .04 \"texture uroughness\" \"f\"");
    assert_int_equal(m.alpha_u_texture, 0);
    assert_int_equal(m.alpha_v_texture, SCENE_NO_TEXTURE);
    assert_near(m.alpha_v, .2, 1e-6);
    m = silent_material(FLOATS "Material \"coateddiffuse\" \"float vroughness\" .04 \"texture roughness\" \"f\"");
    assert_int_equal(m.alpha_u_texture, 0);
    assert_int_equal(m.alpha_v_texture, SCENE_NO_TEXTURE);
}

static void transmission_is_scaled_in_textures(void **state)
{
    (void)state;
    reading r = read_world("Texture \"t\" \"spectrum\" \"bilerp\" \"rgb v00\" [ .2 .4 .6 ] \"rgb v01\" [ .2 .4 .6 ]\n"
                           "\"rgb v10\" [ 1 1 1 ] \"rgb v11\" [ 1 1 1 ]\n"
                           "Material \"diffusetransmission\" \"texture transmittance\" \"t\" \"float scale\" .5 \"bool "
                           "remaproughness\" true Shape \"sphere\"");
    expect_silence(&r);
    surface_hit hit = {.uv = {0.0f, 0.5f}};
    material_point m;
    material_at(r.scene, &hit, &m);
    assert_rgb(m.diffuse.transmittance, .1, .2, .3, 1e-6);
    assert_rgb(m.diffuse.reflectance, .125, .125, .125, 1e-6);
    reading_destroy(&r);
}

/* ---- pbrt-v3's ---- */

#define READ_AS(old, new)                                                                                              \
    "material \"" old "\" is pbrt-v3's: it is read as \"" new "\", as pbrt-v4's \"--upgrade\" does\n"
#define UNUSED(name, old) "\"" name "\" of pbrt-v3's material \"" old "\" is not used\n"

static void old_plastics(void **state)
{
    (void)state;
    material m = warned_material(FLOATS "Material \"matte\" \"rgb Kd\" [ .1 .2 .3 ] \"texture bumpmap\" \"f\"",
                                 READ_AS("matte", "diffuse"));
    assert_int_equal(m.kind, MATERIAL_DIFFUSE);
    assert_rgb(m.reflectance, .1, .2, .3, 1e-7);
    assert_int_equal(m.displacement_texture, 0);
    m = warned_material("Material \"matte\" \"float sigma\" 20 Material \"matte\" \"float sigma\" 30",
                        UNUSED("sigma", "matte") READ_AS("matte", "diffuse"));
    assert_rgb(m.reflectance, .5, .5, .5, 0);
    m = warned_material("Material \"plastic\" \"rgb Kd\" [ .1 .2 .3 ] \"float roughness\" .04",
                        READ_AS("plastic", "coateddiffuse"));
    assert_int_equal(m.kind, MATERIAL_COATED_DIFFUSE);
    assert_rgb(m.reflectance, .1, .2, .3, 1e-7);
    assert_near(m.alpha_u, .2, 1e-6);
    m = warned_material("Material \"plastic\" \"rgb Ks\" [ 0 0 0 ] \"float roughness\" .04",
                        READ_AS("plastic", "diffuse"));
    assert_int_equal(m.kind, MATERIAL_DIFFUSE);
    m = warned_material("Material \"plastic\" \"rgb Ks\" [ .3 .3 .3 ]",
                        UNUSED("Ks", "plastic") READ_AS("plastic", "coateddiffuse"));
    assert_int_equal(m.kind, MATERIAL_COATED_DIFFUSE);
    m = warned_material(
        "Material \"uber\" \"rgb Kd\" [ .1 .2 .3 ] \"rgb Kr\" [ 0 0 0 ] \"rgb Kt\" [ .5 0 0 ] \"rgb opacity\" "
        "[ 1 1 1 ] \"float index\" 1.3",
        UNUSED("Kt", "uber") READ_AS("uber", "coateddiffuse"));
    assert_near(m.ior, 1.3, 1e-6);
    assert_rgb(m.reflectance, .1, .2, .3, 1e-7);
    m = warned_material("Material \"substrate\" \"rgb Kd\" [ .1 .2 .3 ] \"rgb Ks\" [ 1 1 1 ] \"float uroughness\" .01 "
                        "\"float vroughness\" .04",
                        READ_AS("substrate", "coateddiffuse"));
    assert_near(m.alpha_u, .1, 1e-6);
    assert_near(m.alpha_v, .2, 1e-6);
}

static void old_glass_and_metal(void **state)
{
    (void)state;
    material m =
        warned_material("Material \"glass\" \"float index\" 1.7 \"rgb Kr\" [ 1 1 1 ]", READ_AS("glass", "dielectric"));
    assert_int_equal(m.kind, MATERIAL_DIELECTRIC);
    assert_near(m.ior, 1.7, 1e-6);
    m = warned_material("Material \"mirror\"", READ_AS("mirror", "conductor"));
    assert_int_equal(m.kind, MATERIAL_CONDUCTOR);
    assert_same_rgb(m.eta, spectrum("metal-Ag-eta"));
    assert_same_rgb(m.k, spectrum("metal-Ag-k"));
    assert_near(m.alpha_u, 0, 0);
    m = warned_material(
        "MakeNamedMaterial \"a\" \"string type\" \"metal\" \"spectrum eta\" \"metal-Al-eta\" \"spectrum k\" "
        "\"metal-Al-k\" \"float roughness\" .01",
        READ_AS("metal", "conductor"));
    assert_same_rgb(m.eta, spectrum("metal-Al-eta"));
    assert_near(m.alpha_u, .1, 1e-6);
    m = warned_material(
        "Material \"translucent\" \"rgb Kd\" [ .3 .3 .2 ] \"rgb transmit\" [ 1 1 1 ] \"rgb Ks\" [ 0 0 0 ]",
        READ_AS("translucent", "diffusetransmission"));
    assert_int_equal(m.kind, MATERIAL_DIFFUSE_TRANSMISSION);
    assert_rgb(m.transmittance, .3, .3, .2, 1e-7);
    assert_rgb(m.reflectance, .25, .25, .25, 1e-7);
}

static void old_mixes(void **state)
{
    (void)state;
    material m =
        warned_material("MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"b\" \"string type\" "
                        "\"conductor\" Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" "
                        "\"b\" \"rgb amount\" [ .2 .4 .6 ]",
                        "\"rgb amount\" of \"mix\" is not supported: the mean of its components is used\n");
    assert_int_equal(m.kind, MATERIAL_MIX);
    assert_near(m.mix_amount, .4, 1e-6);
    assert_int_equal(m.mixed[0], 2); /* the amount was that of the first, and is that of the second */
    assert_int_equal(m.mixed[1], 1);
}

/* ---- hair ---- */

static void hair_is_colored_by_one_of_its_words(void **state)
{
    (void)state;
    material m = silent_material("Material \"hair\"");
    assert_int_equal(m.kind, MATERIAL_HAIR);
    assert_near(m.ior, 1.55, 1e-6);
    assert_near(m.hair_beta_m, .3, 1e-6);
    assert_near(m.hair_beta_n, .3, 1e-6);
    assert_near(m.hair_tilt_degrees, 2, 1e-6);
    assert_rgb(m.hair_sigma_a, 1.3 * .419, 1.3 * .697, 1.3 * 1.37, 1e-5);
    m = silent_material("Material \"hair\" \"float eumelanin\" .5 \"float pheomelanin\" 2 \" float beta_n\" .5");
    assert_rgb(m.hair_sigma_a, .5 * .419 + 2 * .187, .5 * .697 + 2 * .4, .5 * 1.37 + 2 * 1.05, 1e-5);
    assert_near(m.hair_beta_n, .5, 1e-6);
    m = silent_material("Material \"hair\" \"rgb sigma_a\" [ .1 0 3 ] \"rgb color\" [ .1 .2 .3 ] \"float eta\" 1.4");
    assert_rgb(m.hair_sigma_a, .1, 0, 3, 1e-6);
    assert_near(m.ior, 1.4, 1e-6);
    /* of a colour: (ln c / fit)^2 */
    double fit = 5.969 - 0.215 * .3 + 2.532 * .09 - 10.73 * .027 + 5.574 * .0081 + 0.245 * .00243;
    static const char *const COLORS[] = {"reflectance", "color"};
    for (int i = 0; i < 2; i++) {
        char text[128];
        snprintf(text, sizeof text, "Material \"hair\" \"rgb %s\" [ .35 1 .1 ]", COLORS[i]);
        m = silent_material(text);
        assert_rgb(m.hair_sigma_a, pow(log(.35) / fit, 2), 0, pow(log(.1) / fit, 2), 1e-5);
    }
    refuses("Material \"hair\" \"float beta_m\" 1.5", "\"beta_m\" should be from 0 to 1");
    refuses("Material \"hair\" \"float eta\" .9", "\"eta\" of \"hair\" should be above 1");
    refuses("Material \"hair\" \"rgb sigma_a\" [ -1 0 0 ]", "\"rgb sigma_a\" has a negative component");
    m = warned_material(FLOATS "Material \"hair\" \"texture beta_m\" \"f\"",
                        "material \"hair\": a texture for \"beta_m\" that varies is not supported: 0.3 stands in\n");
    assert_near(m.hair_beta_m, .3, 1e-6);
    m = warned_material(FLOATS "Material \"hair\" \"texture eumelanin\" \"f\"",
                        "material \"hair\": a texture for \"eumelanin\" that varies is not supported: 1.3 stands in\n");
    assert_rgb(m.hair_sigma_a, 1.3 * .419, 1.3 * .697, 1.3 * 1.37, 1e-5);
}

/* Curves of the type "cylinder" with hair are flat to rays, since hair scatters as a whole fibre. */
static void curves_of_hair_are_flat_to_rays(void **state)
{
    (void)state;
    static const struct {
        const char *material;
        curves_type type;
    } CASES[] = {
        {"Material \"hair\"", CURVES_FLAT},
        {"Material \"diffuse\"", CURVES_CYLINDER},
        {"MakeNamedMaterial \"h\" \"string type\" \"hair\" MakeNamedMaterial \"d\" \"string type\" \"diffuse\" "
         "Material \"mix\" \"string materials\" [\"d\" \"h\"]",
         CURVES_FLAT}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "%s Shape \"curve\" \"string type\" \"cylinder\" \"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 3]",
                 CASES[i].material);
        reading r = read_world(text);
        assert_int_equal(r.scene->shapes[r.scene->shape_count - 1].as.curves.type, CASES[i].type);
        reading_destroy(&r);
    }
}

/* ---- stand-ins ---- */

#define STANDS_IN(type, what) "material \"" type "\" is not supported: " what " stands in\n"
#define FOR_FLESH                                                                                                      \
    STANDS_IN("subsurface", "\"coateddiffuse\" of its diffuse reflectance, which lets no light travel inside,")

static void stand_ins_keep_what_they_can(void **state)
{
    (void)state;
    material m = warned_material(
        "Material \"subsurface\" \"rgb reflectance\" [ .1 .2 .3 ] \"rgb mfp\" [ 1 1 1 ] \"float roughness\" .04",
        FOR_FLESH);
    assert_int_equal(m.kind, MATERIAL_COATED_DIFFUSE);
    assert_rgb(m.reflectance, .1, .2, .3, 1e-7);
    assert_near(m.ior, 1.33, 1e-6);
    assert_near(m.alpha_u, .2, 1e-6);
    /* what scatters alone sends all back; what absorbs alone nothing */
    m = warned_material("Material \"subsurface\" \"rgb sigma_a\" [ 0 1 1 ] \"rgb sigma_s\" [ 1 0 1 ]", FOR_FLESH);
    assert_near(m.reflectance.r, 1, 1e-6);
    assert_near(m.reflectance.g, 0, 1e-6);
    assert_near(m.reflectance.b, .25 * (1 + exp(-4.0 / 3 * sqrt(1.5))) * exp(-sqrt(1.5)), 1e-6);
    /* a named stuff is as its coefficients say, whatever else is given */
    m = warned_material("Material \"subsurface\" \"rgb sigma_a\" [ .061 .97 1.45 ] \"rgb sigma_s\" [ .18 .07 .03 ]",
                        FOR_FLESH);
    const rgb ketchup = m.reflectance;
    assert_true(ketchup.r > 4 * ketchup.g);
    m = warned_material(
        "Material \"subsurface\" \"string name\" \"Ketchup\" \"float g\" .5 \"rgb reflectance\" [ .1 .2 .3 ]",
        FOR_FLESH);
    assert_rgb(m.reflectance, ketchup.r, ketchup.g, ketchup.b, 1e-6);
    m = warned_material("Material \"kdsubsurface\" \"rgb Kd\" [ .1 .2 .3 ]",
                        READ_AS("kdsubsurface", "subsurface") FOR_FLESH);
    assert_rgb(m.reflectance, .1, .2, .3, 1e-7);

    m = warned_material(FLOATS "Material \"measured\" \"string filename\" \"a.bsdf\" \"texture displacement\" \"f\"",
                        STANDS_IN("measured", "\"diffuse\" with a reflectance of 0.5"));
    assert_int_equal(m.kind, MATERIAL_DIFFUSE);
    assert_int_equal(m.displacement_texture, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(alpha_of_every_shape),
        cmocka_unit_test(displacement),
        TEST_IN_FOLDER(normal_maps),
        TEST_IN_FOLDER(slopes_are_as_fine_as_pictures),
        cmocka_unit_test(metals_from_textures),
        cmocka_unit_test(roughness_from_textures),
        cmocka_unit_test(transmission_is_scaled_in_textures),
        cmocka_unit_test(old_plastics),
        cmocka_unit_test(old_glass_and_metal),
        cmocka_unit_test(old_mixes),
        cmocka_unit_test(hair_is_colored_by_one_of_its_words),
        cmocka_unit_test(curves_of_hair_are_flat_to_rays),
        cmocka_unit_test(stand_ins_keep_what_they_can),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
