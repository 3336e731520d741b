/* fingerprint_scene.h: the small built-in scene on which the fingerprint of photons and estimates is taken.
 * Flow: [here] -> estimate_fingerprint. Threads: one; the run's workers build the tree.
 *
 * A heap of discs: a large one, the floor, and smaller ones over and through it, flat, nearly flat or at any angle,
 * most of them less than a hundredth above or below it. So estimates meet all that they have rules for: walls, corners,
 * ledges, floors close above each other, surfaces that end. Most discs are diffuse; others have cut-outs or are partly
 * there by alpha, are metal, thin glass, or coated with a texture, or transmit light diffusely. Above them hang a ball
 * of glass and a ball of fog. Lamps of five kinds send light. All shapes are quadrics, whose hits are computed here, so
 * that no instruction set of ray traversal changes them. */
#ifndef AFTERGLOW_FINGERPRINT_SCENE_H
#define AFTERGLOW_FINGERPRINT_SCENE_H

#include "scene.h"

enum { FINGERPRINT_DISCS = 64 };

/* A disc in a frame whose z is its normal; the first is the floor. */
typedef struct fingerprint_disc {
    vec3 center;
    frame axes;
    float radius;
} fingerprint_disc;

/* Makes the scene, committed, and tells where its discs are. isa: as scene_commit takes it. Errors: AG_ERROR_MEMORY,
 * AG_ERROR_RAY_TRACING. */
ag_status fingerprint_scene_create(run_context *run, const char *isa, fingerprint_disc out_discs[FINGERPRINT_DISCS],
                                   scene **out_scene);

#endif
