/* texture_store.c: see texture_store.h. Putting tiles there; texture_store_read.c reads them. */
#include "texture/texture_store_private.h"

#include "parallel_for.h"
#include "status.h"
#include "texture/texture_tile_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

texture_store *texture_store_create(uint64_t limit_bytes)
{
    texture_store *s = aligned_alloc(_Alignof(texture_store), sizeof *s);
    if (!s)
        return NULL;
    memset(s, 0, sizeof *s);
    s->limit_bytes = limit_bytes;
    s->temporary.descriptor = -1;
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
    if (s->temporary.descriptor >= 0)
        close(s->temporary.descriptor);
    free(s);
}

bool texture_store_has_room(const texture_store *s, uint64_t picture_bytes)
{
    return s->whole_bytes + picture_bytes <= s->limit_bytes / 2;
}

bool texture_store_keeps(texture_store *s, uint64_t picture_bytes)
{
    if (!texture_store_has_room(s, picture_bytes))
        return false;
    s->whole_bytes += picture_bytes;
    return true;
}

ag_status texture_store_lend(texture_store *s, texture_tile_source source, texture_layout layout,
                             texture_tiles **out_tiles)
{
    const uint32_t across = ((layout.width - 1) >> source.tile_width_bits) + 1,
                   down = ((layout.height - 1) >> source.tile_height_bits) + 1;
    texture_tiles *t = calloc(1, sizeof *t);
    if (!t)
        return AG_ERROR_MEMORY;
    *t = (texture_tiles){.store = s,
                         .width = layout.width,
                         .tiles_across = across,
                         .tile_width_bits = source.tile_width_bits,
                         .tile_height_bits = source.tile_height_bits,
                         .channel_count = layout.channel_count,
                         .value_bytes = layout.value_bytes,
                         .source = source,
                         .first_number = s->tile_count,
                         .entry_count = (size_t)across * down};
    t->entries = calloc(t->entry_count, sizeof *t->entries);
    if (!t->entries) {
        free(t);
        return AG_ERROR_MEMORY;
    }
    s->tile_count += t->entry_count;
    *out_tiles = t;
    return AG_OK;
}

/* --- writing --- */

typedef struct put_job {
    texture_tiles *tiles;
    const unsigned char *pixels;
    uint32_t height;
    atomic_u32 failure; /* relaxed: an errno, or 0; read when all is done */
} put_job;

/* Tiles at the right and lower edges are whole, too; what is beyond the picture is zero. */
static void cut_tile(const put_job *job, size_t number, unsigned char *out)
{
    const texture_tiles *t = job->tiles;
    const uint32_t x0 = (uint32_t)(number % t->tiles_across) << t->tile_width_bits,
                   y0 = (uint32_t)(number / t->tiles_across) << t->tile_height_bits;
    const uint32_t side = 1u << t->tile_width_bits, left = t->width - x0, count = left < side ? left : side;
    const size_t pixel_bytes = pixel_bytes_of(t), row_bytes = pixel_bytes << t->tile_width_bits;
    memset(out, 0, tile_bytes_of(t));
    for (uint32_t y = 0; y < 1u << t->tile_height_bits && y0 + y < job->height; y++)
        memcpy(out + y * row_bytes, job->pixels + ((size_t)(y0 + y) * t->width + x0) * pixel_bytes,
               count * pixel_bytes);
}

/* scratch: of tile_scratch_bytes; buffers: of two tiles. Gives an errno, or 0. */
static int put_tile(const put_job *job, size_t number, uint32_t *scratch, unsigned char *buffers)
{
    const texture_tiles *t = job->tiles;
    unsigned char *packed = buffers + tile_bytes_of(t);
    texture_tile *tile = &t->entries[number];
    cut_tile(job, number, buffers);
    const size_t packed_bytes = tile_pack(format_of(t), buffers, scratch, packed);
    tile->file_bytes = (uint32_t)packed_bytes;
    tile->file_offset = fetch_add_relaxed_u64(&t->file->size_bytes, packed_bytes);
    if (t->file->is_checked)
        tile->check = tile_check(packed, packed_bytes);
    return tile_file_write(t->file->descriptor, packed, packed_bytes, tile->file_offset) ? 0 : errno;
}

static void put_tiles(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)block, (void)worker;
    put_job *job = user;
    const size_t scratch_bytes = tile_scratch_bytes(format_of(job->tiles));
    unsigned char *memory = malloc(scratch_bytes + 2 * tile_bytes_of(job->tiles));
    int failure = memory ? 0 : ENOMEM;
    for (uint64_t number = begin; number < end && !failure; number++)
        failure = put_tile(job, (size_t)number, (uint32_t *)(void *)memory, memory + scratch_bytes);
    free(memory);
    if (failure)
        store_relaxed_u32(&job->failure, (uint32_t)failure);
}

static const texture_tile_source OWN = {.tile_width_bits = TEXTURE_TILE_BITS, .tile_height_bits = TEXTURE_TILE_BITS};

ag_status texture_store_put(texture_store *s, run_context *run, const void *pixels, texture_layout layout,
                            tile_file *into, texture_tiles **out_tiles, char *message, size_t message_size)
{
    enum { TILES_AT_ONCE = 32 };
    texture_tiles *t;
    ag_status status = texture_store_lend(s, OWN, layout, &t);
    if (status != AG_OK)
        return status;
    put_job job = {.tiles = t, .pixels = pixels, .height = layout.height};
    t->file = into ? into : &s->temporary;
    if (t->file->descriptor < 0) {
        t->file->descriptor = tile_file_open();
        store_relaxed_u32(&job.failure, t->file->descriptor < 0 ? (uint32_t)errno : 0);
    }
    if (t->file->descriptor >= 0 && run && run->pool)
        status = parallel_for(run, t->entry_count, TILES_AT_ONCE, put_tiles, &job, AG_PHASE_LOAD, 0.0, 0.0);
    else if (t->file->descriptor >= 0)
        put_tiles(&job, 0, t->entry_count, 0, 0);
    const int failure = (int)load_relaxed_u32(&job.failure);
    if (status == AG_OK && failure == ENOMEM)
        status = AG_ERROR_MEMORY;
    if (status == AG_OK && failure) {
        snprintf(message, message_size, "no room for textures beyond --texture-memory in %s: %s",
                 into ? "the folder of --texture-cache" : "a temporary file ($TMPDIR)", strerror(failure));
        status = AG_ERROR_SYSTEM;
    }
    if (status != AG_OK)
        texture_tiles_destroy(t);
    else
        *out_tiles = t;
    return status;
}

/* --- what lies in a file already --- */

size_t texture_layout_tile_count(texture_layout layout)
{
    return (size_t)(((layout.width - 1) >> TEXTURE_TILE_BITS) + 1) * (((layout.height - 1) >> TEXTURE_TILE_BITS) + 1);
}

size_t texture_layout_tile_bytes(texture_layout layout)
{
    return ((size_t)layout.channel_count * layout.value_bytes) << (2 * TEXTURE_TILE_BITS);
}

ag_status texture_store_take(texture_store *s, tile_file *from, texture_layout layout, const texture_tile_part *parts,
                             texture_tiles **out_tiles)
{
    AG_TRY(texture_store_lend(s, OWN, layout, out_tiles));
    texture_tiles *t = *out_tiles;
    t->file = from;
    for (size_t k = 0; k < t->entry_count; k++) {
        t->entries[k].file_offset = parts[k].offset;
        t->entries[k].file_bytes = parts[k].size_bytes;
        t->entries[k].check = parts[k].check;
    }
    return AG_OK;
}

void texture_tiles_parts(const texture_tiles *t, texture_tile_part *out_parts)
{
    for (size_t k = 0; k < t->entry_count; k++)
        out_parts[k] = (texture_tile_part){t->entries[k].file_offset, t->entries[k].file_bytes, t->entries[k].check};
}

void texture_tiles_destroy(texture_tiles *t)
{
    if (!t)
        return;
    for (int i = 0; i < SHARDS; i++) {
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

texture_store_counts texture_store_count(const texture_store *s)
{
    texture_store_counts c = {0};
    if (!s)
        return c;
    c.whole_bytes = s->whole_bytes;
    c.file_bytes = load_relaxed_u64(&s->temporary.size_bytes);
    for (int i = 0; i < SHARDS; i++) {
        c.tile_bytes_most += s->shards[i].bytes_most;
        c.tiles_read += s->shards[i].read_count;
    }
    return c;
}

ag_status texture_store_state(const texture_store *s)
{
    const uint32_t failures = s ? load_relaxed_u32(&s->failures) : 0;
    return failures & NO_TEMPORARY ? AG_ERROR_SYSTEM : failures & NO_MEMORY ? AG_ERROR_MEMORY : AG_OK;
}
