/* direct_lighting.c: see direct_lighting.h. */
#include "integrator/direct_lighting.h"

#include "light/light_tree.h"
#include "math/sampling.h"
#include "rays/transmittance.h"

rgb direct_light_transmittance(const transport *t, eye_worker *worker, scene_ray shadow, const light_sample *sample)
{
    float reach = INFINITY;
    if (!isinf(sample->distance)) {
        shadow.direction = vec3_sub(sample->shadow_target, shadow.origin);
        reach = 1.0f;
    }
    worker->rays_shadow++;
    return t->panes_are_direct ? transmittance_through_panes(t->s, shadow, reach, &worker->rays_cut)
                               : transmittance_of_ray(t->s, shadow, reach, &worker->rays_cut);
}

/* Picks the lamp for a point. *in_out_u become the numbers that sample it, *out_factor its density's factor. */
static uint32_t pick_lamp(const transport *t, vec3 from, vec3 normal, float u_pick, vec2 *in_out_u, float *out_factor)
{
    const direct_guide *guide = t->direct_guide;
    uint32_t cell = direct_guide_find(guide, from, normal);
    if (cell == DIRECT_GUIDE_NO_CELL)
        return scene_pick_light(t->s, from, normal, u_pick, out_factor);
    uint32_t lamp = direct_guide_pick(guide, t->s, cell, from, normal, u_pick, out_factor);
    if (*out_factor > 0.0f)
        *out_factor *= direct_guide_warp(guide, t->s, cell, lamp, in_out_u);
    return lamp;
}

/* Returns the lamp's probability, times the density of the guide's warp in that direction, which infinite lights alone
 * have. */
static float picked_factor(const transport *t, vec3 from, vec3 normal, uint32_t lamp, vec3 direction)
{
    const direct_guide *guide = t->direct_guide;
    uint32_t cell = direct_guide_find(guide, from, normal);
    if (cell == DIRECT_GUIDE_NO_CELL)
        return scene_light_probability(t->s, lamp, from, normal);
    return direct_guide_probability(guide, t->s, cell, lamp, from, normal) *
           direct_guide_density(guide, t->s, cell, lamp, direction);
}

/* Returns the radiance that the vertex reflects of a sample of a lamp, over the sample's density, which is that of the
 * lamp's own sampling times `factor`. */
static rgb reflected_light(const transport *t, eye_worker *worker, const vertex *v, bsdf_lobes lobes,
                           const light_sample *sample, float factor, int lamp_count, float scatter_count)
{
    rgb reflected = rgb_mul(bsdf_evaluate(&v->scattering, lobes, BSDF_RADIANCE, sample->direction), sample->radiance);
    if (rgb_is_black(reflected))
        return reflected;
    rgb transmittance = direct_light_transmittance(t, worker, vertex_ray(v, sample->direction), sample);
    if (rgb_is_black(transmittance))
        return transmittance;
    float pdf = sample->pdf_solid_angle * factor, weight = 1.0f;
    if (!sample->is_delta && scatter_count > 0.0f)
        weight = mis_power((float)lamp_count, pdf, scatter_count,
                           bsdf_pdf(&v->scattering, lobes, BSDF_RADIANCE, sample->direction));
    return rgb_scale(rgb_mul(reflected, transmittance), weight / pdf);
}

/* Samples a lamp that was picked. factor: its probability, times the density of the guide's warp at u where there is
 * one. */
static lamp_light sample_picked(const transport *t, eye_worker *worker, const vertex *v, bsdf_lobes lobes,
                                uint32_t lamp, float factor, vec2 u, int lamp_count, float scatter_count)
{
    light_sample sample;
    if (!(factor > 0.0f) || !light_sample_from_point(t->s, &t->s->lights[lamp], vertex_position(v), u, &sample))
        return (lamp_light){.radiance = rgb_gray(0.0f)};
    return (lamp_light){reflected_light(t, worker, v, lobes, &sample, factor, lamp_count, scatter_count), lamp,
                        sample.direction};
}

lamp_light direct_light_sample_lamp(const transport *t, eye_worker *worker, const vertex *v, bsdf_lobes lobes,
                                    float u_pick, vec2 u, int lamp_count, float scatter_count)
{
    if (!t->has_lights)
        return (lamp_light){.radiance = rgb_gray(0.0f)};
    float factor;
    uint32_t lamp = pick_lamp(t, vertex_position(v), vertex_light_normal(v, lobes), u_pick, &u, &factor);
    return sample_picked(t, worker, v, lobes, lamp, factor, u, lamp_count, scatter_count);
}

/* With more lights that reach everywhere a sample of each would cost too much. */
enum { EACH_LIGHTS_MAX = 8 };

/* The share of direct_light_sample_each's samples whose direction a cell of the direct guide decides. */
static const float EACH_GUIDED_SHARE = 0.5f;

/* Returns the factor of the density of direct_light_sample_each, for a light that reaches everywhere. */
static float each_factor(const transport *t, uint32_t cell, uint32_t lamp, vec3 direction)
{
    if (cell == DIRECT_GUIDE_NO_CELL)
        return 1.0f;
    return 1.0f - EACH_GUIDED_SHARE +
           EACH_GUIDED_SHARE * direct_guide_density(t->direct_guide, t->s, cell, lamp, direction);
}

rgb direct_light_sample_each(const transport *t, eye_worker *worker, const vertex *v, bsdf_lobes lobes, rng *random,
                             float scatter_count)
{
    rgb sum = rgb_gray(0.0f);
    if (!t->has_lights)
        return sum;
    const scene *s = t->s;
    if (s->everywhere_count > EACH_LIGHTS_MAX) {
        float u_light = rng_float(random);
        return direct_light_sample_lamp(t, worker, v, lobes, u_light, rng_vec2(random), 1, scatter_count).radiance;
    }
    vec3 from = vertex_position(v), normal = vertex_light_normal(v, lobes);
    uint32_t cell = direct_guide_find(t->direct_guide, from, normal);
    for (uint32_t i = 0; i < s->everywhere_count; i++) {
        light_sample sample;
        uint32_t lamp = s->everywhere_lights[i];
        bool is_guided = rng_float(random) < EACH_GUIDED_SHARE && cell != DIRECT_GUIDE_NO_CELL;
        vec2 u = rng_vec2(random);
        if (is_guided)
            direct_guide_warp(t->direct_guide, s, cell, lamp, &u);
        if (light_sample_from_point(s, &s->lights[lamp], from, u, &sample))
            sum = rgb_add(sum, reflected_light(t, worker, v, lobes, &sample,
                                               each_factor(t, cell, lamp, sample.direction), 1, scatter_count));
    }
    if (!s->light_tree)
        return sum;
    float probability, u_pick = rng_float(random);
    vec2 u = rng_vec2(random);
    uint32_t lamp = light_tree_pick(s->light_tree, from, normal, u_pick, &probability);
    return rgb_add(sum, sample_picked(t, worker, v, lobes, lamp, probability, u, 1, scatter_count).radiance);
}

/* Adds light to the group of its lamp, where groups are asked for. */
static void add_to_group(rgb *by_group, const light *lamp, rgb light_brought)
{
    if (by_group)
        by_group[lamp->group] = rgb_add(by_group[lamp->group], light_brought);
}

/* Returns the weight of a sample by scattering in a direction that a lamp's own sampling has with density own_pdf. */
static float scatter_weight(const transport *t, vec3 from, vec3 normal, uint32_t lamp, vec3 direction, float own_pdf,
                            float pdf_solid_angle, light_counts counts)
{
    const light *l = &t->s->lights[lamp];
    float factor;
    if (counts.lamp != LIGHT_COUNT_EACH || t->s->everywhere_count > EACH_LIGHTS_MAX)
        factor = picked_factor(t, from, normal, lamp, direction);
    else if (!(rgb_mean(l->power) > 0.0f))
        factor = 0.0f;
    else if (light_is_everywhere(l))
        factor = each_factor(t, direct_guide_find(t->direct_guide, from, normal), lamp, direction);
    else
        factor = light_tree_probability(t->s->light_tree, lamp, from, normal);
    float lamp_count = counts.lamp == LIGHT_COUNT_EACH ? 1.0f : (float)counts.lamp;
    return mis_power(counts.scattering, pdf_solid_angle, lamp_count, factor * own_pdf);
}

float direct_light_scatter_weight(const transport *t, vec3 from, vec3 normal, const vertex *on_lamp,
                                  float pdf_solid_angle, light_counts counts)
{
    uint32_t lamp = (uint32_t)(on_lamp->lamp - t->s->lights);
    return scatter_weight(t, from, normal, lamp, on_lamp->arrived.direction,
                          light_pdf_from_point(t->s, on_lamp->lamp, from, &on_lamp->hit), pdf_solid_angle, counts);
}

rgb direct_light_escaped(const transport *t, vec3 from, vec3 normal, vec3 direction, float pdf_solid_angle,
                         light_counts counts, rgb *by_group)
{
    const scene *s = t->s;
    rgb sum = rgb_gray(0.0f);
    for (uint32_t i = 0; i < s->infinite_light_count; i++) {
        uint32_t index = s->infinite_lights[i];
        const light *l = &s->lights[index];
        rgb radiance = light_escaped_radiance(l, from, direction);
        if (rgb_is_black(radiance))
            continue;
        float weight = 1.0f;
        if (pdf_solid_angle > 0.0f)
            weight = scatter_weight(t, from, normal, index, direction, light_escaped_pdf(l, from, direction),
                                    pdf_solid_angle, counts);
        sum = rgb_add(sum, rgb_scale(radiance, weight));
        add_to_group(by_group, l, rgb_scale(radiance, weight));
    }
    return sum;
}

/* Returns how many samples by scattering are taken on average. */
static float mean_scatter_count(sample_counts counts) { return (float)counts.scatter * counts.scatter_probability; }

/* The samples that one of the two ways of sampling has taken of a vertex's direct light. */
typedef struct light_sums {
    rgb sum;    /* of the samples */
    float half; /* of the first half of them, of the mean of the three colours */
} light_sums;

/* number: the sample's, of so many. */
static void add_sample(light_sums *sums, uint32_t number, uint32_t count, rgb brought)
{
    sums->sum = rgb_add(sums->sum, brought);
    if (number < count / 2)
        sums->half += rgb_mean(brought);
}

/* Returns the variance of the samples' mean, by how their halves differ; 0 for a single one, of which it is not known.
 * Each half is spread as evenly as all are, so that it tells how little is left to chance by that, which samples that
 * are held against each other one by one do not. */
static float variance_of_mean(const light_sums *sums, int count)
{
    if (count < 2)
        return 0.0f;
    float first = (float)(count / 2), second = (float)count - first;
    float apart = sums->half / first - (rgb_mean(sums->sum) - sums->half) / second;
    return apart * apart * first * second / ((float)count * (float)count);
}

/* Samples lamps. The sky's part, and that of groups where they are asked for, is added as a mean over the samples. */
static light_sums sample_lamps(const transport *t, eye_worker *worker, const vertex *v, const sampler *where,
                               int path_vertex, sample_counts counts, rgb *in_out_sky, rgb *by_group)
{
    light_sums sums = {rgb_gray(0.0f), 0.0f};
    const uint32_t count = (uint32_t)counts.light;
    const float share = 1.0f / (float)counts.light;
    for (uint32_t i = 0; i < count; i++) {
        float u_pick = sampler_2d_of(where, SAMPLE_LIGHT_PICK, path_vertex, count, i).x;
        vec2 u = sampler_2d_of(where, SAMPLE_LIGHT, path_vertex, count, i);
        lamp_light sample =
            direct_light_sample_lamp(t, worker, v, BSDF_GATHERED, u_pick, u, counts.light, mean_scatter_count(counts));
        add_sample(&sums, i, count, sample.radiance);
        if (rgb_is_black(sample.radiance))
            continue;
        const light *lamp = &t->s->lights[sample.lamp];
        if (light_is_sky(lamp))
            *in_out_sky = rgb_add(*in_out_sky, rgb_scale(sample.radiance, share));
        add_to_group(by_group, lamp, rgb_scale(sample.radiance, share));
    }
    return sums;
}

/* Samples directions by scattering, where that can meet a lamp. The sky's part and the groups' are sample_lamps'. */
static light_sums sample_scattering(const transport *t, eye_worker *worker, const vertex *v, const sampler *where,
                                    int path_vertex, sample_counts counts, rgb *in_out_sky, rgb *by_group)
{
    light_sums sums = {rgb_gray(0.0f), 0.0f};
    const uint32_t count = (uint32_t)counts.scatter;
    if (count == 0 ||
        (counts.scatter_probability < 1.0f &&
         sampler_2d(where, SAMPLE_LOBE, path_vertex + SAMPLER_KEY_CHANCE).x >= counts.scatter_probability))
        return sums;
    const float mean_count = mean_scatter_count(counts), share = 1.0f / mean_count;
    const light_counts against = {counts.light, mean_count};
    const vec3 from = vertex_position(v), normal = vertex_light_normal(v, BSDF_GATHERED);
    for (uint32_t i = 0; i < count; i++) {
        float u_lobe = sampler_2d_of(where, SAMPLE_LOBE, path_vertex, count, i).y; /* x decides the vertex's way on */
        vec2 u = sampler_2d_of(where, SAMPLE_SCATTER_TO_LIGHT, path_vertex, count, i);
        bsdf_sample scattered;
        if (!bsdf_sample_direction(&v->scattering, BSDF_GATHERED, BSDF_RADIANCE, u_lobe, u, &scattered))
            continue;
        vertex met;
        worker->rays_shadow++;
        scene_ray ray = transport_scattered_ray(t, v, scattered.direction, false);
        if (!transport_trace_through_panes(t, worker, ray, &met)) {
            light_group_sums groups;
            rgb *of_group = light_group_sums_begin(&groups, by_group != NULL);
            rgb escaped = direct_light_escaped(t, from, normal, scattered.direction, scattered.pdf_solid_angle, against,
                                               of_group);
            add_sample(&sums, i, count, rgb_mul(rgb_mul(escaped, met.transmittance), scattered.weight));
            rgb reflected = rgb_scale(rgb_mul(met.transmittance, scattered.weight), share);
            *in_out_sky = rgb_add(*in_out_sky, rgb_mul(escaped, reflected));
            for (int k = 0; of_group && k <= LIGHT_GROUPS_MAX; k++)
                by_group[k] = rgb_add(by_group[k], rgb_mul(of_group[k], reflected));
            continue;
        }
        rgb emitted = rgb_mul(vertex_emission(t->s, &met), met.transmittance);
        if (rgb_is_black(emitted))
            continue;
        float weight = direct_light_scatter_weight(t, from, normal, &met, scattered.pdf_solid_angle, against);
        rgb brought = rgb_scale(rgb_mul(emitted, scattered.weight), weight);
        add_sample(&sums, i, count, brought);
        add_to_group(by_group, met.lamp, rgb_scale(brought, share));
    }
    return sums;
}

direct_light direct_light_gathered(const transport *t, eye_worker *worker, const vertex *v, const sampler *where,
                                   int path_vertex, sample_counts counts, rgb *by_group)
{
    direct_light direct = {rgb_gray(0.0f), rgb_gray(0.0f), 0.0f};
    if (!t->has_lights)
        return direct;
    light_sums lamps = sample_lamps(t, worker, v, where, path_vertex, counts, &direct.from_sky, by_group);
    light_sums scattered = sample_scattering(t, worker, v, where, path_vertex, counts, &direct.from_sky, by_group);
    direct.radiance = rgb_scale(lamps.sum, 1.0f / (float)counts.light);
    if (counts.scatter > 0)
        direct.radiance = rgb_add(direct.radiance, rgb_scale(scattered.sum, 1.0f / mean_scatter_count(counts)));
    /* a single scattered sample stands for its own deviation */
    const float chance = counts.scatter_probability;
    const float single = rgb_mean(scattered.sum);
    direct.variance = variance_of_mean(&lamps, counts.light) +
                      (counts.scatter == 1 ? (1.0f - 0.5f * chance) * single * single / (chance * chance)
                                           : variance_of_mean(&scattered, counts.scatter));
    return direct;
}
