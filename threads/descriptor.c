/* descriptor.c: see descriptor.h.
 * Threads: see descriptor.h. */
#define _POSIX_C_SOURCE 200809L
#include "descriptor.h"

#include <errno.h>
#include <fcntl.h>
#include <unistd.h>

enum { STANDARD_COUNT = 3 };

int descriptor_beyond_standard(int descriptor)
{
    if (descriptor < 0 || descriptor >= STANDARD_COUNT)
        return descriptor;
    int copy = fcntl(descriptor, F_DUPFD_CLOEXEC, STANDARD_COUNT);
    int error = errno;
    close(descriptor);
    errno = error;
    return copy;
}
