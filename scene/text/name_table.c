/* name_table.c: see name_table.h. Open addressing with linear probing over the FNV-1a hash (Fowler, Noll, Vo).
 * Threads: one at a time. */
#define _POSIX_C_SOURCE 200809L
#include "text/name_table.h"

#include "name_hash.h"

#include <stdlib.h>
#include <string.h>

/* The slot that holds the name, or the free one where it belongs. */
static name_entry *find_slot(name_entry *slots, size_t capacity, const char *name)
{
    size_t i = (size_t)name_hash(name) & (capacity - 1);
    while (slots[i].name && strcmp(slots[i].name, name) != 0)
        i = (i + 1) & (capacity - 1);
    return &slots[i];
}

void name_table_reset(name_table *table)
{
    for (size_t i = 0; i < table->capacity; i++)
        free(table->slots[i].name);
    free(table->slots);
    memset(table, 0, sizeof *table);
}

bool name_table_find(const name_table *table, const char *name, uint32_t *out_value)
{
    if (table->capacity == 0)
        return false;
    const name_entry *slot = find_slot(table->slots, table->capacity, name);
    if (!slot->name)
        return false;
    *out_value = slot->value;
    return true;
}

static ag_status grow(name_table *table)
{
    size_t capacity = table->capacity ? 2 * table->capacity : 16;
    name_entry *slots = calloc(capacity, sizeof *slots);
    if (!slots)
        return AG_ERROR_MEMORY;
    for (size_t i = 0; i < table->capacity; i++)
        if (table->slots[i].name)
            *find_slot(slots, capacity, table->slots[i].name) = table->slots[i];
    free(table->slots);
    table->slots = slots;
    table->capacity = capacity;
    return AG_OK;
}

ag_status name_table_set(name_table *table, const char *name, uint32_t value)
{
    if (2 * (table->count + 1) > table->capacity && grow(table))
        return AG_ERROR_MEMORY;
    name_entry *slot = find_slot(table->slots, table->capacity, name);
    if (!slot->name) {
        slot->name = strdup(name);
        if (!slot->name)
            return AG_ERROR_MEMORY;
        table->count++;
    }
    slot->value = value;
    return AG_OK;
}
