/* option_guess.h: which option was meant by a name that is none: one that other renderers have, or a slip of the
 * fingers. Flow: options -> [here] -> option_rows. Threads: main's. */
#ifndef AFTERGLOW_OPTION_GUESS_H
#define AFTERGLOW_OPTION_GUESS_H

/* name: without its hyphens, and without what follows a '='. NULL: nothing is near. The string is the library's. */
const char *option_guess(const char *name);

#endif
