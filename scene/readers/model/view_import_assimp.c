/* view_import_assimp.c: cameras and lights as assimp reads them, as records, and what Blender's files mean by theirs:
 * see import_assimp.h. Threads: one. */
#define _POSIX_C_SOURCE 200809L
#include "model/import_assimp.h"

#include <assimp/commonMetaData.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Blender's files say how much of a landscape picture's width is seen, whatever the picture; unless its "Sensor Fit" is
 * set, which they do not say, that is the height of one that is higher than wide. */
static void fit_longer_side(import_camera *c)
{
    const double aspect = (double)c->aspect;
    if (!(aspect > 0.0 && aspect < 1.0))
        return;
    c->horizontal_fov = (float)(2.0 * atan(tan(0.5 * (double)c->horizontal_fov) * aspect));
    c->orthographic_half_width = (float)((double)c->orthographic_half_width * aspect);
}

void assimp_write_camera(assimp_writer *w, const struct aiCamera *c, assimp_matrix root)
{
    import_camera out;
    assimp_matrix world;
    struct aiVector3D position = c->mPosition;
    memset(&out, 0, sizeof out);
    memcpy(world, root, sizeof world);
    const struct aiNode *node = assimp_find_node(w->scene->mRootNode, &c->mName, root, 0, world);
    if (node) { /* what stands in both is meant once */
        const struct aiMatrix4x4 *t = &node->mTransformation;
        float away = fabsf((float)(position.x - t->a4)) + fabsf((float)(position.y - t->b4)) +
                     fabsf((float)(position.z - t->c4));
        if (away <= 1e-5f * (fabsf((float)t->a4) + fabsf((float)t->b4) + fabsf((float)t->c4)))
            position.x = position.y = position.z = 0;
    }
    assimp_copy_text(out.name, sizeof out.name, &c->mName);
    assimp_transform(world, &position, 1.0, out.position);
    assimp_transform(world, &c->mLookAt, 0.0, out.forward);
    assimp_transform(world, &c->mUp, 0.0, out.up);
    out.horizontal_fov = c->mHorizontalFOV;
    out.aspect = c->mAspect;
    out.orthographic_half_width = c->mOrthographicWidth;
    if (w->is_blenders)
        fit_longer_side(&out);
    memcpy(out.shift, w->shifts.of_all, sizeof out.shift);
    assimp_write_record(w, IMPORT_RECORD_CAMERA, &out, sizeof out);
    if (w->shifts.differ) {
        char text[IMPORT_TEXT_SIZE];
        snprintf(text, sizeof text,
                 "camera \"%s\": the file's cameras shift their pictures differently, and which does so how is not "
                 "read: this one is seen without a shift",
                 out.name);
        assimp_write_text(w, IMPORT_RECORD_WARNING, text);
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

/* The scale of a lamp's or camera's node; 0: it does not stand at the root. */
static double root_scale(const struct aiScene *s, const struct aiString *name)
{
    assimp_matrix identity = {{0}}, world;
    const struct aiNode *node = assimp_find_node(s->mRootNode, name, identity, 0, world);
    if (!node || node->mParent != s->mRootNode)
        return 0.0;
    const struct aiMatrix4x4 *t = &node->mTransformation;
    return sqrt((double)t->a1 * (double)t->a1 + (double)t->b1 * (double)t->b1 + (double)t->c1 * (double)t->c1);
}

/* Blender's FBX files have one unit of length in every scene, and what its own unit is in that as the scale of all
 * objects at the root; so this is known where cameras and lamps there, which are seldom scaled, agree. */
static void find_unit_of_fbx(assimp_writer *w)
{
    const struct aiScene *s = w->scene;
    double agreed = 0.0;
    unsigned votes = 0;
    for (unsigned k = 0; k < s->mNumCameras + s->mNumLights; k++) {
        const bool is_camera = k < s->mNumCameras;
        const double scale = root_scale(s, is_camera ? &s->mCameras[k]->mName : &s->mLights[k - s->mNumCameras]->mName);
        if (!(scale > 1e-6 && scale < 1e6))
            continue;
        if (votes > 0 && fabs(scale - agreed) > 1e-3 * agreed)
            return;
        agreed = scale;
        votes += is_camera ? 2 : 1;
    }
    if (votes >= 2)
        w->units_per_metre = (float)agreed;
}

/* Finds which program has written the file, on which the units of its lamps depend: see blender_lamps.h. */
void assimp_find_maker(assimp_writer *w, const char *path)
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
    if (w->is_blenders && is_fbx)
        find_unit_of_fbx(w);
    if (w->is_blenders && is_collada) {
        blender_lamps_read(path, &w->lamps);
        w->units_per_metre = w->lamps.metres_per_unit;
    }
    if (w->is_blenders && s->mNumCameras > 0)
        blender_shifts_read(path, is_fbx, &w->shifts);
}

/* The angle inside of which a spot of Blender's is full, from its half angle and blend: the edge takes that share of
 * what the cosine has to go from the axis on. */
static double full_angle(double half_angle, double blend)
{
    const double dark = cos(half_angle);
    return acos(double_clamp(dark + (1.0 - dark) * blend, -1.0, 1.0));
}

/* Restores the lamp that Blender meant, in a file of its own. */
static void restore_blenders(assimp_writer *w, const struct aiLight *l, assimp_matrix world, import_light *out)
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
        assimp_transform(world, lamp ? &up_of_collada : &up_of_fbx, 0.0, out->up);
        assimp_transform(world, lamp ? &back : &down, 0.0, out->direction);
        snprintf(text, sizeof text,
                 "area lamp \"%s\": its size and shape do not stand in the file: it is a square of 0.1 m", out->name);
        if (!lamp)
            assimp_write_text(w, IMPORT_RECORD_WARNING, text);
    }
    if (out->kind == IMPORT_LIGHT_SPOT && (lamp || w->is_fbx)) {
        const double outer = (double)(lamp ? l->mAngleInnerCone : l->mAngleOuterCone); /* assimp widens Collada's */
        const double blend =
            lamp ? (double)lamp->spot_blend : 1.0 - (double)l->mAngleInnerCone / double_max(outer, 1e-6);
        out->outer_cone = (float)outer;
        out->dims_by_cosine = w->has_dimming_spots;
        out->inner_cone = (float)(2.0 * full_angle(0.5 * outer, double_clamp(blend, 0.0, 1.0)));
    }
}

void assimp_write_light(assimp_writer *w, const struct aiLight *l, assimp_matrix root)
{
    static const uint32_t KINDS[] = {
        [aiLightSource_UNDEFINED] = UINT32_MAX,         [aiLightSource_DIRECTIONAL] = IMPORT_LIGHT_DIRECTIONAL,
        [aiLightSource_POINT] = IMPORT_LIGHT_POINT,     [aiLightSource_SPOT] = IMPORT_LIGHT_SPOT,
        [aiLightSource_AMBIENT] = IMPORT_LIGHT_AMBIENT, [aiLightSource_AREA] = IMPORT_LIGHT_AREA};
    import_light out;
    assimp_matrix world;
    memset(&out, 0, sizeof out);
    memcpy(world, root, sizeof world);
    assimp_find_node(w->scene->mRootNode, &l->mName, root, 0, world);
    assimp_copy_text(out.name, sizeof out.name, &l->mName);
    out.kind = (unsigned)l->mType < sizeof KINDS / sizeof *KINDS ? KINDS[l->mType] : UINT32_MAX;
    const struct aiColor3D *c = l->mType == aiLightSource_AMBIENT ? &l->mColorAmbient : &l->mColorDiffuse;
    out.color = rgb_make((float)c->r, (float)c->g, (float)c->b);
    assimp_transform(world, &l->mPosition, 1.0, out.position);
    assimp_transform(world, &l->mDirection, 0.0, out.direction);
    assimp_transform(world, &l->mUp, 0.0, out.up);
    out.attenuation[0] = l->mAttenuationConstant;
    out.attenuation[1] = l->mAttenuationLinear;
    out.attenuation[2] = l->mAttenuationQuadratic;
    out.inner_cone = l->mAngleInnerCone;
    out.outer_cone = l->mAngleOuterCone;
    out.size[0] = (float)l->mSize.x;
    out.size[1] = (float)l->mSize.y;
    if (w->is_blenders)
        restore_blenders(w, l, world, &out);
    assimp_write_record(w, IMPORT_RECORD_LIGHT, &out, sizeof out);
}
