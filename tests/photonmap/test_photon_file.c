/* test_photon_file.c: maps in a file: the same answers, kept irradiances; what is damaged or of something else is
 * refused; processes that share it compute nothing twice, and what dead ones have left is found.
 * Threads: one; processes of its own. */
/* ctest: sanitize long */
#define _GNU_SOURCE
#include "clock.h"
#include "fixtures/photon_field.h"
#include "photon_file.h"

#include "fixtures/temporary_folder.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/wait.h>

enum { PHOTONS = 6000 / FEWER, NEAREST = 20 };

static run_context quiet; /* for what asks only whether to stop */

static photon_file_key some_key(void)
{
    photon_file_key key;
    memset(&key, 0, sizeof key);
    key.scene = hash128_begin();
    strcpy(key.settings, "seed: 5\nnumber of photons: 300\nradius: 1\n");
    strcpy(key.program, "1.2.3, gcc 12");
    strcpy(key.machine, "x86_64 Somebody avx2");
    return key;
}

/* As the map of a file, but in memory. */
static photon_map make_map(test_run *r)
{
    photon_set set = field_photons(FIELD_SPHERE, PHOTONS, 3);
    return field_map(r, &set, NEAREST, 1.0f);
}

static const char *write_map(test_run *r)
{
    const char *path = in_folder("a.map");
    photon_map map = make_map(r), none;
    photon_set empty = {0};
    none = field_map(r, &empty, NEAREST, 1.0f);
    photon_file_key key = some_key();
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    assert_true(file >= 0);
    assert_int_equal(photon_file_write(&quiet, file, &key, &map, &none), 0);
    assert_int_equal(close(file), 0);
    photon_map_reset(&map);
    photon_map_reset(&none);
    return path;
}

typedef struct opened {
    photon_file file;
    photon_map map, caustic;
    irradiance_cache cache;
} opened;

static void open_map(opened *o, const char *path)
{
    photon_file_key key = some_key();
    photon_file_result result =
        photon_file_open(&quiet, path, &key, &o->file, &o->map, &o->caustic, message, sizeof message);
    if (result != PHOTON_FILE_OPEN)
        fail_msg("not opened: %s", message);
    assert_int_equal(irradiance_cache_create(&o->map, IRRADIANCE_ON_DEMAND, 1, &o->cache), AG_OK);
    if (o->file.is_shared)
        irradiance_cache_share(&o->cache, &o->file.owners);
}

static void close_map(opened *o)
{
    irradiance_cache_reset(&o->cache);
    photon_map_reset(&o->map);
    photon_map_reset(&o->caustic);
    photon_file_close(&o->file);
}

/* A run, a map's file, and that opened. Gives its path. */
static const char *open_new_map(test_run *r, opened *o)
{
    test_run_init(r, 1);
    const char *path = write_map(r);
    open_map(o, path);
    return path;
}

static rgb ask(opened *o, uint32_t index)
{
    irradiance_request request = {.bearer = index};
    irradiance_slot *slot = photon_block_slot(o->map.blocks, index);
    if (irradiance_slot_read(slot) == 0) {
        field_place p = field_photon(&o->map, index);
        irradiance_cache_get(&o->cache, p.position, p.normal, 0, &request);
        if (request.bearer == PHOTON_NONE)
            return request.irradiance;
    }
    irradiance_cache_retry(&o->cache, NULL, &request, 0);
    return request.irradiance;
}

/* What an undisturbed map says at a photon. */
static rgb expected_at(const photon_map *map, uint32_t index)
{
    static photon_neighbor scratch[2 * (NEAREST + 1) + 64];
    field_place p = field_photon(map, index);
    rgb estimate = irradiance_estimate(map, p.position, p.normal, scratch);
    return photon_map_decode_irradiance(map, photon_map_encode_irradiance(map, estimate, index));
}

static void expect_right(const photon_map *map, uint32_t index, rgb irradiance)
{
    rgb expected = expected_at(map, index);
    if (memcmp(&expected, &irradiance, sizeof expected) != 0)
        fail_msg("photon %u: %g, not %g", index, (double)irradiance.r, (double)expected.r);
}

/* --- alone --- */

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
        field_place p = field_photon(&in_memory, i), q = field_photon(&o.map, i);
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

/* Bearers that are a part of the photons have slots of their own, which the file keeps too. */
static void bearers_are_kept(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    const char *path = in_folder("b.map");
    photon_set set = field_photons(FIELD_SPHERE, PHOTONS, 3), empty = {0};
    photon_map_settings settings = {
        .nearest = NEAREST, .max_radius = 1.0f, .surface_area = 4.0f * AG_PI, .bearing = 0.25f};
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
        assert_int_equal(o.map.bearers.count, map.bearers.count);
        assert_false(photon_map_all_bear(&o.map));
        assert_true(photon_map_all_bear(&o.caustic));
        assert_int_equal(irradiance_cache_create(&o.map, IRRADIANCE_ON_DEMAND, 1, &o.cache), AG_OK);
        irradiance_cache_share(&o.cache, &o.file.owners);
        for (uint32_t i = 0; i < PHOTONS; i += 3) {
            irradiance_request x, y;
            field_place at = field_photon(&map, i);
            irradiance_cache_get(&in_memory, at.position, at.normal, 0, &x);
            irradiance_cache_get(&o.cache, at.position, at.normal, 0, &y);
            assert_memory_equal(&x.irradiance, &y.irradiance, sizeof x.irradiance);
        }
        uint64_t computed = irradiance_cache_counters(&in_memory).computed;
        assert_true(computed > map.bearers.count / 2 && computed <= map.bearers.count);
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
            word = irradiance_word(IRRADIANCE_CLAIMED, word & 0x3ff); /* places and generations that there may be */
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

/* Where all places are taken a process works on a copy, in which nobody else's claims are. */
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

/* --- processes --- */

enum { HELD = 5, TOLD_TO_PUBLISH = 'p' };

/* Takes claims, says so, and then holds them; publishes them where it is told to: 0 where all are its own still. */
static pid_t start_holder(const char *path, int *out_ready, int *out_order)
{
    int ready[2], order[2];
    assert_int_equal(pipe(ready), 0);
    assert_int_equal(pipe(order), 0);
    pid_t id = fork();
    assert_true(id >= 0);
    if (id == 0) {
        opened o;
        char byte = 0;
        open_map(&o, path);
        uint32_t word, failed = 0;
        for (uint32_t i = 0; i < HELD; i++)
            if (!irradiance_slot_try_claim(photon_block_slot(o.map.blocks, i), o.file.owners.claimer, &word))
                _exit(2);
        if (write(ready[1], &byte, 1) != 1 || read(order[0], &byte, 1) != 1 || byte != TOLD_TO_PUBLISH)
            _exit(3);
        for (uint32_t i = 0; i < HELD; i++)
            failed += !irradiance_slot_publish(photon_block_slot(o.map.blocks, i), o.file.owners.claimer,
                                               irradiance_word(IRRADIANCE_READY, 77));
        _exit(failed == HELD ? 1 : 0);
    }
    close(ready[1]);
    close(order[0]);
    char byte;
    assert_int_equal(read(ready[0], &byte, 1), 1);
    *out_ready = ready[0];
    *out_order = order[1];
    return id;
}

static void a_dead_process_leaves_no_claim(void **state)
{
    (void)state;
    test_run r;
    opened o;
    const char *path = open_new_map(&r, &o);
    int ready, order;
    pid_t id = start_holder(path, &ready, &order);
    uint32_t word = irradiance_slot_read(photon_block_slot(o.map.blocks, 0));
    assert_int_equal(irradiance_word_state(word), IRRADIANCE_CLAIMED);
    assert_true(claim_owners_is_alive(&o.file.owners, word & IRRADIANCE_VALUE_MASK));
    assert_int_equal(kill(id, SIGKILL), 0);
    assert_int_equal(waitpid(id, NULL, 0), id);
    assert_false(claim_owners_is_alive(&o.file.owners, word & IRRADIANCE_VALUE_MASK));
    expect_right(&o.map, 0, ask(&o, 0));
    assert_int_equal(irradiance_cache_counters(&o.cache).reclaimed, 1);

    /* nor where another has taken its place */
    opened next;
    open_map(&next, path);
    assert_int_equal(next.file.owners.claimer & 255, word & 255);
    assert_int_not_equal(next.file.owners.claimer, word & IRRADIANCE_VALUE_MASK);
    for (uint32_t i = 1; i < HELD; i++)
        expect_right(&o.map, i, ask(i % 2 ? &o : &next, i));
    assert_int_equal(irradiance_cache_counters(&o.cache).reclaimed, 3);
    assert_int_equal(irradiance_cache_counters(&next.cache).reclaimed, 2);
    assert_int_equal(irradiance_cache_counters(&next.cache).duplicated, 0);
    close_map(&next);
    close_map(&o);
    close(ready);
    close(order);
    test_run_reset(&r);
}

/* One that stands still is waited for some seconds, then not any more; what it says afterwards is too late. */
static void a_stopped_process_is_not_waited_for(void **state)
{
    (void)state;
    test_run r;
    opened o;
    const char *path = open_new_map(&r, &o);
    int ready, order, ended;
    pid_t id = start_holder(path, &ready, &order);
    assert_int_equal(kill(id, SIGSTOP), 0);
    rgb value = ask(&o, 0);
    expect_right(&o.map, 0, value);
    assert_int_equal(irradiance_cache_counters(&o.cache).reclaimed, 1);
    uint32_t word = irradiance_slot_read(photon_block_slot(o.map.blocks, 0));
    char byte = TOLD_TO_PUBLISH;
    assert_int_equal(kill(id, SIGCONT), 0);
    assert_int_equal(write(order, &byte, 1), 1);
    assert_int_equal(waitpid(id, &ended, 0), id);
    assert_true(WIFEXITED(ended) && WEXITSTATUS(ended) == 0); /* the others were its own still */
    assert_int_equal(irradiance_slot_read(photon_block_slot(o.map.blocks, 0)), word);
    assert_int_equal(irradiance_slot_read(photon_block_slot(o.map.blocks, 1)), irradiance_word(IRRADIANCE_READY, 77));
    close_map(&o);
    close(ready);
    close(order);
    test_run_reset(&r);
}

enum { FILLERS = 4, KILLS = 60 / (FEWER > 1 ? 4 : 1) };

static pid_t start_filler(const char *path, uint32_t begin)
{
    pid_t id = fork();
    assert_true(id >= 0);
    if (id == 0) {
        opened o;
        open_map(&o, path);
        for (uint32_t i = 0; i < PHOTONS; i++)
            ask(&o, (begin + i) % PHOTONS);
        _exit(irradiance_cache_counters(&o.cache).duplicated == 0 ? 0 : 1);
    }
    return id;
}

/* Four fill a map from different ends; at random moments one is killed, and another begins. */
static void processes_are_killed_at_random(void **state)
{
    (void)state;
    test_run r;
    test_run_init(&r, 1);
    const char *path = write_map(&r);
    rng random = test_random(11);
    pid_t fillers[FILLERS];
    int kills = 0;
    for (uint32_t i = 0; i < FILLERS; i++)
        fillers[i] = start_filler(path, i * (PHOTONS / FILLERS));
    while (kills < KILLS) {
        const struct timespec nap = {0, (long)(rng_next(&random) % 4000000)};
        nanosleep(&nap, NULL);
        uint32_t i = (uint32_t)(rng_next(&random) % FILLERS);
        int ended;
        kill(fillers[i], SIGKILL);
        assert_int_equal(waitpid(fillers[i], &ended, 0), fillers[i]);
        assert_true(WIFSIGNALED(ended) || WEXITSTATUS(ended) == 0);
        kills += WIFSIGNALED(ended);
        if (!WIFSIGNALED(ended)) { /* all is ready: once more from the beginning */
            opened o;
            open_map(&o, path);
            for (uint32_t k = 0; k < PHOTONS; k++)
                if (irradiance_word_is_ready(irradiance_slot_read(photon_block_slot(o.map.blocks, k))))
                    store_relaxed_u32(photon_block_slot(o.map.blocks, k), 0);
            close_map(&o);
            kills++;
        }
        fillers[i] = start_filler(path, (uint32_t)(rng_next(&random) % PHOTONS));
    }
    for (uint32_t i = 0; i < FILLERS; i++) {
        int ended;
        assert_int_equal(waitpid(fillers[i], &ended, 0), fillers[i]);
        assert_true(WIFEXITED(ended) && WEXITSTATUS(ended) == 0);
    }
    opened o;
    open_map(&o, path);
    for (uint32_t i = 0; i < PHOTONS; i++)
        expect_right(&o.map, i, ask(&o, i));
    close_map(&o);
    test_run_reset(&r);
}

/* Patience is lost once for each process that stands still, not for each of its claims; and a cancelled run waits for
 * nobody. */
static void one_that_stands_still_is_remembered(void **state)
{
    (void)state;
    test_run r;
    opened o;
    const char *path = open_new_map(&r, &o);
    int ready, order;
    pid_t id = start_holder(path, &ready, &order);
    assert_int_equal(kill(id, SIGSTOP), 0);
    irradiance_request request = {.bearer = 0};
    run_context run;
    run_context_init(&run, NULL, NULL, NULL, NULL);
    run_cancel(&run);
    irradiance_cache_retry(&o.cache, &run, &request, 0);
    assert_int_equal(request.bearer, PHOTON_NONE);
    assert_false(request.holds);
    assert_int_equal(irradiance_cache_counters(&o.cache).reclaimed, 0);
    run_context_reset(&run);

    ask(&o, 0); /* some seconds */
    for (uint32_t i = 1; i < HELD; i++) {
        claim_wait wait = {0};
        assert_true(claim_owners_wait(&o.file.owners, &wait, irradiance_slot_read(photon_block_slot(o.map.blocks, i))));
        expect_right(&o.map, i, ask(&o, i));
    }
    assert_int_equal(irradiance_cache_counters(&o.cache).reclaimed, HELD);
    assert_int_equal(irradiance_cache_counters(&o.cache).duplicated, 0);
    assert_int_equal(kill(id, SIGKILL), 0);
    assert_int_equal(waitpid(id, NULL, 0), id);
    close_map(&o);
    close(ready);
    close(order);
    test_run_reset(&r);
}

/* A claim of one's own process is another thread's, at work: it is waited for, however long that takes. */
static void own_claims_are_not_taken_over(void **state)
{
    (void)state;
    test_run r;
    opened o;
    open_new_map(&r, &o);
    uint32_t word, own = irradiance_word(IRRADIANCE_CLAIMED, load_relaxed_u32(&o.file.owners.claimer));
    assert_true(
        irradiance_slot_try_claim(photon_block_slot(o.map.blocks, 0), load_relaxed_u32(&o.file.owners.claimer), &word));
    claim_wait wait = {.word = own, .begin = clock_seconds() - 1000.0}; /* it has taken a quarter of an hour so far */
    for (int i = 0; i < 1000; i++)
        assert_false(claim_owners_wait(&o.file.owners, &wait, own));
    close_map(&o);
    test_run_reset(&r);
}

typedef struct thief {
    opened *victim;
    claim_owners *own;
    uint32_t stolen; /* claims taken over while the victim computes */
    atomic_u32 stops;
} thief;

/* Takes every claim of the victim's over that it sees, and never publishes: as one does who thinks it dead. */
static void *steal(void *user)
{
    thief *t = user;
    uint32_t own = load_relaxed_u32(&t->own->claimer);
    for (uint32_t i = 0; !load_relaxed_u32(&t->stops); i = (i + 1) % PHOTONS) {
        irradiance_slot *slot = photon_block_slot(t->victim->map.blocks, i);
        uint32_t word = irradiance_slot_read(slot);
        if (irradiance_word_state(word) == IRRADIANCE_CLAIMED && (word & IRRADIANCE_VALUE_MASK) != own)
            t->stolen += irradiance_slot_take_over(slot, &word, own);
    }
    return NULL;
}

/* An estimate whose claim was taken over meanwhile counts as duplicated, and whoever computed it gets a new number. */
static void what_was_taken_over_is_counted(void **state)
{
    (void)state;
    test_run r;
    opened o, other;
    const char *path = open_new_map(&r, &o);
    open_map(&other, path);
    thief t = {.victim = &o, .own = &other.file.owners};
    uint32_t before = load_relaxed_u32(&o.file.owners.claimer), asked = 0;
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, steal, &t), 0);
    /* as often as it takes the thief to come in between: a busy machine may not let it run at all for a while */
    enum { ROUNDS_MAX = 20000 };
    while (irradiance_cache_counters(&o.cache).duplicated < 3 && asked < ROUNDS_MAX * (uint32_t)PHOTONS) {
        irradiance_request request;
        uint32_t i = asked++ % PHOTONS;
        store_relaxed_u32(photon_block_slot(o.map.blocks, i), 0); /* empty */
        field_place p = field_photon(&o.map, i);
        irradiance_cache_get(&o.cache, p.position, p.normal, 0, &request);
        if (request.bearer == PHOTON_NONE)
            expect_right(&o.map, i, request.irradiance);
    }
    store_relaxed_u32(&t.stops, 1);
    pthread_join(thread, NULL);
    irradiance_counters c = irradiance_cache_counters(&o.cache);
    assert_true(c.duplicated > 0);
    assert_int_equal(c.duplicated, t.stolen);
    uint32_t after = load_relaxed_u32(&o.file.owners.claimer);
    assert_int_not_equal(after, before);
    assert_true(claim_owners_is_alive(&other.file.owners, after));
    assert_false(claim_owners_is_alive(&other.file.owners, before));
    close_map(&other);
    close_map(&o);
    test_run_reset(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(what_was_computed_is_there_again),
        TEST_IN_FOLDER(bearers_are_kept),
        TEST_IN_FOLDER(what_was_made_of_something_else_is_refused),
        TEST_IN_FOLDER(what_is_damaged_is_refused),
        TEST_IN_FOLDER(slots_may_hold_anything),
        TEST_IN_FOLDER(flipped_bits_change_no_irradiance),
        cmocka_unit_test(check_bytes_tell_bits),
        TEST_IN_FOLDER(a_copy_has_no_claims),
        TEST_IN_FOLDER(a_full_disk_is_an_error),
        TEST_IN_FOLDER(a_dead_process_leaves_no_claim),
        TEST_IN_FOLDER(a_stopped_process_is_not_waited_for),
        TEST_IN_FOLDER(one_that_stands_still_is_remembered),
        TEST_IN_FOLDER(own_claims_are_not_taken_over),
        TEST_IN_FOLDER(what_was_taken_over_is_counted),
        TEST_IN_FOLDER(processes_are_killed_at_random),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
