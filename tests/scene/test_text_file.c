/* test_text_file.c: plain and gzip files, standard input, and every way in which they cannot be read.
 * Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "text/text_file.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

static char directory[] = "/tmp/ag_text_file_XXXXXX";
static char error[128];

static const char *path_of(const char *name)
{
    static char path[128];
    snprintf(path, sizeof path, "%s/%s", directory, name);
    return path;
}

static void write_bytes(const char *name, const void *bytes, size_t size)
{
    FILE *f = fopen(path_of(name), "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, size, f), size);
    assert_int_equal(fclose(f), 0);
}

static size_t write_gzip(const char *name, const char *text, size_t size)
{
    gzFile f = gzopen(path_of(name), "wb9");
    assert_non_null(f);
    assert_int_equal(gzwrite(f, text, (unsigned)size), (int)size);
    assert_int_equal(gzclose(f), Z_OK);
    FILE *again = fopen(path_of(name), "rb");
    assert_non_null(again);
    fseek(again, 0, SEEK_END);
    long bytes = ftell(again);
    fclose(again);
    return (size_t)bytes;
}

static void check_text(const char *path, const char *text, size_t size)
{
    text_file file;
    assert_int_equal(text_file_read(NULL, path, error, sizeof error, &file), AG_OK);
    assert_int_equal(file.size, size);
    assert_memory_equal(file.text, text, size);
    assert_int_equal(file.text[size], '\0');
    text_file_reset(&file);
    assert_null(file.text);
}

static void check_error(const char *path, const char *expected)
{
    text_file file;
    assert_int_equal(text_file_read(NULL, path, error, sizeof error, &file), AG_ERROR_INPUT);
    assert_string_equal(error, expected);
    assert_null(file.text);
}

static void plain_and_gzip_are_read_alike(void **state)
{
    (void)state;
    size_t size = 5000000; /* more than one chunk */
    char *text = malloc(size);
    assert_non_null(text);
    for (size_t i = 0; i < size; i++)
        text[i] = (char)('a' + i * i % 23);
    write_bytes("plain", text, size);
    check_text(path_of("plain"), text, size);
    write_gzip("packed.gz", text, size);
    check_text(path_of("packed.gz"), text, size);
    write_gzip("packed.txt", text, size); /* the name does not matter */
    check_text(path_of("packed.txt"), text, size);
    free(text);
    write_bytes("empty", "", 0);
    check_text(path_of("empty"), "", 0);
    write_bytes("zero", "a\0b", 3);
    check_text(path_of("zero"), "a\0b", 3);
}

static void standard_input_is_read(void **state)
{
    (void)state;
    write_bytes("stdin", "from outside", 12);
    int saved = dup(STDIN_FILENO), replaced = open(path_of("stdin"), O_RDONLY);
    assert_true(saved >= 0 && replaced >= 0);
    dup2(replaced, STDIN_FILENO);
    check_text("-", "from outside", 12);
    assert_true(lseek(STDIN_FILENO, 0, SEEK_CUR) >= 0); /* still open: only a duplicate was closed */
    dup2(saved, STDIN_FILENO);
    close(saved);
    close(replaced);
}

static void what_cannot_be_read_is_told(void **state)
{
    (void)state;
    check_error(path_of("missing"), "No such file or directory");
    check_error(directory, "Is a directory");
    char text[4000];
    for (size_t i = 0; i < sizeof text; i++)
        text[i] = (char)(i * i * 7 % 251);
    size_t packed = write_gzip("whole.gz", text, sizeof text);
    char bytes[8000];
    assert_true(packed < sizeof bytes && packed > 100);
    FILE *f = fopen(path_of("whole.gz"), "rb");
    assert_non_null(f);
    assert_int_equal(fread(bytes, 1, packed, f), packed);
    fclose(f);
    const size_t cuts[] = {packed - 1, packed - 8, packed - 9, packed / 2, 20};
    for (size_t i = 0; i < sizeof cuts / sizeof *cuts; i++) {
        write_bytes("cut.gz", bytes, cuts[i]);
        check_error(path_of("cut.gz"), "the gzip file is cut short");
    }
    bytes[packed - 6] ^= 1; /* the checksum */
    write_bytes("bad.gz", bytes, packed);
    text_file file;
    assert_int_equal(text_file_read(NULL, path_of("bad.gz"), error, sizeof error, &file), AG_ERROR_INPUT);
    assert_int_equal(strncmp(error, "the gzip file is damaged (", 26), 0);
}

/* What unpacks to a thousand times its size is refused long before it fills the memory. */
static void gzip_files_that_hold_too_much_are_refused(void **state)
{
    (void)state;
    static char zeros[1 << 20];
    gzFile f = gzopen(path_of("much.gz"), "wb9");
    assert_non_null(f);
    for (int i = 0; i < 300; i++)
        assert_int_equal(gzwrite(f, zeros, sizeof zeros), (int)sizeof zeros);
    assert_int_equal(gzclose(f), Z_OK);
    text_file file;
    assert_int_equal(text_file_read(NULL, path_of("much.gz"), error, sizeof error, &file), AG_ERROR_INPUT);
    assert_non_null(strstr(error, "the gzip file holds more than 256 MiB, which is the most in one of "));
    assert_true(text_file_max_unpacked_bytes(100) == 256 << 20);
    assert_true(text_file_max_unpacked_bytes((uint64_t)1 << 30) == (uint64_t)1 << 38);
}

static int make_directory(void **state)
{
    (void)state;
    return mkdtemp(directory) ? 0 : -1;
}

static int remove_directory(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"plain", "packed.gz", "packed.txt", "empty",  "zero",
                                        "stdin", "whole.gz",  "cut.gz",     "bad.gz", "much.gz"};
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++)
        remove(path_of(NAMES[i]));
    return rmdir(directory);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain_and_gzip_are_read_alike),
        cmocka_unit_test(gzip_files_that_hold_too_much_are_refused),
        cmocka_unit_test(standard_input_is_read),
        cmocka_unit_test(what_cannot_be_read_is_told),
    };
    return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
