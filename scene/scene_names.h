/* scene_names.h: the names of shapes and materials in the scene file, for selecting them in a picture.
 * Flow: readers -> [here] -> renderer's id mattes. Threads: one builds; any number read. */
#ifndef AFTERGLOW_SCENE_NAMES_H
#define AFTERGLOW_SCENE_NAMES_H

#include "afterglow/base.h"

#include <stdint.h>

struct scene;

typedef enum scene_named { NAMED_MATERIAL, NAMED_SHAPE, NAMED_OBJECT } scene_named;
enum { SCENE_NAMED_COUNT = NAMED_OBJECT + 1 };

/* Names by kind and index; all zero: empty. */
typedef struct scene_names {
    char **names[SCENE_NAMED_COUNT]; /* by index; NULL where there is none */
    uint32_t capacities[SCENE_NAMED_COUNT];
} scene_names;

/* Sets a name, which is copied; an empty one or NULL: none. Errors: AG_ERROR_MEMORY. */
ag_status scene_set_name(struct scene *s, scene_named kind, uint32_t index, const char *name);

/* Returns a name, which the scene owns; NULL where there is none. */
const char *scene_name(const struct scene *s, scene_named kind, uint32_t index);

void scene_names_reset(scene_names *names);

#endif
