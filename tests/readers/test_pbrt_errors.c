/* test_pbrt_errors.c: every error of the pbrt reader by its message and location, every warning once. Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "fixtures/pbrt_fixture.h"

static void errors_name_location_and_reason(void **state)
{
    (void)state;
    static const struct {
        const char *text, *location, *message;
    } CASES[] = {
        {"Translate 1 2 3", "1:16", "the file ends without WorldBegin"},
        {"WorldBegin Shape \"sphere", "1:18", "unterminated string"},
        {"WorldBegin Shape \"sphere\n\"", "1:18", "unterminated string"},
        {"WorldBegin \"a\\q\"", "1:14", "unknown escape in a string"},
        {"Bogus 1 2", "1:1", "unknown directive Bogus"},
        {"WorldBegin 12 3", "1:12", "a directive should stand here, not 12"},
        {"WorldBegin \"sphere\"", "1:12", "a directive should stand here, not \"sphere\""},
        {"WorldBegin ]", "1:12", "a directive should stand here, not ]"},
        {"WorldBegin Translate 1 2", "1:25", "Translate expects 3 numbers, but the file ends"},
        {"WorldBegin Translate 1 2 x", "1:26", "Translate expects 3 numbers, not x"},
        {"WorldBegin Translate 1 2 1e999", "1:26", "the number is too large"},
        {"WorldBegin Translate 1 2 \"3\"", "1:26", "Translate expects 3 numbers, not \"3\""},
        {"Scale 0 1 1 WorldBegin", "1:1", "Scale 0 1 1 cannot be undone"},
        {"Rotate 30 0 0 0", "1:1", "Rotate has no axis: 0 0 0"},
        {"LookAt 1 2 3 1 2 3 0 1 0", "1:1", "LookAt looks at the eye itself"},
        {"LookAt 0 0 0 0 1 0 0 1 0", "1:1", "LookAt has an up vector that is zero or along the view"},
        {"Transform 1 2 3", "1:11", "Transform expects [, not 1"},
        {"Transform [ 1 2 3 ]", "1:19", "Transform expects 16 numbers, not ]"},
        {"Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 1 ]", "1:45", "Transform expects ] after 16 numbers, not 1"},
        {"Transform [ 1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1 ]", "1:1", "the singular matrix of Transform cannot be undone"},
        {"WorldBegin Scale 1e200 1 1 Scale 1e200 1 1", "1:28",
         "Scale makes a transform that is too large or too small"},
        {"Camera perspective", "1:8", "Camera expects a quoted type, not perspective"},
        {"Shape \"sphere\"", "1:1", "Shape may only stand after WorldBegin"},
        {"WorldBegin Camera \"perspective\"", "1:12", "Camera may only stand before WorldBegin"},
        {"WorldBegin WorldBegin", "1:12", "WorldBegin may only stand once"},
        {"WorldBegin AttributeEnd", "1:12", "AttributeEnd without AttributeBegin"},
        {"WorldBegin AttributeBegin\n AttributeBegin AttributeEnd", "2:29",
         "the file ends, but AttributeBegin at t:1:12 is still open"},
        {"WorldBegin\nAttributeBegin ObjectEnd", "2:16", "ObjectEnd, but AttributeBegin at t:2:1 is still open"},
        {"WorldBegin ObjectBegin \"a\" AttributeEnd", "1:28", "AttributeEnd, but ObjectBegin at t:1:12 is still open"},
        {"WorldBegin ObjectBegin \"a\" ObjectBegin \"b\"", "1:28", "ObjectBegin within another object"},
        {"WorldBegin ObjectBegin \"a\"", "1:27", "the file ends, but ObjectBegin at t:1:12 is still open"},
        {"WorldBegin ObjectBegin \"a\" ObjectInstance \"b\"", "1:28", "ObjectInstance within an object"},
        {"WorldBegin Shape \"sphere\" \"float radius\" [ 1", "1:45",
         "\"float radius\" expects numbers, but the file ends"},
        {"WorldBegin Shape \"sphere\" \"float radius\" [ 1 2 ]", "1:27",
         "\"float radius\" should have 1 value, but has 2"},
        {"WorldBegin Shape \"sphere\" \"float radius\" [ ]", "1:27", "\"float radius\" should have 1 value, but has 0"},
        {"WorldBegin Shape \"sphere\" \"float radius\" \"big\"", "1:42",
         "\"float radius\" expects numbers, not \"big\""},
        {"WorldBegin Shape \"sphere\" \"float radius\" 5x", "1:42", "\"float radius\" expects numbers, not 5x"},
        {"WorldBegin Shape \"sphere\" \"float radius\" 1e400", "1:42", "the number is too large"},
        {"WorldBegin Shape \"sphere\" \"float radius\" 1e300", "1:27", "\"float radius\": 1e+300 is too large"},
        {"WorldBegin Shape \"sphere\" \"float radius\" nan", "1:42", "\"float radius\" expects numbers, not nan"},
        {"WorldBegin Shape \"sphere\" \"float radius\" [ [ 1 ] ]", "1:44", "\"float radius\" expects numbers, not ["},
        {"WorldBegin Shape \"sphere\" \"float radius\" -1", "1:27", "\"radius\" should be above 0"},
        {"WorldBegin Material \"subsurface\" \"string name\" \"Granite\"", "1:34",
         "no subsurface material is named \"Granite\""},
        {"WorldBegin Shape \"sphere\" \"radius\" 1", "1:27", "\"radius\" should be a parameter's \"type name\""},
        {"WorldBegin Shape \"sphere\" \"double radius\" 1", "1:27", "\"double radius\": unknown parameter type"},
        {"WorldBegin Shape \"sphere\" \"integer radius\" 1", "1:27", "\"integer radius\" should be \"float radius\""},
        {"WorldBegin Shape \"sphere\" \"integer radius\" 1.5", "1:27",
         "\"integer radius\": 1.5 (value 1) is not an integer of 32 bits"},
        {"WorldBegin Shape \"sphere\" \"integer radius\" 3000000000", "1:27",
         "\"integer radius\": 3e+09 (value 1) is not an integer of 32 bits"},
        {"WorldBegin Shape \"sphere\" \"bool radius\" 1", "1:41", "\"bool radius\" expects true or false, not 1"},
        {"WorldBegin Shape \"sphere\" \"string radius\" 1", "1:43", "\"string radius\" expects quoted strings, not 1"},
        {"WorldBegin Shape \"sphere\" \"spectrum radius\" [ true ]", "1:47",
         "\"spectrum radius\" expects a name or numbers, not true"},
        {"WorldBegin Shape \"sphere\" \"spectrum radius\" [ 1 \"a\" ]", "1:49",
         "\"spectrum radius\" expects numbers, not \"a\""},
        {"WorldBegin Shape \"sphere\" \"spectrum radius\" [ 1 2 3 ]", "1:27",
         "\"spectrum radius\" has 3 numbers, which is no multiple of 2"},
        {"WorldBegin Shape \"sphere\" \"rgb c\" [ 1 2 ]", "1:27", "\"rgb c\" has 2 numbers, which is no multiple of 3"},
        {"WorldBegin Shape \"disk\" \"float innerradius\" 1", "1:25",
         "\"innerradius\" should be from 0 to below \"radius\""},
        {"WorldBegin Shape \"disk\" \"float radius\" 0", "1:25", "\"radius\" should be above 0"},
        {"WorldBegin Translate 1e19 0 0 Shape \"sphere\"", "1:31", "it reaches beyond 1e18 units in world space"},
        {"WorldBegin Material \"marzipan\" \"rgb color\" [ .9 .8 .7 ]", "1:12", "unknown material \"marzipan\""},
        {"WorldBegin MakeNamedMaterial \"m\" \"string type\" \"marzipan\"", "1:12", "unknown material \"marzipan\""},
        {"WorldBegin Shape \"spehre\"", "1:12", "unknown shape \"spehre\""},
        {"WorldBegin Shape \"trianglemesh\"", "1:12", "\"point3 P\" is missing"},
        {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ]", "1:33",
         "\"integer indices\" is missing (of 4 vertices; only 3 can do without)"},
        {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 ]", "1:33",
         "\"point3 P\" has 11 numbers, which is no multiple of 3"},
        {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 ]", "1:66",
         "\"indices\" has 2 values, which is no multiple of 3"},
        {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 3 ]", "1:66",
         "index 3 (value 3 of \"indices\") is out of range, there are 3 vertices"},
        {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 -1 2 ]", "1:66",
         "index -1 (value 2 of \"indices\") is out of range, there are 3 vertices"},
        {"WorldBegin Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 2e18 0 ]", "1:33",
         "a vertex lies beyond 1e18 units in world space"},
        {"WorldBegin Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]", "1:33",
         "\"integer indices\" is missing (of 3 vertices; only 4 can do without)"},
        {"WorldBegin MakeNamedMaterial \"a\" \"rgb reflectance\" [ 1 1 1 ]", "1:12",
         "MakeNamedMaterial \"a\" has no \"string type\""},
        {"WorldBegin MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"a\" \"string type\" "
         "\"diffuse\"",
         "2:1", "material \"a\" is made twice, first at t:1:12"},
        {"WorldBegin\n  NamedMaterial \"nope\" NamedMaterial \"nope\"", "2:3", "no material is named \"nope\""},
        {"WorldBegin Material \"diffuse\" \"rgb reflectance\" [ -1 0 0 ]", "1:31",
         "\"rgb reflectance\" has a negative component, -1"},
        {"WorldBegin Material \"conductor\" \"rgb reflectance\" [ 1 1 1 ] \"rgb k\" [ 1 1 1 ]", "1:33",
         "\"reflectance\" and \"eta\" or \"k\" cannot both be given to a conductor"},
        {"WorldBegin Material \"conductor\" \"rgb eta\" [ 0 1 1 ]", "1:33", "\"eta\" should be above 0"},
        {"WorldBegin Material \"conductor\" \"float roughness\" -1", "1:33", "\"roughness\" should not be negative"},
        {"WorldBegin Material \"dielectric\" \"float eta\" 0", "1:34", "\"eta\" should be above 0"},
        {"WorldBegin Material \"dielectric\" \"float vroughness\" -1", "1:34", "\"vroughness\" should not be negative"},
        {"WorldBegin LightSource \"foo\"", "1:12", "unknown light \"foo\""},
        {"WorldBegin LightSource \"point\" \"float scale\" -1", "1:32", "\"scale\" should not be negative"},
        {"WorldBegin LightSource \"point\" \"rgb I\" [ -1 0 0 ]", "1:32", "\"rgb I\" has a negative component, -1"},
        {"WorldBegin LightSource \"point\" \"blackbody I\" 10", "1:32",
         "\"blackbody I\": 10 is not a temperature from 500 to 1e+06 kelvin"},
        {"WorldBegin LightSource \"point\" \"blackbody I\" [ 5000 2 3 ]", "1:32",
         "\"blackbody I\" should have 1 value, but has 3"},
        {"WorldBegin LightSource \"point\" \"rgb I\" [ 1e30 0 0 ] \"float scale\" 1e30", "1:53",
         "the light is too bright for a float"},
        {"WorldBegin LightSource \"spot\" \"float coneangle\" 0", "1:31",
         "\"coneangle\" should be within (0, 180] degrees"},
        {"WorldBegin LightSource \"spot\" \"float conedeltaangle\" 90", "1:31",
         "\"conedeltaangle\" should be from 0 to twice \"coneangle\""},
        {"WorldBegin LightSource \"spot\" \"point3 to\" [ 0 0 0 ]", "1:31", "\"from\" and \"to\" give no direction"},
        {"WorldBegin LightSource \"distant\" \"point3 from\" [ 0 0 1 ]", "1:12",
         "\"from\" and \"to\" give no direction"},
        {"WorldBegin AreaLightSource \"sun\"", "1:12", "unknown area light \"sun\""},
        {"Camera \"foo\"", "1:1", "unknown camera \"foo\""},
        {"Camera \"perspective\" \"float fov\" 180", "1:22", "the field of view should be within (0, 180) degrees"},
        {"Camera \"perspective\" \"float fov\" 0", "1:22", "the field of view should be within (0, 180) degrees"},
        {"Camera \"perspective\" \"float halffov\" 95", "1:22", "the field of view should be within (0, 180) degrees"},
        {"Camera \"perspective\" \"float lensradius\" -1", "1:22", "\"lensradius\" should not be negative"},
        {"Camera \"perspective\" \"float focaldistance\" 0", "1:22", "\"focaldistance\" should be above 0"},
        {"Camera \"perspective\" \"float frameaspectratio\" 0", "1:22", "\"frameaspectratio\" should be above 0"},
        {"Camera \"perspective\" \"float screenwindow\" [ 1 0 0 1 ]", "1:22",
         "\"screenwindow\" should be x0 x1 y0 y1, with x0 < x1 and y0 < y1"},
        {"ColorSpace \"foo\"", "1:1",
         "unknown colour space \"foo\"; known are srgb, dci-p3, rec2020, aces2065-1 and acescg"},
        {"ActiveTransform Foo", "1:17", "ActiveTransform expects StartTime, EndTime or All, not Foo"},
        {"Option \"a\" 1", "1:8", "unknown option \"a\""},
        {"Option \"seed\" [", "1:15", "Option expects a value, not ["},
        {"Option \"seed\" x", "1:15", "Option expects a number, not x"},
        {"Option \"seed\" 1.5", "1:15", "the seed should be an integer of 32 bits"},
        {"Option \"Disable-Pixel_Jitter\" 1", "1:31", "Option expects true or false, not 1"},
        {"WorldBegin Attribute \"film\" \"float a\" 1", "1:12",
         "unknown target \"film\"; known are shape, light, material, medium and texture"},
        {"WorldBegin Attribute \"shape\" \"float radius\" -1 Shape \"sphere\"", "1:30", "\"radius\" should be above 0"},
        {"WorldBegin Material \"diffuse\" \"spectrum reflectance\" [ 500 1 400 1 ]", "1:31",
         "\"spectrum reflectance\": the wavelengths should increase, but 400 follows 500"},
        {"WorldBegin Material \"diffuse\" \"spectrum reflectance\" [ 400 1 500 -2 ]", "1:31",
         "\"spectrum reflectance\" has a negative value, -2"},
        {"WorldBegin Material \"diffuse\" \"spectrum reflectance\" [ 400 1e60 ]", "1:31",
         "\"spectrum reflectance\": 1e+60 is too large"},
        {"WorldBegin Material \"diffuse\" \"spectrum reflectance\" [ ]", "1:31",
         "\"spectrum reflectance\" should have values"},
        {"WorldBegin Material \"diffuse\" \"spectrum reflectance\" [ \"glass-BK7\" \"glass-F5\" ]", "1:31",
         "\"spectrum reflectance\" should have one name, or numbers"},
        {"ColorSpace \"rec2020\" WorldBegin Material \"diffuse\" \"rgb reflectance\" [ 0 -1 0 ]", "1:52",
         "\"rgb reflectance\" has a negative component"},
        {"Camera \"perspective\" \"float shutterclose\" 0", "1:22", "the shutter should close after it opens, at 0"},
        {"Camera \"spherical\" \"string mapping\" \"cube\"", "1:20",
         "unknown mapping \"cube\"; known are equalarea and equirectangular"},
        {"Camera \"realistic\"", "1:1", "Camera \"realistic\" has no \"string lensfile\""},
        {"Include foo", "1:9", "Include expects a quoted file name, not foo"},
        {"WorldBegin Texture \"a\" b", "1:24", "Texture expects a quoted type after its name, not b"},
        {"WorldBegin Shape \"sphere\" \"float radius\" true", "1:42", "\"float radius\" expects numbers, not true"},
        {"WorldBegin Shape sphere", "1:18", "Shape expects a quoted type, not sphere"},
        {"Integrator", "1:11", "Integrator expects a quoted type, but the file ends"},
        {"WorldBegin Shape \"sphere\" \"point3 c\" [ 1 2 3 \"a\" ]", "1:46", "\"point3 c\" expects numbers, not \"a\""},
        {"WorldBegin Shape \"sphere\" \"bool b\" \"maybe\"", "1:36", "\"bool b\" expects true or false, not \"maybe\""},
        {"WorldBegin LightSource \"point\" \"float from\" [ 1 2 3 ]", "1:32",
         "\"float from\" should be \"point3 from\""},
        {"WorldBegin Shape \"trianglemesh\" \"float P\" [ 1 2 3 ]", "1:33", "\"float P\" should be \"point3 P\""},
        {"WorldBegin AreaLightSource \"diffuse\" \"bool twosided\" [ true false ]", "1:38",
         "\"bool twosided\" should have 1 value, but has 2"},
        {"WorldBegin AreaLightSource \"diffuse\" \"float power\" 1e30 \"float scale\" 1e30 Scale 1e-8 1e-8 1e-8 "
         "Shape \"sphere\"",
         "1:97", "AreaLightSource \"diffuse\": the light is too bright for a float"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char expected[256];
        snprintf(expected, sizeof expected, "t:%s: error: %s\n", CASES[i].location, CASES[i].message);
        reading r = reading_create(NULL, CASES[i].text, strlen(CASES[i].text));
        if (r.status != AG_ERROR_SCENE || r.count[AG_LOG_ERROR] != 1 ||
            strncmp(r.said[AG_LOG_ERROR], expected, strlen(expected)) != 0)
            fail_msg("%s\n    should say: %s    but says: %s", CASES[i].text, expected,
                     r.said[AG_LOG_ERROR] ? r.said[AG_LOG_ERROR] : "nothing\n");
        reading_destroy(&r);
    }
}

static void check_error(const char *text, const char *expected)
{
    reading r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_ERROR_SCENE);
    assert_string_equal(r.said[AG_LOG_ERROR], expected);
    reading_destroy(&r);
}

static void errors_show_their_line(void **state)
{
    (void)state;
    check_error("WorldBegin\n\tShape \"sphere\" \"float radius\" five\r\n",
                "t:2:32: error: \"float radius\" expects numbers, not five\n"
                "     Shape \"sphere\" \"float radius\" five\n"
                "                                   ^~~~\n");
    check_error("WorldBegin Shape \"sphere\" \"float radius\" -1",
                "t:1:27: error: \"radius\" should be above 0\n"
                "    WorldBegin Shape \"sphere\" \"float radius\" -1\n"
                "                              ^~~~~~~~~~~~~~\n");
    check_error("WorldBegin\n  Shape \"sphere\" \"integer radius\" 1",
                "t:2:18: error: \"integer radius\" should be \"float radius\"\n"
                "      Shape \"sphere\" \"integer radius\" 1\n"
                "                     ^~~~~~~~~~~~~~~~\n");
    check_error("", "t:1:1: error: the file ends without WorldBegin\n    \n    ^\n");
}

static void parameters_are_limited(void **state)
{
    (void)state;
    char *text = malloc(100000);
    assert_non_null(text);
    size_t used = (size_t)sprintf(text, "Film \"rgb\"");
    for (int i = 0; i <= 1000; i++)
        used += (size_t)sprintf(text + used, "\n\"float p%d\" 1", i);
    check_error(text,
                "t:1002:1: error: Film has more than 1000 parameters\n    \"float p1000\" 1\n    ^~~~~~~~~~~~~\n");
    free(text);
}

/* Each text, said twice, warns once. */
static void warnings_are_given_once(void **state)
{
    (void)state;
    static const struct {
        const char *text, *warning;
    } CASES[] = {
        {"AreaLightSource \"diffuse\" Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0]",
         "Shape \"curve\" cannot shine, nor can it in pbrt: its area light is left out"},
        {"Shape \"sphere\" \"float betamax\" 0.5",
         "Shape \"sphere\": \"float betamax\" is not known, or not supported yet, and is ignored"},
        {"Material \"measured\" \"string filename\" \"a\"",
         "material \"measured\" is not supported: \"diffuse\" with a reflectance of 0.5 stands in"},
        {"Material \"subsurface\" \"float eta\" 1.3",
         "material \"subsurface\" is not supported: \"coateddiffuse\" of its diffuse reflectance, which lets no light "
         "travel inside, stands in"},
        {"Shape \"sphere\" \"texture radius\" \"wood\"",
         "\"texture radius\" is not supported here: it is ignored and the default is used"},
        {"Material \"conductor\" \"spectrum eta\" \"nikon_d850_r\"",
         "the spectrum \"nikon_d850_r\" is not known, or not supported yet: the default of \"eta\" is used"},
        {"LightSource \"point\" \"point from\" [ 0 0 1 ]",
         "the parameter type \"point\" is called \"point3\" in pbrt-v4 and is read as that"},
        {"AreaLightSource \"diffuse\" \"string picture\" \"a.exr\"",
         "AreaLightSource \"diffuse\": \"string picture\" is not known, or not supported yet, and is ignored"},
        {"ColorSpace \"rec2020\" Material \"diffuse\" \"rgb reflectance\" [ 0 1 0 ]",
         "\"rgb reflectance\" is outside the colours of Rec. 709: it is clipped, as are any others"},
        {"TransformBegin TransformEnd", "TransformBegin and TransformEnd are deprecated and taken, as in pbrt-v4, for "
                                        "AttributeBegin and AttributeEnd"},
        {"WorldEnd", "WorldEnd is not part of pbrt-v4 and is ignored"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        char text[512], expected[512];
        size_t length = (size_t)snprintf(text, sizeof text, "WorldBegin\n%s\n%s\n", CASES[i].text, CASES[i].text);
        reading r = reading_create(NULL, text, length);
        assert_int_equal(r.status, AG_OK);
        if (r.count[AG_LOG_WARNING] != 1)
            fail_msg("%s: %d warnings", CASES[i].text, r.count[AG_LOG_WARNING]);
        int line, column;
        assert_int_equal(sscanf(r.said[AG_LOG_WARNING], "t:%d:%d: ", &line, &column), 2);
        assert_int_equal(line, 2);
        snprintf(expected, sizeof expected, "warning: %s\n", CASES[i].warning);
        assert_string_equal(strstr(r.said[AG_LOG_WARNING], "warning: "), expected);
        reading_destroy(&r);
    }
}

static void options_warn_where_they_matter(void **state)
{
    (void)state;
    const char *text =
        "Option \"seed\" 7 Option \"Seed\" -8 Option \"rendercoordsys\" \"world\" Option \"wavefront\" true\n"
        "Option \"force-diffuse\" true Option \"pixelstats\" false Option \"disable_pixel_jitter\" true\n"
        "TransformTimes 0 1 WorldBegin\nCoordSysTransform \"nowhere\"";
    reading r = reading_create(NULL, text, strlen(text));
    assert_int_equal(r.status, AG_OK);
    assert_true(r.scene->hints.seed.is_given && r.scene->hints.disable_pixel_jitter);
    assert_int_equal(r.scene->hints.seed.value, -8);
    assert_string_equal(r.said[AG_LOG_WARNING],
                        "t:2:1: warning: Option \"forcediffuse\" is not supported: materials stay as they are\n"
                        "t:4:1: warning: no coordinate system is named \"nowhere\": CoordSysTransform is ignored\n");
    reading_destroy(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_name_location_and_reason), cmocka_unit_test(errors_show_their_line),
        cmocka_unit_test(parameters_are_limited),          cmocka_unit_test(warnings_are_given_once),
        cmocka_unit_test(options_warn_where_they_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
