/* light_tree.h: picks one of many lamps by the light that each may send to a point: a tree whose nodes bound the
 * positions, directions and intensities of their lamps. Rests on: Conty Estevez, Kulla, "Importance Sampling of Many
 * Lights with Adaptive Tree Splitting", 2018; Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023,
 * 12.6.3. Nodes have eight children, so that few lamps are weighed one by one; and nothing but square roots and
 * quotients is used, so that the bits are the same everywhere. Flow: light_pick makes and asks it. Threads: read-only
 * once created. */
#ifndef AFTERGLOW_LIGHT_TREE_H
#define AFTERGLOW_LIGHT_TREE_H

#include "scene.h"

enum { LIGHT_TREE_WIDTH = 8 };
#define LIGHT_TREE_NONE UINT32_MAX

/* The bounds of lamps: light leaves from within a ball, and the angle between its direction and the axis is at most the
 * sum of two angles: of normals to the axis, and of light to a normal. */
typedef struct light_bounds {
    vec3 center;
    float radius;
    vec3 axis;          /* unit */
    float cos_normals;  /* -1: all directions */
    float cos_emission; /* cosine of the greatest angle of light to a normal */
    float least_cos;    /* 0: intensity is proportional to the cosine to the normal; 1: it is uniform */
    bool two_sided;     /* it shines along -axis as well */
    float intensity;    /* in the brightest direction, W/sr, mean of the channels */
} light_bounds;

/* A cosine for all directions; and the slack of bounds for rounding. */
#define LIGHT_BOUNDS_ALL_AROUND (-1.0f)
#define LIGHT_BOUNDS_SLACK      1e-3f

/* Finds the bounds of a committed light; returns false for lights without position. */
bool light_find_bounds(const scene *s, const light *l, light_bounds *out_bounds);

typedef struct light_tree light_tree;

/* Builds a tree of the lamps with these indices, all with power and bounds. count > 0. Errors: AG_ERROR_MEMORY. */
ag_status light_tree_create(const scene *s, const uint32_t *lights, uint32_t count, light_tree **out_tree);
void light_tree_destroy(light_tree *t); /* NULL is fine */

/* Returns whether any of its lamps may send light to a point. normal: unit, of a surface that scatters light only from
 * its own side; or zero for all sides; also below. */
bool light_tree_reaches(const light_tree *t, vec3 point, vec3 normal);
/* Picks a lamp by u in [0,1), and writes its probability; returns LIGHT_TREE_NONE with 0 where none reaches the
 * point. */
uint32_t light_tree_pick(const light_tree *t, vec3 point, vec3 normal, float u, float *out_probability);
/* Returns the probability with which light_tree_pick picks a lamp of the tree. */
float light_tree_probability(const light_tree *t, uint32_t light_index, vec3 point, vec3 normal);

#endif
