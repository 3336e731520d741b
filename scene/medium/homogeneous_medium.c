/* homogeneous_medium.c: a medium that is the same all over: Beer's law, and flights whose lengths have its density.
 * Threads: pure functions. */
#include "math/attenuation.h"
#include "medium/medium_type.h"

static rgb extinction_of(const medium *m) { return rgb_add(m->as.homogeneous.sigma_a, m->as.homogeneous.sigma_s); }

static float channel_transmittance(float extinction, float distance)
{
    return extinction > 0.0f ? attenuation(extinction * distance) : 1.0f; /* 0 times infinity would be no number */
}

static rgb transmittance_over(rgb extinction, float distance)
{
    return (rgb){channel_transmittance(extinction.r, distance), channel_transmittance(extinction.g, distance),
                 channel_transmittance(extinction.b, distance)};
}

static void add_hash(const medium *m, hash128 *h)
{
    HASH128_ADD(h, m->as.homogeneous.sigma_a);
    HASH128_ADD(h, m->as.homogeneous.sigma_s);
}

static bool scatters(const medium *m) { return !rgb_is_black(m->as.homogeneous.sigma_s); }

static rgb transmittance(const medium *m, const medium_stretch *way)
{
    return transmittance_over(extinction_of(m), way->length);
}

static bool pass(const medium *m, const medium_stretch *way, medium_flight *f, float *out_distance)
{
    rgb extinction = extinction_of(m);
    float of_channel = medium_channel(extinction, f->channel), distance = way->length;
    bool is_scattered = of_channel > 0.0f && f->thickness < of_channel * distance;
    if (is_scattered)
        *out_distance = distance = f->thickness / of_channel;
    else if (of_channel > 0.0f)
        f->thickness -= of_channel * distance;
    medium_flight_go(f, transmittance_over(extinction, distance));
    if (is_scattered)
        medium_flight_scatter(f, m->as.homogeneous.sigma_s, extinction);
    return is_scattered;
}

const medium_type homogeneous_medium = {
    .add_hash = add_hash, .scatters = scatters, .transmittance = transmittance, .pass = pass};
