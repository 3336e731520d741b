/* test_pbrt_materials.c: materials of several parts as the pbrt reader makes them, with pbrt's defaults: coats, diffuse
 * transmission, panes, mixes and the names these use; and what is refused.
 * Threads: one. */
/* ctest: serial */
#include "color/spectra.h"
#include "fixtures/pbrt_fixture.h"
#include "material/material_point.h"
#include "rays/rays.h"
#include "scene.h"

static material only_material(const char *text)
{
    char whole[512];
    snprintf(whole, sizeof whole, "WorldBegin Material %s Shape \"sphere\"", text);
    reading r = reading_of(whole);
    material m = r.scene->materials[r.scene->shapes[0].material_index];
    reading_destroy(&r);
    return m;
}

static void assert_scaled(rgb value, rgb expected, double scale)
{
    assert_rgb(value, (double)expected.r * scale, (double)expected.g * scale, (double)expected.b * scale, 1e-6);
}

static void assert_roughness(float alpha_u, float alpha_v, double u, double v)
{
    assert_near(alpha_u, u, 1e-6);
    assert_near(alpha_v, v, 1e-6);
}

static void coated_diffuse_materials(void **state)
{
    (void)state;
    material m = only_material("\"coateddiffuse\"");
    assert_int_equal(m.kind, MATERIAL_COATED_DIFFUSE);
    assert_rgb(m.reflectance, .5, .5, .5, 0);
    assert_near(m.ior, 1.5, 0);
    assert_roughness(m.alpha_u, m.alpha_v, 0, 0);
    assert_near(m.coat_thickness, .01, 1e-9);
    assert_int_equal(m.coat_bounces, 5);
    assert_true(m.table != NULL && m.coat_g == 0.0f && rgb_is_black(m.coat_albedo));
    m = only_material("\"coateddiffuse\" \"rgb reflectance\" [ .1 .2 1 ] \"float eta\" 1.33 \"float roughness\" .04");
    assert_rgb(m.reflectance, .1, .2, 1, 1e-7);
    assert_near(m.ior, 1.33, 1e-6);
    assert_roughness(m.alpha_u, m.alpha_v, .2, .2);
    m = only_material(
        "\"coateddiffuse\" \"float uroughness\" .04 \"float vroughness\" .3 \"bool remaproughness\" false");
    assert_roughness(m.alpha_u, m.alpha_v, .04, .3);
    assert_near(only_material("\"coateddiffuse\" \"spectrum eta\" \"glass-BK7\"").ior, 1.5168, 1e-6);
    /* what pbrt's random walk is told is taken without a word */
    m = only_material("\"coateddiffuse\" \"float thickness\" .02 \"float g\" .3 \"integer maxdepth\" 20\n"
                      "\"integer nsamples\" 4 \"rgb albedo\" [ .1 .2 1 ]");
    assert_int_equal(m.kind, MATERIAL_COATED_DIFFUSE);
    assert_near(m.coat_thickness, .02, 1e-8);
    assert_near(m.coat_g, .3, 1e-7);
    assert_int_equal(m.coat_bounces, 10);
    assert_rgb(m.coat_albedo, .1, .2, 1, 1e-7);
}

/* A coat's values may be textures: one that is the same everywhere is its value, of the same bits as the number; of one
 * that varies the default stands in, which is told. */
static void coats_of_textures(void **state)
{
    (void)state;
    static const char TEXTURES[] =
        "WorldBegin Texture \"t\" \"float\" \"constant\" \"float value\" .3 Texture \"h\" \"float\" \"constant\" "
        "\"float value\" -.4\nTexture \"a\" \"spectrum\" \"constant\" \"rgb value\" [ .8 .5 .2 ]\n"
        "Texture \"board\" \"float\" \"checkerboard\" Texture \"c\" \"spectrum\" \"checkerboard\" Texture \"no\" "
        "\"float\" \"constant\" \"float value\" -1\n";
    static const char *const KINDS[] = {"coateddiffuse", "coatedconductor"};
    char text[1024];
    for (int i = 0; i < 2; i++) {
        snprintf(text, sizeof text,
                 "%s Material \"%s\" \"texture thickness\" \"t\" \"texture g\" \"h\" \"texture albedo\" \"a\" Shape "
                 "\"sphere\" Material \"%s\" \"float thickness\" .3 \"float g\" -.4 \"rgb albedo\" [ .8 .5 .2 ] Shape "
                 "\"sphere\" Material \"%s\" Shape \"sphere\"",
                 TEXTURES, KINDS[i], KINDS[i], KINDS[i]);
        reading r = reading_of(text);
        const material *m[3];
        for (int k = 0; k < 3; k++)
            m[k] = &r.scene->materials[r.scene->shapes[k].material_index];
        assert_true(m[0]->coat_thickness == .3f && m[0]->coat_g == -.4f);
        assert_memory_equal(&m[0]->coat_albedo, &m[1]->coat_albedo, sizeof(rgb));
        assert_true(m[0]->table && m[0]->table == m[1]->table); /* that of the same coat */
        assert_true(m[0]->table != m[2]->table);
        reading_destroy(&r);

        snprintf(text, sizeof text,
                 "%s Material \"%s\" \"texture thickness\" \"board\" \"texture g\" \"board\" \"texture albedo\" \"c\" "
                 "Shape \"sphere\"",
                 TEXTURES, KINDS[i]);
        r = reading_create(NULL, text, strlen(text));
        assert_int_equal(r.status, AG_OK);
        assert_int_equal(r.count[AG_LOG_WARNING], 3);
        static const char *const WORDS[] = {"a coat: a texture for \"thickness\" that varies is not supported: 0.01 ",
                                            "\"g\" that varies is not supported: 0 stands in",
                                            "\"albedo\" that varies is not supported: black stands in"};
        for (int k = 0; k < 3; k++)
            assert_non_null(strstr(r.said[AG_LOG_WARNING], WORDS[k]));
        const material *of_board = &r.scene->materials[r.scene->shapes[0].material_index];
        assert_true(of_board->coat_thickness == .01f && of_board->coat_g == 0 && rgb_is_black(of_board->coat_albedo));
        reading_destroy(&r);

        static const char *const WRONG[][2] = {
            {"\"texture thickness\" \"no\"", "\"thickness\" should not be negative"},
            {"\"texture g\" \"no\"", "\"g\" should be between -1 and 1"},
            {"\"texture g\" \"a\"", "\"a\" is a spectrum texture, but \"g\" takes a float texture"},
            {"\"texture albedo\" \"nobody\"", "no spectrum texture is named \"nobody\""}};
        for (size_t k = 0; k < sizeof WRONG / sizeof *WRONG; k++) {
            snprintf(text, sizeof text, "%sMaterial \"%s\" %s", TEXTURES, KINDS[i], WRONG[k][0]);
            r = reading_create(NULL, text, strlen(text));
            assert_int_equal(r.status, AG_ERROR_SCENE);
            assert_non_null(strstr(r.said[AG_LOG_ERROR], WRONG[k][1]));
            assert_non_null(strstr(r.said[AG_LOG_ERROR], "t:4:"));
            reading_destroy(&r);
        }
    }
}

static void coated_conductors(void **state)
{
    (void)state;
    /* the metal's index is relative to the coat */
    material m = only_material("\"coatedconductor\"");
    assert_int_equal(m.kind, MATERIAL_COATED_CONDUCTOR);
    assert_near(m.ior, 1.5, 0);
    assert_scaled(m.eta, spectrum("metal-Cu-eta"), 1.0 / 1.5);
    assert_scaled(m.k, spectrum("metal-Cu-k"), 1.0 / 1.5);
    assert_roughness(m.alpha_u, m.alpha_v, 0, 0);
    assert_roughness(m.base_alpha_u, m.base_alpha_v, 0, 0);
    m = only_material("\"coatedconductor\" \"spectrum conductor.eta\" \"metal-Ag-eta\" \"spectrum conductor.k\" "
                      "\"metal-Ag-k\"\n\"float interface.eta\" 2 \"float interface.roughness\" .04\n"
                      "\"float conductor.uroughness\" .09 \"float conductor.vroughness\" .16");
    assert_near(m.ior, 2, 0);
    assert_scaled(m.eta, spectrum("metal-Ag-eta"), .5);
    assert_scaled(m.k, spectrum("metal-Ag-k"), .5);
    assert_roughness(m.alpha_u, m.alpha_v, .2, .2);
    assert_roughness(m.base_alpha_u, m.base_alpha_v, .3, .4);
    /* one remaproughness for both; roughness along one axis alone is made the least on the other */
    m = only_material("\"coatedconductor\" \"float interface.vroughness\" .09 \"float conductor.roughness\" .3 \"bool "
                      "remaproughness\" false");
    assert_near(m.alpha_u, 0, 1e-4);
    assert_true(m.alpha_u > 0.0f);
    assert_near(m.alpha_v, .09, 1e-8);
    assert_roughness(m.base_alpha_u, m.base_alpha_v, .3, .3);
    m = only_material("\"coatedconductor\" \"float conductor.uroughness\" .25");
    assert_near(m.base_alpha_u, .5, 0);
    assert_true(m.base_alpha_v > 0.0f && m.base_alpha_v <= 1e-4f);
    m = only_material("\"coatedconductor\" \"rgb reflectance\" [ 0 .5 .9 ]");
    assert_rgb(m.eta, 1 / 1.5, 1 / 1.5, 1 / 1.5, 1e-6);
    assert_rgb(m.k, 0, 2 / 1.5, 2 * sqrt(9.0) / 1.5, 1e-5);
    m = only_material("\"coatedconductor\" \"float thickness\" .02 \"float g\" 0 \"integer maxdepth\" 2\n"
                      "\"integer nsamples\" 4 \"rgb albedo\" [ 0 0 0 ]");
    assert_int_equal(m.kind, MATERIAL_COATED_CONDUCTOR);
}

static void diffuse_transmission_materials(void **state)
{
    (void)state;
    material m = only_material("\"diffusetransmission\"");
    assert_int_equal(m.kind, MATERIAL_DIFFUSE_TRANSMISSION);
    assert_rgb(m.reflectance, .25, .25, .25, 0);
    assert_rgb(m.transmittance, .25, .25, .25, 0);
    m = only_material("\"diffusetransmission\" \"rgb reflectance\" [ .1 .2 .3 ] \"rgb transmittance\" [ .4 .6 .2 ]");
    assert_rgb(m.reflectance, .1, .2, .3, 1e-7);
    assert_rgb(m.transmittance, .4, .6, .2, 1e-7);
    m = only_material("\"diffusetransmission\" \"rgb transmittance\" [ .4 .6 .2 ] \"float scale\" .5");
    assert_rgb(m.reflectance, .125, .125, .125, 1e-7);
    assert_rgb(m.transmittance, .2, .3, .1, 1e-7);
    assert_rgb(only_material("\"diffusetransmission\" \"float scale\" 0").transmittance, 0, 0, 0, 0);
    /* in green they are 1.6 together */
    const char *text = "WorldBegin Material \"diffusetransmission\" \"rgb reflectance\" [ .2 .8 0 ] \"rgb "
                       "transmittance\" [ .2 .8 .4 ]";
    reading r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_OK);
    assert_string_equal(r.said[AG_LOG_WARNING], "t:1:12: warning: \"reflectance\" and \"transmittance\" are above 1 "
                                                "together: both are scaled down\n");
    m = r.scene->materials[r.scene->material_count - 1];
    assert_rgb(m.reflectance, .125, .5, 0, 1e-6);
    assert_rgb(m.transmittance, .125, .5, .25, 1e-6);
    reading_destroy(&r);
}

static void thin_dielectrics(void **state)
{
    (void)state;
    material m = only_material("\"thindielectric\"");
    assert_int_equal(m.kind, MATERIAL_THIN_DIELECTRIC);
    assert_near(m.ior, 1.5, 0);
    assert_near(only_material("\"thindielectric\" \"float eta\" 1.33").ior, 1.33, 1e-6);
    assert_near(only_material("\"thindielectric\" \"spectrum eta\" \"glass-F11\"").ior, 1.7847, 1e-6);
}

/* --- mixes --- */

#define MAKE(name, reflectance)                                                                                        \
    "MakeNamedMaterial \"" name "\" \"string type\" \"diffuse\" \"rgb reflectance\" [ " reflectance " 0 0 ]\n"
#define MIX(name, first, second)                                                                                       \
    "MakeNamedMaterial \"" name "\" \"string type\" \"mix\" \"string materials\" [ \"" first "\" \"" second "\" ]\n"

static const material *shape_material(const reading *r, uint32_t shape_index)
{
    return &r->scene->materials[r->scene->shapes[shape_index].material_index];
}

/* The two of a mix, by the red of their reflectance. */
static void assert_mixed(const reading *r, const material *m, double first, double second)
{
    assert_int_equal(m->kind, MATERIAL_MIX);
    assert_true(m->mixed[0] < r->scene->material_count && m->mixed[1] < r->scene->material_count);
    assert_near(r->scene->materials[m->mixed[0]].reflectance.r, first, 1e-7);
    assert_near(r->scene->materials[m->mixed[1]].reflectance.r, second, 1e-7);
}

static void mixes_are_of_named_materials(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin\n" MAKE("a", ".1") MAKE("b", ".2") MIX(
        "m", "a", "b") "NamedMaterial \"m\" Shape \"sphere\"\n"
                       "Material \"mix\" \"float amount\" .3 \"string materials\" [ \"b\" \"a\" ] Shape \"sphere\"\n"
                       "Material \"mix\" \"string materials\" [ \"m\" \"m\" ] Shape \"sphere\"");
    assert_mixed(&r, shape_material(&r, 0), .1, .2);
    assert_near(shape_material(&r, 0)->mix_amount, .5, 0);
    assert_mixed(&r, shape_material(&r, 1), .2, .1);
    assert_near(shape_material(&r, 1)->mix_amount, .3, 1e-7);
    const material *nested = shape_material(&r, 2);
    assert_int_equal(nested->mixed[0], nested->mixed[1]);
    assert_mixed(&r, &r.scene->materials[nested->mixed[0]], .1, .2);
    reading_destroy(&r);
}

/* Used before they are made: parts of a mix, the mix itself, a part of a mix that is itself a mix. */
static void mixes_may_look_forward(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin NamedMaterial \"m\" Shape \"sphere\"\n"
                           "Material \"mix\" \"string materials\" [ \"a\" \"m\" ] Shape \"sphere\"\n" MIX("m", "a", "b")
                               MAKE("b", ".2") MAKE("a", ".1") "NamedMaterial \"m\" Shape \"sphere\"");
    assert_mixed(&r, shape_material(&r, 0), .1, .2);
    assert_mixed(&r, shape_material(&r, 2), .1, .2);
    const material *outer = shape_material(&r, 1);
    assert_near(r.scene->materials[outer->mixed[0]].reflectance.r, .1, 1e-7);
    assert_mixed(&r, &r.scene->materials[outer->mixed[1]], .1, .2);
    reading_destroy(&r);
}

/* A mix that is made after its use, and brings new names: the table of names grows meanwhile. */
static void names_grow_while_a_mix_is_made(void **state)
{
    (void)state;
    for (int before = 0; before < 40; before++) {
        char text[8192] = "WorldBegin NamedMaterial \"m\" Shape \"sphere\"\n";
        size_t used = strlen(text);
        for (int i = 0; i < before; i++)
            used += (size_t)sprintf(text + used, "MakeNamedMaterial \"n%d\" \"string type\" \"diffuse\"\n", i);
        sprintf(text + used, "%s", MIX("m", "a", "b") MAKE("a", ".1") MAKE("b", ".2"));
        reading r = reading_of(text);
        assert_mixed(&r, shape_material(&r, 0), .1, .2);
        reading_destroy(&r);
    }
}

static const char CIRCLE[] = "mixes itself by way of others, or mixes are more than 16 deep\n";

/* The location is that of a mix that is named. */
static void expect_circle(const reading *r, const char *where)
{
    assert_non_null(strstr(r->said[AG_LOG_ERROR], CIRCLE));
    if (strncmp(r->said[AG_LOG_ERROR], where, strlen(where)) != 0)
        fail_msg("%s is not at %s", r->said[AG_LOG_ERROR], where);
}

static void circles_of_mixes_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *where;
    } CASES[] = {
        {"WorldBegin\n" MIX("a", "a", "a"), "t:2:1: error: the mix \"a\""},
        {"WorldBegin\n" MAKE("x", ".1") MIX("a", "x", "a"), "t:3:1: error: the mix \"a\""},
        {"WorldBegin\n" MAKE("x", ".1") "NamedMaterial \"a\"\n" MIX("a", "x", "a"), "t:4:1: error: the mix \"a\""},
        {"WorldBegin\n" MAKE("x", ".1") MIX("a", "b", "x") MIX("b", "x", "a"), "t:3:1: error: the mix \"a\""},
        {"WorldBegin\n" MIX("a", "x", "b") MIX("b", "c", "x") MIX("c", "x", "a") MAKE("x", ".1"),
         "t:2:1: error: the mix \"a\""},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        reading r = reading_create(NULL, CASES[i].text, strlen(CASES[i].text));
        assert_int_equal(r.status, AG_ERROR_SCENE);
        assert_int_equal(r.count[AG_LOG_ERROR], 1);
        expect_circle(&r, CASES[i].where);
        reading_destroy(&r);
    }
}

/* Mixes of mixes, of the material that was made just before: 16 of them, and one more. */
static void deep_mixes_are_refused(void **state)
{
    (void)state;
    for (int depth = 1; depth <= 17; depth++) {
        char text[4096] = "WorldBegin\n" MAKE("m0", ".1");
        size_t used = strlen(text);
        for (int i = 1; i <= depth; i++)
            used += (size_t)sprintf(text + used,
                                    "MakeNamedMaterial \"m%d\" \"string type\" \"mix\" \"string materials\" [ \"m%d\" "
                                    "\"m0\" ]\n",
                                    i, i - 1);
        reading r = reading_create(NULL, text, used);
        assert_int_equal(r.status, depth <= 16 ? AG_OK : AG_ERROR_SCENE);
        if (depth > 16)
            expect_circle(&r, "t:18:1: error: the mix \"m16\"");
        else
            assert_int_equal(r.count[AG_LOG_WARNING], 0);
        reading_destroy(&r);
    }
}

/* --- what is refused, or warned of --- */

static void errors_name_location_and_reason(void **state)
{
    (void)state;
    static const struct {
        const char *text, *location, *message;
    } CASES[] = {
        {"\"coateddiffuse\" \"rgb reflectance\" [ -1 0 0 ]", "1:37",
         "\"rgb reflectance\" has a negative component, -1"},
        {"\"coateddiffuse\" \"float eta\" 0", "1:37", "\"eta\" should be above 0"},
        {"\"coateddiffuse\" \"float eta\" -1.5", "1:37", "\"eta\" should be above 0"},
        {"\"coateddiffuse\" \"float roughness\" -1", "1:37", "\"roughness\" should not be negative"},
        {"\"coateddiffuse\" \"float uroughness\" -1", "1:37", "\"uroughness\" should not be negative"},
        {"\"coateddiffuse\" \"string thickness\" \"a\"", "1:37", "\"string thickness\" should be \"float thickness\""},
        {"\"principled\" \"float metallic\" 1.5", "1:34", "\"metallic\" should be from 0 to 1"},
        {"\"principled\" \"float clearcoat_roughness\" -.5", "1:34", "\"clearcoat_roughness\" should be from 0 to 1"},
        {"\"principled\" \"rgb sheen\" [ .5 2 0 ]", "1:34", "\"sheen\" of this model should be from 0 to 1"},
        {"\"principled\" \"rgb sheen\" [ 12 0 0 ] \"string sheen_model\" \"schlick\"", "1:34",
         "\"sheen\" of this model should be from 0 to 11.3"},
        {"\"principled\" \"string sheen_model\" \"wool\"", "1:34",
         "\"sheen_model\" should be \"charlie\", \"schlick\" or \"velvet\", not \"wool\""},
        {"\"principled\" \"float uroughness\" 2", "1:34", "\"uroughness\" should be from 0 to 1"},
        {"\"principled\" \"float vroughness\" -1", "1:34", "\"vroughness\" should be from 0 to 1"},
        {"\"principled\" \"float ior\" .5", "1:34", "\"ior\" should be at least 1, or 0 for an infinite one"},
        {"\"coateddiffuse\" \"float g\" 1", "1:37", "\"g\" should be between -1 and 1"},
        {"\"coateddiffuse\" \"rgb albedo\" [ -1 0 0 ]", "1:37", "\"rgb albedo\" has a negative component, -1"},
        {"\"coateddiffuse\" \"float maxdepth\" 3", "1:37", "\"float maxdepth\" should be \"integer maxdepth\""},
        {"\"coateddiffuse\" \"integer remaproughness\" 1", "1:37",
         "\"integer remaproughness\" should be \"bool remaproughness\""},
        {"\"coateddiffuse\" \"float roughness\" [ .1 .2 ]", "1:37",
         "\"float roughness\" should have 1 value, but has 2"},
        {"\"coatedconductor\" \"float interface.eta\" 0", "1:39", "\"interface.eta\" should be above 0"},
        {"\"coatedconductor\" \"float interface.roughness\" -1", "1:39",
         "\"interface.roughness\" should not be negative"},
        {"\"coatedconductor\" \"float conductor.vroughness\" -1", "1:39",
         "\"conductor.vroughness\" should not be negative"},
        {"\"coatedconductor\" \"rgb conductor.eta\" [ 0 1 1 ]", "1:39", "\"conductor.eta\" should be above 0"},
        {"\"coatedconductor\" \"rgb conductor.k\" [ 1 -1 1 ]", "1:39",
         "\"rgb conductor.k\" has a negative component, -1"},
        {"\"coatedconductor\" \"rgb reflectance\" [ 1 1 1 ] \"rgb conductor.k\" [ 1 1 1 ]", "1:39",
         "\"reflectance\" and \"conductor.eta\" or \"conductor.k\" cannot both be given to a conductor"},
        {"\"coatedconductor\" \"integer conductor.roughness\" 1", "1:39",
         "\"integer conductor.roughness\" should be \"float conductor.roughness\""},
        {"\"diffusetransmission\" \"rgb transmittance\" [ 0 0 -1 ]", "1:43",
         "\"rgb transmittance\" has a negative component, -1"},
        {"\"diffusetransmission\" \"float scale\" -1", "1:43", "\"scale\" should not be negative"},
        {"\"diffusetransmission\" \"rgb scale\" [ 1 1 1 ]", "1:43", "\"rgb scale\" should be \"float scale\""},
        {"\"thindielectric\" \"float eta\" 0", "1:38", "\"eta\" should be above 0"},
        {"\"thindielectric\" \"string eta\" \"a\"", "1:38", "\"string eta\" should be \"float eta\""},
        {"\"mix\"", "1:12", "\"mix\" needs \"string materials\" with two names"},
        {"\"mix\" \"string materials\" \"a\"", "1:27", "\"mix\" needs \"string materials\" with two names"},
        {"\"mix\" \"string materials\" [ ]", "1:27", "\"mix\" needs \"string materials\" with two names"},
        {"\"mix\" \"string materials\" [ \"a\" \"b\" \"c\" ]", "1:27",
         "\"mix\" needs \"string materials\" with two names"},
        {"\"mix\" \"float materials\" [ 1 2 ]", "1:27", "\"mix\" needs \"string materials\" with two names"},
        {"\"mix\" \"integer amount\" 1 \"string materials\" [ \"a\" \"b\" ]", "1:27",
         "\"integer amount\" should be \"float amount\""},
        {"\"mix\" \"string materials\" [ \"a\" \"b\" ]", "1:27", "no material is named \"a\""},
        {"\"mix\" \"string materials\" [ \"a\" \"b\" ]\n MakeNamedMaterial \"a\" \"string type\" \"diffuse\"", "1:27",
         "no material is named \"b\""},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[512], expected[256];
        int length = snprintf(text, sizeof text, "WorldBegin Material %s", CASES[i].text);
        snprintf(expected, sizeof expected, "t:%s: error: %s\n", CASES[i].location, CASES[i].message);
        reading r = reading_create(NULL, text, (size_t)length);
        if (r.status != AG_ERROR_SCENE || r.count[AG_LOG_ERROR] != 1 ||
            strncmp(r.said[AG_LOG_ERROR], expected, strlen(expected)) != 0)
            fail_msg("%s\n    should say: %s    but says: %s", text, expected,
                     r.said[AG_LOG_ERROR] ? r.said[AG_LOG_ERROR] : "nothing\n");
        reading_destroy(&r);
    }
}

static void warnings_are_given_once(void **state)
{
    (void)state;
    static const struct {
        const char *text, *warning;
    } CASES[] = {
        {"Material \"coateddiffuse\" \"rgb albedo\" [ .1 .2 1.3 ]",
         "t:2:26: warning: \"albedo\" is above 1: 1 is used\n"},
        {"Material \"coatedconductor\" \"rgb albedo\" [ .1 .2 1.3 ]",
         "t:2:28: warning: \"albedo\" is above 1: 1 is used\n"},
        {"Material \"coateddiffuse\" \"float conductor.roughness\" .5",
         "t:2:26: warning: Material \"coateddiffuse\": \"float conductor.roughness\" is not known, or not supported "
         "yet, and is ignored\n"},
        {"Material \"coatedconductor\" \"float roughness\" .5",
         "t:2:28: warning: Material \"coatedconductor\": \"float roughness\" is not known, or not supported yet, and "
         "is ignored\n"},
        {"Material \"thindielectric\" \"float roughness\" .5",
         "t:2:27: warning: Material \"thindielectric\": \"float roughness\" is not known, or not supported yet, and "
         "is ignored\n"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[512];
        int length = snprintf(text, sizeof text, "WorldBegin\n%s\n%s\n", CASES[i].text, CASES[i].text);
        reading r = reading_create(NULL, text, (size_t)length);
        assert_int_equal(r.status, AG_OK);
        assert_string_equal(r.said[AG_LOG_WARNING], CASES[i].warning);
        reading_destroy(&r);
    }
    /* each value above 1 is its own fault */
    const char *text = "WorldBegin Material \"coateddiffuse\" \"rgb reflectance\" [ .1 1.2 1 ]";
    reading r = reading_create(NULL, text, strlen(text));
    assert_string_equal(r.said[AG_LOG_WARNING], "t:1:37: warning: \"reflectance\" is above 1: 1 is used\n");
    assert_rgb(r.scene->materials[1].reflectance, .1, 1, 1, 1e-7);
    reading_destroy(&r);
}

static void principled_materials(void **state)
{
    (void)state;
    material m = only_material("\"principled\"");
    assert_int_equal(m.kind, MATERIAL_PRINCIPLED);
    assert_rgb(m.reflectance, 1, 1, 1, 0);
    assert_rgb(m.specular_color, 1, 1, 1, 0);
    assert_true(m.metallic == 1.0f && m.roughness == 1.0f && m.transmission == 0.0f && m.specular == 1.0f);
    assert_true(m.clearcoat == 0.0f && m.clearcoat_roughness == 0.0f && m.ior == 1.5f && m.is_thin && !m.is_textured);
    assert_roughness(m.alpha_u, m.alpha_v, 1, 1);
    assert_rgb(m.dielectric_f0, .04, .04, .04, 1e-6);
    m = only_material("\"principled\" \"rgb reflectance\" [ .1 .2 1 ] \"float metallic\" .25 \"float roughness\" .5\n"
                      "\"float transmission\" .75 \"float ior\" 1.8 \"float specular\" .5 \"bool is_thin\" false\n"
                      "\"rgb specular_color\" [ 1 2 30 ] \"float clearcoat\" .3 \"float clearcoat_roughness\" .4");
    assert_rgb(m.reflectance, .1, .2, 1, 1e-7);
    assert_rgb(m.specular_color, 1, 2, 30, 1e-6);
    assert_true(m.metallic == 0.25f && m.transmission == 0.75f && m.specular == 0.5f && !m.is_thin);
    assert_true(m.clearcoat == 0.3f && m.clearcoat_roughness == 0.4f && m.ior == 1.8f);
    assert_roughness(m.alpha_u, m.alpha_v, .25, .25);
    const double f0 = .8 * .8 / (2.8 * 2.8);
    assert_rgb(m.dielectric_f0, .5 * f0, f0, .5, 1e-6);
}

/* The bound is that of the file's numbers: in narrower primaries a colour may have a larger component. */
static void a_sheen_in_another_colour_space(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin ColorSpace \"rec2020\" Material \"principled\" \"rgb sheen\" [ 9 11.3 11.3 ]\n"
                           "\"string sheen_model\" \"schlick\" Shape \"sphere\"");
    const rgb sheen = r.scene->materials[r.scene->shapes[0].material_index].sheen;
    const double most = (double)sheen_factor_max(SHEEN_SCHLICK);
    assert_rgb(sheen, 1.660491 * 9 - 0.587641 * 11.3 - 0.072850 * 11.3, most, most, 2e-3);
    reading_destroy(&r);
    const char *text = "WorldBegin ColorSpace \"rec2020\" Material \"principled\" \"rgb sheen\" [ 0.5 0.5 1.1 ]";
    r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_ERROR_SCENE);
    assert_non_null(strstr(r.said[AG_LOG_ERROR], "\"sheen\" of this model should be from 0 to 1"));
    reading_destroy(&r);
}

static void cloth_and_brushed_metal(void **state)
{
    (void)state;
    material m = only_material("\"principled\"");
    assert_rgb(m.sheen, 0, 0, 0, 0);
    assert_true(m.sheen_model == SHEEN_CHARLIE && m.sheen_roughness == 0.0f && m.anisotropy == 0.0f);
    assert_true(m.grain_turn == 0.0f && m.grain_texture == SCENE_NO_TEXTURE);
    m = only_material("\"principled\" \"rgb sheen\" [ .1 .2 .9 ] \"float sheen_roughness\" .4 \"float anisotropy\" .5\n"
                      "\"float roughness\" .6 \"float grain_rotation\" -30");
    assert_rgb(m.sheen, .1, .2, .9, 1e-7);
    assert_true(m.sheen_roughness == 0.4f && m.anisotropy == 0.5f);
    assert_roughness(m.alpha_u, m.alpha_v, .36 + .64 * .25, .36);
    assert_near(m.grain_turn, -30.0 / 360.0, 1e-7);
    m = only_material("\"principled\" \"rgb sheen\" [ 3 0 11 ] \"string sheen_model\" \"schlick\"\n"
                      "\"float uroughness\" .2 \"float vroughness\" .9");
    assert_rgb(m.sheen, 3, 0, 11, 1e-6);
    assert_int_equal(m.sheen_model, SHEEN_SCHLICK);
    assert_roughness(m.alpha_u, m.alpha_v, .04, .81);
    m = only_material(
        "\"principled\" \"string sheen_model\" \"velvet\" \"float roughness\" .5 \"float uroughness\" .2");
    assert_int_equal(m.sheen_model, SHEEN_VELVET);
    assert_roughness(m.alpha_u, m.alpha_v, .04, .25);
    m = only_material("\"principled\" \"float roughness\" .5 \"float vroughness\" .2");
    assert_roughness(m.alpha_u, m.alpha_v, .25, .04);
    m = only_material("\"conductor\" \"float uroughness\" .4 \"float vroughness\" .1 \"float grain_rotation\" 450");
    assert_near(m.grain_turn, 0.25, 1e-7);
}

/* Each replaces its own: a texture along u leaves what is said for both to v. */
static void textures_of_cloth_and_brushed_metal(void **state)
{
    (void)state;
    reading r = reading_of(
        "WorldBegin\n"
        "Texture \"f\" \"float\" \"bilerp\" \"float v00\" .5 \"float v01\" .5 \"float v10\" .5 \"float v11\" .5\n"
        "Texture \"g\" \"float\" \"bilerp\" \"float v00\" .7 \"float v01\" .7 \"float v10\" .7 \"float v11\" .7\n"
        "Texture \"c\" \"spectrum\" \"bilerp\" \"rgb v00\" [ .1 .2 .3 ] \"rgb v01\" [ .1 .2 .3 ]\n"
        "\"rgb v10\" [ .1 .2 .3 ] \"rgb v11\" [ .1 .2 .3 ]\n"
        "Material \"principled\" \"texture sheen\" \"c\" \"texture sheen_roughness\" \"f\" \"texture uroughness\" \"g\"\n"
        "\"texture roughness\" \"f\" \"texture anisotropy\" \"f\" Shape \"sphere\"\n"
        "Material \"principled\" \"texture vroughness\" \"g\" \"float roughness\" .2 Shape \"sphere\"");
    material_point point;
    const principled_point *m = &point.principled;
    surface_hit hit = {.uv = {0.5f, 0.5f}};
    material_at(r.scene, &hit, &point);
    assert_rgb(m->sheen, .1, .2, .3, 1e-6);
    assert_near(m->sheen_roughness, .5, 0);
    assert_roughness(m->facets.alpha_u, m->facets.alpha_v, .49 + .51 * .25, .25);
    assert_true(material_point_has_grain(&point));
    hit.shape_index = 1;
    material_at(r.scene, &hit, &point);
    assert_roughness(m->facets.alpha_u, m->facets.alpha_v, .04, .49);
    reading_destroy(&r);
}

/* Factors that are textured start at 1; at a point they are what the texture says, and what follows from that. */
static void principled_textures(void **state)
{
    (void)state;
    reading r = reading_of(
        "WorldBegin\n"
        "Texture \"f\" \"float\" \"bilerp\" \"float v00\" .5 \"float v01\" .5 \"float v10\" .5 \"float v11\" .5\n"
        "Texture \"c\" \"spectrum\" \"bilerp\" \"rgb v00\" [ .1 .2 .3 ] \"rgb v01\" [ .1 .2 .3 ]\n"
        "\"rgb v10\" [ .1 .2 .3 ] \"rgb v11\" [ .1 .2 .3 ]\n"
        "Material \"principled\" \"texture reflectance\" \"c\" \"texture specular_color\" \"c\"\n"
        "\"texture metallic\" \"f\" \"texture roughness\" \"f\" \"texture transmission\" \"f\"\n"
        "\"texture specular\" \"f\" \"texture clearcoat\" \"f\" \"texture clearcoat_roughness\" \"f\"\n"
        "Shape \"sphere\"");
    scene *s = r.scene;
    material *given = &s->materials[s->shapes[0].material_index];
    material_point point;
    const principled_point *m = &point.principled;
    surface_hit hit = {.uv = {0.5f, 0.5f}};
    assert_true(given->is_textured && given->metallic == 1.0f && given->clearcoat == 1.0f);
    assert_ptr_equal(material_at(s, &hit, &point), given);
    assert_int_equal(point.kind, MATERIAL_PRINCIPLED);
    assert_rgb(m->reflectance, .1, .2, .3, 1e-6);
    assert_rgb(m->dielectric_f0, .5 * .04 * .1, .5 * .04 * .2, .5 * .04 * .3, 1e-7);
    assert_true(m->metallic == 0.5f && m->transmission == 0.5f && m->specular == 0.5f);
    assert_true(m->clearcoat == 0.5f && m->clearcoat_roughness == 0.5f && m->facets.alpha_u == 0.25f &&
                m->facets.alpha_v == 0.25f);
    /* they multiply what is given for the whole */
    given->metallic = 0.5f, given->roughness = 0.8f, given->reflectance = rgb_gray(0.5f);
    material_at(s, &hit, &point);
    assert_true(m->metallic == 0.25f);
    assert_near(m->facets.alpha_u, .4 * .4, 1e-6);
    assert_rgb(m->reflectance, .05, .1, .15, 1e-6);
    assert_true(m->base_through > 0.5f && m->base_through < 1.0f);
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coated_diffuse_materials),
        cmocka_unit_test(coated_conductors),
        cmocka_unit_test(coats_of_textures),
        cmocka_unit_test(diffuse_transmission_materials),
        cmocka_unit_test(thin_dielectrics),
        cmocka_unit_test(mixes_are_of_named_materials),
        cmocka_unit_test(mixes_may_look_forward),
        cmocka_unit_test(names_grow_while_a_mix_is_made),
        cmocka_unit_test(circles_of_mixes_are_refused),
        cmocka_unit_test(deep_mixes_are_refused),
        cmocka_unit_test(errors_name_location_and_reason),
        cmocka_unit_test(warnings_are_given_once),
        cmocka_unit_test(principled_materials),
        cmocka_unit_test(principled_textures),
        cmocka_unit_test(cloth_and_brushed_metal),
        cmocka_unit_test(a_sheen_in_another_colour_space),
        cmocka_unit_test(textures_of_cloth_and_brushed_metal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
