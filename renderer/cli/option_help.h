/* option_help.h: the program's options as text: for --help, and for the man page.
 * Flow: option_rows -> [here]. Threads: main's. */
#ifndef AFTERGLOW_OPTION_HELP_H
#define AFTERGLOW_OPTION_HELP_H

#include "afterglow/afterglow.h"

#include <stdio.h>

void option_help_print(FILE *out);

/* Prints an option as a line of --help. */
void option_help_print_line(FILE *out, const ag_setting *option);

/* The part OPTIONS of the man page, as roff. */
void option_help_print_manual(FILE *out);

#endif
