/* light_tree.h: picks one of many lamps by what each may send to a point: a tree whose nodes know where their lamps
 * are, which way they shine, and how bright they are. Rests on: Conty Estevez, Kulla, "Importance Sampling of Many
 * Lights with Adaptive Tree Splitting", 2018; Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed.,
 * 2023, 12.6.3. Nodes have eight children, so that few lamps are weighed one by one; and nothing but square roots and
 * quotients is used, so that the bits are the same everywhere. Flow: light_pick makes and asks it. Threads: read-only
 * once created. */
#ifndef AFTERGLOW_LIGHT_TREE_H
#define AFTERGLOW_LIGHT_TREE_H

#include "scene.h"

enum { LIGHT_TREE_WIDTH = 8 };
#define LIGHT_TREE_NONE UINT32_MAX

/* Bounds of lamps: all light leaves from within a ball, and the angle between its way and a direction is no more
 * than the two angles' sum: normals are within the first of the axis, light within the second of a normal. */
typedef struct light_bounds {
    vec3 center;
    float radius;
    vec3 axis;          /* unit */
    float cos_normals;  /* -1: all directions */
    float cos_emission; /* of the angle from a normal beyond which nothing goes */
    float least_cos;    /* brightness goes with the cosine to the normal where it is 0, is even where it is 1 */
    bool two_sided;     /* it shines along -axis as well */
    float intensity;    /* towards where it is brightest, W/sr by the mean of the channels */
} light_bounds;

/* A cosine for all directions; and what is added to bounds for rounding. */
#define LIGHT_BOUNDS_ALL_AROUND (-1.0f)
#define LIGHT_BOUNDS_SLACK      1e-3f

/* The bounds of a committed light; false for lights that are everywhere. */
bool light_find_bounds(const scene *s, const light *l, light_bounds *out_bounds);

typedef struct light_tree light_tree;

/* Makes a tree of the lamps with these indices, all with power and bounds. count > 0. Errors: AG_ERROR_MEMORY. */
ag_status light_tree_create(const scene *s, const uint32_t *lights, uint32_t count, light_tree **out_tree);
void light_tree_destroy(light_tree *t); /* NULL is fine */

/* Whether any of its lamps may send light to a point. normal: unit, of a surface that scatters light from its own side
 * alone, or zero for all sides; so in the following. */
bool light_tree_reaches(const light_tree *t, vec3 point, vec3 normal);
/* A lamp, and the probability with which it is picked; LIGHT_TREE_NONE and 0 where none reaches the point. u in
 * [0,1). */
uint32_t light_tree_pick(const light_tree *t, vec3 point, vec3 normal, float u, float *out_probability);
/* The probability with which light_tree_pick picks a lamp of the tree. */
float light_tree_probability(const light_tree *t, uint32_t light_index, vec3 point, vec3 normal);

#endif
