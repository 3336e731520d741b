/* gltf_instances.c: meshes that nodes hold: copies in the world, or where many would be large, an object and instances.
 * Rays find their way faster among copies; what shines is always one, for lamps stand in the world itself.
 * Rests on: Khronos, "glTF 2.0 Specification", 2021, 3.5.1 (nodes may share a mesh).
 * Flow: gltf_nodes -> [here] -> gltf_poses, gltf_meshes, scene.instances. Threads: one per scene. */
#include "gltf/gltf_private.h"

/* The most triangles that all copies of a mesh may have together. */
static const double MAX_COPIED_TRIANGLES = 65536.0;

/* Guesses how many triangles a mesh has; what is wrong with it is told when it is read. */
static double triangle_count(const gltf_reader *r, uint32_t mesh_index)
{
    const json_t *primitives = json_object_get(json_array_get(r->lists[GLTF_MESHES].json, mesh_index), "primitives");
    double count = 0.0;
    for (size_t i = 0; i < json_array_size(primitives); i++) {
        const json_t *primitive = json_array_get(primitives, i), *corners = json_object_get(primitive, "indices");
        if (!corners)
            corners = json_object_get(json_object_get(primitive, "attributes"), "POSITION");
        double index = corners ? json_number_value(corners) : -1.0;
        if (index >= 0.0 && index < r->list_counts[GLTF_ACCESSORS])
            count += json_number_value(
                json_object_get(json_array_get(r->lists[GLTF_ACCESSORS].json, (size_t)index), "count"));
    }
    return count / 3.0;
}

/* Finds the node's mesh if other nodes can have the same but for its transform; else GLTF_NONE. */
static ag_status find_shared_mesh(const gltf_reader *r, const gltf_value *node, uint32_t *out_mesh_index)
{
    *out_mesh_index = GLTF_NONE;
    if (gltf_member(node, "skin").json || gltf_member(node, "weights").json)
        return AG_OK;
    return gltf_get_index(r, node, "mesh", GLTF_MESHES, out_mesh_index);
}

ag_status gltf_count_mesh_use(gltf_reader *r, const gltf_value *node)
{
    uint32_t mesh_index;
    AG_TRY(find_shared_mesh(r, node, &mesh_index));
    if (mesh_index != GLTF_NONE)
        r->mesh_uses[mesh_index].node_count++;
    return AG_OK;
}

static ag_status add_posed(gltf_reader *r, const gltf_value *node, uint32_t mesh_index,
                           const gltf_matrix *world_from_node, gltf_destination to)
{
    gltf_value mesh_value;
    gltf_pose pose;
    AG_TRY(gltf_get_item(r, GLTF_MESHES, mesh_index, &mesh_value));
    ag_status status = gltf_pose_open(r, node, &mesh_value, world_from_node, &pose);
    if (status == AG_OK)
        status = gltf_add_mesh(r, mesh_index, &pose, to);
    gltf_pose_close(&pose);
    return status;
}

/* Makes an object of the mesh without a node's transform, but leaves out the parts that shine. */
static ag_status make_object(gltf_reader *r, const gltf_value *node, uint32_t mesh_index, gltf_mesh_use *use)
{
    gltf_matrix identity = gltf_matrix_identity();
    uint32_t shape_count = r->scene->shape_count;
    gltf_destination to = {.part = GLTF_DARK_PART};
    AG_TRY(scene_add_object(r->scene, &to.object_index));
    AG_TRY(add_posed(r, node, mesh_index, &identity, to));
    use->is_made = true;
    use->object_index = r->scene->shape_count > shape_count ? to.object_index : SCENE_NO_OBJECT;
    return AG_OK;
}

static ag_status add_node_mesh(gltf_reader *r, const gltf_value *node, uint32_t mesh_index,
                               const gltf_matrix *world_from_node)
{
    uint32_t shared_index, instance_index;
    const gltf_destination world = {GLTF_ALL_PARTS, SCENE_NO_OBJECT}, shining = {GLTF_SHINING_PART, SCENE_NO_OBJECT};
    affine world_from_object;
    for (int e = 0; e < 12; e++)
        world_from_object.m[e / 4][e % 4] = (float)world_from_node->m[e / 4][e % 4];
    AG_TRY(find_shared_mesh(r, node, &shared_index));
    gltf_mesh_use *use = &r->mesh_uses[mesh_index];
    if (shared_index == GLTF_NONE || use->node_count < 2 || !affine_can_be_undone(&world_from_object) ||
        use->node_count * triangle_count(r, mesh_index) <= MAX_COPIED_TRIANGLES)
        return add_posed(r, node, mesh_index, world_from_node, world);
    if (!use->is_made)
        AG_TRY(make_object(r, node, mesh_index, use));
    if (use->object_index != SCENE_NO_OBJECT)
        AG_TRY(scene_add_instance(r->scene, use->object_index, &world_from_object, 1, &instance_index));
    return add_posed(r, node, mesh_index, world_from_node, shining);
}

/* Returns the name that the file gives it, or NULL. */
static const char *name_of(const gltf_value *item) { return json_string_value(gltf_member(item, "name").json); }

ag_status gltf_add_node_mesh(gltf_reader *r, const gltf_value *node, uint32_t mesh_index,
                             const gltf_matrix *world_from_node)
{
    gltf_value mesh_item;
    uint32_t shape_count = r->scene->shape_count, object_count = r->scene->object_count;
    AG_TRY(add_node_mesh(r, node, mesh_index, world_from_node));
    AG_TRY(gltf_get_item(r, GLTF_MESHES, mesh_index, &mesh_item));
    const char *mesh_name = name_of(&mesh_item), *node_name = name_of(node);
    for (uint32_t i = shape_count; i < r->scene->shape_count; i++) /* names of shapes in the world itself */
        AG_TRY(scene_set_name(r->scene, NAMED_SHAPE, i, node_name ? node_name : mesh_name));
    for (uint32_t i = object_count; i < r->scene->object_count; i++) /* which several nodes share */
        AG_TRY(scene_set_name(r->scene, NAMED_OBJECT, i, mesh_name));
    return AG_OK;
}
