/* photon_arrival.h: where a photon path has arrived, on a surface or in a medium, and all that follows from that:
 * whether a photon is stored there, where, and with which flux; how flux scatters; and the ray that leaves. photon_path
 * asks these functions alone, as integrators ask integrator/vertex.h. Flow: transmittance -> [here] -> photon_path.
 * Threads: pure functions. */
#ifndef AFTERGLOW_PHOTON_ARRIVAL_H
#define AFTERGLOW_PHOTON_ARRIVAL_H

#include "material/bsdf.h"
#include "onward_ways.h"
#include "photon_tracing.h"
#include "rays/transmittance.h"
#include "shape/alpha.h"
#include "shape/instance.h"

typedef struct photon_arrival {
    surface_hit hit;
    vec3 arrived;      /* unit direction of the flux */
    const rgb *albedo; /* of a plain Lambertian surface (lambert.h); else NULL, and: */
    bsdf scattering;
    float guided_share;  /* of the directions in which flux goes on: those sampled by onward; 0: none */
    onward_guide onward; /* by importons; set where guided_share > 0 */
} photon_arrival;

/* Follows a ray to the next surface that is not passed straight, and sets the hit. Moves the ray's medium and cone
 * there; adds 1 to *in_out_cut where too many surfaces lie on the way. Returns false where the ray leaves the scene. */
bool photon_arrival_meet(const scene *s, scene_ray *in_out_ray, uint64_t *in_out_cut, photon_arrival *out_arrival,
                         rgb *out_transmittance);

/* photon_arrival_meet where media that scatter lie on the way: the ray may end in one of them, as two random numbers
 * decide, and *out_weight is then that of the flux there (transmittance_travel). */
ray_end photon_arrival_travel(const scene *s, scene_ray *in_out_ray, rgb carried, vec2 u, uint64_t *in_out_cut,
                              photon_arrival *out_arrival, rgb *out_weight);

/* Scatters flux in the medium of the ray that has arrived there: *in_out_ray goes on from there. */
void photon_arrival_scatter_in_medium(const scene *s, const photon_arrival *at, vec2 u, scene_ray *in_out_ray);

/* Finds how the surface that was met scatters, and the guide that importons made there, if any. */
void photon_arrival_complete(const scene *s, const photon_tracing_settings *settings, photon_arrival *in_out_arrival);

/* The point as photons are stored at it: when the shutter opens, with the normal on the side of arrival. */
static inline surface_rest photon_arrival_rest(const scene *s, const photon_arrival *at)
{
    surface_rest rest = {at->hit.position, at->hit.geometric_normal, 1.0f};
    if (s->has_motion)
        rest = surface_at_opening(s, &at->hit);
    if (vec3_dot(at->hit.geometric_normal, at->arrived) > 0.0f)
        rest.geometric_normal = vec3_negate(rest.geometric_normal);
    return rest;
}

/* Returns whether photons are stored on the surface, and writes the factor of their flux but for what
 * photon_arrival_rest and alpha make of it. */
bool photon_arrival_stores(const scene *s, const photon_arrival *at, float *out_factor);

/* Returns the share of the surface that is there, (0, 1], by its alpha; photons arrive at that share alone, and an
 * estimate divides by all of the area. */
static inline float photon_arrival_alpha(const scene *s, const photon_arrival *at)
{
    return shape_is_opaque(&s->shapes[at->hit.shape_index]) ? 1.0f : alpha_at_hit(s, &at->hit);
}

/* Returns whether flux is scattered by any of these lobes. */
static inline bool photon_arrival_has(const photon_arrival *at, bsdf_lobes lobes)
{
    return at->albedo ? (lobes & BSDF_GATHERED) != 0 : bsdf_has(&at->scattering, lobes);
}

/* Returns whether traced lobes send flux in more than one direction: not all of them are smooth. */
static inline bool photon_arrival_is_rough(const photon_arrival *at)
{
    return !at->albedo && bsdf_is_sampled_from_light(&at->scattering, BSDF_TRACED);
}

/* Returns whether flux may go straight through, as if nothing were there: see bsdf.h. */
static inline bool photon_arrival_is_pane(const photon_arrival *at) { return !at->albedo && at->scattering.is_pane; }

/* Returns about how many times its flux all ways on carry away together, at least 1: see bsdf_flux_gain. */
static inline float photon_arrival_gain(const photon_arrival *at)
{
    return at->albedo ? 1.0f : bsdf_flux_gain(&at->scattering);
}

/* Samples the direction in which flux goes on: by the surface, or by the importons there. The weight is that of
 * sampling by the surface alone; *out_density_ratio: the density of sampling so over that of both ways together, at
 * most 1 / (1 - guided_share); 0: the direction carries nothing. Returns false where the flux is absorbed. */
bool photon_arrival_sample(const photon_arrival *at, bsdf_lobes lobes, float u_lobe, vec2 u, bsdf_sample *out_next,
                           float *out_density_ratio);

/* Returns the ray that leaves in a direction. ray: the one that arrived. */
static inline scene_ray photon_arrival_ray(const photon_arrival *at, const scene_ray *ray, vec3 direction)
{
    return surface_ray(&at->hit, *ray, direction);
}

/* Returns the ray that goes on straight, as if the surface were not there. */
static inline scene_ray photon_arrival_ray_straight(const photon_arrival *at, const scene_ray *ray)
{
    return scene_ray_continue(&at->hit, ray);
}

#endif
