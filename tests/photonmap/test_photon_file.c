/* test_photon_file.c: maps in a file: the same answers, kept irradiances; what is of something else is refused.
 * Threads: one. */
/* ctest: sanitize */
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
    EXPECT_REFUSED(key.estimates.bits[0]++, "photons or estimates of irradiance were others");
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
        TEST_IN_FOLDER(a_copy_has_no_claims),
        TEST_IN_FOLDER(a_full_disk_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
