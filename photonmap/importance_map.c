/* importance_map.c: see importance_map.h. */
#include "importance_map.h"

#include "math/compare_floats.h"
#include "status.h"

#include <stdlib.h>

/* A cube is divided while it holds more points than LEAF_MOST: a surface that passes through leaves about a quarter of
 * them to each part that it passes through, so that hardly any of those is empty by chance. */
enum { FACES = 6, LEAF_MOST = 24, DEPTH_MAX = 24, PARTS = 8 };
/* A point counts for each face of a cube whose direction its normal is within 60 degrees of. */
static const float FACE_COSINE = 0.5f;

struct importance_node {
    uint32_t first_part; /* of eight side by side; 0: a leaf, since the roots come first */
    float density;       /* of a leaf */
};

/* The nodes while they grow, and room to sort the points of one tree. */
typedef struct builder {
    importance_node *nodes;
    uint32_t count, capacity;
    vec3 *points, *scratch;
    float unit; /* what one point adds to the share of a cube */
    bool is_smooth;
} builder;

static bool add_parts(builder *b, uint32_t *out_first)
{
    if (b->count + PARTS > b->capacity) {
        uint32_t capacity = 2 * (b->count + PARTS);
        importance_node *larger = realloc(b->nodes, capacity * sizeof *larger);
        if (!larger)
            return false;
        b->nodes = larger;
        b->capacity = capacity;
    }
    *out_first = b->count;
    for (int i = 0; i < PARTS; i++)
        b->nodes[b->count++] = (importance_node){0, 0.0f};
    return true;
}

static uint32_t part_of(vec3 point, vec3 middle)
{
    return (uint32_t)(point.x >= middle.x) | (uint32_t)(point.y >= middle.y) << 1 |
           (uint32_t)(point.z >= middle.z) << 2;
}

static vec3 part_corner(vec3 corner, float half, uint32_t part)
{
    return (vec3){corner.x + (part & 1 ? half : 0.0f), corner.y + (part & 2 ? half : 0.0f),
                  corner.z + (part & 4 ? half : 0.0f)};
}

/* Puts the points of a cube in the order of its parts; out_ends: where each part's points end. */
static void sort_points(builder *b, uint32_t begin, uint32_t end, vec3 middle, uint32_t out_ends[PARTS])
{
    uint32_t next[PARTS] = {0}, sum = begin; /* each part's number of points, then where its next one goes */
    for (uint32_t i = begin; i < end; i++)
        next[part_of(b->points[i], middle)]++;
    for (int i = 0; i < PARTS; i++) {
        uint32_t count = next[i];
        next[i] = sum;
        sum += count;
        out_ends[i] = sum;
    }
    for (uint32_t i = begin; i < end; i++)
        b->scratch[next[part_of(b->points[i], middle)]++] = b->points[i];
    for (uint32_t i = begin; i < end; i++)
        b->points[i] = b->scratch[i];
}

/* The mean of what a count of points by chance leaves open, where `around` were to be expected before it was known: of
 * the gamma distribution whose shape is 1. */
static float smooth_count(uint32_t count, float around) { return around * ((float)count + 1.0f) / (around + 1.0f); }

/* Makes the nodes below a node that holds the points from begin to end, in a cube. around: how many points there would
 * be if those of the cube above were spread over its surface. Returns false where memory runs out. */
static bool divide(builder *b, uint32_t node, uint32_t begin, uint32_t end, vec3 corner, float size, float around,
                   int depth)
{
    float points = b->is_smooth ? smooth_count(end - begin, around) : (float)(end - begin);
    if (end - begin <= LEAF_MOST || depth == DEPTH_MAX) {
        b->nodes[node].density = points * b->unit / (size * size);
        return true;
    }
    float half = 0.5f * size;
    uint32_t first, ends[PARTS];
    sort_points(b, begin, end, part_corner(corner, half, PARTS - 1), ends);
    if (!add_parts(b, &first))
        return false;
    b->nodes[node].first_part = first;
    for (uint32_t i = 0; i < PARTS; i++) {
        if (!divide(b, first + i, begin, ends[i], part_corner(corner, half, i), half, 0.25f * points, depth + 1))
            return false;
        begin = ends[i];
    }
    return true;
}

static float component(vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

static void set_cube(vec3 low, vec3 high, importance_map *out)
{
    vec3 extent = vec3_sub(high, low);
    float largest = float_max(float_max(extent.x, extent.y), extent.z);
    /* a little larger, and with its corner a little off: what lies in the planes of walls falls on one side */
    out->size = 1.03f * float_max(largest, 1e-6f * float_max(vec3_length(high), 1.0f));
    out->corner = vec3_sub(low, (vec3){0.011f * out->size, 0.012f * out->size, 0.013f * out->size});
}

static ag_status build(const query_point *points, uint32_t count, float unit, bool is_smooth, vec3 low, vec3 high,
                       importance_map *out_importance)
{
    importance_map made = {0};
    set_cube(low, high, &made);
    builder b = {.capacity = FACES + 1024, .count = FACES, .unit = unit, .is_smooth = is_smooth};
    b.nodes = calloc(b.capacity, sizeof *b.nodes);
    b.points = malloc(count * sizeof *b.points);
    b.scratch = malloc(count * sizeof *b.scratch);
    bool is_made = b.nodes && b.points && b.scratch;
    for (uint32_t face = 0; is_made && face < FACES; face++) {
        uint32_t facing_count = 0;
        for (uint32_t i = 0; i < count; i++) {
            float along = component(points[i].normal, (int)face / 2);
            if ((face % 2 ? -along : along) > FACE_COSINE)
                b.points[facing_count++] = points[i].position;
        }
        is_made = divide(&b, face, 0, facing_count, made.corner, made.size, (float)facing_count, 0);
    }
    free(b.points);
    free(b.scratch);
    if (!is_made) {
        free(b.nodes);
        return AG_ERROR_MEMORY;
    }
    made.nodes = b.nodes;
    made.node_count = b.count;
    *out_importance = made;
    return AG_OK;
}

/* The share of the points that the focus holds: what gather rays see of a landscape is left out. */
static const float FOCUS_SHARE = 0.9f;

/* The ball around the median of each coordinate that holds FOCUS_SHARE of the points. */
static ag_status find_focus(const query_point *points, uint32_t count, light_target *out_focus)
{
    float *values = malloc(count * sizeof *values), middle[3];
    if (!values)
        return AG_ERROR_MEMORY;
    for (int axis = 0; axis < 3; axis++) {
        for (uint32_t i = 0; i < count; i++)
            values[i] = component(points[i].position, axis);
        qsort(values, count, sizeof *values, compare_floats);
        middle[axis] = values[count / 2];
    }
    out_focus->center = (vec3){middle[0], middle[1], middle[2]};
    for (uint32_t i = 0; i < count; i++)
        values[i] = vec3_distance_squared(points[i].position, out_focus->center);
    qsort(values, count, sizeof *values, compare_floats);
    out_focus->radius = sqrtf(values[(uint32_t)(FOCUS_SHARE * (float)count)]);
    free(values);
    return AG_OK;
}

ag_status importance_map_create(const query_point *points, uint32_t count, importance_map *out_importance)
{
    *out_importance = (importance_map){0};
    if (count == 0)
        return AG_OK;
    light_target focus;
    AG_TRY(find_focus(points, count, &focus));
    vec3 low = points[0].position, high = low;
    for (uint32_t i = 1; i < count; i++) {
        vec3 p = points[i].position;
        low = vec3_min(low, p);
        high = vec3_max(high, p);
    }
    AG_TRY(build(points, count, 1.0f / (float)count, false, low, high, out_importance));
    out_importance->focus = focus;
    return AG_OK;
}

ag_status importance_map_create_smooth(const query_point *points, uint32_t count, uint32_t whole, vec3 low, vec3 high,
                                       importance_map *out_importance)
{
    *out_importance = (importance_map){0};
    return count == 0 ? AG_OK : build(points, count, 1.0f / (float)whole, true, low, high, out_importance);
}

void importance_map_reset(importance_map *importance)
{
    free(importance->nodes);
    *importance = (importance_map){0};
}

float importance_map_at(const importance_map *importance, vec3 position, vec3 normal)
{
    vec3 corner = importance->corner;
    float size = importance->size;
    vec3 within = vec3_sub(position, corner);
    if (!importance->nodes || !(within.x >= 0.0f && within.y >= 0.0f && within.z >= 0.0f) || within.x > size ||
        within.y > size || within.z > size)
        return 0.0f;
    float x = fabsf(normal.x), y = fabsf(normal.y), z = fabsf(normal.z);
    int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    uint32_t node = 2 * (uint32_t)axis + (component(normal, axis) < 0.0f);
    while (importance->nodes[node].first_part != 0) {
        size *= 0.5f;
        uint32_t part = part_of(position, part_corner(corner, size, PARTS - 1));
        corner = part_corner(corner, size, part);
        node = importance->nodes[node].first_part + part;
    }
    return importance->nodes[node].density;
}
