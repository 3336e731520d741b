/* passage.h: the way of light between two places that scatter it: through media, which absorb, and across interfaces,
 * which it passes unbent. All rays of photon tracing and rendering are cast here.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 11.4 and 14.2 (medium interfaces).
 * Flow: transport, direct lighting, photon tracing -> [here] -> rays.h, which is enough where a scene has neither.
 * Threads: pure but for the caller's counter. */
#ifndef AFTERGLOW_PASSAGE_H
#define AFTERGLOW_PASSAGE_H

#include "rays/rays.h"
#include "scene.h"

/* A way ends at this many interfaces and panes, dark; it is counted in *in_out_cut. */
enum { PASSAGE_CROSSINGS_MAX = 256 };

/* The nearest surface that scatters, along a ray of unit direction. ray->medium becomes that in which it arrives there.
 * *out_transmittance: the share of light that is left, on the way to the surface or, where there is none, to infinity.
 * out_hit->distance is the whole way's. False also where nothing is left of the light. */
bool passage_intersect(const scene *s, scene_ray *ray, uint64_t *in_out_cut, surface_hit *out_hit,
                       rgb *out_transmittance);

/* Whether passage_intersect of such a ray is scene_intersect, for nothing takes of its light on the way. */
static inline bool passage_is_clear(const scene *s, const scene_ray *ray)
{
    return !s->has_interfaces && ray->medium == SCENE_NO_MEDIUM;
}

/* The share of light that is left on a ray's way up to reach (in lengths of its direction, INFINITY is fine); 0 where a
 * surface stands in it. */
rgb passage_transmittance(const scene *s, scene_ray ray, float reach, uint64_t *in_out_cut);

/* passage_transmittance of a ray that goes on across panes and slabs, whose transmittance (pane.h, slab.h) is
 * multiplied in: for light that is sampled at its lamp. Infinitely many reflections between the faces of one pane are
 * in it; those between two panes, which move light sideways, are not. */
rgb passage_transmittance_of_panes(const scene *s, scene_ray ray, float reach, uint64_t *in_out_cut);

/* As scene_intersect and scene_occluded, but interfaces are not there, and alpha surfaces stop all rays,
 * RAY_MEETS_ALPHA unless ray.alpha_rule asks for the empty ones as well: for those who ask about surfaces, not light.
 */
bool passage_find_surface(const scene *s, scene_ray ray, float max_distance, surface_hit *out_hit);
bool passage_is_blocked(const scene *s, scene_ray ray, float max_distance);

/* The ray of unit direction that has met a place which lets it through unbent, on the other side of it. It stays on its
 * line, as far as the line leaves the surface soon, so that many such places bend it no more than one. Of a slab it is
 * the other side of both faces. */
scene_ray passage_continue(const surface_hit *hit, const scene_ray *ray);

/* Says that so many rays were cut, if any. */
void passage_warn_of_cut(log_sink *log, uint64_t count);

#endif
