/* bench_certificate.c: see bench_certificate.h. */
#include "bench/bench_certificate.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void bench_hash_text(hash128 hash, char out_text[33])
{
    snprintf(out_text, 33, "%016" PRIx64 "%016" PRIx64, hash.bits[0], hash.bits[1]);
}

__attribute__((format(printf, 2, 3))) static void object(certificate *c, const char *format, ...)
{
    va_list arguments;
    c->is_valid = false;
    if (c->reason_count == CERTIFICATE_REASONS_MAX)
        return;
    va_start(arguments, format);
    vsnprintf(c->reasons[c->reason_count++], CERTIFICATE_REASON_SIZE, format, arguments);
    va_end(arguments);
}

static void judge_alone(const certificate_entry *e, certificate *c)
{
    if (!e->is_steady)
        object(c, "%s, %s: bits differ from one time to the next on %u threads", e->scene, e->phase, e->threads);
    if (!e->is_sound)
        object(c, "%s, %s: what came out on %u threads is not of finite numbers, or nothing but 0", e->scene, e->phase,
               e->threads);
    if (e->count != e->expected)
        object(c, "%s, %s: counted %" PRIu64 " instead of %" PRIu64 " on %u threads", e->scene, e->phase, e->count,
               e->expected, e->threads);
    if (e->duplicated > 0)
        object(c, "%s, %s: %" PRIu64 " irradiances were computed twice on %u threads", e->scene, e->phase,
               e->duplicated, e->threads);
}

static const certificate_entry *first_alike(const certificate_entry *entries, const certificate_entry *e)
{
    const certificate_entry *first = entries;
    while (strcmp(first->scene, e->scene) != 0 || strcmp(first->phase, e->phase) != 0)
        first++;
    return first;
}

void certificate_judge(const certificate_entry *entries, unsigned count, const hash128 *known, certificate *out)
{
    *out = (certificate){.is_valid = true, .hash = hash128_begin()};
    if (count == 0)
        object(out, "nothing was measured");
    for (unsigned i = 0; i < count; i++) {
        const certificate_entry *e = &entries[i], *first = first_alike(entries, e);
        judge_alone(e, out);
        out->duplicated += e->duplicated;
        if (first == e) {
            hash128_add_text(&out->hash, e->scene);
            hash128_add_text(&out->hash, e->phase);
            HASH128_ADD(&out->hash, e->hash);
            HASH128_ADD(&out->hash, e->count);
            continue;
        }
        if (!hash128_is_equal(first->hash, e->hash))
            object(out, "%s, %s: bits on %u threads are not those on %u", e->scene, e->phase, e->threads,
                   first->threads);
        if (first->count != e->count)
            object(out, "%s, %s: counted %" PRIu64 " on %u threads and %" PRIu64 " on %u", e->scene, e->phase, e->count,
                   e->threads, first->count, first->threads);
    }
    if (!known)
        return;
    out->known = hash128_is_equal(out->hash, *known) ? BENCH_BUILD_MATCHES : BENCH_BUILD_DIFFERS;
    if (out->known == BENCH_BUILD_DIFFERS)
        object(out, "this build is known to make other bits");
}
