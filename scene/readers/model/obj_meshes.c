/* obj_meshes.c: the faces of an OBJ file as one mesh for each material, in which corners that agree in all are one
 * vertex. Flow: obj_file -> [here], polygon -> importer. Threads: one per scene. */
#include "model/obj_private.h"
#include "model/polygon.h"
#include "status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Numbers of vertices that agree */

typedef struct corner_table {
    obj_corner *keys; /* [count] in the order in which they came */
    uint32_t *slots;  /* [capacity] numbers of keys, OBJ_NONE where free */
    size_t count, key_capacity, capacity;
} corner_table;

static void corner_table_reset(corner_table *t)
{
    free(t->keys);
    free(t->slots);
    memset(t, 0, sizeof *t);
}

static size_t hash_corner(obj_corner c)
{
    uint64_t h = c.position * UINT64_C(0x9e3779b97f4a7c15);
    h = (h ^ (h >> 32) ^ c.uv) * UINT64_C(0xbf58476d1ce4e5b9);
    h = (h ^ (h >> 29) ^ c.normal) * UINT64_C(0x94d049bb133111eb);
    return (size_t)(h ^ (h >> 31));
}

static uint32_t *corner_slot(const corner_table *t, obj_corner c)
{
    size_t i = hash_corner(c) & (t->capacity - 1);
    while (t->slots[i] != OBJ_NONE && memcmp(&t->keys[t->slots[i]], &c, sizeof c) != 0)
        i = (i + 1) & (t->capacity - 1);
    return &t->slots[i];
}

static bool corner_table_enlarge(corner_table *t)
{
    size_t capacity = t->capacity ? 2 * t->capacity : 256;
    uint32_t *slots = malloc(capacity * sizeof *slots);
    if (!slots)
        return false;
    memset(slots, 0xff, capacity * sizeof *slots);
    free(t->slots);
    t->slots = slots;
    t->capacity = capacity;
    for (size_t k = 0; k < t->count; k++)
        *corner_slot(t, t->keys[k]) = (uint32_t)k;
    return true;
}

/* Returns the number of the corner, a new one where it has none yet. */
static bool corner_table_number(corner_table *t, obj_corner c, uint32_t *out_number)
{
    if (2 * t->count >= t->capacity && !corner_table_enlarge(t))
        return false;
    uint32_t *slot = corner_slot(t, c);
    if (*slot == OBJ_NONE) {
        if (!obj_grow(&t->keys, t->count, &t->key_capacity, sizeof *t->keys))
            return false;
        t->keys[t->count] = c;
        *slot = (uint32_t)t->count++;
    }
    *out_number = *slot;
    return true;
}

/* Smoothing groups */

/* Gives corners without normals, in smoothing groups, the mean of their group's faces, by their areas. */
static ag_status smooth_normals(obj *o)
{
    corner_table table = {0};
    vec3 *polygon = NULL;
    double(*sums)[3] = NULL;
    size_t polygon_capacity = 0, sum_capacity = 0;
    ag_status status = AG_OK;
    for (size_t k = 0; k < o->face_count && status == AG_OK; k++) {
        const obj_face *f = &o->faces[k];
        if (f->group == 0)
            continue;
        obj_corner *c = o->corners + f->first_corner;
        double area[3];
        for (uint32_t i = 0; i < f->corner_count && status == AG_OK; i++)
            if (!obj_grow(&polygon, i, &polygon_capacity, sizeof *polygon))
                status = AG_ERROR_MEMORY;
            else
                polygon[i] = o->positions[c[i].position];
        if (status != AG_OK)
            break;
        polygon_area_vector(polygon, f->corner_count, area);
        for (uint32_t i = 0; i < f->corner_count && status == AG_OK; i++) {
            uint32_t number;
            if (c[i].normal != OBJ_NONE)
                continue;
            size_t before = table.count;
            if (!corner_table_number(&table, (obj_corner){c[i].position, OBJ_NONE, f->group}, &number) ||
                !obj_grow(&sums, number, &sum_capacity, sizeof *sums)) {
                status = AG_ERROR_MEMORY;
                break;
            }
            if (table.count > before)
                memset(sums[number], 0, sizeof *sums);
            for (int axis = 0; axis < 3; axis++)
                sums[number][axis] += area[axis];
            c[i].normal = OBJ_FIRST_SMOOTH + number;
        }
    }
    o->smooth = malloc((table.count + 1) * sizeof *o->smooth);
    if (!o->smooth)
        status = AG_ERROR_MEMORY;
    for (size_t k = 0; k < table.count && status == AG_OK; k++) {
        const double *s = sums[k];
        double largest = double_max(fabs(s[0]), double_max(fabs(s[1]), fabs(s[2]))),
               scale = largest > 0.0 ? 1.0 / largest : 0.0;
        o->smooth[k] = vec3_make((float)(s[0] * scale), (float)(s[1] * scale), (float)(s[2] * scale));
    }
    o->smooth_count = table.count;
    corner_table_reset(&table);
    free(polygon);
    free(sums);
    return status;
}

/* Meshes */

static ag_status cut_faces(obj *o, const obj_material *u, corner_table *table, uint32_t *out_indices)
{
    vec3 *polygon = malloc(u->corner_count * sizeof *polygon);
    uint32_t *scratch = malloc(u->corner_count * sizeof *scratch), *numbers = malloc(u->corner_count * sizeof *numbers);
    ag_status status = polygon && scratch && numbers ? AG_OK : AG_ERROR_MEMORY;
    for (size_t k = 0; k < u->face_count && status == AG_OK; k++) {
        const obj_face *f = &o->faces[u->first_face + k];
        for (uint32_t i = 0; i < f->corner_count && status == AG_OK; i++) {
            obj_corner c = o->corners[f->first_corner + i];
            polygon[i] = o->positions[c.position];
            if (!corner_table_number(table, c, &numbers[i]))
                status = AG_ERROR_MEMORY;
        }
        if (status != AG_OK)
            break;
        polygon_triangulate(polygon, f->corner_count, scratch, out_indices);
        for (uint32_t i = 0; i < 3 * (f->corner_count - 2); i++)
            out_indices[i] = numbers[out_indices[i]];
        out_indices += 3 * (f->corner_count - 2);
    }
    free(polygon);
    free(scratch);
    free(numbers);
    return status;
}

static ag_status fill_vertices(const obj *o, const corner_table *table, mesh *m)
{
    bool has_uvs = false, has_normals = false;
    for (size_t k = 0; k < table->count; k++) {
        has_uvs = has_uvs || table->keys[k].uv != OBJ_NONE;
        has_normals = has_normals || table->keys[k].normal != OBJ_NONE;
    }
    m->vertex_count = (uint32_t)table->count;
    m->positions = calloc(table->count + 1, sizeof *m->positions); /* room for Embree's 16 byte reads */
    m->uvs = has_uvs ? calloc(table->count, sizeof *m->uvs) : NULL;
    m->normals = has_normals ? calloc(table->count, sizeof *m->normals) : NULL;
    if (!m->positions || (has_uvs && !m->uvs) || (has_normals && !m->normals))
        return AG_ERROR_MEMORY;
    for (size_t k = 0; k < table->count; k++) {
        obj_corner c = table->keys[k];
        m->positions[k] = o->positions[c.position];
        if (c.uv != OBJ_NONE)
            m->uvs[k] = o->uvs[c.uv];
        if (c.normal != OBJ_NONE)
            m->normals[k] =
                c.normal >= OBJ_FIRST_SMOOTH ? o->smooth[c.normal - OBJ_FIRST_SMOOTH] : o->normals[c.normal];
    }
    return AG_OK;
}

static ag_status add_material(obj *o, const obj_material *u, import_surface *out_surface)
{
    uint32_t index;
    import_material plain = mtl_material_make(u->name);
    if (name_table_find(&o->library.names, u->name, &index))
        return importer_add_material(&o->to, &o->library.materials[index], out_surface);
    char key[IMPORT_NAME_SIZE + 16];
    snprintf(key, sizeof key, "material:%s", u->name);
    if (u->name[0])
        log_at_once(o->to.log, AG_LOG_WARNING, o->to.where, key, "material \"%s\" is not defined: grey stands in",
                    u->name);
    return importer_add_material(&o->to, &plain, out_surface);
}

static ag_status add_mesh(obj *o, const obj_material *u)
{
    import_surface surface;
    corner_table table = {0};
    mesh m = {.triangle_count = (uint32_t)u->triangle_count};
    transform identity = transform_identity();
    ag_status status = add_material(o, u, &surface);
    m.indices = malloc(3 * u->triangle_count * sizeof *m.indices);
    if (status == AG_OK && !m.indices)
        status = AG_ERROR_MEMORY;
    if (status == AG_OK)
        status = cut_faces(o, u, &table, m.indices);
    if (status == AG_OK)
        status = fill_vertices(o, &table, &m);
    corner_table_reset(&table);
    if (status == AG_OK)
        return importer_add_mesh(&o->to, u->name, &m, &identity, &surface);
    free(m.positions);
    free(m.uvs);
    free(m.normals);
    free(m.indices);
    return status;
}

/* Brings the faces of each material together, in their order. */
static ag_status sort_faces(obj *o)
{
    obj_face *sorted = malloc((o->face_count + 1) * sizeof *sorted);
    size_t *next = calloc(o->used_count + 1, sizeof *next);
    if (!sorted || !next) {
        free(sorted);
        free(next);
        return AG_ERROR_MEMORY;
    }
    for (size_t k = 0, first = 0; k < o->used_count; first += o->used[k++].face_count)
        o->used[k].first_face = next[k] = first;
    for (size_t k = 0; k < o->face_count; k++)
        sorted[next[o->faces[k].material]++] = o->faces[k];
    free(o->faces);
    free(next);
    o->faces = sorted;
    return AG_OK;
}

/* Heights of bumps are measured on the diagonal of all that is there. */
static void find_bump_unit(obj *o)
{
    vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t k = 0; k < o->position_count; k++) {
        low = vec3_min(low, o->positions[k]);
        high = vec3_max(high, o->positions[k]);
    }
    o->to.bump_unit = importer_bump_unit(low, high);
}

ag_status obj_add_meshes(obj *o)
{
    AG_TRY(smooth_normals(o));
    AG_TRY(sort_faces(o));
    find_bump_unit(o);
    for (size_t k = 0; k < o->used_count; k++) {
        if (run_is_cancelled(o->to.run))
            return AG_CANCELLED;
        if (o->used[k].face_count > 0)
            AG_TRY(add_mesh(o, &o->used[k]));
    }
    return AG_OK;
}
