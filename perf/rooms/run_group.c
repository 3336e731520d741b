/* run_group.c: interleaved runs, what each run owes, pictures that must agree, and the median run.
 * Flow: forty_rooms -> [here] -> renderer_run. Threads: one. */
#include "rooms/run_group.h"

#include "bench/path.h"
#include "rooms/renderer_run.h"
#include "rooms/room_file.h"

#include <math.h>
#include <stdlib.h>

typedef struct run_group {
    const run_group_settings *settings;
    result_row *runs[CACHE_MODE_COUNT]; /* repeats of each mode, in the order run */
    int run_count[CACHE_MODE_COUNT];
    result_table *all_runs; /* the caller's */
    /* The first picture of a family stands for it: on-demand and precompute are one, off is another estimator. */
    renderer_picture reference[2];
    int compared[2];
    bool identical[2];
    int *failed_checks;
} run_group;

static int family_of(cache_mode mode) { return mode == CACHE_OFF ? 1 : 0; }

static void report_failed_check(run_group *group, const result_row *row, const char *what)
{
    fprintf(stderr, "room %d, gather %d, %s: error: %s\n", row->room, row->gather, cache_mode_text(row->mode), what);
    ++*group->failed_checks;
}

/* Checks that hold for every run, whatever its mode. Counts are whole numbers, exact in a double. */
static void check_run(run_group *group, const result_row *row)
{
    const double *values = row->values;
    if (values[RESULT_DUPLICATED] > 0.0) {
        report_failed_check(group, row, "irradiance was computed twice at a photon");
    }
    if (fabs(values[RESULT_COMPUTED] - values[RESULT_DISTINCT]) > 0.0) {
        report_failed_check(group, row, "'computed' is not 'distinct'");
    }
    if (values[RESULT_COMPUTED] > values[RESULT_STORED]) {
        report_failed_check(group, row, "more irradiance was computed than there are photons");
    }
    if (fabs(values[RESULT_STORED] - ROOM_PHOTON_COUNT) > 0.0) {
        report_failed_check(group, row, "the global map does not hold the photons asked for");
    }
    if (!(values[RESULT_PICTURE_MEAN] > 0.0 && isfinite(values[RESULT_PICTURE_MEAN]))) {
        report_failed_check(group, row, "the picture is black, or not finite");
    }
}

/* Holds the picture against the first of its family, which it becomes where there is none yet. Takes it over. */
static void check_picture(run_group *group, const result_row *row, renderer_picture *picture)
{
    const int family = family_of(row->mode);
    if (group->reference[family].pixels == NULL) {
        group->reference[family] = *picture;
        group->identical[family] = true;
        return;
    }
    const size_t count = renderer_picture_difference_count(&group->reference[family], picture);
    ++group->compared[family];
    if (count > 0) {
        char text[96];
        snprintf(text, sizeof text, "pixels that differ from the group's first picture: %zu", count);
        report_failed_check(group, row, text);
        group->identical[family] = false;
    }
    renderer_picture_reset(picture);
}

/* repeat and turn count from 0. */
static ag_status run_once(run_group *group, cache_mode mode, int repeat, int turn)
{
    const run_group_settings *settings = group->settings;
    char picture_path[PATH_SIZE], stats_path[PATH_SIZE], picture_name[64], stats_name[64];
    snprintf(picture_name, sizeof picture_name, "%s.exr", cache_mode_text(mode));
    snprintf(stats_name, sizeof stats_name, "%s.json", cache_mode_text(mode));
    if (!path_join(settings->work_folder, picture_name, picture_path) ||
        !path_join(settings->work_folder, stats_name, stats_path)) {
        return AG_ERROR_ARGUMENT;
    }
    const renderer_run_settings run = {
        .program = settings->program,
        .scene_path = settings->scene_path,
        .picture_path = picture_path,
        .stats_path = stats_path,
        .cache = mode,
        .gather_samples = settings->gather,
        .thread_count = settings->thread_count,
    };
    result_row *row = &group->runs[mode][group->run_count[mode]];
    row->room = settings->room;
    row->gather = settings->gather;
    row->repeat = settings->first_repeat + repeat;
    row->turn = turn + 1;
    renderer_picture picture;
    const ag_status status = renderer_run(&run, row, &picture);
    if (status != AG_OK) {
        renderer_picture_reset(&picture);
        return status;
    }
    ++group->run_count[mode];
    check_run(group, row);
    check_picture(group, row, &picture);
    return result_table_add(group->all_runs, row);
}

/* The modes that have a run in this repeat, in order. Another begins each time, of those that are measured: counted
 * over all modes, the one after a mode left out would begin twice as often. */
static int list_turns(const run_group_settings *settings, int repeat, cache_mode out_modes[CACHE_MODE_COUNT])
{
    cache_mode measured[CACHE_MODE_COUNT];
    int count = 0;
    for (int mode = 0; mode < CACHE_MODE_COUNT; ++mode) {
        if (settings->modes[mode] && repeat < settings->repeats[mode]) {
            measured[count++] = (cache_mode)mode;
        }
    }
    for (int turn = 0; turn < count; ++turn) {
        out_modes[turn] = measured[(repeat + turn) % count];
    }
    return count;
}

/* The modes take turns: what else the machine does then falls on all of them. */
static ag_status run_interleaved(run_group *group)
{
    const run_group_settings *settings = group->settings;
    cache_mode modes[CACHE_MODE_COUNT];
    int turn_count = 0;
    for (int repeat = 0; (turn_count = list_turns(settings, repeat, modes)) > 0; ++repeat) {
        for (int turn = 0; turn < turn_count; ++turn) {
            const ag_status status = run_once(group, modes[turn], repeat, turn);
            if (status != AG_OK) {
                return status;
            }
        }
    }
    return AG_OK;
}

static int compare_by_sum(const void *a, const void *b)
{
    const double x = ((const result_row *)a)->values[RESULT_SUM_S];
    const double y = ((const result_row *)b)->values[RESULT_SUM_S];
    return (x > y) - (x < y);
}

/* A whole run, not the median of each column, so that its phases add up. */
static result_row median_run(const run_group *group, cache_mode mode)
{
    result_row *runs = group->runs[mode];
    const int count = group->run_count[mode];
    qsort(runs, (size_t)count, sizeof *runs, compare_by_sum);
    result_row row = runs[(count - 1) / 2];
    row.repeat = row.turn = 0;
    row.values[RESULT_REPEATS] = count;
    row.values[RESULT_SUM_MIN_S] = runs[0].values[RESULT_SUM_S];
    row.values[RESULT_SUM_MAX_S] = runs[count - 1].values[RESULT_SUM_S];
    const int family = family_of(mode);
    if (group->compared[family] > 0) {
        row.values[RESULT_IDENTICAL] = group->identical[family] ? 1.0 : 0.0;
    }
    return row;
}

ag_status run_group_measure(const run_group_settings *settings, result_table *table, result_table *runs,
                            int *failed_checks)
{
    run_group group = {.settings = settings, .all_runs = runs, .failed_checks = failed_checks};
    ag_status status = AG_OK;
    for (int mode = 0; mode < CACHE_MODE_COUNT; ++mode) {
        if (settings->modes[mode]) {
            group.runs[mode] = malloc((size_t)settings->repeats[mode] * sizeof *group.runs[mode]);
            status = group.runs[mode] == NULL ? AG_ERROR_MEMORY : status;
        }
    }
    if (status == AG_OK) {
        status = run_interleaved(&group);
    }
    for (int mode = 0; mode < CACHE_MODE_COUNT && status == AG_OK; ++mode) {
        if (group.run_count[mode] > 0) {
            const result_row row = median_run(&group, (cache_mode)mode);
            status = result_table_add(table, &row);
        }
    }
    for (int mode = 0; mode < CACHE_MODE_COUNT; ++mode) {
        free(group.runs[mode]);
    }
    renderer_picture_reset(&group.reference[0]);
    renderer_picture_reset(&group.reference[1]);
    return status;
}
