/* irradiance_bearers.c: see irradiance_bearers.h. */
#include "irradiance_bearers.h"

enum { CANCEL_MASK = 0xffff };

uint32_t irradiance_bearers_count(uint32_t photon_count, float fraction)
{
    if (photon_count == 0 || fraction >= 1.0f)
        return photon_count;
    uint32_t count = (uint32_t)((double)photon_count * (double)fraction + 0.5);
    return count > 0 ? count : 1;
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

ag_status irradiance_bearers_create(run_context *run, const photon_tree *photons, float fraction, double progress,
                                    photon_tree *out_bearers)
{
    uint64_t all = photons->count;
    uint32_t count = irradiance_bearers_count(photons->count, fraction);
    photon *records = photon_records_create(count);
    if (!records)
        return AG_ERROR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        if ((i & CANCEL_MASK) == 0 && run_is_cancelled(run))
            break;
        uint64_t begin = i * all / count, end = (i + 1) * all / count;
        uint64_t pick = (hash_mix64(i + UINT64_C(0x62656172)) >> 32) * (end - begin) >> 32;
        records[i] = record_of(photons, (uint32_t)(begin + pick));
    }
    ag_status status =
        run_is_cancelled(run) ? AG_CANCELLED : photon_tree_build(run, records, count, progress, progress, out_bearers);
    if (status != AG_OK)
        free(records);
    return status;
}
