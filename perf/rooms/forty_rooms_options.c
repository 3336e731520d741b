/* forty_rooms_options.c: the command line of afterglow-forty-rooms.
 * Flow: command line -> [here] -> forty_rooms. Threads: one. */
#include "rooms/forty_rooms_options.h"

#include <errno.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>

static const char usage_text[] =
    "usage: afterglow-forty-rooms --out DIR [options]\n"
    "Renders the forty rooms in each cache mode, checks that the pictures agree, and writes DIR/results.csv,\n"
    "DIR/runs.csv and DIR/summary.md. Exit code 1 when a run fails or a check does not hold.\n"
    "  --rooms LIST       of 1 to 40, as 1-10,33 (1-40)\n"
    "  --gathers LIST     gather rays at each gather point, each 1 to 65536 (1,4,16,64)\n"
    "  --modes LIST       of on-demand, precompute, off (all three)\n"
    "  --repeats N        runs of each; the run with the median time is kept (3)\n"
    "  --off-repeats N    the same for mode off, which takes far longer (1)\n"
    "  --threads N        for the renderer; 0 is its own choice (0)\n"
    "  --program FILE     the renderer (afterglow, beside this program)\n"
    "  --quick            rooms 1, 10, 20, 33, gathers 1 and 16, one run of each; later options add to it\n"
    "  --resume           keep the lines in DIR/results.csv and DIR/runs.csv, and measure only what is not there\n"
    "  --summary-only     measure nothing; write the summary of DIR/results.csv and DIR/runs.csv\n"
    "  --help             this text\n";

enum {
    OPTION_OUT = 1,
    OPTION_ROOMS,
    OPTION_GATHERS,
    OPTION_MODES,
    OPTION_REPEATS,
    OPTION_OFF_REPEATS,
    OPTION_THREADS,
    OPTION_PROGRAM,
    OPTION_QUICK,
    OPTION_RESUME,
    OPTION_SUMMARY_ONLY,
    OPTION_HELP
};

static const struct option long_options[] = {
    {"out", required_argument, NULL, OPTION_OUT},
    {"rooms", required_argument, NULL, OPTION_ROOMS},
    {"gathers", required_argument, NULL, OPTION_GATHERS},
    {"modes", required_argument, NULL, OPTION_MODES},
    {"repeats", required_argument, NULL, OPTION_REPEATS},
    {"off-repeats", required_argument, NULL, OPTION_OFF_REPEATS},
    {"threads", required_argument, NULL, OPTION_THREADS},
    {"program", required_argument, NULL, OPTION_PROGRAM},
    {"quick", no_argument, NULL, OPTION_QUICK},
    {"resume", no_argument, NULL, OPTION_RESUME},
    {"summary-only", no_argument, NULL, OPTION_SUMMARY_ONLY},
    {"help", no_argument, NULL, OPTION_HELP},
    {NULL, 0, NULL, 0},
};

/* A whole number at *text, which moves behind it. */
static bool scan_number(const char **text, int low, int high, int *out_value)
{
    char *end = NULL;
    errno = 0;
    const long value = strtol(*text, &end, 10);
    if (errno != 0 || end == *text || value < low || value > high) {
        return false;
    }
    *text = end;
    *out_value = (int)value;
    return true;
}

static bool parse_number(const char *text, int low, int high, int *out_value)
{
    return scan_number(&text, low, high, out_value) && *text == '\0';
}

static bool parse_rooms(const char *text, bool *rooms)
{
    memset(rooms, 0, (ROOM_COUNT + 1) * sizeof *rooms);
    for (;; ++text) {
        int first = 0;
        if (!scan_number(&text, 1, ROOM_COUNT, &first)) {
            return false;
        }
        int last = first;
        if (*text == '-') {
            ++text;
            if (!scan_number(&text, first, ROOM_COUNT, &last)) {
                return false;
            }
        }
        for (int room = first; room <= last; ++room) {
            rooms[room] = true;
        }
        if (*text != ',') {
            return *text == '\0';
        }
    }
}

static bool parse_gathers(const char *text, forty_rooms_options *options)
{
    options->gather_count = 0;
    for (;; ++text) {
        if (options->gather_count == GATHER_LIST_MAX ||
            !scan_number(&text, 1, 65536, &options->gathers[options->gather_count])) {
            return false;
        }
        ++options->gather_count;
        if (*text != ',') {
            return *text == '\0';
        }
    }
}

static bool parse_modes(const char *text, bool *modes)
{
    memset(modes, 0, CACHE_MODE_COUNT * sizeof *modes);
    for (;;) {
        const size_t length = strcspn(text, ",");
        bool known = false;
        for (int mode = 0; mode < CACHE_MODE_COUNT; ++mode) {
            const char *name = cache_mode_text((cache_mode)mode);
            if (strlen(name) == length && strncmp(text, name, length) == 0) {
                modes[mode] = true;
                known = true;
            }
        }
        if (!known) {
            return false;
        }
        if (text[length] == '\0') {
            return true;
        }
        text += length + 1;
    }
}

static void set_quick(forty_rooms_options *options)
{
    (void)parse_rooms("1,10,20,33", options->rooms);
    (void)parse_gathers("1,16", options);
    for (int mode = 0; mode < CACHE_MODE_COUNT; ++mode) {
        options->repeats[mode] = 1;
    }
}

static bool apply_option(int choice, forty_rooms_options *options)
{
    switch (choice) {
    case OPTION_OUT: options->folder = optarg; return true;
    case OPTION_ROOMS: return parse_rooms(optarg, options->rooms);
    case OPTION_GATHERS: return parse_gathers(optarg, options);
    case OPTION_MODES: return parse_modes(optarg, options->modes);
    case OPTION_REPEATS:
        if (!parse_number(optarg, 1, 99, &options->repeats[CACHE_ON_DEMAND])) {
            return false;
        }
        options->repeats[CACHE_PRECOMPUTE] = options->repeats[CACHE_ON_DEMAND];
        return true;
    case OPTION_OFF_REPEATS: return parse_number(optarg, 1, 99, &options->repeats[CACHE_OFF]);
    case OPTION_THREADS: return parse_number(optarg, 0, 4096, &options->thread_count);
    case OPTION_PROGRAM: options->program = optarg; return true;
    case OPTION_QUICK: set_quick(options); return true;
    case OPTION_RESUME: options->resume = true; return true;
    case OPTION_SUMMARY_ONLY: options->summary_only = true; return true;
    default: return false;
    }
}

int forty_rooms_parse_options(int argc, char **argv, forty_rooms_options *out_options)
{
    *out_options = (forty_rooms_options){
        .modes = {true, true, true},
        .repeats = {[CACHE_ON_DEMAND] = 3, [CACHE_PRECOMPUTE] = 3, [CACHE_OFF] = 1},
    };
    (void)parse_rooms("1-40", out_options->rooms);
    (void)parse_gathers("1,4,16,64", out_options);

    int index = 0;
    for (int choice; (choice = getopt_long(argc, argv, "", long_options, &index)) != -1;) {
        if (choice == OPTION_HELP) {
            fputs(usage_text, stdout);
            return -1;
        }
        if (choice == '?') { /* getopt has told */
            return 2;
        }
        if (!apply_option(choice, out_options)) {
            fprintf(stderr, "afterglow-forty-rooms: error: --%s does not take '%s'; see --help\n",
                    long_options[index].name, optarg);
            return 2;
        }
    }
    if (out_options->folder == NULL || optind != argc) {
        fputs(usage_text, stderr);
        return 2;
    }
    return 0;
}
