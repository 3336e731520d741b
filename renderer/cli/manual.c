/* manual.c: a tool of the build: copies the text of the man page, and puts the options, as option_help makes them, in
 * a line "%OPTIONS%". Use: afterglow_manual TEXT OUT Threads: main alone. */
#define _POSIX_C_SOURCE 200809L
#include "option_help.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv)
{
    FILE *in = argc == 3 ? fopen(argv[1], "r") : NULL, *out = in ? fopen(argv[2], "w") : NULL;
    char *line = NULL;
    size_t capacity = 0;
    bool is_there = false;
    while (out && getline(&line, &capacity, in) >= 0) {
        if (strcmp(line, "%OPTIONS%\n") != 0) {
            fputs(line, out);
            continue;
        }
        option_help_print_manual(out);
        is_there = true;
    }
    free(line);
    if (in)
        fclose(in);
    bool is_written = out && !ferror(out);
    if (out && fclose(out) != 0)
        is_written = false;
    return is_there && is_written ? EXIT_SUCCESS : EXIT_FAILURE;
}
