/* slab_faces.h: which surfaces are faces of slabs, plates of smooth glass that are thin beside their extent, and which
 * rays pass such a slab straight: those that enter by one face and whose straight continuation leaves by another of the
 * same material with the opposite normal, with nothing between. So it is the same for a line in both of its directions:
 * shadow rays, scattered rays and photons ask alike. Where the line leaves otherwise (by a rim, into a frame) or the
 * glass is as thick as a block, light is refracted and traced.
 * Rests on: material/slab.h for what a slab lets through.
 * Flow: scene_commit finds the faces; transmittance.c asks where rays meet them. Threads: read-only once found. */
#ifndef AFTERGLOW_SLAB_FACES_H
#define AFTERGLOW_SLAB_FACES_H

#include "rays/rays.h"
#include "scene.h"

/* A slab is at most the width of its faces over this thick; their width is their area over the diagonal of a box around
 * them (of a square, 0.7 of its side). */
#define SLAB_WIDTH_OVER_THICKNESS_MIN 16.0f

typedef struct slab_faces slab_faces;

/* Looks through a scene whose tree stands. *out_faces is NULL where it has no slabs. Errors: AG_ERROR_MEMORY,
 * AG_CANCELLED. */
ag_status slab_faces_find(const scene *s, run_context *run, slab_faces **out_faces);
void slab_faces_destroy(slab_faces *f); /* NULL is fine */

/* The share of the area of all surfaces of a material that are faces of slabs, instances not counted. */
double slab_faces_share(const scene *s, uint32_t material_index);

/* Fills in the hit's slab where the ray, of unit direction, has met a slab that it passes straight. */
void slab_faces_meet(const scene *s, const scene_ray *ray, surface_hit *in_out_hit);

/* slab_faces_meet for scenes that may have no slabs, and for rays that see slabs as the glass they are. */
static inline void slab_meet(const scene *s, const scene_ray *ray, surface_hit *in_out_hit)
{
    if (s->slab_faces && ray->slabs_are_panes)
        slab_faces_meet(s, ray, in_out_hit);
}

#endif
