/* final_gather.c: see final_gather.h. */
#include "final_gather.h"

#include "direct_lighting.h"

/* Roulette begins after this many scatterings along one gather ray; short rays bounce on at most so often; and so often
 * a gather looks whether to stop: its sample is thrown away then. */
enum { ROULETTE_AFTER = 4, SHORT_BOUNCES_MAX = 8, CANCEL_EVERY = 64 };

/* The ray ends at a diffuse place: irradiance on one side of it, picked by the lobes' shares. */
static void read_cache(const transport *t, eye_worker *worker, const vertex *v, rgb throughput, float u_side,
                       gather_ray *out)
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
    irradiance_cache_get(t->cache, at.position, at.facing_normal, worker->index, &out->request);
    out->weight = rgb_scale(rgb_mul(throughput, factor), AG_INV_PI);
}

/* What is behind one gather ray. Lamps and environments add nothing: light straight from them is direct light, light
 * from them by way of traced lobes is in the caustic map. */
static void follow_gather_ray(const transport *t, eye_worker *worker, scene_ray ray, int scatterings_left, rng *random,
                              gather_ray *out)
{
    rgb throughput = rgb_gray(1.0f);
    float travelled = 0.0f;
    int short_bounces = 0;
    for (int depth = 0; depth < scatterings_left; depth++) {
        vertex v;
        worker->rays_gather++;
        if (!transport_trace(t, worker, ray, &v))
            return;
        throughput = rgb_mul(throughput, v.transmittance);
        travelled += v.hit.distance;
        float u_lobe = rng_float(random), u_group = rng_float(random);
        vec2 u = rng_vec2(random);

        /* one group of lobes, picked by its share */
        float gathered_share = bsdf_probability(&v.scattering, BSDF_GATHERED);
        bsdf_lobes lobes = u_group < gathered_share ? BSDF_GATHERED : BSDF_TRACED;
        throughput = rgb_scale(throughput, 1.0f / (lobes == BSDF_GATHERED ? gathered_share : 1.0f - gathered_share));
        if (lobes == BSDF_GATHERED) {
            if (travelled >= t->gather_min_distance || short_bounces == SHORT_BOUNCES_MAX) {
                read_cache(t, worker, &v, throughput, u_lobe, out);
                return;
            }
            /* too near for an estimate that is blurred over about that distance: the light there is direct light,
             * caustics, and what one more bounce brings */
            float u_pick = rng_float(random);
            rgb local = direct_light_from_lamp(t, worker, &v, BSDF_GATHERED, u_pick, rng_vec2(random), 1, 0);
            local = rgb_add(local, transport_caustics(t, worker, &v));
            out->known = rgb_add(out->known, rgb_mul(throughput, local));
            travelled = 0.0f;
            short_bounces++;
        }
        bsdf_sample next;
        if (!bsdf_sample_direction(&v.scattering, lobes, BSDF_RADIANCE, u_lobe, u, &next))
            return;
        throughput = rgb_mul(throughput, next.weight);
        if (depth >= ROULETTE_AFTER || lobes == BSDF_GATHERED) {
            float survival = fminf(1.0f, rgb_max(throughput));
            if (rng_float(random) >= survival)
                return;
            throughput = rgb_scale(throughput, 1.0f / survival);
        }
        ray = surface_ray(&v.hit, v.arrived, next.direction);
    }
}

rgb final_gather(const transport *t, eye_worker *worker, const vertex *v, const sampler *where, int path_vertex,
                 int scatterings_left)
{
    uint32_t count = (uint32_t)t->settings->gather_samples;
    arena_mark mark = arena_save(worker->scratch);
    gather_ray *rays = arena_alloc(worker->scratch, count * sizeof *rays);
    uint32_t sent = 0;

    /* send all rays; those that meet a claim of another thread stay open */
    for (; sent < count; sent++) {
        if (sent % CANCEL_EVERY == 0 && run_is_cancelled(t->run))
            break;
        gather_ray *ray = &rays[sent];
        *ray = (gather_ray){.request = {.photon = PHOTON_NONE}};
        uint32_t index = where->sample * count + sent;
        bsdf_sample first;
        vec2 u = sampler_2d_of(where, SAMPLE_GATHER, path_vertex, count, sent);
        rng random = rng_make(where->key, (uint64_t)path_vertex, index);
        float u_lobe = rng_float(&random);
        if (!bsdf_sample_direction(&v->scattering, BSDF_GATHERED, BSDF_RADIANCE, u_lobe, u, &first))
            continue;
        follow_gather_ray(t, worker, surface_ray(&v->hit, v->arrived, first.direction), scatterings_left - 1, &random,
                          ray);
        ray->known = rgb_mul(ray->known, first.weight);
        ray->weight = rgb_mul(ray->weight, first.weight);
    }

    /* come back to the open ones, then sum in ray order */
    rgb sum = rgb_gray(0.0f);
    for (uint32_t i = 0; i < sent; i++)
        if (rays[i].request.photon != PHOTON_NONE)
            irradiance_cache_retry(t->cache, &rays[i].request, worker->index);
    for (uint32_t i = 0; i < sent; i++)
        sum = rgb_add(sum, rgb_add(rays[i].known, rgb_mul(rays[i].weight, rays[i].request.irradiance)));
    arena_restore(worker->scratch, mark);
    return rgb_scale(sum, 1.0f / (float)count);
}
