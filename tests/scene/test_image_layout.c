/* test_image_layout.c: which channels of a file are its picture, how many rows OpenEXR packs together, which tiles are
 * read one by one, which levels are halves. Flow: tests of scene/image/image_layout.c. Threads: one. */
#include "image/image_layout.h"
#include "texture/texture_store.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void expect_colors(int colors, int first, int count, const char *const *names)
{
    int begin = -1;
    assert_int_equal(image_layout_find_colors(names, count, &begin), colors);
    assert_int_equal(begin, first);
}

#define EXPECT_COLORS(colors, first, ...)                                                                              \
    expect_colors(colors, first, (int)(sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *)),                   \
                  (const char *const[]){__VA_ARGS__})

static void colors_are_those_of_one_layer(void **state)
{
    (void)state;
    EXPECT_COLORS(3, 0, "R", "G", "B");
    EXPECT_COLORS(4, 0, "R", "G", "B", "A", "Z");
    EXPECT_COLORS(4, 1, "Z", "red", "green", "blue", "alpha");
    EXPECT_COLORS(3, 2, "depth.Z", "depth.A", "beauty.R", "beauty.G", "beauty.B", "other.A");
    EXPECT_COLORS(0, 0, "one.R", "two.G", "three.B");
    EXPECT_COLORS(0, 0, "R", "G");
    EXPECT_COLORS(0, 0, "B", "G", "R");
}

/* The rows are those of "The OpenEXR File Format", section "Predefined attributes: compression". */
static void rows_are_packed_by_compression(void **state)
{
    (void)state;
    assert_int_equal(image_layout_exr_rows("none"), 1);
    assert_int_equal(image_layout_exr_rows("rle"), 1);
    assert_int_equal(image_layout_exr_rows("zips"), 1);
    assert_int_equal(image_layout_exr_rows("zip"), 16);
    assert_int_equal(image_layout_exr_rows("pxr24"), 16);
    assert_int_equal(image_layout_exr_rows("piz"), 32);
    assert_int_equal(image_layout_exr_rows("b44"), 32);
    assert_int_equal(image_layout_exr_rows("b44a"), 32);
    assert_int_equal(image_layout_exr_rows("dwaa"), 32);
    assert_int_equal(image_layout_exr_rows("dwab"), 256);
    assert_int_equal(image_layout_exr_rows(""), 256);
    assert_int_equal(image_layout_exr_rows("of another year"), 256);
}

static void tiles_are_powers_of_two(void **state)
{
    (void)state;
    const int largest = 1 << TEXTURE_TILE_BITS_MAX;
    assert_int_equal(image_layout_tile_bits(1), 0);
    assert_int_equal(image_layout_tile_bits(64), 6);
    assert_int_equal(image_layout_tile_bits(largest), TEXTURE_TILE_BITS_MAX);
    assert_int_equal(image_layout_tile_bits(2 * largest), -1);
    assert_int_equal(image_layout_tile_bits(48), -1);
    assert_int_equal(image_layout_tile_bits(0), -1);
    assert_true(image_layout_is_usable_tile(64, 4096));
    assert_false(image_layout_is_usable_tile(4, 4096));
    assert_true(image_layout_is_usable_tile(4, 3)); /* the one tile of a small level */
    assert_false(image_layout_is_usable_tile(48, 48));
    assert_false(image_layout_is_usable_tile(2 * largest, largest));
}

static void halves_are_rounded_either_way(void **state)
{
    (void)state;
    assert_true(image_layout_is_half(2, 5) && image_layout_is_half(3, 5));
    assert_false(image_layout_is_half(4, 5) || image_layout_is_half(1, 5));
    assert_true(image_layout_is_half(1, 1) && !image_layout_is_half(0, 1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colors_are_those_of_one_layer),
        cmocka_unit_test(rows_are_packed_by_compression),
        cmocka_unit_test(tiles_are_powers_of_two),
        cmocka_unit_test(halves_are_rounded_either_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
