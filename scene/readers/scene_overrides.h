/* scene_overrides.h: what scene_request puts instead of what a file says, or beside it: camera, sun, sky.
 *
 * Suns and skies have compass directions. Up is y in models and glTF; in pbrt's text it is the axis nearest to the
 * up of the file's own camera; scene_request.up says otherwise. North is, of the axes across up: where y is up, -z (in
 * a left-handed world, as pbrt's are, +z), so that east is +x; where z is up, +y; where x is up, +y. Azimuths go from
 * north over east, clockwise for who looks down from above: Blender's Sun Position has them so, and a Blender world
 * whose z was up and whose exporter has turned it keeps its north. A pbrt world is left-handed but for cameras that
 * mirror it. Flow: readers -> scene_file -> [here] -> scene. Threads: one per scene. */
#ifndef AFTERGLOW_SCENE_OVERRIDES_H
#define AFTERGLOW_SCENE_OVERRIDES_H

#include "scene.h"

/* To be called for each camera of a file: records its names, the second NULL or "" where there is but one, and returns
 * whether it is the one to use: the first one, or the first of the requested name. Errors: AG_ERROR_MEMORY. */
ag_status scene_overrides_meet_camera(scene *s, const char *name, const char *second_name, bool *out_is_wanted);

/* World from one whose y is up, for what is made up: axes all, by what is asked for. */
frame scene_overrides_upright(const scene *s);

/* Returns whether the settings give light, or drop the file's lights: then none is added. */
bool scene_overrides_light(const scene *s);

/* When all is read. path: for messages. s->request is not NULL. Errors: AG_ERROR_ARGUMENT (there is no such camera, or
 * it makes no sense), those of light_picture; the log says which. */
ag_status scene_overrides_apply(run_context *run, const char *path, bool is_pbrt, scene *s);

#endif
