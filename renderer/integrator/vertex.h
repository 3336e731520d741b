/* vertex.h: a vertex of a camera path or gather ray, and all that follows from its lying on a surface or in a medium:
 * rays that leave it, its emission, where its photons lie. Integrators use these functions and read the vertex's BSDF;
 * of the hit itself they read no more than layers and fans of rays need. In a medium the BSDF is the phase function, a
 * traced lobe, and the hit a point of no surface; so most of what integrators do is the same there.
 * Flow: transport traces rays to vertices -> [here] -> integrators. Threads: pure functions. */
#ifndef AFTERGLOW_VERTEX_H
#define AFTERGLOW_VERTEX_H

#include "material/bsdf.h"
#include "rays/transmittance.h"

typedef struct vertex {
    surface_hit hit;
    bsdf scattering;
    scene_ray arrived; /* of unit direction, in the medium of its last stretch */
    rgb transmittance; /* of the way here; where the ray has travelled (transport_travel), over the probability that it
                          came here. Where it escapes this member alone is set */
    const light *lamp; /* the area light that shines there, or NULL */
    bool is_in_medium; /* a medium has scattered the ray: the hit has no shape */
} vertex;

static inline vec3 vertex_position(const vertex *v) { return v->hit.position; }

/* Returns the ray that leaves the vertex in a unit direction, in the medium of that side. */
static inline scene_ray vertex_ray(const vertex *v, vec3 direction)
{
    return surface_ray(&v->hit, v->arrived, direction);
}

/* Returns the ray that goes on straight, as if the surface were not there. */
static inline scene_ray vertex_ray_straight(const vertex *v) { return scene_ray_continue(&v->hit, &v->arrived); }

/* Returns the geometric normal on the side that the ray came from, unit. */
vec3 vertex_facing_normal(const vertex *v);

/* Returns the normal by which a lamp is picked for these lobes (scene_pick_light); zero where they take light from all
 * sides. */
vec3 vertex_light_normal(const vertex *v, bsdf_lobes lobes);

/* Returns the radiance that the vertex itself emits back along the ray that has arrived. */
rgb vertex_emission(const scene *s, const vertex *v);

/* A point where a vertex's photons lie, and its geometric normal on the side that the ray came from: see
 * photon_tracing.h. */
typedef struct map_point {
    vec3 position, facing_normal;
} map_point;
map_point vertex_map_point(const scene *s, const vertex *v);

#endif
