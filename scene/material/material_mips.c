/* material_mips.c: see material_mips.h. */
#include "material/material_mips.h"

#include "texture/texture_udim.h"

/* A factor that varies goes along with the colour or against it: the mean of the product is another than the product of
 * the means. Roughness has hardly a part in how much is reflected. */
static bool has_varying_factors(const material *m)
{
    return (m->metallic != 0.0f && m->metallic_texture != SCENE_NO_TEXTURE) ||
           (m->transmission != 0.0f && m->transmission_texture != SCENE_NO_TEXTURE) ||
           (m->specular != 0.0f && m->specular_texture != SCENE_NO_TEXTURE) ||
           m->specular_color_texture != SCENE_NO_TEXTURE ||
           (m->clearcoat != 0.0f && m->clearcoat_texture != SCENE_NO_TEXTURE);
}

static float bound_of_color(const scene *s, rgb color, uint32_t texture_index)
{
    return texture_index == SCENE_NO_TEXTURE ? rgb_max(color) : s->textures[texture_index].most;
}

/* Where reflectance and transmittance together are above 1 they are scaled down: the mean of that is not that of
 * means. */
static bool is_cut_by_its_sum(const scene *s, const material *m)
{
    return m->kind == MATERIAL_DIFFUSE_TRANSMISSION &&
           !(bound_of_color(s, m->reflectance, m->reflectance_texture) +
                 bound_of_color(s, m->transmittance, m->transmittance_texture) <=
             1.0f);
}

bool material_is_filtered(const scene *s, const material *m)
{
    switch (m->kind) {
    case MATERIAL_DIFFUSE: return true;
    case MATERIAL_DIFFUSE_TRANSMISSION: return !is_cut_by_its_sum(s, m);
    case MATERIAL_PRINCIPLED: return !has_varying_factors(m);
    default: return false;
    }
}

static ag_status make_of_picture(scene *s, run_context *run, texture_image *i)
{
    s->has_mips = true;
    if (i->udim) {
        i->udim->has_mips = true;
        ag_status status = AG_OK;
        for (uint32_t k = 0; k < i->udim->slot_count && status == AG_OK; k++)
            if (i->udim->tiles[k])
                status = make_of_picture(s, run, i->udim->tiles[k]);
        return status;
    }
    if (i->mips)
        return AG_OK;
    if (i->share && i->share->mips) {
        i->mips = i->share->mips;
        return AG_OK;
    }
    texture_level finest = texture_image_finest(i);
    if (i->share && finest.table)
        finest.table = i->share->table;
    const ag_status status = texture_mips_create(run, &finest, &i->mips);
    if (status == AG_OK && i->share)
        i->share->mips = i->mips;
    return status;
}

/* Makes the levels of the pictures in a texture that is filtered, or a part of one that is. */
static ag_status make_of_texture(scene *s, run_context *run, uint32_t index)
{
    const texture *t = &s->textures[index];
    if (!t->has_pictures || !t->is_spectrum)
        return AG_OK;
    if (t->kind == TEXTURE_IMAGE)
        return make_of_picture(s, run, s->texture_images[t->image_index]);
    ag_status status = AG_OK;
    for (size_t i = 0; i < sizeof t->inputs / sizeof *t->inputs && status == AG_OK; i++)
        if (t->inputs[i].texture_index != SCENE_NO_TEXTURE)
            status = make_of_texture(s, run, t->inputs[i].texture_index);
    return status;
}

ag_status material_mips_make(scene *s, run_context *run)
{
    ag_status status = AG_OK;
    for (uint32_t k = 0; k < s->material_count && status == AG_OK; k++) {
        const material *m = &s->materials[k];
        if (!m->is_textured || !material_is_filtered(s, m))
            continue;
        const uint32_t colors[] = {m->reflectance_texture, m->transmittance_texture};
        for (int i = 0; i < 2 && status == AG_OK; i++)
            if (colors[i] != SCENE_NO_TEXTURE && texture_is_filtered(&s->textures[colors[i]]))
                status = make_of_texture(s, run, colors[i]);
    }
    return status;
}
