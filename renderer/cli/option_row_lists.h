/* option_row_lists.h: the rows of the program's own options, a file for files and colours, one for what changes the
 * scene, one for the work; each has its rows and the functions that take their values. Flow: option_rows_output.c,
 * option_rows_scene.c, option_rows_work.c -> [here] -> option_rows.c. Threads: rows are const. */
#ifndef AFTERGLOW_OPTION_ROW_LISTS_H
#define AFTERGLOW_OPTION_ROW_LISTS_H

#include "option_rows.h"

#include <stddef.h>

typedef struct option_row_list {
    const option_row *rows;
    size_t count;
} option_row_list;

extern const option_row_list option_rows_output, option_rows_scene, option_rows_work;

/* A row's words: the values that it can take, and how many they are. */
#define WORDS(...)                                                                                                     \
    (const char *const[]){__VA_ARGS__}, (int)(sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *))

/* A row's kind and the field of options that it sets. */
#define FLAG(member) .kind = OPTION_FLAG, .offset = offsetof(options, member)
#define TEXT(member) .kind = OPTION_TEXT, .offset = offsetof(options, member)

#endif
