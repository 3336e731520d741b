/* gltf_poses.c: how a node holds its mesh: by its own matrix or by a skin's joints, and with what weights it is
 * morphed. Rests on: Khronos, "glTF 2.0 Specification", 2021, 3.7.2.2 (morph targets), 3.7.3 (skins: the joints alone
 * place a mesh). Flow: gltf_instances -> [here] -> gltf_accessors. Threads: one per scene. */
#include "gltf/gltf_private.h"

#include <stdlib.h>
#include <string.h>

gltf_matrix gltf_matrix_identity(void) { return (gltf_matrix){{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}; }

gltf_matrix gltf_matrix_multiply(const gltf_matrix *a, const gltf_matrix *b)
{
    gltf_matrix c;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++) {
            c.m[i][k] = k == 3 ? a->m[i][3] : 0.0;
            for (int j = 0; j < 3; j++)
                c.m[i][k] += a->m[i][j] * b->m[j][k];
        }
    return c;
}

/* Finds the weights of morph targets: the node's, or where it has none the mesh's. */
static ag_status read_weights(const gltf_reader *r, const gltf_value *node, const gltf_value *mesh_value,
                              gltf_value *out_weights)
{
    AG_TRY(gltf_get_array(r, node, "weights", out_weights));
    if (!out_weights->json)
        AG_TRY(gltf_get_array(r, mesh_value, "weights", out_weights));
    for (size_t i = 0; i < json_array_size(out_weights->json); i++) {
        gltf_value weight = gltf_element(out_weights, i);
        if (!json_is_number(weight.json))
            return gltf_error(r, &weight, "should be a number");
    }
    return AG_OK;
}

static ag_status read_joints(gltf_reader *r, uint32_t skin_index, gltf_pose *pose)
{
    gltf_value skin, joints;
    gltf_accessor inverse;
    uint32_t inverse_index = GLTF_NONE;
    AG_TRY(gltf_get_item(r, GLTF_SKINS, skin_index, &skin));
    AG_TRY(gltf_require(r, &skin, "joints"));
    AG_TRY(gltf_get_array(r, &skin, "joints", &joints));
    AG_TRY(gltf_get_index(r, &skin, "inverseBindMatrices", GLTF_ACCESSORS, &inverse_index));
    gltf_value at = gltf_member(&skin, "inverseBindMatrices");
    size_t count = json_array_size(joints.json);
    if (count == 0 || count > UINT16_MAX)
        return gltf_error(r, &joints, "there are %zu, which should be from 1 to 65535", count);
    if (inverse_index != GLTF_NONE) {
        AG_TRY(gltf_accessor_open(r, &at, inverse_index, 16, 16, &inverse));
        if (inverse.count < count)
            return gltf_error(r, &at, "it has %u elements, but there are %zu joints", inverse.count, count);
    }
    pose->joints = malloc(count * sizeof *pose->joints);
    if (!pose->joints)
        return AG_ERROR_MEMORY;
    pose->joint_count = (uint32_t)count;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t node = 0;
        float m[16]; /* column by column */
        gltf_value joint = gltf_element(&joints, i);
        gltf_matrix joint_from_mesh = gltf_matrix_identity();
        AG_TRY(gltf_read_index(r, &joint, GLTF_NODES, &node));
        if (inverse_index != GLTF_NONE) {
            gltf_accessor_get(&inverse, i, m);
            for (int e = 0; e < 12; e++)
                joint_from_mesh.m[e / 4][e % 4] = (double)m[4 * (e % 4) + e / 4];
        }
        pose->joints[i] = gltf_matrix_multiply(&r->world_from_nodes[node], &joint_from_mesh);
    }
    return AG_OK;
}

ag_status gltf_pose_open(gltf_reader *r, const gltf_value *node, const gltf_value *mesh_value,
                         const gltf_matrix *world_from_node, gltf_pose *out_pose)
{
    uint32_t skin_index = GLTF_NONE;
    double cofactors[3][3];
    memset(out_pose, 0, sizeof *out_pose);
    out_pose->world_from_mesh = *world_from_node;
    AG_TRY(read_weights(r, node, mesh_value, &out_pose->weights));
    AG_TRY(gltf_get_index(r, node, "skin", GLTF_SKINS, &skin_index));
    if (skin_index != GLTF_NONE)
        AG_TRY(read_joints(r, skin_index, out_pose));
    out_pose->is_mirror =
        gltf_matrix_cofactors(skin_index == GLTF_NONE ? world_from_node : &out_pose->joints[0], cofactors);
    return AG_OK;
}

void gltf_pose_close(gltf_pose *pose)
{
    free(pose->joints);
    pose->joints = NULL;
}
