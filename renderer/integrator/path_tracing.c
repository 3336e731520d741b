/* path_tracing.c: see path_tracing.h. */
#include "integrator/path_tracing.h"

#include "integrator/direct_lighting.h"
#include "integrator/first_hit.h"
#include "integrator/integrator.h"
#include "rays/passage.h"

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

/* Which part light would belong to that the path met now, as shares that sum to 1 in each channel: a direction may
 * stand for several lobes of the surfaces that were passed. */
typedef struct part_shares {
    rgb of[LIGHT_PART_COUNT];
} part_shares;

/* Behind a surface whose gathered lobes have this share of what it scatters there. */
static part_shares part_shares_scatter(const part_shares *before, rgb gathered)
{
    rgb traced = rgb_sub(rgb_gray(1.0f), gathered);
    rgb from_lamp = rgb_add(before->of[PART_DIRECT], before->of[PART_CAUSTIC]);
    part_shares after;
    after.of[PART_EMISSION] = rgb_gray(0.0f);
    after.of[PART_DIRECT] = rgb_mul(before->of[PART_EMISSION], gathered);
    after.of[PART_CAUSTIC] = rgb_mul(from_lamp, traced);
    after.of[PART_INDIRECT] = rgb_add(before->of[PART_INDIRECT], rgb_mul(from_lamp, gathered));
    after.of[PART_SPECULAR] = rgb_add(before->of[PART_SPECULAR], rgb_mul(before->of[PART_EMISSION], traced));
    return after;
}

/* The share of the gathered lobes in what is scattered out of a direction. */
static rgb gathered_share(const bsdf *b, vec3 direction)
{
    rgb gathered = bsdf_evaluate(b, BSDF_GATHERED, BSDF_RADIANCE, direction);
    rgb traced = bsdf_evaluate(b, BSDF_TRACED, BSDF_RADIANCE, direction), all = rgb_add(gathered, traced);
    return (rgb){all.r > 0.0f ? gathered.r / all.r : 0.0f, all.g > 0.0f ? gathered.g / all.g : 0.0f,
                 all.b > 0.0f ? gathered.b / all.b : 0.0f};
}

/* shares NULL: parts are not asked for. is_sky: an infinite light's. */
static float add_light(eye_sample *sample, const part_shares *shares, int scatterings, rgb light_brought, bool is_sky)
{
    float kept = eye_sample_bound(sample, 1.0f, scatterings, light_brought);
    if (kept < 1.0f)
        light_brought = rgb_scale(light_brought, kept);
    sample->radiance = rgb_add(sample->radiance, light_brought);
    for (int i = 0; shares && i < LIGHT_PART_COUNT; i++)
        eye_sample_note(sample, (light_part)i, rgb_mul(light_brought, shares->of[i]));
    if (shares && is_sky)
        sample->layers->sky = rgb_add(sample->layers->sky, rgb_mul(light_brought, shares->of[PART_DIRECT]));
    return kept;
}

void path_tracing_radiance(const transport *t, eye_worker *worker, scene_ray ray, const sampler *where,
                           eye_sample *in_out)
{
    const ag_render_settings *settings = t->settings;
    bool is_whole = settings->only == AG_ONLY_ALL, wants_parts = in_out->layers != NULL;
    rgb throughput = rgb_gray(1.0f);
    vec3 scattered_from = ray.origin, scattered_normal = {0.0f, 0.0f, 0.0f};
    float scattered_pdf = 0.0f;   /* 0: the eye or a smooth lobe */
    int scatterings = 0;          /* so far; going straight through a pane may be none, and changes none of all these */
    bool has_met_diffuse = false; /* the path has been scattered by a gathered lobe */
    bool left_first_diffuse = false; /* at the vertex before, for the first time */
    part_shares shares = {.of = {[PART_EMISSION] = rgb_gray(1.0f)}};
    const part_shares *wanted_shares = wants_parts ? &shares : NULL;

    for (int path_vertex = 0;; path_vertex++) {
        vertex v;
        light_group_sums groups;
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
                rgb *by_group = light_group_sums_begin(&groups, t->wants_groups);
                rgb escaped = direct_light_escaped(t, scattered_from, scattered_normal, ray.direction, scattered_pdf, 1,
                                                   1, by_group);
                float kept = add_light(in_out, wanted_shares, scatterings, rgb_mul(throughput, escaped), true);
                eye_sample_add_groups(in_out, by_group, rgb_scale(throughput, kept));
            }
            return;
        }
        worker->camera_rays_met += path_vertex == 0;
        if (path_vertex == 0 && t->wants_layers)
            first_hit_fill(t, worker, &v, where, &in_out->layers->first);
        rgb emitted = transport_emission(t, &v);
        if (!rgb_is_black(emitted) && counts_emission) {
            float weight = 1.0f;
            if (scattered_pdf > 0.0f)
                weight = direct_light_scatter_weight(t, scattered_from, scattered_normal, &v, scattered_pdf, 1, 1);
            rgb light_seen = rgb_scale(rgb_mul(throughput, emitted), weight);
            float kept = add_light(in_out, wanted_shares, scatterings, light_seen, false);
            if (t->wants_groups)
                eye_sample_add_group(in_out, v.lamp->group, rgb_scale(light_seen, kept));
        }
        bool is_last = scatterings >= settings->max_depth, may_go_straight = transport_is_open_pane(t, &v);
        if (is_last && !may_go_straight)
            return;

        /* next-event estimation */
        if ((is_whole || has_met_diffuse) && !is_last && bsdf_is_sampled_from_light(&v.scattering, BSDF_ALL)) {
            float u_pick = sampler_2d(where, SAMPLE_LIGHT_PICK, path_vertex).x;
            lamp_light direct = direct_light_sample_lamp(t, worker, &v, BSDF_ALL, u_pick,
                                                         sampler_2d(where, SAMPLE_LIGHT, path_vertex), 1, 1);
            rgb light_brought = rgb_mul(throughput, direct.radiance);
            bool is_lit = !rgb_is_black(light_brought);
            part_shares there;
            if (wants_parts && is_lit)
                there = part_shares_scatter(&shares, gathered_share(&v.scattering, direct.direction));
            bool is_sky = is_lit && t->s->lights[direct.lamp].kind == LIGHT_INFINITE;
            float kept =
                add_light(in_out, wants_parts && is_lit ? &there : NULL, scatterings + 1, light_brought, is_sky);
            if (t->wants_groups && is_lit)
                eye_sample_add_group(in_out, t->s->lights[direct.lamp].group, rgb_scale(light_brought, kept));
        }

        /* go on */
        bsdf_sample next;
        float u_lobe = sampler_2d(where, SAMPLE_LOBE, path_vertex).x;
        bsdf_lobes lobes = BSDF_ALL;
        if (!is_whole && !has_met_diffuse)
            lobes = pick_group(&v, &u_lobe, &throughput);
        if (!bsdf_sample_direction(&v.scattering, lobes, BSDF_RADIANCE, u_lobe,
                                   sampler_2d(where, SAMPLE_SCATTER, path_vertex), &next))
            return;
        bool goes_straight = may_go_straight && next.is_straight;
        if (is_last && !goes_straight)
            return;
        throughput = rgb_mul(throughput, next.weight);
        if (path_vertex >= ROULETTE_AFTER &&
            !transport_survives(&throughput, sampler_2d(where, SAMPLE_ROULETTE, path_vertex).x))
            return;
        if (goes_straight) {
            ray = passage_continue(&v.hit, &v.arrived);
            continue;
        }
        scatterings++;
        if (wants_parts) {
            bool is_of_one = next.is_delta || lobes != BSDF_ALL;
            shares = part_shares_scatter(&shares, is_of_one ? rgb_gray(next.group == BSDF_GATHERED ? 1.0f : 0.0f)
                                                            : gathered_share(&v.scattering, next.direction));
        }
        left_first_diffuse = !has_met_diffuse && next.group == BSDF_GATHERED;
        has_met_diffuse = has_met_diffuse || left_first_diffuse;
        scattered_from = v.hit.position;
        scattered_normal = direct_light_normal(&v, BSDF_ALL);
        scattered_pdf = next.is_delta ? 0.0f : next.pdf_solid_angle;
        ray = transport_scattered_ray(t, &v, next.direction, next.is_delta);
        ray.cone = next.group == BSDF_GATHERED
                       ? transport_gather_cone(&v)
                       : transport_scattered_cone(t, &v, next.direction, next.is_delta, next.pdf_solid_angle);
    }
}

const integrator path_integrator = {.sample = path_tracing_radiance};
