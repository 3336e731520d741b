/* clear_space.h: a ball around a point of a surface, into which nothing else reaches but what lies below: whether short
 * rays there meet something is known without casting them. Each answer is the one that a ray would have given.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 6.2 (spheres); Ericson,
 * "Real-Time Collision Detection", 2005, ch. 5.1.5 (the point of a triangle that is nearest to another).
 * Flow: bvh -> [here] -> photonmap. Threads: pure functions of the scene. */
#ifndef AFTERGLOW_CLEAR_SPACE_H
#define AFTERGLOW_CLEAR_SPACE_H

#include "scene.h"

enum { CLEAR_SPACE_PLANES = 3 };

typedef struct clear_space_plane {
    vec3 normal; /* unit, to the clear side */
    float height;
} clear_space_plane;

/* The part of a ball that lies above some planes, and, of a sphere, outside of it: no other surface reaches into it,
 * but for a margin that covers what rounding makes of hits. */
typedef struct clear_space {
    vec3 center;
    float radius;                          /* of the ball around the point, scene units; 0: nothing is known */
    float margin;                          /* scene units: the most that rounding makes of its surface's place, and
                                            * of what lies level with it */
    uint32_t shape_index, primitive_index; /* of the surface itself: a triangle, whose plane is the first one, or a
                                            * whole sphere */
    uint32_t plane_count;
    clear_space_plane plane[CLEAR_SPACE_PLANES];
} clear_space;

/* Returns whether anything is known at all: not of scenes with instances, curves, many spheres, or meshes
 * whose vertices move. */
bool clear_space_is_told(const scene *s);

/* Finds the space at a point of a surface, on the side of its normal, which need not be exact, and no farther than
 * `radius`. Nothing is known where the surface has holes, or a material through which rays pass unbent. */
void clear_space_find(const scene *s, vec3 center, vec3 normal, float radius, clear_space *out_space);

/* Returns whether a straight line is known to meet nothing. */
bool clear_space_has_line(const scene *s, const clear_space *space, vec3 from, vec3 to);

/* Returns whether a ray is known to meet the surface itself, which is opaque, before anything else and within
 * `farthest`, and against its normal: the cosine of their angle is greater than min_cos. direction: unit. */
bool clear_space_ends_ray(const scene *s, const clear_space *space, vec3 origin, vec3 direction, float farthest,
                          float min_cos);

/* Returns whether all of a disc around a point of the surface itself is known to be surface, seen from the side of
 * `normal`, with nothing above it: any line from the point along the surface, up to as far as the radius and lifted by
 * at most a sixteenth of it, meets nothing, and any ray from there down onto the surface, out to `share` of the radius,
 * ends at it within the ball of that radius, as clear_space_ends_ray has it. share: < 1. */
bool clear_space_holds_disc(const scene *s, const clear_space *space, vec3 position, vec3 normal, float radius,
                            float share, float min_cos);

#endif
