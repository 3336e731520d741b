/* surface_footprint.c: see surface_footprint.h. */
#include "material/surface_footprint.h"

#include "scene.h"
#include "shape/alpha.h"
#include "shape/tangents.h"

/* A ray along the surface meets an ellipse of this many times its width at most. */
static const float COSINE_MIN = 1e-3f;

/* The step in uv of a step in the surface, by least squares. */
static vec2 uv_step(vec3 dpdu, vec3 dpdv, vec3 step)
{
    const double uu = vec3_dot(dpdu, dpdu), uv = vec3_dot(dpdu, dpdv), vv = vec3_dot(dpdv, dpdv);
    const double u = vec3_dot(step, dpdu), v = vec3_dot(step, dpdv), inverse = 1.0 / (uu * vv - uv * uv);
    return (vec2){(float)((u * vv - v * uv) * inverse), (float)((v * uu - u * uv) * inverse)};
}

bool surface_footprint_at(const scene *s, const surface_hit *hit, surface_footprint *out)
{
    const ray_footprint *ray = &hit->footprint;
    vec3 dpdu, dpdv;
    if (!(ray->width > 0.0f) || !shape_is_opaque(&s->shapes[hit->shape_index]) ||
        !surface_uv_axes(s, hit, &dpdu, &dpdv))
        return false;
    vec3 n = hit->geometric_normal, across = vec3_cross(n, ray->direction);
    float sine = vec3_length(across), cosine = fabsf(vec3_dot(n, ray->direction));
    frame any = frame_from_z(n);
    vec3 minor = sine > 1e-4f ? vec3_scale(across, 1.0f / sine) : any.x;
    out->axes[0] = vec3_scale(minor, ray->width);
    out->axes[1] =
        vec3_scale(vec3_cross(n, minor), ray->is_coarse ? ray->width : ray->width / float_max(cosine, COSINE_MIN));
    for (int i = 0; i < 2; i++)
        out->uv_axes[i] = uv_step(dpdu, dpdv, out->axes[i]);
    out->is_coarse = ray->is_coarse;
    return true;
}
