/* path_tracing.c: see path_tracing.h. */
#include "path_tracing.h"

#include "direct_lighting.h"

enum { ROULETTE_AFTER = 3 };

/* One group of lobes, picked by its share, where it matters which of them scattered: rough lobes of both may send light
 * the same way. Makes the random number fresh again. */
static bsdf_lobes pick_group(const vertex *v, float *in_out_u, rgb *in_out_throughput)
{
    float share = bsdf_probability(&v->scattering, BSDF_GATHERED);
    bool is_gathered = *in_out_u < share;
    float before = is_gathered ? 0.0f : share, picked = is_gathered ? share : 1.0f - share;
    *in_out_u = fminf((*in_out_u - before) / picked, 0x1.fffffep-1f);
    *in_out_throughput = rgb_scale(*in_out_throughput, 1.0f / picked);
    return is_gathered ? BSDF_GATHERED : BSDF_TRACED;
}

rgb path_tracing_radiance(const transport *t, eye_worker *worker, scene_ray ray, const sampler *where)
{
    const ag_render_settings *settings = t->settings;
    bool is_whole = settings->only == AG_ONLY_ALL;
    rgb radiance = rgb_gray(0.0f), throughput = rgb_gray(1.0f);
    vec3 scattered_from = ray.origin, scattered_normal = {0.0f, 0.0f, 0.0f};
    float scattered_pdf = 0.0f;      /* 0: the eye or a smooth lobe */
    bool has_met_diffuse = false;    /* the path has been scattered by a gathered lobe */
    bool left_first_diffuse = false; /* at the vertex before, for the first time */

    for (int path_vertex = 0;; path_vertex++) {
        vertex v;
        if (path_vertex == 0)
            worker->rays_camera++;
        else
            worker->rays_path++;
        /* emitted light; indirect light alone leaves out what is seen, and what falls straight on the first diffuse
         * place */
        bool counts_emission = is_whole || (has_met_diffuse && !left_first_diffuse);
        bool is_met = transport_trace(t, worker, ray, &v);
        throughput = rgb_mul(throughput, v.transmittance);
        if (!is_met) {
            if (counts_emission) {
                rgb escaped =
                    direct_light_escaped(t, scattered_from, scattered_normal, ray.direction, scattered_pdf, 1, 1);
                radiance = rgb_add(radiance, rgb_mul(throughput, escaped));
            }
            return radiance;
        }
        rgb emitted = transport_emission(t, &v);
        if (!rgb_is_black(emitted) && counts_emission) {
            float weight = 1.0f;
            if (scattered_pdf > 0.0f)
                weight = direct_light_scatter_weight(t, scattered_from, scattered_normal, &v, scattered_pdf, 1, 1);
            radiance = rgb_add(radiance, rgb_scale(rgb_mul(throughput, emitted), weight));
        }
        if (path_vertex >= settings->max_depth)
            return radiance;

        /* next-event estimation */
        if ((is_whole || has_met_diffuse) && bsdf_is_sampled_from_light(&v.scattering, BSDF_ALL)) {
            float u_pick = sampler_2d(where, SAMPLE_LIGHT_PICK, path_vertex).x;
            rgb direct = direct_light_from_lamp(t, worker, &v, BSDF_ALL, u_pick,
                                                sampler_2d(where, SAMPLE_LIGHT, path_vertex), 1, 1);
            radiance = rgb_add(radiance, rgb_mul(throughput, direct));
        }

        /* go on */
        bsdf_sample next;
        float u_lobe = sampler_2d(where, SAMPLE_LOBE, path_vertex).x;
        bsdf_lobes lobes = BSDF_ALL;
        if (!is_whole && !has_met_diffuse)
            lobes = pick_group(&v, &u_lobe, &throughput);
        if (!bsdf_sample_direction(&v.scattering, lobes, BSDF_RADIANCE, u_lobe,
                                   sampler_2d(where, SAMPLE_SCATTER, path_vertex), &next))
            return radiance;
        throughput = rgb_mul(throughput, next.weight);
        if (path_vertex >= ROULETTE_AFTER) {
            float survival = fminf(1.0f, rgb_max(throughput));
            if (sampler_2d(where, SAMPLE_ROULETTE, path_vertex).x >= survival)
                return radiance;
            throughput = rgb_scale(throughput, 1.0f / survival);
        }
        left_first_diffuse = !has_met_diffuse && next.group == BSDF_GATHERED;
        has_met_diffuse = has_met_diffuse || left_first_diffuse;
        scattered_from = v.hit.position;
        scattered_normal = direct_light_normal(&v, BSDF_ALL);
        scattered_pdf = next.is_delta ? 0.0f : next.pdf_solid_angle;
        ray = surface_ray(&v.hit, v.arrived, next.direction);
    }
}
