/* loop_subdivision.c: see loop_subdivision.h. Half-edge 3 t + c goes from corner c of triangle t to its next corner;
 * its twin is the one that goes back. Rests on: Loop 1987; Hoppe et al. 1994; Pharr, Jakob, Humphreys 2016, ch. 3.8.
 * Threads: any. */
#include "shape/loop_subdivision.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NONE UINT32_MAX

static const double PI = 3.14159265358979323846;

typedef struct level {
    size_t vertex_count, triangle_count;
    double *positions;
    uint32_t *indices;
    uint32_t *twins; /* per half-edge; NONE on the boundary */
    uint32_t *first; /* per vertex: an outgoing half-edge; on the boundary the one that all others lie to the left of */
} level;

static uint32_t next_of(uint32_t half_edge) { return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1; }
static uint32_t previous_of(uint32_t half_edge) { return half_edge % 3 == 0 ? half_edge + 2 : half_edge - 1; }

static void level_reset(level *l)
{
    free(l->positions);
    free(l->indices);
    free(l->twins);
    free(l->first);
    memset(l, 0, sizeof *l);
}

static bool level_allocate(size_t vertex_count, size_t triangle_count, level *out_level)
{
    level *l = out_level;
    l->vertex_count = vertex_count;
    l->triangle_count = triangle_count;
    l->positions = malloc((3 * vertex_count + 1) * sizeof *l->positions);
    l->indices = malloc((3 * triangle_count + 1) * sizeof *l->indices);
    l->twins = malloc((3 * triangle_count + 1) * sizeof *l->twins);
    l->first = malloc((vertex_count + 1) * sizeof *l->first);
    return l->positions && l->indices && l->twins && l->first;
}

/* --- the control mesh --- */

typedef struct edge {
    uint32_t low, high; /* vertices */
    uint32_t half_edge;
} edge;

static int compare_edges(const void *a, const void *b)
{
    const edge *x = a, *y = b;
    if (x->low != y->low)
        return x->low < y->low ? -1 : 1;
    if (x->high != y->high)
        return x->high < y->high ? -1 : 1;
    return (x->half_edge > y->half_edge) - (x->half_edge < y->half_edge);
}

/* Pairs the half-edges. names: the file's number of each vertex, for messages. */
static ag_status find_twins(level *l, const uint32_t *names, char *error, size_t error_size)
{
    size_t count = 3 * l->triangle_count;
    edge *edges = malloc((count + 1) * sizeof *edges);
    if (!edges)
        return AG_ERROR_MEMORY;
    for (size_t h = 0; h < count; h++) {
        uint32_t a = l->indices[h], b = l->indices[next_of((uint32_t)h)];
        edges[h] = (edge){a < b ? a : b, a < b ? b : a, (uint32_t)h};
        l->twins[h] = NONE;
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    ag_status status = AG_OK;
    for (size_t i = 0, end; i < count && status == AG_OK; i = end) {
        uint32_t low = edges[i].low, high = edges[i].high;
        for (end = i + 1; end < count && edges[end].low == low && edges[end].high == high; end++)
            continue;
        status = AG_ERROR_SCENE;
        if (low == high)
            snprintf(error, error_size, "triangle %u has vertex %u twice", edges[i].half_edge / 3, names[low]);
        else if (end - i > 2)
            snprintf(error, error_size,
                     "the edge between vertices %u and %u has %zu triangles: the mesh is not manifold", names[low],
                     names[high], end - i);
        else if (end - i == 2 && l->indices[edges[i].half_edge] == l->indices[edges[i + 1].half_edge])
            snprintf(
                error, error_size,
                "triangles %u and %u go the same way along the edge between vertices %u and %u: they are not turned "
                "alike",
                edges[i].half_edge / 3, edges[i + 1].half_edge / 3, names[low], names[high]);
        else
            status = AG_OK;
        if (status == AG_OK && end - i == 2) {
            l->twins[edges[i].half_edge] = edges[i + 1].half_edge;
            l->twins[edges[i + 1].half_edge] = edges[i].half_edge;
        }
    }
    free(edges);
    return status;
}

/* Returns the next outgoing half-edge counterclockwise; NONE at the boundary. */
static uint32_t turn_left(const level *l, uint32_t outgoing) { return l->twins[previous_of(outgoing)]; }

/* Finds every vertex's first half-edge, and checks that the triangles around it are one fan. */
static ag_status find_fans(level *l, const uint32_t *names, char *error, size_t error_size)
{
    size_t count = 3 * l->triangle_count;
    uint32_t *corner_counts = calloc(l->vertex_count + 1, sizeof *corner_counts);
    if (!corner_counts)
        return AG_ERROR_MEMORY;
    memset(l->first, 0xff, l->vertex_count * sizeof *l->first);
    for (uint32_t h = 0; h < count; h++) {
        uint32_t v = l->indices[h];
        corner_counts[v]++;
        if (l->first[v] == NONE || l->twins[h] == NONE)
            l->first[v] = h;
    }
    ag_status status = AG_OK;
    for (size_t v = 0; v < l->vertex_count && status == AG_OK; v++) {
        uint32_t seen = 0, h = l->first[v];
        do {
            seen++;
            h = turn_left(l, h);
        } while (h != NONE && h != l->first[v]);
        if (seen != corner_counts[v]) {
            snprintf(error, error_size, "the triangles around vertex %u are not one fan: the mesh is not manifold",
                     names[v]);
            status = AG_ERROR_SCENE;
        }
    }
    free(corner_counts);
    return status;
}

/* Makes the mesh as given, without the vertices that no triangle uses. */
static ag_status make_control_level(const double *positions, size_t vertex_count, const uint32_t *indices,
                                    size_t triangle_count, char *error, size_t error_size, level *out_level)
{
    uint32_t *numbers = malloc((vertex_count + 1) * sizeof *numbers), *names = NULL;
    ag_status status = AG_ERROR_MEMORY;
    size_t used = 0;
    if (!numbers)
        return AG_ERROR_MEMORY;
    memset(numbers, 0xff, vertex_count * sizeof *numbers);
    for (size_t i = 0; i < 3 * triangle_count; i++)
        numbers[indices[i]] = 0;
    for (size_t v = 0; v < vertex_count; v++)
        if (numbers[v] != NONE)
            numbers[v] = (uint32_t)used++;
    names = malloc((used + 1) * sizeof *names);
    if (names && level_allocate(used, triangle_count, out_level)) {
        for (size_t v = 0; v < vertex_count; v++)
            if (numbers[v] != NONE) {
                memcpy(out_level->positions + 3 * (size_t)numbers[v], positions + 3 * v, 3 * sizeof *positions);
                names[numbers[v]] = (uint32_t)v;
            }
        for (size_t i = 0; i < 3 * triangle_count; i++)
            out_level->indices[i] = numbers[indices[i]];
        status = find_twins(out_level, names, error, error_size);
        if (status == AG_OK)
            status = find_fans(out_level, names, error, error_size);
    }
    free(numbers);
    free(names);
    return status;
}

/* --- rings --- */

/* The neighbours of a vertex, counterclockwise; on the boundary from one end to the other. They are visited, not
 * stored: there may be any number of them. */
typedef struct ring_walk {
    const level *l;
    uint32_t outgoing; /* whose end is the next neighbour; NONE: only `last` is left, or nothing */
    uint32_t first, last;
} ring_walk;

static ring_walk ring_begin(const level *l, size_t v) { return (ring_walk){l, l->first[v], l->first[v], NONE}; }

static bool ring_next(ring_walk *walk, const double **out_position)
{
    const level *l = walk->l;
    uint32_t vertex = walk->last;
    if (walk->outgoing != NONE) {
        uint32_t h = walk->outgoing, following = turn_left(l, h);
        vertex = l->indices[next_of(h)];
        walk->outgoing = following == walk->first ? NONE : following;
        walk->last = following == NONE ? l->indices[previous_of(h)] : NONE;
    } else {
        walk->last = NONE;
    }
    if (vertex == NONE)
        return false;
    *out_position = l->positions + 3 * (size_t)vertex;
    return true;
}

static bool is_boundary(const level *l, size_t v) { return l->twins[l->first[v]] == NONE; }

static void add_scaled(double *sum, const double *p, double weight)
{
    for (int i = 0; i < 3; i++)
        sum[i] += weight * p[i];
}

typedef struct ring {
    int valence; /* neighbours */
    double sum[3];
    double ends[3]; /* the first and the last added */
} ring;

static ring summarise_ring(const level *l, size_t v)
{
    ring r = {0, {0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    ring_walk walk = ring_begin(l, v);
    const double *p, *last = NULL;
    while (ring_next(&walk, &p)) {
        if (r.valence++ == 0)
            add_scaled(r.ends, p, 1.0);
        add_scaled(r.sum, p, 1.0);
        last = p;
    }
    if (last)
        add_scaled(r.ends, last, 1.0);
    return r;
}

/* Warren's weight of each neighbour of an interior vertex. */
static double inner_weight(int valence) { return valence == 3 ? 3.0 / 16.0 : 3.0 / (8.0 * valence); }

/* Moves a vertex toward its ring: by one step of subdivision, or by all of them to the limit. */
static void smooth_vertex(const level *l, size_t v, bool to_limit, double out_position[3])
{
    ring r = summarise_ring(l, v);
    double own, each, p[3] = {0.0, 0.0, 0.0};
    if (is_boundary(l, v)) {
        /* a uniform cubic B-spline along the boundary */
        each = to_limit ? 1.0 / 6.0 : 1.0 / 8.0;
        own = 1.0 - 2.0 * each;
        add_scaled(p, r.ends, each);
    } else {
        each = inner_weight(r.valence);
        if (to_limit)
            each = 1.0 / (r.valence + 3.0 / (8.0 * each));
        own = 1.0 - r.valence * each;
        add_scaled(p, r.sum, each);
    }
    add_scaled(p, l->positions + 3 * v, own);
    memcpy(out_position, p, sizeof p);
}

/* Computes the limit surface's normal from the tangents along and across (Hoppe et al. 1994; on the boundary as in
 * Pharr et al.). */
static void limit_normal(const level *l, size_t v, double out_normal[3])
{
    double s[3] = {0.0, 0.0, 0.0}, t[3] = {0.0, 0.0, 0.0};
    const double *p, *own = l->positions + 3 * v;
    bool on_boundary = is_boundary(l, v);
    int n = summarise_ring(l, v).valence, k = 0;
    for (ring_walk walk = ring_begin(l, v); ring_next(&walk, &p); k++) {
        bool is_end = k == 0 || k == n - 1;
        if (!on_boundary) {
            add_scaled(s, p, cos(2.0 * PI * k / n));
            add_scaled(t, p, sin(2.0 * PI * k / n));
            continue;
        }
        if (is_end)
            add_scaled(s, p, k == 0 ? 1.0 : -1.0);
        double theta = PI / (n - 1), weight;
        switch (n) {
        case 2: weight = 1.0; break;
        case 3: weight = is_end ? 0.0 : 1.0; break;
        case 4: weight = is_end ? -1.0 : 2.0; break;
        default: weight = is_end ? -sin(theta) : (2.0 - 2.0 * cos(theta)) * sin(k * theta);
        }
        add_scaled(t, p, weight);
    }
    if (on_boundary && n <= 4)
        add_scaled(t, own, n == 3 ? -1.0 : -2.0);
    out_normal[0] = s[1] * t[2] - s[2] * t[1];
    out_normal[1] = s[2] * t[0] - s[0] * t[2];
    out_normal[2] = s[0] * t[1] - s[1] * t[0];
}

/* --- one step --- */

/* Numbers the edges, from `begin` on; returns the number behind the last. */
static uint32_t number_edges(const level *l, uint32_t begin, uint32_t *edge_vertices)
{
    for (uint32_t h = 0; h < 3 * l->triangle_count; h++)
        if (l->twins[h] == NONE || l->twins[h] > h)
            edge_vertices[h] = begin++;
        else
            edge_vertices[h] = edge_vertices[l->twins[h]];
    return begin;
}

static void place_vertices(const level *coarse, const uint32_t *edge_vertices, level *fine)
{
    for (size_t v = 0; v < coarse->vertex_count; v++)
        smooth_vertex(coarse, v, false, fine->positions + 3 * v);
    for (uint32_t h = 0; h < 3 * coarse->triangle_count; h++) {
        uint32_t twin = coarse->twins[h];
        if (twin != NONE && twin < h)
            continue;
        double *p = fine->positions + 3 * (size_t)edge_vertices[h], along = twin == NONE ? 0.5 : 0.375;
        p[0] = p[1] = p[2] = 0.0;
        add_scaled(p, coarse->positions + 3 * (size_t)coarse->indices[h], along);
        add_scaled(p, coarse->positions + 3 * (size_t)coarse->indices[next_of(h)], along);
        if (twin != NONE) {
            add_scaled(p, coarse->positions + 3 * (size_t)coarse->indices[previous_of(h)], 0.125);
            add_scaled(p, coarse->positions + 3 * (size_t)coarse->indices[previous_of(twin)], 0.125);
        }
    }
}

/* Triangle t becomes 4 t + c at its corners c and 4 t + 3 between them. At a corner the half-edges are: away along the
 * old edge, across to the middle triangle, and back along the old edge before it. */
static void connect_triangles(const level *coarse, const uint32_t *edge_vertices, level *fine)
{
    for (uint32_t t = 0; t < coarse->triangle_count; t++)
        for (uint32_t c = 0; c < 3; c++) {
            uint32_t h = 3 * t + c, before = previous_of(h), corner = 3 * (4 * t + c), middle = 3 * (4 * t + 3);
            fine->indices[corner] = coarse->indices[h];
            fine->indices[corner + 1] = edge_vertices[h];
            fine->indices[corner + 2] = edge_vertices[before];
            fine->indices[middle + c] = edge_vertices[h];
            uint32_t inner = middle + (c + 2) % 3;
            fine->twins[corner + 1] = inner;
            fine->twins[inner] = corner + 1;
            /* an old edge's first half meets the twin's second half, at the triangle of the twin's far corner */
            uint32_t twin = coarse->twins[h], far = twin == NONE ? 0 : next_of(twin);
            fine->twins[corner] = twin == NONE ? NONE : 3 * (4 * (far / 3) + far % 3) + 2;
            twin = coarse->twins[before];
            fine->twins[corner + 2] = twin == NONE ? NONE : 3 * (4 * (twin / 3) + twin % 3);
        }
    memset(fine->first, 0xff, fine->vertex_count * sizeof *fine->first);
    for (uint32_t h = 0; h < 3 * fine->triangle_count; h++)
        if (fine->first[fine->indices[h]] == NONE || fine->twins[h] == NONE)
            fine->first[fine->indices[h]] = h;
}

static ag_status refine(const level *coarse, level *out_fine)
{
    uint32_t *edge_vertices = malloc((3 * coarse->triangle_count + 1) * sizeof *edge_vertices);
    if (!edge_vertices)
        return AG_ERROR_MEMORY;
    size_t vertex_count = number_edges(coarse, (uint32_t)coarse->vertex_count, edge_vertices);
    bool is_allocated = level_allocate(vertex_count, 4 * coarse->triangle_count, out_fine);
    if (is_allocated) {
        place_vertices(coarse, edge_vertices, out_fine);
        connect_triangles(coarse, edge_vertices, out_fine);
    }
    free(edge_vertices);
    return is_allocated ? AG_OK : AG_ERROR_MEMORY;
}

static ag_status push_to_limit(level *l, loop_mesh *out_mesh)
{
    out_mesh->positions = malloc((3 * l->vertex_count + 1) * sizeof(double));
    out_mesh->normals = malloc((3 * l->vertex_count + 1) * sizeof(double));
    if (!out_mesh->positions || !out_mesh->normals)
        return AG_ERROR_MEMORY;
    for (size_t v = 0; v < l->vertex_count; v++) {
        smooth_vertex(l, v, true, out_mesh->positions + 3 * v);
        limit_normal(l, v, out_mesh->normals + 3 * v);
    }
    out_mesh->vertex_count = l->vertex_count;
    out_mesh->triangle_count = l->triangle_count;
    out_mesh->indices = l->indices;
    l->indices = NULL;
    return AG_OK;
}

ag_status loop_subdivide(const double *positions, size_t vertex_count, const uint32_t *indices, size_t triangle_count,
                         int levels, char *error, size_t error_size, loop_mesh *out_mesh)
{
    memset(out_mesh, 0, sizeof *out_mesh);
    if (levels < 0 || levels > 14 || triangle_count > LOOP_MAX_TRIANGLES >> (2 * levels))
        return AG_ERROR_ARGUMENT;
    level current = {.vertex_count = 0};
    ag_status status =
        make_control_level(positions, vertex_count, indices, triangle_count, error, error_size, &current);
    for (int i = 0; i < levels && status == AG_OK; i++) {
        level fine = {.vertex_count = 0};
        status = refine(&current, &fine);
        level_reset(&current);
        current = fine;
    }
    if (status == AG_OK)
        status = push_to_limit(&current, out_mesh);
    level_reset(&current);
    if (status != AG_OK)
        loop_mesh_reset(out_mesh);
    return status;
}

void loop_mesh_reset(loop_mesh *m)
{
    free(m->positions);
    free(m->normals);
    free(m->indices);
    memset(m, 0, sizeof *m);
}
