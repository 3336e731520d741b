/* import_scene.c: see import_scene.h. Records are indexed first, then instances, cameras and lights are taken one by
 * one. Threads: one per scene. */
#include "model/import_scene.h"

#include "model/importer.h"
#include "status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct record {
    import_record_kind kind;
    const unsigned char *bytes; /* aligned to 8 */
    size_t size;
} record;

typedef struct model {
    importer to;
    record *records;
    size_t count;
    /* indices into records, in their order */
    size_t *materials, *meshes;
    import_embedded *pictures;
    size_t material_count, mesh_count;
    import_surface *surfaces; /* [material_count] */
    bool *has_surface;
    import_surface plain; /* of meshes without material */
    bool has_plain;
} model;

/* Records */

static ag_status broken(model *m)
{
    return importer_refuse(&m->to, "what was read of the file does not hold together");
}

static bool append(model *m, const record *r, size_t *capacity)
{
    if (m->count == *capacity) {
        size_t larger = *capacity ? 2 * *capacity : 64;
        record *records = realloc(m->records, larger * sizeof *records);
        if (!records)
            return false;
        m->records = records;
        *capacity = larger;
    }
    m->records[m->count++] = *r;
    return true;
}

/* Cuts the bytes into records; the last is IMPORT_RECORD_END or IMPORT_RECORD_ERROR. */
static ag_status find_records(model *m, const unsigned char *bytes, size_t size)
{
    size_t at = 0, capacity = 0;
    for (;;) {
        import_record head;
        if (size - at < sizeof head)
            return importer_refuse(&m->to, "what was read of the file is cut short");
        memcpy(&head, bytes + at, sizeof head);
        at += sizeof head;
        if (head.kind > IMPORT_RECORD_END || head.size > size - at)
            return broken(m);
        record r = {(import_record_kind)head.kind, bytes + at, (size_t)head.size};
        if (!append(m, &r, &capacity))
            return AG_ERROR_MEMORY;
        if (r.kind == IMPORT_RECORD_END || r.kind == IMPORT_RECORD_ERROR)
            return AG_OK;
        size_t padded = (r.size + 7) & ~(size_t)7;
        if (padded > size - at)
            return broken(m);
        at += padded;
    }
}

static size_t mesh_bytes(const import_mesh *head)
{
    size_t per_vertex = sizeof(vec3) + (head->has_normals ? sizeof(vec3) : 0) + (head->has_uvs ? sizeof(vec2) : 0);
    return sizeof *head + head->vertex_count * per_vertex + 3 * sizeof(uint32_t) * (size_t)head->triangle_count;
}

static ag_status check_record(model *m, const record *r)
{
    static const size_t SIZES[] = {[IMPORT_RECORD_MATERIAL] = sizeof(import_material),
                                   [IMPORT_RECORD_INSTANCE] = sizeof(import_instance),
                                   [IMPORT_RECORD_CAMERA] = sizeof(import_camera),
                                   [IMPORT_RECORD_LIGHT] = sizeof(import_light)};
    import_mesh head;
    switch (r->kind) {
    case IMPORT_RECORD_MATERIAL:
    case IMPORT_RECORD_INSTANCE:
    case IMPORT_RECORD_CAMERA:
    case IMPORT_RECORD_LIGHT: return r->size == SIZES[r->kind] ? AG_OK : broken(m);
    case IMPORT_RECORD_MESH:
        if (r->size < sizeof head)
            return broken(m);
        memcpy(&head, r->bytes, sizeof head);
        if (head.vertex_count >= UINT32_MAX / 4 || head.triangle_count >= UINT32_MAX / 4)
            return importer_refuse(&m->to, "a mesh is too large");
        return r->size == mesh_bytes(&head) ? AG_OK : broken(m);
    default: return AG_OK;
    }
}

static ag_status index_records(model *m)
{
    m->materials = malloc(m->count * sizeof *m->materials);
    m->meshes = malloc(m->count * sizeof *m->meshes);
    m->pictures = malloc(m->count * sizeof *m->pictures);
    m->to.embedded = m->pictures;
    m->surfaces = calloc(m->count, sizeof *m->surfaces);
    m->has_surface = calloc(m->count, sizeof *m->has_surface);
    if (!m->materials || !m->meshes || !m->pictures || !m->surfaces || !m->has_surface)
        return AG_ERROR_MEMORY;
    for (size_t k = 0; k < m->count; k++) {
        const record *r = &m->records[k];
        AG_TRY(check_record(m, r));
        if (r->kind == IMPORT_RECORD_PICTURE)
            m->pictures[m->to.embedded_count++] = (import_embedded){r->bytes, r->size};
        if (r->kind == IMPORT_RECORD_MATERIAL)
            m->materials[m->material_count++] = k;
        if (r->kind == IMPORT_RECORD_MESH)
            m->meshes[m->mesh_count++] = k;
    }
    return AG_OK;
}

/* Materials are made only for meshes that have them; others are not looked at, nor their pictures. */

static ag_status get_surface(model *m, uint32_t index, const import_surface **out_surface)
{
    ag_status status = AG_OK;
    if (index >= m->material_count) {
        if (!m->has_plain) {
            material plain = material_make(MATERIAL_DIFFUSE);
            m->plain = (import_surface){
                .alpha = 1.0f, .alpha_texture = SCENE_NO_TEXTURE, .radiance_texture = SCENE_NO_TEXTURE};
            status = scene_add_material(m->to.scene, &plain, &m->plain.material_index);
            m->has_plain = true;
        }
        *out_surface = &m->plain;
        return status;
    }
    if (!m->has_surface[index]) {
        import_material source;
        memcpy(&source, m->records[m->materials[index]].bytes, sizeof source);
        source.name[IMPORT_NAME_SIZE - 1] = '\0';
        for (int slot = 0; slot < IMPORT_SLOT_COUNT; slot++)
            source.pictures[slot].path[IMPORT_PATH_SIZE - 1] = '\0';
        status = importer_add_material(&m->to, &source, &m->surfaces[index]);
        m->has_surface[index] = true;
    }
    *out_surface = &m->surfaces[index];
    return status;
}

/* Instances */

static bool copy_array(const unsigned char **at, size_t count, size_t item_size, size_t room, void **out_array)
{
    *out_array = calloc(count + room, item_size);
    if (*out_array)
        memcpy(*out_array, *at, count * item_size);
    *at += count * item_size;
    return *out_array != NULL;
}

static ag_status copy_mesh(const record *r, const import_mesh *head, mesh *out_mesh)
{
    const unsigned char *at = r->bytes + sizeof *head;
    void *positions = NULL, *normals = NULL, *uvs = NULL, *indices = NULL;
    bool is_copied = copy_array(&at, head->vertex_count, sizeof(vec3), 1, &positions) &&
                     (!head->has_normals || copy_array(&at, head->vertex_count, sizeof(vec3), 0, &normals)) &&
                     (!head->has_uvs || copy_array(&at, head->vertex_count, sizeof(vec2), 0, &uvs)) &&
                     copy_array(&at, 3 * (size_t)head->triangle_count, sizeof(uint32_t), 0, &indices);
    if (!is_copied) {
        free(positions);
        free(normals);
        free(uvs);
        free(indices);
        return AG_ERROR_MEMORY;
    }
    *out_mesh = (mesh){.vertex_count = head->vertex_count,
                       .triangle_count = head->triangle_count,
                       .positions = positions,
                       .normals = normals,
                       .uvs = uvs,
                       .indices = indices};
    return AG_OK;
}

/* false where the mesh would be flat. */
static bool instance_transform(const import_instance *instance, transform *out_transform)
{
    double matrix[4][4];
    memcpy(matrix, instance->world_from_mesh, sizeof matrix);
    for (int k = 0; k < 4; k++)
        matrix[3][k] = k == 3 ? 1.0 : 0.0;
    return transform_from_matrix((const double(*)[4])matrix, out_transform);
}

/* false where it is of no mesh. */
static bool get_instance(const model *m, const record *r, import_instance *out_instance, const record **out_mesh,
                         import_mesh *out_head)
{
    memcpy(out_instance, r->bytes, sizeof *out_instance);
    if (out_instance->mesh_index >= m->mesh_count)
        return false;
    *out_mesh = &m->records[m->meshes[out_instance->mesh_index]];
    memcpy(out_head, (*out_mesh)->bytes, sizeof *out_head);
    out_head->name[IMPORT_NAME_SIZE - 1] = '\0';
    return true;
}

/* Where object instances are wanted instead of copies: here a mesh is met again for each of its nodes. */
static ag_status add_instance(model *m, const record *r)
{
    import_instance instance;
    import_mesh head;
    const record *source;
    const import_surface *surface;
    transform world_from_mesh;
    mesh copy;
    if (!get_instance(m, r, &instance, &source, &head))
        return broken(m);
    if (run_is_cancelled(m->to.run))
        return AG_CANCELLED;
    m->to.left_out_count += head.left_out;
    if (!instance_transform(&instance, &world_from_mesh)) {
        log_at(m->to.log, AG_LOG_WARNING, m->to.where, "mesh \"%s\" is scaled to nothing and is left out", head.name);
        return AG_OK;
    }
    AG_TRY(get_surface(m, head.material_index, &surface));
    AG_TRY(copy_mesh(source, &head, &copy));
    return importer_add_mesh(&m->to, head.name, &copy, &world_from_mesh, surface);
}

/* Returns the diagonal of all instances, roughly, by which heights of bumps are measured. */
static ag_status find_bump_unit(model *m)
{
    vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t k = 0; k < m->count; k++) {
        import_instance instance;
        import_mesh head;
        const record *source;
        transform t;
        if (m->records[k].kind != IMPORT_RECORD_INSTANCE)
            continue;
        if (!get_instance(m, &m->records[k], &instance, &source, &head))
            return broken(m);
        if (!instance_transform(&instance, &t))
            continue;
        for (uint32_t v = 0; v < head.vertex_count; v++) {
            vec3 p;
            memcpy(&p, source->bytes + sizeof head + v * sizeof p, sizeof p);
            p = transform_point(&t, p);
            low = vec3_min(low, p);
            high = vec3_max(high, p);
        }
    }
    m->to.bump_unit = importer_bump_unit(low, high);
    return AG_OK;
}

/* The whole */

static ag_status add_camera(model *m, const record *r)
{
    import_camera source;
    memcpy(&source, r->bytes, sizeof source);
    source.name[IMPORT_NAME_SIZE - 1] = '\0';
    return importer_add_camera(&m->to, &source);
}

static ag_status add_light(model *m, const record *r)
{
    import_light source;
    memcpy(&source, r->bytes, sizeof source);
    source.name[IMPORT_NAME_SIZE - 1] = '\0';
    return importer_add_light(&m->to, &source);
}

static ag_status add_record(model *m, const record *r)
{
    int length = (int)(r->size < IMPORT_TEXT_SIZE ? r->size : IMPORT_TEXT_SIZE);
    switch (r->kind) {
    case IMPORT_RECORD_ERROR: return importer_refuse(&m->to, "%.*s", length, (const char *)r->bytes);
    case IMPORT_RECORD_WARNING:
        log_at(m->to.log, AG_LOG_WARNING, m->to.where, "%.*s", length, (const char *)r->bytes);
        return AG_OK;
    case IMPORT_RECORD_INSTANCE: return add_instance(m, r);
    case IMPORT_RECORD_CAMERA: return add_camera(m, r);
    case IMPORT_RECORD_LIGHT: return add_light(m, r);
    default: return AG_OK;
    }
}

ag_status import_scene_fill(run_context *run, const char *path, const unsigned char *bytes, size_t size,
                            scene *out_scene)
{
    model m;
    memset(&m, 0, sizeof m);
    ag_status status = importer_init(&m.to, run, path, out_scene);
    if (status == AG_OK)
        status = find_records(&m, bytes, size);
    if (status == AG_OK)
        status = index_records(&m);
    if (status == AG_OK)
        status = find_bump_unit(&m);
    for (size_t k = 0; k < m.count && status == AG_OK; k++)
        status = add_record(&m, &m.records[k]);
    if (status == AG_OK)
        status = importer_finish(&m.to);
    free(m.records);
    free(m.materials);
    free(m.meshes);
    free(m.pictures);
    free(m.surfaces);
    free(m.has_surface);
    return status;
}
