/* lamp_value.h: by which factor an area light shines at a point of its shape, by its texture and its shape's alpha.
 * Flow: texture, shape -> [here] -> area_light, radiance_map. Threads: pure functions. */
#ifndef AFTERGLOW_LAMP_VALUE_H
#define AFTERGLOW_LAMP_VALUE_H

#include "light/light.h"

/* Returns the factor by which a texture changes its radiance at a point, >= 0; 1 without a texture. */
rgb lamp_texture_value(const struct scene *s, const light *l, const struct surface_hit *hit);

/* Returns whether an area light's radiance varies, by its texture or by its shape's alpha. */
bool lamp_varies(const struct scene *s, const light *l);
/* Returns the share of its radiance that a point sampled on an area light emits: the texture's value, times the shape's
 * alpha there unless the shape is invisible (alpha.h). Rays that meet the lamp have already been tested against alpha.
 * at: read only if the light varies. */
rgb lamp_sampled_value(const struct scene *s, const light *l, const struct surface_sample *at);

#endif
