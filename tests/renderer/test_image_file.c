/* test_image_file.c: pictures to disk and back, and what their headers say.
 * Flow: tests of renderer/output/image_file.c, image_openexr.c, and of scene/image/image_reader.c, image_oiio.cpp.
 * Threads: one. */
#define _GNU_SOURCE
#include "clock.h"
#include "fixtures/image_file_fixture.h"
#include "image/image_module_loader.h"
#include "math/rng.h"

#include <float.h>
#include <math.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static void formats_by_extension(void **state)
{
    (void)state;
    assert_true(image_format_of("a/b.exr")->scene_linear);
    assert_int_equal(image_format_of("x.EXR")->default_type, IMAGE_HALF);
    assert_false(image_format_of("x.Png")->scene_linear);
    assert_string_equal(image_format_of("x.y.tiff")->extension, "tiff");
    assert_non_null(image_format_of("x.jpeg"));
    static const char *const unknown[] = {"x", "x.", "x.gif", "x.exr/y", ".png", "x.exr2", "x.ex", "", "a.b/c"};
    for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++)
        assert_null(image_format_of(unknown[i]));

    /* rows: exr, png, tif, jpg; columns: 8, 16, half, float */
    static const char *const names[] = {"x.exr", "x.png", "x.tif", "x.jpg"};
    static const bool can[4][4] = {{0, 0, 1, 1}, {1, 1, 0, 0}, {1, 1, 0, 1}, {1, 0, 0, 0}};
    for (int f = 0; f < 4; f++)
        for (int t = 0; t < 4; t++)
            assert_int_equal(image_format_can_hold(image_format_of(names[f]), (image_sample_type)t), can[f][t]);
}

static void bad_requests(void **state)
{
    (void)state;
    float pixels[WIDTH * HEIGHT * 5];
    fill(pixels, 5);
    image_description description = describe(3, IMAGE_UINT8);
    expect_failure(image_file_write(NULL, in_folder("x.gif"), &description, pixels, message, sizeof message),
                   AG_ERROR_OUTPUT, ".exr, .hdr, .pfm, .png");
    expect_failure(image_file_write(NULL, in_folder("x.exr"), &description, pixels, message, sizeof message),
                   AG_ERROR_OUTPUT, "8-bit");
    description = describe(3, IMAGE_FLOAT);
    expect_failure(image_file_write(NULL, in_folder("x.png"), &description, pixels, message, sizeof message),
                   AG_ERROR_OUTPUT, "float");
    description = describe(5, IMAGE_UINT8);
    expect_failure(image_file_write(NULL, in_folder("x.png"), &description, pixels, message, sizeof message),
                   AG_ERROR_OUTPUT, "5 channels");
    description = describe(3, IMAGE_UINT8);
    description.width = 0;
    expect_failure(image_file_write(NULL, in_folder("x.png"), &description, pixels, message, sizeof message),
                   AG_ERROR_ARGUMENT, "not valid");
    assert_int_equal(entry_count(), 0);
}

static void libjpeg_cannot_end_the_process(void **state)
{
    (void)state;
    image_description description = describe(3, IMAGE_UINT8);
    description.width = description.full_width = 65501;
    description.height = description.full_height = 1;
    float *pixels = calloc(65501 * 3, sizeof *pixels);
    char *long_text = malloc(200001);
    assert_true(pixels && long_text);
    expect_failure(image_file_write(NULL, in_folder("x.jpg"), &description, pixels, message, sizeof message),
                   AG_ERROR_OUTPUT, "65500");
    assert_int_equal(entry_count(), 0);

    memset(long_text, 'x', 200000);
    long_text[200000] = '\0';
    const image_attribute attributes[] = {{"Artist", "somebody", NULL, 0}, {"ImageDescription", long_text, NULL, 0}};
    description = describe(3, IMAGE_UINT8);
    description.attributes = attributes;
    description.attribute_count = 2;
    write_picture(in_folder("x.jpg"), &description, pixels);
    size_t size;
    unsigned char *bytes = read_bytes(in_folder("x.jpg"), &size);
    assert_true(holds(bytes, size, "somebody"));
    assert_true(size < 20000);
    free(bytes);
    free(long_text);
    free(pixels);
}

static void round_trips(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        image_sample_type type;
        int channel_count, read_channel_count;
        double tolerance;
    } cases[] = {
        {"rgb_half.exr", IMAGE_HALF, 3, 3, 0.5 / 2048}, {"rgb.exr", IMAGE_FLOAT, 3, 3, 0.0},
        {"rgba.exr", IMAGE_FLOAT, 4, 4, 0.0},           {"many.exr", IMAGE_FLOAT, 8, 8, 0.0},
        {"8.png", IMAGE_UINT8, 3, 3, 0.501 / 255},      {"16.png", IMAGE_UINT16, 3, 3, 0.501 / 65535},
        {"rgba.png", IMAGE_UINT8, 4, 4, 0.501 / 255},   {"8.tif", IMAGE_UINT8, 3, 3, 0.501 / 255},
        {"16.tiff", IMAGE_UINT16, 4, 4, 0.501 / 65535}, {"float.tif", IMAGE_FLOAT, 3, 3, 0.0},
        {"rgb.jpg", IMAGE_UINT8, 3, 3, 3.0 / 255},      {"rgba.jpeg", IMAGE_UINT8, 4, 3, 3.0 / 255},
    };
    float pixels[WIDTH * HEIGHT * CHANNEL_LIMIT];
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const image_description description = describe(cases[k].channel_count, cases[k].type);
        fill(pixels, cases[k].channel_count);
        write_picture(in_folder(cases[k].name), &description, pixels);
        float *back = read_picture(in_folder(cases[k].name), WIDTH, HEIGHT, cases[k].read_channel_count);
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            for (int c = 0; c < cases[k].read_channel_count; c++) {
                const double error = fabs((double)back[i * cases[k].read_channel_count + c] -
                                          (double)pixels[i * cases[k].channel_count + c]);
                if (!(error <= cases[k].tolerance))
                    print_error("%s: pixel %d channel %d is off by %g\n", cases[k].name, i, c, error);
                assert_true(error <= cases[k].tolerance);
            }
        free(back);
    }
    assert_int_equal(entry_count(), (int)(sizeof cases / sizeof *cases)); /* no temporary file is left */
}

static void integers_are_rounded_and_clamped(void **state)
{
    (void)state;
    const float pixels[] = {-1.0f, 0.5f, 7.0f};
    image_description description = describe(3, IMAGE_UINT8);
    description.width = description.height = description.full_width = description.full_height = 1;
    write_picture(in_folder("x.png"), &description, pixels);
    float *back = read_picture(in_folder("x.png"), 1, 1, 3);
    assert_true(back[0] == 0.0f && back[1] == 128.0f / 255.0f && back[2] == 1.0f);
    free(back);
}

static void half_is_clamped_float_is_not(void **state)
{
    (void)state;
    const float pixels[] = {1e6f, -1e9f, 65519.0f, 6e-8f, 0.0f, 1.0f};
    image_description description = describe(3, IMAGE_HALF);
    description.width = description.full_width = 2;
    description.height = description.full_height = 1;
    write_picture(in_folder("half.exr"), &description, pixels);
    float *back = read_picture(in_folder("half.exr"), 2, 1, 3);
    assert_true(back[0] == 65504.0f && back[1] == -65504.0f && back[2] == 65504.0f);
    assert_true(back[3] > 0.0f && back[4] == 0.0f && back[5] == 1.0f);
    free(back);
    description.type = IMAGE_FLOAT;
    write_picture(in_folder("float.exr"), &description, pixels);
    back = read_picture(in_folder("float.exr"), 2, 1, 3);
    assert_memory_equal(back, pixels, sizeof pixels);
    free(back);
}

/* The half that is nearest, of two as near the even one; in the range of normal halves. */
static float rounded_to_half(float value)
{
    int exponent;
    frexpf(value, &exponent);
    return ldexpf(rintf(ldexpf(value, 11 - exponent)), exponent - 11);
}

/* Another order than the file's, names that are too long for old files, and both types in one file; sizes that end
 * within a block of 16 lines or within a tile, or with it. */
static void exr_keeps_every_value(void **state)
{
    (void)state;
    enum { CHANNELS = 6, SIDE_LIMIT = 130 };
    static const char *const names[CHANNELS] = {"R", "G", "B", "light_of_a_name_that_is_longer_than_31.R", "Z", "A"};
    static const image_sample_type types[CHANNELS] = {IMAGE_HALF,  IMAGE_FLOAT, IMAGE_HALF,
                                                      IMAGE_FLOAT, IMAGE_FLOAT, IMAGE_HALF};
    static const int readers_order[CHANNELS] = {0, 1, 2, 5, 4, 3}; /* OpenImageIO's: R, G, B, A and Z come first */
    static const int sizes[][2] = {{1, 1}, {65, 3}, {64, 64}, {3, 16}, {17, 33}, {130, 129}};
    float *pixels = malloc(SIDE_LIMIT * SIDE_LIMIT * CHANNELS * sizeof *pixels);
    assert_non_null(pixels);
    uint32_t noise = 1;
    for (int i = 0; i < SIDE_LIMIT * SIDE_LIMIT * CHANNELS; i++) {
        noise = noise * 1664525u + 1013904223u;
        pixels[i] = ldexpf((float)(noise >> 8) * 0x1p-24f - 0.5f, (int)(noise & 7u)) + 200.0f;
    }
    for (size_t k = 0; k < 2 * sizeof sizes / sizeof *sizes; k++) {
        const int width = sizes[k / 2][0], height = sizes[k / 2][1];
        const image_description description = {.width = width,
                                               .height = height,
                                               .x = 5,
                                               .y = 7,
                                               .full_width = 200,
                                               .full_height = 150,
                                               .channel_count = CHANNELS,
                                               .channel_names = names,
                                               .type = IMAGE_HALF,
                                               .channel_types = types,
                                               .is_tiled = k % 2 != 0};
        write_picture(in_folder("x.exr"), &description, pixels);
        float *back = read_picture(in_folder("x.exr"), width, height, CHANNELS);
        for (int i = 0; i < width * height; i++)
            for (int c = 0; c < CHANNELS; c++) {
                const int from = readers_order[c];
                const float value = pixels[i * CHANNELS + from];
                assert_true(back[i * CHANNELS + c] == (types[from] == IMAGE_HALF ? rounded_to_half(value) : value));
            }
        free(back);
        size_t size, value_size;
        unsigned char *bytes = read_bytes(in_folder("x.exr"), &size);
        assert_int_equal(exr_attribute(bytes, "tiles", "tiledesc", &value_size) != NULL, description.is_tiled);
        free(bytes);
    }
    free(pixels);
}

/* Pictures that hardly compress: of many, some come out of compression as long as they went in, and then must not be
 * kept compressed, for a chunk of that length is read as it stands. */
static void exr_keeps_what_hardly_compresses(void **state)
{
    (void)state;
    enum { PICTURES = 300, VALUES = 3 * 9 * 5 };
    image_description d = describe(3, IMAGE_FLOAT);
    d.width = d.full_width = 9;
    d.height = d.full_height = 5;
    const char *path = in_folder("noise.exr");
    rng random = rng_make(7, 0, 0);
    for (int i = 0; i < PICTURES; i++) {
        float pixels[VALUES];
        for (int k = 0; k < VALUES; k++)
            pixels[k] = k < i % 20 ? 0.0f : rng_float(&random);
        write_picture(path, &d, pixels);
        float *read = read_picture(path, 9, 5, 3);
        assert_memory_equal(read, pixels, sizeof pixels);
        free(read);
    }
}

static void crops_keep_their_windows(void **state)
{
    (void)state;
    float pixels[WIDTH * HEIGHT * 3];
    fill(pixels, 3);
    image_description description = describe(3, IMAGE_FLOAT);
    description.x = 100;
    description.y = 50;
    description.full_width = 640;
    description.full_height = 480;
    write_picture(in_folder("crop.exr"), &description, pixels);
    size_t size;
    unsigned char *bytes = read_bytes(in_folder("crop.exr"), &size);
    expect_window(bytes, "dataWindow", 100, 50, 100 + WIDTH - 1, 50 + HEIGHT - 1);
    expect_window(bytes, "displayWindow", 0, 0, 639, 479);
    free(bytes);

    /* The others have no display window to speak of; the pixels must be right all the same. */
    static const struct {
        const char *name;
        image_sample_type type;
    } others[] = {
        {"crop.exr", IMAGE_FLOAT}, {"crop.png", IMAGE_UINT8}, {"crop.tif", IMAGE_FLOAT}, {"crop.jpg", IMAGE_UINT8}};
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        description.type = others[k].type;
        write_picture(in_folder(others[k].name), &description, pixels);
        float *back = read_picture(in_folder(others[k].name), WIDTH, HEIGHT, 3);
        for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
            assert_true(fabsf(back[i] - pixels[i]) <= 3.0f / 255.0f);
        free(back);
    }
}

static void attributes_reach_the_header(void **state)
{
    (void)state;
    static const float chromaticities[] = {0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    static const float seed = 17.0f;
    const image_attribute attributes[] = {{"afterglow:scene", "rooms/33.pbrt", NULL, 0},
                                          {"render:seed", NULL, &seed, 1},
                                          {"chromaticities", NULL, chromaticities, 8},
                                          {"DateTime", "2004:06:01 12:00:00", NULL, 0}};
    float pixels[WIDTH * HEIGHT * 3];
    fill(pixels, 3);
    image_description description = describe(3, IMAGE_HALF);
    description.attributes = attributes;
    description.attribute_count = 4;
    write_picture(in_folder("x.exr"), &description, pixels);
    size_t file_size, size;
    unsigned char *bytes = read_bytes(in_folder("x.exr"), &file_size);
    const unsigned char *value = exr_attribute(bytes, "afterglow:scene", "string", &size);
    assert_non_null(value);
    assert_int_equal(size, 13);
    assert_memory_equal(value, "rooms/33.pbrt", 13);
    value = exr_attribute(bytes, "render:seed", "float", &size);
    assert_non_null(value);
    assert_memory_equal(value, &seed, sizeof seed);
    value = exr_attribute(bytes, "chromaticities", "chromaticities", &size);
    assert_non_null(value);
    assert_memory_equal(value, chromaticities, sizeof chromaticities);
    value = exr_attribute(bytes, "capDate", "string", &size);
    assert_non_null(value);
    assert_memory_equal(value, "2004:06:01 12:00:00", 19);
    value = exr_attribute(bytes, "compression", "compression", &size);
    assert_non_null(value);
    assert_int_equal(*value, 3); /* ZIP, 16 rows */
    free(bytes);

    description.type = IMAGE_UINT8;
    description.color_space = "sRGB";
    write_picture(in_folder("x.png"), &description, pixels);
    bytes = read_bytes(in_folder("x.png"), &file_size);
    assert_true(holds(bytes, file_size, "sRGB"));
    assert_true(holds(bytes, file_size, "rooms/33.pbrt"));
    free(bytes);
}

/* Every component of the frame header samples each pixel. */
static void jpeg_keeps_all_colour(void **state)
{
    (void)state;
    float pixels[WIDTH * HEIGHT * 3];
    fill(pixels, 3);
    const image_description description = describe(3, IMAGE_UINT8);
    write_picture(in_folder("x.jpg"), &description, pixels);
    size_t size;
    unsigned char *bytes = read_bytes(in_folder("x.jpg"), &size);
    size_t at = 2;
    while (at + 18 < size && bytes[at] == 0xff && bytes[at + 1] != 0xc0)
        at += 2u + (size_t)bytes[at + 2] * 256u + bytes[at + 3];
    assert_int_equal(bytes[at + 1], 0xc0);
    assert_int_equal(bytes[at + 9], 3);
    for (size_t c = 0; c < 3; c++)
        assert_int_equal(bytes[at + 11 + 3 * c], 0x11);
    free(bytes);
}

static void equal_pictures_give_equal_bytes(void **state)
{
    (void)state;
    static const char *const names[] = {"x.exr", "x.png", "x.tif", "x.jpg"};
    float pixels[WIDTH * HEIGHT * 3];
    char today[32], iso_today[32];
    const time_t now = time(NULL);
    struct tm local;
    assert_non_null(localtime_r(&now, &local));
    strftime(today, sizeof today, "%Y:%m:%d", &local);
    strftime(iso_today, sizeof iso_today, "%Y-%m-%d", &local);
    fill(pixels, 3);
    for (size_t k = 0; k < 4; k++) {
        const image_description description = describe(3, image_format_of(names[k])->default_type);
        size_t first_size, second_size;
        write_picture(in_folder(names[k]), &description, pixels);
        unsigned char *first = read_bytes(in_folder(names[k]), &first_size);
        write_picture(in_folder(names[k]), &description, pixels);
        unsigned char *second = read_bytes(in_folder(names[k]), &second_size);
        assert_int_equal(first_size, second_size);
        assert_memory_equal(first, second, first_size);
        /* Both may have been written within a second: there must be no date in them at all. */
        assert_false(holds(first, first_size, "capDate") || holds(first, first_size, "tIME"));
        assert_false(holds(first, first_size, "DateTime"));
        assert_false(holds(first, first_size, today) || holds(first, first_size, iso_today));
        free(first);
        free(second);
    }
}

static void broken_pictures_are_errors(void **state)
{
    (void)state;
    image back;
    float pixels[WIDTH * HEIGHT * 3];
    fill(pixels, 3);
    expect_failure(image_read(in_folder("none.exr"), &back, message, sizeof message), AG_ERROR_INPUT, "none.exr");
    assert_null(back.pixels);
    const image_description description = describe(3, IMAGE_FLOAT);
    write_picture(in_folder("x.exr"), &description, pixels);
    struct stat status;
    assert_int_equal(stat(in_folder("x.exr"), &status), 0);
    assert_int_equal(truncate(in_folder("x.exr"), status.st_size / 2), 0);
    expect_failure(image_read(in_folder("x.exr"), &back, message, sizeof message), AG_ERROR_INPUT, "x.exr");
    assert_null(back.pixels);
    expect_failure(image_read_compact(NULL, in_folder("x.exr"), &back, message, sizeof message), AG_ERROR_INPUT,
                   "x.exr");
    assert_null(back.bytes);
}

/* OpenImageIO's reader of medical pictures reads bytes of any kind one by one, which takes a minute for these. */
static void large_files_that_are_no_pictures_are_refused_at_once(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"zeros.exr", "zeros.dcm", "zeros.tga", "zeros"};
    for (size_t i = 0; i < sizeof NAMES / sizeof NAMES[0]; i++) {
        image back;
        const char *name = in_folder(NAMES[i]);
        FILE *file = fopen(name, "wb");
        assert_non_null(file);
        assert_int_equal(ftruncate(fileno(file), (off_t)256 << 20), 0);
        assert_int_equal(fclose(file), 0);
        const double begin = clock_thread_cpu_seconds();
        expect_failure(image_read(name, &back, message, sizeof message), AG_ERROR_INPUT, NAMES[i]);
        assert_true(clock_thread_cpu_seconds() - begin < 5.0);
        assert_null(back.pixels);
        assert_int_equal(unlink(name), 0);
    }
}

/* A picture is known by its bytes, whatever its name is. */
static void pictures_under_other_names(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"a.png", "a.tif", "a.jpg", "a.exr"}, *const OTHERS[] = {"b.exr", "b", "b.tga"};
    float pixels[WIDTH * HEIGHT * 3];
    fill(pixels, 3);
    for (size_t i = 0; i < sizeof NAMES / sizeof NAMES[0]; i++) {
        image own, other;
        const image_description description = describe(3, i == 3 ? IMAGE_HALF : IMAGE_UINT8);
        write_picture(in_folder(NAMES[i]), &description, pixels);
        assert_int_equal(image_read(in_folder(NAMES[i]), &own, message, sizeof message), AG_OK);
        for (size_t k = 0; k < sizeof OTHERS / sizeof OTHERS[0]; k++) {
            assert_int_equal(rename(in_folder(k == 0 ? NAMES[i] : OTHERS[k - 1]), in_folder(OTHERS[k])), 0);
            assert_int_equal(image_read(in_folder(OTHERS[k]), &other, message, sizeof message), AG_OK);
            assert_memory_equal(other.pixels, own.pixels, sizeof pixels);
            image_reset(&other);
        }
        image_reset(&own);
    }
}

/* The reader tells what a file holds, keeps bytes as bytes where that is wished, and does not multiply by alpha. */
static void values_are_as_stored(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        image_sample_type type;
    } kinds[] = {{"a.png", IMAGE_UINT8}, {"b.png", IMAGE_UINT16}, {"c.exr", IMAGE_HALF}, {"d.exr", IMAGE_FLOAT}};
    static const float pixels[4 * 4] = {1.0f, 0.4f, 0.0f, 1.0f, 0.2f, 0.4f, 0.6f, 1.0f,
                                        0.0f, 1.0f, 0.8f, 1.0f, 0.8f, 0.6f, 0.2f, 1.0f};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        image_description description = describe(4, kinds[k].type);
        description.width = description.full_width = 4;
        description.height = description.full_height = 1;
        write_picture(in_folder(kinds[k].name), &description, pixels);
        for (int compact = 0; compact < 2; compact++) {
            image read;
            assert_int_equal(compact
                                 ? image_read_compact(NULL, in_folder(kinds[k].name), &read, message, sizeof message)
                                 : image_read(in_folder(kinds[k].name), &read, message, sizeof message),
                             AG_OK);
            assert_int_equal(read.type, kinds[k].type);
            const bool is_bytes = compact && kinds[k].type == IMAGE_UINT8;
            assert_int_equal(read.bytes != NULL, is_bytes);
            assert_int_equal(read.pixels != NULL, !is_bytes);
            for (int i = 0; i < 16; i++) {
                const float value = is_bytes ? (float)read.bytes[i] / 255.0f : read.pixels[i];
                assert_true(fabsf(value - pixels[i]) < (kinds[k].type == IMAGE_HALF ? 5e-4f : 1e-6f));
            }
            image_reset(&read);
            assert_null(read.bytes);
        }
    }
    /* a colour that is there where alpha is 0 */
    char command[512];
    snprintf(command, sizeof command,
             "cd '%s' && oiiotool --no-autopremult --create 1x1 4 --fill:color=1,0.501961,0,0 1x1 -d uint8 "
             "--attrib oiio:UnassociatedAlpha 1 -o alpha.png",
             folder);
    assert_int_equal(system(command), 0);
    image read;
    assert_int_equal(image_read_compact(NULL, in_folder("alpha.png"), &read, message, sizeof message), AG_OK);
    const unsigned char expected[] = {255, 128, 0, 0};
    assert_int_equal(read.channel_count, 4);
    assert_memory_equal(read.bytes, expected, sizeof expected);
    image_reset(&read);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(formats_by_extension),
        TEST_IN_FOLDER(bad_requests),
        TEST_IN_FOLDER(libjpeg_cannot_end_the_process),
        TEST_IN_FOLDER(round_trips),
        TEST_IN_FOLDER(integers_are_rounded_and_clamped),
        TEST_IN_FOLDER(half_is_clamped_float_is_not),
        TEST_IN_FOLDER(exr_keeps_every_value),
        TEST_IN_FOLDER(exr_keeps_what_hardly_compresses),
        TEST_IN_FOLDER(crops_keep_their_windows),
        TEST_IN_FOLDER(attributes_reach_the_header),
        TEST_IN_FOLDER(jpeg_keeps_all_colour),
        TEST_IN_FOLDER(equal_pictures_give_equal_bytes),
        TEST_IN_FOLDER(broken_pictures_are_errors),
        TEST_IN_FOLDER(large_files_that_are_no_pictures_are_refused_at_once),
        TEST_IN_FOLDER(pictures_under_other_names),
        TEST_IN_FOLDER(values_are_as_stored),
    };
    image_module_get(message,
                     sizeof message); /* opened after a picture was written, it crashes GCC 12's leak checker */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
