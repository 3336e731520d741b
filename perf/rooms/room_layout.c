/* room_layout.c: rejection sampling of forty spheres, driven by a hash of (seed, sphere, attempt, axis).
 * After the test suite of Neilson & Yang (TR 04-21, 2004); the paper tells sizes and counts, not positions.
 * Flow: [here] -> room_file. Threads: any; no state. */
#include "rooms/room_layout.h"

#include <math.h>
#include <stdbool.h>

#define ATTEMPT_COUNT 100000 /* a sphere of the fixed seed needs a few hundred at most */

/* A bijection of 64-bit words in which each input bit reaches every output bit: three rounds of folding the upper half
 * down and multiplying. The constants are the fractions of the square roots of 2, 3, 5 and 7, made odd. */
static uint64_t mix(uint64_t word)
{
    word += UINT64_C(0xa54ff53a5f1d36f1);
    word = (word ^ (word >> 31)) * UINT64_C(0x6a09e667f3bcc909);
    word = (word ^ (word >> 29)) * UINT64_C(0xbb67ae8584caa73b);
    word = (word ^ (word >> 32)) * UINT64_C(0x3c6ef372fe94f82b);
    return word ^ (word >> 30);
}

/* Uniform in [0, 1), a function of its arguments alone: one sphere's position never shifts the numbers of another. */
static double unit_number(uint64_t seed, int sphere, int attempt, int axis)
{
    uint64_t word = mix(seed);
    word = mix(word ^ (uint64_t)sphere);
    word = mix(word ^ ((uint64_t)attempt * 4u + (uint64_t)axis));
    return (double)(word >> 11) * 0x1p-53;
}

static double to_thousandths(double value) { return floor(value * 1000.0 + 0.5) / 1000.0; }

static double sphere_to_sphere(const room_sphere *a, const room_sphere *b)
{
    const double dx = a->center[0] - b->center[0];
    const double dy = a->center[1] - b->center[1];
    const double dz = a->center[2] - b->center[2];
    return sqrt(dx * dx + dy * dy + dz * dz) - a->radius - b->radius;
}

/* The distance from a sphere within the room to the nearest of the room's six sides. */
static double sphere_to_wall(const room_sphere *sphere)
{
    double nearest = HUGE_VAL;
    for (int axis = 0; axis < 3; ++axis) {
        nearest = fmin(nearest, sphere->center[axis]);
        nearest = fmin(nearest, ROOM_SIZE - sphere->center[axis]);
    }
    return nearest - sphere->radius;
}

static double sphere_to_eye(const room_sphere *sphere)
{
    const room_sphere eye = {{ROOM_EYE_X, ROOM_EYE_Y, ROOM_EYE_Z}, 0.0};
    return sphere_to_sphere(sphere, &eye);
}

/* The distance from a sphere to the box under the light's square, down to height bottom; to the square itself where
 * that is its own height. */
static double sphere_to_light_column(const room_sphere *sphere, double bottom, double top)
{
    const double low[3] = {0.5 * (ROOM_SIZE - ROOM_LIGHT_SIZE), bottom, 0.5 * (ROOM_SIZE - ROOM_LIGHT_SIZE)};
    const double high[3] = {0.5 * (ROOM_SIZE + ROOM_LIGHT_SIZE), top, 0.5 * (ROOM_SIZE + ROOM_LIGHT_SIZE)};
    double distance_squared = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double outside = fmax(fmax(low[axis] - sphere->center[axis], sphere->center[axis] - high[axis]), 0.0);
        distance_squared += outside * outside;
    }
    return sqrt(distance_squared) - sphere->radius;
}

static room_sphere large_sphere(void)
{
    const room_sphere sphere = {{0.5 * ROOM_SIZE, 33.0, 0.5 * ROOM_SIZE}, ROOM_RADIUS_MAX};
    return sphere;
}

/* Whether a drawn sphere may stand with the placed ones before it and the large one, which stands already. */
static bool is_free(const room_sphere *candidate, const room_sphere *placed, int placed_count)
{
    const room_sphere large = large_sphere();
    if (sphere_to_wall(candidate) < ROOM_GAP || sphere_to_eye(candidate) < ROOM_EYE_GAP ||
        sphere_to_light_column(candidate, ROOM_SIZE - ROOM_COLUMN_DEPTH, ROOM_SIZE) < ROOM_GAP ||
        sphere_to_sphere(candidate, &large) < ROOM_GAP) {
        return false;
    }
    for (int i = 0; i < placed_count; ++i) {
        if (sphere_to_sphere(candidate, &placed[i]) < ROOM_GAP) {
            return false;
        }
    }
    return true;
}

ag_status room_layout_place(uint64_t seed, room_sphere out_spheres[ROOM_COUNT])
{
    for (int i = 0; i < ROOM_COUNT; ++i) {
        const int number = i + 1;
        if (number == ROOM_LARGE_SPHERE) {
            out_spheres[i] = large_sphere();
            continue;
        }
        /* The radius is drawn once, not at each attempt: else the crowded rooms would favour small spheres. */
        room_sphere candidate;
        candidate.radius =
            to_thousandths(ROOM_RADIUS_MIN + (ROOM_RADIUS_MAX - ROOM_RADIUS_MIN) * unit_number(seed, number, 0, 3));
        bool placed = false;
        for (int attempt = 0; attempt < ATTEMPT_COUNT && !placed; ++attempt) {
            for (int axis = 0; axis < 3; ++axis) {
                candidate.center[axis] = to_thousandths(ROOM_SIZE * unit_number(seed, number, attempt, axis));
            }
            placed = is_free(&candidate, out_spheres, i);
        }
        if (!placed) {
            return AG_ERROR_SCENE;
        }
        out_spheres[i] = candidate;
    }
    return AG_OK;
}

room_clearance room_layout_clearance(const room_sphere *spheres, int count)
{
    room_clearance clearance = {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
    for (int i = 0; i < count; ++i) {
        clearance.wall = fmin(clearance.wall, sphere_to_wall(&spheres[i]));
        clearance.eye = fmin(clearance.eye, sphere_to_eye(&spheres[i]));
        clearance.light =
            fmin(clearance.light, sphere_to_light_column(&spheres[i], ROOM_LIGHT_HEIGHT, ROOM_LIGHT_HEIGHT));
        for (int j = 0; j < i; ++j) {
            clearance.sphere = fmin(clearance.sphere, sphere_to_sphere(&spheres[i], &spheres[j]));
        }
    }
    return clearance;
}
