/* text_lines.h: a text file line by line, each as words, with the locations of both for messages.
 * A backslash at the end of a line goes on with the next one; # begins a comment.
 * Flow: text_file -> [here] -> obj_file, mtl_file. Threads: one at a time. */
#ifndef AFTERGLOW_TEXT_LINES_H
#define AFTERGLOW_TEXT_LINES_H

#include "text/file_location.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct text_lines {
    log_sink *log;
    const char *file;       /* borrowed; goes into every location */
    const char *text, *end; /* borrowed; *end is NUL */
    const char *at;         /* within the line, what is read next */
    const char *line_start, *line_end;
    int line, lines_in_line; /* number of the first; how many make up this one */
} text_lines;

typedef struct text_word {
    const char *text; /* not NUL-terminated */
    size_t length;
} text_word;

/* Borrows all; text has a NUL at text[size]. The first line is then got by text_lines_next. */
void text_lines_init(text_lines *lines, log_sink *log, const char *file, const char *text, size_t size);

/* On to the next line that has a word; false at the end. */
bool text_lines_next(text_lines *lines);

/* The line's next word; false at its end. */
bool text_lines_word(text_lines *lines, text_word *out_word);
/* The rest of the line, blanks at both ends cut off; its length may be 0. */
text_word text_lines_rest(text_lines *lines);

bool text_word_is(const text_word *word, const char *text); /* in any case */
/* The value of a word that is a finite number from end to end. */
bool text_word_number(const text_word *word, double *out_value);

/* The next word as a number. Errors: AG_ERROR_SCENE, with a message: what stands there is none, or nothing does. */
ag_status text_lines_number(text_lines *lines, const char *what, double *out_value);

file_location text_lines_where(const text_lines *lines, const char *at);
/* FILE:LINE:COLUMN: error: ... and the line with a mark. Gives AG_ERROR_SCENE. */
ag_status text_lines_refuse(const text_lines *lines, text_word word, const char *format, ...) AG_PRINTF(3, 4);

#endif
