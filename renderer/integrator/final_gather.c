/* final_gather.c: see final_gather.h. */
#include "integrator/final_gather.h"

#include "integrator/direct_lighting.h"
#include "integrator/gather_directions.h"
#include "math/sampling.h"
#include "rays/passage.h"

/* Roulette begins after this many scatterings along one gather ray; short rays bounce on at most so often (asked
 * sooner, the cache tells of the light outside of a small room). */
enum { ROULETTE_AFTER = 4, SHORT_BOUNCES_MAX = 64 };

/* One gather: from where, what its rays' random numbers are keyed by, and what they brought themselves. */
typedef struct gathering {
    const transport *t;
    eye_worker *worker;
    const vertex *from;
    const sampler *where;
    int path_vertex, scatterings_left;
    uint32_t count;
    rgb known;
} gathering;

static rng ray_random(const gathering *g, uint32_t number)
{
    return rng_make(g->where->key, (uint64_t)g->path_vertex, g->where->sample * g->count + number);
}

/* The ray ends at a diffuse place: irradiance on one side of it, picked by the lobes' shares. */
static void read_cache(const gathering *g, const vertex *v, rgb throughput, float u_side)
{
    map_place at = transport_map_place(g->t, v);
    rgb reflected = bsdf_gathered_reflection(&v->scattering), transmitted = bsdf_gathered_transmission(&v->scattering);
    rgb factor = reflected;
    if (!rgb_is_black(transmitted)) {
        float share = rgb_max(transmitted) / (rgb_max(reflected) + rgb_max(transmitted));
        bool is_through = u_side < share;
        factor = is_through ? rgb_scale(transmitted, 1.0f / share) : rgb_scale(reflected, 1.0f / (1.0f - share));
        if (is_through)
            at.facing_normal = vec3_negate(at.facing_normal);
    }
    gather_batch_ask(g->worker->batch, at.position, at.facing_normal,
                     rgb_scale(rgb_mul(throughput, factor), AG_INV_PI));
}

/* Most rays end at once at a Lambertian surface far enough away: without any of what makes up a bsdf. */
static bool ends_plainly(const gathering *g, const vertex *v, rgb throughput)
{
    const rgb *albedo = material_plain_albedo(g->t->s, g->t->s->shapes[v->hit.shape_index].material_index);
    if (!albedo || v->hit.is_strand)
        return false;
    map_place at = transport_map_place(g->t, v);
    gather_batch_ask(g->worker->batch, at.position, at.facing_normal,
                     rgb_scale(rgb_mul(throughput, *albedo), AG_INV_PI));
    return true;
}

/* What is behind a gather ray of that number, which has met *v, and weighs `first` at its start: asks for irradiance,
 * and adds to what is known. Lamps and environments add nothing: light straight from them is direct light, light from
 * them by way of traced lobes is in the caustic map. */
static void follow(gathering *g, uint32_t number, rgb first, vertex *v)
{
    const transport *t = g->t;
    eye_worker *worker = g->worker;
    rgb throughput = rgb_gray(1.0f);
    float travelled = 0.0f;
    int short_bounces = 0;
    rng random = {0};
    for (int depth = 0;;) {
        throughput = rgb_mul(throughput, v->transmittance);
        travelled += v->hit.distance;
        bool is_far = travelled >= t->gather_min_distance || short_bounces == SHORT_BOUNCES_MAX;
        if (is_far && ends_plainly(g, v, rgb_mul(first, throughput)))
            return;
        transport_complete(t, v);
        if (depth == 0) {
            random = ray_random(g, number);
            rng_next(&random); /* of the lobe that the ray left by */
        }
        float u_lobe = rng_float(&random), u_group = rng_float(&random);
        vec2 u = rng_vec2(&random);

        /* one group of lobes, picked by its share */
        float gathered_share = bsdf_probability(&v->scattering, BSDF_GATHERED);
        bsdf_lobes lobes = u_group < gathered_share ? BSDF_GATHERED : BSDF_TRACED;
        throughput = rgb_scale(throughput, 1.0f / (lobes == BSDF_GATHERED ? gathered_share : 1.0f - gathered_share));
        if (lobes == BSDF_GATHERED) {
            if (is_far) {
                read_cache(g, v, rgb_mul(first, throughput), u_lobe);
                return;
            }
            /* too near for an estimate that is blurred over about that distance: the light there is direct light,
             * caustics, and what one more bounce brings */
            float u_pick = rng_float(&random);
            rgb local = direct_light_from_lamp(t, worker, v, BSDF_GATHERED, u_pick, rng_vec2(&random), 1, 0);
            local = rgb_add(local, transport_caustics(t, worker, v));
            g->known = rgb_add(g->known, rgb_mul(rgb_mul(first, throughput), local));
            travelled = 0.0f;
            short_bounces++;
        }
        bsdf_sample next;
        if (!bsdf_sample_direction(&v->scattering, lobes, BSDF_RADIANCE, u_lobe, u, &next))
            return;
        throughput = rgb_mul(throughput, next.weight);
        if ((depth >= ROULETTE_AFTER || lobes == BSDF_GATHERED) && !transport_survives(&throughput, rng_float(&random)))
            return;
        if (++depth == g->scatterings_left)
            return;
        scene_ray ray = surface_ray(&v->hit, v->arrived, next.direction);
        ray.skips_uv = true;
        worker->rays_gather++;
        if (!transport_meet(t, worker, ray, v))
            return;
    }
}

static void follow_alone(gathering *g, uint32_t number, vec3 direction, rgb weight)
{
    vertex v;
    scene_ray ray = surface_ray(&g->from->hit, g->from->arrived, direction);
    ray.skips_uv = true;
    g->worker->rays_gather++;
    if (transport_meet(g->t, g->worker, ray, &v))
        follow(g, number, weight, &v);
}

/* Some of a gather's rays, to the side that the path came from: with what weighs what is behind each, and its number.
 */
typedef struct gather_rays {
    ray_fan fan;
    rgb weight[RAY_FAN_MAX];
    uint32_t number[RAY_FAN_MAX];
} gather_rays;

static void follow_together(gathering *g, gather_rays *r)
{
    const transport *t = g->t;
    ray_fan *fan = &r->fan;
    scene_intersect_fan(t->s, fan);
    g->worker->rays_gather += fan->count;
    for (uint32_t i = 0; i < fan->count; i++) {
        float distance = fan->met[i].distance;
        if (distance == INFINITY)
            continue;
        vec3 position, normal;
        const rgb *albedo = NULL;
        if (distance >= t->gather_min_distance)
            albedo = ray_fan_plain_place(t->s, fan, i, &position, &normal);
        if (albedo) {
            gather_batch_ask(g->worker->batch, position, normal, rgb_scale(rgb_mul(r->weight[i], *albedo), AG_INV_PI));
            continue;
        }
        vertex v;
        v.arrived = fan->common;
        v.arrived.direction = ray_fan_direction(fan, i);
        v.transmittance = rgb_gray(1.0f);
        ray_fan_hit(t->s, fan, i, &v.hit);
        follow(g, r->number[i], r->weight[i], &v);
    }
}

/* The rays `begin` to `end` of a Lambertian place: by the cosine, so that each weighs the albedo; where there is a
 * guide, by both. */
static void sample_plain(const gathering *g, const incident_guide *guide, sampler_sequence *numbers, uint32_t begin,
                         uint32_t end, gather_rays *r)
{
    const bsdf *b = &g->from->scattering;
    vec3 n = transport_facing_normal(g->from);
    ray_fan *fan = &r->fan;
    float u[2][RAY_FAN_MAX], weights[RAY_FAN_MAX];
    gather_numbers(numbers, begin, end - begin, u);
    if (guide)
        incident_guide_warp(guide, end - begin, u, weights);
    gather_directions(u, end - begin, guide ? &guide->around : &b->shading, !guide && bsdf_is_below(b), fan->direction);
    for (uint32_t i = 0; i < end - begin; i++) {
        vec3 direction = ray_fan_direction(fan, i);
        uint32_t k = fan->count;
        for (int a = 0; a < 3; a++)
            fan->direction[a][k] = fan->direction[a][i];
        r->number[k] = begin + i;
        r->weight[k] = guide ? rgb_scale(b->matter.reflectance, weights[i]) : b->matter.reflectance;
        fan->count +=
            vec3_dot(direction, n) > 0.0f; /* a shading normal sends some through the surface: they are lost */
    }
}

/* Of any other place; what goes through is followed at once. */
static void sample_lobes(gathering *g, sampler_sequence *numbers, uint32_t begin, uint32_t end, gather_rays *r)
{
    const bsdf *b = &g->from->scattering;
    vec3 n = transport_facing_normal(g->from);
    for (uint32_t i = begin; i < end; i++) {
        bsdf_sample s;
        rng random = ray_random(g, i);
        vec2 u = sampler_sequence_at(numbers, i);
        if (!bsdf_sample_direction(b, BSDF_GATHERED, BSDF_RADIANCE, rng_float(&random), u, &s))
            continue;
        if (!(vec3_dot(s.direction, n) > 0.0f)) {
            follow_alone(g, i, s.direction, s.weight);
            continue;
        }
        uint32_t k = r->fan.count++;
        r->fan.direction[0][k] = s.direction.x;
        r->fan.direction[1][k] = s.direction.y;
        r->fan.direction[2][k] = s.direction.z;
        r->number[k] = i;
        r->weight[k] = s.weight;
    }
}

/* The place is plain; what is found is for the side that it is seen from. */
static bool find_guide(const transport *t, const vertex *v, incident_guide *out_guide)
{
    const bsdf *b = &v->scattering;
    if (!t->incident)
        return false;
    return incident_light_find(t->incident, transport_map_place(t, v).position,
                               bsdf_is_below(b) ? vec3_negate(b->shading.z) : b->shading.z, out_guide);
}

void final_gather(const transport *t, eye_worker *worker, const vertex *v, const sampler *where, int path_vertex,
                  int scatterings_left, rgb throughput)
{
    uint32_t count = (uint32_t)t->settings->gather_samples;
    gathering g = {t, worker, v, where, path_vertex, scatterings_left - 1, count, rgb_gray(0.0f)};
    gather_batch *batch = worker->batch;
    if (!gather_batch_has_room(batch, RAY_FAN_MAX))
        gather_batch_resolve(batch, t->cache, t->run, worker->index);
    gather_batch_begin(batch, worker->sample, path_vertex == 0, rgb_scale(throughput, 1.0f / (float)count));
    sampler_sequence numbers = sampler_sequence_make(where, SAMPLE_GATHER, path_vertex, count);
    bool is_plain = bsdf_is_plain(&v->scattering);
    incident_guide guide;
    bool is_guided = is_plain && find_guide(t, v, &guide);
    gather_rays rays;
    rays.fan.common = surface_ray(&v->hit, v->arrived, transport_facing_normal(v));
    rays.fan.common.skips_uv = true;
    /* cancelled, its sample is thrown away */
    for (uint32_t begin = 0; begin < count && !run_is_cancelled(t->run); begin += RAY_FAN_MAX) {
        uint32_t end = count - begin < RAY_FAN_MAX ? count : begin + RAY_FAN_MAX;
        if (!gather_batch_has_room(batch, end - begin))
            gather_batch_resolve(batch, t->cache, t->run, worker->index);
        rays.fan.count = 0;
        if (is_plain)
            sample_plain(&g, is_guided ? &guide : NULL, &numbers, begin, end, &rays);
        else
            sample_lobes(&g, &numbers, begin, end, &rays);
        if (passage_is_clear(t->s, &rays.fan.common)) {
            follow_together(&g, &rays);
            continue;
        }
        for (uint32_t i = 0; i < rays.fan.count; i++)
            follow_alone(&g, rays.number[i], ray_fan_direction(&rays.fan, i), rays.weight[i]);
    }
    gather_batch_end(batch, g.known);
}
