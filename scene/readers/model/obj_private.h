/* obj_private.h: an OBJ file as it has been read, between reading (obj_file.c) and meshes (obj_meshes.c).
 * Threads: one per scene. */
#ifndef AFTERGLOW_OBJ_PRIVATE_H
#define AFTERGLOW_OBJ_PRIVATE_H

#include "model/importer.h"
#include "model/mtl_file.h"
#include "text/text_lines.h"

#define OBJ_NONE      UINT32_MAX
#define OBJ_MAX_COUNT (UINT32_MAX / 4)

/* A corner's normal: one of the file's (its number), one of a smoothing group's (OBJ_FIRST_SMOOTH + number),
 * or OBJ_NONE. */
#define OBJ_FIRST_SMOOTH (UINT32_MAX / 2)

typedef struct obj_corner {
    uint32_t position, uv, normal;
} obj_corner;

typedef struct obj_face {
    size_t first_corner;
    uint32_t corner_count;
    uint32_t material; /* in obj.used */
    uint32_t group;    /* smoothing; 0: flat */
} obj_face;

/* A material as faces name it. */
typedef struct obj_material {
    char name[IMPORT_NAME_SIZE];
    size_t first_face, face_count, triangle_count;
    size_t corner_count; /* most of any face */
} obj_material;

typedef struct obj {
    importer to;
    text_lines lines;
    mtl_library library;
    vec3 *positions, *normals, *smooth;
    vec2 *uvs;
    size_t position_total, normal_total, uv_total; /* in the whole file */
    size_t position_count, normal_count, uv_count; /* so far */
    size_t smooth_count, smooth_capacity;
    obj_corner *corners;
    size_t corner_count, corner_capacity;
    obj_face *faces; /* of one material together, once all are read */
    size_t face_count, face_capacity;
    obj_material *used;
    size_t used_count, used_capacity;
    name_table used_names;
    uint32_t material, group; /* of the faces that follow */
} obj;

/* Makes room for one more item; items: the address of an array's pointer. Returns false when out of memory. */
bool obj_grow(void *items, size_t count, size_t *capacity, size_t item_size);

/* Makes meshes of the scene of all that has been read. Errors: AG_ERROR_INPUT, AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status obj_add_meshes(obj *o);

#endif
