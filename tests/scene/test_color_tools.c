/* test_color_tools.c: every display and view, and looks, as OpenColorIO's and OpenImageIO's own tools show the same
 * EXR: of the config compiled in, of one that works in ACEScg (tests/color/aces.ocio), and of Blender's where it is
 * installed. Flow: tests of scene/color/color_ocio.cpp. Threads: one. */
#define _GNU_SOURCE
#include "color/color.h"
#include "color/color_builtin_config.h"
#include "fixtures/temporary_folder.h"
#include "image/image_reader.h"

#include <glob.h>
#include <math.h>

enum { WIDTH = 16, HEIGHT = 12, VALUES = WIDTH * HEIGHT * 3, VIEWS_MAX = 40 };

typedef struct shown_view {
    char display[64], view[64];
} shown_view;

/* Reads the displays' views as users see them listed. */
static int read_views(const color_config *config, shown_view *views)
{
    char *text, *rest, display[64] = "";
    int count = 0;
    assert_int_equal(color_config_describe(config, message, sizeof message, &text), AG_OK);
    char *line = strstr(text, "displays and their views:\n");
    assert_non_null(line);
    for (line = strtok_r(line, "\n", &rest); (line = strtok_r(NULL, "\n", &rest)) && line[0] == ' ';) {
        char *end = strstr(line, " (default)");
        end = end ? end : strstr(line, ", with the looks ");
        if (end)
            *end = '\0';
        if (strncmp(line, "    ", 4) != 0) {
            snprintf(display, sizeof display, "%.60s", line + 2);
            continue;
        }
        assert_true(count < VIEWS_MAX);
        snprintf(views[count].display, sizeof views[count].display, "%s", display);
        snprintf(views[count++].view, sizeof views[0].view, "%.60s", line + 4);
    }
    free(text);
    return count;
}

static bool has_tool(const char *name)
{
    char command[64];
    snprintf(command, sizeof command, "command -v %s >/dev/null 2>&1", name);
    return system(command) == 0;
}

static void run(const char *command)
{
    if (system(command) != 0)
        fail_msg("failed: %s", command);
}

static image read_picture(const char *name)
{
    image read;
    if (image_read(in_folder(name), &read, message, sizeof message) != AG_OK)
        fail_msg("%s", message);
    assert_int_equal(read.width * read.height, WIDTH * HEIGHT);
    return read;
}

/* A picture with values from below black to far above white, and beyond Rec. 709's gamut. */
static void make_input(const char *config_path)
{
    char command[1024];
    snprintf(command, sizeof command,
             "cd '%s' && oiiotool --colorconfig '%s' --pattern fill:topleft=-0.05,0,0.000004:topright=0.9,0.2,0.05:"
             "bottomleft=0.02,1.5,0.3:bottomright=14,9,90000 %dx%d 3 -d float -o in.exr",
             folder, config_path, WIDTH, HEIGHT);
    run(command);
}

/* Largest distance to what the tool wrote. */
static double compare(const color_config *config, const color_view *view, const char *name)
{
    double worst = 0.0;
    color_processor *processor;
    image ours = read_picture("in.exr"), theirs = read_picture(name);
    if (color_processor_create(config, view, message, sizeof message, &processor) != AG_OK)
        fail_msg("%s", message);
    assert_int_equal(color_processor_apply(processor, ours.pixels, WIDTH * HEIGHT, message, sizeof message), AG_OK);
    assert_int_equal(theirs.channel_count, 3);
    for (int i = 0; i < VALUES; i++) {
        double distance = fabs((double)ours.pixels[i] - (double)theirs.pixels[i]) / fmax(1.0, fabs(theirs.pixels[i]));
        worst = distance <= worst ? worst : distance; /* NaN counts */
    }
    color_processor_destroy(processor);
    image_reset(&ours);
    image_reset(&theirs);
    return worst;
}

static void check_view(const color_config *config, const char *tool, const color_view *view, const char *name)
{
    double worst = compare(config, view, name);
    if (!(worst <= 2e-6))
        fail_msg("%s: %s, %s: off by %g", tool, view->display, view->view, worst);
}

/* All views by oiiotool in one run (its --ociodisplay overlooks looks: it has a word of their own for them); one of
 * each display by ocioconvert, of which each costs half a second. */
static void check_config(const char *config_path, const char *look, const char *look_display, const char *look_view)
{
    shown_view views[VIEWS_MAX];
    char command[16384], path[256];
    color_config *config;
    snprintf(path, sizeof path, "%s", config_path); /* in_folder's do not last */
    if (color_config_create(path, NULL, NULL, message, sizeof message, &config) != AG_OK)
        fail_msg("%s", message);
    const char *space = color_config_working_space(config);
    int count = read_views(config, views);
    assert_true(count >= 5);
    make_input(path);
    int at = snprintf(command, sizeof command, "cd '%s' && oiiotool --colorconfig '%s' in.exr", folder, path);
    for (int i = 0; i < count; i++)
        at += snprintf(command + at, sizeof command - (size_t)at,
                       " --dup --ociodisplay:from='%s' '%s' '%s' -d float -o out%d.exr --pop", space, views[i].display,
                       views[i].view, i);
    at += snprintf(command + at, sizeof command - (size_t)at,
                   " --dup --mulc 2 --ociolook:from='%s':to='%s' '%s' --ociodisplay:from='%s' '%s' '%s' -d float -o "
                   "look.exr --pop",
                   space, space, look, space, look_display, look_view);
    assert_true((size_t)at < sizeof command);
    run(command);
    for (int i = 0; i < count; i++) {
        const color_view view = {.display = views[i].display, .view = views[i].view};
        char name[32];
        snprintf(name, sizeof name, "out%d.exr", i);
        check_view(config, "oiiotool", &view, name);
    }
    const color_view looked = {.display = look_display, .view = look_view, .look = look, .exposure = 1.0f};
    check_view(config, "oiiotool with a look", &looked, "look.exr");
    if (has_tool("ocioconvert")) {
        const color_view view = {.display = views[0].display, .view = views[0].view};
        snprintf(command, sizeof command,
                 "cd '%s' && OCIO='%s' ocioconvert --view in.exr '%s' converted.exr '%s' '%s' >converted.txt 2>&1",
                 folder, path, space, view.display, view.view);
        run(command);
        check_view(config, "ocioconvert", &view, "converted.exr");
    }
    color_config_destroy(config);
}

static void skip_without_tools(void)
{
    if (has_tool("oiiotool"))
        return;
    print_message("SKIPPED: oiiotool (Debian: openimageio-tools) is not installed\n");
    skip();
}

static void config_compiled_in(void **state)
{
    (void)state;
    skip_without_tools();
    FILE *file = fopen(in_folder("builtin.ocio"), "w");
    assert_non_null(file);
    assert_int_equal(fwrite(color_builtin_config, 1, color_builtin_config_size, file), color_builtin_config_size);
    assert_int_equal(fclose(file), 0);
    check_config(in_folder("builtin.ocio"), "ACES 1.3 Reference Gamut Compression", "sRGB - Display",
                 "ACES 1.0 - SDR Video");
}

static void config_of_aces_kind(void **state)
{
    (void)state;
    skip_without_tools();
    check_config(AG_SOURCE_DIR "/tests/color/aces.ocio", "Flat, -Warm", "Cinema", "Film");
}

static void config_of_blender(void **state)
{
    static const char *const PATTERNS[] = {"/usr/share/blender/datafiles/colormanagement/config.ocio",
                                           "/usr/share/blender/*/datafiles/colormanagement/config.ocio"};
    (void)state;
    skip_without_tools();
    glob_t found;
    for (int i = 0; i < 2; i++)
        glob(PATTERNS[i], i > 0 ? GLOB_APPEND : 0, NULL, &found);
    if (found.gl_pathc > 0) {
        check_config(found.gl_pathv[0], "High Contrast", "sRGB", "Filmic");
        globfree(&found);
        return;
    }
    globfree(&found);
    print_message("SKIPPED: Blender's config (Debian: blender-data) is not installed\n");
    skip();
}

static int make_folder_without_environment(void **state)
{
    unsetenv("OCIO");
    return make_folder(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(config_compiled_in, make_folder_without_environment, remove_folder),
        cmocka_unit_test_setup_teardown(config_of_aces_kind, make_folder_without_environment, remove_folder),
        cmocka_unit_test_setup_teardown(config_of_blender, make_folder_without_environment, remove_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
