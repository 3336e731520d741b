/* gltf_nodes.c: the tree of nodes, from the default scene's roots down, and what hangs on each.
 * Rests on: Khronos, "glTF 2.0 Specification", 2021, 3.5 (scenes, nodes, transformations).
 * Flow: gltf_reader -> [here] -> gltf_instances, gltf_cameras, gltf_lights. Threads: one per scene. */
#include "gltf/gltf_private.h"

#include <stdlib.h>
#include <string.h>

/* Passing transforms on to a node's children and to its mesh, camera and light */

static ag_status read_matrix(const gltf_reader *r, const gltf_value *node, gltf_matrix *out)
{
    double m[16]; /* column by column */
    gltf_value at = gltf_member(node, "matrix");
    AG_TRY(gltf_get_doubles(r, node, "matrix", 16, m));
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0)
        return gltf_error(r, &at, "its last row should be 0 0 0 1");
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++)
            out->m[i][k] = m[4 * k + i];
    return AG_OK;
}

static ag_status read_rotation(const gltf_reader *r, const gltf_value *node, gltf_matrix *out)
{
    double q[4] = {0.0, 0.0, 0.0, 1.0};
    gltf_value at = gltf_member(node, "rotation");
    AG_TRY(gltf_get_doubles(r, node, "rotation", 4, q));
    double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    if (!(square > 1e-12 && square < 1e12))
        return gltf_error(r, &at, "is no rotation: the quaternion's length is not 1");
    double s = 2.0 / square, x = q[0], y = q[1], z = q[2], w = q[3];
    const double rotation[3][3] = {{1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)},
                                   {s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)},
                                   {s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)}};
    for (int i = 0; i < 3; i++)
        memcpy(out->m[i], rotation[i], sizeof rotation[i]);
    return AG_OK;
}

static ag_status read_transform(const gltf_reader *r, const gltf_value *node, gltf_matrix *out)
{
    double translation[3] = {0.0, 0.0, 0.0}, scale[3] = {1.0, 1.0, 1.0};
    *out = gltf_matrix_identity();
    if (gltf_member(node, "matrix").json)
        return read_matrix(r, node, out);
    AG_TRY(read_rotation(r, node, out));
    AG_TRY(gltf_get_doubles(r, node, "translation", 3, translation));
    AG_TRY(gltf_get_doubles(r, node, "scale", 3, scale));
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            out->m[i][k] *= scale[k];
        out->m[i][3] = translation[i];
    }
    return AG_OK;
}

/* The tree */

typedef struct tree {
    uint32_t *parents; /* [node_count], GLTF_NONE: it has none */
    uint32_t *stack;   /* [node_count]: each node is there once */
    uint32_t *order;   /* [node_count], the nodes of the scene, parents first */
    uint32_t node_count, stack_count, order_count;
} tree;

static ag_status find_parents(gltf_reader *r, tree *t)
{
    for (uint32_t i = 0; i < t->node_count; i++)
        t->parents[i] = GLTF_NONE;
    for (uint32_t i = 0; i < t->node_count; i++) {
        gltf_value node, children;
        AG_TRY(gltf_get_item(r, GLTF_NODES, i, &node));
        AG_TRY(gltf_get_array(r, &node, "children", &children));
        for (size_t k = 0; children.json && k < json_array_size(children.json); k++) {
            uint32_t child;
            gltf_value at = gltf_element(&children, k);
            AG_TRY(gltf_read_index(r, &at, GLTF_NODES, &child));
            if (t->parents[child] != GLTF_NONE)
                return gltf_error(r, &at, "nodes[%u] is a child of nodes[%u] already", child, t->parents[child]);
            t->parents[child] = i;
        }
    }
    return AG_OK;
}

/* Takes a node off the stack, and puts its children there, the first on top. */
static uint32_t step(const gltf_reader *r, tree *t)
{
    uint32_t node = t->stack[--t->stack_count];
    const json_t *children = json_object_get(json_array_get(r->lists[GLTF_NODES].json, node), "children");
    for (size_t k = json_array_size(children); k > 0; k--) /* checked in find_parents */
        t->stack[t->stack_count++] = (uint32_t)json_number_value(json_array_get(children, k - 1));
    return node;
}

/* Refuses cycles. A node that has at most one parent, and is not below a node without a parent, is among its own
 * ancestors or below such a node. */
static ag_status refuse_cycle(const gltf_reader *r, const tree *t)
{
    for (uint32_t i = 0; i < t->node_count; i++) {
        uint32_t ancestor = t->parents[i];
        for (uint32_t k = 0; ancestor != GLTF_NONE && ancestor != i && k < t->node_count; k++)
            ancestor = t->parents[ancestor];
        if (ancestor == i) {
            gltf_value node = gltf_element(&r->lists[GLTF_NODES], i);
            return gltf_error(r, &node, "it is among its own children, or theirs");
        }
    }
    return AG_ERROR_SCENE;
}

/* Computes the transforms of all nodes, also those of other scenes, where a skin's joints may be. */
static ag_status place_nodes(gltf_reader *r, tree *t)
{
    uint32_t visited = 0;
    for (uint32_t i = 0; i < t->node_count; i++) {
        if (t->parents[i] != GLTF_NONE)
            continue;
        t->stack[t->stack_count++] = i;
        for (; t->stack_count > 0; visited++) {
            uint32_t n = step(r, t);
            gltf_value node;
            gltf_matrix own;
            AG_TRY(gltf_get_item(r, GLTF_NODES, n, &node));
            AG_TRY(read_transform(r, &node, &own));
            r->world_from_nodes[n] =
                t->parents[n] == GLTF_NONE ? own : gltf_matrix_multiply(&r->world_from_nodes[t->parents[n]], &own);
        }
    }
    return visited == t->node_count ? AG_OK : refuse_cycle(r, t);
}

/* Puts the scene's roots on the stack, or where the file has no scene all nodes without a parent. */
static ag_status push_roots(gltf_reader *r, tree *t)
{
    uint32_t scene_index = 0;
    gltf_value scene_value, roots;
    AG_TRY(gltf_get_index(r, &r->document, "scene", GLTF_SCENES, &scene_index));
    if (r->list_counts[GLTF_SCENES] == 0) {
        for (uint32_t i = t->node_count; i > 0; i--)
            if (t->parents[i - 1] == GLTF_NONE)
                t->stack[t->stack_count++] = i - 1;
        return AG_OK;
    }
    AG_TRY(gltf_get_item(r, GLTF_SCENES, scene_index, &scene_value));
    AG_TRY(gltf_get_array(r, &scene_value, "nodes", &roots));
    bool *is_root = calloc(t->node_count + 1, sizeof *is_root);
    ag_status status = is_root ? AG_OK : AG_ERROR_MEMORY;
    for (size_t k = json_array_size(roots.json); status == AG_OK && k > 0; k--) {
        uint32_t root = 0;
        gltf_value at = gltf_element(&roots, k - 1);
        status = gltf_read_index(r, &at, GLTF_NODES, &root);
        if (status == AG_OK && t->parents[root] != GLTF_NONE)
            status = gltf_error(r, &at, "nodes[%u] is no root: it is a child of nodes[%u]", root, t->parents[root]);
        if (status == AG_OK && is_root[root])
            status = gltf_error(r, &at, "nodes[%u] is named twice", root);
        if (status == AG_OK) {
            is_root[root] = true;
            t->stack[t->stack_count++] = root;
        }
    }
    free(is_root);
    return status;
}

/* A node's mesh, camera and light */

static ag_status add_node(gltf_reader *r, uint32_t index)
{
    uint32_t mesh_index = GLTF_NONE, camera_index = GLTF_NONE, lamp_index = GLTF_NONE;
    const gltf_matrix *world_from_node = &r->world_from_nodes[index];
    gltf_value node, extensions, extension;
    AG_TRY(gltf_get_item(r, GLTF_NODES, index, &node));
    AG_TRY(gltf_get_index(r, &node, "mesh", GLTF_MESHES, &mesh_index));
    AG_TRY(gltf_get_index(r, &node, "camera", GLTF_CAMERAS, &camera_index));
    AG_TRY(gltf_get_extension(r, &node, "KHR_lights_punctual", &extensions, &extension));
    AG_TRY(gltf_get_index(r, &extension, "light", GLTF_LIGHTS, &lamp_index));
    if (mesh_index != GLTF_NONE)
        AG_TRY(gltf_add_node_mesh(r, &node, mesh_index, world_from_node));
    if (camera_index != GLTF_NONE)
        AG_TRY(gltf_add_camera(r, camera_index, &node, world_from_node));
    if (lamp_index != GLTF_NONE)
        AG_TRY(gltf_add_lamp(r, lamp_index, world_from_node));
    return AG_OK;
}

static ag_status walk(gltf_reader *r, tree *t)
{
    AG_TRY(find_parents(r, t));
    AG_TRY(place_nodes(r, t));
    AG_TRY(push_roots(r, t));
    while (t->stack_count > 0) {
        gltf_value node;
        t->order[t->order_count++] = step(r, t);
        AG_TRY(gltf_get_item(r, GLTF_NODES, t->order[t->order_count - 1], &node));
        AG_TRY(gltf_count_mesh_use(r, &node));
    }
    for (uint32_t i = 0; i < t->order_count; i++) {
        AG_TRY(add_node(r, t->order[i]));
        run_progress(r->run, AG_PHASE_LOAD, (double)i / t->order_count);
    }
    return AG_OK;
}

ag_status gltf_add_nodes(gltf_reader *r)
{
    tree t = {.node_count = r->list_counts[GLTF_NODES]};
    t.parents = malloc((t.node_count + 1) * sizeof *t.parents);
    t.stack = malloc((t.node_count + 1) * sizeof *t.stack);
    t.order = malloc((t.node_count + 1) * sizeof *t.order);
    ag_status status = t.parents && t.stack && t.order ? walk(r, &t) : AG_ERROR_MEMORY;
    free(t.parents);
    free(t.stack);
    free(t.order);
    return status;
}
