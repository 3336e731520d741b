/* shared_bytes.c: see shared_bytes.h. */
#include "shared_bytes.h"

#include <stdlib.h>

shared_bytes *shared_bytes_take(unsigned char *bytes, size_t size, unsigned *living)
{
    shared_bytes *shared = bytes ? malloc(sizeof *shared) : NULL;
    if (!shared) {
        free(bytes);
        return NULL;
    }
    *shared = (shared_bytes){.bytes = bytes, .size = size, .holders = 1, .living = living};
    if (living)
        ++*living;
    return shared;
}

shared_bytes *shared_bytes_hold(shared_bytes *shared)
{
    shared->holders++;
    return shared;
}

void shared_bytes_drop(shared_bytes *shared)
{
    if (!shared || --shared->holders > 0)
        return;
    if (shared->living)
        --*shared->living;
    free(shared->bytes);
    free(shared);
}
