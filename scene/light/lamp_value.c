/* lamp_value.c: see lamp_value.h. */
#include "light/lamp_value.h"

#include "scene.h"
#include "shape/alpha.h"

rgb lamp_texture_value(const scene *s, const light *l, const surface_hit *hit)
{
    if (l->as.area.radiance_texture == SCENE_NO_TEXTURE)
        return rgb_gray(1.0f);
    rgb c = texture_evaluate_rgb(&s->textures, l->as.area.radiance_texture, hit);
    return rgb_make(float_max(c.r, 0.0f), float_max(c.g, 0.0f), float_max(c.b, 0.0f));
}

bool lamp_varies(const scene *s, const light *l)
{
    const shape *lamp = &s->shapes[l->as.area.shape_index];
    return l->as.area.radiance_texture != SCENE_NO_TEXTURE ||
           (lamp->alpha_texture != SCENE_NO_TEXTURE && !shape_is_invisible(lamp));
}

rgb lamp_sampled_value(const scene *s, const light *l, const surface_sample *at)
{
    const shape *lamp = &s->shapes[l->as.area.shape_index];
    if (l->as.area.radiance_texture == SCENE_NO_TEXTURE && shape_is_opaque(lamp))
        return rgb_gray(1.0f);
    surface_hit hit = {.distance = 0.0f};
    if (lamp_varies(s, l))
        shape_sample_surface(lamp, l->as.area.shape_index, at, &hit);
    rgb value = lamp_texture_value(s, l, &hit);
    if (shape_is_opaque(lamp) || shape_is_invisible(lamp))
        return value;
    return rgb_scale(value, alpha_at(s, lamp, &hit));
}
