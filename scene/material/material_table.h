/* material_table.h: tables that some kinds of material compute once from their values, while the scene is read: the
 * walks of a coat, the constants of a fibre. Materials with equal values share a table, also across successive
 * scenes of edits. Flow: material_type says what a kind keeps -> [here] -> scene_add_material.
 * Threads: made and released while scenes are built, by one; read-only between. */
#ifndef AFTERGLOW_MATERIAL_TABLE_H
#define AFTERGLOW_MATERIAL_TABLE_H

#include "material/material.h"

/* The functions of a kind's tables, part of its material_type. */
typedef struct material_table_type {
    /* Returns whether this material has a table; NULL: all of the kind have one. */
    bool (*is_needed)(const material *m);
    /* Creates the table of a prepared material; NULL when out of memory. */
    void *(*create)(const material *m);
    /* Returns whether it is the table that `create` would make for a material of this kind. */
    bool (*serves)(const void *content, const material *m);
    void (*destroy)(void *content);
} material_table_type;

/* A reference-counted table. */
typedef struct material_table {
    const material_table_type *type;
    void *content; /* the result of `create` */
    unsigned holder_count;
} material_table;

/* Returns the functions of a material's table; NULL: it needs none. */
const material_table_type *material_table_needed(const material *m);

/* Creates the table of a material that needs one, with one holder; NULL when out of memory. */
material_table *material_table_create(const material *m);
material_table *material_table_hold(material_table *table);
/* Releases one holder; the last release frees the table. NULL is fine. */
void material_table_release(material_table *table);

/* Returns the first of these tables that fits a material which needs one; NULL: none does. */
material_table *material_table_find(material_table *const *tables, uint32_t count, const material *m);

#endif
