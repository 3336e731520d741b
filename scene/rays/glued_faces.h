/* glued_faces.h: glass that lies flush on an opaque face, as a table top on its table, a cover on a print or a bottle's
 * bottom on a shelf, and fog that ends at walls. Both faces are met at one distance, and chance would choose: a ray
 * that passes the glass there starts beyond the opaque face, and misses it. So wherever a ray meets such glass, the
 * opaque face at the same distance counts in its place, as if the two were glued: no light is refracted between them,
 * and a ray that leaves the opaque face starts in the glass, in the medium in which the light has come. A thin pane
 * does nothing there. The rule is the same for all rays, of the eye, of photons and of shadows. Flow: scene_commit
 * finds such glass; rays_embree.c asks at each hit of it. Threads: pure but for the search. */
#ifndef AFTERGLOW_GLUED_FACES_H
#define AFTERGLOW_GLUED_FACES_H

#include "rays/rays.h"
#include "scene.h"

/* Sets the roles of all shapes, which of them are glued, and s->has_glued_faces, of a scene whose tree is built. Warns
 * of translucent shapes (paper, leaves) on opaque faces: there is no rule for these. Errors: AG_CANCELLED. */
ag_status glued_faces_find(scene *s, run_context *run);

/* Returns how far before and behind a hit, in lengths of the ray's direction, a face may lie that it touches. */
float glued_faces_window(const surface_hit *hit, vec3 direction);

/* Returns whether two faces count as lying on each other, at hits of one ray: they are nearer than a ray starts that
 * leaves the opaque one. */
bool glued_faces_touch(const surface_hit *glass, const surface_hit *opaque);

#endif
