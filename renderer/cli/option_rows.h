/* option_rows.h: the options of the program that are no settings of the renderer, one row each; and the list of both,
 * which the parser, --help and the man page go through. README.md tells how to add one.
 * Flow: options, option_help -> [here] -> afterglow.h's settings. Threads: rows are const. */
#ifndef AFTERGLOW_OPTION_ROWS_H
#define AFTERGLOW_OPTION_ROWS_H

#include "options.h"

typedef enum option_kind {
    OPTION_TAKEN, /* by a function */
    OPTION_FLAG,  /* bool in options */
    OPTION_TEXT   /* const char * in options, argv's */
} option_kind;

typedef struct option_row {
    ag_setting text;
    char letter; /* 0: none */
    option_kind kind;
    size_t offset;                               /* in options */
    bool (*take)(const char *value, options *o); /* false: the value is not valid */
} option_row;

typedef struct listed_option {
    const ag_setting *text;
    const option_row *row; /* NULL: a setting of the renderer */
} listed_option;

/* Finds every option, section by section; returns false where there are no more. */
bool option_at(size_t index, listed_option *out_option);

/* Puts an option's value into o; returns false where it is not valid. */
bool option_take(const listed_option *option, const char *value, options *o);

#endif
