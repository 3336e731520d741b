/* name_table.h: names to 32-bit values, for the named things of a scene file.
 * Flow: pbrt_parser's named materials and coordinate systems. Threads: one at a time. */
#ifndef AFTERGLOW_NAME_TABLE_H
#define AFTERGLOW_NAME_TABLE_H

#include "afterglow/base.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct name_entry {
    char *name; /* NULL where the slot is free */
    uint32_t value;
} name_entry;

/* Zeroed, it is an empty table. */
typedef struct name_table {
    name_entry *slots; /* capacity of them, a power of two, at most half full */
    size_t capacity, count;
} name_table;

void name_table_reset(name_table *table); /* frees what it holds; leaves it zeroed */

/* False where the name is not there. */
bool name_table_find(const name_table *table, const char *name, uint32_t *out_value);

/* Adds the name or gives it another value. Errors: AG_ERROR_MEMORY. */
ag_status name_table_set(name_table *table, const char *name, uint32_t value);

#endif
