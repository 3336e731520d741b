/* blender_lamps.h: how lamps of Blender's are measured, and what its Collada files say of them beside the format.
 * Rests on: its exporters (io_scene_fbx; source/blender/io/collada), and Cycles, held against them by
 * tests/fixtures/blender_rooms.py.
 *
 *   lamp          Blender             FBX, as assimp hands it over   Collada
 *   point, spot   W over 4 pi sr      colour times W (file: 100 W)   colour times W
 *   sun           W/m^2               colour times W/m^2             colour times W/m^2
 *   area          W; pi/4 of it goes  without size or shape          a point; size and shape stand in <extra>
 *                 out (Cycles)
 *   spot's edge   smoothstep in the   angles in proportion           a falloff exponent; "spotblend" in <extra>
 *                 cosine, by "blend";
 *                 before 3.5 times the
 *                 cosine itself
 *   lengths       Blender's units     100 / UnitScaleFactor units;   <unit meter>: m to the unit, as
 *                                     where the scene's own unit is  assimp hands it over
 *                                     no m, the scale of nodes
 *
 * Flow: mesh_import_assimp -> [here]. Threads: plain data. */
#ifndef AFTERGLOW_BLENDER_LAMPS_H
#define AFTERGLOW_BLENDER_LAMPS_H

#include "model/import_model.h"

/* A lamp of a Collada file's node. */
typedef struct blender_lamp {
    char node[IMPORT_NAME_SIZE]; /* its id */
    bool is_area;
    float spot_blend; /* 0 to 1 */
    float size[2];    /* of areas: m, of a rectangle of the same area */
} blender_lamp;

typedef struct blender_lamps {
    blender_lamp *items; /* [count], owned */
    size_t count;
    float metres_per_unit; /* > 0 */
} blender_lamps;

/* Reads the <extra> of lamps, line by line as Blender writes them; what it does not know is not there. Runs in the
 * process that reads the model. */
void blender_lamps_read(const char *path, blender_lamps *out_lamps);
/* NULL: none. */
const blender_lamp *blender_lamps_find(const blender_lamps *lamps, const char *node);

#endif
