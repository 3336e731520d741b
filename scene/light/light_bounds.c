/* light_bounds.c: what the light tree knows of a lamp: see light_tree.h. Threads: read-only. */
#include "light/light_type.h"
#include "scene.h"

bool light_find_bounds(const scene *s, const light *l, light_bounds *out_bounds)
{
    const light_type *type = light_type_of(l->kind);
    *out_bounds = (light_bounds){.axis = {0.0f, 0.0f, 1.0f},
                                 .cos_normals = LIGHT_BOUNDS_ALL_AROUND,
                                 .cos_emission = LIGHT_BOUNDS_ALL_AROUND,
                                 .least_cos = 1.0f,
                                 .intensity = rgb_mean(l->power) * 0.25f * AG_INV_PI};
    if (!type->is_everywhere)
        type->narrow_bounds(s, l, out_bounds);
    return !type->is_everywhere;
}
