/* material_mips.c: see material_mips.h. */
#include "material/material_mips.h"

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

bool material_is_filtered(const material *m)
{
    switch (m->kind) {
    case MATERIAL_DIFFUSE:
    case MATERIAL_DIFFUSE_TRANSMISSION: return true;
    case MATERIAL_PRINCIPLED: return !has_varying_factors(m);
    default: return false;
    }
}

static ag_status make_of_picture(scene *s, run_context *run, texture_image *i)
{
    s->has_mips = true;
    if (i->mips)
        return AG_OK;
    const texture_level finest = texture_image_finest(i);
    return texture_mips_create(run, &finest, &i->mips);
}

/* Of the pictures in it. */
static ag_status make_of_texture(scene *s, run_context *run, uint32_t index)
{
    const texture *t = &s->textures[index];
    if (!t->has_pictures || !t->is_linear_in_pictures || !t->is_spectrum)
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
        if (!m->is_textured || !material_is_filtered(m))
            continue;
        if (m->reflectance_texture != SCENE_NO_TEXTURE)
            status = make_of_texture(s, run, m->reflectance_texture);
        if (status == AG_OK && m->transmittance_texture != SCENE_NO_TEXTURE)
            status = make_of_texture(s, run, m->transmittance_texture);
    }
    return status;
}
