/* test_texture_tile_packing.c: tiles come back as they were, whatever is in them; what is smooth becomes smaller, noise
 * no larger; bytes that are no packed tile are told, not believed. Threads: one. */
#include "math/rng.h"
#include "texture/texture_tile_packing.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 64, BYTES_MAX = SIDE * SIDE * 12 };

static _Alignas(uint32_t) unsigned char pixels[BYTES_MAX], packed[BYTES_MAX], back[BYTES_MAX];
static uint32_t scratch[BYTES_MAX / sizeof(uint32_t)];

static size_t go_round(tile_format f)
{
    const size_t size = tile_format_bytes(f), count = tile_pack(f, pixels, scratch, packed);
    assert_true(count > 0 && count <= size);
    memset(back, 0xa5, sizeof back);
    assert_int_equal(tile_unpack(f, packed, count, scratch, back), AG_OK);
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
    uint32_t *values = (uint32_t *)(void *)pixels;
    for (uint32_t bits = 0; bits < 32; bits++)
        for (uint32_t shift = 0; shift + bits < 32; shift += 13) {
            for (size_t i = 0; i < count; i++) {
                rng random = rng_make(3, bits * 32 + shift, i);
                const uint32_t of_group = i / 1000 % 2 ? bits : bits / 2;
                values[i] = (uint32_t)(ldexp((double)rng_float(&random), (int)of_group)) << shift;
            }
            const size_t packed_bytes = go_round(f);
            if (bits < 27)
                assert_true(packed_bytes < size / 32 * (bits + 1) + size / 100);
        }
}

static void test_broken(void **state)
{
    (void)state;
    const tile_format f = {3 * SIDE, SIDE, 3, 1};
    memset(pixels, 5, sizeof pixels);
    const size_t count = go_round(f);
    assert_int_equal(tile_unpack(f, packed, count - 1, scratch, back), AG_ERROR_SYSTEM);
    for (size_t i = 0; i < count; i++) /* no byte, whatever it is, leads beyond the tile */
        for (int flipped = 1; flipped < 256; flipped += flipped) {
            packed[i] ^= (unsigned char)flipped;
            const ag_status status = tile_unpack(f, packed, count, scratch, back);
            assert_true(status == AG_OK || status == AG_ERROR_SYSTEM);
            packed[i] ^= (unsigned char)flipped;
        }
    packed[0] ^= 0xff;
    assert_int_equal(tile_unpack(f, packed, count, scratch, back), AG_ERROR_SYSTEM);
    assert_int_equal(tile_unpack(f, packed, 0, scratch, back), AG_ERROR_SYSTEM);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_round_trip), cmocka_unit_test(test_widths),
                                       cmocka_unit_test(test_broken)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
