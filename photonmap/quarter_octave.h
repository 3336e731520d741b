/* quarter_octave.h: numbers rounded to a few values, so that what is worked out of them stays the same while they
 * change a little, from frame to frame of an animation. Flow: photon_map, photon_path. Threads: pure. */
#ifndef AFTERGLOW_QUARTER_OCTAVE_H
#define AFTERGLOW_QUARTER_OCTAVE_H

#include <math.h>

/* The power of 2^(1/4) that is nearest to x by their ratio: within 10 % of it. 0, infinity and what is negative or no
 * number stay as they are. */
static inline float quarter_octave_nearest(float x)
{
    static const float BETWEEN[4] = {0.54525387f, 0.64841980f, 0.77110541f, 0.91700404f};
    static const float STEPS[5] = {0.5f, 0.59460356f, 0.70710678f, 0.84089642f, 1.0f};
    int exponent, step = 0;
    if (!(x > 0.0f) || isinf(x))
        return x;
    float fraction = frexpf(x, &exponent);
    while (step < 4 && fraction > BETWEEN[step])
        step++;
    return ldexpf(STEPS[step], exponent);
}

#endif
