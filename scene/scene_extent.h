/* scene_extent.h: bounds and surface area of a scene, instances included.
 * Flow: scene_commit, the importers' default camera and the aim of caustic photons ask. Threads: read-only. */
#ifndef AFTERGLOW_SCENE_EXTENT_H
#define AFTERGLOW_SCENE_EXTENT_H

#include "scene.h"

/* Finds a box around the shapes for which is_wanted returns true (NULL: all), wherever instances put them and for the
 * whole shutter; min > max where there are none. It needs no commit. Errors: AG_ERROR_MEMORY. */
ag_status scene_find_bounds(const scene *s, bool (*is_wanted)(const scene *s, const shape *item), vec3 *out_min,
                            vec3 *out_max);

/* Find a box around an object in its own space, min > max where it has no shapes, which needs object_shapes; and a box
 * around such a box where an instance puts it, for the whole shutter. */
void scene_find_object_bounds(const scene *s, uint32_t object_index, vec3 *out_min, vec3 *out_max);
void scene_place_bounds(const scene *s, uint32_t instance_index, vec3 *in_out_min, vec3 *in_out_max);

/* Finds a ball around the small shapes of a scene that has a few huge ones as well (a ground of kilometres, a dome),
 * with none of a size between; else radius 0. It needs bounds_min and bounds_max. Errors: AG_ERROR_MEMORY. */
ag_status scene_find_detail(const scene *s, vec3 *out_center, float *out_radius);

/* Finds the area of all visible shapes at the opening of the shutter, m^2. For objects that an instance scales unevenly
 * it is exact for flat surfaces, and within a few hundredths for curved ones. It needs committed shapes and
 * object_shapes. Errors: AG_ERROR_MEMORY. */
ag_status scene_find_area(const scene *s, float *out_area);

#endif
