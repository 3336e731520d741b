/* forty_rooms_summary.c: ratios between the cache modes over the rooms, and where 'off' and 'precompute' cross.
 * Compared with Neilson & Yang (TR 04-21, 2004): on demand 1.2 to 2.2 times faster than precomputing, and
 * precomputing slower than no cache where few estimates are asked for.
 * Flow: forty_rooms_results -> [here] -> summary.md. Threads: one. */
#include "rooms/forty_rooms_summary.h"

#include "rooms/room_layout.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* Numbers gathered over rooms or lines; there is space for all of them, so adding cannot fail. */
typedef struct sample_list {
    double *values;
    size_t count;
} sample_list;

static void add_sample(sample_list *list, double value)
{
    if (isfinite(value)) {
        list->values[list->count++] = value;
    }
}

/* "min / median / max", or a dash. */
static void print_spread(FILE *file, sample_list *list, const char *before, int decimals)
{
    if (list->count == 0) {
        fprintf(file, "%s-", before);
        return;
    }
    const double middle = result_median(list->values, list->count); /* sorts */
    fprintf(file, "%s%.*f / %.*f / %.*f", before, decimals, list->values[0], decimals, middle, decimals,
            list->values[list->count - 1]);
}

static double value_of(const result_row *row, result_column column) { return row == NULL ? NAN : row->values[column]; }

/* How many times longer a took than b; NaN where one is missing. */
static double time_ratio(const result_row *a, const result_row *b, result_column column)
{
    const double ratio = value_of(a, column) / value_of(b, column);
    return isfinite(ratio) ? ratio : NAN;
}

/* The modes of one room at one gather count. */
typedef struct room_modes {
    const result_row *on_demand, *precompute, *off;
} room_modes;

static room_modes find_modes(const result_table *table, int room, int gather)
{
    const room_modes modes = {result_table_find(table, room, gather, CACHE_ON_DEMAND, 0),
                              result_table_find(table, room, gather, CACHE_PRECOMPUTE, 0),
                              result_table_find(table, room, gather, CACHE_OFF, 0)};
    return modes;
}

/* Gather hits that ask for irradiance, per stored photon: what 'off' has to estimate, where precompute has 1. */
static double requests_per_photon(const room_modes *modes)
{
    const result_row *cached = modes->on_demand != NULL ? modes->on_demand : modes->precompute;
    const double own = value_of(modes->off, RESULT_REQUESTS) / value_of(modes->off, RESULT_STORED);
    return own > 0.0 ? own : value_of(cached, RESULT_REQUESTS) / value_of(cached, RESULT_STORED);
}

static void print_on_demand(FILE *file, const result_table *table, const int *gathers, size_t gather_count,
                            double *scratch[4])
{
    fprintf(file,
            "\n## On demand against precompute\n\n"
            "Speed-up: precompute's time divided by on-demand's, for emission + map + irradiance + picture; the paper "
            "has 1.2 to 2.2.\nThree numbers: least / median / greatest of the rooms.\n\n"
            "| gather rays | rooms | speed-up | by CPU time of each mode's median run | on-demand is faster in | "
            "share of the photons computed | us an estimate, on demand | us an estimate, precompute | "
            "equal pictures |\n"
            "|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    for (size_t i = 0; i < gather_count; ++i) {
        sample_list speed_up = {scratch[0], 0}, cpu = {scratch[1], 0}, share = {scratch[2], 0}, cost = {scratch[3], 0};
        int faster = 0, compared = 0, equal = 0;
        for (int room = 1; room <= ROOM_COUNT; ++room) {
            const room_modes modes = find_modes(table, room, gathers[i]);
            const double ratio = time_ratio(modes.precompute, modes.on_demand, RESULT_SUM_S);
            add_sample(&speed_up, ratio);
            add_sample(&cpu, time_ratio(modes.precompute, modes.on_demand, RESULT_CPU_S));
            add_sample(&share, value_of(modes.on_demand, RESULT_SHARE));
            add_sample(&cost, value_of(modes.on_demand, RESULT_US_PER_ESTIMATE));
            faster += ratio > 1.0;
            const double identical = value_of(modes.on_demand, RESULT_IDENTICAL);
            compared += isfinite(identical);
            equal += identical > 0.0;
        }
        fprintf(file, "| %d | %zu ", gathers[i], speed_up.count);
        print_spread(file, &speed_up, "| ", 2);
        print_spread(file, &cpu, " | ", 2);
        fprintf(file, " | %d of %zu", faster, speed_up.count);
        print_spread(file, &share, " | ", 3);
        print_spread(file, &cost, " | ", 1);
        cost.count = 0;
        for (int room = 1; room <= ROOM_COUNT; ++room) {
            add_sample(&cost, value_of(find_modes(table, room, gathers[i]).precompute, RESULT_US_PER_ESTIMATE));
        }
        print_spread(file, &cost, " | ", 1);
        fprintf(file, " | %d of %d |\n", equal, compared);
    }
}

static double mean(const sample_list *list)
{
    double sum = 0.0;
    for (size_t i = 0; i < list->count; ++i) {
        sum += list->values[i];
    }
    return sum / (double)list->count;
}

static void print_repeats(FILE *file, const result_table *table, const result_table *runs, const int *gathers,
                          size_t gather_count, double *scratch[4])
{
    fprintf(
        file,
        "\n## On demand against precompute, repeat by repeat\n\n"
        "A room's speed-up: precompute's CPU time (of the whole process) divided by on-demand's in the same repeat; "
        "the median of the\nrepeats. Three numbers: least / median / greatest of the rooms. What is saved ought to "
        "grow with what is not asked for: the last two\ncolumns, means over the rooms.\n\n"
        "| gather rays | rooms | speed-up | rooms below 1 | rooms below 1/1.05 | "
        "1 - share of the photons computed | 1 - CPU time, on-demand / precompute |\n"
        "|---:|---:|---:|---:|---:|---:|---:|\n");
    for (size_t i = 0; i < gather_count; ++i) {
        sample_list speed_up = {scratch[0], 0}, unasked = {scratch[1], 0}, saved = {scratch[2], 0};
        int slower = 0, much_slower = 0;
        for (int room = 1; room <= ROOM_COUNT; ++room) {
            const double ratio = result_table_speed_up(runs, room, gathers[i], scratch[3]);
            const result_row *on_demand = find_modes(table, room, gathers[i]).on_demand;
            if (isnan(ratio) || on_demand == NULL) {
                continue;
            }
            slower += ratio < 1.0;
            much_slower += ratio < 1.0 / 1.05;
            add_sample(&speed_up, ratio);
            add_sample(&saved, 1.0 - 1.0 / ratio);
            add_sample(&unasked, 1.0 - value_of(on_demand, RESULT_SHARE));
        }
        if (speed_up.count == 0) {
            continue;
        }
        fprintf(file, "| %d | %zu ", gathers[i], speed_up.count);
        print_spread(file, &speed_up, "| ", 3);
        fprintf(file, " | %d | %d | %.3f | %.3f |\n", slower, much_slower, mean(&unasked), mean(&saved));
    }
}

/* The rooms in which precompute took longer than off, as "1-9, 12". */
static void print_lost_rooms(FILE *file, const result_table *table, int gather)
{
    bool lost[ROOM_COUNT + 2] = {false};
    int lost_count = 0, compared = 0;
    for (int room = 1; room <= ROOM_COUNT; ++room) {
        const room_modes modes = find_modes(table, room, gather);
        const double ratio = time_ratio(modes.precompute, modes.off, RESULT_SUM_S);
        compared += isfinite(ratio);
        lost[room] = ratio > 1.0;
        lost_count += lost[room];
    }
    if (compared == 0) {
        return;
    }
    fprintf(file, "- %d gather ray%s: precompute loses to off in ", gather, gather == 1 ? "" : "s");
    if (lost_count == 0) {
        fprintf(file, "none of %d rooms\n", compared);
        return;
    }
    fprintf(file, "%d of %d rooms (", lost_count, compared);
    const char *separator = "";
    for (int room = 1; room <= ROOM_COUNT; ++room) {
        if (!lost[room] || lost[room - 1]) {
            continue;
        }
        int last = room;
        while (lost[last + 1]) {
            ++last;
        }
        fprintf(file, "%s%d", separator, room);
        if (last > room) {
            fprintf(file, "-%d", last);
        }
        separator = ", ";
    }
    fprintf(file, ")\n");
}

/* The gather count, in requests per photon, at which off takes as long as precompute: on a straight line between the
 * two neighbouring measurements, both axes logarithmic. NaN where the room has no such neighbours. */
static double find_crossing(const result_table *table, int room, const int *gathers, size_t gather_count)
{
    double last_x = NAN, last_y = NAN;
    for (size_t i = 0; i < gather_count; ++i) {
        const room_modes modes = find_modes(table, room, gathers[i]);
        const double x = log(requests_per_photon(&modes));
        const double y = log(time_ratio(modes.off, modes.precompute, RESULT_SUM_S));
        if (!isfinite(x) || !isfinite(y)) {
            continue;
        }
        if (last_y <= 0.0 && y > 0.0) {
            return exp(last_x + (x - last_x) * (0.0 - last_y) / (y - last_y));
        }
        last_x = x;
        last_y = y;
    }
    return NAN;
}

static void print_off(FILE *file, const result_table *table, const int *gathers, size_t gather_count,
                      double *scratch[4])
{
    fprintf(file,
            "\n## Without a cache\n\n"
            "Off makes one estimate at each gather hit; precompute one at each photon. Three numbers as above.\n\n"
            "| gather rays | rooms | off / precompute | off / on-demand | estimates asked for, per stored photon |\n"
            "|---:|---:|---:|---:|---:|\n");
    for (size_t i = 0; i < gather_count; ++i) {
        sample_list precompute = {scratch[0], 0}, on_demand = {scratch[1], 0}, requests = {scratch[2], 0};
        for (int room = 1; room <= ROOM_COUNT; ++room) {
            const room_modes modes = find_modes(table, room, gathers[i]);
            add_sample(&precompute, time_ratio(modes.off, modes.precompute, RESULT_SUM_S));
            add_sample(&on_demand, time_ratio(modes.off, modes.on_demand, RESULT_SUM_S));
            if (modes.off != NULL) {
                add_sample(&requests, requests_per_photon(&modes));
            }
        }
        fprintf(file, "| %d | %zu ", gathers[i], requests.count);
        print_spread(file, &precompute, "| ", 2);
        print_spread(file, &on_demand, " | ", 2);
        print_spread(file, &requests, " | ", 2);
        fprintf(file, " |\n");
    }
    fprintf(file, "\n");
    for (size_t i = 0; i < gather_count; ++i) {
        print_lost_rooms(file, table, gathers[i]);
    }
    sample_list crossing = {scratch[0], 0};
    for (int room = 1; room <= ROOM_COUNT; ++room) {
        add_sample(&crossing, find_crossing(table, room, gathers, gather_count));
    }
    fprintf(file, "\nOff and precompute cross between the gather counts measured in %zu rooms", crossing.count);
    if (crossing.count > 0) {
        print_spread(file, &crossing, ", at ", 2);
        fprintf(file, " estimates asked for per stored photon");
    }
    fprintf(file, ".\n");
}

/* Sphere 33 stands close under the light: the paper's precompute times jump there. */
static void print_large_sphere(FILE *file, const result_table *table, const int *gathers, size_t gather_count)
{
    fprintf(file,
            "\n## Around sphere %d\n\n"
            "| gather rays | room | precompute phase, s | us an estimate | speed-up | share computed on demand |\n"
            "|---:|---:|---:|---:|---:|---:|\n",
            ROOM_LARGE_SPHERE);
    for (size_t i = 0; i < gather_count; ++i) {
        for (int room = ROOM_LARGE_SPHERE - 2; room <= ROOM_LARGE_SPHERE + 2; ++room) {
            const room_modes modes = find_modes(table, room, gathers[i]);
            if (modes.precompute == NULL || modes.on_demand == NULL) {
                continue;
            }
            fprintf(file, "| %d | %d | %.3f | %.1f | %.2f | %.3f |\n", gathers[i], room,
                    value_of(modes.precompute, RESULT_PRECOMPUTE_S), value_of(modes.precompute, RESULT_US_PER_ESTIMATE),
                    time_ratio(modes.precompute, modes.on_demand, RESULT_SUM_S),
                    value_of(modes.on_demand, RESULT_SHARE));
        }
    }
}

static void print_checks(FILE *file, const result_table *table, double *scratch)
{
    size_t computed_twice = 0, miscounted = 0, compared = 0, different = 0;
    sample_list threads = {scratch, 0};
    for (size_t i = 0; i < table->count; ++i) {
        const double *values = table->rows[i].values;
        computed_twice += values[RESULT_DUPLICATED] <= 0.0 ? 0 : 1;
        miscounted += fabs(values[RESULT_COMPUTED] - values[RESULT_DISTINCT]) <= 0.0 ? 0 : 1;
        compared += isfinite(values[RESULT_IDENTICAL]) ? 1 : 0;
        different += values[RESULT_IDENTICAL] <= 0.0 ? 1 : 0;
        add_sample(&threads, values[RESULT_THREADS]);
    }
    fprintf(file, "\n## Checks\n\n%zu lines", table->count);
    if (threads.count > 0) {
        (void)result_median(threads.values, threads.count); /* sorts */
        const double least = threads.values[0], most = threads.values[threads.count - 1];
        if (least < most) {
            fprintf(file, ", measured with %.0f to %.0f threads", least, most);
        } else {
            fprintf(file, ", measured with %.0f thread%s", most, most > 1.0 ? "s" : "");
        }
    }
    fprintf(file,
            ". Irradiance computed twice: in %zu. `computed` is not `distinct`: in %zu.\n"
            "Pictures that must be the same compared in %zu; a pixel differs in %zu.\n",
            computed_twice, miscounted, compared, different);
}

ag_status forty_rooms_summary_write(const char *path, const result_table *table, const result_table *runs)
{
    size_t gather_count = 0;
    int *gathers = result_table_gathers(table, &gather_count);
    const size_t capacity = table->count + runs->count + ROOM_COUNT; /* of each list: a line each, or a room each */
    double *memory = malloc(4 * capacity * sizeof *memory);
    ag_status status = AG_ERROR_MEMORY;
    if (gathers != NULL && memory != NULL) {
        double *scratch[4] = {memory, memory + capacity, memory + 2 * capacity, memory + 3 * capacity};
        FILE *file = fopen(path, "w");
        status = AG_ERROR_OUTPUT;
        if (file != NULL) {
            fprintf(file, "# The forty rooms: summary of results.csv and runs.csv\n");
            print_on_demand(file, table, gathers, gather_count, scratch);
            if (runs->count > 0) {
                print_repeats(file, table, runs, gathers, gather_count, scratch);
            }
            print_off(file, table, gathers, gather_count, scratch);
            print_large_sphere(file, table, gathers, gather_count);
            print_checks(file, table, memory);
            const bool failed = ferror(file) != 0;
            status = fclose(file) != 0 || failed ? AG_ERROR_OUTPUT : AG_OK;
        }
    }
    free(memory);
    free(gathers);
    return status;
}
