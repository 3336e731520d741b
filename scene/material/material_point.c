/* material_point.c: see material_point.h. Threads: pure functions. */
#include "material/material_point.h"

#include "material/material_mips.h"
#include "material/material_type.h"
#include "material/surface_footprint.h"
#include "scene.h"

void material_point_of(const material *m, material_point *out_point)
{
    out_point->kind = m->kind;
    if (material_type_of(m->kind)->init_point)
        material_type_of(m->kind)->init_point(m, out_point);
}

/* m is no mix; of one that a texture picks from, is_picked: beside the point the other may be, whose pixels are of any
 * colour in this one's pictures, so that none are filtered. */
static void evaluate_at(const scene *s, const material *m, const surface_hit *hit, bool is_picked,
                        material_point *out_point)
{
    const material_type *type = material_type_of(m->kind);
    material_point_of(m, out_point);
    if (!m->is_textured || !type->look_up)
        return;
    surface_footprint footprint;
    const bool filters = hit->footprint.width > 0.0f && s->filters_textures && !is_picked &&
                         material_is_filtered(s, m) && surface_footprint_at(s, hit, &footprint);
    const material_lookup at = {s, hit, filters ? &footprint : NULL};
    type->look_up(&at, m, out_point);
}

const material *material_at(const scene *s, const surface_hit *hit, material_point *out_point)
{
    const material *m = &s->materials[s->shapes[hit->shape_index].material_index];
    const bool is_mix = m->kind == MATERIAL_MIX;
    if (is_mix)
        m = material_resolve_mix(s, m, hit);
    evaluate_at(s, m, hit, is_mix, out_point);
    return m;
}

bool material_gathering_at(const scene *s, const surface_hit *hit, material_point *out_point)
{
    const material *m = material_with_base(s, s->shapes[hit->shape_index].material_index);
    if (m)
        evaluate_at(s, m, hit, true, out_point);
    return m != NULL;
}

bool material_point_has_grain(const material_point *p)
{
    const material_type *type = material_type_of(p->kind);
    return type->has_grain && type->has_grain(p);
}
