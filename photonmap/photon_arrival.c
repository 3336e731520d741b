/* photon_arrival.c: see photon_arrival.h. */
#include "photon_arrival.h"

#include "material/lambert.h"
#include "medium/phase_function.h"

/* Of the diffuse scatterings, the share whose direction is sampled from importons, where there are any. */
static const float GUIDED_SHARE = 0.5f;
/* That share in a caustic map: smaller, since much of its light takes paths that no importon has taken. */
static const float CAUSTIC_GUIDED_SHARE = 0.2f;

/* Notes the direction of the ray, and its cone. */
static void note_arrival(scene_ray *ray, photon_arrival *at)
{
    at->arrived = ray->direction;
    surface_widen_cone(ray, &at->hit);
}

bool photon_arrival_meet(const scene *s, scene_ray *in_out_ray, uint64_t *in_out_cut, photon_arrival *out,
                         rgb *out_transmittance)
{
    if (!transmittance_intersect(s, in_out_ray, in_out_cut, &out->hit, out_transmittance))
        return false;
    note_arrival(in_out_ray, out);
    return true;
}

ray_end photon_arrival_travel(const scene *s, scene_ray *in_out_ray, rgb carried, vec2 u, uint64_t *in_out_cut,
                              photon_arrival *out, rgb *out_weight)
{
    ray_end end = transmittance_travel(s, in_out_ray, carried, u, in_out_cut, &out->hit, out_weight);
    if (end != RAY_ENDS_NOWHERE)
        note_arrival(in_out_ray, out);
    return end;
}

void photon_arrival_scatter_in_medium(const scene *s, const photon_arrival *at, vec2 u, scene_ray *ray)
{
    ray->origin = at->hit.position;
    ray->direction = phase_function_sample(&s->media[ray->medium].phase, at->arrived, u);
}

/* Returns the share of the directions on that importons guide: of the global map a share of those by diffuse lobes; of
 * a caustic map a share of all, where any lobe is rough. */
static float find_guided_share(const photon_arrival *at, photon_kind kind)
{
    if (kind == PHOTON_CAUSTIC)
        return photon_arrival_is_rough(at) ? CAUSTIC_GUIDED_SHARE : 0.0f;
    return at->albedo ? GUIDED_SHARE : GUIDED_SHARE * bsdf_probability(&at->scattering, BSDF_GATHERED);
}

void photon_arrival_complete(const scene *s, const photon_tracing_settings *settings, photon_arrival *at)
{
    vec3 back = vec3_negate(at->arrived);
    at->guided_share = 0.0f;
    at->albedo = lambert_albedo(s, &at->hit);
    if (!at->albedo)
        bsdf_init(s, &at->hit, back, &at->scattering);
    float share = settings->ways ? find_guided_share(at, settings->kind) : 0.0f;
    if (!(share > 0.0f) || !onward_ways_find(settings->ways, photon_arrival_rest(s, at).position,
                                             vec3_face_forward(at->hit.geometric_normal, back), &at->onward))
        return;
    /* histograms are too coarse for what rough metal or a coat reflects */
    if (settings->kind == PHOTON_GLOBAL || at->onward.cone_count > 0)
        at->guided_share = share;
}

bool photon_arrival_stores(const scene *s, const photon_arrival *at, float *out_factor)
{
    if (at->albedo)
        *out_factor = lambert_arrival_factor(&at->hit, at->arrived);
    else if (bsdf_has(&at->scattering, BSDF_GATHERED))
        *out_factor = bsdf_arrival_factor(&at->scattering);
    else
        return bsdf_arrival_factor_beside(s, &at->hit, &at->scattering, out_factor);
    return true;
}

/* Samples the surface's own ways on. Sets all of the sample. Returns false where the flux is absorbed. */
static bool sample_surface(const photon_arrival *at, bsdf_lobes lobes, float u_lobe, vec2 u, bsdf_sample *out_next)
{
    float correction;
    if (!at->albedo)
        return bsdf_sample_direction(&at->scattering, lobes, BSDF_FLUX, u_lobe, u, out_next);
    if (!lambert_sample_flux(&at->hit, at->arrived, u, &out_next->direction, &correction))
        return false;
    out_next->weight = rgb_scale(*at->albedo, correction);
    out_next->pdf_solid_angle = fabsf(vec3_dot(out_next->direction, at->hit.geometric_normal)) * AG_INV_PI;
    out_next->group = BSDF_GATHERED;
    out_next->is_delta = out_next->is_straight = false;
    return true;
}

/* Evaluates the surface's own density and weight of a direction that was sampled otherwise. */
static void evaluate_surface(const photon_arrival *at, bsdf_lobes lobes, vec3 direction, bsdf_sample *out_next)
{
    *out_next = (bsdf_sample){.direction = direction, .group = lobes == BSDF_TRACED ? BSDF_TRACED : BSDF_GATHERED};
    if (at->albedo) {
        vec3 normal = vec3_face_forward(at->hit.geometric_normal, vec3_negate(at->arrived));
        out_next->weight = rgb_scale(*at->albedo, lambert_arrival_factor(&at->hit, at->arrived));
        out_next->pdf_solid_angle = float_max(vec3_dot(direction, normal), 0.0f) * AG_INV_PI;
        return;
    }
    float pdf = bsdf_pdf(&at->scattering, lobes, BSDF_FLUX, direction);
    rgb value = bsdf_evaluate(&at->scattering, lobes, BSDF_FLUX, direction);
    out_next->pdf_solid_angle = pdf;
    out_next->weight = rgb_scale(value, 1.0f / pdf);
    if (!(pdf > 0.0f) || !rgb_is_finite(out_next->weight))
        out_next->weight = rgb_gray(0.0f), out_next->pdf_solid_angle = 0.0f;
}

bool photon_arrival_sample(const photon_arrival *at, bsdf_lobes lobes, float u_lobe, vec2 u, bsdf_sample *out_next,
                           float *out_density_ratio)
{
    float share = at->guided_share;
    *out_density_ratio = 1.0f;
    if (!(share > 0.0f))
        return sample_surface(at, lobes, u_lobe, u, out_next);
    if (u_lobe < share) {
        evaluate_surface(at, lobes, onward_guide_sample(&at->onward, u), out_next);
    } else {
        u_lobe = float_below_one((u_lobe - share) / (1.0f - share));
        if (!sample_surface(at, lobes, u_lobe, u, out_next))
            return false;
    }
    float by_importons = out_next->is_delta ? 0.0f : onward_guide_density(&at->onward, out_next->direction);
    float by_surface = out_next->is_delta ? 1.0f : out_next->pdf_solid_angle;
    *out_density_ratio = by_surface > 0.0f ? by_surface / ((1.0f - share) * by_surface + share * by_importons) : 0.0f;
    return true;
}
