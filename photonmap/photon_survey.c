/* photon_survey.c: see photon_survey.h. */
#include "photon_survey.h"

#include "math/compare_floats.h"

#include <stdlib.h>

ag_status photon_survey(const photon_map *map, photon_survey_measure *measure, float out_sorted[PHOTON_SURVEY_MAX],
                        uint32_t *out_count)
{
    const uint32_t all = map->set.count, count = all < PHOTON_SURVEY_MAX ? all : PHOTON_SURVEY_MAX;
    photon_neighbor *scratch = malloc(photon_map_scratch_count(map) * sizeof *scratch);
    if (!scratch)
        return AG_ERROR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t index = (uint32_t)((uint64_t)i * all / count);
        const vec3 normal = direction_decode(photon_block_normal(map->blocks, index));
        out_sorted[i] = measure(map, photon_block_position(map->blocks, index), normal, scratch);
    }
    free(scratch);
    qsort(out_sorted, count, sizeof *out_sorted, compare_floats);
    *out_count = count;
    return AG_OK;
}
