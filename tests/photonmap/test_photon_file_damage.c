/* test_photon_file_damage.c: a photon map's file with damage is refused, or costs the irradiances in question alone: no
 * flipped bit reaches a picture. Threads: one. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "fixtures/photon_file_fixture.h"

#include <errno.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>

static void flip(const char *path, off_t at)
{
    unsigned char byte;
    int file = open(path, O_RDWR);
    assert_int_equal(pread(file, &byte, 1, at), 1);
    byte ^= 0x10;
    assert_int_equal(pwrite(file, &byte, 1, at), 1);
    close(file);
}

/* Any byte of what never changes; and any length but its own. */
static void what_is_damaged_is_refused(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    const char *path = write_map(&r);
    photon_file_key key = some_key();
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    for (off_t at = 0; at < 820; at += 7) {
        flip(path, at);
        expect_refused(path, &key, "it");
        flip(path, at);
    }
    const off_t blocks_at = 8192, blocks_end = blocks_at + (PHOTONS + 15) / 16 * 384;
    for (off_t at = blocks_at; at < blocks_end; at += 997 * FEWER)
        if ((at - blocks_at) % 384 < 320) {
            flip(path, at);
            expect_refused(path, &key, "photons do not have their checksum");
            flip(path, at);
        }
    off_t nodes_at = (blocks_end + 4095) / 4096 * 4096;
    flip(path, nodes_at + 40);
    expect_refused(path, &key, "photons do not have their checksum");
    flip(path, nodes_at + 40);
    static const off_t LENGTHS[] = {0, 1, 15, 16, 500, 4096, 8192, 100000 / FEWER};
    opened o;
    open_map(&o, path); /* it was put right again */
    close_map(&o);
    assert_int_equal(truncate(path, status.st_size + 1), 0);
    expect_refused(path, &key, "too long");
    assert_int_equal(truncate(path, status.st_size - 1), 0);
    expect_refused(path, &key, "cut short");
    for (size_t i = sizeof LENGTHS / sizeof *LENGTHS; i-- > 0;) {
        assert_int_equal(truncate(path, LENGTHS[i]), 0);
        expect_refused(path, &key, LENGTHS[i] == 0 ? "empty" : "cut short");
    }
    test_run_reset(&r);
}

/* A map that was cut short reads as zeros, whose nodes lead to leaves that are not there. Memory that may not be
 * touched lies right behind where the file is mapped. */
static void searches_stay_in_a_map_that_is_cut_short(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    const char *path = write_map(&r);
    const size_t forbidden_bytes = (size_t)16 << 20;
    void *forbidden = mmap(NULL, forbidden_bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_true(forbidden != MAP_FAILED);
    opened o;
    open_map(&o, path);
    uint32_t leaves = 1u << o.map.tree.depth;
    assert_true(leaves > photon_block_count(o.map.tree.count));
    assert_int_equal(truncate(path, 0), 0);
    for (int i = 0; i < 64; i++) {
        vec3 at = {(float)(i & 3) - 1.5f, (float)(i >> 2 & 3) - 1.5f, (float)(i >> 4) - 1.5f};
        float distance_squared;
        assert_true(photon_tree_leaf(&o.map.tree, at) < leaves);
        photon_tree_nearest(&o.map.tree, at, (vec3){0.0f, 0.0f, 1.0f}, 0.0f, 10.0f, &distance_squared);
    }
    assert_false(photon_file_is_intact(&o.file));
    close_map(&o);
    munmap(forbidden, forbidden_bytes);
    test_run_reset(&r);
}

/* Whatever is in the slots, every request ends with a number. */
static void slots_may_hold_anything(void **state)
{
    (void)state;
    test_run r;
    opened o;
    open_new_map(&r, &o);
    rng random = test_random(8);
    uint64_t not_ready = 0;
    for (uint32_t i = 0; i < PHOTONS; i++) {
        uint32_t word = (uint32_t)rng_next(&random);
        if (i % 3 == 0)
            word = irradiance_word(IRRADIANCE_CLAIMED, word & 0x3ff); /* indices and generations that there may be */
        store_relaxed_u32(photon_block_slot(o.map.blocks, i), word);
        not_ready += !irradiance_word_is_ready(word) && word != 0 &&
                     word != irradiance_word(IRRADIANCE_CLAIMED, o.file.owners.claimer);
    }
    for (uint32_t i = 0; i < PHOTONS; i++) {
        bool was_ready = irradiance_word_is_ready(irradiance_slot_read(photon_block_slot(o.map.blocks, i)));
        if (irradiance_slot_read(photon_block_slot(o.map.blocks, i)) ==
            irradiance_word(IRRADIANCE_CLAIMED, o.file.owners.claimer))
            continue; /* ours, as it says, which nobody takes over here */
        rgb value = ask(&o, i);
        assert_true(rgb_is_finite(value));
        if (!was_ready)
            expect_right(&o.map, i, value);
    }
    assert_int_equal(irradiance_cache_counters(&o.cache).reclaimed, not_ready);
    close_map(&o);
    test_run_reset(&r);
}

/* Every slot of a map, which is ready, is as it was, or is empty and becomes so again. */
static void expect_words(opened *o, const uint32_t *words)
{
    for (uint32_t i = 0; i < PHOTONS; i++) {
        uint32_t word = irradiance_slot_read(photon_block_slot(o->map.blocks, i));
        if (word != words[i]) {
            assert_false(irradiance_word_is_ready(word));
            ask(o, i);
            assert_int_equal(irradiance_slot_read(photon_block_slot(o->map.blocks, i)), words[i]);
        }
    }
}

/* Random bits flipped anywhere in the file, the slots among it: the right irradiances, or a refusal. */
static void flipped_bits_change_no_irradiance(void **state)
{
    (void)state;
    enum { FLIPS = 10000 / FEWER };
    test_run r;
    opened o;
    static uint32_t words[PHOTONS];
    const char *path = open_new_map(&r, &o);
    for (uint32_t i = 0; i < PHOTONS; i++) {
        ask(&o, i);
        words[i] = irradiance_slot_read(photon_block_slot(o.map.blocks, i));
        assert_true(irradiance_word_is_ready(words[i]));
    }
    close_map(&o);
    int file = open(path, O_RDWR);
    struct stat status;
    assert_int_equal(fstat(file, &status), 0);
    rng random = test_random(21);
    uint64_t refused = 0, damaged = 0;
    for (int k = 0; k < FLIPS; k++) {
        photon_file_key key = some_key();
        off_t at = (off_t)(rng_next(&random) % (uint64_t)status.st_size);
        unsigned char byte, before;
        assert_int_equal(pread(file, &before, 1, at), 1);
        byte = (unsigned char)(before ^ 1 << rng_next(&random) % 8);
        assert_int_equal(pwrite(file, &byte, 1, at), 1);
        photon_file_result result =
            photon_file_open(&quiet, path, &key, &o.file, &o.map, &o.caustic, message, sizeof message);
        if (result != PHOTON_FILE_OPEN) {
            refused++;
            assert_int_equal(pwrite(file, &before, 1, at), 1);
            continue;
        }
        assert_int_equal(irradiance_cache_create(&o.map, IRRADIANCE_ON_DEMAND, 1, &o.cache), AG_OK);
        irradiance_cache_share(&o.cache, &o.file.owners);
        damaged += o.file.damaged;
        expect_words(&o, words);
        close_map(&o);
    }
    close(file);
    print_message("of %d flips %d are refused, %d irradiances computed again\n", (int)FLIPS, (int)refused,
                  (int)damaged);
    assert_true(refused > FLIPS / 4); /* the photons never change; the slots and the owners' table do */
    assert_true(damaged > FLIPS / 20);
    test_run_reset(&r);
}

/* One and two bits of a word, and of its index, make another check byte, which is never 0. */
static void check_bytes_tell_bits(void **state)
{
    (void)state;
    rng random = test_random(22);
    for (int k = 0; k < 1000; k++) {
        uint32_t index = (uint32_t)rng_next(&random), word = (uint32_t)rng_next(&random);
        uint8_t check = irradiance_word_check(index, word);
        assert_true(check >= 0x80);
        for (int i = 0; i < 64; i++)
            for (int j = i; j < 64; j++) {
                uint64_t bits = (uint64_t)1 << i ^ (j > i ? (uint64_t)1 << j : 0);
                assert_int_not_equal(irradiance_word_check(index ^ (uint32_t)(bits >> 32), word ^ (uint32_t)bits),
                                     check);
            }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        /* the first: before each test cmocka puts its own handlers in the place of those that opening a map installs */
        TEST_IN_FOLDER(searches_stay_in_a_map_that_is_cut_short),
        TEST_IN_FOLDER(what_is_damaged_is_refused),
        TEST_IN_FOLDER(slots_may_hold_anything),
        TEST_IN_FOLDER(flipped_bits_change_no_irradiance),
        cmocka_unit_test(check_bytes_tell_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
