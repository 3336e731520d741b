/* import_defaults.h: a camera and light for files that bring none, as viewers of models make them.
 * The world is right-handed with y up and its front towards +z, as glTF and OBJ have it; readers of other formats turn
 * their geometry first.
 * Flow: gltf_reader, mesh_import_…, scene_file -> [here] -> scene. Threads: one per scene. */
#ifndef AFTERGLOW_IMPORT_DEFAULTS_H
#define AFTERGLOW_IMPORT_DEFAULTS_H

#include "scene.h"

/* Sets the scene's camera: from the front, a little from the right and from above, 45 degrees, so that the bounds of
 * all shapes are in the picture whatever its proportions; closed_room.h puts it inside of a room. Said at info level.
 * Shapes must be there already; the scene is not yet committed. Always AG_OK: where there is nothing to see, it looks
 * at the origin. */
ag_status import_add_default_camera(scene *s, log_sink *log);

/* Adds an even sky (0.5 W/m^2/sr) and a sun (1.5 W/m^2) over the camera's left shoulder, or without a camera over that
 * of import_add_default_camera's: white surfaces that face the sun stay just below 1. Said at info level. Errors:
 * AG_ERROR_MEMORY. */
ag_status import_add_default_light(scene *s, log_sink *log);

#endif
