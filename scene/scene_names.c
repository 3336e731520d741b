/* scene_names.c: see scene_names.h. */
#define _POSIX_C_SOURCE 200809L
#include "scene_names.h"

#include "scene.h"

#include <stdlib.h>
#include <string.h>

ag_status scene_set_name(scene *s, scene_named kind, uint32_t index, const char *name)
{
    scene_names *n = &s->names;
    if (!name || !*name)
        return AG_OK;
    if (index >= n->capacities[kind]) {
        uint32_t capacity = index < UINT32_MAX / 4 ? 2 * index + 16 : UINT32_MAX;
        char **larger = realloc(n->names[kind], capacity * sizeof *larger);
        if (!larger)
            return AG_ERROR_MEMORY;
        memset(larger + n->capacities[kind], 0, (capacity - n->capacities[kind]) * sizeof *larger);
        n->names[kind] = larger;
        n->capacities[kind] = capacity;
    }
    char *copy = strdup(name);
    if (!copy)
        return AG_ERROR_MEMORY;
    free(n->names[kind][index]);
    n->names[kind][index] = copy;
    return AG_OK;
}

const char *scene_name(const scene *s, scene_named kind, uint32_t index)
{
    return index < s->names.capacities[kind] ? s->names.names[kind][index] : NULL;
}

void scene_names_reset(scene_names *names)
{
    for (int kind = 0; kind < SCENE_NAMED_COUNT; kind++) {
        for (uint32_t i = 0; i < names->capacities[kind]; i++)
            free(names->names[kind][i]);
        free(names->names[kind]);
    }
    *names = (scene_names){0};
}
