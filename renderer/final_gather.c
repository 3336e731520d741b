/* final_gather.c: see final_gather.h. */
#include "final_gather.h"

#include "direct_lighting.h"

/* Roulette begins after this many traced lobes along one gather ray; short rays bounce on at most so often. */
enum { ROULETTE_AFTER = 4, TRACED_MAX = 100, SHORT_BOUNCES_MAX = 8 };

/* What is behind one gather ray. Lamps add nothing: light straight from them is direct light, light from them by way of
 * traced lobes is in the caustic map. */
static void follow_gather_ray(const transport *t, eye_worker *worker, vec3 origin, vec3 direction, rng *random,
                              gather_ray *out)
{
    rgb throughput = rgb_gray(1.0f);
    float travelled = 0.0f;
    int short_bounces = 0;
    for (int depth = 0; depth < TRACED_MAX; depth++) {
        vertex v;
        worker->rays_gather++;
        if (!transport_trace(t, origin, direction, &v))
            return;
        travelled += v.hit.distance;
        float u_lobe = rng_float(random);
        vec2 u = rng_vec2(random);
        vec3 back = vec3_negate(direction);
        bsdf_lobes lobes = BSDF_TRACED;
        if (bsdf_has(&v.scattering, BSDF_GATHERED)) {
            if (travelled >= t->gather_min_distance || short_bounces == SHORT_BOUNCES_MAX) {
                vec3 normal = vec3_face_forward(v.hit.geometric_normal, back);
                irradiance_cache_get(t->cache, v.hit.position, normal, worker->index, &out->request);
                out->weight = rgb_scale(rgb_mul(throughput, bsdf_gathered_albedo(&v.scattering)), AG_INV_PI);
                return;
            }
            /* too near for an estimate that is blurred over about that distance: the light there is direct light,
             * caustics, and what one more bounce brings */
            float u_pick = rng_float(random);
            rgb local = direct_light_from_lamp(t, worker, &v, BSDF_GATHERED, u_pick, rng_vec2(random), 1, 0);
            local = rgb_add(local, transport_caustics(t, worker, &v));
            out->known = rgb_add(out->known, rgb_mul(throughput, local));
            lobes = BSDF_GATHERED;
            travelled = 0.0f;
            short_bounces++;
        }
        bsdf_sample next;
        if (!bsdf_sample_direction(&v.scattering, lobes, BSDF_RADIANCE, back, u_lobe, u, &next))
            return;
        throughput = rgb_mul(throughput, next.weight);
        if (depth >= ROULETTE_AFTER || lobes == BSDF_GATHERED) {
            float survival = fminf(1.0f, rgb_max(throughput));
            if (rng_float(random) >= survival)
                return;
            throughput = rgb_scale(throughput, 1.0f / survival);
        }
        origin = surface_ray_origin(&v.hit, direction, next.direction);
        direction = next.direction;
    }
}

rgb final_gather(const transport *t, eye_worker *worker, const vertex *v, const sampler *where, int path_vertex)
{
    uint32_t count = (uint32_t)t->settings->gather_samples;
    arena_mark mark = arena_save(worker->scratch);
    gather_ray *rays = arena_alloc(worker->scratch, count * sizeof *rays);
    vec3 back = vec3_negate(v->arrival);

    /* send all rays; those that meet a claim of another thread stay open */
    for (uint32_t i = 0; i < count; i++) {
        gather_ray *ray = &rays[i];
        *ray = (gather_ray){.request = {.photon = PHOTON_NONE}};
        uint32_t index = where->sample * count + i;
        bsdf_sample first;
        vec2 u = sampler_2d_at(where, SAMPLE_GATHER, path_vertex, index);
        if (!bsdf_sample_direction(&v->scattering, BSDF_GATHERED, BSDF_RADIANCE, back, 0.0f, u, &first))
            continue;
        rng random = rng_make(where->key, (uint64_t)path_vertex, index);
        follow_gather_ray(t, worker, surface_ray_origin(&v->hit, v->arrival, first.direction), first.direction, &random,
                          ray);
        ray->known = rgb_mul(ray->known, first.weight);
        ray->weight = rgb_mul(ray->weight, first.weight);
    }

    /* come back to the open ones, then sum in ray order */
    rgb sum = rgb_gray(0.0f);
    for (uint32_t i = 0; i < count; i++)
        if (rays[i].request.photon != PHOTON_NONE)
            irradiance_cache_retry(t->cache, &rays[i].request, worker->index);
    for (uint32_t i = 0; i < count; i++)
        sum = rgb_add(sum, rgb_add(rays[i].known, rgb_mul(rays[i].weight, rays[i].request.irradiance)));
    arena_restore(worker->scratch, mark);
    return rgb_scale(sum, 1.0f / (float)count);
}
