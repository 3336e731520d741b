/* material_table.h: what a kind of material works out of its values once, while the scene is read, and keeps beside
 * them: the walks of a coat, the constants of a fibre. Materials share a table that serves them all, in the scenes that
 * follow by edits too. Flow: material_type says what a kind keeps -> [here] -> scene_add_material.
 * Threads: made and released while scenes are built, by one; read-only between. */
#ifndef AFTERGLOW_MATERIAL_TABLE_H
#define AFTERGLOW_MATERIAL_TABLE_H

#include "material/material.h"

/* Part of a kind's row in the table of material types. */
typedef struct material_table_type {
    /* Whether this material has a table; NULL: all of the kind have one. */
    bool (*is_needed)(const material *m);
    /* Makes the table of a prepared material; NULL when out of memory. */
    void *(*create)(const material *m);
    /* Whether it is the one that `create` would make of that material, which is of a kind of this type. */
    bool (*serves)(const void *content, const material *m);
    void (*destroy)(void *content);
} material_table_type;

/* A table with those who hold it. */
typedef struct material_table {
    const material_table_type *type;
    void *content; /* what `create` has made */
    unsigned holder_count;
} material_table;

/* NULL: the material needs none. */
const material_table_type *material_table_needed(const material *m);

/* Of a material that needs one, held once; NULL when out of memory. */
material_table *material_table_create(const material *m);
material_table *material_table_hold(material_table *table);
/* The last holder's release frees it; NULL is fine. */
void material_table_release(material_table *table);

/* The first of these tables that serves a material which needs one; NULL: none does. */
material_table *material_table_find(material_table *const *tables, uint32_t count, const material *m);

#endif
