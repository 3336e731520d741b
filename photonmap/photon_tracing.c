/* photon_tracing.c: see photon_tracing.h.
 * Paths are traced in rounds of blocks; how many blocks a round has depends on the counts so far alone.
 * Threads: blocks by the run's workers, each into its own buffer; merged in their order. */
#include "photon_tracing.h"

#include "alpha.h"
#include "bsdf.h"
#include "parallel_for.h"
#include "passage.h"
#include "scene_extent.h"

#include <stdlib.h>
#include <string.h>

/* A path ends here at the latest; what it still carries is booked as truncated. */
enum { SCATTERING_CAP = 100 };
enum { PATHS_PER_BLOCK = 256, BLOCKS_PER_FIRST_ROUND = 32, BLOCKS_PER_ROUND_MAX = 1024 };
/* While more blocks than this are wanted, a round does half of them: what it found lies beside the photons until it is
 * merged, and is to be small against them. */
enum { BLOCKS_WHOLE_ROUND = 512 };
/* Tracing gives up after so many paths for each photon wanted, and at once when so many have stored none at all. */
static const uint64_t PATHS_PER_PHOTON_MAX = 16, PATHS_WITHOUT_PHOTON_MAX = 1u << 20;
/* Random streams, apart from those of the eye. */
enum { STREAM_GLOBAL = 1, STREAM_CAUSTIC = 2 };

typedef struct block {
    photon *photons;
    uint32_t count, capacity;
    uint32_t place; /* of its photons in the set */
    uint64_t paths, rays, passages_cut;
    photon_books books;
    bool out_of_memory;
} block;

typedef struct tracer {
    const scene *s;
    const light_target *target; /* of a caustic map: what its paths must meet first; else NULL */
    const photon_tracing_settings *settings;
    block *out;
    uint32_t limit; /* photons to store at most; paths begun are finished for the books */
} tracer;

static void book(double entry[3], rgb flux)
{
    entry[0] += (double)flux.r;
    entry[1] += (double)flux.g;
    entry[2] += (double)flux.b;
}

static void store(tracer *t, const surface_hit *hit, const bsdf *b, vec3 direction, rgb flux, uint64_t key)
{
    block *out = t->out;
    float alpha = alpha_at_hit(t->s, hit);
    surface_rest at = surface_at_opening(t->s, hit);
    flux = rgb_scale(flux, alpha > 0.0f ? bsdf_arrival_factor(b) * at.area_ratio / alpha : 0.0f);
    book(out->books.arrived, flux);
    if (out->count == t->limit) {
        book(out->books.cut, flux);
        return;
    }
    if (out->count == out->capacity) {
        uint32_t capacity = out->capacity ? 2 * out->capacity : 4 * PATHS_PER_BLOCK;
        photon *larger = realloc(out->photons, capacity * sizeof *larger);
        if (!larger) {
            out->out_of_memory = true;
            return;
        }
        out->photons = larger;
        out->capacity = capacity;
    }
    photon *p = &out->photons[out->count++];
    memset(p, 0, sizeof *p);
    p->position[0] = at.position.x;
    p->position[1] = at.position.y;
    p->position[2] = at.position.z;
    p->flux = flux_encode(flux, key);
    p->direction = direction_encode(direction);
    bool is_outside = !(vec3_dot(hit->geometric_normal, direction) > 0.0f);
    p->normal = direction_encode(is_outside ? at.geometric_normal : vec3_negate(at.geometric_normal));
    book(out->books.stored, flux_decode(p->flux));
}

/* Media take their share of a path's flux; roulette then keeps what it carries about as it was, so that no photons are
 * spent on light that hardly matters. False: the path ends here. No random number is drawn where nothing is taken. */
static bool pass_media(photon_books *books, rgb transmittance, rng *random, rgb *in_out_flux)
{
    if (transmittance.r == 1.0f && transmittance.g == 1.0f && transmittance.b == 1.0f)
        return true;
    rgb flux = *in_out_flux, left = rgb_mul(flux, transmittance);
    book(books->absorbed, rgb_sub(flux, left));
    if (rgb_is_black(left))
        return false;
    float survival = fminf(1.0f, rgb_max(left) / rgb_max(flux));
    if (rng_float(random) >= survival) {
        book(books->lost, left);
        return false;
    }
    *in_out_flux = rgb_scale(left, 1.0f / survival);
    book(books->gained, rgb_sub(*in_out_flux, left));
    return true;
}

static void trace_path(tracer *t, uint64_t path)
{
    const scene *s = t->s;
    const photon_tracing_settings *settings = t->settings;
    photon_books *books = &t->out->books;
    rng random = rng_make(settings->seed, settings->kind == PHOTON_GLOBAL ? STREAM_GLOBAL : STREAM_CAUSTIC, path);
    uint64_t key = hash_combine(random.state, 0x70686f746f6eu);

    /* leave a lamp, picked by its power, at a time of the path's own where that matters */
    float probability, time = s->has_motion ? rng_float(&random) : 0.0f;
    const light *lamp = &s->lights[scene_pick_light_by_power(s, rng_float(&random), &probability)];
    light_emission start;
    if (!(probability > 0.0f) || !light_sample_emission(s, lamp, t->target, &random, &start))
        return;
    scene_ray ray = scene_ray_make(start.origin, start.direction);
    ray.skips_uv = true;
    ray.medium = start.medium;
    ray.time = time;
    rgb flux = rgb_scale(start.flux, 1.0f / probability);
    book(books->emitted, flux);

    for (int scatterings = 0;; scatterings++) {
        surface_hit hit;
        rgb transmittance;
        t->out->rays++;
        bool is_met = passage_intersect(s, &ray, &t->out->passages_cut, &hit, &transmittance);
        if (!pass_media(books, transmittance, &random, &flux))
            return;
        if (!is_met) {
            book(books->escaped, flux);
            return;
        }
        bsdf b = bsdf_create(s, &hit, vec3_negate(ray.direction));

        /* store at gathered lobes */
        if (bsdf_has(&b, BSDF_GATHERED)) {
            if (settings->kind == PHOTON_GLOBAL || scatterings > 0)
                store(t, &hit, &b, ray.direction, flux, hash_combine(key, (uint64_t)scatterings));
        }
        if (scatterings >= settings->max_scatterings || scatterings >= SCATTERING_CAP) {
            book(books->truncated, flux);
            return;
        }

        /* scatter; a caustic map follows traced lobes alone */
        bsdf_lobes lobes = settings->kind == PHOTON_GLOBAL ? BSDF_ALL : BSDF_TRACED;
        if (!bsdf_has(&b, lobes)) {
            book(books->lost, flux);
            return;
        }
        float u_lobe = rng_float(&random), u_roulette = rng_float(&random);
        vec2 u = rng_vec2(&random);
        bsdf_sample next;
        if (!bsdf_sample_direction(&b, lobes, BSDF_FLUX, u_lobe, u, &next)) {
            book(books->absorbed, flux);
            return;
        }
        rgb scattered = rgb_mul(flux, next.weight);
        book(books->absorbed, rgb_sub(flux, scattered));

        /* roulette keeps the flux of the survivors about what it was */
        float survival = rgb_max(scattered) > 0.0f ? fminf(1.0f, rgb_max(scattered) / rgb_max(flux)) : 0.0f;
        if (u_roulette >= survival) {
            book(books->lost, scattered);
            return;
        }
        flux = rgb_scale(scattered, 1.0f / survival);
        book(books->gained, rgb_sub(flux, scattered));
        ray = surface_ray(&hit, ray, next.direction);
    }
}

typedef struct round_job {
    const scene *s;
    const light_target *target;
    const photon_tracing_settings *settings;
    block *blocks;
    uint64_t first_path;
    run_context *run;
} round_job;

static void trace_block(void *user, uint64_t begin, uint64_t end, uint64_t block_index, unsigned worker)
{
    (void)worker;
    round_job *job = user;
    tracer t = {job->s, job->target, job->settings, &job->blocks[block_index], UINT32_MAX};
    for (uint64_t i = begin; i < end && !run_is_cancelled(job->run); i++)
        trace_path(&t, job->first_path + i);
    t.out->paths = end - begin;
}

static void add_books(photon_books *sum, const photon_books *part)
{
    double *a = (double *)sum;
    const double *b = (const double *)part;
    for (size_t i = 0; i < sizeof *sum / sizeof *a; i++)
        a[i] += b[i];
}

/* Takes a block into the account; where it overfills the set, its paths are traced again up to the one that fills it,
 * so that the books tell of whole paths and of those alone. */
static ag_status account_block(round_job *job, photon_set *set, uint64_t first_path, block *b)
{
    uint32_t room = job->settings->wanted - set->count;
    if (b->out_of_memory)
        return AG_ERROR_MEMORY;
    if (b->count >= room) {
        *b = (block){.photons = b->photons, .capacity = b->capacity};
        tracer t = {job->s, job->target, job->settings, b, room};
        while (b->count < room)
            trace_path(&t, first_path + b->paths++);
    }
    b->place = set->count;
    set->count += b->count;
    set->emitted_paths += b->paths;
    set->rays += b->rays;
    set->passages_cut += b->passages_cut;
    add_books(&set->books, &b->books);
    return AG_OK;
}

typedef struct merge_job {
    const block *blocks;
    photon *photons;
} merge_job;

static void copy_blocks(void *user, uint64_t begin, uint64_t end, uint64_t index, unsigned worker)
{
    (void)index, (void)worker;
    const merge_job *job = user;
    for (uint64_t i = begin; i < end; i++)
        if (job->blocks[i].count > 0)
            memcpy(job->photons + job->blocks[i].place, job->blocks[i].photons, job->blocks[i].count * sizeof(photon));
}

/* Appends the round's blocks in their order, up to the one that fills the set. */
static ag_status merge_round(round_job *job, photon_set *set, uint64_t block_count)
{
    uint64_t used = 0;
    for (; used < block_count && set->count < job->settings->wanted; used++) {
        ag_status status = account_block(job, set, job->first_path + used * PATHS_PER_BLOCK, &job->blocks[used]);
        if (status != AG_OK)
            return status;
    }
    merge_job merge = {job->blocks, set->photons};
    return parallel_for(job->run, used, 16, copy_blocks, &merge, AG_PHASE_PHOTONS, 0.0, 0.0);
}

/* A ball around all shapes that have traced lobes; of radius 0 where there is none. */
static ag_status find_traced_matter(const scene *s, light_target *out_target)
{
    vec3 low, high;
    ag_status status = scene_find_bounds(s, scene_shape_is_traced, &low, &high);
    *out_target = (light_target){{0.0f, 0.0f, 0.0f}, 0.0f};
    if (status != AG_OK || low.x > high.x)
        return status;
    out_target->center = vec3_scale(vec3_add(low, high), 0.5f);
    out_target->radius = vec3_length(vec3_sub(high, out_target->center)) * 1.0001f;
    return AG_OK;
}

static void explain_shortage(run_context *run, const photon_tracing_settings *settings, const photon_set *set)
{
    const photon_books *b = &set->books;
    double emitted = b->emitted[0] + b->emitted[1] + b->emitted[2];
    double escaped = b->escaped[0] + b->escaped[1] + b->escaped[2];
    /* most scenes with something shiny have hardly any caustics: that is no news */
    log_message(run->log, settings->kind == PHOTON_GLOBAL ? AG_LOG_WARNING : AG_LOG_INFO,
                "%s photon map: %u of %u photons stored after %llu paths, of which too few meet a diffuse surface%s "
                "(%.1f %% of "
                "the emitted light leaves the scene): the light is right, its detail coarser",
                settings->kind == PHOTON_GLOBAL ? "global" : "caustic", set->count, settings->wanted,
                (unsigned long long)set->emitted_paths,
                settings->kind == PHOTON_GLOBAL ? "" : " by way of a specular one",
                emitted > 0.0 ? 100.0 * escaped / emitted : 0.0);
}

ag_status photon_tracing_run(const scene *s, run_context *run, const photon_tracing_settings *settings,
                             photon_set *out_set)
{
    photon_set set = {0};
    *out_set = set;
    if (s->light_count == 0 || !(rgb_max(s->light_power) > 0.0f)) {
        log_once(run->log, AG_LOG_WARNING, "no light", "the scene has no light that emits: there are no photons");
        return AG_OK;
    }
    if (!scene_sends_photons(s))
        return AG_OK; /* as the file wants it */
    if (s->shape_count == 0 && s->infinite_light_count > 0)
        return AG_OK; /* a sky alone, which the eye sees without photons */
    light_target traced_matter;
    const light_target *caustic_target = NULL;
    if (settings->kind == PHOTON_CAUSTIC) {
        ag_status found = find_traced_matter(s, &traced_matter);
        if (found != AG_OK)
            return found;
        if (!(traced_matter.radius > 0.0f))
            return AG_OK; /* there may be such matter in objects without instances */
        caustic_target = &traced_matter;
    }
    block *blocks = calloc(BLOCKS_PER_ROUND_MAX, sizeof *blocks);
    set.photons = photon_records_create(settings->wanted);
    ag_status status = blocks && set.photons ? AG_OK : AG_ERROR_MEMORY;
    uint64_t next_path = 0, block_count = settings->wanted / PATHS_PER_BLOCK + 1; /* a photon a path */
    if (block_count > BLOCKS_PER_FIRST_ROUND)
        block_count = BLOCKS_PER_FIRST_ROUND;
    while (status == AG_OK && set.count < settings->wanted) {
        round_job job = {s, caustic_target, settings, blocks, next_path, run};
        status = parallel_for(run, block_count * PATHS_PER_BLOCK, PATHS_PER_BLOCK, trace_block, &job, AG_PHASE_PHOTONS,
                              0.0, 0.0);
        if (status == AG_OK)
            status = merge_round(&job, &set, block_count);
        for (uint64_t i = 0; i < block_count; i++)
            blocks[i] = (block){.photons = blocks[i].photons, .capacity = blocks[i].capacity};
        next_path += block_count * PATHS_PER_BLOCK;

        bool is_hopeless = set.emitted_paths >= PATHS_WITHOUT_PHOTON_MAX &&
                           (set.count == 0 || set.emitted_paths / PATHS_PER_PHOTON_MAX >= settings->wanted);
        if (set.count < settings->wanted && is_hopeless) {
            explain_shortage(run, settings, &set);
            break;
        }
        /* as many blocks as the yield so far lets expect are needed, and one to spare */
        double needed =
            set.count > 0 ? (double)(settings->wanted - set.count) * (double)set.emitted_paths / set.count : 1e18;
        double wanted_blocks = needed / PATHS_PER_BLOCK + 1.0;
        if (wanted_blocks > BLOCKS_WHOLE_ROUND)
            wanted_blocks *= 0.5;
        block_count = wanted_blocks < BLOCKS_PER_ROUND_MAX ? (uint64_t)wanted_blocks : BLOCKS_PER_ROUND_MAX;
        run_progress(run, AG_PHASE_PHOTONS,
                     settings->progress_begin +
                         (settings->progress_end - settings->progress_begin) * ((double)set.count / settings->wanted));
    }
    for (int i = 0; blocks && i < BLOCKS_PER_ROUND_MAX; i++)
        free(blocks[i].photons);
    free(blocks);
    if (status != AG_OK) {
        photon_set_reset(&set);
        return status;
    }
    /* the books so far are sums over paths that each stand for all the light */
    double share = set.emitted_paths > 0 ? 1.0 / (double)set.emitted_paths : 0.0;
    for (size_t i = 0; i < sizeof set.books / sizeof(double); i++)
        ((double *)&set.books)[i] *= share;
    *out_set = set;
    return AG_OK;
}

void photon_set_reset(photon_set *set)
{
    free(set->photons);
    *set = (photon_set){0};
}
