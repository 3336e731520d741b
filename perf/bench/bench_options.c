/* bench_options.c: see bench_options.h. */
#include "bench/bench_options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char bench_options_help[] =
    "usage: afterglow-bench [option]...\n"
    "       afterglow-bench compare A.json B.json\n"
    "Measures what this machine is worth to a photon mapper, phase by phase, on 1, 2, 4 ... all of its cores, and\n"
    "certifies that the work was right: the same bits on all numbers of threads. It takes about five minutes.\n"
    "\n"
    "  --size S        small or large: how much work a unit is (small below 16 cores, large from there on)\n"
    "  --threads LIST  other numbers of threads, by commas; 1 is always among them\n"
    "  --allow-busy    where the machine does other work too: figures without a score, and no failure\n"
    "  --quick         a few seconds: the certificate of tiny work, and no score\n"
    "  -o FILE         write the result: NAME.json, or NAME.html, a page with plots; may be given for each\n"
    "  -q, --quiet     do not tell how far it is\n"
    "  --help          print this\n"
    "  --version       print the version\n"
    "\n"
    "Standard output has a line for a table: processor, threads, size, scores, certificate. One thread of the\n"
    "reference machine, an AMD EPYC of 2.6 GHz, has a score of 100.\n"
    "Exit status: 0 all is well; 1 the certificate is not valid, or a file to compare is no result; 2 the command line\n"
    "has an error; 3 the system failed; 4 the machine was busy, and there is no score.\n";

static int by_value(const void *a, const void *b)
{
    unsigned x = *(const unsigned *)a, y = *(const unsigned *)b;
    return x < y ? -1 : x > y;
}

/* "1,2,8": each in [1, BENCH_THREADS_MAX]. */
static bool parse_threads(const char *list, bench_options *o)
{
    unsigned count = 0;
    o->levels[count++] = 1;
    for (const char *at = list; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        char *end;
        unsigned long n = strtoul(at, &end, 10);
        if (*at < '0' || *at > '9' || (*end != ',' && *end != '\0') || n < 1 || n > BENCH_THREADS_MAX ||
            count == BENCH_LEVELS_MAX)
            return false;
        o->levels[count++] = (unsigned)n;
    }
    qsort(o->levels, count, sizeof *o->levels, by_value);
    o->level_count = 0;
    for (unsigned i = 0; i < count; i++)
        if (i == 0 || o->levels[i] != o->levels[i - 1])
            o->levels[o->level_count++] = o->levels[i];
    return true;
}

static bool ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), end_length = strlen(end);
    return length > end_length && strcmp(text + length - end_length, end) == 0;
}

/* Notes what one option asks for; false: there is no such option, or its value is not valid. */
static bool set_value(bench_options *o, const char *name, const char *value)
{
    if (strcmp(name, "--size") == 0) {
        o->has_size = true;
        o->size = strcmp(value, "large") == 0 ? BENCH_LARGE : BENCH_SMALL;
        return strcmp(value, "large") == 0 || strcmp(value, "small") == 0;
    }
    if (strcmp(name, "--threads") == 0)
        return parse_threads(value, o);
    if (ends_with(value, ".json"))
        o->json_path = value;
    else if (ends_with(value, ".html"))
        o->page_path = value;
    else
        return false;
    return true;
}

bool bench_options_parse(int argc, char **argv, bench_options *out_options, char *message, size_t message_size)
{
    bench_options *o = out_options;
    *o = (bench_options){.action = BENCH_MEASURE};
    if (argc > 1 && strcmp(argv[1], "compare") == 0) {
        o->action = BENCH_COMPARE;
        if (argc != 4) {
            snprintf(message, message_size, "compare wants two files");
            return false;
        }
        o->compared[0] = argv[2];
        o->compared[1] = argv[3];
        return true;
    }
    for (int i = 1; i < argc; i++) {
        const char *name = argv[i];
        if (strcmp(name, "--help") == 0) {
            o->action = BENCH_HELP;
        } else if (strcmp(name, "--version") == 0) {
            o->action = BENCH_VERSION;
        } else if (strcmp(name, "--quick") == 0) {
            o->has_size = true;
            o->size = BENCH_QUICK;
        } else if (strcmp(name, "--allow-busy") == 0) {
            o->allows_busy = true;
        } else if (strcmp(name, "-q") == 0 || strcmp(name, "--quiet") == 0) {
            o->is_quiet = true;
        } else if (strcmp(name, "--size") != 0 && strcmp(name, "--threads") != 0 && strcmp(name, "-o") != 0) {
            snprintf(message, message_size, "'%s' is no option", name);
            return false;
        } else if (i + 1 == argc) {
            snprintf(message, message_size, "%s wants a value", name);
            return false;
        } else if (!set_value(o, name, argv[++i])) {
            snprintf(message, message_size, "%s: '%s' is no value of it", name, argv[i]);
            return false;
        }
    }
    return true;
}
