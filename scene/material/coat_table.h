/* coat_table.h: totals of walks between coat and base, tabulated by the cosine outside, and by roughness where that
 * is textured. Materials with the same coat share a table, which does not depend on the base's colour.
 * Rests on: Kulla, Conty, "Revisiting Physically Based Shading at Imageworks", 2017 (tables of what is lost, given
 * back by products). Flow: coat_cell -> [here] -> coat.
 * Threads: made while the scene is built, by one; read-only then, and a pure function of the material. */
#ifndef AFTERGLOW_COAT_TABLE_H
#define AFTERGLOW_COAT_TABLE_H

#include "material/coat_cell.h"

typedef struct coat_table coat_table;

/* Creates the table of a coated material by random walks; NULL when out of memory. It takes about a tenth of a second
 * where a metal is not smooth, more with textured roughness. Freed by coat_table_destroy. */
coat_table *coat_table_create(const material *m);
void coat_table_destroy(coat_table *table); /* NULL is fine */

/* Returns whether it is the table that coat_table_create would make for a material. */
bool coat_table_serves(const coat_table *table, const material *m);

/* The cells around two roughnesses, of interface and base, with weights that sum to 1. */
typedef struct coat_blend {
    const coat_cell *cells[4];
    float weights[4];
    int count;
} coat_blend;

/* Finds the cells and their weights. It writes to the caller's memory, since a copy of what was just written part by
 * part would stall (store forwarding). */
void coat_table_find(const coat_table *table, ggx interface, ggx base, coat_blend *out_blend);

typedef enum coat_function { COAT_ENTRY, COAT_SCALE, COAT_ALBEDO, COAT_SCATTERED, COAT_FORWARD } coat_function;

/* A function of a cell, of the cosine outside, [0, 1]. */
float coat_blend_at(const coat_blend *blend, coat_function function, float cosine);

#endif
