/* infinite_light.h: what lights of kind LIGHT_INFINITE send to a point of the scene: light with a portal reaches only
 * what sees through the portal. Directions are in world space, unit, towards the light. Flow: environment, portal ->
 * [here] -> light_type; the renderer asks for what rays see that meet nothing. Threads: pure functions. */
#ifndef AFTERGLOW_INFINITE_LIGHT_H
#define AFTERGLOW_INFINITE_LIGHT_H

#include "light/light.h"

/* Returns radiance, W/m^2/sr. */
rgb infinite_light_radiance(const light *l, vec3 point, vec3 direction);
/* Returns the density with which light_sample_from_point picks the direction, 1/sr. */
float infinite_light_pdf(const light *l, vec3 point, vec3 direction);

#endif
