/* shading.c: see shading.h. */
#include "integrator/shading.h"

#include "integrator/direct_lighting.h"
#include "integrator/final_gather.h"
#include "integrator/first_hit.h"
#include "rays/passage.h"

enum { ROULETTE_AFTER = 4 };

/* A path is split at the first glossy place: the diffuse places behind it share the gather rays, and many directions
 * say more of the light than many rays behind one; so there may be more branches than gather rays. Smooth glass has two
 * ways at each of its faces. */
enum { BRANCHES_MAX = 8, SMOOTH_BRANCHES_MAX = 4 };

static const float SQRT_2 = 1.41421356f;

/* Added to the vertex where random numbers are drawn: those of paths with other numbers of branches or of gather rays
 * are of other sequences, and so are those that decide whether there is a gather ray. */
enum { KEY_OF_BRANCHES = 1 << 16, KEY_OF_RAYS = 1 << 24, KEY_OF_CHANCE = 1 << 30 };

/* What a diffuse place sends on: its parts, but for what is gathered, which comes to the sample later. */
typedef struct diffuse_light {
    rgb direct, caustic, indirect;
    rgb sky; /* of the direct light, from infinite lights */
} diffuse_light;

/* A way of light back from the eye, up to the ray that is to be followed next. */
typedef struct eye_path {
    sampler where; /* of the branch: each takes numbers of its own of the same sequences */
    scene_ray ray;
    rgb throughput;
    float share;     /* 1 over the number of branches */
    int vertex;      /* which of its path's the ray will meet, from 0 on */
    int vertex_key;  /* added to it where random numbers are drawn */
    int scatterings; /* so far; going straight through a pane may be none, and changes none of what follows */
    vec3 scattered_from, scattered_normal;
    float scattered_pdf; /* of a rough traced lobe; 0: the eye or a smooth one, which no shadow ray can serve */
    int scatter_count;   /* how many branches left that place */
} eye_path;

static int random_vertex(const eye_path *path) { return path->vertex + path->vertex_key; }

/* The power of two nearest by ratio, at least 1, as bits. */
static uint32_t nearest_bits(float wanted)
{
    uint32_t bits = 0;
    while ((float)(1u << bits) * SQRT_2 < wanted)
        bits++;
    return bits;
}

/* The share of the eye's gather rays that a place on the path has: as many of them as of the light that the eye sees.
 * Where that is less than one, there is one with this probability. */
typedef struct gather_share {
    uint32_t count;
    float probability; /* 1 where count > 1 */
} gather_share;

static gather_share share_of_gather(const transport *t, const eye_worker *worker, const eye_path *path)
{
    uint32_t most = worker->split.rays;
    if (path->scatterings == 0)
        return (gather_share){most, 1.0f};
    float wanted = (float)most * fminf(path->share * rgb_max(path->throughput), 1.0f);
    if (wanted < 1.0f) /* a bound would cut what chance has made brighter */
        return (gather_share){1, t->settings->clamp_indirect > 0.0f ? 1.0f : fminf((float)most * path->share, 1.0f)};
    uint32_t bits = nearest_bits(wanted);
    return (gather_share){1u << bits < most ? 1u << bits : most, 1.0f};
}

/* The light from other surfaces by way of those. */
static void gather_light(const transport *t, eye_worker *worker, const vertex *v, const eye_path *path,
                         int scatterings_left)
{
    gather_share rays = share_of_gather(t, worker, path);
    int key = random_vertex(path) + KEY_OF_RAYS * (int)sampler_bits(rays.count);
    float chance = rays.probability < 1.0f
                       ? sampler_2d(&path->where, SAMPLE_ROULETTE, random_vertex(path) + KEY_OF_CHANCE).x
                       : 0.0f;
    sampler where = path->where;
    if (path->scatterings == 0) { /* all of a pixel's rays are one sequence, however many a sample has */
        where = sampler_shifted(&where, worker->split.ray_shift, where.sample_bits + t->ray_bits, rays.count);
        key = random_vertex(path);
    }
    if (chance < rays.probability)
        final_gather(t, worker, v, &where, key, path->scatterings == 0, scatterings_left, rays.count,
                     rgb_scale(path->throughput, path->share / rays.probability), path->share);
}

/* Light samples are shared like gather rays, but each place has one. */
static rgb direct_radiance(const transport *t, eye_worker *worker, const vertex *v, const eye_path *path, rgb *by_group)
{
    uint32_t lights = worker->split.lights;
    if (path->scatterings > 0) {
        uint32_t bits = nearest_bits((float)lights * fminf(path->share * rgb_max(path->throughput), 1.0f));
        lights = 1u << bits < lights ? 1u << bits : lights;
    }
    uint64_t before = eye_worker_cost(worker);
    rgb direct =
        direct_light_gathered(t, worker, v, &path->where, random_vertex(path) + KEY_OF_RAYS * (int)sampler_bits(lights),
                              transport_sample_counts(t, lights), by_group);
    if (path->scatterings == 0) {
        float weight = rgb_mean(path->throughput);
        worker->light_cost += eye_worker_cost(worker) - before;
        worker->light_variance += weight * weight * worker->direct_variance;
    }
    return direct;
}

static diffuse_light diffuse_radiance(const transport *t, eye_worker *worker, const vertex *v, const eye_path *path,
                                      rgb *by_group)
{
    const ag_render_settings *settings = t->settings;
    int scatterings_left = settings->max_depth - path->scatterings, key = random_vertex(path);
    bool is_whole = settings->only == AG_ONLY_ALL;
    rgb throughput = path->throughput;
    diffuse_light sum = {rgb_gray(0.0f), rgb_gray(0.0f), rgb_gray(0.0f), rgb_gray(0.0f)};
    if (scatterings_left < 1)
        return sum;
    if (is_whole && path->scatterings > 0 && rgb_max(throughput) < SHADING_LOW_CONTRIBUTION) {
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
        sum.direct = direct_radiance(t, worker, v, path, by_group);
        sum.sky = worker->direct_from_sky;
    }
    if (path->scatterings == 0)
        sum.caustic = transport_caustics(t, worker, v);
    else
        sum.caustic = transport_some_caustics(t, worker, v, path->share * rgb_max(throughput),
                                              sampler_2d(&path->where, SAMPLE_ROULETTE, key).y);
    if (scatterings_left >= 2)
        gather_light(t, worker, v, path, scatterings_left);
    return sum;
}

/* by_group: the direct light's; the rest came through the photon map. */
static void add_diffuse(const transport *t, eye_sample *sample, const diffuse_light *diffuse, const eye_path *path,
                        const rgb *by_group)
{
    int scatterings = path->scatterings;
    bool is_first = scatterings == 0;
    float share = path->share;
    rgb throughput = rgb_scale(path->throughput, share);
    rgb direct = rgb_mul(throughput, diffuse->direct), caustic = rgb_mul(throughput, diffuse->caustic),
        indirect = rgb_mul(throughput, diffuse->indirect);
    float kept_direct = eye_sample_bound(sample, share, scatterings + 1, direct),
          kept_caustic = eye_sample_bound(sample, share, scatterings + 2, caustic),
          kept_indirect = eye_sample_bound(sample, share, scatterings + 2, indirect);
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

bool shading_go_on(const transport *t, const vertex *v, const sampler *where, int random_vertex, int path_vertex,
                   bool is_last, rgb *in_out_throughput, bsdf_sample *out_next, bool *out_goes_straight)
{
    bool may_go_straight = transport_is_open_pane(t, v);
    if ((is_last && !may_go_straight) || !bsdf_has(&v->scattering, BSDF_TRACED) ||
        !bsdf_sample_direction(&v->scattering, BSDF_TRACED, BSDF_RADIANCE,
                               sampler_2d(where, SAMPLE_LOBE, random_vertex).x,
                               sampler_2d(where, SAMPLE_SCATTER, random_vertex), out_next))
        return false;
    *out_goes_straight = may_go_straight && out_next->is_straight;
    if (is_last && !*out_goes_straight)
        return false;
    *in_out_throughput = rgb_mul(*in_out_throughput, out_next->weight);
    return path_vertex < ROULETTE_AFTER ||
           transport_survives(in_out_throughput, sampler_2d(where, SAMPLE_ROULETTE, random_vertex).x);
}

static void add_escaped(const transport *t, const eye_path *path, eye_sample *sample)
{
    light_group_sums groups;
    rgb *by_group = light_group_sums_begin(&groups, t->wants_groups);
    rgb weight = rgb_scale(path->throughput, path->share);
    rgb escaped = direct_light_escaped(t, path->scattered_from, path->scattered_normal, path->ray.direction,
                                       path->scattered_pdf, 1, path->scatter_count, by_group);
    float kept = eye_sample_add(sample, path->scatterings == 0 ? PART_EMISSION : PART_SPECULAR, path->share,
                                path->scatterings, rgb_mul(weight, escaped));
    eye_sample_add_groups(sample, by_group, rgb_scale(weight, kept));
}

/* Emitted light, shared with the shadow rays of the place before where that had any. */
static void add_emitted(const transport *t, const eye_path *path, const vertex *v, eye_sample *sample)
{
    rgb emitted = transport_emission(t, v);
    if (rgb_is_black(emitted))
        return;
    float weight = path->share;
    if (path->scattered_pdf > 0.0f)
        weight *= direct_light_scatter_weight(t, path->scattered_from, path->scattered_normal, v, path->scattered_pdf,
                                              1, path->scatter_count);
    rgb seen = rgb_scale(rgb_mul(path->throughput, emitted), weight);
    float kept = eye_sample_add(sample, path->scatterings == 0 ? PART_EMISSION : PART_SPECULAR, path->share,
                                path->scatterings, seen);
    if (t->wants_groups)
        eye_sample_add_group(sample, v->lamp->group, rgb_scale(seen, kept));
}

/* Direct light by the traced lobes, of which scatter_count samples will be taken. */
static void add_direct_traced(const transport *t, eye_worker *worker, const eye_path *path, const vertex *v,
                              int scatter_count, eye_sample *sample)
{
    int key = random_vertex(path);
    float u_pick = sampler_2d(&path->where, SAMPLE_LIGHT_PICK, key).x;
    lamp_light direct = direct_light_sample_lamp(t, worker, v, BSDF_TRACED, u_pick,
                                                 sampler_2d(&path->where, SAMPLE_LIGHT, key), 1, scatter_count);
    rgb brought = rgb_mul(rgb_scale(path->throughput, path->share), direct.radiance);
    float kept = eye_sample_add(sample, PART_SPECULAR, path->share, path->scatterings + 1, brought);
    if (t->wants_groups && !rgb_is_black(brought))
        eye_sample_add_group(sample, t->s->lights[direct.lamp].group, rgb_scale(brought, kept));
}

/* Into how many branches, a power of two as bits, the path is split at the first place that it is traced on from. */
static uint32_t branch_bits(const transport *t, const eye_path *path, const vertex *v)
{
    if (path->scatterings > 0 || transport_is_open_pane(t, v) || !bsdf_has_many_ways(&v->scattering, BSDF_TRACED))
        return 0;
    int most = bsdf_is_sampled_from_light(&v->scattering, BSDF_TRACED) ? BRANCHES_MAX : SMOOTH_BRANCHES_MAX;
    return nearest_bits((float)most * bsdf_probability(&v->scattering, BSDF_TRACED));
}

/* One step of the path: *in_out is on its way to the next place, as one of so many branches from here; false: it has
 * ended. */
static bool go_on(const transport *t, const vertex *v, bool is_last, int branch_count, eye_path *in_out)
{
    bsdf_sample next;
    bool goes_straight;
    if (!shading_go_on(t, v, &in_out->where, random_vertex(in_out), in_out->vertex, is_last, &in_out->throughput, &next,
                       &goes_straight))
        return false;
    in_out->vertex++;
    if (goes_straight) {
        in_out->ray = passage_continue(&v->hit, &v->arrived);
        return true;
    }
    in_out->scatterings++;
    in_out->scattered_from = v->hit.position;
    in_out->scattered_normal = direct_light_normal(v, BSDF_TRACED);
    in_out->scattered_pdf = next.is_delta ? 0.0f : next.pdf_solid_angle;
    in_out->scatter_count = branch_count;
    in_out->ray = transport_scattered_ray(t, v, next.direction, next.is_delta);
    in_out->ray.cone = transport_scattered_cone(t, v, next.direction, next.is_delta, next.pdf_solid_angle);
    return true;
}

static void follow(const transport *t, eye_worker *worker, eye_path path, eye_sample *sample);

static void follow_branches(const transport *t, eye_worker *worker, const eye_path *path, const vertex *v,
                            uint32_t bits, eye_sample *sample)
{
    int count = 1 << bits;
    for (int i = 0; i < count; i++) {
        eye_path branch = *path;
        branch.where = sampler_branch(&path->where, bits, (uint32_t)i);
        branch.vertex_key = KEY_OF_BRANCHES * (int)bits;
        branch.share = 1.0f / (float)count;
        if (go_on(t, v, false, count, &branch))
            follow(t, worker, branch, sample);
    }
}

static void follow(const transport *t, eye_worker *worker, eye_path path, eye_sample *sample)
{
    const ag_render_settings *settings = t->settings;
    bool is_whole = settings->only == AG_ONLY_ALL;
    for (;;) {
        vertex v;
        if (path.vertex == 0)
            worker->rays_camera++;
        else
            worker->rays_path++;
        bool is_met = transport_trace(t, worker, path.ray, &v);
        path.throughput = rgb_mul(path.throughput, v.transmittance);
        if (!is_met) {
            if (is_whole)
                add_escaped(t, &path, sample);
            return;
        }
        worker->camera_rays_met += path.vertex == 0;
        if (path.vertex == 0 && t->wants_layers)
            first_hit_fill(t, worker, &v, &path.where, &sample->layers->first);
        if (is_whole)
            add_emitted(t, &path, &v, sample);

        /* diffuse lobes end here */
        if (bsdf_has(&v.scattering, BSDF_GATHERED)) {
            light_group_sums groups;
            rgb *by_group = light_group_sums_begin(&groups, t->wants_groups);
            diffuse_light diffuse = diffuse_radiance(t, worker, &v, &path, by_group);
            add_diffuse(t, sample, &diffuse, &path, by_group);
        }

        /* the others are traced on */
        bool is_last = path.scatterings >= settings->max_depth;
        uint32_t bits = is_last ? 0 : branch_bits(t, &path, &v);
        if (is_whole && !is_last && bsdf_has(&v.scattering, BSDF_TRACED) &&
            bsdf_is_sampled_from_light(&v.scattering, BSDF_TRACED))
            add_direct_traced(t, worker, &path, &v, 1 << bits, sample);
        if (bits > 0) {
            follow_branches(t, worker, &path, &v, bits, sample);
            return;
        }
        if (!go_on(t, &v, is_last, 1, &path))
            return;
    }
}

void shading_radiance(const transport *t, eye_worker *worker, scene_ray ray, const sampler *where, eye_sample *in_out)
{
    eye_path path = {.where = *where,
                     .ray = ray,
                     .throughput = rgb_gray(1.0f),
                     .share = 1.0f,
                     .scattered_from = ray.origin,
                     .scatter_count = 1};
    follow(t, worker, path, in_out);
}
