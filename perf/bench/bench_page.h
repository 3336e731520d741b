/* bench_page.h: a result of afterglow-bench as one page of HTML, with its plots in it: no script, no network.
 * Rests on: SVG 1.1. Flow: bench_json -> [here] -> file. Threads: one. */
#ifndef AFTERGLOW_BENCH_PAGE_H
#define AFTERGLOW_BENCH_PAGE_H

#include <jansson.h>

/* The page as text, for free(); NULL when out of memory. */
char *bench_page(const json_t *result);

#endif
