/* test_atomic_file.c: files that appear whole or not at all, and targets that are no regular files.
 * Flow: tests of threads/atomic_file.c. Threads: one. */
#define _GNU_SOURCE
#include "atomic_file.h"
#include "fixtures/temporary_folder.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/wait.h>

enum { NOBODY = 65534 };

static void modes_of_new_and_old_files(void **state)
{
    (void)state;
    struct stat status;
    const mode_t saved = umask(022);
    assert_int_equal(atomic_file_write(NULL, in_folder("a"), "1", 1, message, sizeof message), AG_OK);
    umask(077);
    assert_int_equal(atomic_file_write(NULL, in_folder("b"), "2", 1, message, sizeof message), AG_OK);
    assert_int_equal(chmod(in_folder("a"), 0640), 0);
    assert_int_equal(stat(in_folder("b"), &status), 0);
    assert_int_equal(status.st_mode & 0777, 0600);
    assert_int_equal(atomic_file_write(NULL, in_folder("a"), "three", 5, message, sizeof message), AG_OK);
    umask(saved);
    assert_int_equal(stat(in_folder("a"), &status), 0);
    assert_int_equal(status.st_mode & 0777, 0640);
    expect_text(in_folder("a"), "three");
    assert_int_equal(atomic_file_write(NULL, in_folder("c"), "", 0, message, sizeof message), AG_OK);
    expect_text(in_folder("c"), "");
    assert_int_equal(entry_count(), 3);
}

static void names_as_long_as_they_may_be(void **state)
{
    (void)state;
    char name[300];
    memset(name, 'n', sizeof name);
    char path[512];
    snprintf(path, sizeof path, "%s/%.255s", folder, name);
    assert_int_equal(atomic_file_write(NULL, path, "1", 1, message, sizeof message), AG_OK);
    expect_text(path, "1");
    snprintf(path, sizeof path, "%s/%.256s", folder, name);
    expect_failure(atomic_file_write(NULL, path, "1", 1, message, sizeof message), AG_ERROR_OUTPUT, "too long");
    assert_int_equal(entry_count(), 1);
}

static void links_stay_links(void **state)
{
    (void)state;
    struct stat status;
    assert_int_equal(atomic_file_write(NULL, in_folder("real"), "old", 3, message, sizeof message), AG_OK);
    assert_int_equal(symlink("real", in_folder("link")), 0);
    assert_int_equal(symlink("link", in_folder("link_to_link")), 0);
    assert_int_equal(symlink(in_folder("later"), in_folder("dangling")), 0);
    assert_int_equal(symlink("loop", in_folder("loop")), 0);
    assert_int_equal(atomic_file_write(NULL, in_folder("link_to_link"), "new", 3, message, sizeof message), AG_OK);
    assert_int_equal(atomic_file_write(NULL, in_folder("dangling"), "made", 4, message, sizeof message), AG_OK);
    expect_text(in_folder("real"), "new");
    expect_text(in_folder("later"), "made");
    assert_true(lstat(in_folder("link"), &status) == 0 && S_ISLNK(status.st_mode));
    assert_true(lstat(in_folder("dangling"), &status) == 0 && S_ISLNK(status.st_mode));
    expect_failure(atomic_file_write(NULL, in_folder("loop"), "x", 1, message, sizeof message), AG_ERROR_OUTPUT,
                   "links");
    assert_int_equal(entry_count(), 6);
}

static void special_targets_are_written_directly(void **state)
{
    (void)state;
    char buffer[64], path[64];
    struct stat status;
    assert_int_equal(atomic_file_write(NULL, "/dev/null", "x", 1, message, sizeof message), AG_OK);
    assert_true(stat("/dev/null", &status) == 0 && S_ISCHR(status.st_mode));

    assert_int_equal(mkfifo(in_folder("fifo"), 0600), 0);
    assert_int_equal(atomic_file_check(in_folder("fifo"), message, sizeof message), AG_OK); /* does not wait */
    const int reader = open(in_folder("fifo"), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    assert_true(reader >= 0);
    assert_int_equal(atomic_file_write(NULL, in_folder("fifo"), "through", 7, message, sizeof message), AG_OK);
    assert_int_equal(read(reader, buffer, sizeof buffer), 7);
    assert_memory_equal(buffer, "through", 7);
    close(reader);
    assert_int_equal(entry_count(), 1);

    /* A descriptor of a redirected file: after what is there already, not over it. */
    const int fd = open(in_folder("log"), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    assert_int_equal(write(fd, "one ", 4), 4);
    snprintf(path, sizeof path, "/dev/fd/%d", fd);
    assert_int_equal(atomic_file_check(path, message, sizeof message), AG_OK);
    assert_int_equal(atomic_file_write(NULL, path, "two", 3, message, sizeof message), AG_OK);
    assert_int_equal(write(fd, " three", 6), 6);
    close(fd);
    expect_text(in_folder("log"), "one two three");
    expect_failure(atomic_file_write(NULL, path, "x", 1, message, sizeof message), AG_ERROR_OUTPUT, path);
}

static void remove_pending_and_end(int signal_number)
{
    (void)signal_number;
    atomic_file_unlink_pending();
    _exit(7);
}

static void a_signal_leaves_nothing_behind(void **state)
{
    (void)state;
    static char bytes[20000];
    assert_int_equal(atomic_file_write(NULL, in_folder("x"), "as before", 9, message, sizeof message), AG_OK);
    const pid_t child = fork();
    if (child == 0) { /* SIGXFSZ arrives in the middle of the write */
        struct rlimit saved;
        signal(SIGXFSZ, remove_pending_and_end);
        set_file_limit(4096, &saved);
        atomic_file_write(NULL, in_folder("x"), bytes, sizeof bytes, message, sizeof message);
        _exit(1);
    }
    int status = 0;
    assert_true(child > 0 && waitpid(child, &status, 0) == child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 7);
    expect_text(in_folder("x"), "as before");
    assert_int_equal(entry_count(), 1);
    atomic_file_unlink_pending(); /* nothing is pending: nothing happens */
    assert_int_equal(entry_count(), 1);
}

static void files_that_must_not_be_written(void **state)
{
    (void)state;
    assert_int_equal(atomic_file_write(NULL, in_folder("x"), "as before", 9, message, sizeof message), AG_OK);
    assert_int_equal(chmod(in_folder("x"), 0444), 0);
    assert_int_equal(chmod(folder, 0777), 0); /* so that only the file stands in the way */
    const bool root = geteuid() == 0;
    if (root)
        assert_int_equal(seteuid(NOBODY), 0);
    const ag_status status = atomic_file_write(NULL, in_folder("x"), "changed", 7, message, sizeof message);
    if (root)
        assert_int_equal(seteuid(0), 0);
    expect_failure(status, AG_ERROR_OUTPUT, "Permission denied");
    expect_text(in_folder("x"), "as before");
    assert_int_equal(entry_count(), 1);
}

static void targets_are_checked_beforehand(void **state)
{
    (void)state;
    assert_int_equal(mkdir(in_folder("d"), 0777), 0);
    expect_failure(atomic_file_check(in_folder("d"), message, sizeof message), AG_ERROR_OUTPUT, "Is a directory");
    expect_failure(atomic_file_check(in_folder("d/"), message, sizeof message), AG_ERROR_OUTPUT, "Is a directory");
    expect_failure(atomic_file_check(in_folder("none/"), message, sizeof message), AG_ERROR_OUTPUT, "none/");
    expect_failure(atomic_file_check(in_folder("none/x"), message, sizeof message), AG_ERROR_OUTPUT, "No such file");
    expect_failure(atomic_file_check("", message, sizeof message), AG_ERROR_OUTPUT, "No such file");
    assert_int_equal(atomic_file_check(in_folder("x"), message, sizeof message), AG_OK);
    assert_int_equal(entry_count(), 1);
    assert_int_equal(atomic_file_write(NULL, in_folder("x"), "as before", 9, message, sizeof message), AG_OK);
    assert_int_equal(atomic_file_check(in_folder("x"), message, sizeof message), AG_OK);
    expect_failure(atomic_file_check(in_folder("x/y"), message, sizeof message), AG_ERROR_OUTPUT, "Not a directory");
    expect_text(in_folder("x"), "as before");
    assert_int_equal(entry_count(), 2);
}

/* A name without a folder goes into the current one. */
static void bare_names(void **state)
{
    (void)state;
    char saved[4096];
    assert_non_null(getcwd(saved, sizeof saved));
    assert_int_equal(chdir(folder), 0);
    const ag_status status = atomic_file_write(NULL, "bare", "1", 1, message, sizeof message);
    assert_int_equal(chdir(saved), 0);
    assert_int_equal(status, AG_OK);
    expect_text(in_folder("bare"), "1");
    assert_int_equal(entry_count(), 1);
}

/* --- what a killed process leaves --- */

/* Says that it has begun, writes half, and waits for the end. */
static int write_half_and_wait(void *user, int descriptor)
{
    const int *ends = user;
    char byte = 0;
    if (write(descriptor, "half", 4) != 4 || write(ends[1], &byte, 1) != 1)
        return EIO;
    return read(ends[2], &byte, 1) == 1 ? 0 : EIO;
}

/* A process that is in the middle of writing path; ends[3] tells it to go on. */
static pid_t start_writer(const char *path, int ends[4])
{
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(pipe(ends + 2), 0);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
        _exit(atomic_file_write_by(NULL, path, write_half_and_wait, ends, message, sizeof message) == AG_OK ? 0 : 1);
    char byte;
    assert_int_equal(read(ends[0], &byte, 1), 1);
    return child;
}

static void close_ends(int ends[4])
{
    for (int i = 0; i < 4; i++)
        close(ends[i]);
}

static void what_the_dead_have_left_is_removed(void **state)
{
    (void)state;
    int ends[4], others[4], status;
    char path[160], other[160];
    snprintf(path, sizeof path, "%s", in_folder("x"));
    snprintf(other, sizeof other, "%s", in_folder("y"));
    FILE *own = fopen(in_folder(".x.backup"), "w"), *alike = fopen(in_folder(".x.afterglow-abc"), "w");
    assert_non_null(own);
    assert_non_null(alike);
    fclose(own);
    fclose(alike);
    const pid_t dead = start_writer(path, ends), alive = start_writer(path, others);
    assert_int_equal(entry_count(), 4);
    assert_int_equal(kill(dead, SIGKILL), 0);
    assert_int_equal(waitpid(dead, &status, 0), dead);
    assert_int_equal(atomic_file_write(NULL, other, "1", 1, message, sizeof message),
                     AG_OK); /* another file's are left */
    assert_int_equal(entry_count(), 5);
    assert_int_equal(atomic_file_write(NULL, path, "1", 1, message, sizeof message), AG_OK);
    assert_int_equal(entry_count(), 5); /* x is there, and what the dead one has left is gone */
    expect_text(path, "1");
    /* the living one still ends in order */
    char byte = 0;
    assert_int_equal(write(others[3], &byte, 1), 1);
    assert_int_equal(waitpid(alive, &status, 0), alive);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    expect_text(path, "half");
    assert_int_equal(entry_count(), 4);
    close_ends(ends);
    close_ends(others);
}

/* --- pending files --- */

enum { WRITERS = 12, ROUNDS = 60 }; /* more writers than slots */

typedef struct writer {
    pthread_t thread;
    int number, failed;
} writer;

static void *write_often(void *user)
{
    writer *w = user;
    char path[160], said[512];
    for (int k = 0; k < ROUNDS; k++) {
        snprintf(path, sizeof path, "%s/%s%d", folder, k % 2 ? "folder/" : "", w->number);
        w->failed += atomic_file_write(NULL, path, "whole", 5, said, sizeof said) != AG_OK;
    }
    return NULL;
}

/* Removing what is pending, at any moment and by another thread, hits a writer's temporary file or nothing: never a
 * name or a folder that are just being changed. A write may fail by it; a file is whole or not there. */
static void pending_files_are_removed_while_others_write(void **state)
{
    (void)state;
    assert_int_equal(mkdir(in_folder("folder"), 0777), 0);
    writer writers[WRITERS];
    for (int i = 0; i < WRITERS; i++) {
        writers[i] = (writer){.number = i};
        assert_int_equal(pthread_create(&writers[i].thread, NULL, write_often, &writers[i]), 0);
    }
    for (int k = 0; k < 2000; k++)
        atomic_file_unlink_pending();
    for (int i = 0; i < WRITERS; i++)
        pthread_join(writers[i].thread, NULL);
    for (int i = 0; i < WRITERS; i++) {
        char path[160];
        snprintf(path, sizeof path, "%s/%d", folder, i);
        if (access(path, F_OK) == 0)
            expect_text(path, "whole");
    }
    atomic_file_unlink_pending();
    /* nothing else is left over */
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    for (const struct dirent *entry = readdir(directory); entry; entry = readdir(directory))
        assert_null(strstr(entry->d_name, ".afterglow-"));
    closedir(directory);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(modes_of_new_and_old_files),
        TEST_IN_FOLDER(names_as_long_as_they_may_be),
        TEST_IN_FOLDER(links_stay_links),
        TEST_IN_FOLDER(special_targets_are_written_directly),
        TEST_IN_FOLDER(a_signal_leaves_nothing_behind),
        TEST_IN_FOLDER(files_that_must_not_be_written),
        TEST_IN_FOLDER(targets_are_checked_beforehand),
        TEST_IN_FOLDER(bare_names),
        TEST_IN_FOLDER(what_the_dead_have_left_is_removed),
        TEST_IN_FOLDER(pending_files_are_removed_while_others_write),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
