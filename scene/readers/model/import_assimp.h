/* import_assimp.h: what the files that know assimp share. Private to them.
 * Flow: mesh_import_assimp -> material_import_assimp, view_import_assimp. Threads: one. */
#ifndef AFTERGLOW_IMPORT_ASSIMP_H
#define AFTERGLOW_IMPORT_ASSIMP_H

#include "model/blender_lamps.h"
#include "model/blender_shifts.h"
#include "model/import_model.h"

#include <assimp/scene.h>

#include <stdio.h>

typedef double assimp_matrix[4][4];

typedef struct assimp_writer {
    FILE *out;
    const struct aiScene *scene;
    bool is_sound;            /* all could be written */
    bool is_blenders, is_fbx; /* the file is by Blender's exporter of Collada or FBX */
    bool has_dimming_spots;
    float units_per_metre;    /* by Blender's exporter: the file's units in one of Blender's */
    blender_lamps lamps;      /* of such a one, of Collada */
    blender_shifts shifts;    /* of such a one */
    bool has_plain_shining;   /* a material shines */
    bool has_default_surface; /* a material's roughness and specular are not in the file, but known to be left out */
} assimp_writer;

/* Writes fail in silence, and is_sound tells. */
void assimp_write_record(assimp_writer *w, import_record_kind kind, const void *bytes, size_t size);
void assimp_write_text(assimp_writer *w, import_record_kind kind, const char *text);
void assimp_copy_text(char *out, size_t size, const struct aiString *text); /* cut to size - 1 bytes */

/* Finds the transform of the node with that name; where there is none (NULL), or no name, out_world_from_node stays. */
const struct aiNode *assimp_find_node(const struct aiNode *node, const struct aiString *name,
                                      assimp_matrix world_from_parent, int depth, assimp_matrix out_world_from_node);
/* w: 1 of a point, 0 of a direction. */
void assimp_transform(assimp_matrix m, const struct aiVector3D *v, double w, double out[3]);

/* material_import_assimp.c */
void assimp_write_material(assimp_writer *w, const struct aiMaterial *m);

/* view_import_assimp.c. The first finds which program wrote the file, since lamps and cameras depend on that, and is
 * called before the others. root: the world from the scene's root. */
void assimp_find_maker(assimp_writer *w, const char *path);
void assimp_write_camera(assimp_writer *w, const struct aiCamera *c, assimp_matrix root);
void assimp_write_light(assimp_writer *w, const struct aiLight *l, assimp_matrix root);

#endif
