/* borrowed_arrays.c: see borrowed_arrays.h. */
#define _DEFAULT_SOURCE
#include "shape/borrowed_arrays.h"

#include "math/rng.h"
#include "shape/mesh_motion.h"

#include <errno.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { ARRAYS_MOST = 3, END_BYTES = 64, PAGES_AT_ONCE = 4096 };

typedef struct array {
    const unsigned char *bytes;
    size_t size;
} array;

static int borrowed_of(const shape *s, array out[ARRAYS_MOST])
{
    const mesh *m = &s->as.mesh;
    int count = 0;
    if (s->kind != SHAPE_MESH)
        return 0;
    if (m->borrowed & MESH_BORROWS_POSITIONS)
        out[count++] = (array){(const unsigned char *)m->positions, mesh_value_count(m) * sizeof *m->positions};
    if (m->borrowed & MESH_BORROWS_UVS)
        out[count++] = (array){(const unsigned char *)m->uvs, m->vertex_count * sizeof *m->uvs};
    if (m->borrowed & MESH_BORROWS_INDICES)
        out[count++] = (array){(const unsigned char *)m->indices, 3 * (size_t)m->triangle_count * sizeof *m->indices};
    return count;
}

static bool is_mapped(array a)
{
    unsigned char is_in_memory[PAGES_AT_ONCE];
    const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), end = (uintptr_t)a.bytes + a.size;
    for (uintptr_t at = (uintptr_t)a.bytes / page * page; at < end; at += PAGES_AT_ONCE * page) {
        const size_t left = end - at, most = PAGES_AT_ONCE * page;
        if (mincore((void *)at, left < most ? left : most, is_in_memory) != 0 && errno == ENOMEM)
            return false; /* any other error tells nothing of the pages */
    }
    return true;
}

static uint64_t hash_of_ends(const shape *s)
{
    array arrays[ARRAYS_MOST];
    uint64_t hash = 0;
    const int count = borrowed_of(s, arrays);
    for (int i = 0; i < count; i++) {
        const array *a = &arrays[i];
        const size_t size = a->size < END_BYTES ? a->size : END_BYTES;
        for (size_t k = 0; k + sizeof(uint32_t) <= size; k += sizeof(uint32_t)) {
            uint32_t first, last;
            memcpy(&first, a->bytes + k, sizeof first);
            memcpy(&last, a->bytes + a->size - size + k, sizeof last);
            hash = hash_combine(hash_combine(hash, first), last);
        }
    }
    return hash;
}

void borrowed_arrays_note(shape *s)
{
    if (s->kind == SHAPE_MESH)
        s->as.mesh.borrowed_ends = hash_of_ends(s);
}

bool borrowed_arrays_are_mapped(const shape *s)
{
    array arrays[ARRAYS_MOST];
    const int count = borrowed_of(s, arrays);
    for (int i = 0; i < count; i++)
        if (!is_mapped(arrays[i]))
            return false;
    return true;
}

bool borrowed_arrays_are_lost(const shape *s)
{
    return s->kind == SHAPE_MESH && s->as.mesh.borrowed != 0 &&
           (!borrowed_arrays_are_mapped(s) || hash_of_ends(s) != s->as.mesh.borrowed_ends);
}
