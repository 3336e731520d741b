/* coat_table.h: what walks between coat and base come to in all, tabulated by the cosine outside, and by roughness
 * where a texture says it. Two materials of the same coat share one: colours of the base are no part of it.
 * Rests on: Kulla, Conty, "Revisiting Physically Based Shading at Imageworks", 2017 (tables of what is lost, given back
 * by products). Flow: coat_cell -> [here] -> coat.
 * Threads: made while the scene is built, by one; read-only then, and a pure function of the material. */
#ifndef AFTERGLOW_COAT_TABLE_H
#define AFTERGLOW_COAT_TABLE_H

#include "material/coat_cell.h"

typedef struct coat_table coat_table;

/* Walks as the material says it; NULL: no memory. kind: one of the two coated ones. About a tenth of a second where
 * a metal is not smooth, more where textures say how rough. Freed by coat_table_destroy. */
coat_table *coat_table_create(const material *m);
void coat_table_destroy(coat_table *table); /* NULL is fine */

/* Whether it is the one that coat_table_create would make of that material. */
bool coat_table_serves(const coat_table *table, const material *m);

/* Cells about two roughnesses, of interface and base, with weights that sum to 1. */
typedef struct coat_blend {
    const coat_cell *cells[4];
    float weights[4];
    int count;
} coat_blend;

coat_blend coat_table_find(const coat_table *table, ggx interface, ggx base);

typedef enum coat_function { COAT_ENTRY, COAT_SCALE, COAT_ALBEDO, COAT_SCATTERED, COAT_FORWARD } coat_function;

/* One of a cell's functions of the cosine outside, [0, 1]. */
float coat_blend_at(const coat_blend *blend, coat_function function, float cosine);

#endif
