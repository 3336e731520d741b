/* final_gather.c: see final_gather.h. */
#include "final_gather.h"

#include "direct_lighting.h"

/* Roulette begins after this many scatterings along one gather ray; short rays bounce on at most so often (asked
 * sooner, the cache tells of the light outside of a small room); and after so many rays a gather looks whether to stop:
 * its sample is thrown away then. */
enum { ROULETTE_AFTER = 4, SHORT_BOUNCES_MAX = 64, CANCEL_EVERY = 64 };

/* The ray ends at a diffuse place: irradiance on one side of it, picked by the lobes' shares. */
static void read_cache(const transport *t, eye_worker *worker, const vertex *v, rgb throughput, float u_side)
{
    map_place at = transport_map_place(t, v);
    rgb reflected = bsdf_gathered_reflection(&v->scattering), transmitted = bsdf_gathered_transmission(&v->scattering);
    rgb factor = reflected;
    if (!rgb_is_black(transmitted)) {
        float share = rgb_max(transmitted) / (rgb_max(reflected) + rgb_max(transmitted));
        bool is_through = u_side < share;
        factor = is_through ? rgb_scale(transmitted, 1.0f / share) : rgb_scale(reflected, 1.0f / (1.0f - share));
        if (is_through)
            at.facing_normal = vec3_negate(at.facing_normal);
    }
    gather_batch_ask(worker->batch, (irradiance_query){at.position, at.facing_normal},
                     rgb_scale(rgb_mul(throughput, factor), AG_INV_PI));
}

/* One ray of a gather: what its random numbers are keyed by. */
typedef struct ray_key {
    const sampler *where;
    int path_vertex;
    uint32_t index;
} ray_key;

static rng ray_random(const ray_key *key) { return rng_make(key->where->key, (uint64_t)key->path_vertex, key->index); }

/* Most rays end at once at a Lambertian surface far enough away: without any of what makes up a bsdf. */
static bool ends_plainly(const transport *t, eye_worker *worker, const vertex *v, rgb throughput)
{
    const rgb *albedo = material_plain_albedo(t->s, &v->hit);
    if (!albedo)
        return false;
    map_place at = transport_map_place(t, v);
    gather_batch_ask(worker->batch, (irradiance_query){at.position, at.facing_normal},
                     rgb_scale(rgb_mul(throughput, *albedo), AG_INV_PI));
    return true;
}

/* What is behind one gather ray, and weighs `first` at its start: asks for irradiance, and adds to *known. Lamps and
 * environments add nothing: light straight from them is direct light, light from them by way of traced lobes is in the
 * caustic map. */
static void follow_gather_ray(const transport *t, eye_worker *worker, scene_ray ray, rgb first, int scatterings_left,
                              const ray_key *key, rgb *known)
{
    rgb throughput = rgb_gray(1.0f);
    float travelled = 0.0f;
    int short_bounces = 0;
    rng random;
    ray.skips_uv = true;
    for (int depth = 0; depth < scatterings_left; depth++) {
        vertex v;
        worker->rays_gather++;
        if (!transport_meet(t, worker, ray, &v))
            return;
        throughput = rgb_mul(throughput, v.transmittance);
        travelled += v.hit.distance;
        bool is_far = travelled >= t->gather_min_distance || short_bounces == SHORT_BOUNCES_MAX;
        if (is_far && ends_plainly(t, worker, &v, rgb_mul(first, throughput)))
            return;
        transport_complete(t, &v);
        if (depth == 0) {
            random = ray_random(key);
            rng_next(&random); /* of the lobe that the ray left by */
        }
        float u_lobe = rng_float(&random), u_group = rng_float(&random);
        vec2 u = rng_vec2(&random);

        /* one group of lobes, picked by its share */
        float gathered_share = bsdf_probability(&v.scattering, BSDF_GATHERED);
        bsdf_lobes lobes = u_group < gathered_share ? BSDF_GATHERED : BSDF_TRACED;
        throughput = rgb_scale(throughput, 1.0f / (lobes == BSDF_GATHERED ? gathered_share : 1.0f - gathered_share));
        if (lobes == BSDF_GATHERED) {
            if (is_far) {
                read_cache(t, worker, &v, rgb_mul(first, throughput), u_lobe);
                return;
            }
            /* too near for an estimate that is blurred over about that distance: the light there is direct light,
             * caustics, and what one more bounce brings */
            float u_pick = rng_float(&random);
            rgb local = direct_light_from_lamp(t, worker, &v, BSDF_GATHERED, u_pick, rng_vec2(&random), 1, 0);
            local = rgb_add(local, transport_caustics(t, worker, &v));
            *known = rgb_add(*known, rgb_mul(rgb_mul(first, throughput), local));
            travelled = 0.0f;
            short_bounces++;
        }
        bsdf_sample next;
        if (!bsdf_sample_direction(&v.scattering, lobes, BSDF_RADIANCE, u_lobe, u, &next))
            return;
        throughput = rgb_mul(throughput, next.weight);
        if ((depth >= ROULETTE_AFTER || lobes == BSDF_GATHERED) && !transport_survives(&throughput, rng_float(&random)))
            return;
        ray = surface_ray(&v.hit, v.arrived, next.direction);
    }
}

void final_gather(const transport *t, eye_worker *worker, const vertex *v, const sampler *where, int path_vertex,
                  int scatterings_left, rgb throughput)
{
    uint32_t count = (uint32_t)t->settings->gather_samples;
    gather_batch *batch = worker->batch;
    if (gather_batch_is_full(batch))
        gather_batch_resolve(batch, t->cache, t->run, worker->index);
    gather_batch_begin(batch, worker->sample, path_vertex == 0, rgb_scale(throughput, 1.0f / (float)count));
    rgb known = rgb_gray(0.0f);
    sampler_sequence directions = sampler_sequence_make(where, SAMPLE_GATHER, path_vertex, count);
    bool is_plain = bsdf_is_plain(&v->scattering);
    for (uint32_t sent = 0; sent < count; sent++) {
        if (sent % CANCEL_EVERY == 0 && run_is_cancelled(t->run))
            break;
        if (batch->query_count == IRRADIANCE_BATCH_MAX)
            gather_batch_resolve(batch, t->cache, t->run, worker->index);
        ray_key key = {where, path_vertex, where->sample * count + sent};
        bsdf_sample first;
        vec2 u = sampler_sequence_at(&directions, sent);
        float u_lobe = 0.0f;
        if (!is_plain) {
            rng random = ray_random(&key);
            u_lobe = rng_float(&random);
        }
        if (bsdf_sample_direction(&v->scattering, BSDF_GATHERED, BSDF_RADIANCE, u_lobe, u, &first))
            follow_gather_ray(t, worker, surface_ray(&v->hit, v->arrived, first.direction), first.weight,
                              scatterings_left - 1, &key, &known);
    }
    gather_batch_end(batch, known);
}
