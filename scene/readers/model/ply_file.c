/* ply_file.c: see ply_file.h. Memory is taken for what the file's size has room for, or as data comes out of a gzip
 * file: never by a header's word alone. Threads: any. */
#include "model/ply_file.h"

#include "model/ply_header.h"

#include <stdlib.h>
#include <string.h>

enum { FIRST_RECORDS = 1 << 12 }; /* room to begin with where a file's size is not known */

typedef struct loader {
    ply_stream stream;
    ply_header header;
    ply_mesh *out;
    size_t vertex_capacity, triangle_capacity, triangle_count;
    bool has_normals, has_uvs;
} loader;

/* Reallocates an array for count items, 1 at least. */
static bool resize(void *array_pointer, size_t count, size_t item_bytes)
{
    void *old, *larger;
    memcpy(&old, array_pointer, sizeof old);
    larger = realloc(old, (count ? count : 1) * item_bytes);
    if (larger)
        memcpy(array_pointer, &larger, sizeof larger);
    return larger != NULL;
}

static uint64_t smaller(uint64_t a, uint64_t b) { return a < b ? a : b; }

/* Refuses a header that promises more than the file can hold. Returns how many items to make room for at first. */
static ag_status check_room(loader *l, const ply_element *e, uint64_t *out_first)
{
    uint64_t room = ply_room_for(&l->stream, e->least_bytes);
    if (e->count > room) {
        l->stream.element = NULL;
        l->stream.line = e->line;
        return ply_fail(&l->stream,
                        "the header promises %llu of element \"%s\", but the file is cut short: it has room for %llu",
                        (unsigned long long)e->count, e->name, (unsigned long long)room);
    }
    *out_first = room == UINT64_MAX ? smaller(e->count, FIRST_RECORDS) : e->count;
    return AG_OK;
}

/* --- vertices --- */

static ag_status reserve_vertices(loader *l, uint64_t count)
{
    if (count <= l->vertex_capacity && l->out->mesh.positions)
        return AG_OK;
    mesh *m = &l->out->mesh;
    uint64_t capacity = smaller(l->header.vertex->count, 2 * (uint64_t)l->vertex_capacity);
    if (capacity < count)
        capacity = count;
    if (!resize(&m->positions, capacity + 1, sizeof *m->positions) || /* Embree reads 16 bytes at the last */
        (l->has_normals && !resize(&m->normals, capacity, sizeof *m->normals)) ||
        (l->has_uvs && !resize(&m->uvs, capacity, sizeof *m->uvs)))
        return AG_ERROR_MEMORY;
    l->vertex_capacity = (size_t)capacity;
    m->positions[capacity] = (vec3){0.0f, 0.0f, 0.0f};
    return AG_OK;
}

static ag_status store_vertex(loader *l, uint64_t index, const double values[PLY_VERTEX_SLOTS])
{
    mesh *m = &l->out->mesh;
    float v[PLY_VERTEX_SLOTS];
    for (int i = 0; i < PLY_VERTEX_SLOTS; i++)
        v[i] = (float)values[i];
    for (int i = PLY_X; i <= PLY_Z; i++)
        if (!isfinite(v[i]))
            return ply_fail(&l->stream, "%c is no finite number", "xyz"[i]);
    m->positions[index] = (vec3){v[PLY_X], v[PLY_Y], v[PLY_Z]};
    if (l->has_normals) {
        vec3 n = {v[PLY_NX], v[PLY_NY], v[PLY_NZ]};
        bool is_odd = !vec3_is_finite(n);
        l->out->odd_vectors += is_odd;
        m->normals[index] = is_odd ? (vec3){0.0f, 0.0f, 0.0f} : n;
    }
    if (l->has_uvs) {
        bool is_odd = !isfinite(v[PLY_U]) || !isfinite(v[PLY_V]);
        l->out->odd_vectors += is_odd;
        m->uvs[index] = is_odd ? (vec2){0.0f, 0.0f} : (vec2){v[PLY_U], v[PLY_V]};
    }
    return AG_OK;
}

static ag_status read_count(loader *l, const ply_property *p, uint64_t *out_count)
{
    double count;
    AG_TRY(ply_read_number(&l->stream, p->count_type, &count));
    if (!(count >= 0.0 && count <= (double)UINT32_MAX && floor(count) == count))
        return ply_fail(&l->stream, "a list cannot have %.17g entries", count);
    *out_count = (uint64_t)count;
    return AG_OK;
}

/* Passes over a property. */
static ag_status skip_property(loader *l, const ply_property *p)
{
    uint64_t count = 1;
    if (p->is_list)
        AG_TRY(read_count(l, p, &count));
    return ply_skip_numbers(&l->stream, p->type, count);
}

/* Reads vertices number by number: those of ascii files, and those with lists. */
static ag_status read_vertex(loader *l, const ply_element *e, uint64_t index)
{
    double values[PLY_VERTEX_SLOTS] = {0.0};
    for (size_t i = 0; i < e->property_count; i++) {
        const ply_property *p = &e->properties[i];
        if (p->slot == PLY_NO_SLOT)
            AG_TRY(skip_property(l, p));
        else
            AG_TRY(ply_read_number(&l->stream, p->type, &values[p->slot]));
    }
    return store_vertex(l, index, values);
}

/* Reads as many vertices as lie in the buffer: binary, without lists. */
static ag_status read_vertex_block(loader *l, const ply_element *e, uint64_t begin, uint64_t *out_end)
{
    ply_stream *s = &l->stream;
    size_t stride = (size_t)e->least_bytes, offsets[PLY_VERTEX_SLOTS], slot_count = 0, at = 0;
    const ply_property *used[PLY_VERTEX_SLOTS];
    for (size_t i = 0; i < e->property_count; i++) {
        if (e->properties[i].slot != PLY_NO_SLOT) {
            used[slot_count] = &e->properties[i];
            offsets[slot_count++] = at;
        }
        at += ply_type_bytes(e->properties[i].type);
    }
    AG_TRY(ply_fill(s, stride));
    uint64_t end = begin + smaller((s->end - s->next) / stride, e->count - begin);
    s->mark = s->next;
    if (end == begin)
        return ply_fail(s, "the file ends here");
    AG_TRY(reserve_vertices(l, end));
    double values[PLY_VERTEX_SLOTS] = {0.0};
    for (; begin < end; begin++, s->next += stride) {
        s->element_index = begin;
        s->mark = s->next;
        for (size_t i = 0; i < slot_count; i++)
            values[used[i]->slot] = ply_decode(s->bytes + s->next + offsets[i], used[i]->type, s->format);
        AG_TRY(store_vertex(l, begin, values));
    }
    *out_end = end;
    return AG_OK;
}

static ag_status read_vertices(loader *l, const ply_element *e)
{
    uint64_t first = 0;
    AG_TRY(check_room(l, e, &first));
    AG_TRY(reserve_vertices(l, first));
    bool in_blocks = l->stream.format != PLY_ASCII && !e->has_list;
    for (uint64_t i = 0; i < e->count;) {
        l->stream.element_index = i;
        if (in_blocks) {
            AG_TRY(read_vertex_block(l, e, i, &i));
            continue;
        }
        AG_TRY(reserve_vertices(l, i + 1));
        AG_TRY(read_vertex(l, e, i++));
    }
    l->out->mesh.vertex_count = (uint32_t)e->count;
    return AG_OK;
}

/* --- faces --- */

static ag_status reserve_triangles(loader *l, size_t count)
{
    if (count <= l->triangle_capacity && l->out->mesh.indices)
        return AG_OK;
    if (count >= UINT32_MAX / 4)
        return ply_fail(&l->stream, "there are too many triangles");
    size_t capacity = 2 * l->triangle_capacity > count ? 2 * l->triangle_capacity : count;
    if (!resize(&l->out->mesh.indices, 3 * capacity, sizeof *l->out->mesh.indices))
        return AG_ERROR_MEMORY;
    l->triangle_capacity = capacity;
    return AG_OK;
}

static ag_status read_corner(loader *l, const ply_property *p, uint32_t *out_index)
{
    double value, vertex_count = (double)l->header.vertex->count;
    AG_TRY(ply_read_number(&l->stream, p->type, &value));
    if (!(value >= 0.0 && value < vertex_count && floor(value) == value))
        return ply_fail(&l->stream, "index %.17g is out of range, there are %.0f vertices", value, vertex_count);
    *out_index = (uint32_t)value;
    return AG_OK;
}

static ag_status read_corners(loader *l, const ply_property *p)
{
    uint64_t count = 0;
    uint32_t corners[3] = {0, 0, 0};
    AG_TRY(read_count(l, p, &count));
    l->out->lines += count < 3;
    for (uint64_t i = 0; i < count; i++) {
        uint32_t *corner = &corners[i < 2 ? i : 2];
        AG_TRY(read_corner(l, p, corner));
        if (i < 2)
            continue;
        AG_TRY(reserve_triangles(l, l->triangle_count + 1));
        memcpy(l->out->mesh.indices + 3 * l->triangle_count++, corners, sizeof corners);
        corners[1] = corners[2];
    }
    return AG_OK;
}

static ag_status read_face(loader *l, const ply_element *e)
{
    for (size_t i = 0; i < e->property_count; i++)
        AG_TRY(e->properties[i].slot == PLY_CORNERS ? read_corners(l, &e->properties[i])
                                                    : skip_property(l, &e->properties[i]));
    return AG_OK;
}

/* The common record, a byte 3 and three 32-bit numbers, if it is the next and all is well with it. */
static bool read_plain_triangle(loader *l)
{
    ply_stream *s = &l->stream;
    if (s->end - s->next < 13 || s->bytes[s->next] != 3 || l->triangle_count == l->triangle_capacity)
        return false;
    const unsigned char *b = s->bytes + s->next + 1;
    uint32_t *out = l->out->mesh.indices + 3 * l->triangle_count;
    for (int i = 0; i < 3; i++, b += 4) {
        double index = ply_decode(b, PLY_UINT32, s->format);
        if (index >= (double)l->header.vertex->count)
            return false;
        out[i] = (uint32_t)index;
    }
    s->next += 13;
    l->triangle_count++;
    return true;
}

static ag_status read_faces(loader *l, const ply_element *e)
{
    ply_stream *s = &l->stream;
    uint64_t first = 0;
    const ply_property *p = &e->properties[e->of_slot[PLY_CORNERS]];
    AG_TRY(check_room(l, e, &first));
    bool is_ascii = s->format == PLY_ASCII;
    uint64_t triangle_bytes = is_ascii ? 8 : ply_type_bytes(p->count_type) + 3 * ply_type_bytes(p->type);
    AG_TRY(reserve_triangles(l, (size_t)smaller(first, ply_room_for(s, triangle_bytes))));
    bool is_plain =
        !is_ascii && e->property_count == 1 && ply_type_bytes(p->count_type) == 1 && ply_type_bytes(p->type) == 4;
    for (uint64_t i = 0; i < e->count; i++) {
        s->element_index = i;
        if (!is_plain || !read_plain_triangle(l))
            AG_TRY(read_face(l, e));
    }
    l->out->mesh.triangle_count = (uint32_t)l->triangle_count;
    return AG_OK;
}

/* --- the file --- */

static ag_status skip_element(loader *l, const ply_element *e)
{
    uint64_t first = 0;
    AG_TRY(check_room(l, e, &first));
    for (uint64_t i = 0; i < e->count && e->property_count > 0; i++) {
        l->stream.element_index = i;
        for (size_t p = 0; p < e->property_count; p++)
            AG_TRY(skip_property(l, &e->properties[p]));
    }
    return AG_OK;
}

static bool has_slots(const ply_element *e, int first, int last)
{
    for (int i = first; i <= last; i++)
        if (e->of_slot[i] < 0)
            return false;
    return true;
}

static ag_status load(loader *l)
{
    ply_header *h = &l->header;
    AG_TRY(ply_header_read(&l->stream, h));
    l->has_normals = has_slots(h->vertex, PLY_NX, PLY_NZ);
    l->has_uvs = has_slots(h->vertex, PLY_U, PLY_V);
    for (size_t i = 0; i < h->element_count; i++) {
        const ply_element *e = &h->elements[i];
        l->stream.element = e->name;
        AG_TRY(e == h->vertex ? read_vertices(l, e) : e == h->face ? read_faces(l, e) : skip_element(l, e));
    }
    /* to the end of a gzip file, where its checksum is */
    l->stream.next = l->stream.end;
    return ply_fill(&l->stream, 1);
}

ag_status ply_file_read(const char *path, const run_context *run, char *error, size_t error_size, ply_mesh *out_mesh)
{
    memset(out_mesh, 0, sizeof *out_mesh);
    loader *l = calloc(1, sizeof *l); /* the header's tables are large for a stack */
    if (!l)
        return AG_ERROR_MEMORY;
    l->out = out_mesh;
    ag_status status = ply_stream_open(path, run, error, error_size, &l->stream);
    if (status == AG_OK) {
        status = load(l);
        ply_stream_close(&l->stream);
    }
    if (status != AG_OK)
        ply_mesh_reset(out_mesh);
    free(l);
    return status;
}

void ply_mesh_reset(ply_mesh *m)
{
    free(m->mesh.positions);
    free(m->mesh.normals);
    free(m->mesh.uvs);
    free(m->mesh.indices);
    memset(m, 0, sizeof *m);
}
