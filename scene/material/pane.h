/* pane.h: materials that light passes straight: thin glass, or a smooth interface between equal indices. Such light is
 * neither bent nor scattered, and may be sampled at its lamp through the pane: it is direct light.
 * Rests on: Born, Wolf, "Principles of Optics", 1.6 (the series of reflections between two faces, without
 * interference); Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 9.5.1 (thin dielectrics).
 * Flow: material -> [here] -> bsdf, which marks its hits and samples; photons, eye and shadow rays ask that.
 * Threads: pure functions. */
#ifndef AFTERGLOW_PANE_H
#define AFTERGLOW_PANE_H

#include "material/material_point.h"

/* Whether the material, as it is at a point, lets a part of light through unbent by a smooth lobe: thin dielectrics,
 * smooth principled ones that are thin walls, and interfaces of index 1. */
bool pane_is_of(const material_point *m);

/* Whether that is so anywhere on surfaces of the material: pane_is_of may still say no at a point. */
bool pane_may_be_of(const struct scene *s, uint32_t material_index);

/* The share of light that passes a pane unbent, in [0, 1]. cosine: of its direction to the normal; its sign tells the
 * side, negative: inside. Of a thin dielectric with reflectance R at each face, all reflections between the faces
 * together: (1 - R)^2 / (1 - R^2) = (1 - R) / (1 + R). */
rgb pane_transmittance(const material_point *m, float cosine);

#endif
