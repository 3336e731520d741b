/* pilot_lists.c: see pilot_lists.h. */
#include "integrator/pilot_lists.h"

#include "integrator/eye_pilot.h"
#include "status.h"

#include <stdlib.h>
#include <string.h>

enum { FIRST_CAPACITY = 256 };

static const size_t ITEM_BYTES[PILOT_LIST_COUNT] = {
    [PILOT_GATHERED] = sizeof(query_point), [PILOT_ONWARD] = sizeof(query_point),
    [PILOT_SEEN] = sizeof(query_point),     [PILOT_WAYS] = sizeof(photon),
    [PILOT_SEEN_WAYS] = sizeof(photon),     [PILOT_STARTS] = sizeof(emission_trial),
    [PILOT_LIT] = sizeof(lit_point)};

void pilot_row_add(pilot_row *row, pilot_list which, const void *item)
{
    item_list *list = &row->lists[which];
    const size_t bytes = ITEM_BYTES[which];
    if (list->count == list->capacity) {
        uint32_t capacity = list->capacity ? 2 * list->capacity : FIRST_CAPACITY;
        char *larger = realloc(list->items, capacity * bytes);
        if (!larger) {
            list->out_of_memory = true;
            return;
        }
        list->items = larger;
        list->capacity = capacity;
    }
    memcpy(list->items + list->count++ * bytes, item, bytes);
}

ag_status pilot_rows_count(const pilot_row *rows, int row_count, pilot_list which, uint32_t *out_count)
{
    *out_count = 0;
    for (int i = 0; i < row_count; i++) {
        const item_list *list = &rows[i].lists[which];
        if (list->out_of_memory)
            return AG_ERROR_MEMORY;
        *out_count += list->count;
    }
    return AG_OK;
}

void pilot_rows_copy(const pilot_row *rows, int row_count, pilot_list which, void *out_items)
{
    char *at = out_items;
    for (int i = 0; i < row_count; i++) {
        const item_list *list = &rows[i].lists[which];
        const size_t bytes = list->count * ITEM_BYTES[which];
        if (bytes > 0)
            memcpy(at, list->items, bytes);
        at += bytes;
    }
}

ag_status pilot_rows_merge(const pilot_row *rows, int row_count, pilot_list which, void **out_items,
                           uint32_t *out_count)
{
    *out_items = NULL;
    AG_TRY(pilot_rows_count(rows, row_count, which, out_count));
    *out_items = malloc(((size_t)*out_count + 1) * ITEM_BYTES[which]);
    if (!*out_items)
        return AG_ERROR_MEMORY;
    pilot_rows_copy(rows, row_count, which, *out_items);
    return AG_OK;
}

void pilot_rows_destroy(pilot_row *rows, int row_count)
{
    for (int i = 0; rows && i < row_count; i++)
        for (int k = 0; k < PILOT_LIST_COUNT; k++)
            free(rows[i].lists[k].items);
    free(rows);
}
