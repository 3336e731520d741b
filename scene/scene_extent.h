/* scene_extent.h: how far a scene reaches and how much surface it has, instances counted.
 * Flow: scene_commit, the importers' default camera and the aim of caustic photons ask. Threads: read-only. */
#ifndef AFTERGLOW_SCENE_EXTENT_H
#define AFTERGLOW_SCENE_EXTENT_H

#include "scene.h"

/* A box around the shapes that are wanted (is_wanted NULL: all), wherever instances put them and for as long as the
 * shutter is open; min > max where there are none. Needs no commit. Errors: AG_ERROR_MEMORY. */
ag_status scene_find_bounds(const scene *s, bool (*is_wanted)(const scene *s, const shape *item), vec3 *out_min,
                            vec3 *out_max);

/* A box around an object in its own space, min > max where it has no shapes; needs object_shapes. And one around such a
 * box where an instance puts it, for as long as the shutter is open. */
void scene_find_object_bounds(const scene *s, uint32_t object_index, vec3 *out_min, vec3 *out_max);
void scene_place_bounds(const scene *s, uint32_t instance_index, vec3 *in_out_min, vec3 *in_out_max);

/* A ball around what is small beside a few giants (a ground of kilometres, a dome), where there is such: nothing is of
 * a size between. Radius 0 where there is not. Needs bounds_min and bounds_max. Errors: AG_ERROR_MEMORY. */
ag_status scene_find_detail(const scene *s, vec3 *out_center, float *out_radius);

/* m^2, of all shapes that are to be seen, as they stand when the shutter opens. Of objects that an instance stretches
 * more one way than another it is right where they have flat sides, and within some hundredths where they are round.
 * Needs committed shapes and object_shapes. Errors: AG_ERROR_MEMORY. */
ag_status scene_find_area(const scene *s, float *out_area);

#endif
