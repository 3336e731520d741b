/* forty_rooms.c: the program afterglow-forty-rooms: the paper's experiment, each room in each cache mode.
 * After Neilson & Yang, "Beyond Faster Photon Map Global Illumination" (TR 04-21, 2004).
 * Flow: room_file -> run_group -> [here] -> results.csv, runs.csv, summary.md. Threads: one; the renderer, run as a
 * process of its own, has the machine to itself. */
#define _DEFAULT_SOURCE /* readlink */
#include "bench/path.h"
#include "rooms/forty_rooms_options.h"
#include "rooms/forty_rooms_summary.h"
#include "rooms/room_file.h"
#include "rooms/run_group.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct benchmark {
    const forty_rooms_options *options;
    char program[PATH_SIZE];
    char csv_path[PATH_SIZE], runs_path[PATH_SIZE], summary_path[PATH_SIZE], work_folder[PATH_SIZE];
    room_sphere spheres[ROOM_COUNT];
    result_table table, runs;
    int failed_checks;
} benchmark;

/* Appends the table's lines from first on to the file at once, so that a benchmark which is cut short keeps what it
 * measured. */
static ag_status keep_lines(const char *path, result_form form, const result_table *table, size_t first)
{
    FILE *file = fopen(path, "a");
    if (file == NULL) {
        fprintf(stderr, "%s: error: %s\n", path, strerror(errno));
        return AG_ERROR_OUTPUT;
    }
    if (fseek(file, 0, SEEK_END) == 0 && ftell(file) == 0) {
        result_print_heading(file, form);
    }
    for (size_t i = first; i < table->count; ++i) {
        result_print_row(file, form, &table->rows[i]);
    }
    const bool failed = ferror(file) != 0;
    if (fclose(file) != 0 || failed) {
        fprintf(stderr, "%s: error: it cannot be written\n", path);
        return AG_ERROR_OUTPUT;
    }
    return AG_OK;
}

static void tell_lines(const benchmark *bench, size_t first)
{
    const result_row *rows = &bench->table.rows[first];
    printf("room %2d, gather %2d:", rows[0].room, rows[0].gather);
    for (size_t i = 0; i < bench->table.count - first; ++i) {
        const double *values = rows[i].values;
        printf("  %s %.2f s", cache_mode_text(rows[i].mode), values[RESULT_SUM_S]);
        if (rows[i].mode == CACHE_ON_DEMAND) {
            printf(" (%.1f %% of the photons)", 100.0 * values[RESULT_SHARE]);
        }
        if (values[RESULT_IDENTICAL] <= 0.0) {
            printf(" PICTURES DIFFER");
        }
    }
    printf("\n");
    (void)fflush(stdout);
}

static ag_status measure_group(benchmark *bench, int room, int gather, const char *scene_path)
{
    const forty_rooms_options *options = bench->options;
    run_group_settings settings = {
        .program = bench->program,
        .work_folder = bench->work_folder,
        .scene_path = scene_path,
        .room = room,
        .gather = gather,
        .thread_count = options->thread_count,
        /* Numbered on after those of an earlier call: what was not run together is never taken for a pair. */
        .first_repeat = result_table_last_repeat(&bench->runs, room, gather) + 1,
    };
    bool anything = false;
    for (int mode = 0; mode < CACHE_MODE_COUNT; ++mode) {
        settings.modes[mode] =
            options->modes[mode] && result_table_find(&bench->table, room, gather, (cache_mode)mode, 0) == NULL;
        settings.repeats[mode] = options->repeats[mode];
        anything = anything || settings.modes[mode];
    }
    if (!anything) {
        return AG_OK;
    }
    const size_t first = bench->table.count, first_run = bench->runs.count;
    ag_status status = run_group_measure(&settings, &bench->table, &bench->runs, &bench->failed_checks);
    if (status == AG_OK) { /* the runs first: a line of results.csv is never without them */
        status = keep_lines(bench->runs_path, RESULT_RUNS, &bench->runs, first_run);
    }
    if (status == AG_OK) {
        status = keep_lines(bench->csv_path, RESULT_MEDIANS, &bench->table, first);
    }
    if (status == AG_OK) {
        tell_lines(bench, first);
    }
    return status;
}

static ag_status measure_rooms(benchmark *bench)
{
    for (int room = 1; room <= ROOM_COUNT; ++room) {
        if (!bench->options->rooms[room]) {
            continue;
        }
        char name[32], scene_path[PATH_SIZE];
        room_file_name(room, name, sizeof name);
        if (!path_join(bench->work_folder, name, scene_path)) {
            return AG_ERROR_ARGUMENT;
        }
        if (room_file_write(scene_path, bench->spheres, room, bench->options->gathers[0]) != AG_OK) {
            fprintf(stderr, "%s: error: %s\n", scene_path, strerror(errno));
            return AG_ERROR_OUTPUT;
        }
        for (int i = 0; i < bench->options->gather_count; ++i) {
            const ag_status status = measure_group(bench, room, bench->options->gathers[i], scene_path);
            if (status != AG_OK) {
                return status;
            }
        }
    }
    return AG_OK;
}

/* 'afterglow' in the folder of this program. */
static bool find_program(benchmark *bench)
{
    if (bench->options->program != NULL) {
        snprintf(bench->program, sizeof bench->program, "%s", bench->options->program);
        return true;
    }
    char own_path[PATH_SIZE];
    const ssize_t length = readlink("/proc/self/exe", own_path, sizeof own_path - 1);
    if (length <= 0) {
        fprintf(stderr, "afterglow-forty-rooms: error: where it stands is not known; use --program\n");
        return false;
    }
    own_path[length] = '\0';
    *strrchr(own_path, '/') = '\0'; /* an absolute path: there is one */
    return path_join(own_path, "afterglow", bench->program);
}

static bool make_folder(const char *path)
{
    if (mkdir(path, 0777) != 0 && errno != EEXIST) {
        fprintf(stderr, "%s: error: %s\n", path, strerror(errno));
        return false;
    }
    return true;
}

/* An old table that is not carried on is kept beside the new one. */
static bool put_aside(const char *path)
{
    char old_path[PATH_SIZE];
    const int length = snprintf(old_path, sizeof old_path, "%s.old", path);
    if (length < 0 || (size_t)length >= sizeof old_path) {
        fprintf(stderr, "%s: error: the path is too long\n", path);
        return false;
    }
    if (rename(path, old_path) != 0 && errno != ENOENT) {
        fprintf(stderr, "%s: error: %s\n", path, strerror(errno));
        return false;
    }
    return true;
}

/* Names, folders, the lines measured before. */
static bool prepare(benchmark *bench)
{
    const forty_rooms_options *options = bench->options;
    if (!find_program(bench) || !path_join(options->folder, "results.csv", bench->csv_path) ||
        !path_join(options->folder, "runs.csv", bench->runs_path) ||
        !path_join(options->folder, "summary.md", bench->summary_path) ||
        !path_join(options->folder, "work", bench->work_folder) || !make_folder(options->folder)) {
        return false;
    }
    if (options->resume || options->summary_only) {
        return result_table_read(bench->csv_path, RESULT_MEDIANS, &bench->table) == AG_OK &&
               result_table_read(bench->runs_path, RESULT_RUNS, &bench->runs) == AG_OK;
    }
    return put_aside(bench->csv_path) && put_aside(bench->runs_path);
}

/* Lines of the table that tell of a failure; with --resume some are from an earlier run. */
static size_t count_failed_lines(const result_table *table)
{
    size_t count = 0;
    for (size_t i = 0; i < table->count; ++i) {
        const double *values = table->rows[i].values;
        count += values[RESULT_DUPLICATED] > 0.0 || values[RESULT_IDENTICAL] <= 0.0 ||
                 fabs(values[RESULT_COMPUTED] - values[RESULT_DISTINCT]) > 0.0;
    }
    return count;
}

int main(int argc, char **argv)
{
    forty_rooms_options options;
    const int usage = forty_rooms_parse_options(argc, argv, &options);
    if (usage != 0) {
        return usage < 0 ? EXIT_SUCCESS : usage;
    }

    static benchmark bench; /* static: zeroed, and its paths off the stack */
    bench.options = &options;
    if (!prepare(&bench)) {
        result_table_reset(&bench.table);
        result_table_reset(&bench.runs);
        return 1;
    }
    bool good = true;
    if (!options.summary_only) {
        good = make_folder(bench.work_folder) && room_layout_place(ROOM_SEED, bench.spheres) == AG_OK &&
               measure_rooms(&bench) == AG_OK;
    }
    if (bench.table.count > 0) {
        if (forty_rooms_summary_write(bench.summary_path, &bench.table, &bench.runs) == AG_OK) {
            printf("%s\n%s\n%s\n", bench.csv_path, bench.runs_path, bench.summary_path);
        } else {
            fprintf(stderr, "%s: error: it cannot be written\n", bench.summary_path);
            good = false;
        }
    } else if (good) {
        fprintf(stderr, "%s: error: it holds no measurement\n", bench.csv_path);
        good = false;
    }
    const size_t failed_lines = count_failed_lines(&bench.table);
    if (bench.failed_checks > 0 || failed_lines > 0) {
        fprintf(stderr, "afterglow-forty-rooms: error: %d checks failed; %zu of %zu lines tell of a failure\n",
                bench.failed_checks, failed_lines, bench.table.count);
        good = false;
    }
    result_table_reset(&bench.table);
    result_table_reset(&bench.runs);
    return good ? EXIT_SUCCESS : 1;
}
