/* caustic_radius.c: see caustic_radius.h. */
#include "caustic_radius.h"

#include "irradiance_estimate.h"
#include "math/compare_floats.h"
#include "status.h"

#include <math.h>
#include <stdlib.h>

/* Irradiance is asked for at so many photons of the global map; dim are the darkest of them, one in so many. */
enum { SAMPLES = 255, DIM_ONE_IN = 20 };

/* [W/m^2] of the channel that is largest. */
static ag_status find_dim_irradiance(const photon_map *global, float *out_irradiance)
{
    float found[SAMPLES];
    uint32_t count = global->set.count < SAMPLES ? global->set.count : SAMPLES;
    photon_neighbor *scratch = malloc(photon_map_scratch_count(global) * sizeof *scratch);
    if (!scratch)
        return AG_ERROR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t index = (uint32_t)((uint64_t)i * global->set.count / count);
        vec3 normal = direction_decode(photon_block_normal(global->blocks, index));
        found[i] = rgb_max(irradiance_estimate(global, photon_block_position(global->blocks, index), normal, scratch));
    }
    free(scratch);
    qsort(found, count, sizeof *found, compare_floats);
    *out_irradiance = found[count / DIM_ONE_IN];
    return AG_OK;
}

ag_status caustic_radius_find(const photon_map *global, const photon_set *caustic, float *out_radius)
{
    *out_radius = global->max_radius;
    if (global->set.count == 0 || caustic->count == 0)
        return AG_OK;
    float dim = 0.0f;
    AG_TRY(find_dim_irradiance(global, &dim));
    double flux = 0.0;
    for (uint32_t i = 0; i < caustic->count; i++)
        flux += (double)rgb_max(flux_decode(caustic->photons[i].flux));
    double each = flux / ((double)caustic->count * (double)caustic->emitted_paths);
    float radius = (float)sqrt((double)global->nearest * each / ((double)AG_PI * (double)dim));
    if (radius > 0.0f && radius < *out_radius)
        *out_radius = radius;
    return AG_OK;
}
