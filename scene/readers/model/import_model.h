/* import_model.h: what readers of foreign formats say of a file, in plain structs that hold no pointers, so that a
 * process can hand them to another: a row of records, each a head and its bytes. Whoever takes them believes nothing.
 * Flow: mesh_import_assimp (in afterglow-import) -> [here] -> import_scene. Threads: plain data. */
#ifndef AFTERGLOW_IMPORT_MODEL_H
#define AFTERGLOW_IMPORT_MODEL_H

#include "math/vec3.h"

#include <stdint.h>

enum { IMPORT_NAME_SIZE = 128, IMPORT_PATH_SIZE = 1024, IMPORT_TEXT_SIZE = 1024 };

/* Pictures that a material may have, and what they are multiplied by. */
typedef enum import_slot {
    IMPORT_COLOR, /* diffuse or base colour */
    IMPORT_EMISSION,
    IMPORT_OPACITY,   /* grey */
    IMPORT_ROUGHNESS, /* grey */
    IMPORT_METALLIC,  /* grey */
    IMPORT_NORMAL,    /* directions in tangent space; strength scales */
    IMPORT_BUMP,      /* heights; strength scales */
    IMPORT_SLOT_COUNT
} import_slot;

/* How a picture goes on beyond its edges. */
typedef enum import_wrap { IMPORT_REPEATS, IMPORT_IS_CLAMPED, IMPORT_IS_MIRRORED, IMPORT_IS_BLACK } import_wrap;

typedef struct import_picture {
    char path[IMPORT_PATH_SIZE]; /* as the file has it; "": none; "*N": the Nth within the file */
    float scale[2], offset[2];   /* st = uv * scale + offset */
    float strength;              /* 1 where the file says nothing */
    uint32_t wrap_s, wrap_t;     /* import_wrap */
} import_picture;

/* In the words and units of MTL. Negative: the file does not say. */
typedef struct import_material {
    char name[IMPORT_NAME_SIZE];
    int32_t illumination;      /* MTL's illum */
    rgb diffuse;               /* Kd, or the base colour */
    rgb specular;              /* Ks */
    rgb emission;              /* Ke */
    rgb filter;                /* Tf: what passes */
    float exponent;            /* Ns, Phong's */
    float opacity;             /* d: 1 is opaque */
    float ior;                 /* Ni */
    float roughness;           /* Pr */
    float metallic;            /* Pm */
    float clearcoat;           /* Pc */
    float clearcoat_roughness; /* Pcr */
    float transmission;        /* the share that goes through, as glTF's */
    import_picture pictures[IMPORT_SLOT_COUNT];
} import_material;

/* Followed by vertex_count positions, then as many normals and as many uvs or none of either, then 3 * triangle_count
 * indices. */
typedef struct import_mesh {
    char name[IMPORT_NAME_SIZE];
    uint32_t material_index;
    uint32_t vertex_count, triangle_count;
    uint32_t has_normals, has_uvs;
    uint32_t left_out; /* points and lines */
} import_mesh;

/* A mesh and its transform. */
typedef struct import_instance {
    uint32_t mesh_index;
    uint32_t unused;
    double world_from_mesh[4][4]; /* row, column */
} import_instance;

/* World space. */
typedef struct import_camera {
    char name[IMPORT_NAME_SIZE];
    double position[3], forward[3], up[3];
    float horizontal_fov;          /* radians, of the whole picture */
    float aspect;                  /* width / height; 0: not said */
    float orthographic_half_width; /* scene units; 0: perspective */
    float shift[2];                /* of the picture, right and up, as a share of its longer side */
} import_camera;

typedef enum import_light_kind {
    IMPORT_LIGHT_POINT,
    IMPORT_LIGHT_SPOT,
    IMPORT_LIGHT_DIRECTIONAL,
    IMPORT_LIGHT_AMBIENT,
    IMPORT_LIGHT_AREA
} import_light_kind;

/* The unit of a light's colour. */
typedef enum import_light_measure {
    IMPORT_LIGHT_SHADED, /* as rasterizers have it, see below */
    IMPORT_LIGHT_WATTS   /* as Blender has it: points and spots W over the whole sphere, areas W of which pi/4 goes out,
                          * suns W/m^2 */
} import_light_measure;

/* World space; in the words of rasterizers, where IMPORT_LIGHT_SHADED: a white surface that faces it appears as bright
 * as color * 1 / (attenuation[0] + attenuation[1] d + attenuation[2] d^2) at distance d. */
typedef struct import_light {
    char name[IMPORT_NAME_SIZE];
    uint32_t kind;
    rgb color;
    double position[3], direction[3], up[3];
    float attenuation[3];         /* of IMPORT_LIGHT_SHADED */
    uint32_t measure;             /* import_light_measure */
    float units_per_metre;        /* of IMPORT_LIGHT_WATTS, > 0 */
    float inner_cone, outer_cone; /* radians, the whole cone */
    uint32_t dims_by_cosine;      /* spot: 1: multiplied by the cosine to its axis, too */
    float size[2];                /* area: across and along up */
} import_light;

/* The records, in this order; pictures, materials and meshes are numbered as they come. */
typedef enum import_record_kind {
    IMPORT_RECORD_ERROR,   /* text, without an end mark; nothing follows */
    IMPORT_RECORD_WARNING, /* text */
    IMPORT_RECORD_PICTURE, /* within the file: a file of its own, PNG or JPEG; or nothing, of which a warning told */
    IMPORT_RECORD_MATERIAL,
    IMPORT_RECORD_MESH,
    IMPORT_RECORD_INSTANCE,
    IMPORT_RECORD_CAMERA,
    IMPORT_RECORD_LIGHT,
    IMPORT_RECORD_END /* without it the answer is cut short */
} import_record_kind;

typedef struct import_record {
    uint32_t kind;
    uint32_t unused;
    uint64_t size; /* of the bytes that follow */
} import_record;

#endif
