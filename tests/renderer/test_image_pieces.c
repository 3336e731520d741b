/* test_image_pieces.c: pictures are read in pieces, to the values that were written, and reading ends before the next
 * piece once that is asked for. Flow: tests of scene/image/image_oiio.cpp, image_reader.c. Threads: one. */
#define _GNU_SOURCE
#include "fixtures/image_file_fixture.h"
#include "image/image_module_loader.h"

#include <math.h>

enum {
    WIDE = 901,
    HIGH = 1203,
    VALUES = WIDE * HIGH * 3,
    PIECE_MOST = 1 << 20 /* bytes; the files' blocks are smaller */
};

/* How often reading asks whether to end, and the time when it is told so; 0: never. */
typedef struct listener {
    int asked, ends_at;
} listener;

static bool count_and_end(const void *user)
{
    listener *l = *(listener *const *)user;
    return ++l->asked == l->ends_at;
}

static ag_status decode(const char *name, int ends_at, listener *l, image *out_image)
{
    const image_module *module = image_module_get(message, sizeof message);
    assert_non_null(module);
    *l = (listener){.ends_at = ends_at};
    const image_request request = {.wish = IMAGE_COLORS, .is_cancelled = count_and_end, .user = &l};
    const char *path = in_folder(name);
    return module->decode(path, path, &request, out_image, message, sizeof message);
}

/* Different in each row and column, and whole parts of 255. */
static float *make_pixels(void)
{
    float *pixels = malloc(VALUES * sizeof *pixels);
    assert_non_null(pixels);
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++)
            for (int c = 0; c < 3; c++) {
                const uint32_t mixed = (uint32_t)(y * WIDE + x) * 2654435761u + (uint32_t)c * 40503u;
                pixels[(y * WIDE + x) * 3 + c] = (float)((mixed >> 16) % 256) * (1.0f / 255.0f);
            }
    return pixels;
}

static void run_tool(const char *arguments)
{
    char command[512];
    snprintf(command, sizeof command, "cd '%s' && oiiotool %s", folder, arguments);
    assert_int_equal(system(command), 0);
}

static void expect_pieces(const char *name, const float *expected, size_t stored_value_bytes, float tolerance)
{
    listener l;
    image read;
    if (decode(name, 0, &l, &read) != AG_OK)
        fail_msg("%s: %s", name, message);
    assert_int_equal(read.width, WIDE);
    assert_int_equal(read.height, HIGH);
    assert_int_equal(read.channel_count, 3);
    for (size_t i = 0; i < VALUES; i++)
        if (!(fabsf(read.pixels[i] - expected[i]) <= tolerance))
            fail_msg("%s: value %zu is %g, not %g", name, i, (double)read.pixels[i], (double)expected[i]);
    image_reset(&read);
    const int count = l.asked, least = 2 + (int)(VALUES * stored_value_bytes / PIECE_MOST);
    if (count < least)
        fail_msg("%s: it was asked %d times whether to end, not %d", name, count, least);
    const int ends[] = {1, count / 2, count};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        assert_int_equal(decode(name, ends[i], &l, &read), AG_CANCELLED);
        assert_int_equal(l.asked, ends[i]);
        assert_string_equal(message, "");
        assert_null(read.pixels);
    }
}

static void pieces_make_the_whole(void **state)
{
    (void)state;
    float *pixels = make_pixels();
    image_description description = describe(3, IMAGE_FLOAT);
    description.width = WIDE;
    description.height = HIGH;
    description.full_width = WIDE + 40;
    description.full_height = HIGH + 70;
    description.x = 7;
    description.y = 61;
    write_picture(in_folder("lines.exr"), &description, pixels);
    description.is_tiled = true;
    write_picture(in_folder("tiles.exr"), &description, pixels);
    description = describe(3, IMAGE_UINT8);
    description.width = description.full_width = WIDE;
    description.height = description.full_height = HIGH;
    write_picture(in_folder("a.png"), &description, pixels);
    write_picture(in_folder("a.tif"), &description, pixels);
    run_tool("a.tif --compression lzw --planarconfig separate -o apart.tif");
    run_tool("a.tif --compression zip --attrib tiff:RowsPerStrip 64 -o strips.tif");
    run_tool("a.tif --compression lzw --tile 64 32 -o tiles.tif");
    run_tool("a.tif -d float --compression zip --attrib tiff:RowsPerStrip 1203 -o strip.tif");
    expect_pieces("lines.exr", pixels, sizeof(float), 0.0f);
    expect_pieces("tiles.exr", pixels, sizeof(float), 0.0f);
    expect_pieces("a.png", pixels, 1, 1e-7f);
    expect_pieces("a.tif", pixels, 1, 1e-7f);
    expect_pieces("apart.tif", pixels, 1, 1e-7f);
    expect_pieces("strips.tif", pixels, 1, 1e-7f);
    expect_pieces("tiles.tif", pixels, 1, 1e-7f);
    expect_pieces("strip.tif", pixels, sizeof(float), 1e-7f);
    free(pixels);
}

/* Each way by which scenes read pictures asks the run. */
static void runs_end_reading(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"a.png", "a.exr", "a.tif", "a.jpg"};
    float pixels[WIDTH * HEIGHT * 3];
    fill(pixels, 3);
    run_context run;
    run_context_init(&run, NULL, NULL, NULL, NULL);
    for (int cancelled = 0; cancelled < 2; cancelled++) {
        const ag_status expected = cancelled ? AG_CANCELLED : AG_OK;
        if (cancelled)
            run_cancel(&run);
        for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++) {
            const image_description description = describe(3, i == 1 ? IMAGE_HALF : IMAGE_UINT8);
            image read;
            size_t size;
            write_picture(in_folder(NAMES[i]), &description, pixels);
            assert_int_equal(image_read_compact(&run, in_folder(NAMES[i]), &read, message, sizeof message), expected);
            image_reset(&read);
            assert_int_equal(image_read_colors(&run, in_folder(NAMES[i]), &read, message, sizeof message), expected);
            image_reset(&read);
            if (i == 1 || i == 2)
                continue;
            unsigned char *bytes = read_bytes(in_folder(NAMES[i]), &size);
            assert_int_equal(image_read_memory(&run, "picture", bytes, size, &read, message, sizeof message), expected);
            image_reset(&read);
            free(bytes);
        }
    }
    run_context_reset(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(pieces_make_the_whole),
        TEST_IN_FOLDER(runs_end_reading),
    };
    image_module_get(message,
                     sizeof message); /* opened after a picture was written, it crashes GCC 12's leak checker */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
