/* scene_extent.c: see scene_extent.h.
 * Threads: read-only. */
#include "scene_extent.h"

#include "scene.h"

#include <stdlib.h>
#include <string.h>

/* --- bounds --- */

typedef struct box {
    vec3 low, high;
} box;

static const box NOTHING = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void include(box *b, const box *other)
{
    b->low = vec3_min(b->low, other->low);
    b->high = vec3_max(b->high, other->high);
}

/* Around the box that the map makes of b: its middle, and how far its half reaches along each axis. */
static box transform_box(const affine *a, const box *b)
{
    const double middle[3] = {0.5 * ((double)b->low.x + (double)b->high.x),
                              0.5 * ((double)b->low.y + (double)b->high.y),
                              0.5 * ((double)b->low.z + (double)b->high.z)};
    const double half[3] = {(double)b->high.x - middle[0], (double)b->high.y - middle[1],
                            (double)b->high.z - middle[2]};
    float low[3], high[3];
    for (int i = 0; i < 3; i++) {
        double at = (double)a->m[i][3], reach = 0.0;
        for (int j = 0; j < 3; j++) {
            at += (double)a->m[i][j] * middle[j];
            reach += fabs((double)a->m[i][j]) * half[j];
        }
        low[i] = (float)(at - reach);
        high[i] = (float)(at + reach);
    }
    return (box){{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

ag_status scene_find_bounds(const scene *s, bool (*is_wanted)(const scene *s, const shape *item), vec3 *out_min,
                            vec3 *out_max)
{
    box all = NOTHING, *of_objects = NULL;
    if (s->object_count > 0) {
        of_objects = malloc(s->object_count * sizeof *of_objects);
        if (!of_objects)
            return AG_ERROR_MEMORY;
        for (uint32_t i = 0; i < s->object_count; i++)
            of_objects[i] = NOTHING;
    }
    for (uint32_t i = 0; i < s->shape_count; i++) {
        const shape *item = &s->shapes[i];
        box b;
        if (is_wanted && !is_wanted(s, item))
            continue;
        shape_bounds(item, &b.low, &b.high);
        include(item->object_index == SCENE_NO_OBJECT ? &all : &of_objects[item->object_index], &b);
    }
    for (uint32_t i = 0; i < s->instance_count; i++) {
        box placed = of_objects[s->instances[i].object_index];
        scene_place_bounds(s, i, &placed.low, &placed.high);
        include(&all, &placed);
    }
    free(of_objects);
    *out_min = all.low;
    *out_max = all.high;
    return AG_OK;
}

void scene_find_object_bounds(const scene *s, uint32_t object_index, vec3 *out_min, vec3 *out_max)
{
    const scene_object *object = &s->objects[object_index];
    box all = NOTHING;
    for (uint32_t i = 0; i < object->shape_count; i++) {
        box b;
        shape_bounds(&s->shapes[s->object_shapes[object->first_shape + i]], &b.low, &b.high);
        include(&all, &b);
    }
    *out_min = all.low;
    *out_max = all.high;
}

void scene_place_bounds(const scene *s, uint32_t instance_index, vec3 *in_out_min, vec3 *in_out_max)
{
    const scene_instance *at = &s->instances[instance_index];
    const box own = {*in_out_min, *in_out_max};
    box all = NOTHING;
    for (uint32_t k = 0; own.low.x <= own.high.x && k < at->step_count; k++) {
        box placed = transform_box(&s->instance_steps[at->first_step + k], &own);
        include(&all, &placed);
    }
    *in_out_min = all.low;
    *in_out_max = all.high;
}

/* The first instance of each object and the next one of each instance, SCENE_NO_INSTANCE at the end; to be freed. False
 * when out of memory. */
static bool chain_instances(const scene *s, uint32_t **out_first, uint32_t **out_next)
{
    uint32_t *first = malloc(((size_t)s->object_count + 1) * sizeof *first),
             *next = malloc(((size_t)s->instance_count + 1) * sizeof *next);
    if (!first || !next) {
        free(first);
        free(next);
        return false;
    }
    for (uint32_t i = 0; i < s->object_count; i++)
        first[i] = SCENE_NO_INSTANCE;
    for (uint32_t i = s->instance_count; i-- > 0;) {
        uint32_t object = s->instances[i].object_index;
        next[i] = first[object];
        first[object] = i;
    }
    *out_first = first;
    *out_next = next;
    return true;
}

/* --- detail --- */

/* Giants are this many octaves larger than all else, at least; and so is the scene than the ball around that. */
enum { GIANT_OCTAVES = 4, OCTAVES = 320, OCTAVE_OF_ONE = 160 };

/* How many things there are by the octave of their size, and a box around those below an octave. */
typedef struct size_census {
    uint32_t count[OCTAVES];
    int below;
    box small;
} size_census;

/* -1: it has none. */
static int octave_of(float size)
{
    if (!(size > 0.0f))
        return -1;
    int octave = ilogbf(size) + OCTAVE_OF_ONE;
    return octave < 0 ? 0 : octave >= OCTAVES ? OCTAVES - 1 : octave;
}

static float size_of(const box *b) { return vec3_length(vec3_sub(b->high, b->low)); }

static void take_in(size_census *c, const box *b, int octave)
{
    if (octave < 0)
        return;
    c->count[octave]++;
    if (octave < c->below)
        include(&c->small, b);
}

static box triangle_box(const mesh *m, uint32_t triangle)
{
    const uint32_t *index = m->indices + 3 * (size_t)triangle;
    vec3 p = m->positions[index[0]], q = m->positions[index[1]], r = m->positions[index[2]];
    return (box){vec3_min(p, vec3_min(q, r)), vec3_max(p, vec3_max(q, r))};
}

/* Adds a shape; of a mesh that is not small itself, its triangles one by one. */
static void take_in_shape(size_census *c, const shape *item, float small)
{
    box b;
    shape_bounds(item, &b.low, &b.high);
    if (item->kind != SHAPE_MESH || size_of(&b) <= small) {
        take_in(c, &b, octave_of(size_of(&b)));
        return;
    }
    for (uint32_t i = 0; i < item->as.mesh.triangle_count; i++) {
        b = triangle_box(&item->as.mesh, i);
        take_in(c, &b, octave_of(size_of(&b)));
    }
}

/* The boxes around a mesh's triangles of each octave: many instances of many triangles would take minutes one by
 * one. */
static void sort_triangles(const mesh *m, box by_octave[OCTAVES])
{
    for (int i = 0; i < OCTAVES; i++)
        by_octave[i] = NOTHING;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        box b = triangle_box(m, i);
        int octave = octave_of(size_of(&b));
        if (octave >= 0)
            include(&by_octave[octave], &b);
    }
}

/* A shape of an object at all its instances, a chain; a mesh that is not small there by the octaves of its triangles.
 * by_octave: room for them. */
static void take_in_instances(const scene *s, size_census *c, const shape *item, uint32_t first, const uint32_t *next,
                              float small, box by_octave[OCTAVES])
{
    bool is_sorted = false;
    box own;
    shape_bounds(item, &own.low, &own.high);
    for (uint32_t k = first; k != SCENE_NO_INSTANCE; k = next[k]) {
        const affine *a = &s->instance_steps[s->instances[k].first_step];
        box placed = transform_box(a, &own);
        float size = size_of(&placed), scale = size / size_of(&own);
        if (item->kind != SHAPE_MESH || size <= small) {
            take_in(c, &placed, octave_of(size));
            continue;
        }
        if (!is_sorted)
            sort_triangles(&item->as.mesh, by_octave);
        is_sorted = true;
        for (int i = 0; i < OCTAVES; i++)
            if (by_octave[i].low.x <= by_octave[i].high.x) {
                placed = transform_box(a, &by_octave[i]);
                take_in(c, &placed, octave_of(ldexpf(1.5f, i - OCTAVE_OF_ONE) * scale));
            }
    }
}

/* first, next: of chain_instances. */
static void take_in_all(const scene *s, size_census *c, const uint32_t *first, const uint32_t *next, float small,
                        box by_octave[OCTAVES])
{
    for (uint32_t i = 0; i < s->shape_count; i++) {
        const shape *item = &s->shapes[i];
        if (item->object_index == SCENE_NO_OBJECT)
            take_in_shape(c, item, small);
        else
            take_in_instances(s, c, item, first[item->object_index], next, small, by_octave);
    }
}

ag_status scene_find_detail(const scene *s, vec3 *out_center, float *out_radius)
{
    *out_center = (vec3){0.0f, 0.0f, 0.0f};
    *out_radius = 0.0f;
    float whole = vec3_length(vec3_sub(s->bounds_max, s->bounds_min)), small = ldexpf(whole, -2 * GIANT_OCTAVES);
    size_census *c = calloc(1, sizeof *c);
    box *by_octave = malloc(OCTAVES * sizeof *by_octave);
    uint32_t *first = NULL, *next = NULL;
    if (!c || !by_octave || !chain_instances(s, &first, &next)) {
        free(c);
        free(by_octave);
        return AG_ERROR_MEMORY;
    }
    c->small = NOTHING;
    take_in_all(s, c, first, next, small, by_octave);
    int octave = OCTAVES - 1, empty = 0;
    while (octave >= 0 && c->count[octave] == 0)
        octave--;
    for (; octave >= 0 && empty < GIANT_OCTAVES; octave--)
        empty = c->count[octave] == 0 ? empty + 1 : 0;
    while (octave >= 0 && c->count[octave] == 0)
        octave--;
    if (octave >= 0 && empty >= GIANT_OCTAVES) {
        c->below = octave + 1;
        take_in_all(s, c, first, next, small, by_octave);
        float radius = 0.5f * vec3_length(vec3_sub(c->small.high, c->small.low));
        if (ldexpf(radius, GIANT_OCTAVES) <= 0.5f * whole) {
            *out_center = vec3_scale(vec3_add(c->small.low, c->small.high), 0.5f);
            *out_radius = radius * 1.0001f;
        }
    }
    free(first);
    free(next);
    free(by_octave);
    free(c);
    return AG_OK;
}

/* --- area --- */

/* An object's area vectors, summed over those of like direction: each direction and its opposite by its largest
 * coordinate and, in its plane, by one of 4 x 4 squares. */
enum { SQUARES = 4, DIRECTIONS = 3 * SQUARES * SQUARES, SAMPLES_ACROSS_QUADRIC = 16 };

typedef struct area_vectors {
    double sums[DIRECTIONS][3];
    double area;      /* of the object */
    double area_seen; /* the lengths of the sums: curved surfaces lose a few hundredths */
} area_vectors;

static void add_area(area_vectors *v, const double a[3])
{
    int largest = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(a[i]) > fabs(a[largest]))
            largest = i;
    if (a[largest] == 0.0)
        return;
    double sign = a[largest] < 0.0 ? -1.0 : 1.0;
    int bin = largest;
    for (int k = 1; k < 3; k++) {
        int square = (int)((a[(largest + k) % 3] / a[largest] + 1.0) * (0.5 * SQUARES));
        bin = bin * SQUARES + (square < SQUARES ? square : SQUARES - 1);
    }
    for (int i = 0; i < 3; i++)
        v->sums[bin][i] += sign * a[i];
}

static void add_shape(area_vectors *v, const shape *item)
{
    v->area += (double)item->area;
    if (item->kind != SHAPE_MESH) {
        const int n = SAMPLES_ACROSS_QUADRIC;
        for (int i = 0; i < n * n; i++) {
            vec2 u = {((float)(i % n) + 0.5f) / (float)n, ((float)(i / n) + 0.5f) / (float)n};
            surface_sample at = shape_sample_area(item, u);
            double share = 1.0 / ((double)at.pdf_area * n * n);
            add_area(v, (const double[]){(double)at.geometric_normal.x * share, (double)at.geometric_normal.y * share,
                                         (double)at.geometric_normal.z * share});
        }
        return;
    }
    const mesh *m = &item->as.mesh;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const uint32_t *index = m->indices + 3 * (size_t)i;
        vec3 p = m->positions[index[0]], q = m->positions[index[1]], r = m->positions[index[2]];
        double u[3] = {(double)q.x - p.x, (double)q.y - p.y, (double)q.z - p.z};
        double w[3] = {(double)r.x - p.x, (double)r.y - p.y, (double)r.z - p.z};
        add_area(v, (const double[]){0.5 * (u[1] * w[2] - u[2] * w[1]), 0.5 * (u[2] * w[0] - u[0] * w[2]),
                                     0.5 * (u[0] * w[1] - u[1] * w[0])});
    }
}

/* Interfaces have no light on them, curves no photons. */
static bool counts(const scene *s, const shape *item)
{
    return item->kind != SHAPE_CURVES && s->materials[item->material_index].kind != MATERIAL_INTERFACE;
}

static double length_of(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

static void gather_area_vectors(const scene *s, const scene_object *object, area_vectors *out)
{
    memset(out, 0, sizeof *out);
    for (uint32_t i = 0; i < object->shape_count; i++) {
        const shape *item = &s->shapes[s->object_shapes[object->first_shape + i]];
        if (counts(s, item))
            add_shape(out, item);
    }
    for (int i = 0; i < DIRECTIONS; i++)
        out->area_seen += length_of(out->sums[i]);
}

/* Area vectors go over by the cofactors. */
static double placed_area(const area_vectors *v, const affine *a)
{
    double c[3][3], sum = 0.0;
    affine_cofactors(a, c);
    for (int i = 0; i < DIRECTIONS; i++) {
        const double *n = v->sums[i];
        double w[3];
        for (int k = 0; k < 3; k++)
            w[k] = c[k][0] * n[0] + c[k][1] * n[1] + c[k][2] * n[2];
        sum += length_of(w);
    }
    return v->area_seen > 0.0 ? sum * (v->area / v->area_seen) : 0.0;
}

ag_status scene_find_area(const scene *s, float *out_area)
{
    float area = 0.0f;
    double of_instances = 0.0;
    for (uint32_t i = 0; i < s->shape_count; i++)
        if (s->shapes[i].object_index == SCENE_NO_OBJECT && counts(s, &s->shapes[i]))
            area += s->shapes[i].area;
    *out_area = area;
    if (s->instance_count == 0)
        return AG_OK;
    uint32_t *first, *next;
    if (!chain_instances(s, &first, &next))
        return AG_ERROR_MEMORY;
    for (uint32_t i = 0; i < s->object_count; i++) {
        area_vectors vectors;
        if (first[i] == SCENE_NO_INSTANCE)
            continue;
        gather_area_vectors(s, &s->objects[i], &vectors);
        for (uint32_t k = first[i]; k != SCENE_NO_INSTANCE; k = next[k])
            of_instances += placed_area(&vectors, &s->instance_steps[s->instances[k].first_step]);
    }
    free(first);
    free(next);
    *out_area = area + (float)of_instances;
    return AG_OK;
}
