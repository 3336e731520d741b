/* material_table.c: see material_table.h. */
#include "material/material_table.h"

#include "material/material_type.h"

#include <stdlib.h>

const material_table_type *material_table_needed(const material *m)
{
    const material_table_type *type = material_type_of(m->kind)->table;
    return type && (!type->is_needed || type->is_needed(m)) ? type : NULL;
}

material_table *material_table_create(const material *m)
{
    const material_table_type *type = material_table_needed(m);
    material_table *table = malloc(sizeof *table);
    if (!table)
        return NULL;
    *table = (material_table){.type = type, .content = type->create(m), .holder_count = 1};
    if (table->content)
        return table;
    free(table);
    return NULL;
}

material_table *material_table_hold(material_table *table)
{
    table->holder_count++;
    return table;
}

void material_table_release(material_table *table)
{
    if (!table || --table->holder_count > 0)
        return;
    table->type->destroy(table->content);
    free(table);
}

material_table *material_table_find(material_table *const *tables, uint32_t count, const material *m)
{
    const material_table_type *type = material_type_of(m->kind)->table;
    for (uint32_t i = 0; i < count; i++)
        if (tables[i]->type == type && type->serves(tables[i]->content, m))
            return tables[i];
    return NULL;
}
