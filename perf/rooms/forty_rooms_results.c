/* forty_rooms_results.c: the table of measurements, and its CSV form, written and read back.
 * The heading must match to the letter, so that lines of different makes never mix in one file.
 * Flow: forty_rooms -> [here] -> forty_rooms_summary. Threads: one caller at a time. */
#include "rooms/forty_rooms_results.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const char heading[] = "room,gather,mode"
#define RESULT_COLUMN_HEADING(name, text, format) "," text
    RESULT_COLUMN_LIST(RESULT_COLUMN_HEADING);
#undef RESULT_COLUMN_HEADING

static const char runs_heading[] = "repeat,turn,"; /* before the other in RESULT_RUNS */

static const char *const mode_texts[CACHE_MODE_COUNT] = {
#define CACHE_MODE_TEXT(name, text) text,
    CACHE_MODE_LIST(CACHE_MODE_TEXT)
#undef CACHE_MODE_TEXT
};

const char *cache_mode_text(cache_mode mode) { return mode_texts[mode]; }

ag_status result_table_add(result_table *table, const result_row *row)
{
    if (table->count == table->capacity) {
        const size_t capacity = table->capacity == 0 ? 64 : 2 * table->capacity;
        result_row *rows = realloc(table->rows, capacity * sizeof *rows);
        if (rows == NULL) {
            return AG_ERROR_MEMORY;
        }
        table->rows = rows;
        table->capacity = capacity;
    }
    table->rows[table->count++] = *row;
    return AG_OK;
}

void result_table_reset(result_table *table)
{
    free(table->rows);
    *table = (result_table){NULL, 0, 0};
}

const result_row *result_table_find(const result_table *table, int room, int gather, cache_mode mode, int repeat)
{
    for (size_t i = 0; i < table->count; ++i) {
        const result_row *row = &table->rows[i];
        if (row->room == room && row->gather == gather && row->mode == mode && row->repeat == repeat) {
            return row;
        }
    }
    return NULL;
}

int *result_table_gathers(const result_table *table, size_t *out_count)
{
    int *gathers = malloc((table->count + 1) * sizeof *gathers);
    size_t count = 0;
    for (size_t i = 0; gathers != NULL && i < table->count; ++i) {
        const int gather = table->rows[i].gather;
        size_t at = 0;
        while (at < count && gathers[at] < gather) {
            ++at;
        }
        if (at == count || gathers[at] != gather) {
            for (size_t j = count; j > at; --j) {
                gathers[j] = gathers[j - 1];
            }
            gathers[at] = gather;
            ++count;
        }
    }
    *out_count = count;
    return gathers;
}

int result_table_last_repeat(const result_table *runs, int room, int gather)
{
    int last = 0;
    for (size_t i = 0; i < runs->count; ++i) {
        const result_row *row = &runs->rows[i];
        if (row->room == room && row->gather == gather && row->repeat > last) {
            last = row->repeat;
        }
    }
    return last;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double result_median(double *values, size_t count)
{
    if (count == 0) {
        return NAN;
    }
    qsort(values, count, sizeof *values, compare_doubles);
    const size_t half = count / 2;
    return count % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double result_table_speed_up(const result_table *runs, int room, int gather, double *ratios)
{
    size_t count = 0;
    const int last = result_table_last_repeat(runs, room, gather);
    for (int repeat = 1; repeat <= last; ++repeat) {
        const result_row *on_demand = result_table_find(runs, room, gather, CACHE_ON_DEMAND, repeat);
        const result_row *precompute = result_table_find(runs, room, gather, CACHE_PRECOMPUTE, repeat);
        if (on_demand != NULL && precompute != NULL) {
            const double ratio = precompute->values[RESULT_CPU_S] / on_demand->values[RESULT_CPU_S];
            if (isfinite(ratio)) {
                ratios[count++] = ratio;
            }
        }
    }
    return result_median(ratios, count);
}

void result_print_heading(FILE *file, result_form form)
{
    fprintf(file, "%s%s\n", form == RESULT_RUNS ? runs_heading : "", heading);
}

void result_print_row(FILE *file, result_form form, const result_row *row)
{
    if (form == RESULT_RUNS) {
        fprintf(file, "%d,%d,", row->repeat, row->turn);
    }
    fprintf(file, "%d,%d,%s", row->room, row->gather, cache_mode_text(row->mode));
    /* Unrolled by the list, so that each format stands before the compiler as a literal. */
#define RESULT_COLUMN_PRINT(name, text, format)                                                                        \
    fputc(',', file);                                                                                                  \
    if (!isnan(row->values[name])) {                                                                                   \
        fprintf(file, format, row->values[name]);                                                                      \
    }
    RESULT_COLUMN_LIST(RESULT_COLUMN_PRINT)
#undef RESULT_COLUMN_PRINT
    fputc('\n', file);
}

/* Cuts the field up to the next comma out of *line, which moves on; NULL after the last. */
static char *next_field(char **line)
{
    char *field = *line;
    if (field == NULL) {
        return NULL;
    }
    char *comma = strchr(field, ',');
    if (comma != NULL) {
        *comma = '\0';
        *line = comma + 1;
    } else {
        *line = NULL;
    }
    return field;
}

static bool parse_double(const char *field, double *out_value)
{
    if (field == NULL) {
        return false;
    }
    if (*field == '\0') {
        *out_value = NAN;
        return true;
    }
    char *end = NULL;
    *out_value = strtod(field, &end);
    return *end == '\0';
}

static bool parse_mode(const char *field, cache_mode *out_mode)
{
    for (int mode = 0; field != NULL && mode < CACHE_MODE_COUNT; ++mode) {
        if (strcmp(field, mode_texts[mode]) == 0) {
            *out_mode = (cache_mode)mode;
            return true;
        }
    }
    return false;
}

static bool parse_count(const char *field, int *out_value)
{
    double value = 0.0;
    if (!parse_double(field, &value) || !(value >= 1.0 && value <= 1e6)) {
        return false;
    }
    *out_value = (int)value;
    return true;
}

static bool parse_row(char *line, result_form form, result_row *out_row)
{
    out_row->repeat = out_row->turn = 0;
    if (form == RESULT_RUNS &&
        (!parse_count(next_field(&line), &out_row->repeat) || !parse_count(next_field(&line), &out_row->turn))) {
        return false;
    }
    if (!parse_count(next_field(&line), &out_row->room) || !parse_count(next_field(&line), &out_row->gather) ||
        !parse_mode(next_field(&line), &out_row->mode)) {
        return false;
    }
    for (int column = 0; column < RESULT_COLUMN_COUNT; ++column) {
        if (!parse_double(next_field(&line), &out_row->values[column])) {
            return false;
        }
    }
    return line == NULL;
}

static bool is_heading(const char *line, result_form form)
{
    if (form == RESULT_RUNS) {
        const size_t length = sizeof runs_heading - 1;
        if (strncmp(line, runs_heading, length) != 0) {
            return false;
        }
        line += length;
    }
    return strcmp(line, heading) == 0;
}

ag_status result_table_read(const char *path, result_form form, result_table *table)
{
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        if (errno == ENOENT) {
            return AG_OK;
        }
        fprintf(stderr, "%s: error: %s\n", path, strerror(errno));
        return AG_ERROR_INPUT;
    }
    ag_status status = AG_OK;
    char line[2048];
    for (int number = 1; status == AG_OK && fgets(line, sizeof line, file) != NULL; ++number) {
        line[strcspn(line, "\n")] = '\0';
        result_row row;
        if (number == 1 ? !is_heading(line, form) : !parse_row(line, form, &row)) {
            fprintf(stderr, "%s:%d:1: error: %s\n", path, number,
                    number == 1 ? "this is not the heading that this program writes" : "a malformed line");
            status = AG_ERROR_INPUT;
        } else if (number > 1) {
            status = result_table_add(table, &row);
        }
    }
    if (status == AG_OK && ferror(file)) {
        fprintf(stderr, "%s: error: it cannot be read\n", path);
        status = AG_ERROR_INPUT;
    }
    fclose(file);
    return status;
}
