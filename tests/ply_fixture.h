/* ply_fixture.h: PLY files of any format, written for tests.
 * Flow: [here] -> tests/test_ply_file.c, test_pbrt_ply.c. Threads: one. */
#ifndef AFTERGLOW_TESTS_PLY_FIXTURE_H
#define AFTERGLOW_TESTS_PLY_FIXTURE_H

#include "pbrt_fixture.h"
#include "temporary_folder.h"

#include <zlib.h>

/* Three corners, one triangle; their lines follow. */
#define VERTEX(count) "element vertex " #count "\nproperty float x\nproperty float y\nproperty float z\n"
#define FACE(count)   "element face " #count "\nproperty list uchar int vertex_indices\n"
#define HEAD          "ply\nformat ascii 1.0\n" VERTEX(3) FACE(1) "end_header\n"

typedef enum format { ASCII, LITTLE, BIG } format;
static const char *const FORMAT_NAMES[] = {"ascii", "binary_little_endian", "binary_big_endian"};

typedef struct text {
    char *bytes;
    size_t size, capacity;
} text;

static inline void append(text *t, const void *bytes, size_t size)
{
    if (t->size + size > t->capacity) {
        t->capacity = 2 * (t->size + size);
        t->bytes = realloc(t->bytes, t->capacity);
        assert_non_null(t->bytes);
    }
    memcpy(t->bytes + t->size, bytes, size);
    t->size += size;
}

static inline void append_text(text *t, const char *string) { append(t, string, strlen(string)); }

/* A number of a type as PLY calls it. */
static inline void append_number(text *t, format f, const char *type, double value)
{
    char ascii[64];
    unsigned char bytes[8];
    bool is_float = strncmp(type, "float", 5) == 0,
         is_double = strcmp(type, "double") == 0 || strcmp(type, "float64") == 0;
    size_t size = strstr(type, "char") || strstr(type, "int8")  ? 1
                  : strstr(type, "short") || strstr(type, "16") ? 2
                                                                : 4;
    if (is_double)
        size = 8;
    if (f == ASCII) {
        snprintf(ascii, sizeof ascii, "%.17g ", value);
        append_text(t, ascii);
        return;
    }
    uint64_t bits = (uint64_t)(int64_t)value;
    if (is_double) {
        memcpy(&bits, &value, sizeof bits);
    } else if (is_float) {
        float single = (float)value;
        uint32_t word;
        memcpy(&word, &single, sizeof word);
        bits = word;
    }
    for (size_t i = 0; i < size; i++)
        bytes[f == LITTLE ? i : size - 1 - i] = (unsigned char)(bits >> (8 * i));
    append(t, bytes, size);
}

static inline void end_line(text *t, format f)
{
    if (f == ASCII)
        append_text(t, "\n");
}

static inline const char *write_file(const char *name, const void *bytes, size_t size)
{
    const char *path = in_folder(name);
    size_t length = strlen(name);
    if (length > 3 && strcmp(name + length - 3, ".gz") == 0) {
        gzFile file = gzopen(path, "wb");
        assert_non_null(file);
        assert_int_equal(gzwrite(file, bytes, (unsigned)size), (int)size);
        assert_int_equal(gzclose(file), Z_OK);
    } else {
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        assert_int_equal(fwrite(bytes, 1, size, file), size);
        assert_int_equal(fclose(file), 0);
    }
    return path;
}

#endif
