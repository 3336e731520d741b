/* material_mips.c: see material_mips.h. */
#include "material/material_mips.h"

#include "material/material_type.h"
#include "texture/texture_udim.h"

bool material_is_filtered(const scene *s, const material *m)
{
    const material_type *type = material_type_of(m->kind);
    return type->is_filtered && type->is_filtered(s, m);
}

static ag_status make_of_picture(scene *s, run_context *run, texture_image *i)
{
    s->filters_textures = true;
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
    const texture *t = &s->textures.items[index];
    if (t->kind == TEXTURE_CHECKERBOARD) {
        s->filters_textures = true;
        return AG_OK;
    }
    if (!t->has_pictures || !t->is_spectrum)
        return AG_OK;
    if (t->kind == TEXTURE_IMAGE)
        return make_of_picture(s, run, s->textures.images[t->image_index]);
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
            if (colors[i] != SCENE_NO_TEXTURE && texture_is_filtered(&s->textures.items[colors[i]]))
                status = make_of_texture(s, run, colors[i]);
    }
    return status;
}
