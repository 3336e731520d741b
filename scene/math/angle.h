/* angle.h: the angle of a direction in the plane, by a series of our own: libm's atan2 has variants per instruction set
 * that differ in the last bit.
 * Threads: pure functions. */
#ifndef AFTERGLOW_ANGLE_H
#define AFTERGLOW_ANGLE_H

#include "math/min_max.h"

#include <math.h>

/* atan2(y, x) / (2 pi), counted from the x axis to the y axis and on: in [0, 1]. Right to 2e-11; 0 where both are 0. */
static inline double angle_turns(double y, double x)
{
    double ax = fabs(x), ay = fabs(y), high = double_max(ax, ay), t = double_min(ax, ay), turns = 0.0;
    if (!(high > 0.0))
        return 0.0;
    t /= high;
    if (t > 0.41421356237309504880) { /* tan(pi/8): the rest of the octant by the angle from its diagonal */
        t = (t - 1.0) / (t + 1.0);
        turns = 0.125;
    }
    double t2 = t * t, series = 1.0 / 21;
    for (int k = 19; k >= 1; k -= 2)
        series = 1.0 / k - t2 * series;
    turns += t * series * 0.15915494309189533577;
    if (ay > ax)
        turns = 0.25 - turns;
    if (x < 0.0)
        turns = 0.5 - turns;
    return y < 0.0 ? 1.0 - turns : turns;
}

#endif
