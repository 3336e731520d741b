/* pane.c: see pane.h. Threads: pure functions. */
#include "material/pane.h"

#include "material/material_type.h"

bool pane_is_of(const material_point *m)
{
    const material_type *type = material_type_of(m->kind);
    return type->is_pane && type->is_pane(m);
}

bool pane_may_be_of(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->kind == MATERIAL_MIX)
        return pane_may_be_of(s, m->mixed[0]) || pane_may_be_of(s, m->mixed[1]);
    const material_type *type = material_type_of(m->kind);
    return type->may_be_pane && type->may_be_pane(s, m);
}

rgb pane_transmittance(const material_point *m, float cosine)
{
    return material_type_of(m->kind)->pane_transmittance(m, cosine);
}
