/* mesh_import_assimp.c: see mesh_import_assimp.h. Scenes, meshes and nodes; the files *_import_assimp.c alone know
 * assimp. Facts of assimp 5.2.5: camera angles are of the whole width; 3DS cameras have their position twice, in the
 * node and in the camera; FBX files keep their up axis, which stands in the metadata; STL, 3MF, AMF and Blender's files
 * keep z up. Nothing is freed: the process ends. */
#define _POSIX_C_SOURCE 200809L
#include "model/mesh_import_assimp.h"

#include "model/import_assimp.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>

#include <string.h>
#include <strings.h>

enum { MAX_DEPTH = 1000 }; /* of nodes within nodes */

static void write_bytes(assimp_writer *w, const void *bytes, size_t size)
{
    w->is_sound = w->is_sound && (size == 0 || fwrite(bytes, size, 1, w->out) == 1);
}

static void write_head(assimp_writer *w, import_record_kind kind, size_t size)
{
    import_record head = {.kind = kind, .size = size};
    write_bytes(w, &head, sizeof head);
}

static void write_padding(assimp_writer *w, size_t size)
{
    static const char ZEROS[8] = {0};
    write_bytes(w, ZEROS, (8 - size % 8) % 8);
}

void assimp_write_record(assimp_writer *w, import_record_kind kind, const void *bytes, size_t size)
{
    write_head(w, kind, size);
    write_bytes(w, bytes, size);
    write_padding(w, size);
}

void assimp_write_text(assimp_writer *w, import_record_kind kind, const char *text)
{
    assimp_write_record(w, kind, text, strlen(text));
}

void assimp_copy_text(char *out, size_t size, const struct aiString *text)
{
    size_t length = text->length < size ? text->length : size - 1;
    memcpy(out, text->data, length);
    out[length] = '\0';
}

/* Meshes */

static void write_vectors(assimp_writer *w, const struct aiVector3D *vectors, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        vec3 v = {(float)vectors[k].x, (float)vectors[k].y, (float)vectors[k].z};
        write_bytes(w, &v, sizeof v);
    }
}

static void write_mesh(assimp_writer *w, const struct aiMesh *m)
{
    import_mesh head;
    memset(&head, 0, sizeof head);
    assimp_copy_text(head.name, sizeof head.name, &m->mName);
    head.material_index = m->mMaterialIndex;
    head.vertex_count = m->mNumVertices;
    head.has_normals = m->mNormals != NULL;
    head.has_uvs = m->mTextureCoords[0] != NULL;
    for (unsigned k = 0; k < m->mNumFaces; k++)
        head.triangle_count += m->mFaces[k].mNumIndices == 3;
    head.left_out = m->mNumFaces - head.triangle_count;
    size_t per_vertex = sizeof(vec3) + (head.has_normals ? sizeof(vec3) : 0) + (head.has_uvs ? sizeof(vec2) : 0);
    size_t size = sizeof head + head.vertex_count * per_vertex + 12 * (size_t)head.triangle_count;
    write_head(w, IMPORT_RECORD_MESH, size);
    write_bytes(w, &head, sizeof head);
    write_vectors(w, m->mVertices, head.vertex_count);
    if (head.has_normals)
        write_vectors(w, m->mNormals, head.vertex_count);
    for (unsigned k = 0; head.has_uvs && k < head.vertex_count; k++) {
        vec2 uv = {(float)m->mTextureCoords[0][k].x, (float)m->mTextureCoords[0][k].y};
        write_bytes(w, &uv, sizeof uv);
    }
    for (unsigned k = 0; k < m->mNumFaces; k++)
        for (unsigned corner = 0; corner < 3 && m->mFaces[k].mNumIndices == 3; corner++) {
            uint32_t index = m->mFaces[k].mIndices[corner];
            write_bytes(w, &index, sizeof index);
        }
    write_padding(w, size);
}

/* Transforms */

static void from_assimp(const struct aiMatrix4x4 *a, assimp_matrix out)
{
    const ai_real *values = &a->a1;
    for (int k = 0; k < 16; k++)
        out[k / 4][k % 4] = (double)values[k];
}

static void multiply(assimp_matrix a, assimp_matrix b, assimp_matrix out)
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j] + a[i][3] * b[3][j];
}

static void write_instances(assimp_writer *w, const struct aiNode *node, assimp_matrix world_from_parent, int depth)
{
    import_instance instance;
    assimp_matrix own;
    memset(&instance, 0, sizeof instance);
    from_assimp(&node->mTransformation, own);
    multiply(world_from_parent, own, instance.world_from_mesh);
    for (unsigned k = 0; k < node->mNumMeshes; k++) {
        instance.mesh_index = node->mMeshes[k];
        assimp_write_record(w, IMPORT_RECORD_INSTANCE, &instance, sizeof instance);
    }
    if (depth == MAX_DEPTH && node->mNumChildren > 0)
        assimp_write_text(w, IMPORT_RECORD_WARNING, "nodes stand within more than 1000 others: those are left out");
    for (unsigned k = 0; k < node->mNumChildren && depth < MAX_DEPTH; k++)
        write_instances(w, node->mChildren[k], instance.world_from_mesh, depth + 1);
}

/* Of the node with that name; where there is none, or no name, the world itself. */
const struct aiNode *assimp_find_node(const struct aiNode *node, const struct aiString *name,
                                      assimp_matrix world_from_parent, int depth, assimp_matrix out_world_from_node)
{
    assimp_matrix own, world;
    from_assimp(&node->mTransformation, own);
    multiply(world_from_parent, own, world);
    if (node->mName.length == name->length && memcmp(node->mName.data, name->data, name->length) == 0) {
        memcpy(out_world_from_node, world, sizeof world);
        return node;
    }
    for (unsigned k = 0; k < node->mNumChildren && depth < MAX_DEPTH; k++) {
        const struct aiNode *found = assimp_find_node(node->mChildren[k], name, world, depth + 1, out_world_from_node);
        if (found)
            return found;
    }
    return NULL;
}

void assimp_transform(assimp_matrix m, const struct aiVector3D *v, double w, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = m[k][0] * (double)v->x + m[k][1] * (double)v->y + m[k][2] * (double)v->z + m[k][3] * w;
}

/* The axis that is up: 0, 1 or 2. */
static int up_axis(const struct aiScene *s, const char *path)
{
    static const char *const Z_UP[] = {".stl", ".3mf", ".amf", ".blend"};
    const char *dot = strrchr(path, '.');
    for (size_t k = 0; dot && k < sizeof Z_UP / sizeof *Z_UP; k++)
        if (strcasecmp(dot, Z_UP[k]) == 0)
            return 2;
    for (unsigned k = 0; s->mMetaData && k < s->mMetaData->mNumProperties; k++)
        if (strcmp(s->mMetaData->mKeys[k].data, "UpAxis") == 0 && s->mMetaData->mValues[k].mType == AI_INT32)
            return *(const int32_t *)s->mMetaData->mValues[k].mData;
    return 1;
}

static void write_scene(assimp_writer *w, const char *path)
{
    const struct aiScene *s = w->scene;
    static const assimp_matrix X_UP = {{0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    static const assimp_matrix Y_UP = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    static const assimp_matrix Z_UP = {{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}, {0, 0, 0, 1}};
    int up = up_axis(s, path);
    assimp_matrix root;
    assimp_find_maker(w, path);
    memcpy(root, up == 0 ? X_UP : up == 2 ? Z_UP : Y_UP, sizeof root);
    for (unsigned k = 0; k < s->mNumTextures; k++) {
        const struct aiTexture *t = s->mTextures[k];
        if (t->mHeight != 0)
            assimp_write_text(w, IMPORT_RECORD_WARNING,
                              "a picture within the file is packed in no known way and is not used");
        assimp_write_record(w, IMPORT_RECORD_PICTURE, t->pcData, t->mHeight == 0 && t->pcData ? t->mWidth : 0);
    }
    for (unsigned k = 0; k < s->mNumMaterials; k++)
        assimp_write_material(w, s->mMaterials[k]);
    const char *dot = strrchr(path, '.');
    if (w->is_blenders && w->has_plain_shining && dot && strcasecmp(dot, ".dae") == 0)
        assimp_write_text(
            w, IMPORT_RECORD_WARNING,
            "Blender writes no strength of emission to Collada files: surfaces shine with 1 times their colour");
    if (w->has_default_surface)
        assimp_write_text(w, IMPORT_RECORD_WARNING,
                          "Blender writes neither roughness nor specular to Collada files: both are taken to be 0.5, "
                          "as in its new materials");
    for (unsigned k = 0; k < s->mNumMeshes; k++)
        write_mesh(w, s->mMeshes[k]);
    write_instances(w, s->mRootNode, root, 0);
    for (unsigned k = 0; k < s->mNumCameras; k++)
        assimp_write_camera(w, s->mCameras[k], root);
    for (unsigned k = 0; k < s->mNumLights; k++)
        assimp_write_light(w, s->mLights[k], root);
    write_head(w, IMPORT_RECORD_END, 0);
}

bool assimp_write_records(const char *path, FILE *answer)
{
    assimp_writer w = {.out = answer, .is_sound = true};
    w.scene = aiImportFile(path, aiProcess_ValidateDataStructure | aiProcess_Triangulate);
    if (w.scene && w.scene->mRootNode) {
        write_scene(&w, path);
    } else {
        const char *text = aiGetErrorString();
        assimp_write_text(&w, IMPORT_RECORD_ERROR, text && text[0] ? text : "assimp cannot read the file");
    }
    return w.is_sound;
}

bool assimp_write_refusal(const char *text, FILE *answer)
{
    assimp_writer w = {.out = answer, .is_sound = true};
    assimp_write_text(&w, IMPORT_RECORD_ERROR, text);
    return w.is_sound;
}

bool assimp_reads_extension(const char *extension) { return aiIsExtensionSupported(extension) == AI_TRUE; }
