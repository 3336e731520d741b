/* test_color.c: the colour bridge against known values, other people's kinds of config, and oiiotool.
 * Flow: tests of scene/color/color_ocio.cpp and scene/color/config.ocio. Threads: one. */
#define _GNU_SOURCE
#include "color/color.h"
#include "color/color_builtin_config.h"
#include "fixtures/temporary_folder.h"
#include "image/image_reader.h"

#include <math.h>

/* How the configs of the first profile version begin; and the rows of a matrix. */
#define VERSION_1 "ocio_profile_version: 1\nstrictparsing: false\nluma: [0.2126, 0.7152, 0.0722]\n"
#define ACESCG_FROM_REC709                                                                                             \
    "[0.613097402, 0.339523146, 0.047379451, 0, 0.070193822, 0.916353879, 0.013452399, 0, "                            \
    "0.020615593, 0.109569773, 0.869814635, 0, 0, 0, 0, 1]"

static void write_text(const char *name, const char *text)
{
    FILE *file = fopen(in_folder(name), "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

/* A config that multiplies by factor, so that it can be told which one was used. */
static void write_scaling_config(const char *name, double factor)
{
    char text[1024];
    snprintf(text, sizeof text,
             VERSION_1
             "roles:\n  scene_linear: Linear\ndisplays:\n  Screen:\n"
             "    - !<View> {name: Scaled, colorspace: scaled}\ncolorspaces:\n"
             "  - !<ColorSpace>\n    name: Linear\n"
             "  - !<ColorSpace>\n    name: scaled\n"
             "    from_reference: !<MatrixTransform> {matrix: [%g, 0, 0, 0, 0, %g, 0, 0, 0, 0, %g, 0, 0, 0, 0, 1]}\n",
             factor, factor, factor);
    write_text(name, text);
}

static color_config *open_config(const char *path)
{
    color_config *config = NULL;
    const ag_status status = color_config_create(path, NULL, NULL, message, sizeof message, &config);
    if (status != AG_OK)
        print_error("%s\n", message);
    assert_int_equal(status, AG_OK);
    assert_non_null(config);
    return config;
}

static color_config *open_config_file(const char *name) { return open_config(in_folder(name)); }

static color_processor *open_processor(const color_config *config, const char *display, const char *view)
{
    color_processor *processor = NULL;
    const color_view wanted = {.display = display, .view = view};
    const ag_status status = color_processor_create(config, &wanted, message, sizeof message, &processor);
    if (status != AG_OK)
        print_error("%s\n", message);
    assert_int_equal(status, AG_OK);
    return processor;
}

static void apply(const color_config *config, const char *display, const char *view, float *rgb, size_t count)
{
    color_processor *processor = open_processor(config, display, view);
    assert_int_equal(color_processor_apply(processor, rgb, count, message, sizeof message), AG_OK);
    color_processor_destroy(processor);
}

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        print_error("%.7f is not within %g of %.7f\n", value, tolerance, expected);
    assert_true(fabs(value - expected) <= tolerance);
}

static void assert_rgb(const float *rgb, double red, double green, double blue, double tolerance)
{
    assert_near(rgb[0], red, tolerance);
    assert_near(rgb[1], green, tolerance);
    assert_near(rgb[2], blue, tolerance);
}

static void expect_grey(const color_config *config, const char *display, const char *view, float in, double out,
                        double tolerance)
{
    float rgb[3] = {in, in, in};
    apply(config, display, view, rgb, 1);
    assert_rgb(rgb, out, out, out, tolerance);
}

static void known_values(void **state)
{
    (void)state;
    color_config *config = open_config(NULL);
    const double srgb_grey = 1.055 * pow(0.18, 1.0 / 2.4) - 0.055;
    expect_grey(config, "sRGB - Display", "Un-tone-mapped", 0.18f, srgb_grey, 2e-5);
    expect_grey(config, "sRGB - Display", "ACES 1.0 - SDR Video", 0.18f, 0.355954, 5e-5);
    expect_grey(config, "sRGB - Display", "ACES 1.0 - SDR Video", 1.0f, 0.811971, 5e-5);
    expect_grey(config, "sRGB - Display", "ACES 1.0 - SDR Video", 16.0f, 0.9997, 1e-4);
    expect_grey(config, "Rec.1886 Rec.709 - Display", "ACES 1.0 - SDR Video", 0.18f, 0.389530, 5e-5);
    expect_grey(config, "sRGB - Display", "Raw", 0.18f, 0.18, 1e-7);

    float red[3] = {1.0f, 0.0f, 0.0f};
    apply(config, "Display P3 - Display", "Un-tone-mapped", red, 1);
    assert_rgb(red, 0.9175, 0.2003, 0.1386, 1e-4);

    /* A P3-D65 display's curve is a plain power of 2.6. */
    float projected[3] = {1.0f, 0.0f, 0.0f};
    apply(config, "P3-D65 - Display", "Un-tone-mapped", projected, 1);
    for (int c = 0; c < 3; c++)
        assert_near(pow(projected[c], 2.6), pow((red[c] + 0.055) / 1.055, 2.4), 2e-4);
    color_config_destroy(config);
}

static void defaults_and_names(void **state)
{
    (void)state;
    color_config *config = open_config(NULL);
    assert_string_equal(color_config_working_space(config), "Linear Rec.709 (sRGB)");
    assert_true(strlen(color_config_name(config)) > 0);
    assert_true(strlen(color_config_hash(config)) >= 16);

    color_config *again = open_config(NULL);
    assert_string_equal(color_config_hash(again), color_config_hash(config));
    write_scaling_config("hash.ocio", 3.0);
    color_config *other = open_config_file("hash.ocio");
    assert_string_not_equal(color_config_hash(other), color_config_hash(config));
    color_config_destroy(other);
    color_config_destroy(again);

    expect_grey(config, NULL, NULL, 0.18f, 0.355954, 5e-5); /* sRGB - Display, ACES 1.0 - SDR Video */
    expect_grey(config, "srgb - display", "un-tone-mapped", 0.18f, 0.461356, 5e-5); /* in any case */
    color_config_destroy(config);
    color_config_destroy(NULL);
    color_processor_destroy(NULL);
}

static void path_beats_environment_beats_builtin(void **state)
{
    (void)state;
    write_scaling_config("two.ocio", 2.0);
    write_scaling_config("four.ocio", 4.0);
    setenv("OCIO", in_folder("four.ocio"), 1);
    color_config *config = open_config_file("two.ocio");
    expect_grey(config, NULL, NULL, 0.25f, 0.5, 1e-6);
    assert_non_null(strstr(color_config_name(config), "two.ocio"));
    color_config_destroy(config);

    config = open_config(NULL);
    expect_grey(config, NULL, NULL, 0.25f, 1.0, 1e-6);
    assert_non_null(strstr(color_config_name(config), "four.ocio"));
    color_config_destroy(config);

    setenv("OCIO", "", 1);
    config = open_config(NULL);
    expect_grey(config, "sRGB - Display", "Un-tone-mapped", 0.18f, 0.461356, 5e-5);
    color_config_destroy(config);
    unsetenv("OCIO");
}

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

/* Light is multiplied before the view, and the looks that are asked for replace the view's own. */
static void exposure_and_looks(void **state)
{
    (void)state;
    color_config *config = open_config(NULL);
    color_processor *plain, *brighter, *contrast, *undone;
    const color_view views[] = {{.view = "Un-tone-mapped"},
                                {.view = "Un-tone-mapped", .exposure = -1.0f},
                                {.view = "Un-tone-mapped", .look = "higher contrast"},
                                {.view = "Un-tone-mapped", .look = "Higher Contrast, -Higher Contrast"}};
    color_processor **const made[] = {&plain, &brighter, &contrast, &undone};
    for (int i = 0; i < 4; i++)
        assert_int_equal(color_processor_create(config, &views[i], message, sizeof message, made[i]), AG_OK);
    float in[4][3] = {{0.09f, 0.2f, 0.3f}, {0.18f, 0.4f, 0.6f}, {0.09f, 0.2f, 0.3f}, {0.09f, 0.2f, 0.3f}};
    for (int i = 0; i < 4; i++)
        assert_int_equal(color_processor_apply(*made[i], in[i], 1, message, sizeof message), AG_OK);
    assert_memory_equal(in[0], in[1], sizeof in[0]);
    assert_true(in[2][0] < in[0][0] - 0.01f); /* below grey it is darker */
    assert_rgb(in[3], in[0][0], in[0][1], in[0][2], 2e-4);
    for (int i = 0; i < 4; i++)
        color_processor_destroy(*made[i]);
    color_config_destroy(config);
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
    /* the same light looks the same from both spaces */
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

static void tells_what_there_is(void **state)
{
    (void)state;
    char *text = NULL;
    color_config *config = open_config(NULL);
    assert_int_equal(color_config_describe(config, message, sizeof message, &text), AG_OK);
    static const char *const told[] = {"  sRGB - Display (default)\n", "    ACES 1.0 - SDR Video (default)\n",
                                       "  Lower Contrast\n", "  ACEScg (aces_cg, ", "  scene_linear: Linear Rec.709"};
    for (size_t i = 0; i < sizeof told / sizeof *told; i++)
        assert_non_null(strstr(text, told[i]));
    free(text);
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

static void bands_have_the_same_bits(void **state)
{
    (void)state;
    enum { COUNT = 5000 };
    float *whole = malloc(3 * COUNT * sizeof(float));
    float *bands = malloc(3 * COUNT * sizeof(float));
    assert_true(whole && bands);
    for (int i = 0; i < 3 * COUNT; i++)
        whole[i] = bands[i] = exp2f((float)(i * 7919 % 4001) / 250.0f - 10.0f);
    color_config *config = open_config(NULL);
    color_processor *processor = open_processor(config, NULL, NULL);
    assert_int_equal(color_processor_apply(processor, whole, COUNT, message, sizeof message), AG_OK);
    static const size_t sizes[] = {1, 2, 3, 1023, 1025, 7, 1024, 400, 0};
    size_t done = 0;
    for (size_t i = 0; done < COUNT; i++) {
        size_t size = sizes[i % (sizeof sizes / sizeof *sizes)];
        if (size > COUNT - done)
            size = COUNT - done;
        assert_int_equal(color_processor_apply(processor, bands + 3 * done, size, message, sizeof message), AG_OK);
        done += size;
    }
    assert_memory_equal(whole, bands, 3 * COUNT * sizeof(float));
    color_processor_destroy(processor);
    color_config_destroy(config);
    free(whole);
    free(bands);
}

static void agrees_with_oiiotool(void **state)
{
    (void)state;
    if (system("command -v oiiotool >/dev/null 2>&1") != 0) {
        print_message("oiiotool is not installed: no comparison with it\n");
        skip();
    }
    char text[16384], command[1024];
    assert_true(color_builtin_config_size < sizeof text);
    memcpy(text, color_builtin_config, color_builtin_config_size);
    text[color_builtin_config_size] = '\0';
    write_text("builtin.ocio", text);
    snprintf(
        command, sizeof command,
        "cd '%s' && oiiotool --colorconfig builtin.ocio --pattern "
        "fill:topleft=0,0.1,0.2:topright=1,0.5,0.1:bottomleft=0.05,2,0.3:bottomright=4,3,6 32x16 3 "
        "-d float -o in.tif --ociodisplay:from=lin_rec709 'sRGB - Display' 'ACES 1.0 - SDR Video' -d float -o out.tif",
        folder);
    assert_int_equal(system(command), 0);

    image ours, theirs;
    assert_int_equal(image_read(in_folder("in.tif"), &ours, message, sizeof message), AG_OK);
    assert_int_equal(image_read(in_folder("out.tif"), &theirs, message, sizeof message), AG_OK);
    assert_int_equal(theirs.width * theirs.height * theirs.channel_count, 32 * 16 * 3);
    color_config *config = open_config(NULL);
    apply(config, "sRGB - Display", "ACES 1.0 - SDR Video", ours.pixels, 32 * 16);
    for (int i = 0; i < 32 * 16 * 3; i++)
        assert_near(ours.pixels[i], theirs.pixels[i], 2e-6);
    color_config_destroy(config);
    image_reset(&ours);
    image_reset(&theirs);
}

/* Textures rest on the sRGB curve of IEC 61966-2-1, tested value by value. */
static void decodes_srgb(void **state)
{
    (void)state;
    setenv("OCIO", "/nowhere/config.ocio", 1);
    color_config *config = NULL;
    assert_int_equal(color_config_create_builtin(message, sizeof message, &config), AG_OK);
    unsetenv("OCIO");
    color_processor *processor = NULL;
    expect_failure(color_decoder_create(config, "no such space", message, sizeof message, &processor), AG_ERROR_COLOR,
                   "no such space");
    assert_null(processor);
    assert_int_equal(color_decoder_create(config, "sRGB - Texture", message, sizeof message, &processor), AG_OK);
    float pixels[256 * 3];
    for (int i = 0; i < 256; i++)
        for (int c = 0; c < 3; c++)
            pixels[3 * i + c] = (float)((i + 85 * c) % 256) / 255.0f;
    assert_int_equal(color_processor_apply(processor, pixels, 256, message, sizeof message), AG_OK);
    for (int i = 0; i < 256; i++)
        for (int c = 0; c < 3; c++) {
            double v = (i + 85 * c) % 256 / 255.0;
            assert_near(pixels[3 * i + c], v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4), 1e-6);
        }
    color_processor_destroy(processor);
    color_config_destroy(config);
}

static int make_folder_without_environment(void **state)
{
    unsetenv("OCIO");
    return make_folder(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_values),
        cmocka_unit_test(defaults_and_names),
        cmocka_unit_test(path_beats_environment_beats_builtin),
        cmocka_unit_test(bad_configs_say_why),
        cmocka_unit_test(unknown_names_list_the_known),
        cmocka_unit_test(config_of_blender_kind),
        cmocka_unit_test(configs_of_aces_kind),
        cmocka_unit_test(exposure_and_looks),
        cmocka_unit_test(working_space_by_name),
        cmocka_unit_test(what_is_made_of_itself_is_refused),
        cmocka_unit_test(missing_tables_are_named),
        cmocka_unit_test(tells_what_there_is),
        cmocka_unit_test(falls_back_to_the_role),
        cmocka_unit_test(bands_have_the_same_bits),
        cmocka_unit_test(agrees_with_oiiotool),
        cmocka_unit_test(decodes_srgb),
    };
    return cmocka_run_group_tests(tests, make_folder_without_environment, remove_folder);
}
