/* test_photon_file_processes.c: processes that share a map's file compute nothing twice, and what dead or stopped ones
 * have left is found. Threads: processes of its own, and threads that take claims. */
/* ctest: sanitize */
#define _GNU_SOURCE
#include "clock.h"
#include "fixtures/photon_file_fixture.h"

#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <sys/wait.h>

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

    /* nor where another has taken its number */
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

/* A process that is stopped while it holds a claim is waited for some seconds, and then no more: its value comes too
 * late. */
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
    field_point p = field_photon(&o.map, 0);
    irradiance_request request = {.query = {p.position, p.normal}, .irradiance_photon = 0};
    run_context run;
    run_context_init(&run, NULL, NULL, NULL, NULL);
    run_cancel(&run);
    irradiance_cache_retry(&o.cache, &run, &request, 0);
    assert_int_equal(request.irradiance_photon, PHOTON_NONE);
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

/* A claim of one's own process is another thread's, at work: it is waited for, for seconds. */
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
        field_point p = field_photon(&o.map, i);
        irradiance_cache_get(&o.cache, p.position, p.normal, 0, &request);
        if (request.irradiance_photon == PHOTON_NONE)
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
        TEST_IN_FOLDER(a_dead_process_leaves_no_claim),      TEST_IN_FOLDER(a_stopped_process_is_not_waited_for),
        TEST_IN_FOLDER(one_that_stands_still_is_remembered), TEST_IN_FOLDER(own_claims_are_not_taken_over),
        TEST_IN_FOLDER(what_was_taken_over_is_counted),      TEST_IN_FOLDER(processes_are_killed_at_random),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
