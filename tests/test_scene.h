/* test_scene.h: what the tests of light and photons share: a run with its workers and its log, scenes from a few lines
 * of pbrt, and a test of counts against a density. Includes cmocka and all that it wants.
 * Threads: one at a time; the run's workers work inside. */
#ifndef AFTERGLOW_TESTS_TEST_SCENE_H
#define AFTERGLOW_TESTS_TEST_SCENE_H

#include "bvh.h"
#include "math/rng.h"
#include "math/sampling.h"
#include "pbrt_parser.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#if defined(__has_feature)
#if __has_feature(thread_sanitizer) || __has_feature(address_sanitizer)
#define UNDER_SANITIZER 1
#endif
#endif
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
#define UNDER_SANITIZER 1
#endif
/* Sanitizers make all some ten times slower: fewer samples then, and wider bounds for what is measured with them. */
#ifdef UNDER_SANITIZER
enum { FEWER = 16, WIDER = 4 };
#else
enum { FEWER = 1, WIDER = 1 };
#endif

static const double PI = 3.14159265358979323846;

typedef struct test_run {
    thread_pool *pool;
    log_sink *log;
    run_context run;
    int warning_count;
    char said[1024]; /* the last warning or error */
} test_run;

static void test_run_hear(void *user, ag_log_level level, const char *message)
{
    test_run *r = user;
    if (level > AG_LOG_WARNING)
        return;
    r->warning_count++;
    snprintf(r->said, sizeof r->said, "%s", message);
}

static inline void test_run_init(test_run *r, unsigned worker_count)
{
    *r = (test_run){0};
    assert_int_equal(thread_pool_create(worker_count, &r->pool), AG_OK);
    r->log = log_create(test_run_hear, r);
    assert_non_null(r->log);
    run_context_init(&r->run, r->pool, r->log, NULL, NULL);
}

static inline void test_run_reset(test_run *r)
{
    run_context_reset(&r->run);
    log_destroy(r->log);
    thread_pool_destroy(r->pool);
}

/* A committed scene of what stands after WorldBegin; the caller destroys it. Nothing may be warned of. */
static inline scene *test_scene_create(test_run *r, const char *world)
{
    size_t size = strlen(world) + 16;
    char *text = malloc(size);
    scene *s = scene_create();
    assert_non_null(text);
    assert_non_null(s);
    snprintf(text, size, "WorldBegin\n%s\n", world);
    ag_status status = pbrt_parse_text(&r->run, "scene", text, strlen(text), s);
    free(text);
    if (status == AG_OK)
        status = scene_commit(s, &r->run, NULL);
    if (status != AG_OK || r->warning_count > 0)
        fail_msg("%s: %s", ag_status_text(status), r->said);
    return s;
}

static inline void assert_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.9g is not %.9g within %g", value, expected, tolerance);
}

static inline void assert_relative(double value, double expected, double relative)
{
    assert_close(value, expected, fabs(expected) * relative);
}

static inline rng test_random(uint64_t index) { return rng_make(2004, 421, index); }

static inline vec3 random_direction(rng *random) { return sample_uniform_sphere(rng_vec2(random)); }

static inline vec3 random_in_box(rng *random, vec3 low, vec3 high)
{
    float x = rng_float(random), y = rng_float(random), z = rng_float(random);
    return vec3_add(low, vec3_mul(vec3_sub(high, low), (vec3){x, y, z}));
}

/* --- counts of directions against a density: Pearson's chi-square over bins of equal solid angle --- */

enum { BINS_Z = 24, BINS_PHI = 24, BIN_COUNT = BINS_Z * BINS_PHI };

static inline int direction_bin(vec3 d)
{
    int i = (int)floor((d.z + 1.0) * (BINS_Z / 2.0));
    int j = (int)floor((atan2(d.y, d.x) / (2.0 * PI) + 0.5) * BINS_PHI);
    i = i < 0 ? 0 : i >= BINS_Z ? BINS_Z - 1 : i;
    j = j < 0 ? 0 : j >= BINS_PHI ? BINS_PHI - 1 : j;
    return i * BINS_PHI + j;
}

typedef double density_fn(void *user, vec3 direction);

/* The integral of the density over each bin, by steps x steps midpoints; returns the whole. */
static inline double integrate_bins(density_fn *density, void *user, int steps, double out_bins[BIN_COUNT])
{
    double whole = 0.0, cell = 4.0 * PI / BIN_COUNT / steps / steps;
    for (int i = 0; i < BINS_Z; i++)
        for (int j = 0; j < BINS_PHI; j++) {
            double sum = 0.0;
            for (int k = 0; k < steps * steps; k++) {
                double z = (i + (k / steps + 0.5) / steps) * 2.0 / BINS_Z - 1.0, r = sqrt(1.0 - z * z);
                double phi = ((j + (k % steps + 0.5) / steps) / BINS_PHI - 0.5) * 2.0 * PI;
                sum += density(user, (vec3){(float)(r * cos(phi)), (float)(r * sin(phi)), (float)z});
            }
            out_bins[i * BINS_PHI + j] = sum * cell;
            whole += sum * cell;
        }
    return whole;
}

/* counts of `samples` draws against the bins' shares; the rest of the draws fell nowhere. Bins that expect few are
 * taken together. relative_error: of the integrals themselves. */
static inline void assert_chi_square(const uint32_t counts[BIN_COUNT], const double bins[BIN_COUNT], double samples,
                                     double relative_error)
{
    double chi = 0.0, pooled_expected = 0.0, pooled_count = 0.0;
    int degrees = 0;
    for (int i = 0; i < BIN_COUNT; i++) {
        double expected = bins[i] * samples;
        if (expected < 10.0) {
            pooled_expected += expected;
            pooled_count += counts[i];
            continue;
        }
        double off = fmax(0.0, fabs(counts[i] - expected) - relative_error * expected);
        chi += off * off / expected;
        degrees++;
    }
    if (pooled_expected >= 10.0) {
        double off = pooled_count - pooled_expected;
        chi += off * off / pooled_expected;
        degrees++;
    } else if (pooled_count > 10.0 + pooled_expected + 8.0 * sqrt(pooled_expected + 1.0)) {
        fail_msg("%g samples where %g were expected", pooled_count, pooled_expected);
    }
    assert_true(degrees > 0);
    double limit = degrees + 5.0 * sqrt(2.0 * degrees) + 5.0;
    if (!(chi < limit))
        fail_msg("chi-square %g, with %d bins: above %g", chi, degrees, limit);
}

/* Whether anything stands between two points that lie off all surfaces. */
static inline bool is_blocked_between(const scene *s, vec3 from, vec3 to)
{
    return scene_occluded(s, scene_ray_make(from, vec3_sub(to, from)), 1.0f);
}

#endif
