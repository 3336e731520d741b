/* motion.h: the way from one transform to another while the shutter is open: translation and scale go straight,
 * rotation turns evenly about one axis; and paths of several such ways. Rests on: Shoemake, Duff, "Matrix Animation and
 * Polar Decomposition", 1992; Pharr, Jakob, Humphreys, "Physically Based Rendering", 3rd ed., 2016, 2.9 (animating
 * transformations). Flow: the scene file's two transforms -> [here] -> the steps of an instance, the camera. Threads:
 * pure functions. */
#ifndef AFTERGLOW_MOTION_H
#define AFTERGLOW_MOTION_H

#include "math/affine.h"

#include <stdint.h>

/* At most so many steps stand for a motion: as many as Embree takes. */
enum { MOTION_STEPS_MAX = 129 };

typedef struct motion {
    /* of the first transform and of the last: M = translation rotation stretch */
    double translation[2][3];
    double rotation[2][4]; /* unit quaternions, the real part first, less than half a turn apart */
    double stretch[2][3][3];
    double at_opening, at_closing; /* how much of the way is behind; below 0 and above 1 nothing moves */
} motion;

/* Motions that follow one another and take equally long: at_opening and at_closing of each are as of its own way. */
typedef struct motion_path {
    motion *segments;       /* [segment_count]; whose they are is said where a path is kept */
    uint32_t segment_count; /* at least 1 */
} motion_path;

/* From start to end; at_opening and at_closing as in motion. False where one of them is not affine or cannot be undone,
 * or where they differ in handedness: somewhere on the way there would be no volume. */
bool motion_make(const transform *start, const transform *end, double at_opening, double at_closing,
                 motion *out_motion);

/* The map at a time of the shutter, from 0 at its opening to 1 at its closing. */
void motion_at(const motion *m, double time, double out_matrix[3][4]);

/* motion_at along a path. */
void motion_path_at(const motion_path *path, double time, double out_matrix[3][4]);

/* Fills in evenly spaced steps from the shutter's opening to its closing, between which all goes straight, and returns
 * how many: 1 where nothing moves, and else as many as keep within a ten-thousandth of what is turned or travelled, as
 * long as MOTION_STEPS_MAX are enough. outer is applied behind inner, which may be NULL. */
uint32_t motion_steps(const motion_path *outer, const motion_path *inner, affine out_steps[MOTION_STEPS_MAX]);

#endif
