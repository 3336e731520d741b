/* afterglow_bench.c: the program afterglow-bench: what a machine is worth to a photon mapper, with a certificate that
 * the work was right. Flow: options -> bench_run -> bench_certificate, bench_score -> JSON, page, line.
 * Threads: main, and those of each level's context. */
#define _POSIX_C_SOURCE 200809L
#include "atomic_file.h"
#include "bench/bench_compare.h"
#include "bench/bench_json.h"
#include "bench/bench_options.h"
#include "bench/bench_page.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ALL_IS_WELL = 0, WRONG_WORK = 1, WRONG_USE = 2, SYSTEM_FAILED = 3, MACHINE_BUSY = 4 };
/* With this many cores or more a unit of the small size is too short to keep them busy. */
enum { LARGE_FROM_CORES = 16 };

static void say(void *user, ag_log_level level, const char *text)
{
    (void)user;
    if (level == AG_LOG_ERROR)
        fprintf(stderr, "afterglow-bench: %s\n", text);
}

static void tell_progress(const char *what) { fprintf(stderr, "afterglow-bench: %s\n", what); }

static int fail(const char *what)
{
    fprintf(stderr, "afterglow-bench: error: %s\n", what);
    return SYSTEM_FAILED;
}

/* Whether both files could be written, before minutes are spent. */
static bool check_paths(const bench_options *o)
{
    char message[1024] = "";
    const char *const paths[] = {o->json_path, o->page_path};
    for (int i = 0; i < 2; i++)
        if (paths[i] && atomic_file_check(paths[i], message, sizeof message) != AG_OK) {
            fail(message);
            return false;
        }
    return true;
}

static bool write_file(const char *path, const char *text)
{
    char message[1024] = "";
    if (text && atomic_file_write(NULL, path, text, strlen(text), message, sizeof message) == AG_OK)
        return true;
    fail(text ? message : "out of memory");
    return false;
}

static bool write_files(const bench_options *o, const json_t *result)
{
    bool is_written = true;
    if (o->json_path) {
        char *text = json_dumps(result, JSON_INDENT(1) | JSON_REAL_PRECISION(9));
        is_written = write_file(o->json_path, text);
        free(text);
    }
    if (o->page_path && is_written) {
        char *page = bench_page(result);
        is_written = write_file(o->page_path, page);
        free(page);
    }
    return is_written;
}

static void print_reasons(const json_t *reasons)
{
    size_t i;
    json_t *reason;
    json_array_foreach(reasons, i, reason) fprintf(stderr, "afterglow-bench: %s\n", json_string_value(reason));
}

/* Beside an interval: what the clock did meanwhile. */
static void print_clock(const json_t *result)
{
    const json_t *best = json_object_get(result, "score_best"), *machine = json_object_get(result, "machine");
    double least = json_number_value(json_object_get(machine, "clock_least_mhz"));
    if (!json_is_false(json_object_get(best, "steady")))
        return;
    if (least > 0.0)
        fprintf(
            stderr,
            "afterglow-bench: scores of the turns are more than 2 %% apart; the clock was seen at %.0f to %.0f MHz\n",
            least, json_number_value(json_object_get(machine, "clock_most_mhz")));
    else
        fputs("afterglow-bench: scores of the turns are more than 2 % apart; the clock is not told\n", stderr);
}

static int report(const bench_options *o, const json_t *result, bool is_valid)
{
    char line[512];
    if (!write_files(o, result))
        return SYSTEM_FAILED;
    bench_line(result, line, sizeof line);
    puts(line);
    print_reasons(json_object_get(json_object_get(result, "certificate"), "reasons"));
    print_reasons(json_object_get(result, "refused"));
    print_clock(result);
    if (fflush(stdout) != 0)
        return fail("standard output cannot be written");
    if (!is_valid)
        return WRONG_WORK;
    return json_is_true(json_object_get(result, "busy")) && !o->allows_busy ? MACHINE_BUSY : ALL_IS_WELL;
}

static int measure(bench_options *o)
{
    static bench_run run;
    static certificate c;
    bench_machine machine;
    ag_status status = check_paths(o) ? bench_machine_create(&machine) : AG_ERROR_OUTPUT;
    if (status != AG_OK) {
        if (status != AG_ERROR_OUTPUT)
            fail(ag_status_text(status));
        return SYSTEM_FAILED;
    }
    if (!o->has_size)
        o->size = machine.core_count < LARGE_FROM_CORES ? BENCH_SMALL : BENCH_LARGE;
    if (o->level_count == 0) {
        unsigned cores = machine.core_count < machine.entitled ? machine.core_count : machine.entitled;
        o->level_count = bench_levels_of(cores, machine.entitled, o->levels);
    }
    unsetenv("OCIO"); /* the colours are to be the same everywhere */
    status =
        bench_run_measure(&machine, o->size, o->levels, o->level_count, say, o->is_quiet ? NULL : tell_progress, &run);
    int code = SYSTEM_FAILED;
    if (status == AG_OK) {
        bench_build build = bench_build_describe(run.isa, run.machine.maker);
        bench_certify(&run, &build, &c);
        json_t *result = bench_json(&run, &build, &c);
        code = result ? report(o, result, c.is_valid) : fail("out of memory");
        json_decref(result);
    } else {
        fail(ag_status_text(status));
    }
    bench_run_reset(&run);
    return code;
}

int main(int argc, char **argv)
{
    bench_options o;
    char message[1024];
    if (!bench_options_parse(argc, argv, &o, message, sizeof message)) {
        fprintf(stderr, "afterglow-bench: error: %s; --help tells of all\n", message);
        return WRONG_USE;
    }
    switch (o.action) {
    case BENCH_HELP: fputs(bench_options_help, stdout); return ALL_IS_WELL;
    case BENCH_VERSION: printf("afterglow-bench %s\n", ag_version()); return ALL_IS_WELL;
    case BENCH_COMPARE:
        if (bench_compare(o.compared[0], o.compared[1], stdout, message, sizeof message) == AG_OK)
            return ALL_IS_WELL;
        fprintf(stderr, "%s\n", message);
        return WRONG_WORK;
    case BENCH_MEASURE: break;
    }
    return measure(&o);
}
