/* test_program_settings.c: every row of the table of settings reaches --help, the man page, the statistics and, where
 * it is marked so, the header of EXR files. Flow: tests of the whole program. Threads: the program's. */
#define _GNU_SOURCE
#include "fixtures/program_picture.h"
#include "settings_table.h"

#include <ctype.h>

static char *man_page(void)
{
    char path[1024];
    size_t size;
    snprintf(path, sizeof path, "%s/renderer/afterglow.1", getenv("AFTERGLOW_BUILD_DIR"));
    return (char *)read_bytes(path, &size);
}

static void test_help_and_man_page(void **state)
{
    (void)state;
    program_run help = RUN("--help");
    char *page = man_page();
    const ag_setting *setting;
    for (size_t i = 0; (setting = ag_setting_at(i)) != NULL; i++) {
        char in_help[128], in_page[256] = "\n\\fB\\-\\-";
        size_t used = strlen(in_page);
        snprintf(in_help, sizeof in_help, " --%s%s%s ", setting->name, setting->argument ? " " : "",
                 setting->argument ? setting->argument : "");
        for (const char *c = setting->name; *c; c++)
            used += (size_t)snprintf(in_page + used, sizeof in_page - used, "%s%c", *c == '-' ? "\\" : "", *c);
        snprintf(in_page + used, sizeof in_page - used, "\\fR");
        if (!strstr(help.out, in_help))
            fail_msg("--help does not tell of '%s'", in_help);
        if (!strstr(page, in_page))
            fail_msg("the man page does not tell of '%s'", in_page);
    }
    assert_null(strstr(page, "%OPTIONS%"));
    assert_null(strstr(page, "%PHOTON_MAP"));
    free(page);
    program_run_reset(&help);
}

/* "settings.pane_light" is noted as "afterglow/paneLight". */
static void attribute_name(const char *json, char *out)
{
    const char *dot = strchr(json, '.');
    out += sprintf(out, "afterglow/");
    for (const char *c = dot ? dot + 1 : json; *c; c++)
        if (*c != '_')
            *out++ = c > json && c[-1] == '_' ? (char)toupper((unsigned char)*c) : *c;
    *out = '\0';
}

static void test_statistics_and_header(void **state)
{
    (void)state;
    program_run run = RUN("-q", "--photons=300", "--caustic-photons=20", "--spp=1", "--gather-samples=2", "--size=8x6",
                          "--aov=Z,light", "--nearest=31", "--max-depth=7", "--photon-aim=0.25", "--seed=12",
                          "--pane-light=traced", "--stats=a.json", "-o", "a.exr", PROGRAM_SCENES "sphere.pbrt");
    expect_exit(&run, 0);
    program_run_reset(&run);
    json_t *stats = stats_read(in_folder("a.json"));
    size_t size;
    unsigned char *file = read_bytes(in_folder("a.exr"), &size);
    const setting_row *row;
    for (size_t i = 0; (row = setting_at(i)) != NULL; i++) {
        char attribute[128];
        if (row->json && row->kind != SETTING_SIZE)
            assert_non_null(stats_find(stats, row->json)); /* says itself which is missing */
        if (!(row->marks & SETTING_IN_HEADER))
            continue;
        attribute_name(row->json, attribute);
        if (!memmem(file, size, attribute, strlen(attribute) + 1))
            fail_msg("the file has no attribute '%s'", attribute);
    }
    assert_int_equal(stats_integer(stats, "image.width"), 8);
    assert_int_equal(stats_integer(stats, "image.height"), 6);
    assert_int_equal(stats_integer(stats, "seed"), 12);
    assert_int_equal(stats_integer(stats, "settings.photon_count"), 300);
    assert_int_equal(stats_integer(stats, "settings.nearest"), 31);
    assert_true(json_real_value(stats_find(stats, "settings.photon_aim")) == 0.25);
    assert_string_equal(json_string_value(stats_find(stats, "settings.pane_light")), "traced");
    assert_true(json_is_false(stats_find(stats, "settings.denoise")));
    assert_int_equal(json_array_size(stats_find(stats, "settings.layers")), 6);
    assert_string_equal(json_string_value(json_array_get(stats_find(stats, "settings.layers"), 0)), "Z");
    free(file);
    json_decref(stats);
}

static void expect_photons(json_int_t global, json_int_t caustic, const char *const *arguments)
{
    program_run run = program_execute(NULL, arguments);
    expect_exit(&run, 0);
    program_run_reset(&run);
    json_t *stats = stats_read(in_folder("n.json"));
    assert_int_equal(stats_integer(stats, "settings.photon_count"), global);
    assert_int_equal(stats_integer(stats, "settings.caustic_photon_count"), caustic);
    assert_int_equal(stats_integer(stats, "photons.stored_global"), global);
    json_decref(stats);
}

#define EXPECT_PHOTONS_OF(scene, global, caustic, ...)                                                                 \
    expect_photons(                                                                                                    \
        global, caustic,                                                                                               \
        ARGUMENTS("-q", "--gather-samples=1", "--stats=n.json", "-o", "n.exr", __VA_ARGS__, PROGRAM_SCENES scene))
#define EXPECT_PHOTONS(global, caustic, ...) EXPECT_PHOTONS_OF("sphere.pbrt", global, caustic, __VA_ARGS__)

/* The whole frame's camera samples decide, not those of a crop; a kept map is not of one picture alone. Of a floor in
 * the open no gather ray meets anything. */
static void test_photons_by_samples(void **state)
{
    (void)state;
    EXPECT_PHOTONS(131072, 65536, "--spp=1", "--size=8x6");
    EXPECT_PHOTONS(160000, 80000, "--spp=8", "--size=100x100", "--cropwindow=0,0.1,0,0.1");
    EXPECT_PHOTONS(192000, 96000, "--noise=1", "--spp=1024", "--size=100x60", "--cropwindow=0,0.1,0,0.1");
    EXPECT_PHOTONS(240000, 120000, "--noise=1", "--min-spp=20", "--size=100x60", "--cropwindow=0,0.1,0,0.1");
    EXPECT_PHOTONS(144000, 72000, "--noise=1", "--spp=12", "--size=100x60", "--cropwindow=0,0.1,0,0.1");
    EXPECT_PHOTONS(1000000, 500000, "--spp=1024", "--size=100x100", "--cropwindow=0,0.02,0,0.02");
    EXPECT_PHOTONS(1000000, 500000, "--spp=1", "--size=8x6", "--photon-map=n.map");
    EXPECT_PHOTONS(700, 65536, "--spp=1", "--size=8x6", "--photons=700");
    EXPECT_PHOTONS_OF("lamp_point.pbrt", 16384, 80000, "--spp=8", "--size=100x100", "--cropwindow=0,0.1,0,0.1");
    EXPECT_PHOTONS_OF("lamp_point.pbrt", 700, 80000, "--spp=8", "--size=100x100", "--photons=700");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(test_help_and_man_page),
        TEST_IN_FOLDER(test_statistics_and_header),
        TEST_IN_FOLDER(test_photons_by_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
