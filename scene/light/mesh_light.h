/* mesh_light.h: which point of a mesh that shines is sampled from a lit point.
 * Rests on: Arvo, "Stratified Sampling of Spherical Triangles", 1995; Pharr, Jakob, Humphreys, "Physically Based
 * Rendering", 4th ed., 2023, 6.5.4 (where solid angles are too small or too large to be sampled).
 *
 * By area alone, a lamp that is near or that turns its back in part gives samples of very different weight: beside a
 * large bright window these are bright specks. Meshes of few triangles are sampled uniformly in the solid angle of all
 * that faces the point. Of others a triangle is picked by area and its solid angle sampled, which is as even as the
 * triangles are small.
 * Threads: read-only. */
#ifndef AFTERGLOW_MESH_LIGHT_H
#define AFTERGLOW_MESH_LIGHT_H

#include "shape/shape.h"

/* With what density a point of a mesh is picked. */
typedef struct mesh_light_density {
    double value;
    bool is_by_area; /* value is per area; else per solid angle */
} mesh_light_density;

/* Samples a committed mesh with area_cdf by u in [0,1)^2. Returns false where none of it faces the point. */
bool mesh_light_sample(const shape *lamp, bool is_two_sided, vec3 point, vec2 u, surface_sample *out_sample,
                       mesh_light_density *out_density);

/* Returns the density with which mesh_light_sample picks a point of that triangle; 0: never. */
mesh_light_density mesh_light_density_of(const shape *lamp, bool is_two_sided, vec3 point, uint32_t triangle);

#endif
