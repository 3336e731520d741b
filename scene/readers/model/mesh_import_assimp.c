/* mesh_import_assimp.c: see mesh_import_assimp.h. The only file that knows assimp.
 * Facts of assimp 5.2.5: camera angles are of the whole width; 3DS cameras have their position twice, in the node and
 * in the camera; FBX files keep their up axis, which stands in the metadata; STL, 3MF, AMF and Blender's files keep z
 * up. Nothing is freed: the process ends. */
#define _POSIX_C_SOURCE 200809L
#include "model/mesh_import_assimp.h"

#include "model/blender_lamps.h"
#include "model/blender_shifts.h"
#include "model/import_model.h"

#include <assimp/ObjMaterial.h>
#include <assimp/cimport.h>
#include <assimp/commonMetaData.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_DEPTH = 1000 }; /* of nodes within nodes */

typedef struct writer {
    FILE *out;
    const struct aiScene *scene;
    bool is_sound;            /* all could be written */
    bool is_blenders, is_fbx; /* the file is by Blender's exporter of Collada or FBX */
    bool has_dimming_spots;
    float units_per_metre;  /* of such a one */
    blender_lamps lamps;    /* of such a one, of Collada */
    blender_shifts shifts;  /* of such a one */
    bool has_plain_shining; /* a material shines */
} writer;

static void write_bytes(writer *w, const void *bytes, size_t size)
{
    w->is_sound = w->is_sound && (size == 0 || fwrite(bytes, size, 1, w->out) == 1);
}

static void write_head(writer *w, import_record_kind kind, size_t size)
{
    import_record head = {.kind = kind, .size = size};
    write_bytes(w, &head, sizeof head);
}

static void write_padding(writer *w, size_t size)
{
    static const char ZEROS[8] = {0};
    write_bytes(w, ZEROS, (8 - size % 8) % 8);
}

static void write_record(writer *w, import_record_kind kind, const void *bytes, size_t size)
{
    write_head(w, kind, size);
    write_bytes(w, bytes, size);
    write_padding(w, size);
}

static void write_text(writer *w, import_record_kind kind, const char *text)
{
    write_record(w, kind, text, strlen(text));
}

static void copy_text(char *out, size_t size, const struct aiString *text)
{
    size_t length = text->length < size ? text->length : size - 1;
    memcpy(out, text->data, length);
    out[length] = '\0';
}

/* Materials */

static float get_float(const struct aiMaterial *m, const char *key, unsigned type, unsigned index, float fallback)
{
    ai_real value;
    unsigned count = 1;
    return aiGetMaterialFloatArray(m, key, type, index, &value, &count) == aiReturn_SUCCESS && count == 1 ? (float)value
                                                                                                          : fallback;
}

static rgb get_color(const struct aiMaterial *m, const char *key, unsigned type, unsigned index, rgb fallback)
{
    struct aiColor4D c;
    return aiGetMaterialColor(m, key, type, index, &c) == aiReturn_SUCCESS
               ? rgb_make((float)c.r, (float)c.g, (float)c.b)
               : fallback;
}

static uint32_t wrap_of(enum aiTextureMapMode mode)
{
    return mode == aiTextureMapMode_Clamp    ? IMPORT_IS_CLAMPED
           : mode == aiTextureMapMode_Mirror ? IMPORT_IS_MIRRORED
           : mode == aiTextureMapMode_Decal  ? IMPORT_IS_BLACK
                                             : IMPORT_REPEATS;
}

/* The first of up to three kinds of which the material has a picture. */
static void get_picture(const writer *w, const struct aiMaterial *m, const enum aiTextureType types[3],
                        import_picture *out)
{
    *out = (import_picture){.scale = {1.0f, 1.0f}, .strength = 1.0f};
    for (int k = 0; k < 3 && types[k] != aiTextureType_NONE; k++) {
        struct aiString path;
        enum aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
        struct aiUVTransform t;
        if (aiGetMaterialTexture(m, types[k], 0, &path, NULL, NULL, NULL, NULL, modes, NULL) != aiReturn_SUCCESS)
            continue;
        copy_text(out->path, sizeof out->path, &path);
        for (unsigned n = 0; n < w->scene->mNumTextures && path.data[0] != '*'; n++)
            if (strcmp(w->scene->mTextures[n]->mFilename.data, path.data) == 0) {
                snprintf(out->path, sizeof out->path, "*%u", n);
                break;
            }
        out->wrap_s = wrap_of(modes[0]);
        out->wrap_t = wrap_of(modes[1]);
        if (aiGetMaterialUVTransform(m, AI_MATKEY_UVTRANSFORM(types[k], 0), &t) == aiReturn_SUCCESS) {
            out->scale[0] = (float)t.mScaling.x;
            out->scale[1] = (float)t.mScaling.y;
            out->offset[0] = (float)t.mTranslation.x;
            out->offset[1] = (float)t.mTranslation.y;
        }
        out->strength = get_float(m, AI_MATKEY_OBJ_BUMPMULT(types[k], 0), 1.0f);
        return;
    }
}

/* Readers fill in specular colours where the file has none. */
static bool has_highlights(const struct aiMaterial *m)
{
    int mode = 0;
    unsigned count = 1;
    if (aiGetMaterialIntegerArray(m, AI_MATKEY_SHADING_MODEL, &mode, &count) == aiReturn_SUCCESS && count == 1)
        return mode == aiShadingMode_Phong || mode == aiShadingMode_Blinn || mode == aiShadingMode_CookTorrance;
    return get_float(m, AI_MATKEY_SHININESS, 0.0f) > 0.0f;
}

/* Blender's FBX exporter squeezes its principled material into Phong's words: specular is twice SpecularFactor and 0.08
 * of it is reflected at normal incidence, roughness is 1 - sqrt(Shininess) / 10, metallic ReflectionFactor. */
static void restore_surface(const struct aiMaterial *m, import_material *out)
{
    const double specular = 2.0 * (double)get_float(m, AI_MATKEY_SHININESS_STRENGTH, 0.25f);
    const double normal = sqrt(fmin(fmax(0.08 * specular, 1e-6), 0.9));
    out->metallic = fminf(fmaxf(get_float(m, AI_MATKEY_REFLECTIVITY, 0.0f), 0.0f), 1.0f);
    out->roughness = (float)fmax(1.0 - sqrt(fmax((double)out->exponent, 0.0)) / 10.0, 0.0);
    out->ior = (float)((1.0 + normal) / (1.0 - normal));
}

static void write_material(writer *w, const struct aiMaterial *m)
{
    static const enum aiTextureType TYPES[IMPORT_SLOT_COUNT][3] = {
        [IMPORT_COLOR] = {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE, aiTextureType_NONE},
        [IMPORT_EMISSION] = {aiTextureType_EMISSION_COLOR, aiTextureType_EMISSIVE, aiTextureType_NONE},
        [IMPORT_OPACITY] = {aiTextureType_OPACITY, aiTextureType_NONE, aiTextureType_NONE},
        [IMPORT_ROUGHNESS] = {aiTextureType_DIFFUSE_ROUGHNESS, aiTextureType_NONE, aiTextureType_NONE},
        [IMPORT_METALLIC] = {aiTextureType_METALNESS, aiTextureType_NONE, aiTextureType_NONE},
        [IMPORT_NORMAL] = {aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA, aiTextureType_NONE},
        [IMPORT_BUMP] = {aiTextureType_HEIGHT, aiTextureType_DISPLACEMENT, aiTextureType_NONE},
    };
    const rgb black = rgb_gray(0.0f);
    import_material out;
    memset(&out, 0, sizeof out);
    struct aiString name;
    if (aiGetMaterialString(m, AI_MATKEY_NAME, &name) == aiReturn_SUCCESS)
        copy_text(out.name, sizeof out.name, &name);
    int illumination = -1;
    unsigned count = 1;
    aiGetMaterialIntegerArray(m, AI_MATKEY_OBJ_ILLUM, &illumination, &count);
    out.illumination = illumination;
    out.diffuse = get_color(m, AI_MATKEY_COLOR_DIFFUSE, rgb_gray(0.6f));
    out.diffuse = get_color(m, AI_MATKEY_BASE_COLOR, out.diffuse);
    if (has_highlights(m))
        out.specular =
            rgb_scale(get_color(m, AI_MATKEY_COLOR_SPECULAR, black), get_float(m, AI_MATKEY_SHININESS_STRENGTH, 1.0f));
    out.emission =
        rgb_scale(get_color(m, AI_MATKEY_COLOR_EMISSIVE, black), get_float(m, AI_MATKEY_EMISSIVE_INTENSITY, 1.0f));
    w->has_plain_shining |= out.emission.r > 0.0f || out.emission.g > 0.0f || out.emission.b > 0.0f;
    out.filter = illumination >= 0 ? get_color(m, AI_MATKEY_COLOR_TRANSPARENT, rgb_gray(1.0f)) : rgb_gray(1.0f);
    out.exponent = get_float(m, AI_MATKEY_SHININESS, -1.0f);
    out.opacity = get_float(m, AI_MATKEY_OPACITY, 1.0f);
    out.ior = get_float(m, AI_MATKEY_REFRACTI, -1.0f);
    out.metallic = get_float(m, AI_MATKEY_METALLIC_FACTOR, -1.0f);
    /* some readers derive a roughness from Phong's exponent: that one counts by itself */
    out.roughness = illumination >= 0 || out.metallic >= 0.0f ? get_float(m, AI_MATKEY_ROUGHNESS_FACTOR, -1.0f) : -1.0f;
    out.clearcoat = get_float(m, AI_MATKEY_CLEARCOAT_FACTOR, 0.0f);
    out.clearcoat_roughness = get_float(m, AI_MATKEY_CLEARCOAT_ROUGHNESS_FACTOR, 0.0f);
    out.transmission = get_float(m, AI_MATKEY_TRANSMISSION_FACTOR, 0.0f);
    if (w->is_blenders && w->is_fbx)
        restore_surface(m, &out);
    for (int slot = 0; slot < IMPORT_SLOT_COUNT; slot++)
        get_picture(w, m, TYPES[slot], &out.pictures[slot]);
    if (w->is_blenders && w->is_fbx && out.pictures[IMPORT_COLOR].path[0] != '\0')
        out.diffuse = rgb_gray(1.0f); /* a socket's value, which the picture replaces */
    write_record(w, IMPORT_RECORD_MATERIAL, &out, sizeof out);
}

/* Meshes */

static void write_vectors(writer *w, const struct aiVector3D *vectors, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        vec3 v = {(float)vectors[k].x, (float)vectors[k].y, (float)vectors[k].z};
        write_bytes(w, &v, sizeof v);
    }
}

static void write_mesh(writer *w, const struct aiMesh *m)
{
    import_mesh head;
    memset(&head, 0, sizeof head);
    copy_text(head.name, sizeof head.name, &m->mName);
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

typedef double matrix[4][4];

static void from_assimp(const struct aiMatrix4x4 *a, matrix out)
{
    const ai_real *values = &a->a1;
    for (int k = 0; k < 16; k++)
        out[k / 4][k % 4] = (double)values[k];
}

static void multiply(matrix a, matrix b, matrix out)
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j] + a[i][3] * b[3][j];
}

static void write_instances(writer *w, const struct aiNode *node, matrix world_from_parent, int depth)
{
    import_instance instance;
    matrix own;
    memset(&instance, 0, sizeof instance);
    from_assimp(&node->mTransformation, own);
    multiply(world_from_parent, own, instance.world_from_mesh);
    for (unsigned k = 0; k < node->mNumMeshes; k++) {
        instance.mesh_index = node->mMeshes[k];
        write_record(w, IMPORT_RECORD_INSTANCE, &instance, sizeof instance);
    }
    if (depth == MAX_DEPTH && node->mNumChildren > 0)
        write_text(w, IMPORT_RECORD_WARNING, "nodes stand within more than 1000 others: those are left out");
    for (unsigned k = 0; k < node->mNumChildren && depth < MAX_DEPTH; k++)
        write_instances(w, node->mChildren[k], instance.world_from_mesh, depth + 1);
}

/* Of the node with that name; where there is none, or no name, the world itself. */
static const struct aiNode *find_node(const struct aiNode *node, const struct aiString *name, matrix world_from_parent,
                                      int depth, matrix out_world_from_node)
{
    matrix own, world;
    from_assimp(&node->mTransformation, own);
    multiply(world_from_parent, own, world);
    if (node->mName.length == name->length && memcmp(node->mName.data, name->data, name->length) == 0) {
        memcpy(out_world_from_node, world, sizeof world);
        return node;
    }
    for (unsigned k = 0; k < node->mNumChildren && depth < MAX_DEPTH; k++) {
        const struct aiNode *found = find_node(node->mChildren[k], name, world, depth + 1, out_world_from_node);
        if (found)
            return found;
    }
    return NULL;
}

static void transform_to(matrix m, const struct aiVector3D *v, double w, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = m[k][0] * (double)v->x + m[k][1] * (double)v->y + m[k][2] * (double)v->z + m[k][3] * w;
}

static void write_camera(writer *w, const struct aiCamera *c, matrix root)
{
    import_camera out;
    matrix world;
    struct aiVector3D position = c->mPosition;
    memset(&out, 0, sizeof out);
    memcpy(world, root, sizeof world);
    const struct aiNode *node = find_node(w->scene->mRootNode, &c->mName, root, 0, world);
    if (node) { /* what stands in both is meant once */
        const struct aiMatrix4x4 *t = &node->mTransformation;
        float away = fabsf((float)(position.x - t->a4)) + fabsf((float)(position.y - t->b4)) +
                     fabsf((float)(position.z - t->c4));
        if (away <= 1e-5f * (fabsf((float)t->a4) + fabsf((float)t->b4) + fabsf((float)t->c4)))
            position.x = position.y = position.z = 0;
    }
    copy_text(out.name, sizeof out.name, &c->mName);
    transform_to(world, &position, 1.0, out.position);
    transform_to(world, &c->mLookAt, 0.0, out.forward);
    transform_to(world, &c->mUp, 0.0, out.up);
    out.horizontal_fov = c->mHorizontalFOV;
    out.aspect = c->mAspect;
    out.orthographic_half_width = c->mOrthographicWidth;
    memcpy(out.shift, w->shifts.of_all, sizeof out.shift);
    write_record(w, IMPORT_RECORD_CAMERA, &out, sizeof out);
    if (w->shifts.differ) {
        char text[IMPORT_TEXT_SIZE];
        snprintf(text, sizeof text,
                 "camera \"%s\": the file's cameras shift their pictures differently, and which does so how is not "
                 "read: this one is seen without a shift",
                 out.name);
        write_text(w, IMPORT_RECORD_WARNING, text);
    }
}

/* Of the program that made the file, as "Blender (stable FBX IO) - 3.4.1 - 4.37.5"; "": it names none. */
static const char *maker_of(const struct aiScene *s)
{
    for (unsigned k = 0; s->mMetaData && k < s->mMetaData->mNumProperties; k++)
        if (strcmp(s->mMetaData->mKeys[k].data, AI_METADATA_SOURCE_GENERATOR) == 0 &&
            s->mMetaData->mValues[k].mType == AI_AISTRING)
            return ((const struct aiString *)s->mMetaData->mValues[k].mData)->data;
    return "";
}

/* Blender's spots were dimmer beside their axis before 3.5: see spot_light.c. */
static bool has_dimming_spots(const char *maker)
{
    const char *version = maker + strcspn(maker, "0123456789");
    char *end;
    const long major = strtol(version, &end, 10), minor = *end == '.' ? strtol(end + 1, NULL, 10) : 0;
    return end != version && (major < 3 || (major == 3 && minor < 5));
}

/* Whose file it is, for lamps: see blender_lamps.h. */
static void find_maker(writer *w, const char *path)
{
    const struct aiScene *s = w->scene;
    const char *dot = strrchr(path, '.');
    const bool is_collada = dot && strcasecmp(dot, ".dae") == 0, is_fbx = dot && strcasecmp(dot, ".fbx") == 0;
    w->is_fbx = is_fbx;
    w->units_per_metre = is_fbx ? 100.0f : 1.0f;
    w->is_blenders = (is_collada || is_fbx) && strncmp(maker_of(s), "Blender ", strlen("Blender ")) == 0;
    w->has_dimming_spots = w->is_blenders && has_dimming_spots(maker_of(s));
    for (unsigned k = 0; is_fbx && s->mMetaData && k < s->mMetaData->mNumProperties; k++) {
        const struct aiMetadataEntry *value = &s->mMetaData->mValues[k];
        if (strcmp(s->mMetaData->mKeys[k].data, "UnitScaleFactor") != 0)
            continue;
        const double factor = value->mType == AI_DOUBLE  ? *(const double *)value->mData
                              : value->mType == AI_FLOAT ? (double)*(const float *)value->mData
                                                         : 1.0;
        if (factor > 1e-6 && factor < 1e6)
            w->units_per_metre = (float)(100.0 / factor);
    }
    if (w->is_blenders && is_collada)
        blender_lamps_read(path, &w->lamps);
    if (w->is_blenders && s->mNumCameras > 0)
        blender_shifts_read(path, is_fbx, &w->shifts);
}

/* The angle inside of which a spot of Blender's is full, from its half angle and blend: the edge takes that share of
 * what the cosine has to go from the axis on. */
static double full_angle(double half_angle, double blend)
{
    const double dark = cos(half_angle);
    return acos(fmin(fmax(dark + (1.0 - dark) * blend, -1.0), 1.0));
}

/* Restores the lamp that Blender meant, in a file of its own. */
static void restore_blenders(writer *w, const struct aiLight *l, matrix world, import_light *out)
{
    const struct aiVector3D up_of_fbx = {0, 0, 1}, up_of_collada = {0, 1, 0}, down = {0, -1, 0}, back = {0, 0, -1};
    const blender_lamp *lamp = blender_lamps_find(&w->lamps, out->name);
    out->measure = IMPORT_LIGHT_WATTS;
    out->units_per_metre = w->units_per_metre;
    if ((lamp && lamp->is_area) || l->mType == aiLightSource_UNDEFINED) {
        char text[IMPORT_TEXT_SIZE];
        out->kind = IMPORT_LIGHT_AREA;
        for (int k = 0; k < 2; k++)
            out->size[k] = (lamp ? lamp->size[k] : 0.1f) * w->units_per_metre;
        transform_to(world, lamp ? &up_of_collada : &up_of_fbx, 0.0, out->up);
        transform_to(world, lamp ? &back : &down, 0.0, out->direction);
        snprintf(text, sizeof text,
                 "area lamp \"%s\": its size and shape do not stand in the file: it is a square of 0.1 m", out->name);
        if (!lamp)
            write_text(w, IMPORT_RECORD_WARNING, text);
    }
    if (out->kind == IMPORT_LIGHT_SPOT && (lamp || w->is_fbx)) {
        const double outer = (double)(lamp ? l->mAngleInnerCone : l->mAngleOuterCone); /* assimp widens Collada's */
        const double blend = lamp ? (double)lamp->spot_blend : 1.0 - (double)l->mAngleInnerCone / fmax(outer, 1e-6);
        out->outer_cone = (float)outer;
        out->dims_by_cosine = w->has_dimming_spots;
        out->inner_cone = (float)(2.0 * full_angle(0.5 * outer, fmin(fmax(blend, 0.0), 1.0)));
    }
}

static void write_light(writer *w, const struct aiLight *l, matrix root)
{
    static const uint32_t KINDS[] = {
        [aiLightSource_UNDEFINED] = UINT32_MAX,         [aiLightSource_DIRECTIONAL] = IMPORT_LIGHT_DIRECTIONAL,
        [aiLightSource_POINT] = IMPORT_LIGHT_POINT,     [aiLightSource_SPOT] = IMPORT_LIGHT_SPOT,
        [aiLightSource_AMBIENT] = IMPORT_LIGHT_AMBIENT, [aiLightSource_AREA] = IMPORT_LIGHT_AREA};
    import_light out;
    matrix world;
    memset(&out, 0, sizeof out);
    memcpy(world, root, sizeof world);
    find_node(w->scene->mRootNode, &l->mName, root, 0, world);
    copy_text(out.name, sizeof out.name, &l->mName);
    out.kind = (unsigned)l->mType < sizeof KINDS / sizeof *KINDS ? KINDS[l->mType] : UINT32_MAX;
    const struct aiColor3D *c = l->mType == aiLightSource_AMBIENT ? &l->mColorAmbient : &l->mColorDiffuse;
    out.color = rgb_make((float)c->r, (float)c->g, (float)c->b);
    transform_to(world, &l->mPosition, 1.0, out.position);
    transform_to(world, &l->mDirection, 0.0, out.direction);
    transform_to(world, &l->mUp, 0.0, out.up);
    out.attenuation[0] = l->mAttenuationConstant;
    out.attenuation[1] = l->mAttenuationLinear;
    out.attenuation[2] = l->mAttenuationQuadratic;
    out.inner_cone = l->mAngleInnerCone;
    out.outer_cone = l->mAngleOuterCone;
    out.size[0] = (float)l->mSize.x;
    out.size[1] = (float)l->mSize.y;
    if (w->is_blenders)
        restore_blenders(w, l, world, &out);
    write_record(w, IMPORT_RECORD_LIGHT, &out, sizeof out);
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

static void write_scene(writer *w, const char *path)
{
    const struct aiScene *s = w->scene;
    static const matrix X_UP = {{0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    static const matrix Y_UP = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    static const matrix Z_UP = {{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}, {0, 0, 0, 1}};
    int up = up_axis(s, path);
    matrix root;
    find_maker(w, path);
    memcpy(root, up == 0 ? X_UP : up == 2 ? Z_UP : Y_UP, sizeof root);
    for (unsigned k = 0; k < s->mNumTextures; k++) {
        const struct aiTexture *t = s->mTextures[k];
        if (t->mHeight != 0)
            write_text(w, IMPORT_RECORD_WARNING, "a picture within the file is packed in no known way and is not used");
        write_record(w, IMPORT_RECORD_PICTURE, t->pcData, t->mHeight == 0 && t->pcData ? t->mWidth : 0);
    }
    for (unsigned k = 0; k < s->mNumMaterials; k++)
        write_material(w, s->mMaterials[k]);
    const char *dot = strrchr(path, '.');
    if (w->is_blenders && w->has_plain_shining && dot && strcasecmp(dot, ".dae") == 0)
        write_text(w, IMPORT_RECORD_WARNING,
                   "Blender writes no strength of emission to Collada files: surfaces shine with 1 times their colour");
    for (unsigned k = 0; k < s->mNumMeshes; k++)
        write_mesh(w, s->mMeshes[k]);
    write_instances(w, s->mRootNode, root, 0);
    for (unsigned k = 0; k < s->mNumCameras; k++)
        write_camera(w, s->mCameras[k], root);
    for (unsigned k = 0; k < s->mNumLights; k++)
        write_light(w, s->mLights[k], root);
    write_head(w, IMPORT_RECORD_END, 0);
}

bool assimp_write_records(const char *path, FILE *answer)
{
    writer w = {.out = answer, .is_sound = true};
    w.scene = aiImportFile(path, aiProcess_ValidateDataStructure | aiProcess_Triangulate);
    if (w.scene && w.scene->mRootNode) {
        write_scene(&w, path);
    } else {
        const char *text = aiGetErrorString();
        write_text(&w, IMPORT_RECORD_ERROR, text && text[0] ? text : "assimp cannot read the file");
    }
    return w.is_sound;
}

bool assimp_write_refusal(const char *text, FILE *answer)
{
    writer w = {.out = answer, .is_sound = true};
    write_text(&w, IMPORT_RECORD_ERROR, text);
    return w.is_sound;
}

bool assimp_reads_extension(const char *extension) { return aiIsExtensionSupported(extension) == AI_TRUE; }
