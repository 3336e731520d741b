/* test_thread_pool.c: every worker once per job, quiet when idle, floating point state, signals, failing creation.
 * Threads: assertions are the main thread's; workers only write down what they saw. */
#define _GNU_SOURCE
#include "thread_pool.h"

#include "atomics.h"
#include "clock.h"
#include "cpu_count.h"
#include "fixtures/sanitizer.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <dirent.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

enum { MOST_WORKERS = 64 };

static const unsigned worker_counts[] = {1, 2, 3, 8, MOST_WORKERS};
#define WORKER_COUNTS (sizeof worker_counts / sizeof worker_counts[0])

static thread_pool *create_pool(unsigned worker_count)
{
    thread_pool *pool = NULL;
    assert_int_equal(thread_pool_create(worker_count, &pool), AG_OK);
    assert_non_null(pool);
    return pool;
}

/* Not atomic on purpose: a worker called twice at once, or a job that returns early, is a race that TSan sees. */
typedef struct calls {
    unsigned count[MOST_WORKERS];
    pthread_t thread[MOST_WORKERS];
} calls;

static void count_call(void *user, unsigned worker_index)
{
    calls *c = user;
    c->count[worker_index]++;
    c->thread[worker_index] = pthread_self();
}

static void test_each_worker_once_per_job(void **state)
{
    (void)state;
    for (size_t k = 0; k < WORKER_COUNTS; k++) {
        thread_pool *pool = create_pool(worker_counts[k]);
        assert_int_equal(thread_pool_worker_count(pool), worker_counts[k]);
        calls c = {{0}, {0}}, before;
        for (unsigned job = 1; job <= 20; job++) {
            before = c;
            thread_pool_run(pool, count_call, &c);
            for (unsigned w = 0; w < MOST_WORKERS; w++)
                assert_int_equal(c.count[w], w < worker_counts[k] ? job : 0);
            assert_true(pthread_equal(c.thread[0], pthread_self()));
            for (unsigned w = 1; w < worker_counts[k]; w++) {
                assert_false(pthread_equal(c.thread[w], pthread_self()));
                assert_true(job == 1 || pthread_equal(c.thread[w], before.thread[w])); /* an index is a thread */
            }
        }
        thread_pool_destroy(pool);
    }
}

static void add_one(void *user, unsigned worker_index)
{
    (void)worker_index;
    fetch_add_relaxed_u64(user, 1);
}

static void test_many_quick_jobs(void **state)
{
    (void)state;
    for (unsigned worker_count = 2; worker_count <= 8; worker_count *= 2) {
        thread_pool *pool = create_pool(worker_count);
        atomic_u64 total = 0;
        for (unsigned job = 1; job <= 2000; job++) {
            thread_pool_run(pool, add_one, &total);
            assert_int_equal(load_relaxed_u64(&total), (uint64_t)job * worker_count);
        }
        thread_pool_destroy(pool);
    }
}

static unsigned thread_count_of_process(void)
{
    DIR *tasks = opendir("/proc/self/task");
    if (!tasks)
        return 0;
    unsigned count = 0;
    for (struct dirent *entry; (entry = readdir(tasks));)
        count += entry->d_name[0] != '.';
    closedir(tasks);
    return count;
}

/* A joined thread can be listed a moment longer, while the kernel still buries it. */
static bool thread_count_comes_to(unsigned expected)
{
    for (int i = 0; i < 1000; i++) {
        if (thread_count_of_process() == expected)
            return true;
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
    return false;
}

static void test_create_and_destroy_in_a_loop(void **state)
{
    (void)state;
    thread_pool_destroy(NULL);
    thread_pool_destroy(create_pool(2)); /* a sanitizer's own thread may come with the first */
    unsigned threads_before = thread_count_of_process();
    for (int i = 0; i < 100; i++) {
        thread_pool *pool = create_pool(1 + (unsigned)i % 8);
        atomic_u64 total = 0;
        if (i % 3 != 0) { /* some are destroyed before their threads have looked around */
            thread_pool_run(pool, add_one, &total);
            assert_int_equal(load_relaxed_u64(&total), thread_pool_worker_count(pool));
        }
        thread_pool_destroy(pool);
    }
    assert_true(thread_count_comes_to(threads_before));
}

static void test_two_pools(void **state)
{
    (void)state;
    thread_pool *a = create_pool(3), *b = create_pool(4);
    atomic_u64 total = 0;
    for (int i = 0; i < 100; i++) {
        thread_pool_run(a, add_one, &total);
        thread_pool_run(b, add_one, &total);
    }
    assert_int_equal(load_relaxed_u64(&total), 700);
    thread_pool_destroy(a);
    thread_pool_destroy(b);
}

static void test_default_count(void **state)
{
    (void)state;
    thread_pool *pool = create_pool(0);
    assert_int_equal(thread_pool_worker_count(pool), cpu_count_available());
    thread_pool_destroy(pool);
}

/* CPU time, not wall time: a worker that spins for want of work would use 200 ms for every core there is. */
static void test_idle_workers_sleep(void **state)
{
    (void)state;
    thread_pool *pool = create_pool(8);
    atomic_u64 total = 0;
    thread_pool_run(pool, add_one, &total);
    double cpu_before = clock_process_cpu_seconds();
    nanosleep(&(struct timespec){.tv_nsec = 200000000}, NULL);
    assert_true(clock_process_cpu_seconds() - cpu_before < 0.05);
    thread_pool_destroy(pool);
}

/* Each worker needs all others to arrive, so they must run at once, however few the cores. */
static void meet_all(void *user, unsigned worker_index)
{
    (void)worker_index;
    pthread_barrier_wait(user);
}

static void test_all_workers_run_at_once(void **state)
{
    (void)state;
    thread_pool *pool = create_pool(MOST_WORKERS);
    pthread_barrier_t barrier;
    assert_int_equal(pthread_barrier_init(&barrier, NULL, MOST_WORKERS), 0);
    for (int i = 0; i < 10; i++)
        thread_pool_run(pool, meet_all, &barrier);
    pthread_barrier_destroy(&barrier);
    thread_pool_destroy(pool);
}

#if defined(__SSE__)
enum { CONTROL_BITS = 0xffc0, FLUSHING_ROUNDING_NEAREST = 0x9fc0 }; /* all but the sticky flags */

static void note_mxcsr(void *user, unsigned worker_index)
{
    unsigned *seen = user;
    seen[worker_index] = _mm_getcsr() & CONTROL_BITS;
    _mm_setcsr(_mm_getcsr() ^ _MM_ROUND_UP); /* what a careless library leaves behind must not reach the next job */
}

static void test_mxcsr(void **state)
{
    (void)state;
    const unsigned original = _mm_getcsr();
    const unsigned callers[] = {original, original | _MM_ROUND_TOWARD_ZERO, original | _MM_FLUSH_ZERO_ON};
    for (size_t k = 0; k < sizeof callers / sizeof callers[0]; k++) {
        _mm_setcsr(callers[k]);
        thread_pool *pool = create_pool(8); /* threads inherit the creator's state */
        for (int job = 0; job < 3; job++) {
            unsigned seen[8] = {0};
            thread_pool_run(pool, note_mxcsr, seen);
            unsigned after = _mm_getcsr();
            _mm_setcsr(original);
            for (unsigned w = 0; w < 8; w++)
                assert_int_equal(seen[w], FLUSHING_ROUNDING_NEAREST);
            assert_int_equal(after & CONTROL_BITS, callers[k] & CONTROL_BITS);
            _mm_setcsr(callers[k]);
        }
        thread_pool_destroy(pool);
        _mm_setcsr(original);
    }
}
#endif

typedef struct identity {
    sigset_t blocked;
    char name[16];
} identity;

static void note_identity(void *user, unsigned worker_index)
{
    identity *seen = (identity *)user + worker_index;
    pthread_sigmask(SIG_SETMASK, NULL, &seen->blocked);
    pthread_getname_np(pthread_self(), seen->name, sizeof seen->name);
}

static void test_names_and_signals(void **state)
{
    (void)state;
    char callers_name[16];
    pthread_getname_np(pthread_self(), callers_name, sizeof callers_name);
    thread_pool *pool = create_pool(4);
    identity seen[4];
    memset(seen, 0, sizeof seen);
    thread_pool_run(pool, note_identity, seen);
    static const int programs[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGCHLD, SIGPIPE, SIGALRM};
    for (unsigned w = 0; w < 4; w++) {
        char name[16];
        snprintf(name, sizeof name, "afterglow-%u", w);
        assert_string_equal(seen[w].name, w == 0 ? callers_name : name);
        for (size_t i = 0; i < sizeof programs / sizeof programs[0]; i++)
            assert_int_equal(sigismember(&seen[w].blocked, programs[i]), w != 0);
        assert_int_equal(sigismember(&seen[w].blocked, SIGSEGV), 0);
    }
    thread_pool_destroy(pool);
}

/* Runs in a process of its own, with address space for some of the stacks but not for all. */
static void test_creation_fails_part_way(void **state)
{
    (void)state;
#if IS_SANITIZED
    skip(); /* sanitizers reserve address space themselves, and end the process when they get none */
#else
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        unsigned long pages = 0;
        FILE *statm = fopen("/proc/self/statm", "r");
        if (!statm || fscanf(statm, "%lu", &pages) != 1)
            _exit(2);
        fclose(statm);
        pthread_attr_t attributes;
        size_t stack_bytes = 0;
        if (pthread_getattr_default_np(&attributes) != 0 || pthread_attr_getstacksize(&attributes, &stack_bytes) != 0)
            _exit(2);
        rlim_t limit = (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE) + 5 * (rlim_t)stack_bytes;
        if (setrlimit(RLIMIT_AS, &(struct rlimit){limit, limit}) != 0)
            _exit(2);
        thread_pool *pool = NULL;
        if (thread_pool_create(3, &pool) != AG_OK) /* a few do fit */
            _exit(3);
        thread_pool_destroy(pool);
        pool = (thread_pool *)&pool;
        if (thread_pool_create(MOST_WORKERS, &pool) != AG_ERROR_SYSTEM || pool != NULL)
            _exit(4);
        _exit(thread_count_comes_to(1) ? 0 : 5);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
#endif
}

static void use_cpu(void *user, unsigned worker_index)
{
    (void)worker_index;
    volatile uint32_t x = 1;
    double until = clock_thread_cpu_seconds() + 0.01;
    while (clock_thread_cpu_seconds() < until)
        x = x * 1664525u + 1013904223u;
    fetch_add_relaxed_u64(user, 1);
}

static void test_clocks(void **state)
{
    (void)state;
    double start = clock_seconds(), cpu_start = clock_process_cpu_seconds();
    thread_pool *pool = create_pool(3);
    atomic_u64 total = 0;
    thread_pool_run(pool, use_cpu, &total);
    thread_pool_destroy(pool);
    assert_int_equal(load_relaxed_u64(&total), 3);
    assert_true(clock_seconds() > start);
    assert_true(clock_process_cpu_seconds() - cpu_start >= 0.03); /* all threads', ended ones too */
    assert_true(clock_process_cpu_seconds() >= clock_thread_cpu_seconds());
    assert_true(peak_memory_bytes() > 100000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_creation_fails_part_way), /* first: it forks while there is one thread */
        cmocka_unit_test(test_each_worker_once_per_job),
        cmocka_unit_test(test_many_quick_jobs),
        cmocka_unit_test(test_create_and_destroy_in_a_loop),
        cmocka_unit_test(test_two_pools),
        cmocka_unit_test(test_default_count),
        cmocka_unit_test(test_idle_workers_sleep),
        cmocka_unit_test(test_all_workers_run_at_once),
#if defined(__SSE__)
        cmocka_unit_test(test_mxcsr),
#endif
        cmocka_unit_test(test_names_and_signals),
        cmocka_unit_test(test_clocks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
