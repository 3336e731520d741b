/* room_layout.h: where the spheres of the forty rooms stand: room n holds the first n of one fixed list.
 * After the test suite of Neilson & Yang, "Beyond Faster Photon Map Global Illumination" (TR 04-21, 2004).
 * Flow: [here] -> room_file -> scene files -> the renderer. Threads: any; no state. */
#ifndef AFTERGLOW_ROOM_LAYOUT_H
#define AFTERGLOW_ROOM_LAYOUT_H

#include "afterglow/base.h"

#include <stdint.h>

#define ROOM_COUNT 40
#define ROOM_SEED  2004u /* of the published rooms; another seed gives another suite */

/* The room is [0, ROOM_SIZE]^3, y up, lengths in the paper's units. The light hangs just under the middle of the
 * ceiling, the eye stands before the middle of the wall z = 0 and looks at the opposite one. */
#define ROOM_SIZE         40.0
#define ROOM_LIGHT_SIZE   5.0
#define ROOM_LIGHT_HEIGHT 39.99
#define ROOM_EYE_X        20.0
#define ROOM_EYE_Y        20.0
#define ROOM_EYE_Z        0.5

#define ROOM_RADIUS_MIN 3.0
#define ROOM_RADIUS_MAX 5.0

/* Sphere 33 is not drawn by lot: "large and close to the light" is what the paper says of it. */
#define ROOM_LARGE_SPHERE 33

/* How near things may come to one another. The eye has room before it, so that no single sphere hides the rest. */
#define ROOM_GAP          0.25 /* sphere to sphere, wall, and the column under the light */
#define ROOM_EYE_GAP      8.0  /* eye to the nearest point of a sphere */
#define ROOM_COLUMN_DEPTH 10.0 /* the column under the light: its square, this far down from the ceiling */

typedef struct room_sphere {
    double center[3]; /* multiples of 1/1000, so that a file with three decimals holds them exactly */
    double radius;    /* in [ROOM_RADIUS_MIN, ROOM_RADIUS_MAX], a multiple of 1/1000 */
} room_sphere;

/* The smallest distances between surfaces, negative where two overlap; HUGE_VAL where there is nothing to measure. */
typedef struct room_clearance {
    double wall;   /* sphere to wall, floor or ceiling */
    double sphere; /* sphere to sphere */
    double eye;    /* sphere to eye */
    double light;  /* sphere to light */
} room_clearance;

/* Fills all ROOM_COUNT spheres. Every gap above holds, sphere 33 included, which keeps its position from the beginning.
 * The room is the same on every machine. Errors: AG_ERROR_SCENE when a seed leaves no room for some sphere (never
 * ROOM_SEED). */
ag_status room_layout_place(uint64_t seed, room_sphere out_spheres[ROOM_COUNT]);

/* Measures the first count spheres against everything, without use of what placing them has checked. */
room_clearance room_layout_clearance(const room_sphere *spheres, int count);

#endif
