/* slab_faces.h: which surfaces are faces of slabs, plates of smooth glass that are thin beside their extent, and which
 * rays pass such a slab straight: those that enter by one face and whose straight continuation leaves by another of the
 * same material with the opposite normal, with nothing between. The answer is the same for both directions of a line,
 * and for shadow rays, scattered rays and photons. Where the line leaves otherwise (by a rim, into a frame) or the
 * glass is as thick as a block, light is refracted and traced.
 * Rests on: material/slab.h for what a slab lets through.
 * Flow: scene_commit finds the faces; transmittance.c asks where rays meet them. Threads: read-only once found. */
#ifndef AFTERGLOW_SLAB_FACES_H
#define AFTERGLOW_SLAB_FACES_H

#include "rays/rays.h"
#include "scene.h"

/* A slab's thickness is at most the width of its faces over this; the width is their area over the diagonal of a box
 * around them (0.7 of a square's side). */
#define SLAB_WIDTH_OVER_THICKNESS_MIN 16.0f

typedef struct slab_faces slab_faces;

/* Finds the slabs of a scene whose tree is built. *out_faces is NULL where it has none. Errors: AG_ERROR_MEMORY,
 * AG_CANCELLED. */
ag_status slab_faces_find(const scene *s, run_context *run, slab_faces **out_faces);
void slab_faces_destroy(slab_faces *f); /* NULL is fine */

/* Returns the share of a material's surface area that are faces of slabs, without instances. */
double slab_faces_share(const scene *s, uint32_t material_index);

/* Sets the hit's slab where the ray, of unit direction, has met a slab that it passes straight. */
void slab_faces_meet(const scene *s, const scene_ray *ray, surface_hit *in_out_hit);

/* slab_faces_meet for scenes that may have no slabs, and for rays that treat slabs as solid glass. */
static inline void slab_meet(const scene *s, const scene_ray *ray, surface_hit *in_out_hit)
{
    if (s->slab_faces && ray->slabs_are_panes)
        slab_faces_meet(s, ray, in_out_hit);
}

#endif
