/* scene_forms.h: the forms that rays meet in a scene, each with its fingerprint and its bounds: to tell where two
 * scenes differ, as one frame of an animation does from the next. What a surface is made of, and what shines, is not
 * asked. Flow: scene -> [here] -> irradiance_carry. Threads: any number, of a committed scene. */
#ifndef AFTERGLOW_SCENE_FORMS_H
#define AFTERGLOW_SCENE_FORMS_H

#include "math/hash128.h"
#include "scene.h"

typedef struct scene_box {
    vec3 low, high;
} scene_box;

/* A shape of the world itself, or an instance, wherever it is while the shutter is open. */
typedef struct scene_form {
    hash128 is;
    scene_box bounds;
} scene_form;

typedef struct scene_forms {
    scene_form *forms; /* owned, sorted */
    uint32_t count;
    hash128 passed_surfaces; /* scene_hash_of_passed_surfaces */
    bool has_curves;
} scene_forms;

/* Keeps nothing of the scene. Errors: AG_ERROR_MEMORY. */
ag_status scene_forms_create(const scene *s, scene_forms *out_forms);
void scene_forms_reset(scene_forms *forms);

enum { SCENE_DIFFERENCE_BOXES = 256 };

/* Boxes around all forms that one of two scenes has and the other has not. A ray that asks for surfaces gives the same
 * bits in both where it stays clear of them: Embree's robust mode loses no hit to the shape of its tree. Curves it
 * finds by iteration, and which of them first depends on the tree. */
typedef struct scene_difference {
    bool is_known; /* false: no place is known to be the same */
    uint32_t count;
    scene_box boxes[SCENE_DIFFERENCE_BOXES];
} scene_difference;

/* Errors: AG_ERROR_MEMORY. */
ag_status scene_forms_compare(const scene_forms *a, const scene_forms *b, scene_difference *out_difference);

/* Whether any of the boxes comes nearer to the point than that, squared. */
bool scene_difference_is_near(const scene_difference *d, vec3 point, float distance_squared);

#endif
