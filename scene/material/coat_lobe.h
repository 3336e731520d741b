/* coat_lobe.h: the directional lobe of a metal under a coat, fitted to walks.
 * Rests on: Sinkhorn, Knopp, "Concerning Nonnegative Matrices and Doubly Stochastic Matrices", 1967 (scales on both
 * sides until the sums are right). Flow: coat_walk -> [here] -> coat_cell, coat. Threads: pure functions. */
#ifndef AFTERGLOW_COAT_LOBE_H
#define AFTERGLOW_COAT_LOBE_H

#include "material/coat.h"
#include "material/coat_cell.h"

/* Returns facets that reflect outside about as the metal does under the coat, for the lobe under a rough interface.
 * breadth: factor of their roughness. */
ggx coat_lobe_facets(const coat_point *m, float breadth);

/* Returns the breadth that fits walks; key: of their random numbers. */
float coat_lobe_fit_breadth(const coat_point *m, const coat_layers *layers, uint64_t key);

/* Sets the cell's scales so that the lobe has its albedo. once: the albedo of walks with one reflection by the metal.
 * Under a smooth interface the lobe of one reflection is exact, so that walks only tell how much the others add, and
 * the cell's albedo is set anew. Returns false when out of memory. */
bool coat_lobe_fit_scales(coat_cell *cell, const coat_point *m, const coat_layers *layers,
                          const float once[COAT_COSINES]);

#endif
