/* tile_scheduler.c: see tile_scheduler.h. The order is laid out beforehand; claiming is one atomic addition.
 * Rests on: Hilbert, "Ueber die stetige Abbildung einer Linie auf ein Flaechenstueck", 1891; for rectangles of any size
 * the way of J. Cerveny's "gilbert" (github.com/jakubcerveny/gilbert, 2019).
 * Threads: created and destroyed by one; the tiles are read-only after that. */
#include "tile_scheduler.h"

#include "atomics.h"

#include <stdlib.h>

enum {
    SMALLEST_EDGE = 4, /* pixels; below that, claiming and cold caches cost more than an idle moment */
    /* Cells at the end of the curve, for each worker. A worker that claims last is then busy for a sixteenth of a
     * full tile, and a tile up to that many times dearer than its neighbours does not show. */
    SIXTEENTHS_PER_WORKER = 2,
    QUARTERS_PER_WORKER = 2,
};

struct tile_scheduler {
    tile *tiles;
    uint32_t count;
    atomic_u64 next; /* pairs with itself: each addition claims another tile. The tiles never change, so relaxed. */
};

typedef struct cell {
    int x, y;
} cell;

typedef struct layout {
    tile_scheduler *scheduler;
    int x0, y0, x1, y1, tile_size;
    uint64_t cells_left;                         /* not yet visited */
    uint64_t quartered_below, sixteenthed_below; /* of cells_left */
} layout;

/* Adds the square with this corner, relative to the bounds, cut to them, in 4^levels parts. */
static void add_square(layout *l, int64_t x, int64_t y, int64_t edge, int levels)
{
    int64_t width = (int64_t)l->x1 - l->x0, height = (int64_t)l->y1 - l->y0;
    if (x >= width || y >= height)
        return;
    if (levels > 0 && edge / 2 >= SMALLEST_EDGE) {
        int64_t half = edge / 2; /* parts in a U, so that each touches the one before */
        add_square(l, x, y, half, levels - 1);
        add_square(l, x, y + half, half, levels - 1);
        add_square(l, x + half, y + half, half, levels - 1);
        add_square(l, x + half, y, half, levels - 1);
        return;
    }
    tile_scheduler *s = l->scheduler;
    s->tiles[s->count] = (tile){.x0 = (int)(l->x0 + x),
                                .y0 = (int)(l->y0 + y),
                                .x1 = x + edge < width ? (int)(l->x0 + x + edge) : l->x1,
                                .y1 = y + edge < height ? (int)(l->y0 + y + edge) : l->y1,
                                .index = s->count};
    s->count++;
}

static void visit(layout *l, cell c)
{
    int levels = l->cells_left <= l->sixteenthed_below ? 2 : l->cells_left <= l->quartered_below ? 1 : 0;
    add_square(l, (int64_t)c.x * l->tile_size, (int64_t)c.y * l->tile_size, l->tile_size, levels);
    l->cells_left--;
}

static cell moved(cell from, cell direction, int steps)
{
    return (cell){from.x + steps * direction.x, from.y + steps * direction.y};
}

static cell reversed(cell direction) { return (cell){-direction.x, -direction.y}; }

/* Takes an even half where there is a choice: only then do the parts join without a diagonal step. */
static int even_half(int length)
{
    int half = length / 2;
    return half % 2 != 0 && length > 2 ? half + 1 : half;
}

/* Visits the rectangle of length x width cells that `first` is a corner of: in at `first`, out at the other end of the
 * side that goes `along`. Directions are unit steps. */
static void walk(layout *l, cell first, cell along, int length, cell across, int width)
{
    if (width == 1 || length == 1) {
        for (int i = 0; i < length * width; i++)
            visit(l, moved(first, width == 1 ? along : across, i));
    } else if (2 * (int64_t)length > 3 * (int64_t)width) {
        int half = even_half(length);
        walk(l, first, along, half, across, width);
        walk(l, moved(first, along, half), along, length - half, across, width);
    } else {
        /* Up on the near side, over the far half, and down again. */
        int near = even_half(width), half = length / 2;
        walk(l, first, across, near, along, half);
        walk(l, moved(first, across, near), along, length, across, width - near);
        cell last = moved(moved(first, along, length - 1), across, near - 1);
        walk(l, last, reversed(across), near, reversed(along), length - half);
    }
}

ag_status tile_scheduler_create(int x0, int y0, int x1, int y1, int tile_size, unsigned worker_count,
                                tile_scheduler **out_scheduler)
{
    *out_scheduler = NULL;
    if (x0 >= x1 || y0 >= y1 || tile_size < 8 || tile_size > 256 || (tile_size & (tile_size - 1)) != 0)
        return AG_ERROR_ARGUMENT;
    int columns = (int)(((int64_t)x1 - x0 + tile_size - 1) / tile_size);
    int rows = (int)(((int64_t)y1 - y0 + tile_size - 1) / tile_size);
    uint64_t cell_count = (uint64_t)columns * (uint64_t)rows;
    uint64_t sixteenthed = (uint64_t)SIXTEENTHS_PER_WORKER * worker_count;
    uint64_t quartered = sixteenthed + (uint64_t)QUARTERS_PER_WORKER * worker_count;
    uint64_t most_tiles = cell_count + 3 * (quartered < cell_count ? quartered : cell_count) +
                          12 * (sixteenthed < cell_count ? sixteenthed : cell_count);
    if (most_tiles > UINT32_MAX)
        return AG_ERROR_MEMORY; /* some eighty gigabytes of tiles */

    tile_scheduler *s = calloc(1, sizeof *s);
    if (!s)
        return AG_ERROR_MEMORY;
    s->tiles = malloc((size_t)most_tiles * sizeof *s->tiles);
    if (!s->tiles) {
        free(s);
        return AG_ERROR_MEMORY;
    }
    layout l = {.scheduler = s,
                .x0 = x0,
                .y0 = y0,
                .x1 = x1,
                .y1 = y1,
                .tile_size = tile_size,
                .cells_left = cell_count,
                .quartered_below = quartered,
                .sixteenthed_below = sixteenthed};
    cell right = {1, 0}, down = {0, 1}, origin = {0, 0};
    if (columns >= rows)
        walk(&l, origin, right, columns, down, rows);
    else
        walk(&l, origin, down, rows, right, columns);
    uint64_t left = 0;
    for (uint32_t i = s->count; i-- > 0;) {
        tile *t = &s->tiles[i];
        t->left = left;
        left += (uint64_t)(t->x1 - t->x0) * (uint64_t)(t->y1 - t->y0);
    }
    *out_scheduler = s;
    return AG_OK;
}

void tile_scheduler_destroy(tile_scheduler *scheduler)
{
    if (!scheduler)
        return;
    free(scheduler->tiles);
    free(scheduler);
}

bool tile_scheduler_next(tile_scheduler *scheduler, tile *out_tile)
{
    uint64_t i = fetch_add_relaxed_u64(&scheduler->next, 1);
    if (i >= scheduler->count)
        return false;
    *out_tile = scheduler->tiles[i];
    return true;
}

uint32_t tile_scheduler_count(const tile_scheduler *scheduler) { return scheduler->count; }
