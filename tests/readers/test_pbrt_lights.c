/* test_pbrt_lights.c: lights, materials and the camera as the pbrt reader makes them, with pbrt's defaults.
 * Threads: one. */
#include "fixtures/pbrt_fixture.h"

#include "color/spectra.h"

static const double PI = 3.14159265358979323846;

static const light *only_light(const reading *r)
{
    assert_int_equal(r->scene->light_count, 1);
    return &r->scene->lights[0];
}

static void assert_refused(const char *text, const char *message)
{
    reading r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_ERROR_SCENE);
    assert_non_null(strstr(r.said[AG_LOG_ERROR], message));
    reading_destroy(&r);
}

static void point_lights(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin Translate 1 0 0 LightSource \"point\"");
    const light *l = only_light(&r);
    assert_int_equal(l->kind, LIGHT_POINT);
    assert_rgb(l->as.point.intensity, 1, 1, 1, 0);
    assert_vec3(l->as.point.position, 1, 0, 0, 0);
    reading_destroy(&r);
    r = reading_of(
        "WorldBegin Scale 2 2 2 LightSource \"point\" \"rgb I\" [ 1 2 3 ] \"float scale\" 2 \"point3 from\" [ 1 2 3 ]");
    l = only_light(&r);
    assert_rgb(l->as.point.intensity, 2, 4, 6, 0);
    assert_vec3(l->as.point.position, 2, 4, 6, 0);
    reading_destroy(&r);
    /* power replaces the magnitude that I of 1 would have, and is itself multiplied by I and scale */
    r = reading_of("WorldBegin LightSource \"point\" \"rgb I\" [ 1 .5 0 ] \"float power\" 100 \"float scale\" 2");
    assert_rgb(only_light(&r)->as.point.intensity, 200 / (4 * PI), 100 / (4 * PI), 0, 1e-5);
    reading_destroy(&r);
    r = reading_of("WorldBegin LightSource \"point\" \"rgb I\" [ 0 0 0 ]");
    assert_string_equal(r.said[AG_LOG_DEBUG], "t:1:12: debug: LightSource \"point\" has no power\n");
    assert_rgb(only_light(&r)->as.point.intensity, 0, 0, 0, 0);
    reading_destroy(&r);
}

static void spot_lights(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin Rotate 90 0 1 0 LightSource \"spot\"");
    const light *l = only_light(&r);
    assert_int_equal(l->kind, LIGHT_SPOT);
    assert_rgb(l->as.spot.intensity, 1, 1, 1, 0);
    assert_vec3(l->as.spot.direction, 1, 0, 0, 1e-6);
    assert_near(l->as.spot.falloff_end, 1 - cos(30 * PI / 180), 1e-7);
    assert_near(l->as.spot.falloff_start, 1 - cos(25 * PI / 180), 1e-7);
    reading_destroy(&r);
    r = reading_of(
        "WorldBegin LightSource \"spot\" \"point3 from\" [ 1 1 1 ] \"point3 to\" [ 1 -4 1 ] \"float coneangle\" 60\n"
        "\"float conedeltaangle\" 20 \"float power\" 10");
    l = only_light(&r);
    assert_vec3(l->as.point.position, 1, 1, 1, 0);
    assert_vec3(l->as.spot.direction, 0, -1, 0, 1e-6);
    double start = cos(40 * PI / 180), end = cos(60 * PI / 180), measure = 2 * PI * ((1 - start) + (start - end) / 2);
    assert_rgb(l->as.spot.intensity, 10 / measure, 10 / measure, 10 / measure, 1e-5);
    reading_destroy(&r);
    /* a cone narrower than the default penumbra: pbrt counts on beyond the axis */
    r = reading_of("WorldBegin LightSource \"spot\" \"float coneangle\" 3");
    assert_near(only_light(&r)->as.spot.falloff_start, 1 - cos(2 * PI / 180), 1e-9);
    assert_false(only_light(&r)->as.spot.dims_by_cosine);
    reading_destroy(&r);
    r = reading_of("WorldBegin LightSource \"spot\" \"bool cosine\" true");
    assert_true(only_light(&r)->as.spot.dims_by_cosine);
    reading_destroy(&r);
    assert_refused("WorldBegin LightSource \"spot\" \"bool cosine\" true \"float coneangle\" 91",
                   "t:1:31: error: a \"cosine\" goes with a \"coneangle\" of at most 90 degrees");
    assert_refused("WorldBegin LightSource \"spot\" \"float power\" 1 \"bool cosine\" true",
                   "a \"cosine\" goes with a \"coneangle\" of at most 90 degrees, and not with \"power\"");
}

static void distant_lights(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin LightSource \"distant\"");
    const light *l = only_light(&r);
    assert_int_equal(l->kind, LIGHT_DISTANT);
    assert_rgb(l->as.distant.irradiance, 1, 1, 1, 0);
    assert_vec3(l->as.distant.direction, 0, 0, 1, 0);
    reading_destroy(&r);
    r = reading_of(
        "WorldBegin Translate 5 5 5 Scale 3 3 3 LightSource \"distant\" \"rgb L\" [ 1 2 3 ] \"float scale\" 2\n"
        "\"point3 from\" [ 0 10 0 ] \"point3 to\" [ 0 0 0 ] \"float illuminance\" 50");
    l = only_light(&r);
    assert_rgb(l->as.distant.irradiance, 100, 200, 300, 0);
    assert_vec3(l->as.distant.direction, 0, -1, 0, 1e-6);
    assert_near(l->as.distant.disc_one_minus_cos, 0, 0);
    reading_destroy(&r);
    r = reading_of("WorldBegin LightSource \"distant\" \"float angle\" 10");
    assert_near(only_light(&r)->as.distant.disc_one_minus_cos, 1 - cos(5 * PI / 180), 1e-9);
    reading_destroy(&r);
    assert_refused("WorldBegin LightSource \"distant\" \"float angle\" 181",
                   "\"angle\" should be from 0 to 180 degrees");
}

static void area_lights(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin AreaLightSource \"diffuse\" Shape \"sphere\"");
    const light *l = only_light(&r);
    assert_int_equal(l->kind, LIGHT_AREA);
    assert_rgb(l->as.area.radiance, 1, 1, 1, 0);
    assert_false(l->as.area.two_sided);
    assert_int_equal(l->as.area.shape_index, 0);
    assert_int_equal(r.scene->shapes[0].light_index, 0);
    reading_destroy(&r);
    r = reading_of("WorldBegin AreaLightSource \"diffuse\" \"rgb L\" [ 17 12 4 ] \"float scale\" .5 \"bool twosided\" "
                   "[ \"true\" ]\n"
                   "Shape \"disk\"");
    l = only_light(&r);
    assert_rgb(l->as.area.radiance, 8.5, 6, 2, 0);
    assert_true(l->as.area.two_sided);
    reading_destroy(&r);
    /* a disk of radius 2 has 4 pi; two-sided lamps of radiance 1 have 2 pi times it */
    r = reading_of(
        "WorldBegin AreaLightSource \"diffuse\" \"rgb L\" [ 1 .5 0 ] \"float power\" 60 \"bool twosided\" true\n"
        "Shape \"disk\" \"float radius\" 2");
    assert_rgb(only_light(&r)->as.area.radiance, 60 / (8 * PI * PI), 30 / (8 * PI * PI), 0, 1e-5);
    reading_destroy(&r);
    r = reading_of("WorldBegin Scale 3 3 3 AreaLightSource \"diffuse\" \"float power\" 60 Shape \"sphere\"");
    assert_rgb(only_light(&r)->as.area.radiance, 60 / (36 * PI * PI), 60 / (36 * PI * PI), 60 / (36 * PI * PI), 1e-5);
    reading_destroy(&r);
    /* a second AreaLightSource replaces the first */
    r = reading_of(
        "WorldBegin AreaLightSource \"diffuse\" AreaLightSource \"diffuse\" \"rgb L\" [ 2 2 2 ] Shape \"disk\"");
    assert_rgb(only_light(&r)->as.area.radiance, 2, 2, 2, 0);
    reading_destroy(&r);
}

static void black_bodies(void **state)
{
    (void)state;
    reading r = reading_of("WorldBegin LightSource \"point\" \"blackbody I\" [ 4000 ] \"float scale\" 3");
    rgb expected = spectra_blackbody(4000, NULL), value = only_light(&r)->as.point.intensity;
    assert_rgb(value, 3 * expected.r, 3 * expected.g, 3 * expected.b, 1e-5);
    reading_destroy(&r);
}

static material only_material(const char *text)
{
    char whole[512];
    snprintf(whole, sizeof whole, "WorldBegin Material %s Shape \"sphere\"", text);
    reading r = reading_of(whole);
    material m = r.scene->materials[r.scene->shapes[0].material_index];
    reading_destroy(&r);
    return m;
}

static void diffuse_materials(void **state)
{
    (void)state;
    material m = only_material("\"diffuse\"");
    assert_int_equal(m.kind, MATERIAL_DIFFUSE);
    assert_rgb(m.reflectance, .5, .5, .5, 0);
    assert_rgb(only_material("\"diffuse\" \"rgb reflectance\" [ .1 .2 1 ]").reflectance, .1, .2, 1, 1e-7);
    const char *text = "WorldBegin Material \"diffuse\" \"rgb reflectance\" [ .1 1.2 1 ]";
    reading r = reading_create(NULL, text, strlen(text));
    assert_string_equal(r.said[AG_LOG_WARNING], "t:1:31: warning: \"reflectance\" is above 1: 1 is used\n");
    assert_rgb(r.scene->materials[1].reflectance, .1, 1, 1, 1e-7);
    reading_destroy(&r);
}

static void conductors(void **state)
{
    (void)state;
    material m = only_material("\"conductor\"");
    rgb eta, k;
    assert_true(spectra_find_named("metal-Cu-eta", NULL, &eta) && spectra_find_named("metal-Cu-k", NULL, &k));
    assert_int_equal(m.kind, MATERIAL_CONDUCTOR);
    assert_rgb(m.eta, eta.r, eta.g, eta.b, 0);
    assert_rgb(m.k, k.r, k.g, k.b, 0);
    assert_near(m.alpha_u, 0, 0);
    m = only_material(
        "\"conductor\" \"spectrum eta\" \"metal-Ag-eta\" \"spectrum k\" [ \"metal-Ag-k\" ] \"float roughness\" .25");
    assert_true(m.k.r > 4.0f && m.eta.r < 0.2f);
    assert_near(m.alpha_u, .5, 0);
    assert_near(m.alpha_v, .5, 0);
    m = only_material(
        "\"conductor\" \"rgb reflectance\" [ 0 .5 1 ] \"float uroughness\" .09 \"bool remaproughness\" false");
    assert_rgb(m.eta, 1, 1, 1, 0);
    assert_rgb(m.k, 0, 2, 2 * sqrt(.9999 / (1 - .9999)), .05);
    /* at normal incidence it reflects what was asked for */
    assert_near(((1.0 - m.eta.g) * (1.0 - m.eta.g) + m.k.g * m.k.g) /
                    ((1.0 + m.eta.g) * (1.0 + m.eta.g) + m.k.g * m.k.g),
                .5, 1e-6);
    assert_near(m.alpha_u, .09, 1e-8);
    assert_near(m.alpha_v, 0, 1e-4); /* the scene makes it the least that is rough */
}

static void dielectrics(void **state)
{
    (void)state;
    material m = only_material("\"dielectric\"");
    assert_int_equal(m.kind, MATERIAL_DIELECTRIC);
    assert_near(m.ior, 1.5, 0);
    assert_near(m.alpha_u, 0, 0);
    assert_near(only_material("\"dielectric\" \"float eta\" 1.33").ior, 1.33, 1e-6);
    assert_near(only_material("\"dielectric\" \"spectrum eta\" \"glass-BK7\"").ior, 1.5168, 1e-6);
    assert_near(only_material("\"dielectric\" \"spectrum eta\" \"glass-F11\"").ior, 1.7847, 1e-6);
    m = only_material("\"dielectric\" \"float roughness\" .04 \"float vroughness\" .16");
    assert_near(m.alpha_u, .2, 1e-6);
    assert_near(m.alpha_v, .4, 1e-6);
}

static void named_materials(void **state)
{
    (void)state;
    /* the last use comes before its making, as pbrt allows */
    reading r = reading_of(
        "WorldBegin MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [ .1 .1 .1 ]\n"
        "MakeNamedMaterial \"b\" \"string type\" [ \"dielectric\" ] \"float eta\" 2\n"
        "NamedMaterial \"a\" Shape \"sphere\" NamedMaterial \"b\" Shape \"sphere\" NamedMaterial \"a\" Shape \"disk\"\n"
        "NamedMaterial \"late\" Shape \"disk\" MakeNamedMaterial \"late\" \"string type\" \"conductor\"");
    const scene *s = r.scene;
    assert_int_equal(s->shapes[0].material_index, s->shapes[2].material_index);
    assert_rgb(s->materials[s->shapes[0].material_index].reflectance, .1, .1, .1, 1e-7);
    assert_near(s->materials[s->shapes[1].material_index].ior, 2, 0);
    assert_int_equal(s->materials[s->shapes[3].material_index].kind, MATERIAL_CONDUCTOR);
    reading_destroy(&r);
}

/* Warnings about a named material name its type, and speak once for all of that type. */
static void unknown_parameters_of_named_materials_are_told_once(void **state)
{
    (void)state;
    const char *text = "WorldBegin MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"float sigma\" 1\n"
                       "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" \"float sigma\" 1";
    reading r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_OK);
    assert_string_equal(r.said[AG_LOG_WARNING],
                        "t:1:58: warning: MakeNamedMaterial \"diffuse\": \"float sigma\" is not "
                        "known, or not supported yet, and is ignored\n");
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(point_lights),    cmocka_unit_test(spot_lights),
        cmocka_unit_test(distant_lights),  cmocka_unit_test(area_lights),
        cmocka_unit_test(black_bodies),    cmocka_unit_test(diffuse_materials),
        cmocka_unit_test(conductors),      cmocka_unit_test(dielectrics),
        cmocka_unit_test(named_materials), cmocka_unit_test(unknown_parameters_of_named_materials_are_told_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
