/* test_parallel_for.c: every block once, merged results independent of the workers, cancellation, progress.
 * Threads: assertions are the main thread's; workers only write down what they saw. */
#define _GNU_SOURCE
#include "parallel_for.h"

#include "clock.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <sched.h>
#include <string.h>
#include <time.h>

static const unsigned worker_counts[] = {1, 2, 3, 8, 64};
#define WORKER_COUNTS (sizeof worker_counts / sizeof worker_counts[0])

enum { MOST_ITEMS = 10000, MOST_BLOCKS = MOST_ITEMS };

typedef struct surroundings {
    thread_pool *pool;
    run_context run;
} surroundings;

static void set_up(surroundings *s, unsigned worker_count, ag_progress_fn *progress, void *user)
{
    assert_int_equal(thread_pool_create(worker_count, &s->pool), AG_OK);
    run_context_init(&s->run, s->pool, NULL, progress, user);
}

static void tear_down(surroundings *s)
{
    run_context_reset(&s->run);
    thread_pool_destroy(s->pool);
}

/* Plain memory on purpose: an item done twice at once is a race that TSan sees. */
typedef struct coverage {
    uint64_t count, block_size;
    unsigned worker_count;
    unsigned char item_done[MOST_ITEMS], block_done[MOST_BLOCKS];
    atomic_u64 wrong_calls;
} coverage;

static coverage covered;

static void cover(void *user, uint64_t begin, uint64_t end, uint64_t block_index, unsigned worker_index)
{
    coverage *c = user;
    uint64_t expected_end = begin + c->block_size < c->count ? begin + c->block_size : c->count;
    if (begin != block_index * c->block_size || end != expected_end || begin >= end || worker_index >= c->worker_count)
        fetch_add_relaxed_u64(&c->wrong_calls, 1);
    c->block_done[block_index]++;
    for (uint64_t i = begin; i < end; i++)
        c->item_done[i]++;
}

static void test_every_block_once(void **state)
{
    (void)state;
    static const uint64_t counts[] = {0, 1, 2, 63, 64, 65, 1000, MOST_ITEMS};
    static const uint64_t block_sizes[] = {1, 7, 64, 1000, UINT64_MAX};
    for (size_t k = 0; k < WORKER_COUNTS; k++) {
        surroundings s;
        set_up(&s, worker_counts[k], NULL, NULL);
        for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
            for (size_t j = 0; j < sizeof block_sizes / sizeof block_sizes[0]; j++) {
                memset(&covered, 0, sizeof covered);
                covered.count = counts[i];
                /* so that begin + block_size does not wrap in the check above */
                covered.block_size = block_sizes[j] == UINT64_MAX ? UINT64_MAX / 2 : block_sizes[j];
                covered.worker_count = worker_counts[k];
                assert_int_equal(
                    parallel_for(&s.run, counts[i], block_sizes[j], cover, &covered, AG_PHASE_RENDER, 0, 0), AG_OK);
                uint64_t block_count = counts[i] == 0 ? 0 : (counts[i] - 1) / block_sizes[j] + 1;
                assert_int_equal(load_relaxed_u64(&covered.wrong_calls), 0);
                for (uint64_t item = 0; item < MOST_ITEMS; item++)
                    assert_int_equal(covered.item_done[item], item < counts[i]);
                for (uint64_t block = 0; block < MOST_BLOCKS; block++)
                    assert_int_equal(covered.block_done[block], block < block_count);
            }
        tear_down(&s);
    }
}

/* Terms of very different size: their sum depends on the order in which it is taken. */
static void sum_block(void *user, uint64_t begin, uint64_t end, uint64_t block_index, unsigned worker_index)
{
    (void)worker_index;
    float sum = 0.0f;
    for (uint64_t i = begin; i < end; i++)
        sum += ldexpf((float)(i * 2654435761u % 1000u), (int)(i * 40503u % 41u) - 20);
    ((float *)user)[block_index] = sum;
}

static void test_merging_by_block_does_not_depend_on_the_workers(void **state)
{
    (void)state;
    enum { BLOCK_SIZE = 13, BLOCKS = (MOST_ITEMS + BLOCK_SIZE - 1) / BLOCK_SIZE };
    float first = 0.0f;
    for (size_t k = 0; k < WORKER_COUNTS; k++) {
        surroundings s;
        set_up(&s, worker_counts[k], NULL, NULL);
        float sums[BLOCKS] = {0}, total = 0.0f, backwards = 0.0f;
        assert_int_equal(parallel_for(&s.run, MOST_ITEMS, BLOCK_SIZE, sum_block, sums, AG_PHASE_PHOTONS, 0, 0), AG_OK);
        tear_down(&s);
        for (int i = 0; i < BLOCKS; i++) {
            total += sums[i];
            backwards += sums[BLOCKS - 1 - i];
        }
        if (k == 0)
            first = total;
        assert_memory_equal(&total, &first, sizeof total);
        assert_memory_not_equal(&total, &backwards, sizeof total); /* else this test would show nothing */
    }
}

enum { CANCELLING_BLOCK = 5, CANCELLED_BLOCKS = 1000 };

typedef struct cancellation {
    run_context *run;
    unsigned char done[CANCELLED_BLOCKS];
} cancellation;

/* Blocks behind the one that cancels wait for it, so that however threads are scheduled it does come in time. */
static void cancel_or_wait(void *user, uint64_t begin, uint64_t end, uint64_t block_index, unsigned worker_index)
{
    (void)begin, (void)end, (void)worker_index;
    cancellation *c = user;
    if (block_index == CANCELLING_BLOCK)
        run_cancel(c->run);
    while (block_index > CANCELLING_BLOCK && !run_is_cancelled(c->run))
        sched_yield();
    c->done[block_index]++;
}

static void test_cancellation_between_blocks(void **state)
{
    (void)state;
    for (size_t k = 0; k < WORKER_COUNTS; k++) {
        surroundings s;
        set_up(&s, worker_counts[k], NULL, NULL);
        cancellation c = {.run = &s.run};
        assert_int_equal(parallel_for(&s.run, CANCELLED_BLOCKS, 1, cancel_or_wait, &c, AG_PHASE_RENDER, 0, 1),
                         AG_CANCELLED);
        unsigned done_count = 0;
        for (unsigned i = 0; i < CANCELLED_BLOCKS; i++) {
            assert_in_range(c.done[i], 0, 1);
            done_count += c.done[i];
        }
        for (unsigned i = 0; i <= CANCELLING_BLOCK; i++)
            assert_int_equal(c.done[i], 1); /* what was claimed is finished */
        assert_in_range(done_count, CANCELLING_BLOCK + 1, CANCELLING_BLOCK + worker_counts[k]);
        /* once cancelled, nothing begins; but where there is nothing to do, all is done */
        memset(c.done, 0, sizeof c.done);
        assert_int_equal(parallel_for(&s.run, 10, 1, cancel_or_wait, &c, AG_PHASE_RENDER, 0, 0), AG_CANCELLED);
        for (unsigned i = 0; i < 10; i++)
            assert_int_equal(c.done[i], 0);
        assert_int_equal(parallel_for(&s.run, 0, 1, cancel_or_wait, &c, AG_PHASE_RENDER, 0, 0), AG_OK);
        tear_down(&s);
    }
}

static void cancel_in_the_last(void *user, uint64_t begin, uint64_t end, uint64_t block_index, unsigned worker_index)
{
    (void)begin, (void)end, (void)worker_index;
    if (block_index == 9)
        run_cancel(user);
}

static void test_cancelled_when_all_is_done(void **state)
{
    (void)state;
    surroundings s;
    set_up(&s, 1, NULL, NULL);
    assert_int_equal(parallel_for(&s.run, 10, 1, cancel_in_the_last, &s.run, AG_PHASE_RENDER, 0, 0), AG_OK);
    assert_true(run_is_cancelled(&s.run));
    tear_down(&s);
}

/* Plain memory on purpose: two calls at once are a race that TSan sees. */
enum { MOST_TOLD = 10000 };
typedef struct told {
    atomic_u32 inside;
    unsigned overlapping, count;
    ag_phase phase[MOST_TOLD];
    double fraction[MOST_TOLD];
} told;

static told heard;

static void hear(void *user, ag_phase phase, double fraction)
{
    told *t = user;
    uint32_t nobody = 0;
    if (!cas_acquire_u32(&t->inside, &nobody, 1)) /* pairs with the store below */
        t->overlapping++;
    if (t->count < MOST_TOLD) {
        t->phase[t->count] = phase;
        t->fraction[t->count] = fraction;
    }
    t->count++;
    sched_yield();
    store_release_u32(&t->inside, 0);
}

static void assert_rises(const told *t, unsigned from, unsigned to, ag_phase phase, double first, double last)
{
    assert_true(from < to && to <= MOST_TOLD);
    assert_true(t->fraction[from] == first);
    assert_true(t->fraction[to - 1] == last);
    for (unsigned i = from; i < to; i++) {
        assert_int_equal(t->phase[i], phase);
        assert_true(i == from || t->fraction[i] > t->fraction[i - 1]);
    }
}

static void test_progress_of_parallel_for(void **state)
{
    (void)state;
    for (size_t k = 0; k < WORKER_COUNTS; k++) {
        memset(&heard, 0, sizeof heard);
        memset(&covered, 0, sizeof covered);
        surroundings s;
        set_up(&s, worker_counts[k], hear, &heard);
        covered.count = MOST_ITEMS;
        covered.block_size = 1;
        covered.worker_count = worker_counts[k];
        /* two loops share a phase */
        parallel_for(&s.run, MOST_ITEMS, 1, cover, &covered, AG_PHASE_PHOTONS, 0.0, 0.1);
        parallel_for(&s.run, MOST_ITEMS, 1, cover, &covered, AG_PHASE_PHOTONS, 0.1, 1.0);
        unsigned photon_end = heard.count;
        assert_rises(&heard, 0, photon_end, AG_PHASE_PHOTONS, 0.0, 1.0);
        parallel_for(&s.run, MOST_ITEMS, 1, cover, &covered, AG_PHASE_RENDER, 0.5, 0.5); /* tells nothing */
        assert_int_equal(heard.count, photon_end);
        parallel_for(&s.run, 0, 1, cover, &covered, AG_PHASE_MAP, 0.0, 1.0); /* nothing to do is soon done */
        assert_rises(&heard, photon_end, heard.count, AG_PHASE_MAP, 0.0, 1.0);
        assert_int_equal(heard.overlapping, 0);
        tear_down(&s);
    }
}

static void test_progress_is_clamped_and_never_falls(void **state)
{
    (void)state;
    memset(&heard, 0, sizeof heard);
    surroundings s;
    set_up(&s, 1, hear, &heard);
    run_progress(&s.run, AG_PHASE_LOAD, -3.0);
    run_progress(&s.run, AG_PHASE_LOAD, (double)NAN);
    run_progress(&s.run, AG_PHASE_LOAD, 7.0);
    run_progress(&s.run, AG_PHASE_LOAD, 0.5);
    run_progress(&s.run, AG_PHASE_LOAD, 0.0);
    run_progress(&s.run, AG_PHASE_LOAD, 1.0);
    assert_int_equal(heard.count, 2);
    assert_rises(&heard, 0, 2, AG_PHASE_LOAD, 0.0, 1.0);
    run_progress(&s.run, AG_PHASE_BVH, 0.5); /* a phase begins at 0, whatever comes first */
    run_progress(&s.run, AG_PHASE_BVH, 1.0);
    assert_rises(&heard, 2, heard.count, AG_PHASE_BVH, 0.0, 1.0);
    tear_down(&s);
    run_context_init(&s.run, NULL, NULL, NULL, NULL);
    run_progress(&s.run, AG_PHASE_LOAD, 1.0); /* nobody to tell */
    run_context_reset(&s.run);
}

static void tell_often(void *user, unsigned worker_index)
{
    (void)worker_index;
    for (int i = 1; i < 20000; i++)
        run_progress(user, AG_PHASE_RENDER, i / 20000.0);
}

static void test_progress_is_rare(void **state)
{
    (void)state;
    memset(&heard, 0, sizeof heard);
    surroundings s;
    set_up(&s, 8, hear, &heard);
    double start = clock_seconds();
    run_progress(&s.run, AG_PHASE_RENDER, 0.0);
    thread_pool_run(s.pool, tell_often, &s.run);
    run_progress(&s.run, AG_PHASE_RENDER, 1.0);
    double passed = clock_seconds() - start;
    assert_true(heard.count <= 2.0 + passed * 20.0); /* however long it took */
    assert_rises(&heard, 0, heard.count, AG_PHASE_RENDER, 0.0, 1.0);
    assert_int_equal(heard.overlapping, 0);
    tear_down(&s);
}

/* --- what is watched --- */

enum { WATCHED_BLOCKS = 4000, LOST_AT = 100 };
typedef struct watched_thing {
    atomic_u64 done, thorough, thorough_at_once, most_at_once;
    bool is_lost_thoroughly; /* only thorough looks find out that it is lost */
} watched_thing;

static bool look_at_thing(const void *watched, bool thoroughly)
{
    watched_thing *t = (watched_thing *)(uintptr_t)watched;
    bool is_lost = load_relaxed_u64(&t->done) >= LOST_AT;
    if (!thoroughly)
        return t->is_lost_thoroughly || !is_lost;
    fetch_add_relaxed_u64(&t->thorough, 1);
    uint64_t others = fetch_add_relaxed_u64(&t->thorough_at_once, 1);
    if (others > load_relaxed_u64(&t->most_at_once))
        store_relaxed_u64(&t->most_at_once, others);
    fetch_add_relaxed_u64(&t->thorough_at_once, UINT64_MAX);
    return !is_lost;
}

static void work_on_thing(void *user, uint64_t begin, uint64_t end, uint64_t block_index, unsigned worker_index)
{
    (void)begin, (void)end, (void)block_index, (void)worker_index;
    watched_thing *t = user;
    if (fetch_add_relaxed_u64(&t->done, 1) >= LOST_AT)
        nanosleep(&(struct timespec){0, 2000000}, NULL); /* so that all of it would take seconds */
}

static void test_what_is_lost_breaks_a_phase_off(void **state)
{
    (void)state;
    for (int thoroughly = 0; thoroughly < 2; thoroughly++)
        for (size_t w = 0; w < WORKER_COUNTS; w++) {
            surroundings s;
            watched_thing thing = {.is_lost_thoroughly = thoroughly};
            set_up(&s, worker_counts[w], NULL, NULL);
            run_begin_watch(&s.run, look_at_thing, &thing);
            double start = clock_seconds();
            uint64_t blocks = WATCHED_BLOCKS * worker_counts[w];
            assert_int_equal(parallel_for(&s.run, blocks, 1, work_on_thing, &thing, AG_PHASE_MAP, 0.0, 0.0),
                             AG_CANCELLED);
            assert_true(load_relaxed_u64(&thing.done) < blocks);
            assert_true((double)load_relaxed_u64(&thing.thorough) <= 1.0 + 2.0 * (clock_seconds() - start));
            assert_int_equal(load_relaxed_u64(&thing.most_at_once), 0);
            assert_true(run_end_break(&s.run));
            run_end_watch(&s.run);
            assert_int_equal(parallel_for(&s.run, 2 * LOST_AT, 1, work_on_thing, &thing, AG_PHASE_MAP, 0.0, 0.0),
                             AG_OK); /* nobody looks any more */
            assert_false(run_end_break(&s.run));
            tear_down(&s);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_block_once),
        cmocka_unit_test(test_merging_by_block_does_not_depend_on_the_workers),
        cmocka_unit_test(test_cancellation_between_blocks),
        cmocka_unit_test(test_cancelled_when_all_is_done),
        cmocka_unit_test(test_progress_of_parallel_for),
        cmocka_unit_test(test_progress_is_clamped_and_never_falls),
        cmocka_unit_test(test_progress_is_rare),
        cmocka_unit_test(test_what_is_lost_breaks_a_phase_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
