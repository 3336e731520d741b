/* film_tiles.c: see film_tiles.h. */
#define _POSIX_C_SOURCE 200809L
#include "film/film_tiles.h"

#include "film/film_channels.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

struct film_tiles {
    pthread_mutex_t lock; /* of all below, and of the film's pixels while others may look */
    uint64_t version;     /* the latest */
    uint64_t *versions;   /* of each tile; 0: black, as in the beginning */
    size_t columns, count;
};

film_tiles *film_tiles_create(int width, int height)
{
    film_tiles *tiles = calloc(1, sizeof *tiles);
    if (!tiles)
        return NULL;
    tiles->columns = ((size_t)width + AG_TILE_SIZE - 1) / AG_TILE_SIZE;
    tiles->count = tiles->columns * (((size_t)height + AG_TILE_SIZE - 1) / AG_TILE_SIZE);
    tiles->versions = calloc(tiles->count + 1, sizeof *tiles->versions);
    if (tiles->versions && pthread_mutex_init(&tiles->lock, NULL) == 0)
        return tiles;
    free(tiles->versions);
    free(tiles);
    return NULL;
}

void film_tiles_destroy(film_tiles *tiles)
{
    if (!tiles)
        return;
    pthread_mutex_destroy(&tiles->lock);
    free(tiles->versions);
    free(tiles);
}

/* The tile's rectangle in pixels of the crop. */
static ag_tile tile_at(const ag_film *film, size_t index)
{
    const int x = (int)(index % film->tiles->columns) * AG_TILE_SIZE,
              y = (int)(index / film->tiles->columns) * AG_TILE_SIZE;
    const int width = film->width - x < AG_TILE_SIZE ? film->width - x : AG_TILE_SIZE,
              height = film->height - y < AG_TILE_SIZE ? film->height - y : AG_TILE_SIZE;
    return (ag_tile){.x = x, .y = y, .width = width, .height = height};
}

static float *row_of(const ag_film *film, int x, int y)
{
    return film->pixels + 3 * ((size_t)y * (size_t)film->width + (size_t)x);
}

/* Shows the part [x0, x1) x [y0, y1) of one tile. The part is developed without the lock. */
static void show_part(ag_film *film, size_t index, int x0, int y0, int x1, int y1)
{
    float developed[3 * AG_TILE_SIZE * AG_TILE_SIZE], *out = developed;
    const size_t row_bytes = 3 * (size_t)(x1 - x0) * sizeof *developed;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++, out += 3)
            film_develop(film, film_pixel_at(film, film->x0 + x, film->y0 + y), out);
    film_tiles *tiles = film->tiles;
    bool has_changed = false;
    pthread_mutex_lock(&tiles->lock);
    for (int y = y0; y < y1; y++) {
        const float *row = developed + 3 * (size_t)(y - y0) * (size_t)(x1 - x0);
        has_changed = has_changed || memcmp(row_of(film, x0, y), row, row_bytes) != 0;
        memcpy(row_of(film, x0, y), row, row_bytes);
    }
    if (has_changed)
        tiles->versions[index] = ++tiles->version;
    pthread_mutex_unlock(&tiles->lock);
}

void film_show(ag_film *film, film_area area)
{
    const int x0 = area.x0 > film->x0 ? area.x0 - film->x0 : 0, y0 = area.y0 > film->y0 ? area.y0 - film->y0 : 0;
    const int right = area.x0 + area.width - film->x0, bottom = area.y0 + area.height - film->y0;
    const int x1 = right < film->width ? right : film->width, y1 = bottom < film->height ? bottom : film->height;
    for (int y = y0; y < y1; y = (y / AG_TILE_SIZE + 1) * AG_TILE_SIZE)
        for (int x = x0; x < x1; x = (x / AG_TILE_SIZE + 1) * AG_TILE_SIZE) {
            const size_t index = (size_t)(y / AG_TILE_SIZE) * film->tiles->columns + (size_t)(x / AG_TILE_SIZE);
            const ag_tile tile = tile_at(film, index);
            show_part(film, index, x, y, tile.x + tile.width < x1 ? tile.x + tile.width : x1,
                      tile.y + tile.height < y1 ? tile.y + tile.height : y1);
        }
}

void film_tiles_begin_change(film_tiles *tiles) { pthread_mutex_lock(&tiles->lock); }

void film_tiles_end_change(film_tiles *tiles)
{
    tiles->version++;
    for (size_t i = 0; i < tiles->count; i++)
        tiles->versions[i] = tiles->version;
    pthread_mutex_unlock(&tiles->lock);
}

/* --- as the public interface shows it --- */

size_t ag_film_tile_count(const ag_film *film) { return film ? film->tiles->count : 0; }

/* Copies a tile that has changed since that version, to rows that are so many floats apart. */
static bool read_tile(const ag_film *film, size_t index, uint64_t since, ag_tile *out_tile, float *out, size_t stride)
{
    film_tiles *tiles = film->tiles;
    ag_tile tile = tile_at(film, index);
    pthread_mutex_lock(&tiles->lock);
    tile.version = tiles->versions[index];
    const bool has_changed = tile.version > since;
    for (int y = 0; has_changed && y < tile.height; y++)
        memcpy(out + (size_t)y * stride, row_of(film, tile.x, tile.y + y), 3 * (size_t)tile.width * sizeof *out);
    pthread_mutex_unlock(&tiles->lock);
    if (has_changed)
        *out_tile = tile;
    return has_changed;
}

bool ag_film_read_tile(const ag_film *film, size_t index, uint64_t since_version, ag_tile *out_tile, float *out_pixels)
{
    if (!film || index >= film->tiles->count || !out_tile || !out_pixels)
        return false;
    return read_tile(film, index, since_version, out_tile, out_pixels, 3 * (size_t)tile_at(film, index).width);
}

uint64_t ag_film_read_picture(const ag_film *film, uint64_t since_version, float *out_pixels)
{
    ag_tile tile;
    if (!film || !out_pixels)
        return since_version;
    pthread_mutex_lock(&film->tiles->lock);
    const uint64_t version = film->tiles->version;
    pthread_mutex_unlock(&film->tiles->lock);
    for (size_t i = 0; i < film->tiles->count; i++) {
        const ag_tile at = tile_at(film, i);
        read_tile(film, i, since_version, &tile, out_pixels + 3 * ((size_t)at.y * (size_t)film->width + (size_t)at.x),
                  3 * (size_t)film->width);
    }
    return version;
}
