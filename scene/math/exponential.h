/* exponential.h: e^x and the natural logarithm by series of our own: libm's have variants per instruction set that
 * differ in the last bit.
 * Threads: pure functions. */
#ifndef AFTERGLOW_EXPONENTIAL_H
#define AFTERGLOW_EXPONENTIAL_H

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Right to 1e-13 of the value; 0 below -700, and beyond 700 as at 700. Taylor's series about the nearest power of 2. */
static inline double exponential(double x)
{
    if (!(x > -700.0))
        return 0.0;
    x = x < 700.0 ? x : 700.0;
    double power = floor(x * 1.44269504088896340736 + 0.5), r = x - power * 0.69314718055994530942, r2 = r * r;
    double low = 1.0 + r + r2 * (1.0 / 2 + r * (1.0 / 6)) + r2 * r2 * (1.0 / 24 + r * (1.0 / 120));
    double high = 1.0 / 720 + r * (1.0 / 5040) + r2 * (1.0 / 40320 + r * (1.0 / 362880)) +
                  r2 * r2 * (1.0 / 3628800 + r * (1.0 / 39916800));
    uint64_t bits = (uint64_t)((int64_t)power + 1023) << 52;
    double two_to_power;
    memcpy(&two_to_power, &bits, sizeof two_to_power);
    return (low + r2 * r2 * r2 * high) * two_to_power;
}

/* The logarithm of x > 0, right to 1e-13. */
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
