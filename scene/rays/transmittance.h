/* transmittance.h: the share of light that is left along a ray between two vertices of a path: media absorb, and light
 * crosses interfaces unbent. All rays of photon tracing and rendering are cast here.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 11.4 and 14.2 (medium interfaces).
 * Flow: transport, direct lighting, photon tracing -> [here] -> rays.h, which is enough where a scene has neither.
 * Threads: pure but for the caller's counter. */
#ifndef AFTERGLOW_TRANSMITTANCE_H
#define AFTERGLOW_TRANSMITTANCE_H

#include "rays/rays.h"
#include "scene.h"

/* A ray ends, dark, at this many interfaces and panes, and is counted in *in_out_cut. */
enum { TRANSMITTANCE_CROSSINGS_MAX = 256 };

/* The nearest surface that scatters, along a ray of unit direction. ray->medium becomes that in which it arrives there.
 * *out_transmittance: the share of light that is left, on the way to the surface or, where there is none, to infinity.
 * out_hit->distance is the whole way's. False also where nothing is left of the light. */
bool transmittance_intersect(const scene *s, scene_ray *ray, uint64_t *in_out_cut, surface_hit *out_hit,
                             rgb *out_transmittance);

/* Whether transmittance_intersect of such a ray is scene_intersect, for nothing takes of its light on the way. */
static inline bool transmittance_is_one(const scene *s, const scene_ray *ray)
{
    return !s->has_interfaces && ray->medium == SCENE_NO_MEDIUM;
}

/* The share of light that is left on a ray's way up to reach (in lengths of its direction, INFINITY is fine); 0 where a
 * surface stands in it. */
rgb transmittance_of_ray(const scene *s, scene_ray ray, float reach, uint64_t *in_out_cut);

/* transmittance_of_ray of a ray that goes on across panes and slabs, whose transmittance (pane.h, slab.h) is
 * multiplied in: for light that is sampled at its lamp. Infinitely many reflections between the faces of one pane are
 * in it; those between two panes, which move light sideways, are not. */
rgb transmittance_through_panes(const scene *s, scene_ray ray, float reach, uint64_t *in_out_cut);

/* scene_find_surface finds the first surface that is no interface, and scene_is_blocked whether there is one up to
 * max_distance: for questions about surfaces, not light. Alpha surfaces stop all rays (RAY_MEETS_ALPHA), and the empty
 * parts too where ray.alpha_rule asks for them. */
bool scene_find_surface(const scene *s, scene_ray ray, float max_distance, surface_hit *out_hit);
bool scene_is_blocked(const scene *s, scene_ray ray, float max_distance);

/* The ray of unit direction that goes on unbent from the other side of the surface that it has hit; of a slab, from the
 * other side of both faces. It stays on its line, as far as the line leaves the surface soon, so that many such
 * crossings bend it no more than one. */
scene_ray scene_ray_continue(const surface_hit *hit, const scene_ray *ray);

/* Logs a warning that this many rays were cut, if any. */
void transmittance_warn_of_cut(log_sink *log, uint64_t count);

#endif
