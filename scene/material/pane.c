/* pane.c: see pane.h. Threads: pure functions. */
#include "material/pane.h"

#include "material/fresnel.h"
#include "scene.h"

static bool is_straight(bool is_thin, float ior) { return is_thin || ior == 1.0f; }

bool pane_is_of(const material_point *m)
{
    switch (m->kind) {
    case MATERIAL_THIN_DIELECTRIC: return true;
    case MATERIAL_DIELECTRIC: return m->glass.ior == 1.0f;
    case MATERIAL_PRINCIPLED:
        return is_straight(m->principled.is_thin, m->principled.ior) && principled_transmits(&m->principled) &&
               material_is_smooth(m->principled.alpha, m->principled.alpha);
    default: return false;
    }
}

bool pane_may_be_of(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    switch (m->kind) {
    case MATERIAL_MIX: return pane_may_be_of(s, m->mixed[0]) || pane_may_be_of(s, m->mixed[1]);
    case MATERIAL_THIN_DIELECTRIC: return true;
    case MATERIAL_DIELECTRIC: return m->ior == 1.0f;
    case MATERIAL_PRINCIPLED:
        /* textures multiply: they may take metal and roughness away */
        return is_straight(m->is_thin, m->ior) && m->transmission > 0.0f &&
               (m->roughness_texture != SCENE_NO_TEXTURE || material_is_smooth(m->alpha_u, m->alpha_v));
    default: return false;
    }
}

rgb pane_transmittance(const material_point *m, float cosine)
{
    float c = fminf(fabsf(cosine), 1.0f);
    if (m->kind == MATERIAL_THIN_DIELECTRIC)
        return rgb_gray(1.0f - fresnel_thin_dielectric(c, m->glass.ior));
    if (m->kind == MATERIAL_DIELECTRIC)
        return rgb_gray(1.0f);
    rgb reflected, through;
    const principled_point *p = &m->principled;
    principled_interface(p, c, cosine < 0.0f && principled_is_solid(p), &reflected, &through);
    return rgb_scale(through, principled_coat_factor(p, cosine, -cosine));
}
