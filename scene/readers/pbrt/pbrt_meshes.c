/* pbrt_meshes.c: Shape "trianglemesh" of a pbrt-v4 scene, and what all meshes have in common.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Shapes"; and for which side is outside on Pharr, Jakob,
 * Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 6.5.
 * Flow: pbrt_shapes, pbrt_patches, pbrt_ply, pbrt_subdivision -> [here] -> scene.shapes. Threads: one per scene. */
#include "pbrt/pbrt_meshes.h"

#include "shape/borrowed_arrays.h"
#include "shape/mesh_motion.h"

#include <stdlib.h>
#include <string.h>

static bool has_area(const vec3 *positions, const uint32_t *corners)
{
    vec3 a = positions[corners[0]], b = positions[corners[1]], c = positions[corners[2]];
    double u[3] = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z};
    double v[3] = {(double)c.x - a.x, (double)c.y - a.y, (double)c.z - a.z};
    return u[1] * v[2] - u[2] * v[1] != 0.0 || u[2] * v[0] - u[0] * v[2] != 0.0 || u[0] * v[1] - u[1] * v[0] != 0.0;
}

/* Returns a normal of unit length in world space, on the outside that the file and ReverseOrientation give; zero stays
 * zero, and the triangle's own normal is then used. A mirror does not turn normals over (as in pbrt). */
static vec3 world_normal(const transform *t, bool reverse, vec3 n)
{
    double w[3], square = 0.0, largest = (double)vec3_max_abs(n);
    if (!(largest > 0.0))
        return (vec3){0.0f, 0.0f, 0.0f};
    for (int i = 0; i < 3; i++) {
        w[i] = (t->inverse[0][i] * (double)n.x + t->inverse[1][i] * (double)n.y + t->inverse[2][i] * (double)n.z) /
               largest;
        square += w[i] * w[i];
    }
    double inverse = (reverse ? -1.0 : 1.0) / sqrt(square);
    vec3 unit = {(float)(w[0] * inverse), (float)(w[1] * inverse), (float)(w[2] * inverse)};
    return vec3_is_finite(unit) ? unit : (vec3){0.0f, 0.0f, 0.0f};
}

/* Converts a direction of any length, also one that a float cannot hold. */
static vec3 float_direction(const double *n)
{
    double largest = double_max(fabs(n[0]), double_max(fabs(n[1]), fabs(n[2])));
    if (!(largest > 0.0))
        return (vec3){0.0f, 0.0f, 0.0f};
    return (vec3){(float)(n[0] / largest), (float)(n[1] / largest), (float)(n[2] / largest)};
}

static bool allocate_arrays(const pbrt_mesh *source, mesh *m)
{
    const size_t count = mesh_value_count(m);
    m->positions = calloc(count + 1, sizeof *m->positions); /* room for Embree's 16 byte reads */
    if (source->normals)
        m->normals = malloc(count * sizeof *m->normals);
    if (source->uvs)
        m->uvs = malloc(source->vertex_count * sizeof *m->uvs);
    if (source->tangents)
        m->tangents = malloc(count * sizeof *m->tangents);
    return m->positions && (!source->normals || m->normals) && (!source->uvs || m->uvs) &&
           (!source->tangents || m->tangents);
}

static void copy_vertices(const pbrt_mesh *source, mesh *m)
{
    const size_t count = mesh_value_count(m);
    for (size_t i = 0; i < count; i++) {
        const double *p = source->positions + 3 * i;
        m->positions[i] = (vec3){(float)p[0], (float)p[1], (float)p[2]};
    }
    if (m->normals)
        for (size_t i = 0; i < count; i++)
            m->normals[i] = float_direction(source->normals + 3 * i);
    if (m->uvs)
        for (size_t i = 0; i < source->vertex_count; i++)
            m->uvs[i] = (vec2){(float)source->uvs[2 * i], (float)source->uvs[2 * i + 1]};
    if (m->tangents)
        for (size_t i = 0; i < count; i++)
            m->tangents[i] = float_direction(source->tangents + 3 * i);
}

/* Transforms vertices from object to world space; returns false where one is out of reach. */
static bool transform_vertices(const pbrt_state *state, mesh *m)
{
    const transform *t = &state->world_from_object;
    const size_t count = mesh_value_count(m);
    for (size_t i = 0; i < count; i++) {
        vec3 world = transform_point(t, m->positions[i]);
        if (!(vec3_max_abs(world) <= PBRT_MAX_COORDINATE) || !vec3_is_finite(world))
            return false;
        if (!(m->borrowed & MESH_BORROWS_POSITIONS)) /* they stay as they are */
            m->positions[i] = world;
    }
    if (m->normals)
        for (size_t i = 0; i < count; i++)
            m->normals[i] = world_normal(t, state->reverse_orientation, m->normals[i]);
    if (m->tangents)
        for (size_t i = 0; i < count; i++) {
            vec3 along = transform_vector(t, m->tangents[i]);
            m->tangents[i] = vec3_is_finite(along) ? along : (vec3){0.0f, 0.0f, 0.0f};
        }
    return true;
}

/* Returns whether a triangle has an area in any of the sets. */
static bool has_area_ever(const mesh *m, const uint32_t *corners)
{
    bool has_any = false;
    for (size_t k = 0; k <= m->motion_segments && !has_any; k++)
        has_any = has_area(m->positions + k * m->vertex_count, corners);
    return has_any;
}

/* Moves the triangles that have an area together; returns how many they are. out_late: how many of them have none at
 * the opening of the shutter. */
static size_t drop_degenerate(const mesh *m, size_t *out_late)
{
    uint32_t *indices = m->indices;
    size_t kept = 0;
    *out_late = 0;
    for (size_t i = 0; i < m->triangle_count; i++)
        if (has_area_ever(m, indices + 3 * i)) {
            if (kept < i) /* borrowed indices are not written to */
                memmove(indices + 3 * kept, indices + 3 * i, 3 * sizeof *indices);
            *out_late += m->motion_segments > 0 && !has_area(m->positions, indices + 3 * i);
            kept++;
        }
    return kept;
}

/* Returns whether vertices move that have to stand still, as those of lamps do; if so it is told. */
static bool has_to_stand_still(pbrt_parser *parser, const parameter_list *list, const mesh *m)
{
    const pbrt_state *state = &parser->state;
    const bool shines = state->area_light.is_set && !state->has_no_surface && !parser->is_material_unknown;
    if (m->motion_segments == 0 || !shines)
        return false;
    log_at_once(parser->log, AG_LOG_WARNING, list->where, "deforming light",
                "a shape with an area light whose vertices move is not supported: it stands as it does at the opening "
                "of the shutter");
    return true;
}

/* Adds a mesh that is in world space, less the triangles without area, whose arrays are its alone; takes it. */
static ag_status add_world_mesh(pbrt_parser *parser, const parameter_list *list, shape *s, size_t dropped,
                                bool expects_degenerate)
{
    mesh *m = &s->as.mesh;
    size_t count = m->triangle_count + dropped, late, kept = drop_degenerate(m, &late);
    if (kept == 0 && count > 0 && !expects_degenerate)
        log_at(parser->log, AG_LOG_WARNING, list->where,
               "Shape \"%s\": %zu of %zu triangles have no area and are left out", list->name, count, count);
    else if (kept < count && !expects_degenerate) /* scanned and cut models have some in each mesh */
        log_at_once(parser->log, AG_LOG_WARNING, list->where, "no area",
                    "Shape \"%s\": %zu of %zu triangles have no area and are left out, as are any others", list->name,
                    count - kept, count);
    if (kept == 0) {
        log_at(parser->log, AG_LOG_WARNING, list->where, "Shape \"%s\" is empty and is left out%s", list->name,
               parser->state.area_light.is_set ? ", and its area light with it" : "");
        mesh_reset(m);
        return AG_OK;
    }
    if (late > 0 && !parser->state.area_light.is_set) /* a lamp stands still, and an interface has no photons */
        log_at(parser->log, AG_LOG_WARNING, list->where,
               "Shape \"%s\": %zu of %zu triangles have no area when the shutter opens: photons are kept as they lie "
               "then, so that no indirect light of the photon map is on them",
               list->name, late, kept);
    m->triangle_count = (uint32_t)kept;
    return pbrt_add_shape(parser, list, s);
}

ag_status pbrt_add_object_mesh(pbrt_parser *parser, const parameter_list *list, mesh *object_mesh, size_t dropped,
                               bool expects_degenerate)
{
    const pbrt_state *state = &parser->state;
    shape s = shape_make(SHAPE_MESH);
    s.flip_normal = state->reverse_orientation != transform_swaps_handedness(&state->world_from_object);
    s.as.mesh = *object_mesh;
    if (!transform_vertices(state, &s.as.mesh)) {
        mesh_reset(&s.as.mesh);
        return pbrt_refuse(parser, list, "P", "a vertex lies beyond 1e18 units in world space");
    }
    if (has_to_stand_still(parser, list, &s.as.mesh))
        s.as.mesh.motion_segments = 0;
    return add_world_mesh(parser, list, &s, dropped, expects_degenerate);
}

ag_status pbrt_add_made_mesh(pbrt_parser *parser, const parameter_list *list)
{
    shape s, still = *parser->made_mesh;
    const mesh *m = &still.as.mesh;
    const bool stands_still = has_to_stand_still(parser, list, m);
    bool all_have_area = true;
    if (stands_still)
        still.as.mesh.motion_segments = 0;
    for (size_t i = 0; i < m->triangle_count && stands_still && all_have_area; i++)
        all_have_area = has_area(m->positions, m->indices + 3 * i);
    if (!all_have_area) {
        AG_TRY(shape_copy(&still, NULL, &s));
        return add_world_mesh(parser, list, &s, 0, false);
    }
    AG_TRY(shape_share(parser->made_mesh, &s));
    if (stands_still) {
        s.as.mesh.motion_segments = 0;
        borrowed_arrays_note(&s); /* its positions end with the first set */
    }
    return pbrt_add_shape(parser, list, &s);
}

ag_status pbrt_add_mesh(pbrt_parser *parser, const parameter_list *list, const pbrt_mesh *source)
{
    mesh m = {.indices = source->indices, .motion_segments = source->motion_segments};
    if (source->vertex_count >= UINT32_MAX / 4 || source->triangle_count >= UINT32_MAX / 4) {
        mesh_reset(&m);
        return pbrt_refuse(parser, list, "P", "the mesh is too large");
    }
    m.vertex_count = (uint32_t)source->vertex_count;
    m.triangle_count = (uint32_t)source->triangle_count;
    if (!allocate_arrays(source, &m)) {
        mesh_reset(&m);
        return AG_ERROR_MEMORY;
    }
    copy_vertices(source, &m);
    return pbrt_add_object_mesh(parser, list, &m, 0, source->expects_degenerate);
}

/* Returns whether there is as much of vertex data as there are positions; else it is dropped, as in pbrt. */
static bool has_count(const pbrt_parser *parser, const parameter_list *list, const char *name, size_t count,
                      size_t expected)
{
    if (count != expected)
        log_at(parser->log, AG_LOG_WARNING, parameter_list_find(list, name)->where,
               "Shape \"%s\": \"%s\" should have %zu numbers as \"P\" goes, but has %zu, and is ignored", list->name,
               name, expected, count);
    return count == expected;
}

/* Reads vertex data other than the positions. */
static ag_status read_vertex_data(pbrt_parser *parser, parameter_list *list, const char *name, parameter_type type,
                                  size_t expected, const double **out_values)
{
    size_t count;
    AG_TRY(parameter_get_numbers(list, parser->log, name, type, out_values, &count));
    if (*out_values && !has_count(parser, list, name, count, expected))
        *out_values = NULL;
    if (count == 0)
        *out_values = NULL;
    return AG_OK;
}

bool pbrt_has_motion_steps(const char *type)
{
    return strcmp(type, "trianglemesh") == 0 || strcmp(type, "loopsubdiv") == 0 || strcmp(type, "curve") == 0;
}

ag_status pbrt_read_motion_steps(pbrt_parser *parser, parameter_list *list, size_t *in_out_vertex_count,
                                 uint32_t *out_segments)
{
    int64_t steps = 1;
    AG_TRY(parameter_get_int(list, parser->log, "motionsteps", &steps));
    if (steps < 1 || steps > MESH_STEPS_MAX)
        return pbrt_refuse(parser, list, "motionsteps", "\"motionsteps\" should be from 1 to %d", MESH_STEPS_MAX);
    if (*in_out_vertex_count % (size_t)steps != 0)
        return pbrt_refuse(parser, list, "P", "\"P\" has %zu points, which is no multiple of the %d of \"motionsteps\"",
                           *in_out_vertex_count, (int)steps);
    *in_out_vertex_count /= (size_t)steps;
    *out_segments = (uint32_t)steps - 1;
    return AG_OK;
}

static ag_status convert_indices(pbrt_parser *parser, const parameter_list *list, const double *numbers, size_t count,
                                 size_t vertex_count, uint32_t *out_indices)
{
    for (size_t i = 0; i < count; i++) {
        if (!(numbers[i] >= 0.0 && numbers[i] < (double)vertex_count))
            return pbrt_refuse(parser, list, "indices",
                               "index %.0f (value %zu of \"indices\") is out of range, there are %zu vertices",
                               numbers[i], i + 1, vertex_count);
        out_indices[i] = (uint32_t)numbers[i];
    }
    return AG_OK;
}

ag_status pbrt_read_mesh_arrays(pbrt_parser *parser, parameter_list *list, size_t corners, pbrt_mesh *out_mesh,
                                size_t *out_index_count)
{
    const double *numbers, *unused;
    size_t number_count, position_count, unused_count;
    memset(out_mesh, 0, sizeof *out_mesh);
    AG_TRY(parameter_get_numbers(list, parser->log, "P", PARAMETER_POINT3, &out_mesh->positions, &position_count));
    if (!parameter_list_find(list, "P"))
        return pbrt_refuse(parser, list, "P", "\"point3 P\" is missing");
    size_t vertex_count = position_count / 3, numbers_of_all = 3 * vertex_count;
    if (corners == 3)
        AG_TRY(pbrt_read_motion_steps(parser, list, &vertex_count, &out_mesh->motion_segments));
    out_mesh->vertex_count = vertex_count;
    AG_TRY(read_vertex_data(parser, list, "N", PARAMETER_NORMAL, numbers_of_all, &out_mesh->normals));
    AG_TRY(read_vertex_data(parser, list, "uv", PARAMETER_POINT2, 2 * vertex_count, &out_mesh->uvs));
    if (corners == 3) /* patches have none */
        AG_TRY(read_vertex_data(parser, list, "S", PARAMETER_VECTOR3, numbers_of_all, &out_mesh->tangents));
    /* face numbers serve Ptex only */
    AG_TRY(parameter_get_numbers(list, parser->log, "faceIndices", PARAMETER_INTEGER, &unused, &unused_count));
    AG_TRY(parameter_get_numbers(list, parser->log, "indices", PARAMETER_INTEGER, &numbers, &number_count));
    bool has_indices = parameter_list_find(list, "indices") != NULL;
    if (!has_indices && vertex_count != 0 && vertex_count != corners)
        return pbrt_refuse(parser, list, "P",
                           "\"integer indices\" is missing (of %zu vertices; only %zu can do without)", vertex_count,
                           corners);
    if (number_count % corners != 0)
        return pbrt_refuse(parser, list, "indices", "\"indices\" has %zu values, which is no multiple of %zu",
                           number_count, corners);
    size_t count = *out_index_count = has_indices ? number_count : vertex_count;
    out_mesh->indices = malloc((count ? count : 1) * sizeof *out_mesh->indices);
    if (!out_mesh->indices)
        return AG_ERROR_MEMORY;
    ag_status status = AG_OK;
    if (has_indices)
        status = convert_indices(parser, list, numbers, count, vertex_count, out_mesh->indices);
    else
        for (size_t i = 0; i < count; i++)
            out_mesh->indices[i] = (uint32_t)i;
    if (status != AG_OK) {
        free(out_mesh->indices);
        out_mesh->indices = NULL;
    }
    return status;
}

/* --- borrowed arrays --- */

/* Returns whether the transform leaves every bit of the numbers as it is: even the identity turns -0 into 0. */
static bool stays_as_it_is(const transform *t, const float *numbers, size_t count)
{
    const transform identity = transform_identity();
    if (memcmp(t->m, identity.m, sizeof t->m) != 0)
        return false;
    for (size_t i = 0; i < count; i++)
        if (numbers[i] == 0.0f && signbit(numbers[i]))
            return false;
    return true;
}

static ag_status borrow_positions(const pbrt_parser *parser, const pbrt_borrowed *from, mesh *m)
{
    const size_t count = mesh_value_count(m);
    if (stays_as_it_is(&parser->state.world_from_object, from->positions, 3 * count)) {
        m->positions = (vec3 *)(uintptr_t)from->positions; /* nobody writes there */
        m->borrowed |= MESH_BORROWS_POSITIONS;
        return AG_OK;
    }
    m->positions = calloc(count + 1, sizeof *m->positions);
    if (!m->positions)
        return AG_ERROR_MEMORY;
    memcpy(m->positions, from->positions, count * sizeof *m->positions);
    return AG_OK;
}

/* Borrows the indices, once the positions are there, which tell whether triangles are to be left out. */
static ag_status borrow_indices(pbrt_parser *parser, const parameter_list *list, const pbrt_borrowed *from, mesh *m)
{
    bool all_have_area = true;
    for (size_t i = 0; i < from->index_count; i++)
        if (from->indices[i] < 0 || (size_t)from->indices[i] >= m->vertex_count)
            return pbrt_refuse(parser, list, "indices",
                               "index %d (value %zu of \"indices\") is out of range, there are %zu vertices",
                               (int)from->indices[i], i + 1, (size_t)m->vertex_count);
    m->indices = (uint32_t *)(uintptr_t)from->indices; /* never written while borrowed */
    m->borrowed |= MESH_BORROWS_INDICES;
    for (size_t i = 0; i < m->triangle_count && all_have_area; i++) {
        vec3 corners[3];
        static const uint32_t OWN[3] = {0, 1, 2};
        all_have_area = false;
        for (size_t step = 0; step <= m->motion_segments && !all_have_area; step++) {
            const vec3 *positions = m->positions + step * m->vertex_count;
            for (size_t k = 0; k < 3; k++)
                corners[k] = transform_point(&parser->state.world_from_object, positions[m->indices[3 * i + k]]);
            all_have_area = has_area(corners, OWN);
        }
    }
    if (all_have_area)
        return AG_OK;
    m->borrowed &= ~(unsigned)MESH_BORROWS_INDICES;
    m->indices = malloc(from->index_count * sizeof *m->indices);
    if (!m->indices)
        return AG_ERROR_MEMORY;
    memcpy(m->indices, from->indices, from->index_count * sizeof *m->indices);
    return AG_OK;
}

/* Copies directions, since they are made unit. */
static ag_status copy_directions(const double *numbers, size_t count, vec3 **out)
{
    if (!numbers)
        return AG_OK;
    *out = malloc(count * sizeof **out);
    for (size_t i = 0; *out && i < count; i++)
        (*out)[i] = float_direction(numbers + 3 * i);
    return *out ? AG_OK : AG_ERROR_MEMORY;
}

static ag_status read_borrowed(pbrt_parser *parser, parameter_list *list, const pbrt_borrowed *from, mesh *m)
{
    static const char *const NAMES[] = {"P", "uv", "indices", "faceIndices"};
    static const parameter_type TYPES[] = {PARAMETER_POINT3, PARAMETER_POINT2, PARAMETER_INTEGER, PARAMETER_INTEGER};
    const double *normals, *tangents, *unused;
    size_t unused_count, vertex_count = from->vertex_count;
    for (int i = 0; i < 4; i++) /* marks them as known */
        AG_TRY(parameter_get_numbers(list, parser->log, NAMES[i], TYPES[i], &unused, &unused_count));
    AG_TRY(pbrt_read_motion_steps(parser, list, &vertex_count, &m->motion_segments));
    AG_TRY(read_vertex_data(parser, list, "N", PARAMETER_NORMAL, 3 * from->vertex_count, &normals));
    AG_TRY(read_vertex_data(parser, list, "S", PARAMETER_VECTOR3, 3 * from->vertex_count, &tangents));
    parameter_list_warn_unused(list, parser->log);
    if (vertex_count >= UINT32_MAX / 4 || from->index_count / 3 >= UINT32_MAX / 4)
        return pbrt_refuse(parser, list, "P", "the mesh is too large");
    if (from->index_count % 3 != 0)
        return pbrt_refuse(parser, list, "indices", "\"indices\" has %zu values, which is no multiple of 3",
                           from->index_count);
    m->vertex_count = (uint32_t)vertex_count;
    m->triangle_count = (uint32_t)(from->index_count / 3);
    if (from->uvs && has_count(parser, list, "uv", from->uv_count, 2 * vertex_count)) {
        m->uvs = (vec2 *)(uintptr_t)from->uvs;
        m->borrowed |= MESH_BORROWS_UVS;
    }
    AG_TRY(copy_directions(normals, from->vertex_count, &m->normals));
    AG_TRY(copy_directions(tangents, from->vertex_count, &m->tangents));
    AG_TRY(borrow_positions(parser, from, m));
    return borrow_indices(parser, list, from, m);
}

static ag_status add_borrowed_mesh(pbrt_parser *parser, parameter_list *list)
{
    mesh m = {0};
    const ag_status status = read_borrowed(parser, list, parser->borrowed, &m);
    if (status == AG_OK)
        return pbrt_add_object_mesh(parser, list, &m, 0, false);
    mesh_reset(&m);
    return status;
}

ag_status pbrt_triangle_mesh(pbrt_parser *parser, parameter_list *list)
{
    if (parser->borrowed)
        return add_borrowed_mesh(parser, list);
    pbrt_mesh source;
    size_t index_count;
    AG_TRY(pbrt_read_mesh_arrays(parser, list, 3, &source, &index_count));
    source.triangle_count = index_count / 3;
    parameter_list_warn_unused(list, parser->log);
    return pbrt_add_mesh(parser, list, &source);
}
