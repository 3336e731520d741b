/* test_color.c: the colour bridge against known values and oiiotool, and which config it takes.
 * Flow: tests of scene/color/color_ocio.cpp and scene/color/config.ocio. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/color_fixture.h"

#include "color/color_builtin_config.h"
#include "image/image_reader.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_values),
        cmocka_unit_test(defaults_and_names),
        cmocka_unit_test(path_beats_environment_beats_builtin),
        cmocka_unit_test(exposure_and_looks),
        cmocka_unit_test(tells_what_there_is),
        cmocka_unit_test(bands_have_the_same_bits),
        cmocka_unit_test(agrees_with_oiiotool),
        cmocka_unit_test(decodes_srgb),
    };
    return cmocka_run_group_tests(tests, make_folder_without_environment, remove_folder);
}
