/* scene_hints.c: see scene_hints.h. */
#include "scene_hints.h"

#include <stdlib.h>

scene_hints scene_hints_default(void)
{
    return (scene_hints){.iso = 100.0f,
                         .filter = {.kind = FILTER_GAUSSIAN,
                                    .radius = {1.5f, 1.5f},
                                    .sigma = 0.5f,
                                    .b = 1.0f / 3.0f,
                                    .c = 1.0f / 3.0f,
                                    .tau = 3.0f}};
}

void scene_hints_reset(scene_hints *hints)
{
    free(hints->file_name);
    *hints = scene_hints_default();
}
