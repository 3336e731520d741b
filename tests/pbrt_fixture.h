/* pbrt_fixture.h: a scene read from text or file, with all that was said meanwhile. For the tests of the pbrt reader.
 * Threads: one at a time. */
#ifndef AFTERGLOW_PBRT_FIXTURE_H
#define AFTERGLOW_PBRT_FIXTURE_H

#include "pbrt_parser.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct reading {
    scene *scene;
    ag_status status;
    char *said[4]; /* by level: all messages, a line end behind each */
    int count[4];  /* of messages */
} reading;

static inline void reading_hear(void *user, ag_log_level level, const char *message)
{
    reading *r = user;
    size_t old = r->said[level] ? strlen(r->said[level]) : 0;
    r->said[level] = realloc(r->said[level], old + strlen(message) + 2);
    assert_non_null(r->said[level]);
    sprintf(r->said[level] + old, "%s\n", message);
    r->count[level]++;
}

/* An empty scene, and a run whose log the reading hears, until reading_end. */
static inline void reading_begin(reading *r, run_context *run)
{
    memset(r, 0, sizeof *r);
    log_sink *log = log_create(reading_hear, r);
    r->scene = scene_create();
    assert_non_null(log);
    assert_non_null(r->scene);
    run_context_init(run, NULL, log, NULL, NULL);
}

static inline void reading_end(run_context *run)
{
    log_destroy(run->log);
    run_context_reset(run);
}

/* path NULL: reads text, called "t" in messages. */
static inline reading reading_create(const char *path, const char *text, size_t size)
{
    reading r;
    run_context run;
    reading_begin(&r, &run);
    r.status = path ? pbrt_parse_file(&run, path, r.scene) : pbrt_parse_text(&run, "t", text, size, r.scene);
    reading_end(&run);
    return r;
}

static inline void reading_destroy(reading *r)
{
    scene_destroy(r->scene);
    for (int i = 0; i < 4; i++)
        free(r->said[i]);
}

/* Reads text that is right and says nothing louder than info. */
static inline reading reading_of(const char *text)
{
    reading r = reading_create(NULL, text, strlen(text));
    if (r.said[AG_LOG_ERROR])
        print_error("%s", r.said[AG_LOG_ERROR]);
    if (r.said[AG_LOG_WARNING])
        print_error("%s", r.said[AG_LOG_WARNING]);
    assert_int_equal(r.status, AG_OK);
    assert_int_equal(r.count[AG_LOG_WARNING], 0);
    return r;
}

static inline void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.9g is not %.9g within %g", value, expected, tolerance);
}

static inline void assert_vec3(vec3 value, double x, double y, double z, double tolerance)
{
    assert_near(value.x, x, tolerance);
    assert_near(value.y, y, tolerance);
    assert_near(value.z, z, tolerance);
}

static inline void assert_rgb(rgb value, double r, double g, double b, double tolerance)
{
    assert_near(value.r, r, tolerance);
    assert_near(value.g, g, tolerance);
    assert_near(value.b, b, tolerance);
}

#endif
