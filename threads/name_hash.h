/* name_hash.h: a 64-bit hash of a name: FNV-1a (Fowler, Noll, Vo), of the bytes before the NUL.
 * Threads: pure functions. */
#ifndef AFTERGLOW_NAME_HASH_H
#define AFTERGLOW_NAME_HASH_H

#include <stdint.h>

static inline uint64_t name_hash(const char *name)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (; *name; name++)
        hash = (hash ^ (unsigned char)*name) * 0x100000001b3u;
    return hash;
}

#endif
