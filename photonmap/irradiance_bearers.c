/* irradiance_bearers.c: see irradiance_bearers.h. */
#include "irradiance_bearers.h"

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

static bool stands_for(const choice *c, vec3 position, vec3 normal, uint32_t other)
{
    vec3 its_normal = direction_decode(photon_block_normal(c->photons->blocks, other));
    return vec3_distance_squared(position, photon_block_position(c->photons->blocks, other)) <= c->reach_squared &&
           vec3_dot(normal, its_normal) > c->min_cos;
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

/* The bearers of a run of photons, as records, where there is room for them. Returns how many they are; when cancelled,
 * how many it got to. */
static uint32_t choose(const choice *c, uint32_t run, photon *records)
{
    const photon_block *blocks = c->photons->blocks;
    uint64_t all = c->photons->count, begin = run * all / c->runs, end = (run + 1) * all / c->runs;
    uint32_t pick = (uint32_t)(begin + ((hash_mix64(run + UINT64_C(0x62656172)) >> 32) * (end - begin) >> 32));
    vec3 position = photon_block_position(blocks, pick), normal = direction_decode(photon_block_normal(blocks, pick));
    uint32_t count = 0;
    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++) {
        if ((i & CANCEL_MASK) == 0 && run_is_cancelled(c->run))
            break;
        if (i != pick && stands_for(c, position, normal, i))
            continue;
        if (records)
            records[count] = record_of(c->photons, i);
        count++;
    }
    return count;
}

/* All of them in a row; false when cancelled. */
static bool choose_all(const choice *c, photon *records, uint32_t *out_count)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < c->runs && !run_is_cancelled(c->run); i++)
        count += choose(c, i, records ? records + count : NULL);
    *out_count = count;
    return !run_is_cancelled(c->run);
}

ag_status irradiance_bearers_create(run_context *run, const photon_tree *photons, float fraction, float reach,
                                    float min_cos, double progress, photon_tree *out_bearers)
{
    choice c = {run, photons, irradiance_bearers_runs(photons->count, fraction), reach * reach, min_cos};
    uint32_t count;
    if (!choose_all(&c, NULL, &count))
        return AG_CANCELLED;
    photon *records = photon_records_create(count);
    if (!records)
        return AG_ERROR_MEMORY;
    ag_status status = AG_CANCELLED;
    if (choose_all(&c, records, &count))
        status = photon_tree_build(run, records, count, progress, progress, out_bearers);
    if (status != AG_OK)
        free(records);
    return status;
}
