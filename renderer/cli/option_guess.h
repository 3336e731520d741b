/* option_guess.h: which option was meant by a name that is none: one that other renderers have, or a slip of the
 * fingers. Flow: options -> [here] -> option_rows. Threads: main's. */
#ifndef AFTERGLOW_OPTION_GUESS_H
#define AFTERGLOW_OPTION_GUESS_H

/* Returns the option that was probably meant, a string of the library's; NULL: none is near. name: without its hyphens,
 * and without what follows a '='. */
const char *option_guess(const char *name);

#endif
