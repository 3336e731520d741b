/* photon_tracing.c: see photon_tracing.h.
 * Paths are traced in rounds of blocks; how many blocks a round has depends on the counts so far alone.
 * Threads: blocks by the run's workers, each into its own buffer; merged in their order. */
#include "photon_tracing.h"

#include "parallel_for.h"
#include "photon_path.h"
#include "scene_extent.h"
#include "status.h"

#include <stdlib.h>
#include <string.h>

enum { PATHS_PER_BLOCK = 256, BLOCKS_PER_FIRST_ROUND = 32, BLOCKS_PER_ROUND_MAX = 1024 };
/* The first round assumes that each path leaves FIRST_YIELD photons; most leave fewer. A round that leaves none at all
 * is followed by one NO_YIELD_GROWTH times as large. */
enum { FIRST_YIELD = 4, NO_YIELD_GROWTH = 8 };
/* While more blocks than this are needed, a round does half of them: its photons are held beside the others until they
 * are merged, and should be few against them. */
enum { BLOCKS_WHOLE_ROUND = 512 };
/* Tracing gives up when this many paths have stored no photon at all. */
static const uint64_t PATHS_WITHOUT_PHOTON_MAX = 1u << 20;

typedef struct round_job {
    const scene *s;
    const light_target *target;
    const photon_tracing_settings *settings;
    path_block *blocks;
    uint64_t first_path;
    run_context *run;
} round_job;

static void trace_block(void *user, uint64_t begin, uint64_t end, uint64_t block_index, unsigned worker)
{
    (void)worker;
    round_job *job = user;
    /* a copy, since each photon changes the balance, and that of the next block, which another worker changes, may lie
     * on the same line of the cache */
    path_block out = job->blocks[block_index];
    photon_tracer t = {.s = job->s, .target = job->target, .settings = job->settings, .out = &out, .limit = UINT32_MAX};
    for (uint64_t i = begin; i < end && !run_is_cancelled(job->run); i++)
        photon_path_trace(&t, job->first_path + i);
    out.paths = end - begin;
    out.is_cut = run_is_cancelled(job->run); /* a cancel just behind the last path counts as well: harmless */
    job->blocks[block_index] = out;
}

static void add_balance(energy_balance *sum, const energy_balance *part)
{
    double *a = (double *)sum;
    const double *b = (const double *)part;
    for (size_t i = 0; i < sizeof *sum / sizeof *a; i++)
        a[i] += b[i];
}

/* Adds a block to the set's counts and balance. Where the block overfills the set, its paths are traced again up to the
 * one that fills it, so that the balance is of whole paths, and of no path behind that one. */
static ag_status account_block(round_job *job, photon_set *set, uint64_t first_path, path_block *b)
{
    uint32_t room = job->settings->wanted - set->count;
    if (b->out_of_memory)
        return AG_ERROR_MEMORY;
    if (b->is_cut) /* where all blocks had been begun before the run was cancelled, parallel_for returns AG_OK */
        return AG_CANCELLED;
    if (b->count >= room) {
        *b = (path_block){.photons = b->photons, .capacity = b->capacity};
        photon_tracer t = {.s = job->s, .target = job->target, .settings = job->settings, .out = b, .limit = room};
        while (b->count < room)
            photon_path_trace(&t, first_path + b->paths++);
    }
    b->first = set->count;
    set->count += b->count;
    set->emitted_paths += b->paths;
    set->rays += b->rays;
    set->parts += b->parts;
    set->rays_cut += b->rays_cut;
    add_balance(&set->balance, &b->balance);
    return AG_OK;
}

typedef struct merge_job {
    const path_block *blocks;
    photon *photons;
} merge_job;

static void copy_blocks(void *user, uint64_t begin, uint64_t end, uint64_t index, unsigned worker)
{
    (void)index, (void)worker;
    const merge_job *job = user;
    for (uint64_t i = begin; i < end; i++)
        if (job->blocks[i].count > 0)
            memcpy(job->photons + job->blocks[i].first, job->blocks[i].photons, job->blocks[i].count * sizeof(photon));
}

/* Appends the round's blocks in their order, up to the one that fills the set. */
static ag_status merge_round(round_job *job, photon_set *set, uint64_t block_count)
{
    uint64_t used = 0;
    for (; used < block_count && set->count < job->settings->wanted; used++) {
        AG_TRY(account_block(job, set, job->first_path + used * PATHS_PER_BLOCK, &job->blocks[used]));
    }
    merge_job merge = {job->blocks, set->photons};
    return parallel_for(job->run, used, 16, copy_blocks, &merge, AG_PHASE_PHOTONS, 0.0, 0.0);
}

/* Finds a ball around all shapes that have traced lobes; its radius is 0 where there is none. */
static ag_status find_traced_surfaces(const scene *s, light_target *out_target)
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

static void warn_of_shortage(run_context *run, const photon_tracing_settings *settings, const photon_set *set)
{
    const energy_balance *b = &set->balance;
    double emitted = b->emitted[0] + b->emitted[1] + b->emitted[2];
    double escaped = b->escaped[0] + b->escaped[1] + b->escaped[2];
    /* few caustics are no reason to warn: most scenes that have mirrors or glass are like that */
    log_message(run->log, settings->kind == PHOTON_GLOBAL ? AG_LOG_WARNING : AG_LOG_INFO,
                "%s photon map: %u of %u photons stored after %llu paths, of which too few meet a diffuse surface%s "
                "(%.1f %% of the emitted light leaves the scene): the light is right, its detail coarser",
                settings->kind == PHOTON_GLOBAL ? "global" : "caustic", set->count, settings->wanted,
                (unsigned long long)set->emitted_paths,
                settings->kind == PHOTON_GLOBAL ? "" : " by way of a specular one",
                emitted > 0.0 ? 100.0 * escaped / emitted : 0.0);
}

/* Finds the traced surfaces that a caustic map's paths are to meet first; NULL for the global map. *out_has_any is
 * false where there is no light, or nothing that a caustic could come from. */
static ag_status find_target(const scene *s, photon_kind kind, light_target *out_target_ball,
                             const light_target **out_target, bool *out_has_any)
{
    *out_target = NULL;
    *out_has_any = s->light_count > 0 && rgb_max(s->light_power) > 0.0f && scene_sends_photons(s) &&
                   !(s->shape_count == 0 && s->infinite_light_count > 0); /* a sky alone is seen without photons */
    if (!*out_has_any || kind == PHOTON_GLOBAL)
        return AG_OK;
    ag_status status = find_traced_surfaces(s, out_target_ball);
    *out_target = out_target_ball;
    *out_has_any = out_target_ball->radius > 0.0f; /* there may be such surfaces in objects without instances */
    return status;
}

/* Warns that the map was full before all requested paths had been emitted. */
static void warn_of_full_map(run_context *run, const photon_tracing_settings *settings, const photon_set *set)
{
    log_message(run->log, AG_LOG_WARNING,
                "the photon map was full after %llu of %llu paths: photons will change from frame to frame (more "
                "--photons make room)",
                (unsigned long long)set->emitted_paths, (unsigned long long)settings->paths);
}

/* Returns the number of the next round's blocks: as many as will be needed if they yield as much as those before, and
 * one to spare. */
static uint64_t next_block_count(const photon_set *set, uint32_t wanted, uint64_t block_count)
{
    double needed = (double)(wanted - set->count) * (double)set->emitted_paths;
    double blocks =
        set->count > 0 ? needed / set->count / PATHS_PER_BLOCK + 1.0 : NO_YIELD_GROWTH * (double)block_count;
    if (blocks > BLOCKS_WHOLE_ROUND)
        blocks *= 0.5;
    return blocks < BLOCKS_PER_ROUND_MAX ? (uint64_t)blocks : BLOCKS_PER_ROUND_MAX;
}

/* Returns the number of paths that remain to be emitted in the blocks of a round. */
static uint64_t paths_of_round(const photon_tracing_settings *settings, uint64_t next_path, uint64_t block_count)
{
    uint64_t paths = block_count * PATHS_PER_BLOCK, left = settings->paths > 0 ? settings->paths - next_path : paths;
    return left < paths ? left : paths;
}

/* Returns whether paths have stored so few photons that there is no point in going on. A fixed number of paths is
 * traced to its end unless none has stored any. */
static bool is_hopeless(const photon_tracing_settings *settings, const photon_set *set)
{
    bool takes_too_many = settings->paths == 0 && set->emitted_paths / PHOTON_PATHS_MAX >= settings->wanted;
    return set->emitted_paths >= PATHS_WITHOUT_PHOTON_MAX && (set->count == 0 || takes_too_many);
}

/* From sums over paths, each of which stands for all the light, to their mean. */
static void divide_balance(energy_balance *balance, uint64_t paths)
{
    double share = paths > 0 ? 1.0 / (double)paths : 0.0;
    for (size_t i = 0; i < sizeof *balance / sizeof(double); i++)
        ((double *)balance)[i] *= share;
}

/* Returns how much of the work is done, from 0 to 1. */
static double share_done(const photon_tracing_settings *settings, const photon_set *set, uint64_t next_path)
{
    double done = (double)set->count / settings->wanted;
    return settings->paths > 0 ? double_max(done, (double)next_path / (double)settings->paths) : done;
}

/* Traces rounds until the set is full, all paths have been emitted, or there is no point in going on. blocks: those of
 * a round, whose buffers are used again by the next. */
static ag_status trace_rounds(const scene *s, run_context *run, const photon_tracing_settings *settings,
                              const light_target *target, path_block *blocks, photon_set *set)
{
    uint64_t next_path = 0, block_count = settings->wanted / (FIRST_YIELD * PATHS_PER_BLOCK) + 1;
    if (block_count > BLOCKS_PER_FIRST_ROUND)
        block_count = BLOCKS_PER_FIRST_ROUND;
    while (set->count < settings->wanted && (settings->paths == 0 || next_path < settings->paths)) {
        uint64_t paths = paths_of_round(settings, next_path, block_count);
        block_count = (paths + PATHS_PER_BLOCK - 1) / PATHS_PER_BLOCK;
        round_job job = {s, target, settings, blocks, next_path, run};
        AG_TRY(parallel_for(run, paths, PATHS_PER_BLOCK, trace_block, &job, AG_PHASE_PHOTONS, 0.0, 0.0));
        AG_TRY(merge_round(&job, set, block_count));
        for (uint64_t i = 0; i < block_count; i++)
            blocks[i] = (path_block){.photons = blocks[i].photons, .capacity = blocks[i].capacity};
        next_path += paths;
        if (set->count < settings->wanted && is_hopeless(settings, set)) {
            warn_of_shortage(run, settings, set);
            break;
        }
        block_count = next_block_count(set, settings->wanted, block_count);
        run_progress(run, AG_PHASE_PHOTONS,
                     settings->progress_begin +
                         (settings->progress_end - settings->progress_begin) * share_done(settings, set, next_path));
    }
    return AG_OK;
}

ag_status photon_tracing_run(const scene *s, run_context *run, const photon_tracing_settings *settings,
                             photon_set *out_set)
{
    photon_set set = {0};
    *out_set = set;
    light_target traced_surfaces;
    const light_target *caustic_target;
    bool has_any;
    ag_status status = find_target(s, settings->kind, &traced_surfaces, &caustic_target, &has_any);
    if (status != AG_OK || !has_any)
        return status;
    path_block *blocks = calloc(BLOCKS_PER_ROUND_MAX, sizeof *blocks);
    set.photons = photon_records_create(settings->wanted);
    status = blocks && set.photons ? trace_rounds(s, run, settings, caustic_target, blocks, &set) : AG_ERROR_MEMORY;
    for (int i = 0; blocks && i < BLOCKS_PER_ROUND_MAX; i++)
        free(blocks[i].photons);
    free(blocks);
    if (status != AG_OK) {
        photon_set_reset(&set);
        return status;
    }
    if (set.count == settings->wanted && set.emitted_paths < settings->paths)
        warn_of_full_map(run, settings, &set);
    divide_balance(&set.balance, set.emitted_paths);
    *out_set = set;
    return AG_OK;
}

void photon_set_reset(photon_set *set)
{
    free(set->photons);
    *set = (photon_set){0};
}

/* --- trials --- */

enum { TRIALS_PER_BLOCK = 512 };

typedef struct trial_job {
    const scene *s;
    const light_target *target;
    const photon_tracing_settings *settings;
    uint64_t first_path;
    emission_trial *trials;
    trial_counts *counts; /* of each path_block */
    run_context *run;
} trial_job;

static void try_block(void *user, uint64_t begin, uint64_t end, uint64_t block_index, unsigned worker)
{
    (void)worker;
    trial_job *job = user;
    path_block out = {0};
    trial_counts counts = {0};
    for (uint64_t i = begin; i < end && !run_is_cancelled(job->run); i++) {
        photon_tracer t = {.s = job->s,
                           .target = job->target,
                           .settings = job->settings,
                           .out = &out,
                           .trial = &job->trials[i],
                           .counts = &counts};
        photon_path_trace(&t, job->first_path + i);
    }
    counts.paths = end - begin;
    counts.parts = out.parts;
    counts.rays = out.rays;
    job->counts[block_index] = counts;
}

ag_status photon_tracing_try(const scene *s, run_context *run, const photon_tracing_settings *settings,
                             uint64_t first_path, uint32_t count, emission_trial *out_trials,
                             trial_counts *in_out_counts)
{
    light_target traced_surfaces;
    const light_target *caustic_target;
    bool has_any;
    ag_status status = find_target(s, settings->kind, &traced_surfaces, &caustic_target, &has_any);
    for (uint32_t i = 0; i < count; i++)
        out_trials[i] = (emission_trial){.density = 1.0f};
    if (status != AG_OK || !has_any)
        return status;
    uint64_t block_count = (count + TRIALS_PER_BLOCK - 1) / TRIALS_PER_BLOCK;
    trial_counts *counts = calloc(block_count, sizeof *counts);
    if (!counts)
        return AG_ERROR_MEMORY;
    trial_job job = {s, caustic_target, settings, first_path, out_trials, counts, run};
    status = parallel_for(run, count, TRIALS_PER_BLOCK, try_block, &job, AG_PHASE_PHOTONS, 0.0, 0.0);
    for (uint64_t i = 0; i < block_count; i++) {
        in_out_counts->paths += counts[i].paths;
        in_out_counts->parts += counts[i].parts;
        in_out_counts->rays += counts[i].rays;
        in_out_counts->photons += counts[i].photons;
        in_out_counts->asked += counts[i].asked;
        in_out_counts->stored += counts[i].stored;
        in_out_counts->roots += counts[i].roots;
        in_out_counts->importance += counts[i].importance;
    }
    free(counts);
    return status;
}
