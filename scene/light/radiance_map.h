/* radiance_map.h: the distribution of light over a lamp with a texture or with holes: a grid over the unit square
 * that shape_sample_area maps evenly onto the shape.
 * Flow: scene_commit makes it; light and light_emission sample it. Threads: read-only once created. */
#ifndef AFTERGLOW_RADIANCE_MAP_H
#define AFTERGLOW_RADIANCE_MAP_H

#include "light/light.h"
#include "math/distribution_2d.h"

typedef struct radiance_map {
    distribution_2d picks;
    rgb mean; /* of lamp_sampled_value over the shape's area */
} radiance_map;

/* Builds the map of an area light that varies, whose shape is committed. Errors: AG_ERROR_MEMORY. */
ag_status radiance_map_create(const struct scene *s, const light *l, radiance_map **out_map);
void radiance_map_destroy(radiance_map *m); /* NULL is fine */

/* Maps a sample of the unit square in proportion to radiance, and writes how many times denser than uniform samples are
 * there. Returns false where the lamp is black. */
bool radiance_map_sample(const radiance_map *m, vec2 u, vec2 *out_u, float *out_density);
float radiance_map_density(const radiance_map *m, vec2 u);

#endif
