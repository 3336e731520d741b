/* shading.c: see shading.h. */
#include "shading.h"

#include "direct_lighting.h"
#include "final_gather.h"

/* Below this throughput a diffuse place is shown by the k-nearest estimate at it instead of being gathered (Jensen
 * 2001, 8.2: an approximate evaluation where the contribution is low). */
static const float LOW_CONTRIBUTION = 0.03f;
enum { ROULETTE_AFTER = 4 };

static rgb diffuse_radiance(const transport *t, eye_worker *worker, const vertex *v, const sampler *where,
                            int path_vertex, float contribution)
{
    const ag_render_settings *settings = t->settings;
    int scatterings_left = settings->max_depth - path_vertex;
    bool is_whole = settings->only == AG_ONLY_ALL;
    rgb sum = rgb_gray(0.0f);
    if (scatterings_left < 1)
        return sum;
    if (is_whole && path_vertex > 0 && contribution < LOW_CONTRIBUTION) {
        map_place at = transport_map_place(t, v);
        rgb transmitted = bsdf_gathered_transmission(&v->scattering);
        sum = rgb_mul(bsdf_gathered_reflection(&v->scattering),
                      irradiance_cache_estimate(t->cache, at.position, at.facing_normal, worker->index));
        if (!rgb_is_black(transmitted)) {
            rgb behind = irradiance_cache_estimate(t->cache, at.position, vec3_negate(at.facing_normal), worker->index);
            sum = rgb_add(sum, rgb_mul(transmitted, behind));
        }
        return rgb_scale(sum, AG_INV_PI);
    }
    if (is_whole)
        sum = direct_light_gathered(t, worker, v, where, path_vertex);
    sum = rgb_add(sum, transport_caustics(t, worker, v));
    if (scatterings_left >= 2)
        sum = rgb_add(sum, final_gather(t, worker, v, where, path_vertex, scatterings_left));
    return sum;
}

rgb shading_radiance(const transport *t, eye_worker *worker, scene_ray ray, const sampler *where)
{
    const ag_render_settings *settings = t->settings;
    bool is_whole = settings->only == AG_ONLY_ALL;
    rgb radiance = rgb_gray(0.0f), throughput = rgb_gray(1.0f);
    vec3 scattered_from = ray.origin, scattered_normal = {0.0f, 0.0f, 0.0f};
    float scattered_pdf = 0.0f; /* of a rough traced lobe; 0: the eye or a smooth one, which no shadow ray can serve */

    for (int path_vertex = 0;; path_vertex++) {
        vertex v;
        if (path_vertex == 0)
            worker->rays_camera++;
        else
            worker->rays_path++;
        bool is_met = transport_trace(t, worker, ray, &v);
        throughput = rgb_mul(throughput, v.transmittance);
        if (!is_met) {
            if (is_whole) {
                rgb escaped =
                    direct_light_escaped(t, scattered_from, scattered_normal, ray.direction, scattered_pdf, 1, 1);
                radiance = rgb_add(radiance, rgb_mul(throughput, escaped));
            }
            return radiance;
        }

        /* emitted light, shared with the shadow rays of the vertex before where that had any */
        rgb emitted = transport_emission(t, &v);
        if (is_whole && !rgb_is_black(emitted)) {
            float weight = 1.0f;
            if (scattered_pdf > 0.0f)
                weight = direct_light_scatter_weight(t, scattered_from, scattered_normal, &v, scattered_pdf, 1, 1);
            radiance = rgb_add(radiance, rgb_scale(rgb_mul(throughput, emitted), weight));
        }

        /* diffuse lobes end here */
        if (bsdf_has(&v.scattering, BSDF_GATHERED)) {
            rgb diffuse = diffuse_radiance(t, worker, &v, where, path_vertex, rgb_max(throughput));
            radiance = rgb_add(radiance, rgb_mul(throughput, diffuse));
        }

        /* the others are traced on */
        if (path_vertex >= settings->max_depth || !bsdf_has(&v.scattering, BSDF_TRACED))
            return radiance;
        if (is_whole && bsdf_is_sampled_from_light(&v.scattering, BSDF_TRACED)) {
            float u_pick = sampler_2d(where, SAMPLE_LIGHT_PICK, path_vertex).x;
            rgb direct = direct_light_from_lamp(t, worker, &v, BSDF_TRACED, u_pick,
                                                sampler_2d(where, SAMPLE_LIGHT, path_vertex), 1, 1);
            radiance = rgb_add(radiance, rgb_mul(throughput, direct));
        }
        bsdf_sample next;
        if (!bsdf_sample_direction(&v.scattering, BSDF_TRACED, BSDF_RADIANCE,
                                   sampler_2d(where, SAMPLE_LOBE, path_vertex).x,
                                   sampler_2d(where, SAMPLE_SCATTER, path_vertex), &next))
            return radiance;
        throughput = rgb_mul(throughput, next.weight);
        if (path_vertex >= ROULETTE_AFTER) {
            float survival = fminf(1.0f, rgb_max(throughput));
            if (sampler_2d(where, SAMPLE_ROULETTE, path_vertex).x >= survival)
                return radiance;
            throughput = rgb_scale(throughput, 1.0f / survival);
        }
        scattered_from = v.hit.position;
        scattered_normal = direct_light_normal(&v, BSDF_TRACED);
        scattered_pdf = next.is_delta ? 0.0f : next.pdf_solid_angle;
        ray = surface_ray(&v.hit, v.arrived, next.direction);
    }
}
