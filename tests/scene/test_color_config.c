/* test_color_config.c: configs of OpenColorIO as others write them: Blender's and ACES' kind, working spaces, and what
 * is wrong with those that cannot be used. Flow: tests of scene/color/color_ocio.cpp. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/color_fixture.h"

static void expect_bad_config(const char *path, const char *text, const char *more_text)
{
    color_config *config = (color_config *)(void *)message;
    assert_int_equal(color_config_create(path, NULL, NULL, message, sizeof message, &config), AG_ERROR_COLOR);
    assert_null(config);
    assert_non_null(strstr(message, text));
    assert_non_null(strstr(message, more_text));
}

static void bad_configs_say_why(void **state)
{
    (void)state;
    const char *path = in_folder("missing.ocio");
    expect_bad_config(path, "missing.ocio", "could not");
    setenv("OCIO", path, 1); /* no silent fallback */
    expect_bad_config(NULL, "$OCIO", "missing.ocio");
    unsetenv("OCIO");

    write_text("broken.ocio", "ocio_profile_version: 1\nroles: [\n");
    path = in_folder("broken.ocio");
    expect_bad_config(path, "broken.ocio", "line");

    write_text("later.ocio", "ocio_profile_version: 2.9\n");
    path = in_folder("later.ocio");
    expect_bad_config(path, "later.ocio", "version");

    write_text("not_linear.ocio",
               VERSION_1 "displays:\n  Screen:\n    - !<View> {name: Plain, colorspace: lut}\ncolorspaces:\n"
                         "  - !<ColorSpace>\n    name: lut\n");
    path = in_folder("not_linear.ocio");
    expect_bad_config(path, "scene-linear", "");

    /* The message is cut, not overrun. */
    char small[8];
    color_config *config;
    assert_int_equal(color_config_create(path, NULL, NULL, small, sizeof small, &config), AG_ERROR_COLOR);
    assert_int_equal(strlen(small), sizeof small - 1);
}

static void unknown_names_list_the_known(void **state)
{
    (void)state;
    color_config *config = open_config(NULL);
    color_processor *processor = NULL;
    const color_view cinema = {.display = "Cinema"}, filmic = {.view = "Filmic"}, look = {.look = "Bleach"};
    assert_int_equal(color_processor_create(config, &cinema, message, sizeof message, &processor), AG_ERROR_COLOR);
    assert_null(processor);
    assert_non_null(strstr(message, "'Cinema'"));
    assert_non_null(strstr(message, "'sRGB - Display'"));
    assert_non_null(strstr(message, "'P3-D65 - Display'"));

    assert_int_equal(color_processor_create(config, &filmic, message, sizeof message, &processor), AG_ERROR_COLOR);
    assert_non_null(strstr(message, "'Filmic'"));
    assert_non_null(strstr(message, "'Un-tone-mapped'"));
    assert_non_null(strstr(message, "'ACES 1.0 - SDR Video'"));
    assert_null(strstr(message, "P3 lim")); /* a view of other displays */

    expect_failure(color_processor_create(config, &look, message, sizeof message, &processor), AG_ERROR_COLOR,
                   "'Bleach'");
    assert_non_null(strstr(message, "'Higher Contrast'"));
    const color_view half_known = {.look = "Higher Contrast, nothing"};
    expect_failure(color_processor_create(config, &half_known, message, sizeof message, &processor), AG_ERROR_COLOR,
                   "'nothing'");
    color_config_destroy(config);

    color_config *none = NULL;
    expect_failure(color_config_create(NULL, "ACEScq", NULL, message, sizeof message, &none), AG_ERROR_COLOR,
                   "'ACEScq'");
    assert_non_null(strstr(message, "'ACEScg'"));
    expect_failure(color_config_create(NULL, "Raw", NULL, message, sizeof message, &none), AG_ERROR_COLOR, "data");
    expect_failure(color_config_create(NULL, "ACEScct", NULL, message, sizeof message, &none), AG_ERROR_COLOR,
                   "not linear");
    assert_null(none);
}

/* Blender before 4.0: the reference space is linear Rec. 709 and is called "Linear". */
static void config_of_blender_kind(void **state)
{
    (void)state;
    write_text("blender.ocio", VERSION_1 "roles:\n  scene_linear: Linear\n  default: Linear\ndisplays:\n  sRGB:\n"
                                         "    - !<View> {name: Standard, colorspace: Square}\ncolorspaces:\n"
                                         "  - !<ColorSpace>\n    name: Linear\n    bitdepth: 32f\n"
                                         "  - !<ColorSpace>\n    name: Square\n"
                                         "    from_reference: !<ExponentTransform> {value: [2, 2, 2, 1]}\n");
    color_config *config = open_config_file("blender.ocio");
    assert_string_equal(color_config_working_space(config), "Linear");
    float rgb[3] = {0.5f, 0.25f, 0.125f};
    apply(config, "sRGB", "Standard", rgb, 1);
    assert_rgb(rgb, 0.25, 0.0625, 0.015625, 1e-5);
    color_config_destroy(config);
}

/* Light is carried in ACEScg: Rec. 709 red is the first column of the matrix there, and the view shows what it is
 * given. */
static void expect_acescg(const char *name, const char *text, const char *working_space)
{
    write_text(name, text);
    color_config *config = open_config_file(name);
    assert_string_equal(color_config_working_space(config), working_space);
    double m[9];
    assert_true(color_config_from_rec709(config, m));
    assert_near(m[0], 0.613097, 2e-6);
    assert_near(m[3], 0.070194, 2e-6);
    assert_near(m[6], 0.020616, 2e-6);
    float rgb[3] = {0.5f, 0.25f, 0.125f};
    apply(config, NULL, NULL, rgb, 1);
    assert_rgb(rgb, 0.5, 0.25, 0.125, 1e-6);
    color_config_destroy(config);
}

static void configs_of_aces_kind(void **state)
{
    (void)state;
    /* 1.x: scene_linear is ACEScg, and Rec. 709 has a name. */
    expect_acescg("aces1.ocio",
                  VERSION_1 "roles:\n  scene_linear: ACES - ACEScg\n  rendering: ACES - ACEScg\ndisplays:\n"
                            "  ACES:\n    - !<View> {name: Plain, colorspace: ACES - ACEScg}\ncolorspaces:\n"
                            "  - !<ColorSpace>\n    name: ACES - ACEScg\n"
                            "  - !<ColorSpace>\n    name: Utility - Linear - sRGB\n"
                            "    to_reference: !<MatrixTransform> {matrix: " ACESCG_FROM_REC709 "}\n",
                  "ACES - ACEScg");
    /* 2.x without a Rec. 709 space: by way of the interchange role. */
    expect_acescg("aces2.ocio",
                  "ocio_profile_version: 2\nfile_rules:\n  - !<Rule> {name: Default, colorspace: ACEScg}\n"
                  "roles:\n  scene_linear: ACEScg\n  aces_interchange: ACES2065-1\ndisplays:\n"
                  "  ACES:\n    - !<View> {name: Plain, colorspace: ACEScg}\ncolorspaces:\n"
                  "  - !<ColorSpace>\n    name: ACES2065-1\n"
                  "  - !<ColorSpace>\n    name: ACEScg\n"
                  "    to_scene_reference: !<BuiltinTransform> {style: ACEScg_to_ACES2065-1}\n",
                  "ACEScg");
}

static void working_space_by_name(void **state)
{
    (void)state;
    color_config *config = NULL;
    double m[9];
    assert_int_equal(color_config_create(NULL, "lin_ap1", NULL, message, sizeof message, &config), AG_OK);
    assert_string_equal(color_config_working_space(config), "ACEScg");
    assert_true(color_config_from_rec709(config, m));
    assert_near(m[0], 0.613097, 2e-6);
    assert_near(m[1], 0.339523, 2e-6);
    /* light looks alike from both spaces */
    color_config *rec709 = open_config(NULL);
    float a[3] = {0.8f, 0.1f, 0.3f}, b[3];
    for (int i = 0; i < 3; i++)
        b[i] = (float)(m[3 * i] * (double)a[0] + m[3 * i + 1] * (double)a[1] + m[3 * i + 2] * (double)a[2]);
    apply(rec709, NULL, NULL, a, 1);
    apply(config, NULL, NULL, b, 1);
    assert_rgb(a, b[0], b[1], b[2], 2e-5);
    color_config_destroy(rec709);

    color_curve curve;
    assert_int_equal(color_config_study_space(config, "srgb_tx", message, sizeof message, &curve, m), AG_OK);
    assert_int_equal(curve, COLOR_CURVE_SRGB);
    assert_near(m[0], 0.613097, 2e-5);
    assert_int_equal(color_config_study_space(config, "ACES2065-1", message, sizeof message, &curve, m), AG_OK);
    assert_int_equal(curve, COLOR_CURVE_LINEAR);
    assert_near(m[0], 1.451439, 2e-5);
    assert_int_equal(color_config_study_space(config, "Raw", message, sizeof message, &curve, m), AG_OK);
    assert_int_equal(curve, COLOR_CURVE_DATA);
    assert_int_equal(color_config_study_space(config, "ACEScct", message, sizeof message, &curve, m), AG_OK);
    assert_int_equal(curve, COLOR_CURVE_OTHER);
    expect_failure(color_config_study_space(config, "sRBG", message, sizeof message, &curve, m), AG_ERROR_COLOR,
                   "'sRBG'");

    assert_string_equal(color_config_rule(config, "/some/where/a.exr"), "Linear Rec.709 (sRGB)");
    assert_null(color_config_rule(config, "a.png"));
    assert_string_equal(color_config_find_space(config, "rendering", message, sizeof message), "Linear Rec.709 (sRGB)");
    color_config_destroy(config);
}

/* Definitions that OpenColorIO would follow for ever are refused. */
static void what_is_made_of_itself_is_refused(void **state)
{
    (void)state;
#define HEAD_OF_SPACES                                                                                                 \
    VERSION_1 "roles:\n  scene_linear: Linear\ndisplays:\n  Screen:\n"                                                 \
              "    - !<View> {name: Plain, colorspace: a}\ncolorspaces:\n  - !<ColorSpace>\n    name: Linear\n"
#define SPACE_OF(name, src)                                                                                            \
    "  - !<ColorSpace>\n    name: " name "\n    to_reference: !<ColorSpaceTransform> {src: " src ", dst: Linear}\n"
    write_text("self.ocio", HEAD_OF_SPACES SPACE_OF("a", "a"));
    expect_bad_config(in_folder("self.ocio"), "'a'", "made of itself");
    write_text("ring.ocio", HEAD_OF_SPACES SPACE_OF("a", "b") SPACE_OF("b", "c") SPACE_OF("c", "a"));
    expect_bad_config(in_folder("ring.ocio"), "made of itself", "");
    write_text("chain.ocio", HEAD_OF_SPACES SPACE_OF("a", "b") SPACE_OF("b", "c") SPACE_OF("c", "Linear"));
    color_config *config = open_config_file("chain.ocio");
    expect_grey(config, NULL, NULL, 0.3f, 0.3, 1e-6);
    color_config_destroy(config);

    /* each is made of the next, twice */
    enum { SPACES = 30 };
    char text[8192];
    int at = snprintf(text, sizeof text, HEAD_OF_SPACES SPACE_OF("a", "s0"));
    for (int i = 0; i < SPACES; i++)
        at += snprintf(text + at, sizeof text - (size_t)at,
                       "  - !<ColorSpace>\n    name: s%d\n    to_reference: !<GroupTransform>\n      children:\n"
                       "        - !<ColorSpaceTransform> {src: s%d, dst: Linear}\n"
                       "        - !<ColorSpaceTransform> {src: s%d, dst: Linear}\n",
                       i, i + 1, i + 1);
    snprintf(text + at, sizeof text - (size_t)at, SPACE_OF("s30", "Linear"));
    write_text("doubling.ocio", text);
    expect_bad_config(in_folder("doubling.ocio"), "too many", "");
}

/* A view whose table is not there is told as it is; the config's other views work. */
static void missing_tables_are_named(void **state)
{
    (void)state;
    write_text("tables.ocio", VERSION_1 "search_path: luts\nroles:\n  scene_linear: Linear\ndisplays:\n  Screen:\n"
                                        "    - !<View> {name: Plain, colorspace: Linear}\n"
                                        "    - !<View> {name: Table, colorspace: table}\ncolorspaces:\n"
                                        "  - !<ColorSpace>\n    name: Linear\n"
                                        "  - !<ColorSpace>\n    name: table\n"
                                        "    from_reference: !<FileTransform> {src: gone.spi1d}\n");
    color_config *config = open_config_file("tables.ocio");
    color_processor *processor = NULL;
    const color_view table = {.view = "Table"};
    expect_failure(color_processor_create(config, &table, message, sizeof message, &processor), AG_ERROR_COLOR,
                   "gone.spi1d");
    expect_grey(config, "Screen", "Plain", 0.3f, 0.3, 1e-6);
    color_config_destroy(config);
}

/* Without a known name and an interchange space only the role is left. */
static void falls_back_to_the_role(void **state)
{
    (void)state;
    write_text("role.ocio", VERSION_1 "roles:\n  scene_linear: scene\ndisplays:\n  Screen:\n"
                                      "    - !<View> {name: Plain, colorspace: scene}\ncolorspaces:\n"
                                      "  - !<ColorSpace>\n    name: scene\n");
    color_config *config = open_config_file("role.ocio");
    assert_string_equal(color_config_working_space(config), "scene");
    expect_grey(config, NULL, NULL, 0.3f, 0.3, 1e-6);
    color_config_destroy(config);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_configs_say_why),      cmocka_unit_test(unknown_names_list_the_known),
        cmocka_unit_test(config_of_blender_kind),   cmocka_unit_test(configs_of_aces_kind),
        cmocka_unit_test(working_space_by_name),    cmocka_unit_test(what_is_made_of_itself_is_refused),
        cmocka_unit_test(missing_tables_are_named), cmocka_unit_test(falls_back_to_the_role),
    };
    return cmocka_run_group_tests(tests, make_folder_without_environment, remove_folder);
}
