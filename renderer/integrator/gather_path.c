/* gather_path.c: see gather_path.h. */
#include "integrator/gather_path.h"

#include "integrator/direct_lighting.h"
#include "rays/transmittance.h"

/* Roulette begins after this many scatterings along one gather ray. Short rays bounce on at most so often before the
 * cache is asked: in a room smaller than an estimate's radius, the cache would return light from outside. */
enum { ROULETTE_AFTER = 4, SHORT_BOUNCES_MAX = 64 };

/* Returns direct light and caustics at a diffuse vertex, which an estimate there would contain: radiance towards v's
 * `out`. */
static rgb local_light(const transport *t, eye_worker *worker, const vertex *v, float share_seen, rng *random)
{
    float u_pick = rng_float(random), u_caustic = rng_float(random);
    rgb direct = direct_light_from_lamp(t, worker, v, BSDF_GATHERED, u_pick, rng_vec2(random), 1, 0.0f);
    return rgb_add(direct,
                   transport_some_caustics(t, worker, v, transport_caustic_probability(t, share_seen), u_caustic));
}

/* The last scattering of a gather ray by a medium, or by traced lobes behind that. From there on to the next diffuse
 * surface it is followed as a path tracer's: neither the direct light of the surface that gathers nor a caustic map has
 * the light that a medium has scattered. */
typedef struct traced_start {
    bool is_set;
    vec3 position, normal; /* normal: vertex_light_normal */
    float pdf;             /* of the ray that left it, 1/sr; 0: by a smooth lobe, for which no shadow ray can stand */
} traced_start;

/* Returns the radiance that the ray meets at a surface, weighted against shadow rays from where it was traced on. */
static rgb traced_emission(const transport *t, const traced_start *from, const vertex *v)
{
    rgb emitted = from->is_set ? vertex_emission(t->s, v) : rgb_gray(0.0f);
    if (rgb_is_black(emitted) || !(from->pdf > 0.0f))
        return emitted;
    return rgb_scale(emitted, direct_light_scatter_weight(t, from->position, from->normal, v, from->pdf, 1, 1.0f));
}

/* Ends the ray at a diffuse vertex with the irradiance on one side of it, which is picked by the lobes' shares. */
static void end_at(const transport *t, const vertex *v, int scatterings_left, rgb throughput, float u_side,
                   gather_end *out_end, rgb *out_weight)
{
    map_point at = vertex_map_point(t->s, v);
    rgb reflected = bsdf_gathered_reflection(&v->scattering), transmitted = bsdf_gathered_transmission(&v->scattering);
    rgb factor = reflected;
    if (!rgb_is_black(transmitted)) {
        float share = rgb_max(transmitted) / (rgb_max(reflected) + rgb_max(transmitted));
        bool is_through = u_side < share;
        factor = is_through ? rgb_scale(transmitted, 1.0f / share) : rgb_scale(reflected, 1.0f / (1.0f - share));
        if (is_through)
            at.facing_normal = vec3_negate(at.facing_normal);
    }
    *out_end = (gather_end){{at.position, at.facing_normal, v->hit.epsilon}, v->arrived.medium, scatterings_left};
    *out_weight = rgb_scale(rgb_mul(throughput, factor), AG_INV_PI);
}

bool gather_path_follow(const transport *t, eye_worker *worker, vertex *v, rng random, int scatterings_left, rgb first,
                        float share_seen, rgb *in_out_known, gather_end *out_end, rgb *out_weight)
{
    rgb throughput = rgb_gray(1.0f);
    float travelled = 0.0f;
    int short_bounces = 0, left = scatterings_left;
    traced_start start = {.is_set = false};
    int in_media = 0; /* how often media have scattered the ray */
    for (int depth = 0;;) {
        throughput = rgb_mul(throughput, v->transmittance);
        travelled += v->hit.distance;
        bool is_far = travelled >= t->gather_min_distance || short_bounces == SHORT_BOUNCES_MAX;
        transport_complete(t, v);
        if (start.is_set)
            *in_out_known = rgb_add(*in_out_known, rgb_mul(rgb_mul(first, throughput), traced_emission(t, &start, v)));
        float u_lobe = rng_float(&random), u_group = rng_float(&random);
        vec2 u = rng_vec2(&random);

        /* one group of lobes, picked by its share */
        float gathered_share = bsdf_probability(&v->scattering, BSDF_GATHERED);
        bsdf_lobes lobes = u_group < gathered_share ? BSDF_GATHERED : BSDF_TRACED;
        throughput = rgb_scale(throughput, 1.0f / (lobes == BSDF_GATHERED ? gathered_share : 1.0f - gathered_share));
        if (lobes == BSDF_GATHERED) {
            if (is_far) {
                end_at(t, v, left, rgb_mul(first, throughput), u_lobe, out_end, out_weight);
                return true;
            }
            /* an estimate is blurred over about that distance, which is too coarse so near */
            rgb weight = rgb_mul(first, throughput);
            rgb local = local_light(t, worker, v, share_seen * rgb_max(weight), &random);
            *in_out_known = rgb_add(*in_out_known, rgb_mul(weight, local));
            travelled = 0.0f;
            short_bounces++;
            start.is_set = false;
        }
        bool counts = !v->is_in_medium || t->media_are_bounded;
        in_media += v->is_in_medium;
        bool is_last = (counts && left == 1) || in_media == MEDIUM_SCATTERINGS_MAX;
        bool is_traced = lobes == BSDF_TRACED && (v->is_in_medium || start.is_set);
        if (is_traced && bsdf_is_sampled_from_light(&v->scattering, BSDF_TRACED)) {
            float u_pick = rng_float(&random);
            rgb direct =
                direct_light_from_lamp(t, worker, v, BSDF_TRACED, u_pick, rng_vec2(&random), 1, is_last ? 0.0f : 1.0f);
            *in_out_known = rgb_add(*in_out_known, rgb_mul(rgb_mul(first, throughput), direct));
        }
        bsdf_sample next;
        if (!bsdf_sample_direction(&v->scattering, lobes, BSDF_RADIANCE, u_lobe, u, &next))
            return false;
        throughput = rgb_mul(throughput, next.weight);
        if ((depth >= ROULETTE_AFTER || lobes == BSDF_GATHERED) &&
            !transport_survives(&throughput, in_media, rng_float(&random)))
            return false;
        bool goes_straight = transport_is_open_pane(t, v) && next.is_straight;
        depth += !goes_straight;
        left -= counts && !goes_straight;
        if (left == 0 || (v->is_in_medium && is_last))
            return false;
        scene_ray ray = goes_straight ? vertex_ray_straight(v) : transport_scattered_ray(t, v, next.direction, true);
        ray.skips_uv = true;
        worker->rays_gather++;
        if (is_traced && !goes_straight)
            start = (traced_start){true, vertex_position(v), vertex_light_normal(v, BSDF_TRACED),
                                   next.is_delta ? 0.0f : next.pdf_solid_angle};
        if (transport_travel_to(t, worker, ray, rgb_mul(first, throughput), &random, v))
            continue;
        if (start.is_set) {
            rgb weight = rgb_mul(rgb_mul(first, throughput), v->transmittance);
            *in_out_known =
                rgb_add(*in_out_known, rgb_mul(weight, direct_light_escaped(t, start.position, start.normal,
                                                                            ray.direction, start.pdf, 1, 1.0f, NULL)));
        }
        return false;
    }
}

void gather_end_make_white(const gather_end *end, vertex *v)
{
    static const material_point WHITE = {.kind = MATERIAL_DIFFUSE, .diffuse = {.reflectance = {1.0f, 1.0f, 1.0f}}};
    const surface_point *at = &end->point;
    v->hit = (surface_hit){.position = at->position,
                           .geometric_normal = at->normal,
                           .shading_normal = at->normal,
                           .epsilon = at->epsilon,
                           .instance_index = SCENE_NO_INSTANCE};
    v->arrived = scene_ray_make(at->position, vec3_negate(at->normal));
    v->arrived.medium = end->medium;
    v->arrived.skips_uv = true;
    bsdf_init_of(&WHITE, &v->hit, at->normal, &v->scattering);
    v->transmittance = rgb_gray(1.0f);
    v->lamp = NULL;
    v->is_in_medium = false;
}

bool gather_path_bounce(const transport *t, eye_worker *worker, rng random, float share_seen, gather_end *in_out_end,
                        rgb *in_out_weight, rgb *in_out_known)
{
    vertex v;
    bsdf_sample next;
    rgb throughput = rgb_scale(*in_out_weight, AG_PI);
    gather_end_make_white(in_out_end, &v);
    rgb local = local_light(t, worker, &v, share_seen * rgb_max(throughput), &random);
    *in_out_known = rgb_add(*in_out_known, rgb_mul(throughput, local));
    int left = in_out_end->scatterings_left - 1;
    vec2 u = rng_vec2(&random);
    if (left == 0 || !transport_survives(&throughput, 0, rng_float(&random)) ||
        !bsdf_sample_direction(&v.scattering, BSDF_GATHERED, BSDF_RADIANCE, 0.0f, u, &next))
        return false;
    scene_ray ray = transport_scattered_ray(t, &v, next.direction, false);
    worker->rays_gather++;
    throughput = rgb_mul(throughput, next.weight);
    return transport_travel_to(t, worker, ray, throughput, &random, &v) &&
           gather_path_follow(t, worker, &v, random, left, throughput, share_seen, in_out_known, in_out_end,
                              in_out_weight);
}
