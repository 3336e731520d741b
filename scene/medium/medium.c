/* medium.c: see medium.h. */
#include "medium/medium.h"

#include "material/fresnel.h"

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
