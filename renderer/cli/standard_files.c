/* standard_files.c: see standard_files.h.
 * Threads: see standard_files.h. */
#define _POSIX_C_SOURCE 200809L
#include "standard_files.h"

#include <errno.h>
#include <fcntl.h>
#include <unistd.h>

bool standard_files_fill(void)
{
    for (int number = STDIN_FILENO; number <= STDERR_FILENO; number++) {
        if (fcntl(number, F_GETFD) >= 0 || errno != EBADF)
            continue;
        /* open takes the lowest number that is free, which is this one; children inherit it */
        if (open("/dev/null", (number == STDIN_FILENO ? O_WRONLY : O_RDONLY) | O_NOCTTY) != number)
            return false;
    }
    return true;
}
