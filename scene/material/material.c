/* material.c: derived values of materials, and predicates that need no point of a surface.
 * Threads: material_prepare while the scene is built; the rest read only. */
#include "material/material.h"

#include "material/material_type.h"
#include "math/rng.h"
#include "scene.h"

#include <string.h>

void material_make_rough_on_both_axes(float *alpha_u, float *alpha_v)
{
    if (*alpha_u >= MATERIAL_SMOOTH_ALPHA || *alpha_v >= MATERIAL_SMOOTH_ALPHA) {
        *alpha_u = float_max(*alpha_u, 1e-4f);
        *alpha_v = float_max(*alpha_v, 1e-4f);
    }
}

material material_make(material_kind kind)
{
    material m;
    memset(&m, 0, sizeof m);
    m.kind = kind;
#define SET_VALUE(type, name, otherwise) m.name = (otherwise);
    MATERIAL_VALUE_LIST(SET_VALUE)
#undef SET_VALUE
#define SET_NO_TEXTURE(name) m.name = SCENE_NO_TEXTURE;
    MATERIAL_TEXTURE_LIST(SET_NO_TEXTURE)
#undef SET_NO_TEXTURE
    if (material_type_of(kind)->init)
        material_type_of(kind)->init(&m);
    return m;
}

static bool has_textures(const material *m)
{
#define OR_IS_THERE(name) || m->name != SCENE_NO_TEXTURE
    return false MATERIAL_TEXTURE_LIST(OR_IS_THERE);
#undef OR_IS_THERE
}

void material_prepare(material *m)
{
    m->is_textured = has_textures(m);
    m->is_lambertian = false;
    if (material_type_of(m->kind)->prepare)
        material_type_of(m->kind)->prepare(m);
    material_make_rough_on_both_axes(&m->alpha_u, &m->alpha_v);
    material_make_rough_on_both_axes(&m->base_alpha_u, &m->base_alpha_v);
}

bool material_is_traced(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->kind == MATERIAL_MIX)
        return material_is_traced(s, m->mixed[0]) || material_is_traced(s, m->mixed[1]);
    const material_type *type = material_type_of(m->kind);
    return type->is_traced && type->is_traced(s, m);
}

bool material_is_clear_glass(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->kind == MATERIAL_MIX)
        return material_is_clear_glass(s, m->mixed[0]) || material_is_clear_glass(s, m->mixed[1]);
    const material_type *type = material_type_of(m->kind);
    return type->is_clear_glass && type->is_clear_glass(s, m);
}

bool material_transmits(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->kind == MATERIAL_MIX)
        return material_transmits(s, m->mixed[0]) || material_transmits(s, m->mixed[1]);
    const material_type *type = material_type_of(m->kind);
    return m->kind == MATERIAL_INTERFACE || (type->transmits && type->transmits(s, m));
}

bool material_is_transparent(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->kind == MATERIAL_MIX)
        return material_is_transparent(s, m->mixed[0]) && material_is_transparent(s, m->mixed[1]);
    const material_type *type = material_type_of(m->kind);
    return m->kind == MATERIAL_INTERFACE || (type->is_transparent && type->is_transparent(s, m));
}

/* A mix picks one of its two by position alone, as pbrt-v4 does: the same for all rays, so photons and eye agree. */
const material *material_resolve_mix(const scene *s, const material *m, const surface_hit *hit)
{
    uint32_t bits[3];
    memcpy(bits, &hit->position, sizeof bits);
    uint64_t hash = hash_combine(hash_combine(bits[0], bits[1]), bits[2]);
    while (m->kind == MATERIAL_MIX) {
        hash = hash_mix64(hash + 0x9e3779b97f4a7c15u);
        float u = (float)(hash >> 40) * 0x1p-24f;
        float amount = m->mix_amount;
        if (m->mix_amount_texture != SCENE_NO_TEXTURE)
            amount = texture_evaluate_float(&s->textures, m->mix_amount_texture, hit);
        m = &s->materials[m->mixed[u < amount ? 1 : 0]];
    }
    return m;
}

bool material_is_interface(const scene *s, const surface_hit *hit)
{
    const material *m = &s->materials[s->shapes[hit->shape_index].material_index];
    if (m->kind == MATERIAL_MIX)
        m = material_resolve_mix(s, m, hit);
    return m->kind == MATERIAL_INTERFACE;
}

bool material_may_be_interface(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->kind == MATERIAL_MIX)
        return material_may_be_interface(s, m->mixed[0]) || material_may_be_interface(s, m->mixed[1]);
    return m->kind == MATERIAL_INTERFACE;
}

const material *material_with_base(const scene *s, uint32_t material_index)
{
    const material *m = &s->materials[material_index];
    if (m->kind != MATERIAL_MIX) {
        const material_type *type = material_type_of(m->kind);
        return type->has_base && type->has_base(s, m) ? m : NULL;
    }
    const material *first = material_with_base(s, m->mixed[0]);
    return first ? first : material_with_base(s, m->mixed[1]);
}
