/* flat_patches.c: see flat_patches.h. Corners at one position are one, whatever their numbers; triangles with a common
 * edge and a common plane are joined (union by smallest root). Threads: pure functions. */
#include "shape/flat_patches.h"

#include <stdlib.h>
#include <string.h>

/* At an edge a triangle is compared with at most so many earlier ones: more than two at one edge are rare. */
enum { EDGE_NEIGHBORS_MAX = 8 };
/* Normals of a file's vertices are off by this where they were rounded to bytes, radians: sqrt(3) / 2 / 127. */
static const float VERTEX_ANGLE_MAX = 7e-3f;

typedef struct corner {
    vec3 at;
    uint32_t vertex;
} corner;

typedef struct edge {
    uint32_t low, high, triangle; /* its ends, as welded vertices */
} edge;

typedef struct work {
    const mesh *m;
    uint32_t *welded; /* one vertex number for all vertices at one position */
    uint32_t *root;   /* of each triangle */
    vec3 *normal;     /* of each triangle; zero where it is not flat or has no area */
    float *area;
    corner *corners;
    edge *edges;
} work;

static int compare_positions(vec3 a, vec3 b)
{
    if (a.x != b.x)
        return a.x < b.x ? -1 : 1;
    if (a.y != b.y)
        return a.y < b.y ? -1 : 1;
    return a.z < b.z ? -1 : a.z > b.z;
}

static int compare_corners(const void *a, const void *b)
{
    const corner *x = a, *y = b;
    int order = compare_positions(x->at, y->at);
    return order ? order : x->vertex < y->vertex ? -1 : x->vertex > y->vertex;
}

static int compare_edges(const void *a, const void *b)
{
    const edge *x = a, *y = b;
    if (x->low != y->low)
        return x->low < y->low ? -1 : 1;
    if (x->high != y->high)
        return x->high < y->high ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

static void weld_vertices(work *w)
{
    uint32_t count = w->m->vertex_count;
    for (uint32_t i = 0; i < count; i++)
        w->corners[i] = (corner){w->m->positions[i], i};
    qsort(w->corners, count, sizeof *w->corners, compare_corners);
    for (uint32_t i = 0; i < count; i++) {
        bool is_same = i > 0 && compare_positions(w->corners[i - 1].at, w->corners[i].at) == 0;
        uint32_t vertex = w->corners[i].vertex;
        w->welded[vertex] = is_same ? w->welded[w->corners[i - 1].vertex] : vertex;
    }
}

static void difference(vec3 a, vec3 b, double out[3])
{
    out[0] = (double)a.x - (double)b.x, out[1] = (double)a.y - (double)b.y, out[2] = (double)a.z - (double)b.z;
}

/* Returns whether two unit normals are parallel, whether they point the same way or opposite ways. */
static bool is_parallel(vec3 a, vec3 b, float angle_max)
{
    vec3 apart = vec3_sub(a, vec3_face_forward(b, a));
    return vec3_length_squared(apart) <= angle_max * angle_max;
}

/* Computes the normal and area of a triangle; both are zero where its vertices have other normals. */
static void measure(work *w, uint32_t triangle)
{
    const mesh *m = w->m;
    const uint32_t *index = m->indices + 3 * (size_t)triangle;
    double a[3], b[3];
    difference(m->positions[index[1]], m->positions[index[0]], a);
    difference(m->positions[index[2]], m->positions[index[0]], b);
    double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    w->normal[triangle] = (vec3){0.0f, 0.0f, 0.0f};
    w->area[triangle] = (float)(0.5 * length);
    if (!(w->area[triangle] > 0.0f))
        return;
    vec3 normal = {(float)(n[0] / length), (float)(n[1] / length), (float)(n[2] / length)};
    for (int k = 0; m->normals && k < 3; k++)
        if (!is_parallel(normal, m->normals[index[k]], VERTEX_ANGLE_MAX))
            return;
    w->normal[triangle] = normal;
}

static bool is_flat(const work *w, uint32_t triangle) { return vec3_length_squared(w->normal[triangle]) > 0.0f; }

static uint32_t find_root(uint32_t *root, uint32_t i)
{
    while (root[i] != i)
        i = root[i] = root[root[i]];
    return i;
}

static void join(work *w, uint32_t a, uint32_t b)
{
    uint32_t x = find_root(w->root, a), y = find_root(w->root, b);
    if (x < y)
        w->root[y] = x;
    else
        w->root[x] = y;
}

static void join_neighbors(work *w)
{
    size_t count = 0;
    for (uint32_t t = 0; t < w->m->triangle_count; t++)
        for (int k = 0; k < 3 && is_flat(w, t); k++) {
            uint32_t a = w->welded[w->m->indices[3 * (size_t)t + (size_t)k]];
            uint32_t b = w->welded[w->m->indices[3 * (size_t)t + (size_t)((k + 1) % 3)]];
            w->edges[count++] = (edge){a < b ? a : b, a < b ? b : a, t};
        }
    qsort(w->edges, count, sizeof *w->edges, compare_edges);
    for (size_t i = 1; i < count; i++)
        for (size_t k = i; k-- > 0 && i - k <= EDGE_NEIGHBORS_MAX;) {
            const edge *x = &w->edges[k], *y = &w->edges[i];
            if (x->low != y->low || x->high != y->high)
                break;
            if (is_parallel(w->normal[x->triangle], w->normal[y->triangle], FLAT_ANGLE_MAX))
                join(w, x->triangle, y->triangle);
        }
}

/* Patches get numbers in the order of their first triangles, which are their roots. */
static ag_status gather(work *w, double share_min, uint32_t *patch_of, flat_patch **out_patches, uint32_t *out_count)
{
    const mesh *m = w->m;
    uint32_t count = 0, kept = 0;
    double whole = 0.0;
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        whole += (double)w->area[t];
        patch_of[t] = FLAT_NO_PATCH;
        uint32_t root = find_root(w->root, t);
        if (is_flat(w, t))
            patch_of[t] = root == t ? count++ : patch_of[root];
    }
    flat_patch *patches = calloc((size_t)count + 1, sizeof *patches);
    vec3 *low = malloc(((size_t)count + 1) * sizeof *low), *high = malloc(((size_t)count + 1) * sizeof *high);
    bool *is_bent = calloc((size_t)count + 1, sizeof *is_bent);
    uint32_t *number = malloc(((size_t)count + 1) * sizeof *number);
    if (!patches || !low || !high || !is_bent || !number) {
        free(patches), free(low), free(high), free(is_bent), free(number);
        return AG_ERROR_MEMORY;
    }
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        uint32_t i = patch_of[t];
        if (i == FLAT_NO_PATCH)
            continue;
        flat_patch *p = &patches[i];
        bool is_first = p->area == 0.0f;
        if (is_first)
            *p = (flat_patch){.normal = w->normal[t], .largest_triangle = t};
        /* a finely cut cylinder turns little from edge to edge, but more in all */
        is_bent[i] = is_bent[i] || !is_parallel(p->normal, w->normal[t], FLAT_ANGLE_MAX);
        if (w->area[t] > w->area[p->largest_triangle])
            p->largest_triangle = t;
        p->area += w->area[t];
        for (int k = 0; k < 3; k++) {
            vec3 at = m->positions[m->indices[3 * (size_t)t + (size_t)k]];
            low[i] = is_first && k == 0 ? at : vec3_min(low[i], at);
            high[i] = is_first && k == 0 ? at : vec3_max(high[i], at);
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        bool is_kept = !is_bent[i] && (double)patches[i].area >= share_min * whole;
        number[i] = is_kept ? kept : FLAT_NO_PATCH;
        patches[i].extent = vec3_sub(high[i], low[i]);
        if (is_kept)
            patches[kept++] = patches[i];
    }
    for (uint32_t t = 0; t < m->triangle_count; t++)
        if (patch_of[t] != FLAT_NO_PATCH)
            patch_of[t] = number[patch_of[t]];
    free(low), free(high), free(is_bent), free(number);
    *out_patches = patches;
    *out_count = kept;
    return AG_OK;
}

ag_status flat_patches_find(const mesh *m, double share_min, uint32_t **out_patch_of_triangle, flat_patch **out_patches,
                            uint32_t *out_count)
{
    size_t triangles = m->triangle_count, vertices = m->vertex_count;
    work w = {.m = m,
              .welded = malloc((vertices + 1) * sizeof *w.welded),
              .root = malloc((triangles + 1) * sizeof *w.root),
              .normal = malloc((triangles + 1) * sizeof *w.normal),
              .area = malloc((triangles + 1) * sizeof *w.area),
              .corners = malloc((vertices + 1) * sizeof *w.corners),
              .edges = malloc((3 * triangles + 1) * sizeof *w.edges)};
    uint32_t *patch_of = malloc((triangles + 1) * sizeof *patch_of);
    ag_status status = AG_ERROR_MEMORY;
    if (w.welded && w.root && w.normal && w.area && w.corners && w.edges && patch_of) {
        for (uint32_t t = 0; t < m->triangle_count; t++) {
            w.root[t] = t;
            measure(&w, t);
        }
        weld_vertices(&w);
        join_neighbors(&w);
        status = gather(&w, share_min, patch_of, out_patches, out_count);
    }
    free(w.welded), free(w.root), free(w.normal), free(w.area), free(w.corners), free(w.edges);
    if (status == AG_OK)
        *out_patch_of_triangle = patch_of;
    else
        free(patch_of);
    return status;
}
