/* vertex.c: see vertex.h. */
#include "integrator/vertex.h"

vec3 vertex_facing_normal(const vertex *v) { return vec3_face_forward(v->hit.geometric_normal, v->scattering.out); }

vec3 vertex_light_normal(const vertex *v, bsdf_lobes lobes)
{
    return bsdf_scatters_through(&v->scattering, lobes) ? vec3_make(0.0f, 0.0f, 0.0f) : vertex_facing_normal(v);
}

rgb vertex_emission(const scene *s, const vertex *v)
{
    if (!v->lamp)
        return rgb_gray(0.0f);
    return light_emitted_radiance(s, v->lamp, &v->hit, vec3_negate(v->arrived.direction));
}

map_point vertex_map_point(const scene *s, const vertex *v)
{
    surface_rest rest = surface_at_opening(s, &v->hit);
    bool is_behind = vec3_dot(v->hit.geometric_normal, v->arrived.direction) > 0.0f;
    return (map_point){rest.position, is_behind ? vec3_negate(rest.geometric_normal) : rest.geometric_normal};
}
