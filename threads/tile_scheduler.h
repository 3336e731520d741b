/* tile_scheduler.h: the image in tiles, claimed atomically, neighbours one after the other.
 * Tiles lie along a Hilbert curve (Hilbert 1891) so that caches stay warm; the last ones are split so that no
 * thread is left alone with a large one.
 * Threads: created and destroyed by one; tile_scheduler_next from any. */
#ifndef AFTERGLOW_TILE_SCHEDULER_H
#define AFTERGLOW_TILE_SCHEDULER_H

#include "afterglow/base.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct tile {
    int x0, y0, x1, y1; /* pixels [x0, x1) x [y0, y1), in the coordinates of the bounds given */
    uint32_t index;     /*/* position in the order of claiming */
    uint64_t left;      /* pixels of the tiles behind it in that order */
} tile;

typedef struct tile_scheduler tile_scheduler;

/* Covers [x0, x1) x [y0, y1) (not empty) exactly once. tile_size: pixels along the edge of a full tile, a power of two
 * in [8, 256]. worker_count: only decides how many tiles at the end are split into quarters, and those again.
 * Errors: AG_ERROR_ARGUMENT, AG_ERROR_MEMORY. */
ag_status tile_scheduler_create(int x0, int y0, int x1, int y1, int tile_size, unsigned worker_count,
                                tile_scheduler **out_scheduler);
void tile_scheduler_destroy(tile_scheduler *scheduler); /* NULL is fine */

/* Claims the next tile; returns false when all are claimed. */
bool tile_scheduler_next(tile_scheduler *scheduler, tile *out_tile);

uint32_t tile_scheduler_count(const tile_scheduler *scheduler);

#endif
