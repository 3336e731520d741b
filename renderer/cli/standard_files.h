/* standard_files.h: standard input, output and error are there, also where the program was started without them.
 * Threads: main, before all else. */
#ifndef AFTERGLOW_STANDARD_FILES_H
#define AFTERGLOW_STANDARD_FILES_H

#include <stdbool.h>

/* Opens /dev/null on each of the three that is closed: no file opened later takes its number, so no message is written
 * into a picture or a photon map. It is opened for the wrong direction, so that reading standard input or writing a
 * picture to /dev/stdout stays an error. False, with errno: that is not possible. */
bool standard_files_fill(void);

#endif
