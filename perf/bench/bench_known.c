/* bench_known.c: what the bits of a build depend on, and the bits that builds are known to make. A row is what
 * afterglow-bench says of itself: `.build` and `.certificate.hash` of the JSON. Rows of --quick are held by
 * tests/perf/test_afterglow_bench.sh, and are brought up to date by the change that makes other bits; those of `small`
 * and `large` belong to a released version, whose bits stay. Flow: [here] -> bench_certificate. Threads: any. */
#define _GNU_SOURCE
#include "bench/bench_certificate.h"

#include "afterglow/afterglow.h"

#include "bench_sources.h" /* made by perf/bench/bench_sources.cmake */

#include <gnu/libc-version.h>
#include <stdio.h>
#include <string.h>

#if defined(__clang__)
#define COMPILER "clang " __clang_version__
#else
#define COMPILER "gcc " __VERSION__
#endif

bench_build bench_build_describe(const char *isa, const char *maker)
{
    bench_build b = {0};
    snprintf(b.sources, sizeof b.sources, "%s", AG_BENCH_SOURCES);
    snprintf(b.compiler, sizeof b.compiler, "%s", COMPILER);
    snprintf(b.embree, sizeof b.embree, "%s", AG_BENCH_EMBREE);
    snprintf(b.libm, sizeof b.libm, "glibc %s", gnu_get_libc_version());
    snprintf(b.isa, sizeof b.isa, "%s", isa);
    snprintf(b.maker, sizeof b.maker, "%s", maker);
    return b;
}

static const struct {
    const char *version, *compiler, *embree, *libm, *isa, *maker;
    const char *size;
    hash128 hash;
} known[] = {
    {"0.1.0",
     "gcc 12.2.0",
     "3.13.5",
     "glibc 2.36",
     "avx2",
     "AuthenticAMD",
     "quick",
     {{0xd54730b1a9c3a4fc, 0x7cef300f4f3ddc9a}}},
};

bool bench_known_hash(const bench_build *build, const char *size, hash128 *out_hash)
{
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const char *const row[] = {known[i].version, known[i].compiler, known[i].embree, known[i].libm,
                                   known[i].isa,     known[i].maker,    known[i].size};
        const char *const here[] = {ag_version(), build->compiler, build->embree, build->libm,
                                    build->isa,   build->maker,    size};
        bool is_alike = true;
        for (size_t k = 0; k < sizeof row / sizeof *row; k++)
            is_alike = is_alike && strcmp(row[k], here[k]) == 0;
        if (!is_alike)
            continue;
        *out_hash = known[i].hash;
        return true;
    }
    return false;
}
