/* curve_arrays.c: the arrays that curves are in: see curves.h.
 * Threads: curves_reserve and curves_join by one thread; the rest read only. */
#include "shape/curves.h"

#include "status.h"

#include <stdlib.h>
#include <string.h>

enum { CAPACITY_MIN = 4, SEGMENTS_MAX = 1 << 28 };

static bool enlarge(void *items, size_t count, size_t spare, size_t item_bytes)
{
    void *old, *larger;
    memcpy(&old, items, sizeof old);
    larger = realloc(old, (count + spare) * item_bytes);
    if (larger)
        memcpy(items, &larger, sizeof larger);
    return larger != NULL;
}

ag_status curves_reserve(curves *c, uint32_t segment_count)
{
    const size_t each = curves_points_of_each(c);
    if (segment_count > SEGMENTS_MAX / (c->motion_segments + 1))
        return AG_ERROR_MEMORY;
    if (segment_count <= c->capacity)
        return AG_OK;
    uint32_t capacity = c->capacity ? c->capacity : CAPACITY_MIN;
    while (capacity < segment_count)
        capacity *= 2;
    size_t points = each * capacity;
    if (!enlarge(&c->points, points, 0, sizeof *c->points) || !enlarge(&c->spans, capacity, 0, sizeof *c->spans) ||
        !enlarge(&c->first_points, capacity, 0, sizeof *c->first_points) ||
        (c->type == CURVES_RIBBON && !enlarge(&c->normals, points, 1, sizeof *c->normals)))
        return AG_ERROR_MEMORY;
    for (uint32_t i = c->capacity; i < capacity; i++)
        c->first_points[i] = (uint32_t)each * i;
    c->capacity = capacity;
    return AG_OK;
}

void curves_reset(curves *c)
{
    if (!c->holder_count || --*c->holder_count == 0) {
        free(c->points);
        free(c->spans);
        free(c->first_points);
        free(c->normals);
        free(c->holder_count);
    }
    *c = (curves){0};
}

bool curves_can_be_joined(const shape *s, const shape *with)
{
    return s->kind == SHAPE_CURVES && with->kind == SHAPE_CURVES && s->as.curves.type == with->as.curves.type &&
           !s->as.curves.holder_count && s->flip_normal == with->flip_normal &&
           s->medium_inside == with->medium_inside && s->medium_outside == with->medium_outside &&
           s->material_index == with->material_index && s->alpha == with->alpha &&
           s->alpha_texture == with->alpha_texture && s->alpha_cutoff == with->alpha_cutoff &&
           s->light_index == SHAPE_NO_LIGHT && with->light_index == SHAPE_NO_LIGHT &&
           s->object_index == with->object_index && s->as.curves.motion_segments == with->as.curves.motion_segments &&
           s->as.curves.segment_count + with->as.curves.segment_count <=
               SEGMENTS_MAX / (s->as.curves.motion_segments + 1);
}

ag_status curves_join(curves *c, const curves *from)
{
    const uint32_t before = c->segment_count;
    const size_t each = curves_points_of_each(c);
    AG_TRY(curves_reserve(c, before + from->segment_count));
    memcpy(c->points + each * before, from->points, each * from->segment_count * sizeof *c->points);
    memcpy(c->spans + before, from->spans, from->segment_count * sizeof *c->spans);
    if (c->normals)
        memcpy(c->normals + 4 * (size_t)before, from->normals, 4 * (size_t)from->segment_count * sizeof *c->normals);
    c->segment_count += from->segment_count;
    return AG_OK;
}

void curves_find_bounds(const shape *s, vec3 *out_min, vec3 *out_max)
{
    const curves *c = &s->as.curves;
    vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < curves_points_of_each(c) * c->segment_count;
         i++) { /* a Bezier curve is within its control points' hull */
        curve_point p = c->points[i];
        vec3 reach = {p.radius, p.radius, p.radius};
        low = vec3_min(low, vec3_sub(p.at, reach));
        high = vec3_max(high, vec3_add(p.at, reach));
    }
    *out_min = low;
    *out_max = high;
}
