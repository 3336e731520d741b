/* pane.c: see pane.h. Threads: pure functions. */
#include "material/pane.h"

#include "material/fresnel.h"
#include "material/principled.h"
#include "scene.h"

static bool is_straight_principled(const material *m) { return m->is_thin || m->ior == 1.0f; }

bool pane_is_of(const material *m)
{
    switch (m->kind) {
    case MATERIAL_THIN_DIELECTRIC: return true;
    case MATERIAL_DIELECTRIC: return m->ior == 1.0f;
    case MATERIAL_PRINCIPLED:
        return is_straight_principled(m) && principled_transmits(m) && material_is_smooth(m->alpha_u, m->alpha_v);
    default: return false;
    }
}

bool pane_may_be_of(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->kind == MATERIAL_MIX)
        return pane_may_be_of(s, m->mixed[0]) || pane_may_be_of(s, m->mixed[1]);
    if (m->kind != MATERIAL_PRINCIPLED)
        return pane_is_of(m);
    /* textures multiply: they may take metal and roughness away */
    bool may_be_smooth = m->roughness_texture != SCENE_NO_TEXTURE || material_is_smooth(m->alpha_u, m->alpha_v);
    return is_straight_principled(m) && m->transmission > 0.0f && may_be_smooth;
}

rgb pane_transmittance(const material *m, float cosine)
{
    float c = fminf(fabsf(cosine), 1.0f);
    if (m->kind == MATERIAL_THIN_DIELECTRIC)
        return rgb_gray(1.0f - fresnel_thin_dielectric(c, m->ior));
    if (m->kind == MATERIAL_DIELECTRIC)
        return rgb_gray(1.0f);
    rgb reflected, through;
    principled_interface(m, c, cosine < 0.0f && principled_is_solid(m), &reflected, &through);
    return rgb_scale(through, principled_coat_factor(m, cosine, -cosine));
}
