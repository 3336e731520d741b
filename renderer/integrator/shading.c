/* shading.c: see shading.h. */
#include "integrator/shading.h"

#include "integrator/direct_lighting.h"
#include "integrator/final_gather.h"
#include "integrator/first_hit.h"
#include "rays/passage.h"

enum { ROULETTE_AFTER = 4 };

/* What a diffuse place sends on: its parts, but for what is gathered, which comes to the sample later. */
typedef struct diffuse_light {
    rgb direct, caustic, indirect;
    rgb sky; /* of the direct light, from infinite lights */
} diffuse_light;

/* path_vertex: which of its path's it is; scatterings: those between it and the eye, which panes may not be among. */
static diffuse_light diffuse_radiance(const transport *t, eye_worker *worker, const vertex *v, const sampler *where,
                                      int path_vertex, int scatterings, rgb throughput, rgb *by_group)
{
    const ag_render_settings *settings = t->settings;
    int scatterings_left = settings->max_depth - scatterings;
    bool is_whole = settings->only == AG_ONLY_ALL;
    diffuse_light sum = {rgb_gray(0.0f), rgb_gray(0.0f), rgb_gray(0.0f), rgb_gray(0.0f)};
    if (scatterings_left < 1)
        return sum;
    if (is_whole && scatterings > 0 && rgb_max(throughput) < SHADING_LOW_CONTRIBUTION) {
        map_place at = transport_map_place(t, v);
        rgb transmitted = bsdf_gathered_transmission(&v->scattering);
        rgb all = rgb_mul(bsdf_gathered_reflection(&v->scattering),
                          irradiance_cache_estimate(t->cache, at.position, at.facing_normal, worker->index));
        if (!rgb_is_black(transmitted)) {
            rgb behind = irradiance_cache_estimate(t->cache, at.position, vec3_negate(at.facing_normal), worker->index);
            all = rgb_add(all, rgb_mul(transmitted, behind));
        }
        sum.indirect = rgb_scale(all, AG_INV_PI);
        return sum;
    }
    if (is_whole) {
        sum.direct = direct_light_gathered(t, worker, v, where, path_vertex, by_group);
        sum.sky = worker->direct_from_sky;
    }
    sum.caustic = transport_caustics(t, worker, v);
    if (scatterings_left >= 2)
        final_gather(t, worker, v, where, path_vertex, scatterings == 0, scatterings_left, throughput);
    return sum;
}

/* by_group: the direct light's; the rest came through the photon map. */
static void add_diffuse(const transport *t, eye_sample *sample, const diffuse_light *diffuse, int scatterings,
                        rgb throughput, const rgb *by_group)
{
    bool is_first = scatterings == 0;
    rgb direct = rgb_mul(throughput, diffuse->direct), caustic = rgb_mul(throughput, diffuse->caustic),
        indirect = rgb_mul(throughput, diffuse->indirect);
    float kept_direct = eye_sample_bound(sample, scatterings + 1, direct),
          kept_caustic = eye_sample_bound(sample, scatterings + 2, caustic),
          kept_indirect = eye_sample_bound(sample, scatterings + 2, indirect);
    direct = rgb_scale(direct, kept_direct);
    caustic = rgb_scale(caustic, kept_caustic);
    indirect = rgb_scale(indirect, kept_indirect);
    rgb all = rgb_mul(throughput, rgb_add(rgb_add(diffuse->direct, diffuse->caustic), diffuse->indirect));
    if (kept_direct < 1.0f || kept_caustic < 1.0f || kept_indirect < 1.0f)
        all = rgb_add(rgb_add(direct, caustic), indirect);
    sample->radiance = rgb_add(sample->radiance, all);
    eye_sample_note(sample, is_first ? PART_DIRECT : PART_SPECULAR, direct);
    eye_sample_note(sample, is_first ? PART_CAUSTIC : PART_SPECULAR, caustic);
    eye_sample_note(sample, is_first ? PART_INDIRECT : PART_SPECULAR, indirect);
    if (is_first && sample->layers)
        sample->layers->sky = rgb_add(sample->layers->sky, rgb_scale(rgb_mul(throughput, diffuse->sky), kept_direct));
    if (by_group) {
        eye_sample_add_groups(sample, by_group, rgb_scale(throughput, kept_direct));
        eye_sample_add_group(sample, (uint32_t)t->layout->group_count, rgb_add(caustic, indirect));
    }
}

bool shading_go_on(const transport *t, const vertex *v, const sampler *where, int path_vertex, bool is_last,
                   rgb *in_out_throughput, bsdf_sample *out_next, bool *out_goes_straight)
{
    bool may_go_straight = transport_is_open_pane(t, v);
    if ((is_last && !may_go_straight) || !bsdf_has(&v->scattering, BSDF_TRACED) ||
        !bsdf_sample_direction(&v->scattering, BSDF_TRACED, BSDF_RADIANCE,
                               sampler_2d(where, SAMPLE_LOBE, path_vertex).x,
                               sampler_2d(where, SAMPLE_SCATTER, path_vertex), out_next))
        return false;
    *out_goes_straight = may_go_straight && out_next->is_straight;
    if (is_last && !*out_goes_straight)
        return false;
    *in_out_throughput = rgb_mul(*in_out_throughput, out_next->weight);
    return path_vertex < ROULETTE_AFTER ||
           transport_survives(in_out_throughput, sampler_2d(where, SAMPLE_ROULETTE, path_vertex).x);
}

void shading_radiance(const transport *t, eye_worker *worker, scene_ray ray, const sampler *where, eye_sample *in_out)
{
    const ag_render_settings *settings = t->settings;
    bool is_whole = settings->only == AG_ONLY_ALL;
    rgb throughput = rgb_gray(1.0f);
    vec3 scattered_from = ray.origin, scattered_normal = {0.0f, 0.0f, 0.0f};
    float scattered_pdf = 0.0f; /* of a rough traced lobe; 0: the eye or a smooth one, which no shadow ray can serve */
    int scatterings = 0;        /* so far; going straight through a pane may be none, and changes none of these */

    for (int path_vertex = 0;; path_vertex++) {
        vertex v;
        light_group_sums groups;
        light_part seen = scatterings == 0 ? PART_EMISSION : PART_SPECULAR;
        if (path_vertex == 0)
            worker->rays_camera++;
        else
            worker->rays_path++;
        bool is_met = transport_trace(t, worker, ray, &v);
        throughput = rgb_mul(throughput, v.transmittance);
        if (!is_met) {
            if (is_whole) {
                rgb *by_group = light_group_sums_begin(&groups, t->wants_groups);
                rgb escaped = direct_light_escaped(t, scattered_from, scattered_normal, ray.direction, scattered_pdf, 1,
                                                   1, by_group);
                float kept = eye_sample_add(in_out, seen, scatterings, rgb_mul(throughput, escaped));
                eye_sample_add_groups(in_out, by_group, rgb_scale(throughput, kept));
            }
            return;
        }
        worker->camera_rays_met += path_vertex == 0;
        if (path_vertex == 0 && t->wants_layers)
            first_hit_fill(t, worker, &v, where, &in_out->layers->first);

        /* emitted light, shared with the shadow rays of the vertex before where that had any */
        rgb emitted = transport_emission(t, &v);
        if (is_whole && !rgb_is_black(emitted)) {
            float weight = 1.0f;
            if (scattered_pdf > 0.0f)
                weight = direct_light_scatter_weight(t, scattered_from, scattered_normal, &v, scattered_pdf, 1, 1);
            rgb light_seen = rgb_scale(rgb_mul(throughput, emitted), weight);
            float kept = eye_sample_add(in_out, seen, scatterings, light_seen);
            if (t->wants_groups)
                eye_sample_add_group(in_out, v.lamp->group, rgb_scale(light_seen, kept));
        }

        /* diffuse lobes end here */
        if (bsdf_has(&v.scattering, BSDF_GATHERED)) {
            rgb *by_group = light_group_sums_begin(&groups, t->wants_groups);
            diffuse_light diffuse =
                diffuse_radiance(t, worker, &v, where, path_vertex, scatterings, throughput, by_group);
            add_diffuse(t, in_out, &diffuse, scatterings, throughput, by_group);
        }

        /* the others are traced on */
        bool is_last = scatterings >= settings->max_depth;
        if (is_whole && !is_last && bsdf_has(&v.scattering, BSDF_TRACED) &&
            bsdf_is_sampled_from_light(&v.scattering, BSDF_TRACED)) {
            float u_pick = sampler_2d(where, SAMPLE_LIGHT_PICK, path_vertex).x;
            lamp_light direct = direct_light_sample_lamp(t, worker, &v, BSDF_TRACED, u_pick,
                                                         sampler_2d(where, SAMPLE_LIGHT, path_vertex), 1, 1);
            rgb light_brought = rgb_mul(throughput, direct.radiance);
            float kept = eye_sample_add(in_out, PART_SPECULAR, scatterings + 1, light_brought);
            if (t->wants_groups && !rgb_is_black(light_brought))
                eye_sample_add_group(in_out, t->s->lights[direct.lamp].group, rgb_scale(light_brought, kept));
        }
        bsdf_sample next;
        bool goes_straight;
        if (!shading_go_on(t, &v, where, path_vertex, is_last, &throughput, &next, &goes_straight))
            return;
        if (goes_straight) {
            ray = passage_continue(&v.hit, &v.arrived);
            continue;
        }
        scatterings++;
        scattered_from = v.hit.position;
        scattered_normal = direct_light_normal(&v, BSDF_TRACED);
        scattered_pdf = next.is_delta ? 0.0f : next.pdf_solid_angle;
        ray = surface_ray(&v.hit, v.arrived, next.direction);
    }
}
