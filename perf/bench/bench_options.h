/* bench_options.h: the command line of afterglow-bench. Flow: argv -> [here] -> afterglow_bench.c. Threads: one. */
#ifndef AFTERGLOW_BENCH_OPTIONS_H
#define AFTERGLOW_BENCH_OPTIONS_H

#include "bench/bench_machine.h"
#include "bench/bench_scenes.h"

#include <stddef.h>

typedef struct bench_options {
    enum { BENCH_MEASURE, BENCH_COMPARE, BENCH_HELP, BENCH_VERSION } action;
    bool has_size;
    bench_size size;
    bool allows_busy, is_quiet;
    unsigned levels[BENCH_LEVELS_MAX], level_count; /* 0: by the machine; else ascending, 1 among them */
    const char *json_path, *page_path;              /* NULL: no such file is written */
    const char *compared[2];
} bench_options;

extern const char bench_options_help[];

/* False: message says what is wrong. */
bool bench_options_parse(int argc, char **argv, bench_options *out_options, char *message, size_t message_size);

#endif
