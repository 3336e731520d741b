/* bench_json.h: a run as JSON: what the page, the line and comparisons are made of. The field names are part of the
 * program's contract. Flow: bench_run, bench_score, bench_certificate -> [here] -> file, bench_page, bench_compare.
 * Threads: one. */
#ifndef AFTERGLOW_BENCH_JSON_H
#define AFTERGLOW_BENCH_JSON_H

#include "bench/bench_certificate.h"
#include "bench/bench_run.h"

#include <jansson.h>

/* The certificate of a run. */
void bench_certify(const bench_run *run, const bench_build *build, certificate *out);

/* The caller's; NULL when out of memory. Scores are null, and "refused" says why, where the certificate is not valid,
 * the size is quick, or the machine was busy. */
json_t *bench_json(const bench_run *run, const bench_build *build, const certificate *c);

/* Writes one line of a table: processor, threads, size, scores of one thread and of the best number, certificate. */
void bench_line(const json_t *result, char *out_line, size_t size);

#endif
