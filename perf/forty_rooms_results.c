/* forty_rooms_results.c: the table of measurements, and its CSV form, written and read back.
 * The heading must match to the letter, so that lines of different makes never mix in one file.
 * Flow: forty_rooms -> [here] -> forty_rooms_summary. Threads: one caller at a time. */
#include "forty_rooms_results.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const char heading[] = "room,gather,mode"
#define RESULT_COLUMN_HEADING(name, text, format) "," text
    RESULT_COLUMN_LIST(RESULT_COLUMN_HEADING);
#undef RESULT_COLUMN_HEADING

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

const result_row *result_table_find(const result_table *table, int room, int gather, cache_mode mode)
{
    for (size_t i = 0; i < table->count; ++i) {
        const result_row *row = &table->rows[i];
        if (row->room == room && row->gather == gather && row->mode == mode) {
            return row;
        }
    }
    return NULL;
}

void result_print_heading(FILE *file) { fprintf(file, "%s\n", heading); }

void result_print_row(FILE *file, const result_row *row)
{
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

static bool parse_row(char *line, result_row *out_row)
{
    double room = 0.0, gather = 0.0;
    if (!parse_double(next_field(&line), &room) || !parse_double(next_field(&line), &gather) ||
        !(room >= 1.0 && room <= 1e6 && gather >= 1.0 && gather <= 1e6) ||
        !parse_mode(next_field(&line), &out_row->mode)) {
        return false;
    }
    out_row->room = (int)room;
    out_row->gather = (int)gather;
    for (int column = 0; column < RESULT_COLUMN_COUNT; ++column) {
        if (!parse_double(next_field(&line), &out_row->values[column])) {
            return false;
        }
    }
    return line == NULL;
}

ag_status result_table_read(const char *path, result_table *table)
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
        if (number == 1 ? strcmp(line, heading) != 0 : !parse_row(line, &row)) {
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
