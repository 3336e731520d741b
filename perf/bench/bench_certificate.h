/* bench_certificate.h: whether the work that was timed was the right work: the same bits on all numbers of threads, all
 * counts as expected, nothing computed twice, and where the build is known the bits that it is known to make. It guards
 * against wrong work, not against liars. Flow: bench_run -> [here] -> bench_json. Threads: one. */
#ifndef AFTERGLOW_BENCH_CERTIFICATE_H
#define AFTERGLOW_BENCH_CERTIFICATE_H

#include "math/hash128.h"

#include <stdbool.h>

/* The build on which the bits depend, besides the program's version and the benchmark's own scenes: short texts
 * without a line's end. The sources are told, but not compared: most changes of theirs make no other bits. */
typedef struct bench_build {
    char sources[40];  /* fingerprint of the sources of threads/, scene/, photonmap/ and renderer/, 32 hexadecimals */
    char compiler[64]; /* "gcc 12.2.0" */
    char embree[32], libm[32], isa[16], maker[16];
} bench_build;

/* isa and maker: as bench_run has them. */
bench_build bench_build_describe(const char *isa, const char *maker);

/* The work of a phase of a scene on a number of threads. */
typedef struct certificate_entry {
    const char *scene, *phase;
    unsigned threads;
    hash128 hash;
    uint64_t count, expected, duplicated;
    bool is_steady; /* all units of its had the same hash */
    bool is_sound;  /* what came out is of finite numbers, and not all 0 */
} certificate_entry;

typedef enum bench_known { BENCH_BUILD_UNKNOWN, BENCH_BUILD_MATCHES, BENCH_BUILD_DIFFERS } bench_known;

enum { CERTIFICATE_REASONS_MAX = 16, CERTIFICATE_REASON_SIZE = 200 };

typedef struct certificate {
    bool is_valid;
    hash128 hash; /* of all phases of all scenes, by their first entries */
    uint64_t duplicated;
    bench_known known;
    unsigned reason_count; /* against it; of more than can be kept the first */
    char reasons[CERTIFICATE_REASONS_MAX][CERTIFICATE_REASON_SIZE];
} certificate;

/* Entries of one scene and phase are held against the first of them. known: the hash that this build is known to make,
 * or NULL. No entries: not valid. */
void certificate_judge(const certificate_entry *entries, unsigned count, const hash128 *known, certificate *out);

/* The hash that a build is known to make at that size ("small"); false where it is not known. */
bool bench_known_hash(const bench_build *build, const char *size, hash128 *out_hash);

/* 32 hexadecimals and a terminator. */
void bench_hash_text(hash128 hash, char out_text[33]);

#endif
