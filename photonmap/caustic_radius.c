/* caustic_radius.c: see caustic_radius.h. */
#include "caustic_radius.h"

#include "irradiance_estimate.h"
#include "photon_survey.h"
#include "status.h"

#include <math.h>

/* One of this many photons of the global map is darker than the dim irradiance. */
enum { DIM_ONE_IN = 20 };

/* [W/m^2] of the channel that is largest. */
static float irradiance_at(const photon_map *global, vec3 position, vec3 normal, photon_neighbor *scratch)
{
    return rgb_max(irradiance_estimate(global, position, normal, scratch));
}

ag_status caustic_radius_find(const photon_map *global, const photon_set *caustic, float *out_radius)
{
    *out_radius = global->max_radius;
    if (global->set.count == 0 || caustic->count == 0)
        return AG_OK;
    float found[PHOTON_SURVEY_MAX];
    uint32_t count;
    AG_TRY(photon_survey(global, irradiance_at, found, &count));
    const float dim = found[count / DIM_ONE_IN];
    double flux = 0.0;
    for (uint32_t i = 0; i < caustic->count; i++)
        flux += (double)rgb_max(flux_decode(caustic->photons[i].flux));
    double each = flux / ((double)caustic->count * (double)caustic->emitted_paths);
    float radius = (float)sqrt((double)global->nearest * each / ((double)AG_PI * (double)dim));
    if (radius > 0.0f && radius < *out_radius)
        *out_radius = radius;
    return AG_OK;
}
