/* gltf_meshes.c: primitives become shapes in world space, and lights where their material shines.
 * Rests on: Khronos, "glTF 2.0 Specification", 2021, 3.7.2 (meshes).
 * Flow: gltf_instances -> [here] -> gltf_vertices, gltf_triangles -> scene.shapes, scene.lights. Threads: one per
 * scene. */
#include "gltf/gltf_private.h"

#include <stdlib.h>
#include <string.h>

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

static ag_status fill_vertices(gltf_reader *r, const gltf_vertices *v, const uint32_t *file_numbers, mesh *m)
{
    size_t count = m->vertex_count;
    m->positions = calloc(count + 1, sizeof *m->positions); /* room for Embree's 16 byte reads */
    m->normals = v->has_normals ? calloc(count, sizeof *m->normals) : NULL;
    m->uvs = v->has_uvs || v->needs_uvs ? calloc(count, sizeof *m->uvs) : NULL;
    if (!m->positions || (v->has_normals && !m->normals) || ((v->has_uvs || v->needs_uvs) && !m->uvs))
        return AG_ERROR_MEMORY;
    for (uint32_t i = 0; i < m->vertex_count; i++)
        AG_TRY(gltf_vertices_get(r, v, file_numbers[i], &m->positions[i], m->normals ? &m->normals[i] : NULL,
                                 m->uvs ? &m->uvs[i] : NULL));
    return AG_OK;
}

static bool has_area(const mesh *m, const uint32_t *corners)
{
    vec3 a = m->positions[corners[0]], b = m->positions[corners[1]], c = m->positions[corners[2]];
    double u[3] = {(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z};
    double v[3] = {(double)c.x - a.x, (double)c.y - a.y, (double)c.z - a.z};
    return u[1] * v[2] - u[2] * v[1] != 0.0 || u[2] * v[0] - u[0] * v[2] != 0.0 || u[0] * v[1] - u[1] * v[0] != 0.0;
}

/* Removes triangles without area, which can be neither seen nor sampled. */
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

/* Gives the mesh's arrays to the scene. */
static ag_status add_shape(gltf_reader *r, const mesh *m, bool is_mirror, const gltf_material *from,
                           uint32_t object_index)
{
    uint32_t shape_index, light_index;
    shape s = shape_make(SHAPE_MESH);
    s.as.mesh = *m;
    s.flip_normal = is_mirror;
    s.material_index = from->material_index;
    s.medium_inside = from->medium_inside;
    s.has_medium_interface = from->medium_inside != SCENE_NO_MEDIUM;
    s.alpha = from->alpha;
    s.alpha_texture = from->alpha_texture;
    s.alpha_cutoff = from->alpha_cutoff;
    AG_TRY(scene_add_object_shape(r->scene, object_index, &s, &shape_index));
    if (rgb_is_black(from->radiance))
        return AG_OK;
    light l = light_make(LIGHT_AREA);
    l.as.area.shape_index = shape_index;
    l.as.area.radiance = from->radiance;
    l.as.area.radiance_texture = from->radiance_texture;
    l.as.area.two_sided = from->is_two_sided;
    r->glow_count += from->only_glows;
    return scene_add_light(r->scene, &l, &light_index);
}

/* The grain of a brushed material runs along u, whatever tangents the file gives. */
static ag_status warn_of_grain(const gltf_reader *r, const gltf_value *mesh_at, const gltf_value *attributes,
                               const gltf_vertices *v)
{
    const char *name = "";
    const gltf_value tangents = gltf_member(attributes, "TANGENT");
    AG_TRY(gltf_get_text(r, mesh_at, "name", &name));
    if (!v->has_uvs && !v->needs_uvs)
        gltf_warn_once(r, attributes, "grain without uvs",
                       "mesh \"%s\", and whichever else, has no uvs: what KHR_materials_anisotropy brushes runs along "
                       "the first edge of each triangle",
                       name);
    if (tangents.json && v->has_uvs)
        gltf_warn_once(r, &tangents, "TANGENT",
                       "the tangents of mesh \"%s\", and whichever else has them, are not supported: what "
                       "KHR_materials_anisotropy brushes runs along u",
                       name);
    return AG_OK;
}

static ag_status add_primitive(gltf_reader *r, const gltf_value *mesh_at, const gltf_value *primitive,
                               const gltf_pose *pose, gltf_destination to)
{
    uint32_t material_index = GLTF_NONE, *file_numbers = NULL;
    const gltf_material *material_of;
    gltf_vertices v;
    gltf_triangles t;
    AG_TRY(gltf_get_index(r, primitive, "material", GLTF_MATERIALS, &material_index));
    AG_TRY(gltf_material_find(r, material_index, &material_of));
    if (to.part == (rgb_is_black(material_of->radiance) ? GLTF_SHINING_PART : GLTF_DARK_PART))
        return AG_OK;
    gltf_value attributes;
    AG_TRY(gltf_require(r, primitive, "attributes"));
    AG_TRY(gltf_get_object(r, primitive, "attributes", &attributes));
    ag_status status = gltf_vertices_open(r, primitive, &attributes, material_of->uv_set, pose, &v);
    if (status == AG_OK && v.count > 0 && r->scene->materials[material_of->material_index].anisotropy > 0.0f)
        status = warn_of_grain(r, mesh_at, &attributes, &v);
    mesh m = {.vertex_count = 0};
    if (status == AG_OK && v.count > 0)
        status = gltf_read_triangles(r, primitive, v.count, &t);
    if (status == AG_OK && v.count > 0 && t.count > 0) {
        m.indices = t.indices;
        m.triangle_count = t.count;
        status = number_vertices(&t, &file_numbers, &m.vertex_count);
        if (status == AG_OK)
            status = fill_vertices(r, &v, file_numbers, &m);
        if (status == AG_OK)
            drop_degenerate(r, t.is_strip, &m);
    }
    free(file_numbers);
    gltf_vertices_close(&v);
    if (status == AG_OK && m.triangle_count > 0)
        return add_shape(r, &m, pose->is_mirror, material_of, to.object_index);
    free_arrays(&m);
    return status;
}

ag_status gltf_add_mesh(gltf_reader *r, uint32_t mesh_index, const gltf_pose *pose, gltf_destination to)
{
    gltf_value at, primitives;
    AG_TRY(gltf_get_item(r, GLTF_MESHES, mesh_index, &at));
    AG_TRY(gltf_require(r, &at, "primitives"));
    AG_TRY(gltf_get_array(r, &at, "primitives", &primitives));
    for (size_t i = 0; i < json_array_size(primitives.json); i++) {
        gltf_value primitive;
        if (run_is_cancelled(r->run))
            return AG_CANCELLED;
        AG_TRY(gltf_get_element(r, &primitives, i, &primitive));
        AG_TRY(add_primitive(r, &at, &primitive, pose, to));
    }
    return AG_OK;
}
