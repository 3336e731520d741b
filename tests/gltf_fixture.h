/* gltf_fixture.h: glTF scenes written to a folder and read, with all that was said meanwhile. In documents, ' stands for
 * ", and numbers of buffers come from a blob.
 * Flow: text, blob -> file -> gltf_load_file -> tests/test_gltf_*.c. Threads: one at a time. */
#ifndef AFTERGLOW_TESTS_GLTF_FIXTURE_H
#define AFTERGLOW_TESTS_GLTF_FIXTURE_H

#include "gltf_reader.h"
#include "pbrt_fixture.h"
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

/* Reads a file of the folder. */
static inline reading gltf_read_file(const char *name)
{
    reading r;
    memset(&r, 0, sizeof r);
    log_sink *log = log_create(reading_hear, &r);
    run_context run;
    run_context_init(&run, NULL, log, NULL, NULL);
    r.scene = scene_create();
    assert_non_null(log);
    assert_non_null(r.scene);
    r.status = gltf_load_file(&run, in_folder(name), r.scene);
    run_context_reset(&run);
    log_destroy(log);
    return r;
}

static inline reading gltf_read(const char *text)
{
    char *json = json_text(text);
    write_file("t.gltf", json, strlen(json));
    free(json);
    return gltf_read_file("t.gltf");
}

/* Reads what is right. */
static inline reading gltf_of(const char *text)
{
    reading r = gltf_read(text);
    if (r.said[AG_LOG_ERROR])
        print_error("%s", r.said[AG_LOG_ERROR]);
    if (r.said[AG_LOG_WARNING])
        print_error("%s", r.said[AG_LOG_WARNING]);
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.count[AG_LOG_WARNING], 0);
    return r;
}

/* One message, that says this. */
static inline void expect_said(const reading *r, ag_log_level level, const char *text)
{
    if (!r->said[level] || !strstr(r->said[level], text))
        fail_msg("'%s' is not in: %s", text, r->said[level] ? r->said[level] : "(nothing)");
}

static inline void gltf_expect_error(const char *text, ag_status status, const char *error)
{
    reading r = gltf_read(text);
    expect_said(&r, AG_LOG_ERROR, error);
    assert_int_equal(r.status, status);
    assert_int_equal(r.count[AG_LOG_ERROR], 1);
    reading_destroy(&r);
}

/* Reads what is right but for one warning. */
static inline void gltf_expect_warning(const char *text, const char *warning)
{
    reading r = gltf_read(text);
    if (r.said[AG_LOG_ERROR])
        print_error("%s", r.said[AG_LOG_ERROR]);
    assert_int_equal(r.status, AG_OK);
    expect_said(&r, AG_LOG_WARNING, warning);
    assert_int_equal(r.count[AG_LOG_WARNING], 1);
    reading_destroy(&r);
}

/* A triangle at the origin along x and y: positions 0 to 35, and what a document needs to have it; goes on with other
 * members. */
#define GLTF_TRIANGLE_BUFFER "'buffers': [{'uri': 'triangle.bin', 'byteLength': 36}], 'bufferViews': [{'buffer': 0, 'byteLength': 36}], "
#define GLTF_TRIANGLE_ACCESSOR "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'}], "
#define GLTF_TRIANGLE GLTF_TRIANGLE_BUFFER GLTF_TRIANGLE_ACCESSOR
#define GLTF_ASSET    "'asset': {'version': '2.0'}, "

static inline void write_triangle(void)
{
    blob b = {.size = 0};
    BLOB_PUT(&b, (float[]){0, 0, 0, 1, 0, 0, 0, 1, 0});
    write_blob("triangle.bin", &b);
}

#endif
