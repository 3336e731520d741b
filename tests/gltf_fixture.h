/* gltf_fixture.h: glTF scenes read, with all that was said meanwhile.
 * Flow: gltf_file.h -> gltf_load_file -> [here] -> tests/test_gltf_*.c. Threads: one at a time. */
#ifndef AFTERGLOW_TESTS_GLTF_FIXTURE_H
#define AFTERGLOW_TESTS_GLTF_FIXTURE_H

#include "gltf_reader.h"
#include "pbrt_fixture.h" /* before what has a global called message */

#include "gltf_file.h"

/* Reads a file of the folder. */
static inline reading gltf_read_file(const char *name)
{
    reading r;
    run_context run;
    reading_begin(&r, &run);
    r.status = gltf_load_file(&run, in_folder(name), r.scene);
    reading_end(&run);
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

#endif
