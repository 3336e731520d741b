/* test_texture_tile_packing.c: tiles come back as they were, whatever is in them; what is smooth becomes smaller, noise
 * no larger; bytes that are no packed tile are told, and lead nowhere beyond. Threads: one. */
#include "math/rng.h"
#include "texture/texture_tile_packing.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SIDE = 64,
    VALUES_MAX = SIDE * SIDE * 3,
    BYTES_MAX = VALUES_MAX * 4,
    GUARD = 256,
    UNTOUCHED = 0xa5,
    GROUP = 128
};

static unsigned char pixels[BYTES_MAX], packed[BYTES_MAX + GUARD], back[BYTES_MAX + GUARD];
static uint32_t values[VALUES_MAX], scratch[VALUES_MAX + GUARD / sizeof(uint32_t)];

static void expect_untouched(const void *memory, size_t begin)
{
    for (size_t k = 0; k < GUARD; k++)
        assert_int_equal(((const unsigned char *)memory)[begin + k], UNTOUCHED);
}

/* Unpacks from and in memory of exactly the sizes that tile_unpack asks for, so that an address sanitizer tells of each
 * access beyond them. Returns its status. */
static ag_status unpack_in_bounds(tile_format f, size_t count, unsigned char *out_pixels)
{
    unsigned char *input = malloc(count > 0 ? count : 1);
    uint32_t *room = malloc(tile_scratch_bytes(f));
    assert_true(input && room);
    memcpy(input, packed, count);
    const ag_status status = tile_unpack(f, input, count, room, out_pixels);
    free(input);
    free(room);
    return status;
}

/* Unpacks to `back`, and checks that nothing beyond it and beyond the scratch memory is written. Returns the status. */
static ag_status unpack(tile_format f, size_t count)
{
    memset(back, UNTOUCHED, sizeof back);
    memset(scratch, UNTOUCHED, sizeof scratch);
    const ag_status status = tile_unpack(f, packed, count, scratch, back);
    expect_untouched(back, tile_format_bytes(f));
    expect_untouched(scratch, tile_scratch_bytes(f));
    unsigned char *again = malloc(tile_format_bytes(f));
    assert_non_null(again);
    assert_int_equal(unpack_in_bounds(f, count, again), status);
    if (status == AG_OK)
        assert_memory_equal(again, back, tile_format_bytes(f));
    free(again);
    return status;
}

static size_t go_round(tile_format f)
{
    const size_t size = tile_format_bytes(f);
    memset(packed, UNTOUCHED, sizeof packed);
    const size_t count = tile_pack(f, pixels, scratch, packed);
    assert_true(count > 0 && count <= size);
    expect_untouched(packed, size);
    assert_int_equal(unpack(f, count), AG_OK);
    assert_memory_equal(back, pixels, size);
    return count;
}

static void test_round_trip(void **state)
{
    (void)state;
    static const size_t CHANNELS[] = {1, 3}, BYTES[] = {1, 2, 4};
    for (int k = 0; k < 6; k++) {
        const tile_format f = {CHANNELS[k % 2] * SIDE, SIDE, CHANNELS[k % 2], BYTES[k / 2]};
        const size_t size = tile_format_bytes(f);
        memset(pixels, 77, size);
        assert_true(go_round(f) < size / 50);
        for (size_t i = 0; i < size; i++) {
            rng random = rng_make(1, (uint32_t)k, i);
            pixels[i] = (unsigned char)(255.0f * rng_float(&random));
        }
        go_round(f);
        for (size_t i = 0; i < size / f.value_bytes; i++) { /* a slope, with 4 values of noise */
            rng random = rng_make(2, (uint32_t)k, i);
            const uint32_t value = (uint32_t)(i / f.channel_count % SIDE) * 3 + (uint32_t)(4.0f * rng_float(&random));
            memcpy(pixels + i * f.value_bytes, &value, f.value_bytes);
        }
        assert_true(go_round(f) < size - size / 3);
    }
}

/* Groups of any number of bits, beside others; floats that were halves have 13 bits that are 0 in all of them. */
static void test_widths(void **state)
{
    (void)state;
    const tile_format f = {3 * SIDE, SIDE, 3, 4};
    const size_t size = tile_format_bytes(f), count = size / sizeof(uint32_t);
    for (uint32_t bits = 0; bits < 32; bits++)
        for (uint32_t shift = 0; shift + bits < 32; shift += 13) {
            for (size_t i = 0; i < count; i++) {
                rng random = rng_make(3, bits * 32 + shift, i);
                const uint32_t of_group = i / 1000 % 2 ? bits : bits / 2;
                values[i] = (uint32_t)(ldexp((double)rng_float(&random), (int)of_group)) << shift;
            }
            memcpy(pixels, values, size);
            const size_t packed_bytes = go_round(f);
            if (bits < 27)
                assert_true(packed_bytes < size / 32 * (bits + 1) + size / 100);
        }
}

/* --- bytes that are no packed tile, or another one --- */

/* Noise of another number of bits in each group of values. Gives the packed bytes. */
static size_t pack_noise(tile_format f)
{
    const size_t size = tile_format_bytes(f);
    for (size_t i = 0; i < size / f.value_bytes; i++) {
        rng random = rng_make(4, f.value_bytes, i);
        const uint32_t value =
            (uint32_t)ldexp((double)rng_float(&random), (int)(1 + i / GROUP % (7 * f.value_bytes - 2)));
        memcpy(pixels + i * f.value_bytes, &value, f.value_bytes);
    }
    const size_t count = go_round(f);
    assert_true(count < size);
    return count;
}

static tile_format format_of(size_t value_bytes) { return (tile_format){3 * SIDE, SIDE, 3, value_bytes}; }
static size_t widths_begin(tile_format f) { return 1 + f.channel_count * sizeof(uint32_t); }
static size_t group_count(tile_format f) { return f.row_values * f.row_count / GROUP; }

static void test_flipped(void **state)
{
    (void)state;
    for (size_t value_bytes = 1; value_bytes <= 4; value_bytes *= 2) {
        const tile_format f = format_of(value_bytes);
        const size_t count = pack_noise(f), begin = widths_begin(f), end = begin + group_count(f);
        const size_t cuts[] = {0, 1, begin, end - 1, end, count - 1};
        for (int k = 0; k < 6; k++)
            assert_int_equal(unpack(f, cuts[k]), AG_ERROR_SYSTEM);
        for (size_t i = 0; i < count; i += i < end ? 1 : 97)
            for (int flipped = 1; flipped < 256; flipped += flipped) {
                packed[i] ^= (unsigned char)flipped;
                const bool is_wrong = i == 0 ? packed[0] >= 8 * value_bytes : i >= begin && i < end;
                assert_int_equal(unpack(f, count), is_wrong ? AG_ERROR_SYSTEM : AG_OK);
                packed[i] ^= (unsigned char)flipped;
            }
        for (int shift = 0; shift < 256; shift++) {
            packed[0] = (unsigned char)shift;
            assert_int_equal(unpack(f, count), shift < (int)(8 * value_bytes) ? AG_OK : AG_ERROR_SYSTEM);
        }
    }
}

/* Widths whose sum is that of the tile, so that its size does not tell that they are others. */
static void test_widths_of_another_tile(void **state)
{
    (void)state;
    for (size_t value_bytes = 1; value_bytes <= 4; value_bytes *= 2) {
        const tile_format f = format_of(value_bytes);
        const size_t count = pack_noise(f), groups = group_count(f);
        unsigned char *widths = packed + widths_begin(f), before[VALUES_MAX / GROUP];
        int exchanged = 0;
        memcpy(before, widths, groups);
        for (size_t i = 0; i < groups; i++) {
            const size_t other = (i * 7 + 5) % groups;
            exchanged += widths[i] != widths[other];
            widths[i] = before[other];
            widths[other] = before[i];
            assert_int_equal(unpack(f, count), AG_OK);
            memcpy(widths, before, groups);
        }
        assert_true(exchanged > 0);
        for (size_t i = 0; i < groups; i++)
            for (int more = 0; more < 2; more++) { /* the most that a width may be, and beyond, at the others' cost */
                const int wanted = (int)(8 * value_bytes) + more;
                for (size_t k = 0; widths[i] < wanted; k = (k + 1) % groups)
                    if (k != i && widths[k] > 0) {
                        widths[k]--;
                        widths[i]++;
                    }
                assert_int_equal(unpack(f, count), more > 0 ? AG_ERROR_SYSTEM : AG_OK);
                memcpy(widths, before, groups);
            }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_round_trip), cmocka_unit_test(test_widths),
                                       cmocka_unit_test(test_flipped), cmocka_unit_test(test_widths_of_another_tile)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
