/* temporary_folder.h: what tests of files share: a folder that is made before each test and removed after it, and looks
 * at what is in it. Includes cmocka and all that it wants. Threads: one. */
#ifndef AFTERGLOW_TESTS_TEMPORARY_FOLDER_H
#define AFTERGLOW_TESTS_TEMPORARY_FOLDER_H

#include "afterglow/base.h"

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[64];
static char message[4096];

static inline const char *in_folder(const char *name)
{
    static char paths[4][160];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

static inline int entry_count(void)
{
    int count = 0;
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    for (const struct dirent *entry = readdir(directory); entry; entry = readdir(directory))
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(directory);
    return count;
}

static inline unsigned char *read_bytes(const char *path, size_t *out_size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    *out_size = (size_t)ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(*out_size + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *out_size, file), *out_size);
    bytes[*out_size] = '\0';
    fclose(file);
    return bytes;
}

/* Two files of the folder, to the last byte. */
static inline void expect_same_files(const char *a, const char *b)
{
    size_t size_a, size_b;
    unsigned char *bytes_a = read_bytes(in_folder(a), &size_a), *bytes_b = read_bytes(in_folder(b), &size_b);
    if (size_a != size_b || memcmp(bytes_a, bytes_b, size_a) != 0)
        fail_msg("%s and %s differ", a, b);
    free(bytes_a);
    free(bytes_b);
}

static inline void expect_text(const char *path, const char *text)
{
    size_t size;
    unsigned char *bytes = read_bytes(path, &size);
    assert_int_equal(size, strlen(text));
    assert_memory_equal(bytes, text, size);
    free(bytes);
}

static inline void expect_failure(ag_status status, ag_status expected, const char *text)
{
    assert_int_equal(status, expected);
    if (!strstr(message, text))
        print_error("'%s' is not in: %s\n", text, message);
    assert_non_null(strstr(message, text));
}

/* A limit on the size of files stands for a full disk; at SIGXFSZ the write fails half-way. */
static inline void set_file_limit(rlim_t limit, struct rlimit *out_saved)
{
    assert_int_equal(getrlimit(RLIMIT_FSIZE, out_saved), 0);
    const struct rlimit small = {limit, out_saved->rlim_max};
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
}

static inline int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/afterglow_test.XXXXXX");
    return mkdtemp(folder) && chmod(folder, 0755) == 0 ? 0 : -1;
}

static inline int remove_folder(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

#define TEST_IN_FOLDER(function) cmocka_unit_test_setup_teardown(function, make_folder, remove_folder)

#endif
