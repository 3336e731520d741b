/* ray_cone.c: see ray_cone.h. */
#include "rays/ray_cone.h"

#include "scene.h"
#include "shape/tangents.h"

/* Factor by which a density of 1/pi gives the diffuse spread. */
static const float SPREAD_OF_DENSITY = 0.0705f;
static const float SPREAD_MAX = 2.0f;

ray_cone ray_cone_scattered(const ray_cone *c, float pdf_solid_angle)
{
    float spread = float_min(SPREAD_OF_DENSITY / sqrtf(pdf_solid_angle), RAY_CONE_DIFFUSE_SPREAD);
    spread = float_max(spread, fabsf(c->spread));
    return (ray_cone){fabsf(c->width), spread, c->is_coarse};
}

/* Mean curvature, 1/length: above 0 where the surface bulges out. Half the trace of dn/dp. */
static float mean_curvature(const scene *s, const surface_hit *hit)
{
    const shape *at = &s->shapes[hit->shape_index];
    if (at->kind == SHAPE_DISK || (at->kind == SHAPE_MESH && !at->as.mesh.normals))
        return 0.0f;
    surface_differentials d = surface_differentials_at(s, hit);
    float uu = vec3_dot(d.dpdu, d.dpdu), uv = vec3_dot(d.dpdu, d.dpdv), vv = vec3_dot(d.dpdv, d.dpdv);
    float area = uu * vv - uv * uv;
    float turned = vec3_dot(d.dndu, d.dpdu) * vv - (vec3_dot(d.dndu, d.dpdv) + vec3_dot(d.dndv, d.dpdu)) * uv +
                   vec3_dot(d.dndv, d.dpdv) * uu;
    float curvature = 0.5f * turned / area;
    return isfinite(curvature) ? curvature : 0.0f;
}

ray_cone ray_cone_bent(const scene *s, const ray_cone *c, const surface_hit *hit, vec3 arrived, vec3 direction,
                       float index)
{
    vec3 n = hit->geometric_normal;
    bool is_inside = vec3_dot(arrived, n) > 0.0f, is_reflected = (vec3_dot(direction, n) > 0.0f) != is_inside;
    float curvature = mean_curvature(s, hit);
    if (is_inside)
        curvature = -curvature; /* as seen from where the ray came from */
    float spread;
    if (is_reflected) {
        spread = c->spread + 2.0f * curvature * c->width;
    } else {
        float ratio = index > 0.0f ? (is_inside ? index : 1.0f / index) : 1.0f; /* before over behind */
        spread = ratio * c->spread - (1.0f - ratio) * curvature * c->width;
    }
    return (ray_cone){c->width, float_clamp(spread, -SPREAD_MAX, SPREAD_MAX), c->is_coarse};
}
