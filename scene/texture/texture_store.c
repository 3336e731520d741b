/* texture_store.c: see texture_store.h. Each tile belongs to one of some shards, by its number in the file: a lock, a
 * share of the limit and the tiles held. Which is dropped is found by going round (a clock: those that were asked for
 * since stay for another round). */
#define _GNU_SOURCE
#include "texture/texture_store.h"

#include "atomics.h"
#include "descriptor.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SHARDS = 64 };
enum { NO_MEMORY = 1, NO_FILE = 2 }; /* failures */

/* Read and changed under its shard's lock. */
typedef struct texture_tile {
    unsigned char *pixels; /* NULL: in the file alone */
    uint32_t size_bytes;
    bool was_asked;
} texture_tile;

typedef struct shard {
    _Alignas(64) pthread_mutex_t lock;
    texture_tile **held;
    uint32_t held_count, held_capacity, hand;
    uint64_t bytes, bytes_most, read_count;
} shard;

struct texture_store {
    shard shards[SHARDS];
    uint64_t limit_bytes, whole_bytes, file_bytes;
    int file;            /* -1: not made yet */
    atomic_u32 failures; /* relaxed: read behind a barrier of the pass */
};

texture_store *texture_store_create(uint64_t limit_bytes)
{
    texture_store *s = aligned_alloc(_Alignof(texture_store), sizeof *s);
    if (!s)
        return NULL;
    memset(s, 0, sizeof *s);
    s->limit_bytes = limit_bytes;
    s->file = -1;
    for (int i = 0; i < SHARDS; i++)
        pthread_mutex_init(&s->shards[i].lock, NULL);
    return s;
}

void texture_store_destroy(texture_store *s)
{
    if (!s)
        return;
    for (int i = 0; i < SHARDS; i++) {
        free(s->shards[i].held);
        pthread_mutex_destroy(&s->shards[i].lock);
    }
    if (s->file >= 0)
        close(s->file);
    free(s);
}

bool texture_store_keeps(texture_store *s, uint64_t picture_bytes)
{
    if (s->whole_bytes + picture_bytes > s->limit_bytes / 2)
        return false;
    s->whole_bytes += picture_bytes;
    return true;
}

/* --- writing --- */

/* Without a name, so that nothing is left behind however the process ends. */
static int open_temporary(void)
{
    const char *folder = getenv("TMPDIR");
    char path[4096];
    if (!folder || !*folder)
        folder = "/tmp";
    int file = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (file < 0) {
        if (snprintf(path, sizeof path, "%s/afterglow-textures-XXXXXX", folder) >= (int)sizeof path) {
            errno = ENAMETOOLONG;
            return -1;
        }
        file = mkostemp(path, O_CLOEXEC);
        if (file >= 0)
            unlink(path);
    }
    return descriptor_beyond_standard(file); /* what a host prints must not reach the tiles */
}

static bool write_all(int file, const unsigned char *bytes, size_t size, uint64_t offset)
{
    while (size > 0) {
        ssize_t written = pwrite(file, bytes, size, (off_t)offset);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0) {
            errno = written == 0 ? ENOSPC : errno;
            return false;
        }
        bytes += written;
        size -= (size_t)written;
        offset += (uint64_t)written;
    }
    return true;
}

/* Tiles at the right and lower edges are whole, too; what is beyond the picture is zero. */
static bool write_tiles(const texture_tiles *t, const unsigned char *pixels, uint32_t height, unsigned char *row)
{
    const size_t tile_row = (size_t)TEXTURE_TILE_SIDE * t->pixel_bytes, tile_bytes = TEXTURE_TILE_SIDE * tile_row;
    const size_t row_bytes = tile_bytes * t->tiles_across;
    for (uint32_t y0 = 0; y0 < height; y0 += TEXTURE_TILE_SIDE) {
        memset(row, 0, row_bytes);
        for (uint32_t y = y0; y < height && y < y0 + TEXTURE_TILE_SIDE; y++)
            for (uint32_t tile = 0; tile < t->tiles_across; tile++) {
                const uint32_t x = tile * TEXTURE_TILE_SIDE, left = t->width - x;
                const uint32_t count = left < TEXTURE_TILE_SIDE ? left : TEXTURE_TILE_SIDE;
                memcpy(row + tile * tile_bytes + (y - y0) * tile_row,
                       pixels + ((size_t)y * t->width + x) * t->pixel_bytes, (size_t)count * t->pixel_bytes);
            }
        if (!write_all(t->store->file, row, row_bytes, t->file_offset + (y0 / TEXTURE_TILE_SIDE) * (uint64_t)row_bytes))
            return false;
    }
    return true;
}

ag_status texture_store_put(texture_store *s, const void *pixels, uint32_t width, uint32_t height, uint32_t pixel_bytes,
                            texture_tiles **out_tiles, char *message, size_t message_size)
{
    const uint32_t across = (width + TEXTURE_TILE_SIDE - 1) / TEXTURE_TILE_SIDE,
                   down = (height + TEXTURE_TILE_SIDE - 1) / TEXTURE_TILE_SIDE;
    const size_t tile_bytes = (size_t)TEXTURE_TILE_SIDE * TEXTURE_TILE_SIDE * pixel_bytes;
    texture_tiles *t = calloc(1, sizeof *t);
    unsigned char *row = malloc(tile_bytes * across);
    ag_status status = t && row ? AG_OK : AG_ERROR_MEMORY;
    if (status == AG_OK) {
        *t = (texture_tiles){s, width, across, pixel_bytes, s->file_bytes, NULL, (size_t)across * down};
        t->entries = calloc(t->entry_count, sizeof *t->entries);
        if (!t->entries)
            status = AG_ERROR_MEMORY;
    }
    if (status == AG_OK && s->file < 0)
        s->file = open_temporary();
    if (status == AG_OK && (s->file < 0 || !write_tiles(t, pixels, height, row))) {
        snprintf(message, message_size,
                 "no room for textures beyond --texture-memory in a temporary file ($TMPDIR): %s", strerror(errno));
        status = AG_ERROR_SYSTEM;
    }
    free(row);
    if (status != AG_OK) {
        texture_tiles_destroy(t);
        return status;
    }
    s->file_bytes += (uint64_t)tile_bytes * across * down;
    *out_tiles = t;
    return AG_OK;
}

void texture_tiles_destroy(texture_tiles *t)
{
    if (!t)
        return;
    for (int i = 0; i < SHARDS && t->entries; i++) {
        shard *of = &t->store->shards[i];
        uint32_t kept = 0;
        for (uint32_t k = 0; k < of->held_count; k++) {
            const uintptr_t at = (uintptr_t)of->held[k], first = (uintptr_t)t->entries;
            if (at >= first && at < first + t->entry_count * sizeof *t->entries) {
                of->bytes -= of->held[k]->size_bytes;
                free(of->held[k]->pixels);
            } else {
                of->held[kept++] = of->held[k];
            }
        }
        of->held_count = kept;
    }
    free(t->entries);
    free(t);
}

/* --- reading --- */

static bool read_all(int file, unsigned char *bytes, size_t size, uint64_t offset)
{
    while (size > 0) {
        ssize_t got = pread(file, bytes, size, (off_t)offset);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        bytes += got;
        size -= (size_t)got;
        offset += (uint64_t)got;
    }
    return true;
}

/* Drops one tile; there is one. */
static void drop_one(shard *of)
{
    for (;;) {
        of->hand = of->hand < of->held_count ? of->hand : 0;
        texture_tile *tile = of->held[of->hand];
        if (!tile->was_asked) {
            free(tile->pixels);
            tile->pixels = NULL;
            of->bytes -= tile->size_bytes;
            of->held[of->hand] = of->held[--of->held_count];
            return;
        }
        tile->was_asked = false;
        of->hand++;
    }
}

/* A shard holds one tile at least. Errors: AG_ERROR_MEMORY, AG_ERROR_SYSTEM (the file cannot be read). */
static ag_status bring_in(texture_store *s, shard *of, texture_tile *tile, uint32_t size_bytes, uint64_t offset)
{
    const uint64_t room = (s->limit_bytes - s->whole_bytes) / SHARDS;
    while (of->held_count > 0 && of->bytes + size_bytes > room)
        drop_one(of);
    if (of->held_count == of->held_capacity) {
        const uint32_t capacity = of->held_capacity ? 2 * of->held_capacity : 64;
        texture_tile **larger = realloc(of->held, capacity * sizeof *larger);
        if (!larger)
            return AG_ERROR_MEMORY;
        of->held = larger;
        of->held_capacity = capacity;
    }
    unsigned char *pixels = malloc(size_bytes);
    if (!pixels)
        return AG_ERROR_MEMORY;
    if (!read_all(s->file, pixels, size_bytes, offset)) {
        free(pixels);
        return AG_ERROR_SYSTEM;
    }
    *tile = (texture_tile){pixels, size_bytes, false};
    of->held[of->held_count++] = tile;
    of->bytes += size_bytes;
    of->bytes_most = of->bytes > of->bytes_most ? of->bytes : of->bytes_most;
    of->read_count++;
    return AG_OK;
}

void texture_tiles_read(const texture_tiles *t, const pixel_blend *blend, unsigned char *out_pixels)
{
    texture_store *s = t->store;
    const uint32_t size_bytes = TEXTURE_TILE_SIDE * TEXTURE_TILE_SIDE * t->pixel_bytes;
    for (int k = 0; k < blend->count;) {
        const size_t x = blend->pixel[k] % t->width, y = blend->pixel[k] / t->width;
        const size_t number = y / TEXTURE_TILE_SIDE * t->tiles_across + x / TEXTURE_TILE_SIDE;
        const uint64_t offset = t->file_offset + (uint64_t)number * size_bytes;
        texture_tile *tile = &t->entries[number];
        shard *of = &s->shards[(offset / size_bytes * UINT64_C(0x9e3779b97f4a7c15)) >> 58];
        pthread_mutex_lock(&of->lock);
        const ag_status status = tile->pixels ? AG_OK : bring_in(s, of, tile, size_bytes, offset);
        /* what follows in the same tile at once */
        for (bool is_same = true; is_same;) {
            const size_t px = blend->pixel[k] % t->width % TEXTURE_TILE_SIDE,
                         py = blend->pixel[k] / t->width % TEXTURE_TILE_SIDE;
            if (status == AG_OK)
                memcpy(out_pixels + (size_t)k * t->pixel_bytes,
                       tile->pixels + (py * TEXTURE_TILE_SIDE + px) * t->pixel_bytes, t->pixel_bytes);
            else
                memset(out_pixels + (size_t)k * t->pixel_bytes, 0, t->pixel_bytes);
            k++;
            is_same = k < blend->count && blend->pixel[k] / t->width / TEXTURE_TILE_SIDE * t->tiles_across +
                                                  blend->pixel[k] % t->width / TEXTURE_TILE_SIDE ==
                                              number;
        }
        tile->was_asked = true;
        pthread_mutex_unlock(&of->lock);
        if (status != AG_OK)
            fetch_or_relaxed_u32(&s->failures, status == AG_ERROR_MEMORY ? NO_MEMORY : NO_FILE);
    }
}

texture_store_counts texture_store_count(const texture_store *s)
{
    texture_store_counts c = {0};
    if (!s)
        return c;
    c.whole_bytes = s->whole_bytes;
    c.file_bytes = s->file_bytes;
    for (int i = 0; i < SHARDS; i++) {
        c.tile_bytes_most += s->shards[i].bytes_most;
        c.tiles_read += s->shards[i].read_count;
    }
    return c;
}

ag_status texture_store_state(const texture_store *s)
{
    const uint32_t failures = s ? load_relaxed_u32(&s->failures) : 0;
    return failures & NO_FILE ? AG_ERROR_SYSTEM : failures & NO_MEMORY ? AG_ERROR_MEMORY : AG_OK;
}
