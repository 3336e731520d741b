/* portal.h: a rectangle that is the only opening for an infinite light: a window, seen from inside.
 * Rests on: Bitterli, Novak, Jarosz, "Portal-Masked Environment Map Sampling", 2015: on a map whose coordinates are
 * the angles along the rectangle's two edges, what a point sees through it is itself a rectangle, and sums over
 * rectangles are four look-ups. The map is a density alone, radiance is always the light's own.
 * Flow: pbrt_environments makes it; environment and light_emission sample it. Threads: read-only once created. */
#ifndef AFTERGLOW_PORTAL_H
#define AFTERGLOW_PORTAL_H

#include "afterglow/base.h"
#include "light/light.h"

typedef struct portal {
    vec3 corner;         /* world space, the origin of x and y */
    frame axes;          /* x, y along the edges, z out of the room, towards the light */
    float width, height; /* along x and y */
    uint32_t size;       /* cells of the tables along a side */
    double *light;  /* [size + 1][size + 1], sums over the cells above and left: radiance times solid angle; owned */
    double *flux;   /* such sums of radiance times solid angle times the cosine to z */
    rgb irradiance; /* on its plane from outside, W/m^2 */
} portal;

/* Sets a portal from corners, as pbrt's "portal" in world space: edges 0 to 3 and 0 to 1 are x and y. Returns false
 * where they are no rectangle. */
bool portal_init(const vec3 corners[4], portal *out_portal);

/* sky: the radiance that shines through it. placed: see portal_init. Errors: AG_ERROR_MEMORY. */
ag_status portal_create(const portal *placed, const light_directions *sky, portal **out_portal);
void portal_destroy(portal *p); /* NULL is fine */

/* Directions are in world space, unit, towards the light. */

/* Whether the point is on the room's side. */
bool portal_is_before(const portal *p, vec3 point);
/* Returns whether its light may reach a point from the side of a normal, which may be 0 0 0 (all sides). */
bool portal_reaches(const portal *p, vec3 point, vec3 normal);
/* Returns whether a ray leaves the room through it. */
bool portal_is_crossed(const portal *p, vec3 point, vec3 direction);
/* Samples a direction out through it, nearly in proportion to radiance, by u in [0,1)^2. Returns false where there is
 * none. */
bool portal_sample(const portal *p, vec3 point, vec2 u, vec3 *out_direction, float *out_pdf_solid_angle);
/* Returns the density of portal_sample, 1/sr; 0 for directions that miss the portal. */
float portal_pdf(const portal *p, vec3 point, vec3 direction);
/* Samples a point on it and a direction, nearly in proportion to the flux that enters; with a target, to the flux that
 * may meet that ball. The density is per area and solid angle. Returns false where the sample carries no flux. */
bool portal_sample_flux(const portal *p, const light_target *target, const emission_numbers *numbers,
                        vec3 *out_position, vec3 *out_direction, float *out_pdf);

#endif
