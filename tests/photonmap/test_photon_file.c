/* test_photon_file.c: maps in a file: the same answers, kept irradiances; what is damaged or of something else is
 * refused. Threads: one. */
/* ctest: sanitize long */
#define _GNU_SOURCE
#include "fixtures/photon_file_fixture.h"

#include <errno.h>
#include <signal.h>
#include <sys/wait.h>

static void what_was_computed_is_there_again(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    photon_map in_memory = make_map(&r);
    const char *path = write_map(&r);
    opened o;
    open_map(&o, path);
    assert_true(o.file.is_shared);
    assert_int_equal(o.map.set.count, PHOTONS);
    assert_int_equal(o.cache.ready_before, 0);
    assert_int_equal(o.caustic.set.count, 0);
    for (uint32_t i = 0; i < PHOTONS; i += 3) {
        expect_right(&o.map, i, ask(&o, i));
        field_point p = field_photon(&in_memory, i), q = field_photon(&o.map, i);
        assert_memory_equal(&p, &q, sizeof p);
        expect_right(&in_memory, i, expected_at(&o.map, i));
    }
    uint64_t computed = irradiance_cache_counters(&o.cache).computed;
    assert_true(computed > PHOTONS / 4);
    close_map(&o);

    open_map(&o, path);
    assert_int_equal(o.cache.ready_before, computed);
    for (uint32_t i = 0; i < PHOTONS; i += 3)
        ask(&o, i);
    assert_int_equal(irradiance_cache_counters(&o.cache).computed, 0);
    close_map(&o);
    photon_map_reset(&in_memory);
    test_run_reset(&r);
}

static void expect_refused(const char *path, const photon_file_key *key, const char *why)
{
    photon_file file;
    photon_map a, b;
    photon_file_result result = photon_file_open(&quiet, path, key, &file, &a, &b, message, sizeof message);
    bool is_foreign = strcmp(message, "it is no photon map") == 0;
    assert_int_equal(result, is_foreign ? PHOTON_FILE_FOREIGN : PHOTON_FILE_REFUSED);
    if (!strstr(message, why))
        fail_msg("'%s' is not in: %s", why, message);
}

/* Irradiance photons that are a part of the photons have slots of their own, which the file keeps too. */
static void irradiance_photons_are_kept(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    const char *path = in_folder("b.map");
    photon_set set = field_photons(FIELD_SPHERE, PHOTONS, 3), empty = {0};
    photon_map_settings settings = {
        .nearest = NEAREST, .max_radius = 1.0f, .surface_area = 4.0f * AG_PI, .irradiance_fraction = 0.25f};
    photon_map map, none = field_map(&r, &empty, NEAREST, 1.0f);
    assert_int_equal(photon_map_create(&r.run, &set, &settings, 0.0, 1.0, &map), AG_OK);
    photon_file_key key = some_key();
    strcpy(key.settings, "fraction: 0.25\n");
    int descriptor = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    assert_true(descriptor >= 0);
    assert_int_equal(photon_file_write(&quiet, descriptor, &key, &map, &none), 0);
    assert_int_equal(close(descriptor), 0);

    irradiance_cache in_memory;
    assert_int_equal(irradiance_cache_create(&map, IRRADIANCE_ON_DEMAND, 1, &in_memory), AG_OK);
    for (int time = 0; time < 2; time++) {
        opened o;
        assert_int_equal(photon_file_open(&quiet, path, &key, &o.file, &o.map, &o.caustic, message, sizeof message),
                         PHOTON_FILE_OPEN);
        assert_true(o.file.is_shared);
        assert_int_equal(o.map.set.count, PHOTONS);
        assert_int_equal(o.map.irradiance_photons.count, map.irradiance_photons.count);
        assert_false(photon_map_all_have_irradiance(&o.map));
        assert_true(photon_map_all_have_irradiance(&o.caustic));
        assert_int_equal(irradiance_cache_create(&o.map, IRRADIANCE_ON_DEMAND, 1, &o.cache), AG_OK);
        irradiance_cache_share(&o.cache, &o.file.owners);
        for (uint32_t i = 0; i < PHOTONS; i += 3) {
            irradiance_request x, y;
            field_point at = field_photon(&map, i);
            irradiance_cache_get(&in_memory, at.position, at.normal, 0, &x);
            irradiance_cache_get(&o.cache, at.position, at.normal, 0, &y);
            assert_memory_equal(&x.irradiance, &y.irradiance, sizeof x.irradiance);
        }
        uint64_t computed = irradiance_cache_counters(&in_memory).computed;
        assert_true(computed > map.irradiance_photons.count / 2 && computed <= map.irradiance_photons.count);
        assert_int_equal(o.cache.ready_before, time == 0 ? 0 : computed);
        assert_int_equal(irradiance_cache_counters(&o.cache).computed, time == 0 ? computed : 0);
        close_map(&o);
    }
    irradiance_cache_reset(&in_memory);
    photon_map_reset(&map);
    photon_map_reset(&none);
    test_run_reset(&r);
}

static void what_was_made_of_something_else_is_refused(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    const char *path = write_map(&r);
    photon_file_key key = some_key();
#define EXPECT_REFUSED(change, why)                                                                                    \
    do {                                                                                                               \
        key = some_key();                                                                                              \
        change;                                                                                                        \
        expect_refused(path, &key, why);                                                                               \
    } while (0)
    EXPECT_REFUSED(key.scene.bits[1]++, "another scene");
    EXPECT_REFUSED(key.settings[6] = '6', "made with another seed: 5, not 6");
    EXPECT_REFUSED(strcpy(key.settings, "seed: 5\nnumber of photons: 30\nradius: 1\n"), "photons: 300, not 30");
    EXPECT_REFUSED(strcpy(key.settings, "seed: 5\nnumber of photons: 300\nradius: 1.5\n"), "radius: 1, not 1.5");
    EXPECT_REFUSED(strcpy(key.settings, "seed: 5\nnumber of photons: 300\n"), "other kinds of settings");
    EXPECT_REFUSED(strcpy(key.settings, "seed: 5\nnumber of photons: 300\nradius: 1\nmore: 1\n"), "other kinds");
    EXPECT_REFUSED(strcpy(key.settings, ""), "other kinds of settings");
    EXPECT_REFUSED(key.aim_view.bits[0]++, "aimed at another view");
    EXPECT_REFUSED(key.estimates.bits[0]++, "estimates of irradiance were others");
    EXPECT_REFUSED(strcpy(key.program, "1.2.4, gcc 12"), "another program");
    EXPECT_REFUSED(strcpy(key.machine, "x86_64 Somebody avx512"), "another machine");
    photon_file file;
    photon_map a, b;
    key = some_key();
    assert_int_equal(photon_file_open(&quiet, in_folder("none.map"), &key, &file, &a, &b, message, sizeof message),
                     PHOTON_FILE_ABSENT);
    assert_int_equal(photon_file_open(&quiet, folder, &key, &file, &a, &b, message, sizeof message),
                     PHOTON_FILE_FAILED);
    test_run_reset(&r);
}

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

/* Where all entries of the table are taken a process works on a copy, in which nobody else's claims are. */
static void a_copy_has_no_claims(void **state)
{
    (void)state;
    test_run r;
    opened first, copy;
    const char *path = open_new_map(&r, &first);
    ask(&first, 1);
    uint32_t word;
    assert_true(irradiance_slot_try_claim(photon_block_slot(first.map.blocks, 2), first.file.owners.claimer, &word));
    int files[CLAIM_OWNERS_MAX];
    claim_owners others;
    uint32_t last = 0;
    for (int i = 1; i < CLAIM_OWNERS_MAX; i++) {
        files[i] = open(path, O_RDWR | O_CLOEXEC);
        assert_true(claim_owners_join(files[i], first.file.owners.table, &others));
        last = others.claimer;
        claim_owners_reset(&others);
        assert_true(claim_owners_is_alive(&first.file.owners, last));
    }
    open_map(&copy, path);
    assert_false(copy.file.is_shared);
    assert_non_null(strstr(message, "too many"));
    assert_int_equal(copy.cache.ready_before, 1);
    expect_right(&copy.map, 2, ask(&copy, 2));
    expect_right(&copy.map, 3, ask(&copy, 3));
    assert_int_equal(irradiance_slot_read(photon_block_slot(first.map.blocks, 3)), 0);
    close_map(&copy);
    for (int i = 1; i < CLAIM_OWNERS_MAX; i++)
        close(files[i]);
    assert_false(claim_owners_is_alive(&first.file.owners, last));
    close_map(&first);
    test_run_reset(&r);
}

static void a_full_disk_is_an_error(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    photon_map map = make_map(&r);
    photon_file_key key = some_key();
    int file = open(in_folder("b.map"), O_WRONLY | O_CREAT, 0666);
    struct rlimit saved;
    signal(SIGXFSZ, SIG_IGN);
    set_file_limit(40000 / FEWER, &saved);
    int error = photon_file_write(&quiet, file, &key, &map, &map);
    setrlimit(RLIMIT_FSIZE, &saved);
    assert_int_equal(error, EFBIG);
    run_cancel(&quiet);
    assert_int_equal(photon_file_write(&quiet, file, &key, &map, &map), ECANCELED);
    quiet = (run_context){0};
    close(file);
    photon_map_reset(&map);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(what_was_computed_is_there_again),
        TEST_IN_FOLDER(irradiance_photons_are_kept),
        TEST_IN_FOLDER(what_was_made_of_something_else_is_refused),
        TEST_IN_FOLDER(what_is_damaged_is_refused),
        TEST_IN_FOLDER(slots_may_hold_anything),
        TEST_IN_FOLDER(flipped_bits_change_no_irradiance),
        cmocka_unit_test(check_bytes_tell_bits),
        TEST_IN_FOLDER(a_copy_has_no_claims),
        TEST_IN_FOLDER(a_full_disk_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
