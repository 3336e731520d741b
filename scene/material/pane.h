/* pane.h: materials that transmit light straight: thin glass, or a smooth interface between equal indices. Such
 * light is neither refracted nor scattered, and may be sampled at its lamp through the pane: it is direct light.
 * Rests on: Born, Wolf, "Principles of Optics", 1.6 (the series of reflections between two faces, without
 * interference); Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 9.5.1 (thin dielectrics).
 * Flow: material -> [here] -> bsdf, which marks its hits and samples; photons, eye and shadow rays ask that.
 * Threads: pure functions. */
#ifndef AFTERGLOW_PANE_H
#define AFTERGLOW_PANE_H

#include "material/material_point.h"

/* Returns whether the material, with its values at a point, transmits light straight by a smooth lobe: thin
 * dielectrics, smooth principled ones that are thin walls, and interfaces of index 1. */
bool pane_is_of(const material_point *m);

/* Returns whether that may be so anywhere on surfaces of the material; pane_is_of decides at a point. */
bool pane_may_be_of(const struct scene *s, uint32_t material_index);

/* Returns the transmittance of a pane, [0, 1]. cosine: of the light's direction to the normal; negative: inside. For a
 * thin dielectric with reflectance R at each face, all reflections between the faces together: (1 - R)^2 / (1 - R^2) =
 * (1 - R) / (1 + R). */
rgb pane_transmittance(const material_point *m, float cosine);

#endif
