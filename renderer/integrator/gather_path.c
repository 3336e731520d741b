/* gather_path.c: see gather_path.h. */
#include "integrator/gather_path.h"

#include "integrator/direct_lighting.h"
#include "rays/transmittance.h"

/* Roulette begins after this many scatterings along one gather ray. Short rays bounce on at most so often before the
 * cache is asked: in a room smaller than an estimate's radius, the cache would return light from outside. */
enum { ROULETTE_AFTER = 4, SHORT_BOUNCES_MAX = 64 };

/* Returns direct light and caustics at a diffuse vertex, which an estimate there would contain: radiance towards v's
 * `out`. goes_on: the path will bounce there, and lamps that it meets straight count. */
static rgb local_light(const transport *t, eye_worker *worker, const vertex *v, float share_seen, bool goes_on,
                       rng *random)
{
    float u_caustic = rng_float(random);
    rgb direct = direct_light_sample_each(t, worker, v, BSDF_GATHERED, random, goes_on ? 1.0f : 0.0f);
    return rgb_add(direct,
                   transport_some_caustics(t, worker, v, transport_caustic_probability(t, share_seen), u_caustic));
}

/* The last scattering of a gather ray from which lamps that it meets count, weighted against shadow rays from there. */
typedef enum lit_from {
    LIT_FROM_NOWHERE, /* lamps do not count: they are direct light where the gather began, or in the caustic map */
    /* a diffuse surface that the ray has bounced on, from which lamps count that it meets straight: its local light has
     * the others' */
    LIT_FROM_BOUNCE,
    /* a medium, or traced lobes behind that. From there on to the next diffuse surface it is followed as a path
     * tracer's: neither the direct light of the surface that gathers nor a caustic map has the light that a medium has
     * scattered */
    LIT_FROM_MEDIUM
} lit_from;

typedef struct lit_start {
    lit_from from;
    vec3 position, normal; /* normal: vertex_light_normal */
    float pdf;             /* of the ray that left it, 1/sr; 0: by a smooth lobe, for which no shadow ray can stand */
} lit_start;

/* Returns the samples that light from such a start is weighted against. */
static light_counts weighted_against(const lit_start *start)
{
    return (light_counts){start->from == LIT_FROM_BOUNCE ? LIGHT_COUNT_EACH : 1, 1.0f};
}

/* A gather ray on its way. */
typedef struct gather_ray {
    rng random;
    rgb start_throughput; /* from the ray's start to where its light is wanted */
    rgb throughput;       /* from the ray's end to its start; roulette goes by this alone */
    float travelled;      /* since its start or its last short bounce, scene units */
    int short_bounces;    /* by diffuse surfaces too near for the cache */
    int scatterings;      /* passing a pane straight is none */
    int scatterings_left; /* between the lamp and the ray's last start */
    int in_media;         /* scatterings by media */
    lit_start lit;
} gather_ray;

/* Returns what the light at the ray's end is multiplied by. */
static rgb whole_throughput(const gather_ray *g) { return rgb_mul(g->start_throughput, g->throughput); }

/* Ends the ray at a diffuse vertex, with the irradiance on its side, and on the far side where light comes through. A
 * curtain's may differ by a hundred times, so that picking one side would be noise. */
static void end_at(const transport *t, const vertex *v, int scatterings_left, rgb throughput, gather_ends *out)
{
    map_point at = vertex_map_point(t->s, v);
    const rgb factors[GATHER_ENDS_MAX] = {bsdf_gathered_reflection(&v->scattering),
                                          bsdf_gathered_transmission(&v->scattering)};
    const vec3 normals[GATHER_ENDS_MAX] = {at.facing_normal, vec3_negate(at.facing_normal)};
    out->count = 0;
    for (int side = 0; side < GATHER_ENDS_MAX; side++) {
        if (rgb_is_black(factors[side]))
            continue;
        out->end[out->count] =
            (gather_end){{at.position, normals[side], v->hit.epsilon}, v->arrived.medium, scatterings_left};
        out->weight[out->count++] = rgb_scale(rgb_mul(throughput, factors[side]), AG_INV_PI);
    }
}

/* Takes the ray to the vertex that it has met, and adds what shines there to *in_out_known where lamps count. */
static void arrive(const transport *t, gather_ray *g, vertex *v, rgb *in_out_known)
{
    const lit_start *start = &g->lit;
    g->throughput = rgb_mul(g->throughput, v->transmittance);
    g->travelled += v->hit.distance;
    transport_complete(t, v);
    if (start->from == LIT_FROM_NOWHERE)
        return;
    rgb emitted = vertex_emission(t->s, v);
    if (!rgb_is_black(emitted) && start->pdf > 0.0f)
        emitted = rgb_scale(emitted, direct_light_scatter_weight(t, start->position, start->normal, v, start->pdf,
                                                                 weighted_against(start)));
    *in_out_known = rgb_add(*in_out_known, rgb_mul(whole_throughput(g), emitted));
}

/* Picks one group of lobes by its share. */
static bsdf_lobes pick_group(gather_ray *g, const vertex *v, float u)
{
    float gathered_share = bsdf_probability(&v->scattering, BSDF_GATHERED);
    bool is_gathered = u < gathered_share;
    g->throughput = rgb_scale(g->throughput, 1.0f / (is_gathered ? gathered_share : 1.0f - gathered_share));
    return is_gathered ? BSDF_GATHERED : BSDF_TRACED;
}

/* Adds direct light and caustics at a diffuse vertex too near for the cache, by which the ray bounces on. */
static void begin_short_bounce(const transport *t, eye_worker *worker, gather_ray *g, const vertex *v, float share_seen,
                               rgb *in_out_known)
{
    rgb weight = whole_throughput(g);
    rgb local = local_light(t, worker, v, share_seen * rgb_max(weight), g->scatterings_left > 1, &g->random);
    *in_out_known = rgb_add(*in_out_known, rgb_mul(weight, local));
    g->travelled = 0.0f;
    g->short_bounces++;
}

/* Sends the ray on from the vertex by these lobes, and adds the direct light that they scatter where the ray is traced
 * as a path tracer's. Returns false where it ends: by the lobes, by roulette, or by the limit of scatterings. */
static bool scatter(const transport *t, eye_worker *worker, gather_ray *g, const vertex *v, bsdf_lobes lobes,
                    float u_lobe, vec2 u, rgb *in_out_known, scene_ray *out_ray)
{
    bool is_counted = !v->is_in_medium || t->media_are_bounded;
    g->in_media += v->is_in_medium;
    bool is_last = (is_counted && g->scatterings_left == 1) || g->in_media == MEDIUM_SCATTERINGS_MAX;
    bool is_traced = lobes == BSDF_TRACED && (v->is_in_medium || g->lit.from == LIT_FROM_MEDIUM);
    if (is_traced && bsdf_is_sampled_from_light(&v->scattering, BSDF_TRACED)) {
        float u_pick = rng_float(&g->random);
        lamp_light direct =
            direct_light_sample_lamp(t, worker, v, BSDF_TRACED, u_pick, rng_vec2(&g->random), 1, is_last ? 0.0f : 1.0f);
        *in_out_known = rgb_add(*in_out_known, rgb_mul(whole_throughput(g), direct.radiance));
    }
    bsdf_sample next;
    if (!bsdf_sample_direction(&v->scattering, lobes, BSDF_RADIANCE, u_lobe, u, &next))
        return false;
    g->throughput = rgb_mul(g->throughput, next.weight);
    if ((g->scatterings >= ROULETTE_AFTER || lobes == BSDF_GATHERED) &&
        !transport_survives(&g->throughput, medium_roulette_level(g->in_media), rng_float(&g->random)))
        return false;
    bool goes_straight = transport_is_open_pane(t, v) && next.is_straight;
    g->scatterings += !goes_straight;
    g->scatterings_left -= is_counted && !goes_straight;
    if (g->scatterings_left == 0 || (v->is_in_medium && is_last))
        return false;
    if (!goes_straight)
        g->lit =
            (lit_start){is_traced                ? LIT_FROM_MEDIUM
                        : lobes == BSDF_GATHERED ? LIT_FROM_BOUNCE
                                                 : LIT_FROM_NOWHERE,
                        vertex_position(v), vertex_light_normal(v, lobes), next.is_delta ? 0.0f : next.pdf_solid_angle};
    *out_ray = goes_straight ? vertex_ray_straight(v) : transport_scattered_ray(t, v, next.direction, true);
    out_ray->skips_uv = true;
    return true;
}

/* Adds the light of infinite lights along a ray that has escaped, where lamps count. */
static void add_escaped(const transport *t, const gather_ray *g, vec3 direction, rgb transmittance, rgb *in_out_known)
{
    const lit_start *start = &g->lit;
    if (start->from == LIT_FROM_NOWHERE)
        return;
    rgb escaped =
        direct_light_escaped(t, start->position, start->normal, direction, start->pdf, weighted_against(start), NULL);
    *in_out_known = rgb_add(*in_out_known, rgb_mul(rgb_mul(whole_throughput(g), transmittance), escaped));
}

/* Follows a ray that has met *v. */
static bool follow(const transport *t, eye_worker *worker, gather_ray *g, vertex *v, float share_seen,
                   rgb *in_out_known, gather_ends *out_ends)
{
    for (;;) {
        arrive(t, g, v, in_out_known);
        bool is_near = g->travelled < t->gather_min_distance && g->short_bounces < SHORT_BOUNCES_MAX;
        float u_lobe = rng_float(&g->random), u_group = rng_float(&g->random);
        vec2 u = rng_vec2(&g->random);
        bsdf_lobes lobes = pick_group(g, v, u_group);
        if (lobes == BSDF_GATHERED && !is_near) {
            end_at(t, v, g->scatterings_left, whole_throughput(g), out_ends);
            return out_ends->count > 0;
        }
        if (lobes == BSDF_GATHERED) /* an estimate is blurred over about that distance, which is too coarse so near */
            begin_short_bounce(t, worker, g, v, share_seen, in_out_known);
        scene_ray ray;
        if (!scatter(t, worker, g, v, lobes, u_lobe, u, in_out_known, &ray))
            return false;
        worker->rays_gather++;
        if (!transport_travel_to(t, worker, ray, whole_throughput(g), &g->random, v)) {
            add_escaped(t, g, ray.direction, v->transmittance, in_out_known);
            return false;
        }
    }
}

bool gather_path_follow(const transport *t, eye_worker *worker, vertex *v, rng random, int scatterings_left,
                        rgb throughput, float share_seen, rgb *in_out_known, gather_ends *out_ends)
{
    gather_ray g = {.random = random,
                    .start_throughput = throughput,
                    .throughput = rgb_gray(1.0f),
                    .scatterings_left = scatterings_left};
    return follow(t, worker, &g, v, share_seen, in_out_known, out_ends);
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
    int left = in_out_end->scatterings_left - 1;
    rgb local = local_light(t, worker, &v, share_seen * rgb_max(throughput), left > 0, &random);
    *in_out_known = rgb_add(*in_out_known, rgb_mul(throughput, local));
    vec2 u = rng_vec2(&random);
    float u_end = rng_float(&random);
    if (left == 0 || !transport_survives(&throughput, 1.0f, rng_float(&random)) ||
        !bsdf_sample_direction(&v.scattering, BSDF_GATHERED, BSDF_RADIANCE, 0.0f, u, &next))
        return false;
    scene_ray ray = transport_scattered_ray(t, &v, next.direction, false);
    worker->rays_gather++;
    gather_ray g = {
        .start_throughput = rgb_mul(throughput, next.weight),
        .throughput = rgb_gray(1.0f),
        .scatterings_left = left,
        .lit = {LIT_FROM_BOUNCE, vertex_position(&v), vertex_light_normal(&v, BSDF_GATHERED), next.pdf_solid_angle}};
    gather_ends ends;
    bool is_met = transport_travel_to(t, worker, ray, g.start_throughput, &random, &v);
    g.random = random;
    if (!is_met)
        add_escaped(t, &g, ray.direction, v.transmittance, in_out_known);
    if (!is_met || !follow(t, worker, &g, &v, share_seen, in_out_known, &ends))
        return false;
    gather_ends_pick(&ends, u_end);
    *in_out_end = ends.end[0];
    *in_out_weight = ends.weight[0];
    return true;
}
