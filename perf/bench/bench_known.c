/* bench_known.c: what the bits of a build depend on, and the bits that builds are known to make. A new row: what
 * `afterglow-bench --size small` and `large` say of build and certificate (`.build` and `.certificate.hash` of the
 * JSON), once the sources of a release stand: any change of theirs is another build. Flow: [here] -> bench_certificate.
 * Threads: any. */
#define _GNU_SOURCE
#include "bench/bench_certificate.h"

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
    bench_build build;
    const char *size;
    hash128 hash;
} known[] = {
    {{"8629aa3c1db65600dd05ba940415bb7a", "gcc 12.2.0", "3.13.5", "glibc 2.36", "avx2", "AuthenticAMD"},
     "small",
     {{0x873dac929ddc5078, 0xec6593dc0720daaa}}},
};

bool bench_known_hash(const bench_build *build, const char *size, hash128 *out_hash)
{
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const bench_build *k = &known[i].build;
        if (strcmp(k->sources, build->sources) != 0 || strcmp(k->compiler, build->compiler) != 0 ||
            strcmp(k->embree, build->embree) != 0 || strcmp(k->libm, build->libm) != 0 ||
            strcmp(k->isa, build->isa) != 0 || strcmp(k->maker, build->maker) != 0 || strcmp(known[i].size, size) != 0)
            continue;
        *out_hash = known[i].hash;
        return true;
    }
    return false;
}
