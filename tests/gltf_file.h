/* gltf_file.h: glTF files written for tests. In documents, ' stands for ", and numbers of buffers come from a blob.
 * Flow: text, blob -> [here] -> a file in the folder of the test. Threads: one at a time. */
#ifndef AFTERGLOW_TESTS_GLTF_FILE_H
#define AFTERGLOW_TESTS_GLTF_FILE_H

#include "temporary_folder.h"

/* Bytes for a buffer. */
typedef struct blob {
    unsigned char bytes[8192];
    size_t size;
} blob;

static inline size_t blob_put(blob *b, const void *bytes, size_t size)
{
    size_t offset = b->size;
    assert_true(offset + size <= sizeof b->bytes);
    memcpy(b->bytes + offset, bytes, size);
    b->size += size;
    return offset;
}

/* Of a C array; gives its offset. */
#define BLOB_PUT(b, ...) blob_put(b, (__VA_ARGS__), sizeof(__VA_ARGS__))

static inline void write_file(const char *name, const void *bytes, size_t size)
{
    remove(in_folder(name)); /* a file that is cut and written anew goes to disk at once on some file systems */
    FILE *file = fopen(in_folder(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static inline void write_blob(const char *name, const blob *b) { write_file(name, b->bytes, b->size); }

/* With quotes as JSON has them; to be freed. */
static inline char *json_text(const char *text)
{
    char *json = strdup(text);
    assert_non_null(json);
    for (char *c = json; *c; c++)
        if (*c == '\'')
            *c = '"';
    return json;
}

/* A triangle at the origin along x and y: positions 0 to 35, and what a document needs to have it; goes on with other
 * members. */
#define GLTF_TRIANGLE_BUFFER                                                                                           \
    "'buffers': [{'uri': 'triangle.bin', 'byteLength': 36}], 'bufferViews': [{'buffer': 0, 'byteLength': 36}], "
#define GLTF_TRIANGLE_ACCESSOR "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'}], "
#define GLTF_TRIANGLE          GLTF_TRIANGLE_BUFFER GLTF_TRIANGLE_ACCESSOR
#define GLTF_ASSET             "'asset': {'version': '2.0'}, "

static inline void write_triangle(void)
{
    blob b = {.size = 0};
    BLOB_PUT(&b, (float[]){0, 0, 0, 1, 0, 0, 0, 1, 0});
    write_blob("triangle.bin", &b);
}

#endif
