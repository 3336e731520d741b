/* blender_shifts.h: how far Blender's exporters say that a camera's picture is shifted, which assimp does not hand on.
 * Rests on: io_scene_fbx, whose FilmOffsetX and FilmOffsetY are the shift times FilmWidth; the <extra> of Collada files
 * (source/blender/io/collada). Flow: mesh_import_assimp, in its process -> [here]. Threads: plain functions. */
#ifndef AFTERGLOW_BLENDER_SHIFTS_H
#define AFTERGLOW_BLENDER_SHIFTS_H

#include <stdbool.h>

typedef struct blender_shifts {
    float of_all[2]; /* right and up, as a share of the picture's longer side; 0 where the cameras differ */
    bool differ;     /* the files do not tell which shift belongs to which picture */
} blender_shifts;

/* path: of a binary FBX file, or of a Collada file. A file that cannot be read has no shifts. */
void blender_shifts_read(const char *path, bool is_fbx, blender_shifts *out_shifts);

#endif
