/* gltf_accessors.c: arrays of numbers as they lie in buffers: any component type, normalised, strided, sparse.
 * Rests on: Khronos, "glTF 2.0 Specification", 2021, 3.6.2 (accessors).
 * Flow: gltf_meshes, gltf_triangles -> [here] -> gltf_buffers. Threads: one per scene. */
#include "gltf/gltf_private.h"

#include <string.h>

/* The largest accessor without bytes: it is all zeros, and a file could give it any size. */
static const uint32_t MAX_ZEROS = (uint32_t)1 << 24;

typedef enum component_type { INT8 = 5120, UINT8, INT16, UINT16, UINT32 = 5125, FLOAT32 } component_type;

/* Returns the size in bytes of a component type; 0: there is no such type. */
static size_t component_size(int type)
{
    switch (type) {
    case INT8:
    case UINT8: return 1;
    case INT16:
    case UINT16: return 2;
    case UINT32:
    case FLOAT32: return 4;
    default: return 0;
    }
}

/* Returns the number of components of a type; 0: there is no such type. */
static int component_count(const char *type)
{
    static const struct {
        const char *name;
        int count;
    } TYPES[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
    for (size_t i = 0; i < sizeof TYPES / sizeof *TYPES; i++)
        if (strcmp(TYPES[i].name, type) == 0)
            return TYPES[i].count;
    return 0;
}

/* Reads a component from its bytes, in the machine's order: both it and the format are little-endian. */
static float read_component(const unsigned char *bytes, int type, bool is_normalized)
{
    int8_t i8;
    int16_t i16;
    uint16_t u16;
    uint32_t u32;
    float f;
    switch (type) {
    case INT8: memcpy(&i8, bytes, 1); return is_normalized ? float_max((float)i8 / 127.0f, -1.0f) : (float)i8;
    case UINT8: return is_normalized ? (float)*bytes / 255.0f : (float)*bytes;
    case INT16: memcpy(&i16, bytes, 2); return is_normalized ? float_max((float)i16 / 32767.0f, -1.0f) : (float)i16;
    case UINT16: memcpy(&u16, bytes, 2); return is_normalized ? (float)u16 / 65535.0f : (float)u16;
    case UINT32: memcpy(&u32, bytes, 4); return is_normalized ? (float)((double)u32 / 4294967295.0) : (float)u32;
    default: memcpy(&f, bytes, 4); return f;
    }
}

static uint32_t read_unsigned(const unsigned char *bytes, int type)
{
    uint16_t u16;
    uint32_t u32;
    switch (type) {
    case UINT8: return *bytes;
    case UINT16: memcpy(&u16, bytes, 2); return u16;
    default: memcpy(&u32, bytes, 4); return u32;
    }
}

static ag_status read_component_type(const gltf_reader *r, const gltf_value *at, int *out_type)
{
    uint64_t type = 0;
    gltf_value v = gltf_member(at, "componentType");
    AG_TRY(gltf_require(r, at, "componentType"));
    AG_TRY(gltf_get_uint(r, at, "componentType", &type));
    if (type > INT16_MAX || component_size((int)type) == 0)
        return gltf_error(r, &v, "there is no component type %llu", (unsigned long long)type);
    *out_type = (int)type;
    return AG_OK;
}

/* The values of a sparse accessor, which replace others, by rising indices. */
static ag_status open_sparse(gltf_reader *r, const gltf_value *accessor, gltf_accessor *a)
{
    gltf_value sparse, indices, values;
    uint64_t count = 0, index_offset = 0, value_offset = 0;
    size_t stride, element_size = component_size(a->component_type) * (size_t)a->components;
    AG_TRY(gltf_get_object(r, accessor, "sparse", &sparse));
    if (!sparse.json)
        return AG_OK;
    AG_TRY(gltf_require(r, &sparse, "count"));
    AG_TRY(gltf_get_uint(r, &sparse, "count", &count));
    AG_TRY(gltf_require(r, &sparse, "indices"));
    AG_TRY(gltf_get_object(r, &sparse, "indices", &indices));
    AG_TRY(gltf_require(r, &sparse, "values"));
    AG_TRY(gltf_get_object(r, &sparse, "values", &values));
    AG_TRY(read_component_type(r, &indices, &a->sparse_index_type));
    AG_TRY(gltf_get_uint(r, &indices, "byteOffset", &index_offset));
    AG_TRY(gltf_get_uint(r, &values, "byteOffset", &value_offset));
    if (count > a->count)
        return gltf_error(r, &sparse, "its count is %llu, but the accessor has %u elements", (unsigned long long)count,
                          a->count);
    if (a->sparse_index_type != UINT8 && a->sparse_index_type != UINT16 && a->sparse_index_type != UINT32)
        return gltf_error(r, &indices, "should be unsigned integers");
    size_t index_size = component_size(a->sparse_index_type);
    AG_TRY(gltf_view_span(r, &indices, index_offset, count, index_size, &a->sparse_indices, &stride));
    if (stride != index_size)
        return gltf_error(r, &indices, "their view must have no byteStride");
    AG_TRY(gltf_view_span(r, &values, value_offset, count, element_size, &a->sparse_values, &stride));
    if (stride != element_size)
        return gltf_error(r, &values, "their view must have no byteStride");
    a->sparse_count = (uint32_t)count;
    uint32_t last = 0;
    for (uint32_t i = 0; i < a->sparse_count; i++) {
        uint32_t index = read_unsigned(a->sparse_indices.data + i * index_size, a->sparse_index_type);
        if (index >= a->count || (i > 0 && index <= last))
            return gltf_error(r, &indices, "index %u (element %u) is out of range, or does not rise", index, i);
        last = index;
    }
    return AG_OK;
}

ag_status gltf_accessor_open(gltf_reader *r, const gltf_value *at, uint32_t index, int components_min,
                             int components_max, gltf_accessor *out_accessor)
{
    gltf_accessor *a = out_accessor;
    gltf_value accessor;
    const char *type = "";
    uint64_t offset = 0, count = 0;
    memset(a, 0, sizeof *a);
    AG_TRY(gltf_get_item(r, GLTF_ACCESSORS, index, &accessor));
    AG_TRY(gltf_require(r, &accessor, "count"));
    AG_TRY(gltf_require(r, &accessor, "type"));
    AG_TRY(gltf_get_text(r, &accessor, "type", &type));
    AG_TRY(read_component_type(r, &accessor, &a->component_type));
    AG_TRY(gltf_get_bool(r, &accessor, "normalized", &a->is_normalized));
    AG_TRY(gltf_get_uint(r, &accessor, "byteOffset", &offset));
    AG_TRY(gltf_get_uint(r, &accessor, "count", &count));
    a->components = component_count(type);
    if (a->components == 0)
        return gltf_error(r, &accessor, "there is no type \"%s\"", type);
    if (a->components < components_min || a->components > components_max)
        return gltf_error(r, at, "accessors[%u] is of type %s, which does not fit", index, type);
    if (count == 0 || count > UINT32_MAX / 4)
        return gltf_error(r, &accessor, "its count is %llu, which should be from 1 to 2^30", (unsigned long long)count);
    a->count = (uint32_t)count;
    size_t element_size = component_size(a->component_type) * (size_t)a->components;
    if (gltf_member(&accessor, "bufferView").json)
        AG_TRY(gltf_view_span(r, &accessor, offset, count, element_size, &a->bytes, &a->stride));
    else if (count > MAX_ZEROS)
        return gltf_error(r, &accessor, "it has no bufferView, and %u elements are too many for that", a->count);
    return open_sparse(r, &accessor, a);
}

/* Returns the bytes of element i; NULL: it is zeros. */
static const unsigned char *element_at(const gltf_accessor *a, uint32_t i)
{
    size_t index_size = component_size(a->sparse_index_type);
    uint32_t low = 0, high = a->sparse_count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        uint32_t index = read_unsigned(a->sparse_indices.data + middle * index_size, a->sparse_index_type);
        if (index == i)
            return a->sparse_values.data + middle * component_size(a->component_type) * (size_t)a->components;
        if (index < i)
            low = middle + 1;
        else
            high = middle;
    }
    return a->bytes.data ? a->bytes.data + i * a->stride : NULL;
}

void gltf_accessor_get(const gltf_accessor *a, uint32_t i, float *out_values)
{
    const unsigned char *element = element_at(a, i);
    size_t size = component_size(a->component_type);
    for (int c = 0; c < a->components; c++)
        out_values[c] =
            element ? read_component(element + (size_t)c * size, a->component_type, a->is_normalized) : 0.0f;
}

uint32_t gltf_accessor_get_index(const gltf_accessor *a, uint32_t i)
{
    const unsigned char *element = element_at(a, i);
    return element ? read_unsigned(element, a->component_type) : 0;
}
