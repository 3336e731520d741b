/* exponential.h: e^x and the natural logarithm by series of our own: libm's have variants per instruction set that
 * differ in the last bit.
 * Threads: pure functions. */
#ifndef AFTERGLOW_EXPONENTIAL_H
#define AFTERGLOW_EXPONENTIAL_H

#include <math.h>

/* Right to 1e-13 of the value; 0 below -700, and beyond 700 as at 700. */
static inline double exponential(double x)
{
    if (!(x > -700.0))
        return 0.0;
    x = fmin(x, 700.0);
    double power = floor(x * 1.44269504088896340736 + 0.5), r = x - power * 0.69314718055994530942, series = 1.0;
    for (int k = 12; k >= 1; k--)
        series = 1.0 + series * r / k;
    return ldexp(series, (int)power);
}

/* Of x > 0; right to 1e-13. */
static inline double natural_logarithm(double x)
{
    int power;
    double m = frexp(x, &power); /* [1/2, 1) */
    if (m < 0.70710678118654752440) {
        m *= 2.0;
        power--;
    }
    double t = (m - 1.0) / (m + 1.0), t2 = t * t, series = 1.0 / 19;
    for (int k = 17; k >= 1; k -= 2)
        series = 1.0 / k + t2 * series;
    return 2.0 * t * series + power * 0.69314718055994530942;
}

#endif
