/* texture_store_read.c: see texture_store.h. Each tile belongs to one of some shards, by its number: a lock, a share of
 * the limit and the tiles held. Which is dropped is found by going round (a clock: those that were asked for since stay
 * for another round). */
#include "texture/texture_store_private.h"

#include "texture/texture_tile_file.h"

#include <stdlib.h>
#include <string.h>

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

/* Errors: as texture_store_state. */
static ag_status read_packed(const texture_tiles *t, const texture_tile *tile, unsigned char *out_pixels)
{
    const size_t scratch_bytes = tile_scratch_bytes(format_of(t));
    unsigned char *memory = malloc(scratch_bytes + tile_bytes_of(t));
    if (!memory)
        return AG_ERROR_MEMORY;
    unsigned char *packed = memory + scratch_bytes;
    ag_status status = AG_ERROR_SYSTEM;
    if (tile_file_read(t->file->descriptor, packed, tile->file_bytes, tile->file_offset) &&
        (!t->file->is_checked || tile_check(packed, tile->file_bytes) == tile->check))
        status = tile_unpack(format_of(t), packed, tile->file_bytes, (uint32_t *)(void *)memory, out_pixels);
    if (status == AG_ERROR_SYSTEM)
        store_relaxed_u32(&t->file->is_damaged, 1);
    free(memory);
    return status;
}

static ag_status read_tile(const texture_tiles *t, size_t number, unsigned char *out_pixels)
{
    if (!t->source.fetch)
        return read_packed(t, &t->entries[number], out_pixels);
    return t->source.fetch(t->source.user, t->source.level, (uint32_t)(number % t->tiles_across) << t->tile_width_bits,
                           (uint32_t)(number / t->tiles_across) << t->tile_height_bits, out_pixels);
}

/* A shard holds one tile at least. Errors: as texture_store_state. */
static ag_status bring_in(const texture_tiles *t, shard *of, size_t number)
{
    const texture_store *s = t->store;
    const uint64_t room = (s->limit_bytes - s->whole_bytes) / SHARDS;
    const size_t size_bytes = tile_bytes_of(t);
    texture_tile *tile = &t->entries[number];
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
    const ag_status status = pixels ? read_tile(t, number, pixels) : AG_ERROR_MEMORY;
    if (status != AG_OK) {
        free(pixels);
        return status;
    }
    tile->pixels = pixels;
    tile->size_bytes = (uint32_t)size_bytes;
    tile->was_asked = false;
    of->held[of->held_count++] = tile;
    of->bytes += size_bytes;
    of->bytes_most = of->bytes > of->bytes_most ? of->bytes : of->bytes_most;
    of->read_count++;
    return AG_OK;
}

typedef struct tile_pixel {
    size_t number; /* of the tile */
    size_t pixel;  /* within it */
} tile_pixel;

static tile_pixel tile_pixel_of(const texture_tiles *t, size_t pixel)
{
    const size_t x = pixel % t->width, y = pixel / t->width;
    const size_t in_x = x & (((size_t)1 << t->tile_width_bits) - 1),
                 in_y = y & (((size_t)1 << t->tile_height_bits) - 1);
    return (tile_pixel){(y >> t->tile_height_bits) * t->tiles_across + (x >> t->tile_width_bits),
                        (in_y << t->tile_width_bits) + in_x};
}

static void note_failure(texture_store *s, const texture_tiles *t, ag_status status)
{
    if (status == AG_ERROR_MEMORY || !t->source.fetch) /* what else is wrong, the source knows */
        fetch_or_relaxed_u32(&s->failures, status == AG_ERROR_MEMORY ? NO_MEMORY : NO_TEMPORARY);
}

void texture_tiles_read(const texture_tiles *t, const pixel_blend *blend, unsigned char *out_pixels)
{
    texture_store *s = t->store;
    const size_t pixel_bytes = pixel_bytes_of(t);
    for (int k = 0; k < blend->count;) {
        tile_pixel at = tile_pixel_of(t, blend->pixel[k]);
        const size_t number = at.number;
        texture_tile *tile = &t->entries[number];
        shard *of = &s->shards[((t->first_number + number) * UINT64_C(0x9e3779b97f4a7c15)) >> (64 - SHARD_BITS)];
        pthread_mutex_lock(&of->lock);
        const ag_status status = tile->pixels ? AG_OK : bring_in(t, of, number);
        do { /* what follows in the same tile at once */
            unsigned char *out = out_pixels + (size_t)k * pixel_bytes;
            if (status == AG_OK)
                memcpy(out, tile->pixels + at.pixel * pixel_bytes, pixel_bytes);
            else
                memset(out, 0, pixel_bytes);
            if (++k < blend->count)
                at = tile_pixel_of(t, blend->pixel[k]);
        } while (k < blend->count && at.number == number);
        tile->was_asked = true;
        pthread_mutex_unlock(&of->lock);
        if (status != AG_OK)
            note_failure(s, t, status);
    }
}
