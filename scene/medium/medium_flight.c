/* medium_flight.c: see medium_flight.h. */
#include "medium/medium_flight.h"

#include "math/exponential.h"

static float channel_of(rgb color, int channel) { return channel == 0 ? color.r : channel == 1 ? color.g : color.b; }

medium_flight medium_flight_begin(vec2 u)
{
    int channel = (int)(3.0f * u.x);
    return (medium_flight){.channel = channel < 2 ? channel : 2,
                           .thickness = (float)-natural_logarithm(1.0 - (double)u.y),
                           .transmittance = rgb_gray(1.0f),
                           .density = rgb_gray(1.0f)};
}

bool medium_flight_pass(medium_flight *f, const medium *m, float distance, float *out_distance)
{
    if (!medium_scatters(m)) {
        f->transmittance = rgb_mul(f->transmittance, medium_transmittance(m, distance));
        return false;
    }
    rgb extinction = medium_extinction(m);
    float of_channel = channel_of(extinction, f->channel);
    bool is_scattered = of_channel > 0.0f && f->thickness < of_channel * distance;
    if (is_scattered)
        *out_distance = distance = f->thickness / of_channel;
    else if (of_channel > 0.0f)
        f->thickness -= of_channel * distance;
    rgb left = medium_transmittance(m, distance);
    f->transmittance = rgb_mul(f->transmittance, left);
    f->density = rgb_mul(f->density, left);
    if (is_scattered) {
        f->transmittance = rgb_mul(f->transmittance, m->sigma_s);
        f->density = rgb_mul(f->density, extinction);
    }
    return is_scattered;
}

rgb medium_flight_weight(const medium_flight *f)
{
    float density = rgb_mean(f->density);
    return density > 0.0f ? rgb_scale(f->transmittance, 1.0f / density) : rgb_gray(0.0f);
}
