/* irradiance_photons.c: see irradiance_photons.h. */
#include "irradiance_photons.h"

#include "parallel_for.h"

#include <stdlib.h>

uint32_t irradiance_photons_runs(uint32_t photon_count, float fraction)
{
    if (photon_count == 0 || fraction >= 1.0f)
        return photon_count;
    uint32_t count = (uint32_t)((double)photon_count * (double)fraction + 0.5);
    return count > 0 ? count : 1;
}

/* How often long loops look whether to stop: a run may be of all photons. */
enum { CANCEL_MASK = 0xffff };

typedef struct choice {
    const run_context *run;
    const photon_tree *photons;
    uint32_t runs;
    float reach_squared, min_cos;
} choice;

/* Where a photon lies. */
typedef struct spot {
    vec3 position, normal; /* of the surface there */
} spot;

static spot spot_of(const choice *c, uint32_t photon_index)
{
    const photon_block *blocks = c->photons->blocks;
    return (spot){photon_block_position(blocks, photon_index),
                  direction_decode(photon_block_normal(blocks, photon_index))};
}

static bool is_near(const choice *c, const spot *a, const spot *b, float reach_squared)
{
    return vec3_distance_squared(a->position, b->position) <= reach_squared &&
           vec3_dot(a->normal, b->normal) > c->min_cos;
}

static photon record_of(const photon_tree *photons, uint32_t index)
{
    const photon_block *b = &photons->blocks[index / PHOTON_BLOCK_LANES];
    uint32_t lane = index % PHOTON_BLOCK_LANES;
    photon p;
    __builtin_memset(&p, 0, sizeof p);
    for (int a = 0; a < 3; a++)
        p.position[a] = b->position[a][lane];
    p.flux = index;
    p.direction = b->direction[lane];
    p.normal = b->normal[lane];
    return p;
}

/* A photon is compared with this many of its run's irradiance photons at most: the pick, and the last ones. */
enum { ASKED = 8 };

/* Returns whether one of the chosen photons, of which the pick is the first, represents a photon. The others have half
 * the reach: they lie where a gather hit may be far from all photons. */
static bool is_stood_for(const choice *c, const spot *chosen, uint32_t count, const spot *photon_at)
{
    if (is_near(c, &chosen[0], photon_at, c->reach_squared))
        return true;
    for (uint32_t i = 1; i < count; i++)
        if (is_near(c, &chosen[i], photon_at, 0.25f * c->reach_squared))
            return true;
    return false;
}

/* Chooses a run's irradiance photons: its pick, and the photons that none of those compared represents. Writes them to
 * records, unless it is NULL, and returns their number, or when cancelled the number so far. */
static uint32_t choose(const choice *c, uint32_t run, photon *records)
{
    uint64_t all = c->photons->count, begin = run * all / c->runs, end = (run + 1) * all / c->runs;
    uint32_t pick = (uint32_t)(begin + ((hash_mix64(run + UINT64_C(0x62656172)) >> 32) * (end - begin) >> 32));
    spot asked[ASKED] = {spot_of(c, pick)};
    uint32_t count = 0, others = 0;
    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++) {
        if ((i & CANCEL_MASK) == 0 && run_is_cancelled(c->run))
            break;
        if (i != pick) {
            spot at = spot_of(c, i);
            if (is_stood_for(c, asked, others < ASKED - 1 ? others + 1 : ASKED, &at))
                continue;
            asked[1 + others++ % (ASKED - 1)] = at;
        }
        if (records)
            records[count] = record_of(c->photons, i);
        count++;
    }
    return count;
}

/* --- all runs, in blocks --- */

enum { RUNS_PER_BLOCK = 256 };

typedef struct choice_job {
    const choice *c;
    uint32_t *begins; /* by block: the number of its irradiance photons, then the index of the first one */
    photon *records;  /* NULL while they are counted */
} choice_job;

static void choose_block(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)worker;
    const choice_job *job = user;
    uint32_t count = 0;
    for (uint64_t i = begin; i < end && !run_is_cancelled(job->c->run); i++)
        count += choose(job->c, (uint32_t)i, job->records ? job->records + job->begins[block] + count : NULL);
    if (!job->records)
        job->begins[block] = count;
}

static ag_status choose_all(run_context *run, choice_job *job)
{
    ag_status status = parallel_for(run, job->c->runs, RUNS_PER_BLOCK, choose_block, job, AG_PHASE_MAP, 0.0, 0.0);
    return status == AG_OK && run_is_cancelled(run) ? AG_CANCELLED : status; /* the last blocks may be incomplete */
}

/* Turns the blocks' counts into their first indices; returns the sum. */
static uint32_t sum_counts(uint32_t *counts, uint32_t block_count)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < block_count; i++) {
        uint32_t count = counts[i];
        counts[i] = sum;
        sum += count;
    }
    return sum;
}

ag_status irradiance_photons_create(run_context *run, const photon_tree *photons, float fraction, float reach,
                                    float min_cos, double progress, photon_tree *out_irradiance_photons)
{
    choice c = {run, photons, irradiance_photons_runs(photons->count, fraction), reach * reach, min_cos};
    uint32_t block_count = c.runs / RUNS_PER_BLOCK + 1;
    choice_job job = {&c, calloc(block_count, sizeof *job.begins), NULL};
    if (!job.begins)
        return AG_ERROR_MEMORY;
    ag_status status = choose_all(run, &job);
    photon *records = NULL;
    if (status == AG_OK) {
        uint32_t count = sum_counts(job.begins, block_count);
        records = job.records = photon_records_create(count);
        status = records ? choose_all(run, &job) : AG_ERROR_MEMORY;
        if (status == AG_OK)
            status = photon_tree_build(run, records, count, progress, progress, out_irradiance_photons);
    }
    free(job.begins);
    if (status != AG_OK)
        free(records);
    return status;
}
