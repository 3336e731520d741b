/* gltf_meshes.c: primitives become shapes in world space, and lights where their material shines.
 * Rests on: Khronos, "glTF 2.0 Specification", 2021, 3.7.2 (meshes), 3.7.4 (a mirroring node turns triangles over).
 * Flow: gltf_nodes -> [here] -> scene.shapes, scene.lights. Threads: one per scene. */
#include "gltf_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A node's matrix and what normals need of it. */
typedef struct placement {
    const gltf_matrix *matrix;
    double normal[3][3]; /* cofactors, so that a flattening one will do; of a mirroring one with the sign changed */
    bool is_mirror;
} placement;

static placement placement_of(const gltf_matrix *matrix)
{
    placement p = {.matrix = matrix};
    double determinant = 0.0;
    for (int i = 0; i < 3; i++) {
        const double *a = matrix->m[(i + 1) % 3], *b = matrix->m[(i + 2) % 3];
        for (int k = 0; k < 3; k++)
            p.normal[i][k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    }
    for (int k = 0; k < 3; k++)
        determinant += matrix->m[0][k] * p.normal[0][k];
    p.is_mirror = determinant < 0.0;
    for (int i = 0; p.is_mirror && i < 9; i++)
        p.normal[i / 3][i % 3] = -p.normal[i / 3][i % 3];
    return p;
}

static vec3 place_point(const placement *p, const float *v)
{
    double world[3];
    for (int i = 0; i < 3; i++) {
        const double *m = p->matrix->m[i];
        world[i] = m[0] * (double)v[0] + m[1] * (double)v[1] + m[2] * (double)v[2] + m[3];
    }
    return vec3_make((float)world[0], (float)world[1], (float)world[2]);
}

/* Zero where there is none: the triangle's own normal is then used. */
static vec3 place_normal(const placement *p, const float *v)
{
    double world[3], square = 0.0;
    for (int i = 0; i < 3; i++) {
        const double *m = p->normal[i];
        world[i] = m[0] * (double)v[0] + m[1] * (double)v[1] + m[2] * (double)v[2];
        square += world[i] * world[i];
    }
    if (!(square > 0.0 && isfinite(square)))
        return vec3_make(0.0f, 0.0f, 0.0f);
    double inverse = 1.0 / sqrt(square);
    return vec3_make((float)(world[0] * inverse), (float)(world[1] * inverse), (float)(world[2] * inverse));
}

/* The primitive's attributes. */
typedef struct attributes {
    gltf_value at; /* primitive.attributes */
    gltf_accessor positions, normals, uvs;
    bool has_normals, has_uvs;
} attributes;

static ag_status open_attribute(gltf_reader *r, const gltf_value *at, const char *name, int components_min,
                                int components_max, bool *out_is_there, gltf_accessor *out_accessor)
{
    uint32_t index = GLTF_NONE;
    gltf_value v = gltf_member(at, name);
    GLTF_TRY(gltf_get_index(r, at, name, GLTF_ACCESSORS, &index));
    *out_is_there = index != GLTF_NONE;
    return *out_is_there ? gltf_accessor_open(r, &v, index, components_min, components_max, out_accessor) : AG_OK;
}

static ag_status open_vertex_data(gltf_reader *r, const gltf_value *at, const char *name, int components,
                                  uint32_t vertex_count, bool *out_is_there, gltf_accessor *out_accessor)
{
    gltf_value v = gltf_member(at, name);
    GLTF_TRY(open_attribute(r, at, name, components, components, out_is_there, out_accessor));
    if (*out_is_there && out_accessor->count < vertex_count)
        return gltf_error(r, &v, "it has %u elements, but POSITION has %u", out_accessor->count, vertex_count);
    return AG_OK;
}

/* Colours of vertices are not supported; white ones change nothing. */
static ag_status warn_colors(gltf_reader *r, const gltf_value *at)
{
    gltf_accessor colors;
    bool is_there;
    float c[16];
    gltf_value v = gltf_member(at, "COLOR_0");
    GLTF_TRY(open_attribute(r, at, "COLOR_0", 3, 4, &is_there, &colors));
    for (uint32_t i = 0; is_there && i < colors.count; i++) {
        gltf_accessor_get(&colors, i, c);
        if (c[0] != 1.0f || c[1] != 1.0f || c[2] != 1.0f) {
            gltf_warn_once(r, &v, "COLOR_0", "colours of vertices are not supported, and ignored");
            break;
        }
    }
    return AG_OK;
}

static ag_status open_attributes(gltf_reader *r, const gltf_value *primitive, const gltf_material *m, attributes *a)
{
    char name[32];
    bool is_there;
    GLTF_TRY(gltf_require(r, primitive, "attributes"));
    GLTF_TRY(gltf_get_object(r, primitive, "attributes", &a->at));
    GLTF_TRY(open_attribute(r, &a->at, "POSITION", 3, 3, &is_there, &a->positions));
    if (!is_there) {
        gltf_warn_once(r, &a->at, "POSITION", "there is no POSITION, and so nothing to see");
        a->positions.count = 0;
        return AG_OK;
    }
    GLTF_TRY(open_vertex_data(r, &a->at, "NORMAL", 3, a->positions.count, &a->has_normals, &a->normals));
    snprintf(name, sizeof name, "TEXCOORD_%u", m->uv_set == GLTF_NONE ? 0 : m->uv_set);
    GLTF_TRY(open_vertex_data(r, &a->at, name, 2, a->positions.count, &a->has_uvs, &a->uvs));
    if (m->uv_set != GLTF_NONE && !a->has_uvs)
        gltf_warn_once(r, &a->at, "TEXCOORD", "the material's textures need %s, which is missing: it is 0 everywhere",
                       name);
    return warn_colors(r, &a->at);
}

/* Numbers the vertices that the triangles use from 0, in their order, and gives each one's number in the file: many
 * primitives may share long arrays, each a small part of them. */
static ag_status number_vertices(gltf_triangles *t, uint32_t **out_file_numbers, uint32_t *out_count)
{
    size_t corner_count = 3 * (size_t)t->count;
    uint32_t low = UINT32_MAX, high = 0, count = 0;
    for (size_t i = 0; i < corner_count; i++) {
        low = t->indices[i] < low ? t->indices[i] : low;
        high = t->indices[i] > high ? t->indices[i] : high;
    }
    size_t range = (size_t)high - low + 1;
    uint32_t *numbers = calloc(range, sizeof *numbers), *file_numbers = malloc(range * sizeof *file_numbers);
    if (numbers && file_numbers) {
        for (size_t i = 0; i < corner_count; i++)
            numbers[t->indices[i] - low] = 1;
        for (size_t i = 0; i < range; i++)
            if (numbers[i]) {
                file_numbers[count] = low + (uint32_t)i;
                numbers[i] = count++;
            }
        for (size_t i = 0; i < corner_count; i++)
            t->indices[i] = numbers[t->indices[i] - low];
    }
    free(numbers);
    *out_file_numbers = file_numbers;
    *out_count = count;
    return count > 0 ? AG_OK : AG_ERROR_MEMORY;
}

static void fill_normal_and_uv(const attributes *a, const placement *p, uint32_t from, uint32_t to, mesh *m)
{
    float v[16];
    if (m->normals) {
        gltf_accessor_get(&a->normals, from, v);
        m->normals[to] = place_normal(p, v);
    }
    if (m->uvs && a->has_uvs) {
        gltf_accessor_get(&a->uvs, from, v);
        bool is_good = isfinite(v[0]) && isfinite(v[1]);
        m->uvs[to] = (vec2){is_good ? v[0] : 0.0f, is_good ? 1.0f - v[1] : 0.0f}; /* ours goes up the picture */
    }
}

static ag_status fill_vertices(gltf_reader *r, const attributes *a, const placement *p, const uint32_t *file_numbers,
                               bool needs_uvs, mesh *m)
{
    size_t count = m->vertex_count;
    m->positions = calloc(count + 1, sizeof *m->positions); /* room for Embree's 16 byte reads */
    m->normals = a->has_normals ? malloc(count * sizeof *m->normals) : NULL;
    m->uvs = a->has_uvs || needs_uvs ? calloc(count, sizeof *m->uvs) : NULL;
    if (!m->positions || (a->has_normals && !m->normals) || ((a->has_uvs || needs_uvs) && !m->uvs))
        return AG_ERROR_MEMORY;
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        float v[16];
        gltf_accessor_get(&a->positions, file_numbers[i], v);
        m->positions[i] = place_point(p, v);
        if (!((double)vec3_max_abs(m->positions[i]) <= GLTF_MAX_COORDINATE) || !vec3_is_finite(m->positions[i])) {
            gltf_value at = gltf_member(&a->at, "POSITION");
            return gltf_error(r, &at, "vertex %u is not finite, or beyond 1e18 units in world space", file_numbers[i]);
        }
        fill_normal_and_uv(a, p, file_numbers[i], i, m);
    }
    return AG_OK;
}

static bool has_area(const mesh *m, const uint32_t *corners)
{
    vec3 a = m->positions[corners[0]], b = m->positions[corners[1]], c = m->positions[corners[2]];
    double u[3] = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z};
    double v[3] = {(double)c.x - a.x, (double)c.y - a.y, (double)c.z - a.z};
    return u[1] * v[2] - u[2] * v[1] != 0.0 || u[2] * v[0] - u[0] * v[2] != 0.0 || u[0] * v[1] - u[1] * v[0] != 0.0;
}

/* Triangles without area cannot be seen, nor sampled. */
static void drop_degenerate(gltf_reader *r, bool is_strip, mesh *m)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const uint32_t *corners = m->indices + 3 * (size_t)i;
        if (has_area(m, corners))
            memmove(m->indices + 3 * (size_t)kept++, corners, 3 * sizeof *corners);
    }
    r->triangles_read += m->triangle_count;
    r->triangles_dropped += is_strip ? 0 : m->triangle_count - kept;
    m->triangle_count = kept;
}

static void free_arrays(mesh *m)
{
    free(m->positions);
    free(m->normals);
    free(m->uvs);
    free(m->indices);
}

/* The mesh's arrays become the scene's. */
static ag_status add_shape(gltf_reader *r, const mesh *m, bool is_mirror, const gltf_material *from)
{
    uint32_t shape_index, light_index;
    shape s = shape_make(SHAPE_MESH);
    s.as.mesh = *m;
    s.flip_normal = is_mirror;
    s.material_index = from->material_index;
    s.alpha = from->alpha;
    s.alpha_texture = from->alpha_texture;
    s.alpha_cutoff = from->alpha_cutoff;
    GLTF_TRY(scene_add_shape(r->scene, &s, &shape_index));
    if (rgb_is_black(from->radiance))
        return AG_OK;
    light l = light_make(LIGHT_AREA);
    l.shape_index = shape_index;
    l.radiance = from->radiance;
    l.radiance_texture = from->radiance_texture;
    l.two_sided = from->is_two_sided;
    return scene_add_light(r->scene, &l, &light_index);
}

static ag_status add_primitive(gltf_reader *r, const gltf_value *primitive, const placement *p)
{
    uint32_t material_index = GLTF_NONE, *file_numbers = NULL;
    const gltf_material *material_of;
    attributes a;
    gltf_triangles t;
    memset(&a, 0, sizeof a);
    GLTF_TRY(gltf_get_index(r, primitive, "material", GLTF_MATERIALS, &material_index));
    GLTF_TRY(gltf_material_find(r, material_index, &material_of));
    GLTF_TRY(open_attributes(r, primitive, material_of, &a));
    if (a.positions.count == 0)
        return AG_OK;
    GLTF_TRY(gltf_read_triangles(r, primitive, a.positions.count, &t));
    if (t.count == 0)
        return AG_OK;
    mesh m = {.indices = t.indices, .triangle_count = t.count};
    ag_status status = number_vertices(&t, &file_numbers, &m.vertex_count);
    if (!status)
        status = fill_vertices(r, &a, p, file_numbers, material_of->uv_set != GLTF_NONE, &m);
    free(file_numbers);
    if (!status)
        drop_degenerate(r, t.is_strip, &m);
    if (!status && m.triangle_count > 0)
        return add_shape(r, &m, p->is_mirror, material_of);
    free_arrays(&m);
    return status;
}

/* Morph targets are not supported; those without weight change nothing. */
static ag_status warn_weights(const gltf_reader *r, const gltf_value *mesh_value)
{
    gltf_value weights;
    GLTF_TRY(gltf_get_array(r, mesh_value, "weights", &weights));
    for (size_t i = 0; weights.json && i < json_array_size(weights.json); i++)
        if (json_number_value(json_array_get(weights.json, i)) != 0.0)
            gltf_warn_once(r, &weights, "weights", "morph targets are not supported, and ignored");
    return AG_OK;
}

ag_status gltf_add_mesh(gltf_reader *r, uint32_t mesh_index, const gltf_matrix *world_from_node)
{
    gltf_value at, primitives;
    placement p = placement_of(world_from_node);
    GLTF_TRY(gltf_get_item(r, GLTF_MESHES, mesh_index, &at));
    GLTF_TRY(gltf_require(r, &at, "primitives"));
    GLTF_TRY(gltf_get_array(r, &at, "primitives", &primitives));
    GLTF_TRY(warn_weights(r, &at));
    for (size_t i = 0; i < json_array_size(primitives.json); i++) {
        gltf_value primitive;
        if (run_is_cancelled(r->run))
            return AG_CANCELLED;
        GLTF_TRY(gltf_get_element(r, &primitives, i, &primitive));
        GLTF_TRY(add_primitive(r, &primitive, &p));
    }
    return AG_OK;
}
