/* pilot_lists.h: what the eye's pilot finds: lists of its own for each row of its grid, put together in the rows'
 * order. Flow: eye_pilot -> [here] -> eye_pilot. Threads: a row belongs to one worker; rows are put together when none
 * is at work. */
#ifndef AFTERGLOW_PILOT_LISTS_H
#define AFTERGLOW_PILOT_LISTS_H

#include "afterglow/base.h"

#include <stdbool.h>
#include <stdint.h>

/* The lists, with the type of their items: the first five are the members of eye_pilot. */
typedef enum pilot_list {
    PILOT_GATHERED,  /* query_point */
    PILOT_ONWARD,    /* query_point */
    PILOT_SEEN,      /* query_point */
    PILOT_WAYS,      /* photon: an importon */
    PILOT_SEEN_WAYS, /* photon: an importon */
    PILOT_STARTS,    /* emission_trial: the start of a photon path */
    PILOT_LIT,       /* lit_point */
    PILOT_LIST_COUNT
} pilot_list;

typedef struct item_list {
    char *items; /* owned */
    uint32_t count, capacity;
    bool out_of_memory; /* an item did not find room */
} item_list;

/* Empty where all of it is 0. */
typedef struct pilot_row {
    item_list lists[PILOT_LIST_COUNT];
    uint32_t importons; /* that were traced */
    uint32_t escapes;   /* eye paths that meet nothing */
    uint32_t points;    /* that send gather rays */
    double enclosures;  /* sum over points of the squared share of their gather rays that meet something */
} pilot_row;

/* Copies an item of the list's type to the end of the list. Where there is no memory, pilot_rows_count tells. */
void pilot_row_add(pilot_row *row, pilot_list which, const void *item);

/* Gives the number of items of all rows. Errors: AG_ERROR_MEMORY, where one of them did not find room. */
ag_status pilot_rows_count(const pilot_row *rows, int row_count, pilot_list which, uint32_t *out_count);

/* Copies the items of all rows. out_items: [pilot_rows_count]. */
void pilot_rows_copy(const pilot_row *rows, int row_count, pilot_list which, void *out_items);

/* Makes one array of the items of all rows. *out_items: to be freed by the caller, NULL on failure. Errors:
 * AG_ERROR_MEMORY. */
ag_status pilot_rows_merge(const pilot_row *rows, int row_count, pilot_list which, void **out_items,
                           uint32_t *out_count);

/* Frees the rows and what they own; NULL is fine. */
void pilot_rows_destroy(pilot_row *rows, int row_count);

#endif
