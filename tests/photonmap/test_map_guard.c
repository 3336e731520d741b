/* test_map_guard.c: memory of a file that was cut short reads as zeros, and faults elsewhere come to the handlers of
 * others, in whatever order these and ours were installed. Threads: one. */
#define _GNU_SOURCE
#include "map_guard.h"

#include "fixtures/temporary_folder.h"

#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

enum { BYTES = 4096 };

/* Maps a file, guarded where out_guard is not NULL, and then cuts it to nothing. */
static volatile char *map_lost_file(int *out_guard)
{
    int file = open(in_folder("lost"), O_RDWR | O_CREAT | O_TRUNC, 0600);
    assert_true(file >= 0 && ftruncate(file, BYTES) == 0);
    char *memory = mmap(NULL, BYTES, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    assert_true(memory != MAP_FAILED);
    memory[0] = 1;
    if (out_guard) {
        *out_guard = map_guard_add(memory, BYTES);
        assert_true(*out_guard >= 0);
        assert_false(map_guard_is_lost(*out_guard));
    }
    assert_true(ftruncate(file, 0) == 0 && close(file) == 0);
    return memory;
}

static void lost_memory_reads_as_zeros(void **state)
{
    (void)state;
    int guard;
    volatile char *memory = map_lost_file(&guard);
    assert_int_equal(memory[0], 0);
    assert_true(map_guard_is_lost(guard));
    map_guard_remove(guard);
    munmap((void *)memory, BYTES);
}

static sigjmp_buf back;
static struct sigaction before_library;
static volatile sig_atomic_t host_faults, library_faults;

static void host_handler(int number)
{
    (void)number;
    host_faults++;
    siglongjmp(back, 1);
}

/* A library's handler, which passes all faults on to the handler that it has replaced. */
static void library_handler(int number, siginfo_t *info, void *context)
{
    library_faults++;
    before_library.sa_sigaction(number, info, context);
}

static void touch_lost_memory(void)
{
    volatile char *memory = map_lost_file(NULL);
    if (sigsetjmp(back, 1) == 0)
        (void)memory[0];
    munmap((void *)memory, BYTES);
}

/* Installed are the host's handler, ours, a library's, and ours again. */
static void faults_of_others_reach_the_host(void **state)
{
    (void)state;
    struct sigaction host = {.sa_handler = host_handler}, library = {.sa_sigaction = library_handler};
    struct sigaction found;
    library.sa_flags = SA_SIGINFO;
    assert_int_equal(sigaction(SIGBUS, &host, &found), 0);
    int guard;
    volatile char *memory = map_lost_file(&guard);
    assert_int_equal(sigaction(SIGBUS, &library, &before_library), 0);
    int other;
    volatile char *more = map_lost_file(&other);
    for (int i = 1; i < 3; i++) { /* a second time, since the host's handler never returns */
        touch_lost_memory();
        assert_int_equal(host_faults, i);
    }
    assert_true(library_faults > 0);
    assert_int_equal(memory[0] + more[0], 0);
    assert_true(map_guard_is_lost(guard) && map_guard_is_lost(other));
    map_guard_remove(guard);
    map_guard_remove(other);
    munmap((void *)memory, BYTES);
    munmap((void *)more, BYTES);
    assert_int_equal(sigaction(SIGBUS, &found, NULL), 0);
}

int main(void)
{
    /* the first one installs the host's handler before ours is there */
    const struct CMUnitTest tests[] = {TEST_IN_FOLDER(faults_of_others_reach_the_host),
                                       TEST_IN_FOLDER(lost_memory_reads_as_zeros)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
