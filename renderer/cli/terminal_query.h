/* terminal_query.h: what a terminal can show, as it says itself when it is asked (DEC's device attributes, xterm's
 * graphics attributes and cell size). Flow: the terminal's answers -> [here] -> progress. Threads: main's, while there
 * is no other. */
#ifndef AFTERGLOW_TERMINAL_QUERY_H
#define AFTERGLOW_TERMINAL_QUERY_H

#include <stdbool.h>

typedef struct terminal_abilities {
    bool has_sixels;
    int cell_width, cell_height; /* of a character, pixels; 0: not told */
    int color_count;             /* that one picture may have by sixels */
} terminal_abilities;

enum { TERMINAL_LEAST_COLORS = 2, TERMINAL_MOST_COLORS = 256 };

/* Asks the controlling terminal, where descriptor is that one and this process is in its foreground; waits for a second
 * at the most, until it reads the question and answers. In that time keys are not shown and signals wait; the
 * terminal's modes are then as they were. Nothing is asked where keys have been pressed that nobody has read, which
 * would be lost. False: nothing is known. */
bool terminal_query(int descriptor, terminal_abilities *out);

/* To be called at the end: an answer that came too late is taken away, so that no shell reads it as a command. Nothing
 * where none is outstanding, or in the background. May be called by a signal's handler. */
void terminal_query_forget(void);

#endif
