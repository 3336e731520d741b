/* odd_scene.h: what is odd about a picture that is complete, said once: nothing shines, nothing is in view, nothing is
 * lit, the eye stands inside of a solid, or the light is of another scale than the scene.
 * Flow: render.c -> [here] -> log. Threads: as in afterglow.h. */
#ifndef AFTERGLOW_ODD_SCENE_H
#define AFTERGLOW_ODD_SCENE_H

#include "rendering.h"

/* A warning in the log, or none. What may well be so in a part of a
 * picture is said of whole pictures alone. */
void odd_scene_warn(const struct ag_rendering *r);

#endif
