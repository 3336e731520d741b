/* shading.c: see shading.h. */
#include "integrator/shading.h"

#include "integrator/direct_lighting.h"
#include "integrator/final_gather.h"

/* A path is split at the first glossy vertex: the diffuse vertices behind it share the gather rays, and many directions
 * say more of the light than many rays behind one; so there may be more branches than gather rays. Smooth glass has two
 * ways at each of its faces. */
enum { BRANCHES_MAX = 8, SMOOTH_BRANCHES_MAX = 4 };

/* Glints are looked for where the eye sees more than this share of them. */
static const float GLINT_SHARE_SEEN = 1.0f / 8.0f;

static const float SQRT_2 = 1.41421356f;

/* A path is split at so many smooth surfaces, and only where the variance of a choice between their two ways, in the
 * square of the light that the eye sees, is above WAYS_VARIANCE. Rays times squared error at four samples, over that of
 * chance alone: a glass pot 0.78, a pool 0.73, twenty thick sheets in a row 0.85, 400 balls 0.99, thirty panes in a row
 * 1.10; the last three 2.0, 2.4 and 6.3 where the number of surfaces is not bounded. */
enum { WAYS_MAX = 3 };
static const float WAYS_VARIANCE = 1.0f / 8192.0f;

/* The parts of the light that a diffuse vertex sends on, but for gathered light, which the sample gets later. */
typedef struct diffuse_light {
    rgb direct, caustic;
    rgb sky; /* the part of the direct light that comes from infinite lights */
} diffuse_light;

/* Returns the exponent of the power of two that is nearest by ratio, at least 0. */
static uint32_t nearest_bits(float wanted)
{
    uint32_t bits = 0;
    while ((float)(1u << bits) * SQRT_2 < wanted)
        bits++;
    return bits;
}

/* The share of the eye's gather rays, of which there may be `most`, that a vertex of the path has: as many of them as
 * of the light that the eye sees. Where that is less than one, there is one with this probability. */
typedef struct gather_share {
    uint32_t count;
    float probability; /* 1 where count > 1 */
} gather_share;

static gather_share share_of_gather(const transport *t, uint32_t most, const eye_path *path)
{
    if (path->scatterings == 0)
        return (gather_share){most, 1.0f};
    float wanted = (float)most * float_min(path->share * rgb_max(path->throughput), 1.0f);
    if (wanted < 1.0f) /* a bound would cut what chance has made brighter */
        return (gather_share){1,
                              t->settings->clamp_indirect > 0.0f ? 1.0f : float_min((float)most * path->share, 1.0f)};
    uint32_t bits = nearest_bits(wanted);
    return (gather_share){1u << bits < most ? 1u << bits : most, 1.0f};
}

/* Finds the light that other surfaces send by way of these lobes. */
static void gather_light(const transport *t, eye_worker *worker, const vertex *v, const camera_sample *from,
                         const eye_path *path, eye_sample *sample)
{
    gather_share rays = share_of_gather(t, from->split.rays, path);
    int key = eye_path_key(path) + SAMPLER_KEY_RAYS * (int)sampler_bits(rays.count);
    float chance = rays.probability < 1.0f
                       ? sampler_2d(&path->where, SAMPLE_ROULETTE, eye_path_key(path) + SAMPLER_KEY_CHANCE).x
                       : 0.0f;
    sampler where = path->where;
    if (path->scatterings == 0) { /* the gather rays of all samples of a pixel form one sequence */
        where = sampler_shifted(&where, from->split.ray_shift, where.sample_bits + t->ray_bits, rays.count);
        key = eye_path_key(path);
    }
    if (chance >= rays.probability)
        return;
    gather_request request = {.from = v,
                              .where = &where,
                              .path_vertex = key,
                              .sample = from->number,
                              .is_first = path->scatterings == 0,
                              .scatterings_left = eye_path_scatterings_left(t, path),
                              .count = rays.count,
                              .throughput = rgb_scale(path->throughput, path->share / rays.probability),
                              .share = path->share};
    sample->gather_cost += final_gather(t, worker, &request);
}

/* Light samples are shared like gather rays, but each vertex has one. */
static direct_light direct_radiance(const transport *t, eye_worker *worker, const vertex *v, const camera_sample *from,
                                    const eye_path *path, eye_sample *sample, rgb *by_group)
{
    uint32_t lights = from->split.lights;
    if (path->scatterings > 0) {
        uint32_t bits = nearest_bits((float)lights * float_min(path->share * rgb_max(path->throughput), 1.0f));
        lights = 1u << bits < lights ? 1u << bits : lights;
    }
    uint64_t before = eye_worker_cost(worker);
    direct_light direct = direct_light_gathered(t, worker, v, &path->where,
                                                eye_path_key(path) + SAMPLER_KEY_RAYS * (int)sampler_bits(lights),
                                                transport_sample_counts(t, lights, path->scatterings == 0), by_group);
    if (path->scatterings == 0) {
        float weight = eye_path_shared(path) * rgb_mean(path->throughput);
        sample->light_cost += (uint32_t)(eye_worker_cost(worker) - before);
        sample->light_variance += weight * weight * direct.variance;
    }
    return direct;
}

/* Caustics behind the first surface are asked for by what of them reaches the eye; all of them only as often as it pays
 * in the block. */
static rgb caustic_radiance(const transport *t, eye_worker *worker, const vertex *v, const camera_sample *from,
                            const eye_path *path, eye_sample *sample)
{
    rgb seen = rgb_scale(path->throughput, path->share);
    float of_block = 1.0f / (float)(1u << from->split.caustic_bits);
    float of_path = path->scatterings == 0 ? 1.0f : transport_caustic_probability(t, rgb_max(seen));
    uint64_t before = eye_worker_cost(worker);
    rgb caustic = transport_some_caustics(t, worker, v, of_block * of_path,
                                          sampler_2d(&path->where, SAMPLE_ROULETTE, eye_path_key(path)).y);
    float brought = rgb_mean(rgb_mul(seen, caustic));
    sample->caustic_square += of_block * brought * brought;
    sample->caustic_cost += (uint32_t)(eye_worker_cost(worker) - before);
    return caustic;
}

/* Finds the light that a diffuse vertex sends on, and notes in the sample what gather rays, light samples and caustics
 * cost, and how noisy the latter two are. */
static diffuse_light diffuse_radiance(const transport *t, eye_worker *worker, const vertex *v,
                                      const camera_sample *from, const eye_path *path, eye_sample *sample,
                                      rgb *by_group)
{
    int scatterings_left = eye_path_scatterings_left(t, path);
    diffuse_light sum = {rgb_gray(0.0f), rgb_gray(0.0f), rgb_gray(0.0f)};
    if (scatterings_left < 1)
        return sum;
    if (transport_wants_all_light(t)) {
        const direct_light direct = direct_radiance(t, worker, v, from, path, sample, by_group);
        sum.direct = direct.radiance;
        sum.sky = direct.from_sky;
    }
    if (path->is_further)
        return sum;
    sum.caustic = caustic_radiance(t, worker, v, from, path, sample);
    if (scatterings_left >= 2)
        gather_light(t, worker, v, from, path, sample);
    return sum;
}

/* Adds the light of a diffuse vertex to the sample. by_group: the direct light by groups of lamps; all other light came
 * through the photon map, and is of no group. */
static void add_diffuse(const transport *t, eye_sample *sample, const diffuse_light *diffuse, const eye_path *path,
                        const rgb *by_group)
{
    int scatterings = path->scatterings;
    bool is_first = scatterings == 0;
    float share = path->share, shared = eye_path_shared(path);
    rgb throughput = rgb_scale(path->throughput, share), throughput_shared = rgb_scale(path->throughput, shared);
    rgb direct = rgb_mul(throughput_shared, diffuse->direct), caustic = rgb_mul(throughput, diffuse->caustic);
    float kept_direct = eye_sample_bound(sample, shared, scatterings + 1, direct);
    direct = rgb_scale(direct, kept_direct);
    caustic = rgb_scale(caustic, eye_sample_bound(sample, share, scatterings + 2, caustic));
    sample->radiance = rgb_add(sample->radiance, rgb_add(direct, caustic));
    sample->own += rgb_mean(caustic);
    eye_sample_add_part(sample, is_first ? PART_DIRECT : PART_SPECULAR, direct);
    eye_sample_add_part(sample, is_first ? PART_CAUSTIC : PART_SPECULAR, caustic);
    if (is_first && sample->layers)
        sample->layers->sky =
            rgb_add(sample->layers->sky, rgb_scale(rgb_mul(throughput_shared, diffuse->sky), kept_direct));
    if (by_group) {
        eye_sample_add_groups(sample, by_group, rgb_scale(throughput_shared, kept_direct));
        eye_sample_add_group(sample, (uint32_t)t->layout->group_count, caustic);
    }
}

/* Returns how much of the light behind the path the eye sees, at most 1. The throughput alone may be more, as radiance
 * grows where it leaves glass, and then bounds nothing. */
static float share_seen(const eye_path *path) { return path->share * float_min(rgb_max(path->throughput), 1.0f); }

/* Returns the number of branches, as the exponent of a power of two, into which the path is split at the vertex: at one
 * that is seen directly or by a smooth surface, where it is traced on in more than one direction; into the fewer, the
 * less of it is seen. */
static uint32_t branch_bits(const transport *t, const eye_path *path, const vertex *v)
{
    if (path->scattered_pdf > 0.0f || transport_is_open_pane(t, v) || !bsdf_has_many_ways(&v->scattering, BSDF_TRACED))
        return 0;
    float reflected = bsdf_smooth_reflection_share(&v->scattering, BSDF_TRACED);
    if (reflected == 0.0f || reflected == 1.0f) /* all reflected, say: branches would be one line */
        return 0;
    float most =
        bsdf_is_sampled_from_light(&v->scattering, BSDF_TRACED) ? (float)BRANCHES_MAX : (float)SMOOTH_BRANCHES_MAX;
    if (path->is_further) /* by whose branches nothing is gathered */
        most *= 2.0f * path->shared;
    return nearest_bits(most * bsdf_probability(&v->scattering, BSDF_TRACED) * share_seen(path));
}

static void follow(const transport *t, eye_worker *worker, const camera_sample *from, eye_path path,
                   eye_sample *sample);

static void follow_branches(const transport *t, eye_worker *worker, const camera_sample *from, const eye_path *path,
                            const vertex *v, const glint_guide *glints, uint32_t bits, eye_sample *sample)
{
    int count = 1 << bits;
    for (int i = 0; i < count; i++) {
        eye_path branch = *path;
        branch.where = sampler_branch(&path->where, bits, (uint32_t)i);
        branch.vertex_key += SAMPLER_KEY_BRANCHES * (int)bits;
        branch.share /= (float)count;
        if (eye_path_go_on(t, v, BSDF_TRACED, glints, eye_path_u_lobe(&branch), count, &branch))
            follow(t, worker, from, branch, sample);
    }
}

/* A path that is split at a smooth surface by its two ways. */
typedef struct two_ways {
    eye_path bright, faint;  /* by the way that has more of the light, and by the other */
    float u_bright, u_faint; /* the numbers that pick them */
} two_ways;

/* Splits the path where the choice between the two ways of a smooth surface would matter; returns whether it did. */
static bool split_ways(const eye_path *path, const vertex *v, two_ways *out)
{
    float reflected = bsdf_smooth_reflection_share(&v->scattering, BSDF_TRACED), transmitted = 1.0f - reflected;
    float share = share_seen(path) * (path->is_further ? path->shared : 1.0f);
    if (path->ways_taken >= WAYS_MAX || !(reflected * transmitted * share * share > WAYS_VARIANCE))
        return false;
    float u_reflected = 0.5f * reflected, u_transmitted = 1.0f - 0.5f * transmitted;
    bool is_mirror = reflected > transmitted;
    *out = (two_ways){*path, *path, is_mirror ? u_reflected : u_transmitted, is_mirror ? u_transmitted : u_reflected};
    out->bright.ways_taken = out->faint.ways_taken = path->ways_taken + 1;
    out->bright.share *= float_max(reflected, transmitted);
    out->faint.share *= float_min(reflected, transmitted);
    out->faint.where = sampler_apart(&path->where, (uint32_t)path->vertex);
    return true;
}

static void follow(const transport *t, eye_worker *worker, const camera_sample *from, eye_path path, eye_sample *sample)
{
    bool wants_all = transport_wants_all_light(t);
    for (;;) {
        vertex v;
        if (!eye_path_trace(t, worker, &path, sample, &v)) {
            if (wants_all)
                eye_path_add_escaped(t, &path, sample);
            return;
        }
        if (wants_all)
            eye_path_add_emitted(t, &path, &v, sample);

        /* diffuse lobes end here */
        if (bsdf_has(&v.scattering, BSDF_GATHERED)) {
            light_group_sums groups;
            rgb *by_group = light_group_sums_begin(&groups, t->wants_groups);
            diffuse_light diffuse = diffuse_radiance(t, worker, &v, from, &path, sample, by_group);
            add_diffuse(t, sample, &diffuse, &path, by_group);
        }

        /* mirrors, glass and glossy lobes: the path goes on, maybe in several branches */
        bool is_last = eye_path_is_last(t, &path);
        uint32_t bits = is_last ? 0 : branch_bits(t, &path, &v);
        if (wants_all && !is_last && bsdf_has(&v.scattering, BSDF_TRACED) &&
            bsdf_is_sampled_from_light(&v.scattering, BSDF_TRACED))
            eye_path_add_direct(t, worker, &path, &v, BSDF_TRACED, 1 << bits, sample);
        two_ways ways;
        if (split_ways(&path, &v, &ways)) {
            if (eye_path_go_on(t, &v, BSDF_TRACED, NULL, ways.u_faint, 1, &ways.faint))
                follow(t, worker, from, ways.faint, sample);
            path = ways.bright;
            if (!eye_path_go_on(t, &v, BSDF_TRACED, NULL, ways.u_bright, 1, &path))
                return;
            continue;
        }
        glint_guide guide;
        bool is_seen = !is_last && share_seen(&path) > GLINT_SHARE_SEEN;
        const glint_guide *glints = is_seen ? eye_path_find_glints(t, &v, &guide) : NULL;
        if (bits > 0) {
            follow_branches(t, worker, from, &path, &v, glints, bits, sample);
            return;
        }
        if (!eye_path_go_on(t, &v, BSDF_TRACED, glints, eye_path_u_lobe(&path), 1, &path))
            return;
    }
}

void shading_radiance(const transport *t, eye_worker *worker, const camera_sample *from, eye_sample *in_out)
{
    follow(t, worker, from, eye_path_begin(from, SHADING_ROULETTE, in_out->layers != NULL), in_out);
}
