/* attenuation.h: the share of light that is left behind a medium, by Beer's law. Flow: media, coats -> [here].
 * Threads: pure functions. */
#ifndef AFTERGLOW_ATTENUATION_H
#define AFTERGLOW_ATTENUATION_H

/* e^-x for x >= 0, to float precision, in plain steps (libm's variants differ in the last bit): the 1024th power of a
 * short series. */
static inline float attenuation(float x)
{
    if (!(x < 100.0f))
        return 0.0f;
    double y = (double)x * (1.0 / 1024.0), e = 1.0 - y * (1.0 - y * (0.5 - y * (1.0 / 6.0 - y * (1.0 / 24.0))));
    for (int i = 0; i < 10; i++)
        e *= e;
    return (float)e;
}

#endif
