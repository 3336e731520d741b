/* texture_checkerboard.h: of cells of side 1 in the plane or in space, the share of odd ones over a ray's footprint.
 * The mean over a box that lies along the cells is a product of integrals of one dimension each; a footprint is taken
 * as some such boxes, which have its extent. Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed.,
 * 2023, 10.4.4 (checkerboards over boxes); McCormack et al., "Feline", SIGGRAPH 1999 (probes along the longer axis).
 * Flow: texture -> [here]. Threads: pure functions. */
#ifndef AFTERGLOW_TEXTURE_CHECKERBOARD_H
#define AFTERGLOW_TEXTURE_CHECKERBOARD_H

#include "math/vec3.h"

#include <stdbool.h>

/* Whether the cell of p is odd. In the plane p.z is within (0, 1). */
bool checkerboard_is_odd(vec3 p);

/* From 0 to 1, over a rectangle around p, in cells: its sides are the axes of the ellipse with these conjugate
 * diameters. In the plane, where is_solid is false, their z is 0. Where boxes would not
 * tell the footprint's cells from those beside it, points stand for it, so that the mean over many rays stays right. */
float checkerboard_odd_share(vec3 p, const vec3 axes[2], bool is_solid);

#endif
