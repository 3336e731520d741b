/* array_grow.h: arrays that grow item by item. Flow: [here] -> scene, texture_set. Threads: pure but for the array. */
#ifndef AFTERGLOW_ARRAY_GROW_H
#define AFTERGLOW_ARRAY_GROW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/* Makes room for one more item in an array from malloc that has doubled whenever its count reached a power of two; it
 * may move. Returns false, with the array as it was, when out of memory. */
static inline bool array_grow(void **items, uint32_t count, size_t item_bytes)
{
    if (count & (count - 1))
        return true;
    if (count > UINT32_MAX / 4)
        return false;
    size_t capacity = count ? 2 * (size_t)count : 1;
    void *larger = realloc(*items, capacity * item_bytes);
    if (!larger)
        return false;
    *items = larger;
    return true;
}

#endif
