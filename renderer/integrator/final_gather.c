/* final_gather.c: see final_gather.h. */
#include "integrator/final_gather.h"

#include "integrator/gather_directions.h"
#include "integrator/gather_path.h"
#include "math/sampling.h"
#include "rays/slab_faces.h"
#include "rays/transmittance.h"

/* Key of the random stream that tells how far a gather ray goes in media, apart from the ray's other numbers. */
static const uint64_t KEY_OF_DISTANCE = 0x64697374616e6365u;

/* A gather while its rays are sent. */
typedef struct gathering {
    const transport *t;
    eye_worker *worker;
    const gather_request *request;
    float share_seen; /* the share of a ray's light that reaches the eye */
    rgb known;        /* light that its rays brought without a request for irradiance */
    uint64_t cost;    /* the cost of its rays, as eye_worker_cost has it */
} gathering;

/* Returns random numbers of the gather ray of that number. key: of the use, 0 for its lobe and its path. */
static rng ray_random(const gathering *g, uint64_t key, uint32_t number)
{
    const gather_request *r = g->request;
    return rng_make(r->where->key ^ key, (uint64_t)r->path_vertex, (uint64_t)r->where->sample * r->count + number);
}

/* Returns how many scatterings are left between a ray's end and the lamp. */
static int scatterings_left(const gathering *g) { return g->request->scatterings_left - 1; }

/* Finds the light behind the gather ray of that number, which has met *v: requests irradiance at its end, and adds what
 * it has brought on the way to what is known. first: the weight of its light at its start. */
static void follow(gathering *g, uint32_t number, rgb first, vertex *v)
{
    gather_ends ends;
    rgb known = rgb_gray(0.0f);
    rng random = ray_random(g, 0, number);
    rng_next(&random); /* skips the number that picked the lobe by which the ray left */
    uint64_t before = eye_worker_cost(g->worker);
    bool asks =
        gather_path_follow(g->t, g->worker, v, random, scatterings_left(g), first, g->share_seen, &known, &ends);
    g->cost += eye_worker_cost(g->worker) - before;
    g->known = rgb_add(g->known, known);
    if (asks)
        gather_batch_ask_all(g->worker->batch, &ends, number, rgb_mean(known));
    else
        gather_batch_note(g->worker->batch, rgb_mean(known));
}

static void follow_alone(gathering *g, uint32_t number, vec3 direction, rgb weight)
{
    vertex v;
    rng random = ray_random(g, KEY_OF_DISTANCE, number);
    scene_ray ray = transport_scattered_ray(g->t, g->request->from, direction, false);
    ray.skips_uv = true;
    ray.cone = transport_gather_cone(g->request->from);
    g->worker->rays_gather++;
    g->cost += EYE_COST_OF_RAY;
    if (transport_travel_to(g->t, g->worker, ray, weight, &random, &v))
        follow(g, number, weight, &v);
}

/* Some of a gather's rays, towards the side that the path came from: each with its number, and the weight of the light
 * behind it. */
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
    g->cost += (uint64_t)EYE_COST_OF_RAY * fan->count;
    for (uint32_t i = 0; i < fan->count; i++) {
        float distance = fan->met[i].distance;
        if (distance == INFINITY)
            continue;
        gather_end end = {.medium = fan->common.medium, .scatterings_left = scatterings_left(g)};
        const rgb *albedo = NULL;
        if (distance >= t->gather_min_distance)
            albedo = ray_fan_plain_point(t->s, fan, i, &end.point);
        if (albedo) {
            gather_batch_ask(g->worker->batch, &end, r->number[i], rgb_scale(rgb_mul(r->weight[i], *albedo), AG_INV_PI),
                             0.0f);
            continue;
        }
        vertex v;
        v.arrived = fan->common;
        v.arrived.direction = ray_fan_direction(fan, i);
        v.transmittance = rgb_gray(1.0f);
        v.is_in_medium = false;
        ray_fan_hit(t->s, fan, i, &v.hit);
        slab_meet(t->s, &v.arrived, &v.hit);
        surface_widen_cone(&v.arrived, &v.hit);
        follow(g, r->number[i], r->weight[i], &v);
    }
}

/* Makes the rays `begin` to `end` of a Lambertian vertex. Their directions go by the cosine, so that each ray weighs
 * the albedo, or by the cosine and a guide. */
static void sample_plain(const gathering *g, const incident_guide *guide, sampler_sequence *numbers, uint32_t begin,
                         uint32_t end, gather_rays *r)
{
    const bsdf *b = &g->request->from->scattering;
    vec3 n = vertex_facing_normal(g->request->from);
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
        r->weight[k] = guide ? rgb_scale(b->material.diffuse.reflectance, weights[i]) : b->material.diffuse.reflectance;
        /* a shading normal sends some rays through the surface, which bring nothing */
        fan->count += vec3_dot(direction, n) > 0.0f;
    }
}

/* Samples a vertex that is not plain; rays that go through are followed at once. */
static void sample_lobes(gathering *g, sampler_sequence *numbers, uint32_t begin, uint32_t end, gather_rays *r)
{
    const bsdf *b = &g->request->from->scattering;
    vec3 n = vertex_facing_normal(g->request->from);
    for (uint32_t i = begin; i < end; i++) {
        bsdf_sample s;
        rng random = ray_random(g, 0, i);
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

/* Finds the guide for gathers at a plain vertex, on the side that is seen. Returns false where there is none. */
static bool find_guide(const transport *t, const vertex *v, incident_guide *out_guide)
{
    const bsdf *b = &v->scattering;
    if (!t->incident)
        return false;
    return incident_light_find(t->incident, vertex_map_point(t->s, v).position,
                               bsdf_is_below(b) ? vec3_negate(b->shading.z) : b->shading.z, out_guide);
}

uint32_t final_gather(const transport *t, eye_worker *worker, const gather_request *request)
{
    const vertex *v = request->from;
    uint32_t count = request->count;
    rgb one_ray = rgb_scale(request->throughput, 1.0f / (float)count);
    gathering g = {t, worker, request, rgb_max(one_ray), rgb_gray(0.0f), 0};
    gather_batch *batch = worker->batch;
    if (!gather_batch_has_room(batch, GATHER_ENDS_MAX * RAY_FAN_MAX))
        final_gather_resolve(t, worker);
    if (run_is_cancelled(t->run)) /* the batch stays full, and the sample is thrown away */
        return 0;
    gather_batch_begin(batch, request->sample, request->is_first, one_ray, request->share, count,
                       hash_combine(hash_combine(request->where->key, (uint64_t)request->path_vertex),
                                    (uint64_t)request->where->sample * count));
    sampler_sequence numbers = sampler_sequence_make(request->where, SAMPLE_GATHER, request->path_vertex, count);
    bool is_plain = bsdf_is_plain(&v->scattering);
    incident_guide guide;
    bool is_guided = is_plain && find_guide(t, v, &guide);
    gather_rays rays;
    rays.fan.common = transport_scattered_ray(t, v, vertex_facing_normal(v), false);
    rays.fan.common.skips_uv = true;
    rays.fan.common.cone = transport_gather_cone(v);
    for (uint32_t begin = 0; begin < count && !run_is_cancelled(t->run); begin += RAY_FAN_MAX) {
        uint32_t end = count - begin < RAY_FAN_MAX ? count : begin + RAY_FAN_MAX;
        if (!gather_batch_has_room(batch, GATHER_ENDS_MAX * (end - begin)))
            final_gather_resolve(t, worker);
        if (run_is_cancelled(t->run))
            break;
        rays.fan.count = 0;
        if (is_plain)
            sample_plain(&g, is_guided ? &guide : NULL, &numbers, begin, end, &rays);
        else
            sample_lobes(&g, &numbers, begin, end, &rays);
        if (transmittance_is_one(t->s, &rays.fan.common)) {
            follow_together(&g, &rays);
            continue;
        }
        for (uint32_t i = 0; i < rays.fan.count; i++)
            follow_alone(&g, rays.number[i], ray_fan_direction(&rays.fan, i), rays.weight[i]);
    }
    gather_batch_end(batch, g.known);
    return (uint32_t)g.cost;
}

/* Bounces the detours under way until each has been answered or ends. They ask for irradiance together, so that it is
 * looked up in the map's order. */
static void follow_detours(const transport *t, eye_worker *worker, uint32_t count)
{
    gather_batch *b = worker->batch;
    for (uint64_t bounce = 0; count > 0 && !run_is_cancelled(t->run); bounce++) {
        uint32_t asking = 0;
        for (uint32_t i = 0; i < count; i++) {
            gather_detour *d = &b->detours[i];
            if (!gather_path_bounce(t, worker, rng_make(d->key, bounce, d->number), d->share_seen, &d->end, &d->weight,
                                    &b->irradiance[d->query]))
                continue;
            b->detour_queries[asking] = (irradiance_query){d->end.point.position, d->end.point.normal};
            b->detours[asking++] = *d;
        }
        irradiance_cache_get_many(t->cache, t->run, b->detour_queries, asking, worker->index, b->detour_irradiance,
                                  b->detour_holds);
        if (run_is_cancelled(t->run))
            return;
        count = 0;
        for (uint32_t i = 0; i < asking; i++) {
            const gather_detour *d = &b->detours[i];
            rgb *sum = &b->irradiance[d->query];
            if (b->detour_holds[i])
                *sum = rgb_add(*sum, rgb_mul(d->weight, b->detour_irradiance[i]));
            else
                b->detours[count++] = *d;
        }
    }
}

void final_gather_resolve(const transport *t, eye_worker *worker)
{
    gather_batch *b = worker->batch;
    uint64_t cost_before = eye_worker_cost(worker);
    irradiance_cache_get_many(t->cache, t->run, b->queries, b->query_count, worker->index, b->irradiance, b->holds);
    if (run_is_cancelled(t->run))
        return;
    uint32_t query = 0, count;
    while ((count = gather_batch_make_detours(b, &query)) > 0)
        follow_detours(t, worker, count);
    worker->uncharged_cost += eye_worker_cost(worker) - cost_before;
    gather_batch_sum(b);
}
