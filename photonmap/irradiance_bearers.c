/* irradiance_bearers.c: see irradiance_bearers.h. */
#include "irradiance_bearers.h"

#include "parallel_for.h"

#include <stdlib.h>

uint32_t irradiance_bearers_runs(uint32_t photon_count, float fraction)
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

/* A bearer that stands for photons around it. */
typedef struct chosen {
    vec3 position, normal;
} chosen;

static chosen chosen_at(const choice *c, uint32_t index)
{
    const photon_block *blocks = c->photons->blocks;
    return (chosen){photon_block_position(blocks, index), direction_decode(photon_block_normal(blocks, index))};
}

static bool stands_for(const choice *c, const chosen *bearer, const chosen *other)
{
    return vec3_distance_squared(bearer->position, other->position) <= c->reach_squared &&
           vec3_dot(bearer->normal, other->normal) > c->min_cos;
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

/* So many of a run's bearers are asked whether they stand for a photon: its pick, and the last ones. */
enum { ASKED = 8 };

/* The bearers of a run of photons, as records, where there is room for them: its pick, and of what that does not stand
 * for, what none before stands for. Returns how many they are; when cancelled, how many it got to. */
static uint32_t choose(const choice *c, uint32_t run, photon *records)
{
    uint64_t all = c->photons->count, begin = run * all / c->runs, end = (run + 1) * all / c->runs;
    uint32_t pick = (uint32_t)(begin + ((hash_mix64(run + UINT64_C(0x62656172)) >> 32) * (end - begin) >> 32));
    chosen asked[ASKED] = {chosen_at(c, pick)};
    uint32_t count = 0, asked_count = 1, oldest = 1;
    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++) {
        if ((i & CANCEL_MASK) == 0 && run_is_cancelled(c->run))
            break;
        if (i != pick) {
            chosen at = chosen_at(c, i);
            bool is_borne = false;
            for (uint32_t k = 0; k < asked_count && !is_borne; k++)
                is_borne = stands_for(c, &asked[k], &at);
            if (is_borne)
                continue;
            if (asked_count < ASKED) {
                asked[asked_count++] = at;
            } else {
                asked[oldest] = at;
                oldest = oldest + 1 < ASKED ? oldest + 1 : 1;
            }
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
    uint32_t *places; /* by block: how many its bearers are, then where the first one lies */
    photon *records;  /* NULL while they are counted */
} choice_job;

static void choose_block(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)worker;
    const choice_job *job = user;
    uint32_t count = 0;
    for (uint64_t i = begin; i < end && !run_is_cancelled(job->c->run); i++)
        count += choose(job->c, (uint32_t)i, job->records ? job->records + job->places[block] + count : NULL);
    if (!job->records)
        job->places[block] = count;
}

static ag_status choose_all(run_context *run, choice_job *job)
{
    ag_status status = parallel_for(run, job->c->runs, RUNS_PER_BLOCK, choose_block, job, AG_PHASE_MAP, 0.0, 0.0);
    return status == AG_OK && run_is_cancelled(run) ? AG_CANCELLED : status; /* the last blocks may be incomplete */
}

/* Makes places of counts; gives how many bearers there are. */
static uint32_t place_blocks(uint32_t *places, uint32_t block_count)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < block_count; i++) {
        uint32_t count = places[i];
        places[i] = sum;
        sum += count;
    }
    return sum;
}

ag_status irradiance_bearers_create(run_context *run, const photon_tree *photons, float fraction, float reach,
                                    float min_cos, double progress, photon_tree *out_bearers)
{
    choice c = {run, photons, irradiance_bearers_runs(photons->count, fraction), reach * reach, min_cos};
    uint32_t block_count = c.runs / RUNS_PER_BLOCK + 1;
    choice_job job = {&c, calloc(block_count, sizeof *job.places), NULL};
    if (!job.places)
        return AG_ERROR_MEMORY;
    ag_status status = choose_all(run, &job);
    photon *records = NULL;
    if (status == AG_OK) {
        uint32_t count = place_blocks(job.places, block_count);
        records = job.records = photon_records_create(count);
        status = records ? choose_all(run, &job) : AG_ERROR_MEMORY;
        if (status == AG_OK)
            status = photon_tree_build(run, records, count, progress, progress, out_bearers);
    }
    free(job.places);
    if (status != AG_OK)
        free(records);
    return status;
}
