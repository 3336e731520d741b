/* photon_survey.c: see photon_survey.h. */
#include "photon_survey.h"

#include "math/compare_floats.h"
#include "quarter_octave.h"

#include <stdlib.h>

/* A steady map is measured at about this many photons, chosen by their positions: the same ones where others come and
 * go. */
static const float STEADY_ASKED = 192.0f;

/* The next photon to ask, from `index` on; count: there is none. */
static uint32_t next_steady(const photon_map *map, uint32_t index)
{
    const double share = double_min((double)STEADY_ASKED / (double)quarter_octave_nearest((float)map->set.count), 1.0);
    const uint64_t most = (uint64_t)(share * 0x1p32);
    while (index < map->set.count && photon_block_position_key(map->blocks, index) >> 32 >= most)
        index++;
    return index;
}

ag_status photon_survey(const photon_map *map, photon_survey_measure *measure, float out_sorted[PHOTON_SURVEY_MAX],
                        uint32_t *out_count)
{
    const uint32_t all = map->set.count, most = all < PHOTON_SURVEY_MAX ? all : PHOTON_SURVEY_MAX;
    const bool is_steady = map->is_steady && all > PHOTON_SURVEY_MAX;
    uint32_t count = 0;
    photon_neighbor *scratch = malloc(photon_map_scratch_count(map) * sizeof *scratch);
    if (!scratch)
        return AG_ERROR_MEMORY;
    for (uint32_t next = 0; count < most; next++) {
        if (is_steady)
            next = next_steady(map, next);
        if (next >= all && count > 0)
            break;
        const uint32_t index = next >= all ? 0 : is_steady ? next : (uint32_t)((uint64_t)next * all / most);
        const vec3 normal = direction_decode(photon_block_normal(map->blocks, index));
        out_sorted[count++] = measure(map, photon_block_position(map->blocks, index), normal, scratch);
    }
    free(scratch);
    qsort(out_sorted, count, sizeof *out_sorted, compare_floats);
    *out_count = count;
    return AG_OK;
}
