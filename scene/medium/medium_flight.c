/* medium_flight.c: see medium_flight.h. */
#include "medium/medium_flight.h"

#include "math/exponential.h"
#include "medium/medium_type.h"

medium_flight medium_flight_begin(rgb carried, vec2 u)
{
    const float sum = carried.r + carried.g + carried.b;
    rgb probability = sum > 0.0f ? rgb_scale(carried, 1.0f / sum) : rgb_gray(1.0f / 3.0f);
    int channel = u.x < probability.r ? 0 : u.x < probability.r + probability.g ? 1 : 2;
    if (channel == 2 && !(probability.b > 0.0f)) /* by rounding */
        channel = probability.g > 0.0f ? 1 : 0;
    return (medium_flight){.channel = channel,
                           .probability = probability,
                           .thickness = (float)-natural_logarithm(1.0 - (double)u.y),
                           .transmittance = rgb_gray(1.0f),
                           .density = rgb_gray(1.0f)};
}

bool medium_flight_pass(medium_flight *f, const medium *m, const medium_stretch *way, float *out_distance)
{
    if (medium_scatters(m))
        return medium_type_of(m->kind)->pass(m, way, f, out_distance);
    f->transmittance = rgb_mul(f->transmittance, medium_transmittance(m, way));
    return false;
}

rgb medium_flight_weight(const medium_flight *f)
{
    /* channels of less than this probability carry nothing that is seen, and their weight might overflow */
    static const float PROBABILITY_MIN = 1e-20f;
    const rgb p = f->probability, t = f->transmittance;
    float density = p.r * f->density.r + p.g * f->density.g + p.b * f->density.b;
    if (!(density > 0.0f))
        return rgb_gray(0.0f);
    return (rgb){p.r > PROBABILITY_MIN ? t.r / density : 0.0f, p.g > PROBABILITY_MIN ? t.g / density : 0.0f,
                 p.b > PROBABILITY_MIN ? t.b / density : 0.0f};
}
