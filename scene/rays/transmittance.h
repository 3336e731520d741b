/* transmittance.h: the share of light that is left along a ray between two vertices of a path: media absorb and
 * scatter, and light crosses interfaces unbent. All rays of photon tracing and rendering are cast here. Rests on:
 * Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 11.4 and 14.2 (medium interfaces). Flow:
 * transport, direct lighting, photon tracing -> [here] -> rays.h, which is enough where a scene has neither. Threads:
 * pure but for the caller's counter. */
#ifndef AFTERGLOW_TRANSMITTANCE_H
#define AFTERGLOW_TRANSMITTANCE_H

#include "rays/rays.h"
#include "scene.h"

/* A ray ends without light at this many interfaces and panes, and is counted in *in_out_cut. */
enum { TRANSMITTANCE_CROSSINGS_MAX = 256 };

/* Finds the nearest surface that scatters, along a ray of unit direction. ray->medium becomes the medium in front of
 * it. *out_transmittance: the transmittance up to the surface or, where there is none, to infinity. out_hit->distance:
 * the whole distance. Returns false also where the transmittance is 0. */
bool transmittance_intersect(const scene *s, scene_ray *ray, uint64_t *in_out_cut, surface_hit *out_hit,
                             rgb *out_transmittance);

/* Where a ray that may be scattered on its way has come to. */
typedef enum ray_end {
    RAY_ENDS_NOWHERE,    /* it has left the scene, or no light is left */
    RAY_ENDS_AT_SURFACE, /* that scatters */
    RAY_ENDS_IN_MEDIUM   /* that has scattered it */
} ray_end;

/* Follows a ray of unit direction, as transmittance_intersect does, up to where a medium scatters it, which two random
 * numbers in [0, 1) and what the light carries decide (medium_flight_begin). *out_weight: of the light that comes from
 * there: the transmittance over the probability of coming there, and in a medium times sigma_s. out_hit: in a medium,
 * the position, the distance and the time are those of a point of no surface (epsilon 0), and the normals point back
 * along the ray. */
ray_end transmittance_travel(const scene *s, scene_ray *ray, rgb carried, vec2 u, uint64_t *in_out_cut,
                             surface_hit *out_hit, rgb *out_weight);

/* Returns whether transmittance_intersect of such a ray equals scene_intersect, since nothing on its way absorbs. */
static inline bool transmittance_is_one(const scene *s, const scene_ray *ray)
{
    return !s->has_interfaces && ray->medium == SCENE_NO_MEDIUM;
}

/* Returns the transmittance of a ray up to `reach` (in lengths of its direction, INFINITY is fine); 0 where a surface
 * blocks it. */
rgb transmittance_of_ray(const scene *s, scene_ray ray, float reach, uint64_t *in_out_cut);

/* transmittance_of_ray of a ray that passes panes and slabs, multiplied by their transmittance (pane.h, slab.h): for
 * light that is sampled at its lamp. It includes the reflections between the faces of one pane, but not those between
 * two panes, which shift light sideways. */
rgb transmittance_through_panes(const scene *s, scene_ray ray, float reach, uint64_t *in_out_cut);

/* scene_find_surface finds the first surface that is no interface; scene_is_blocked returns whether there is one up to
 * max_distance. They are for questions about surfaces, not light: alpha surfaces stop all rays (RAY_MEETS_ALPHA), their
 * empty parts too where ray.alpha_rule says so. */
bool scene_find_surface(const scene *s, scene_ray ray, float max_distance, surface_hit *out_hit);
bool scene_is_blocked(const scene *s, scene_ray ray, float max_distance);

/* Returns the ray that continues straight from the other side of the surface that it has hit; of a slab, from the other
 * side of both faces. It stays on its line, so that many such crossings deviate no more than one, as long as the line
 * leaves the surface soon. */
scene_ray scene_ray_continue(const surface_hit *hit, const scene_ray *ray);

/* Logs a warning that this many rays were cut, if any. */
void transmittance_warn_of_cut(log_sink *log, uint64_t count);

#endif
