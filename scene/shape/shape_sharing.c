/* shape_sharing.c: shapes of scenes that follow one another, which hold the same arrays: see shape.h.
 * Threads: one at a time. */
#include "shape/shape.h"

#include "math/rng.h"
#include "shape/borrowed_arrays.h"
#include "shape/curves.h"
#include "shape/mesh_motion.h"

#include <stdlib.h>
#include <string.h>

/* Returns where the count of a shape's holders is kept; NULL: a shape of that kind has no arrays. */
static uint32_t **holder_count_of(shape *s)
{
    return s->kind == SHAPE_MESH     ? &s->as.mesh.holder_count
           : s->kind == SHAPE_CURVES ? &s->as.curves.holder_count
                                     : NULL;
}

ag_status shape_share(shape *s, shape *out_other)
{
    uint32_t **count = holder_count_of(s);
    if (count && !*count) {
        *count = malloc(sizeof **count);
        if (!*count)
            return AG_ERROR_MEMORY;
        **count = 1;
    }
    if (count)
        ++**count;
    *out_other = *s;
    if (s->kind == SHAPE_MESH)
        out_other->as.mesh.area_cdf = NULL;
    return AG_OK;
}

static bool is_same_quadric(const quadric *a, const quadric *b)
{
    return memcmp(a->world_from_object.m, b->world_from_object.m, sizeof a->world_from_object.m) == 0 &&
           a->radius == b->radius && a->inner_radius == b->inner_radius && a->height == b->height &&
           a->z_min == b->z_min && a->z_max == b->z_max && a->turn == b->turn;
}

bool shape_has_same_surface(const shape *a, const shape *b)
{
    if (a->kind != b->kind)
        return false;
    if (a->kind == SHAPE_MESH)
        return a->as.mesh.holder_count && a->as.mesh.holder_count == b->as.mesh.holder_count &&
               a->as.mesh.motion_segments == b->as.mesh.motion_segments; /* of a lamp that stands still: 0 */
    if (a->kind == SHAPE_CURVES)
        return a->as.curves.holder_count && a->as.curves.holder_count == b->as.curves.holder_count;
    return is_same_quadric(&a->as.quadric, &b->as.quadric);
}

static bool is_same_array(const void *a, const void *b, size_t size_bytes)
{
    return !a == !b && (!a || memcmp(a, b, size_bytes) == 0);
}

static bool is_same_mesh(const mesh *a, const mesh *b)
{
    const size_t count = mesh_value_count(a), corners = 3 * (size_t)a->triangle_count;
    return a->vertex_count == b->vertex_count && a->motion_segments == b->motion_segments &&
           a->triangle_count == b->triangle_count && a->borrowed == 0 && b->borrowed == 0 &&
           is_same_array(a->positions, b->positions, count * sizeof *a->positions) &&
           is_same_array(a->normals, b->normals, count * sizeof *a->normals) &&
           is_same_array(a->uvs, b->uvs, a->vertex_count * sizeof *a->uvs) &&
           is_same_array(a->tangents, b->tangents, count * sizeof *a->tangents) &&
           is_same_array(a->indices, b->indices, corners * sizeof *a->indices);
}

static bool is_same_curves(const curves *a, const curves *b)
{
    const size_t count = a->segment_count;
    return a->type == b->type && a->segment_count == b->segment_count && a->motion_segments == b->motion_segments &&
           is_same_array(a->points, b->points, curves_points_of_each(a) * count * sizeof *a->points) &&
           is_same_array(a->spans, b->spans, count * sizeof *a->spans) &&
           is_same_array(a->normals, b->normals, 4 * count * sizeof *a->normals);
}

bool shape_equals(const shape *s, const shape *other)
{
    if (s->kind != other->kind || shape_has_same_surface(s, other))
        return false; /* nothing is left to be done */
    return s->kind == SHAPE_MESH     ? is_same_mesh(&s->as.mesh, &other->as.mesh)
           : s->kind == SHAPE_CURVES ? is_same_curves(&s->as.curves, &other->as.curves)
                                     : false;
}

ag_status shape_share_arrays(shape *from, shape *in_out_shape)
{
    shape other;
    ag_status status = shape_share(from, &other);
    if (status != AG_OK)
        return status;
    shape_reset(in_out_shape);
    if (from->kind == SHAPE_MESH)
        in_out_shape->as.mesh = other.as.mesh;
    else
        in_out_shape->as.curves = other.as.curves;
    return AG_OK;
}

/* Extends a hash by count words of 4 bytes. */
static uint64_t hash_words(uint64_t hash, const void *array, size_t count)
{
    const unsigned char *bytes = array;
    for (size_t i = 0; i < count; i++) {
        uint32_t word;
        memcpy(&word, bytes + i * sizeof word, sizeof word);
        hash = hash_combine(hash, word);
    }
    return hash;
}

uint64_t shape_hash_borrowed(const shape *s)
{
    const mesh *m = &s->as.mesh;
    uint64_t hash = 0;
    if (s->kind != SHAPE_MESH || m->borrowed == 0 || !borrowed_arrays_are_mapped(s))
        return 0;
    if (m->borrowed & MESH_BORROWS_POSITIONS)
        hash = hash_words(hash, m->positions, 3 * mesh_value_count(m));
    if (m->borrowed & MESH_BORROWS_UVS)
        hash = hash_words(hash, m->uvs, 2 * (size_t)m->vertex_count);
    if (m->borrowed & MESH_BORROWS_INDICES)
        hash = hash_words(hash, m->indices, 3 * (size_t)m->triangle_count);
    return hash;
}
