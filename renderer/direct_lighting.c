/* direct_lighting.c: see direct_lighting.h. */
#include "direct_lighting.h"

#include "environment.h"
#include "math/sampling.h"
#include "passage.h"

vec3 direct_light_normal(const vertex *v, bsdf_lobes lobes)
{
    return bsdf_scatters_through(&v->scattering, lobes) ? vec3_make(0.0f, 0.0f, 0.0f) : transport_facing_normal(v);
}

rgb direct_light_from_lamp(const transport *t, eye_worker *worker, const vertex *v, bsdf_lobes lobes, float u_pick,
                           vec2 u, int lamp_count, int scatter_count)
{
    const rgb none = rgb_gray(0.0f);
    if (!t->has_lights)
        return none;
    float probability;
    uint32_t lamp = scene_pick_light(t->s, v->hit.position, direct_light_normal(v, lobes), u_pick, &probability);
    light_sample sample;
    if (!(probability > 0.0f) || !light_sample_from_point(t->s, &t->s->lights[lamp], v->hit.position, u, &sample))
        return none;
    rgb reflected = rgb_mul(bsdf_evaluate(&v->scattering, lobes, BSDF_RADIANCE, sample.direction), sample.radiance);
    if (rgb_is_black(reflected))
        return none;

    scene_ray shadow = surface_ray(&v->hit, v->arrived, sample.direction);
    float reach = INFINITY;
    if (!isinf(sample.distance)) {
        shadow.direction = vec3_sub(sample.shadow_target, shadow.origin);
        reach = 1.0f;
    }
    worker->rays_shadow++;
    rgb transmittance = passage_transmittance(t->s, shadow, reach, &worker->passages_cut);
    if (rgb_is_black(transmittance))
        return none;
    float pdf = sample.pdf_solid_angle * probability, weight = 1.0f;
    if (!sample.is_delta && scatter_count > 0)
        weight =
            mis_power((float)lamp_count, pdf, (float)scatter_count, bsdf_pdf(&v->scattering, lobes, sample.direction));
    return rgb_scale(rgb_mul(reflected, transmittance), weight / pdf);
}

float direct_light_scatter_weight(const transport *t, vec3 from, vec3 normal, const vertex *on_lamp,
                                  float pdf_solid_angle, int lamp_count, int scatter_count)
{
    float pick = scene_light_probability(t->s, (uint32_t)(on_lamp->lamp - t->s->lights), from, normal);
    float pdf = pick * light_pdf_from_point(t->s, on_lamp->lamp, from, &on_lamp->hit);
    return mis_power((float)scatter_count, pdf_solid_angle, (float)lamp_count, pdf);
}

rgb direct_light_escaped(const transport *t, vec3 from, vec3 normal, vec3 direction, float pdf_solid_angle,
                         int lamp_count, int scatter_count)
{
    const scene *s = t->s;
    rgb sum = rgb_gray(0.0f);
    for (uint32_t i = 0; i < s->infinite_light_count; i++) {
        uint32_t index = s->infinite_lights[i];
        const light *l = &s->lights[index];
        rgb radiance = environment_radiance(l, from, direction);
        if (rgb_is_black(radiance))
            continue;
        float weight = 1.0f;
        if (pdf_solid_angle > 0.0f)
            weight = mis_power((float)scatter_count, pdf_solid_angle, (float)lamp_count,
                               scene_light_probability(s, index, from, normal) * environment_pdf(l, from, direction));
        sum = rgb_add(sum, rgb_scale(radiance, weight));
    }
    return sum;
}

rgb direct_light_gathered(const transport *t, eye_worker *worker, const vertex *v, const sampler *where,
                          int path_vertex)
{
    rgb from_lamps = rgb_gray(0.0f), by_scattering = rgb_gray(0.0f);
    if (!t->has_lights)
        return from_lamps;
    int lamp_count = t->light_samples, scatter_count = t->scatter_samples;
    vec3 from = v->hit.position, normal = direct_light_normal(v, BSDF_GATHERED);
    for (int i = 0; i < lamp_count; i++) {
        float u_pick = sampler_2d_of(where, SAMPLE_LIGHT_PICK, path_vertex, (uint32_t)lamp_count, (uint32_t)i).x;
        vec2 u = sampler_2d_of(where, SAMPLE_LIGHT, path_vertex, (uint32_t)lamp_count, (uint32_t)i);
        from_lamps = rgb_add(from_lamps,
                             direct_light_from_lamp(t, worker, v, BSDF_GATHERED, u_pick, u, lamp_count, scatter_count));
    }
    for (int i = 0; i < scatter_count; i++) {
        float u_lobe = sampler_2d_of(where, SAMPLE_LOBE, path_vertex, (uint32_t)scatter_count, (uint32_t)i)
                           .y; /* x is for the way on */
        vec2 u = sampler_2d_of(where, SAMPLE_SCATTER_TO_LIGHT, path_vertex, (uint32_t)scatter_count, (uint32_t)i);
        bsdf_sample scattered;
        if (!bsdf_sample_direction(&v->scattering, BSDF_GATHERED, BSDF_RADIANCE, u_lobe, u, &scattered))
            continue;
        vertex met;
        worker->rays_shadow++;
        if (!transport_trace(t, worker, surface_ray(&v->hit, v->arrived, scattered.direction), &met)) {
            rgb escaped = direct_light_escaped(t, from, normal, scattered.direction, scattered.pdf_solid_angle,
                                               lamp_count, scatter_count);
            by_scattering = rgb_add(by_scattering, rgb_mul(rgb_mul(escaped, met.transmittance), scattered.weight));
            continue;
        }
        rgb emitted = rgb_mul(transport_emission(t, &met), met.transmittance);
        if (rgb_is_black(emitted))
            continue;
        float weight =
            direct_light_scatter_weight(t, from, normal, &met, scattered.pdf_solid_angle, lamp_count, scatter_count);
        by_scattering = rgb_add(by_scattering, rgb_scale(rgb_mul(emitted, scattered.weight), weight));
    }
    rgb sum = rgb_scale(from_lamps, 1.0f / (float)lamp_count);
    return scatter_count > 0 ? rgb_add(sum, rgb_scale(by_scattering, 1.0f / (float)scatter_count)) : sum;
}
