/* gltf_vertices.c: a primitive's vertices in world space: attributes, morphed, then taken along by joints or by the
 * node. Rests on: Khronos, "glTF 2.0 Specification", 2021, 3.7.2.2 (morph targets), 3.7.3 (skins). Flow: gltf_meshes ->
 * [here] -> gltf_accessors, gltf_skins. Threads: one per scene. */
#include "gltf/gltf_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Opening */

static ag_status open_attribute(gltf_reader *r, const gltf_value *at, const char *name, int components_min,
                                int components_max, bool *out_is_there, gltf_accessor *out_accessor)
{
    uint32_t index = GLTF_NONE;
    gltf_value v = gltf_member(at, name);
    AG_TRY(gltf_get_index(r, at, name, GLTF_ACCESSORS, &index));
    *out_is_there = index != GLTF_NONE;
    return *out_is_there ? gltf_accessor_open(r, &v, index, components_min, components_max, out_accessor) : AG_OK;
}

/* One that has an element for each vertex. */
static ag_status open_vertex_data(gltf_reader *r, const gltf_value *at, const char *name, int components,
                                  uint32_t vertex_count, bool *out_is_there, gltf_accessor *out_accessor)
{
    gltf_value v = gltf_member(at, name);
    AG_TRY(open_attribute(r, at, name, components, components, out_is_there, out_accessor));
    if (*out_is_there && out_accessor->count < vertex_count)
        return gltf_error(r, &v, "it has %u elements, but POSITION has %u", out_accessor->count, vertex_count);
    return AG_OK;
}

/* Warns of colours of vertices, which are not supported; white ones change nothing. */
static ag_status warn_colors(gltf_reader *r, const gltf_value *at)
{
    gltf_accessor colors;
    bool is_there;
    float c[16];
    gltf_value v = gltf_member(at, "COLOR_0");
    AG_TRY(open_attribute(r, at, "COLOR_0", 3, 4, &is_there, &colors));
    for (uint32_t i = 0; is_there && i < colors.count; i++) {
        gltf_accessor_get(&colors, i, c);
        if (c[0] != 1.0f || c[1] != 1.0f || c[2] != 1.0f) {
            gltf_warn_once(r, &v, "COLOR_0", "colours of vertices are not supported, and ignored");
            break;
        }
    }
    return AG_OK;
}

/* The morph targets that have a weight. */
static ag_status open_morphs(gltf_reader *r, const gltf_value *primitive, gltf_vertices *v)
{
    gltf_value targets, weights = v->pose->weights;
    AG_TRY(gltf_get_array(r, primitive, "targets", &targets));
    size_t count = json_array_size(targets.json), weight_count = json_array_size(weights.json);
    if (count == 0 || weight_count == 0)
        return AG_OK;
    v->morphs = calloc(count, sizeof *v->morphs);
    if (!v->morphs)
        return AG_ERROR_MEMORY;
    for (size_t i = 0; i < count && i < weight_count; i++) {
        gltf_morph *m = &v->morphs[v->morph_count];
        gltf_value target;
        m->weight = json_number_value(json_array_get(weights.json, i));
        if (m->weight == 0.0)
            continue;
        AG_TRY(gltf_get_element(r, &targets, i, &target));
        AG_TRY(open_vertex_data(r, &target, "POSITION", 3, v->count, &m->has_positions, &m->positions));
        AG_TRY(open_vertex_data(r, &target, "NORMAL", 3, v->count, &m->has_normals, &m->normals));
        v->morph_count++;
    }
    return AG_OK;
}

static ag_status open_influences(gltf_reader *r, const gltf_value *at, gltf_vertices *v)
{
    for (int set = 0; v->pose->joint_count > 0 && set < GLTF_MAX_INFLUENCES; set++) {
        char joints[32], weights[32];
        bool has_joints, has_weights;
        snprintf(joints, sizeof joints, "JOINTS_%d", set);
        snprintf(weights, sizeof weights, "WEIGHTS_%d", set);
        AG_TRY(open_vertex_data(r, at, joints, 4, v->count, &has_joints, &v->joints[set]));
        AG_TRY(open_vertex_data(r, at, weights, 4, v->count, &has_weights, &v->weights[set]));
        if (!has_joints || !has_weights)
            break;
        v->influence_count++;
    }
    return AG_OK;
}

ag_status gltf_vertices_open(gltf_reader *r, const gltf_value *primitive, const gltf_value *attributes, uint32_t uv_set,
                             const gltf_pose *pose, gltf_vertices *out_vertices)
{
    gltf_vertices *v = out_vertices;
    char name[32];
    bool is_there;
    memset(v, 0, sizeof *v);
    v->attributes = attributes;
    v->pose = pose;
    v->needs_uvs = uv_set != GLTF_NONE;
    AG_TRY(open_attribute(r, attributes, "POSITION", 3, 3, &is_there, &v->positions));
    if (!is_there) {
        gltf_warn_once(r, attributes, "POSITION", "there is no POSITION, and so nothing to see");
        return AG_OK;
    }
    v->count = v->positions.count;
    AG_TRY(open_vertex_data(r, attributes, "NORMAL", 3, v->count, &v->has_normals, &v->normals));
    snprintf(name, sizeof name, "TEXCOORD_%u", v->needs_uvs ? uv_set : 0);
    AG_TRY(open_vertex_data(r, attributes, name, 2, v->count, &v->has_uvs, &v->uvs));
    if (v->needs_uvs && !v->has_uvs)
        gltf_warn_once(r, attributes, "TEXCOORD",
                       "the material's textures need %s, which is missing: it is 0 everywhere", name);
    AG_TRY(warn_colors(r, attributes));
    AG_TRY(open_morphs(r, primitive, v));
    return open_influences(r, attributes, v);
}

void gltf_vertices_close(gltf_vertices *v)
{
    free(v->morphs);
    v->morphs = NULL;
}

/* Placing */

bool gltf_matrix_cofactors(const gltf_matrix *matrix, double out_cofactors[3][3])
{
    double determinant = 0.0;
    for (int i = 0; i < 3; i++) {
        const double *a = matrix->m[(i + 1) % 3], *b = matrix->m[(i + 2) % 3];
        for (int k = 0; k < 3; k++)
            out_cofactors[i][k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    }
    for (int k = 0; k < 3; k++)
        determinant += matrix->m[0][k] * out_cofactors[0][k];
    for (int i = 0; determinant < 0.0 && i < 9; i++)
        out_cofactors[i / 3][i % 3] = -out_cofactors[i / 3][i % 3];
    return determinant < 0.0;
}

static vec3 point_to_world(const gltf_matrix *matrix, const double *v)
{
    double world[3];
    for (int i = 0; i < 3; i++) {
        const double *m = matrix->m[i];
        world[i] = m[0] * v[0] + m[1] * v[1] + m[2] * v[2] + m[3];
    }
    return vec3_make((float)world[0], (float)world[1], (float)world[2]);
}

/* By cofactors, so that a flattening matrix will do. Zero where there is none: the triangle's own normal is then
 * used. */
static vec3 normal_to_world(double cofactors[3][3], const double *v)
{
    double world[3], square = 0.0;
    for (int i = 0; i < 3; i++) {
        const double *m = cofactors[i];
        world[i] = m[0] * v[0] + m[1] * v[1] + m[2] * v[2];
        square += world[i] * world[i];
    }
    if (!(square > 0.0 && isfinite(square)))
        return vec3_make(0.0f, 0.0f, 0.0f);
    double inverse = 1.0 / sqrt(square);
    return vec3_make((float)(world[0] * inverse), (float)(world[1] * inverse), (float)(world[2] * inverse));
}

static void get_morphed(const gltf_vertices *v, uint32_t i, bool is_normal, double out[3])
{
    float values[16];
    gltf_accessor_get(is_normal ? &v->normals : &v->positions, i, values);
    for (int k = 0; k < 3; k++)
        out[k] = (double)values[k];
    for (size_t m = 0; m < v->morph_count; m++) {
        const gltf_morph *morph = &v->morphs[m];
        if (is_normal ? !morph->has_normals : !morph->has_positions)
            continue;
        gltf_accessor_get(is_normal ? &morph->normals : &morph->positions, i, values);
        for (int k = 0; k < 3; k++)
            out[k] += morph->weight * (double)values[k];
    }
}

/* The joints' matrices, weighted. */
static ag_status blend_joints(gltf_reader *r, const gltf_vertices *v, uint32_t i, gltf_matrix *out)
{
    double sum = 0.0;
    memset(out, 0, sizeof *out);
    for (int set = 0; set < v->influence_count; set++) {
        float joints[16], weights[16];
        gltf_accessor_get(&v->joints[set], i, joints);
        gltf_accessor_get(&v->weights[set], i, weights);
        for (int k = 0; k < 4; k++) {
            if (!(weights[k] > 0.0f && weights[k] <= 1e6f))
                continue;
            if (!(joints[k] >= 0.0f && joints[k] < (float)v->pose->joint_count))
                return gltf_error(r, v->attributes, "JOINTS_%d: vertex %u has joint %g, but the skin has %u", set, i,
                                  (double)joints[k], v->pose->joint_count);
            const gltf_matrix *joint = &v->pose->joints[(uint32_t)joints[k]];
            for (int e = 0; e < 12; e++)
                out->m[e / 4][e % 4] += (double)weights[k] * joint->m[e / 4][e % 4];
            sum += (double)weights[k];
        }
    }
    if (!(sum > 0.0)) { /* none has it: the first does */
        *out = v->pose->joints[0];
        return AG_OK;
    }
    for (int e = 0; e < 12; e++)
        out->m[e / 4][e % 4] /= sum;
    return AG_OK;
}

ag_status gltf_vertices_get(gltf_reader *r, const gltf_vertices *v, uint32_t i, vec3 *out_position, vec3 *out_normal,
                            vec2 *out_uv)
{
    gltf_matrix matrix = v->pose->world_from_mesh;
    double own[3];
    float values[16];
    if (v->influence_count > 0)
        AG_TRY(blend_joints(r, v, i, &matrix));
    get_morphed(v, i, false, own);
    *out_position = point_to_world(&matrix, own);
    if (!((double)vec3_max_abs(*out_position) <= GLTF_MAX_COORDINATE) || !vec3_is_finite(*out_position)) {
        gltf_value at = gltf_member(v->attributes, "POSITION");
        return gltf_error(r, &at, "vertex %u is not finite, or beyond 1e18 units in world space", i);
    }
    if (out_normal) {
        double cofactors[3][3];
        get_morphed(v, i, true, own);
        gltf_matrix_cofactors(&matrix, cofactors);
        *out_normal = normal_to_world(cofactors, own);
    }
    if (out_uv && v->has_uvs) {
        gltf_accessor_get(&v->uvs, i, values);
        bool is_good = isfinite(values[0]) && isfinite(values[1]);
        *out_uv = (vec2){is_good ? values[0] : 0.0f, is_good ? 1.0f - values[1] : 0.0f}; /* ours goes up the picture */
    }
    return AG_OK;
}
