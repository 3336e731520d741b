/* importer.c: see importer.h; here meshes, and the end. Threads: one per scene. */
#include "model/importer.h"

#include "import_defaults.h"
#include "status.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

ag_status importer_init(importer *i, run_context *run, const char *path, scene *out_scene)
{
    memset(i, 0, sizeof *i);
    i->run = run;
    i->log = run->log;
    i->scene = out_scene;
    i->where.file = scene_intern_file_name(out_scene, path);
    i->bump_unit = 1.0f;
    return i->where.file ? AG_OK : AG_ERROR_MEMORY;
}

ag_status importer_refuse(importer *i, const char *format, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    log_at(i->log, AG_LOG_ERROR, i->where, "%s", text);
    return AG_ERROR_INPUT;
}

float importer_bump_unit(vec3 low, vec3 high)
{
    double x = (double)high.x - low.x, y = (double)high.y - low.y, z = (double)high.z - low.z;
    double diagonal = sqrt(x * x + y * y + z * z);
    return low.x <= high.x && isfinite(diagonal) ? (float)(0.002 * diagonal) : 0.0f;
}

/* Meshes */

static void free_arrays(mesh *m)
{
    free(m->positions);
    free(m->normals);
    free(m->uvs);
    free(m->indices);
    memset(m, 0, sizeof *m);
}

static bool has_area(const vec3 *positions, const uint32_t *corners)
{
    vec3 a = positions[corners[0]], b = positions[corners[1]], c = positions[corners[2]];
    double u[3] = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z};
    double v[3] = {(double)c.x - a.x, (double)c.y - a.y, (double)c.z - a.z};
    return u[1] * v[2] - u[2] * v[1] != 0.0 || u[2] * v[0] - u[0] * v[2] != 0.0 || u[0] * v[1] - u[1] * v[0] != 0.0;
}

/* Unit length; zero where there is none, and the triangle's own normal is then used. */
static vec3 world_normal(const transform *t, vec3 n)
{
    double w[3], square = 0.0, largest = (double)vec3_max_abs(n);
    if (!(largest > 0.0))
        return vec3_make(0.0f, 0.0f, 0.0f);
    for (int k = 0; k < 3; k++) {
        w[k] = (t->inverse[0][k] * (double)n.x + t->inverse[1][k] * (double)n.y + t->inverse[2][k] * (double)n.z) /
               largest;
        square += w[k] * w[k];
    }
    double inverse = 1.0 / sqrt(square);
    vec3 unit = {(float)(w[0] * inverse), (float)(w[1] * inverse), (float)(w[2] * inverse)};
    return vec3_is_finite(unit) ? unit : vec3_make(0.0f, 0.0f, 0.0f);
}

static ag_status check_indices(importer *i, const char *name, const mesh *m)
{
    for (size_t k = 0; k < 3 * (size_t)m->triangle_count; k++)
        if (m->indices[k] >= m->vertex_count)
            return importer_refuse(i, "mesh \"%s\": triangle %zu refers to vertex %u, but there are %u", name, k / 3,
                                   m->indices[k], m->vertex_count);
    return AG_OK;
}

static ag_status place_vertices(importer *i, const char *name, const transform *t, mesh *m)
{
    for (uint32_t k = 0; k < m->vertex_count; k++) {
        if (!vec3_is_finite(m->positions[k]))
            return importer_refuse(i, "mesh \"%s\": vertex %u is not a finite number", name, k);
        vec3 world = transform_point(t, m->positions[k]);
        if (!vec3_is_finite(world) || !(vec3_max_abs(world) <= IMPORT_MAX_COORDINATE))
            return importer_refuse(i, "mesh \"%s\": vertex %u lies beyond 1e18 units", name, k);
        m->positions[k] = world;
    }
    for (uint32_t k = 0; m->normals && k < m->vertex_count; k++) {
        i->odd_vector_count += !vec3_is_finite(m->normals[k]);
        m->normals[k] = vec3_is_finite(m->normals[k]) ? world_normal(t, m->normals[k]) : vec3_make(0.0f, 0.0f, 0.0f);
    }
    for (uint32_t k = 0; m->uvs && k < m->vertex_count; k++)
        if (!isfinite(m->uvs[k].x) || !isfinite(m->uvs[k].y)) {
            i->odd_vector_count++;
            m->uvs[k] = (vec2){0.0f, 0.0f};
        }
    return AG_OK;
}

static void drop_degenerate(importer *i, mesh *m)
{
    uint32_t kept = 0;
    for (uint32_t k = 0; k < m->triangle_count; k++)
        if (has_area(m->positions, m->indices + 3 * (size_t)k)) {
            memmove(m->indices + 3 * (size_t)kept, m->indices + 3 * (size_t)k, 3 * sizeof *m->indices);
            kept++;
        }
    i->triangle_count += m->triangle_count;
    i->degenerate_count += m->triangle_count - kept;
    m->triangle_count = kept;
}

static ag_status add_lamp(importer *i, const import_surface *surface, uint32_t shape_index)
{
    float area = shape_area(&i->scene->shapes[shape_index]);
    if (rgb_is_black(surface->radiance) || !(area > 0.0f && isfinite(area)))
        return AG_OK;
    light l = light_make(LIGHT_AREA);
    uint32_t index;
    l.as.area.shape_index = shape_index;
    l.as.area.radiance = surface->radiance;
    l.as.area.radiance_texture = surface->radiance_texture;
    l.as.area.two_sided = true; /* these formats know no lamp with a dark side */
    return scene_add_light(i->scene, &l, &index);
}

ag_status importer_add_mesh(importer *i, const char *name, mesh *m, const transform *world_from_mesh,
                            const import_surface *surface)
{
    ag_status status = check_indices(i, name, m);
    if (status == AG_OK)
        status = place_vertices(i, name, world_from_mesh, m);
    if (status == AG_OK)
        drop_degenerate(i, m);
    if (status != AG_OK || m->triangle_count == 0) {
        free_arrays(m);
        return status;
    }
    shape s = shape_make(SHAPE_MESH);
    uint32_t index;
    s.flip_normal = transform_swaps_handedness(world_from_mesh);
    s.material_index = surface->material_index;
    s.alpha = surface->alpha;
    s.alpha_texture = surface->alpha_texture;
    s.as.mesh = *m;
    memset(m, 0, sizeof *m);
    AG_TRY(scene_add_shape(i->scene, &s, &index));
    AG_TRY(scene_set_name(i->scene, NAMED_SHAPE, index, name));
    return add_lamp(i, surface, index);
}

/* The end */

ag_status importer_finish(importer *i)
{
    if (i->left_out_count > 0)
        log_at(i->log, AG_LOG_WARNING, i->where, "%zu points and lines are left out", i->left_out_count);
    if (i->degenerate_count > 0)
        log_at(i->log, AG_LOG_WARNING, i->where, "%zu of %zu triangles have no area and are left out",
               i->degenerate_count, i->triangle_count);
    if (i->odd_vector_count > 0)
        log_at(i->log, AG_LOG_WARNING, i->where, "%zu normals or texture coordinates are not finite, and are not used",
               i->odd_vector_count);
    if (i->scene->shape_count == 0)
        return importer_refuse(i, "there is no triangle in the file: nothing to see");
    if (!i->scene->has_camera)
        AG_TRY(import_add_default_camera(i->scene, i->log));
    return i->scene->light_count == 0 ? import_add_default_light(i->scene, i->log) : AG_OK;
}
