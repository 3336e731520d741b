/* medium.c: see medium.h. */
#include "medium/medium.h"

#include "material/fresnel.h"
#include "medium/medium_roulette.h"

static float channel_transmittance(float extinction, float distance)
{
    return extinction > 0.0f ? attenuation(extinction * distance) : 1.0f; /* 0 times infinity would be no number */
}

rgb medium_transmittance(const medium *m, float distance)
{
    rgb extinction = medium_extinction(m);
    return (rgb){channel_transmittance(extinction.r, distance), channel_transmittance(extinction.g, distance),
                 channel_transmittance(extinction.b, distance)};
}

void medium_add_hash(const medium *m, hash128 *h)
{
    const int roulette_after = MEDIUM_ROULETTE_AFTER; /* another beginning of roulette gives other photons */
    HASH128_ADD(h, m->sigma_a);
    HASH128_ADD(h, m->sigma_s);
    phase_function_add_hash(&m->phase, h);
    if (medium_scatters(m))
        HASH128_ADD(h, roulette_after);
}
