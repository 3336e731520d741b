/* gltf_triangles.c: from a primitive's mode and indices to the corners of triangles.
 * Rests on: Khronos, "glTF 2.0 Specification", 2021, 3.7.2.1 (topology types).
 * Flow: gltf_meshes -> [here] -> gltf_accessors. Threads: one per scene. */
#include "gltf/gltf_private.h"

#include <stdlib.h>

enum { MODE_TRIANGLES = 4, MODE_STRIP, MODE_FAN };

/* Takes the primitive's vertices in their order. */
typedef struct corner_list {
    gltf_accessor indices;
    bool is_indexed; /* else each vertex once */
    uint32_t count;
} corner_list;

static uint32_t corner(const corner_list *list, uint32_t i)
{
    return list->is_indexed ? gltf_accessor_get_index(&list->indices, i) : i;
}

static ag_status open_corners(gltf_reader *r, const gltf_value *primitive, uint32_t vertex_count, corner_list *list)
{
    uint32_t index = GLTF_NONE;
    gltf_value at = gltf_member(primitive, "indices");
    list->is_indexed = false;
    list->count = vertex_count;
    AG_TRY(gltf_get_index(r, primitive, "indices", GLTF_ACCESSORS, &index));
    if (index == GLTF_NONE)
        return AG_OK;
    AG_TRY(gltf_accessor_open(r, &at, index, 1, 1, &list->indices));
    int type = list->indices.component_type;
    if (type != 5121 && type != 5123 && type != 5125)
        return gltf_error(r, &at, "should be unsigned integers");
    list->is_indexed = true;
    list->count = list->indices.count;
    for (uint32_t i = 0; i < list->count; i++)
        if (corner(list, i) >= vertex_count)
            return gltf_error(r, &at, "index %u (element %u) is out of range: there are %u vertices", corner(list, i),
                              i, vertex_count);
    return AG_OK;
}

static void fill_triangle(const corner_list *list, uint64_t mode, uint32_t i, uint32_t *triangle)
{
    uint32_t odd = i % 2, first = 3 * i, second = first + 1, third = first + 2;
    if (mode == MODE_STRIP) /* every other one is turned over */
        first = i, second = i + 1 + odd, third = i + 2 - odd;
    else if (mode == MODE_FAN)
        first = i + 1, second = i + 2, third = 0;
    triangle[0] = corner(list, first);
    triangle[1] = corner(list, second);
    triangle[2] = corner(list, third);
}

ag_status gltf_read_triangles(gltf_reader *r, const gltf_value *primitive, uint32_t vertex_count,
                              gltf_triangles *out_triangles)
{
    static const char *const OTHERS[MODE_TRIANGLES] = {"points", "lines", "line loops", "line strips"};
    uint64_t mode = MODE_TRIANGLES;
    corner_list list;
    gltf_value at = gltf_member(primitive, "mode");
    *out_triangles = (gltf_triangles){NULL, 0, false};
    AG_TRY(gltf_get_uint(r, primitive, "mode", &mode));
    if (mode > MODE_FAN)
        return gltf_error(r, &at, "there is no mode %llu", (unsigned long long)mode);
    if (mode < MODE_TRIANGLES) {
        gltf_warn_once(r, &at, OTHERS[mode], "%s have no surface, and are left out", OTHERS[mode]);
        return AG_OK;
    }
    AG_TRY(open_corners(r, primitive, vertex_count, &list));
    uint32_t count = mode == MODE_TRIANGLES ? list.count / 3 : list.count >= 3 ? list.count - 2 : 0;
    if (mode == MODE_TRIANGLES ? list.count % 3 != 0 : list.count < 3)
        gltf_warn_once(r, primitive, "corners", "%u vertices do not make whole triangles", list.count);
    if (count == 0)
        return AG_OK;
    uint32_t *indices = malloc(3 * (size_t)count * sizeof *indices);
    if (!indices)
        return AG_ERROR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
        fill_triangle(&list, mode, i, indices + 3 * (size_t)i);
    *out_triangles = (gltf_triangles){indices, count, mode == MODE_STRIP};
    return AG_OK;
}
