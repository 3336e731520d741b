/* texture_set.c: see texture_set.h. */
#include "texture/texture_set.h"

#include "array_grow.h"

#include <math.h>
#include <stdlib.h>

/* Half a pixel of a picture that lies on uv; of others what pbrt takes where it knows no better. */
static float own_step(const texture_set *set, const texture *t)
{
    static const float STEP = 0.0005f, STEP_MIN = 1e-5f, STEP_MAX = 0.25f;
    if (t->kind == TEXTURE_CONSTANT || t->kind == TEXTURE_SCALE || t->kind == TEXTURE_MIX)
        return STEP_MAX; /* no finer than their inputs */
    if (t->kind != TEXTURE_IMAGE || t->mapping.kind != TEXTURE_MAPPING_UV)
        return STEP;
    const texture_image *picture = set->images[t->image_index];
    float pixels = float_max(fabsf(t->mapping.scale.x) * (float)picture->width,
                             fabsf(t->mapping.scale.y) * (float)picture->height);
    return pixels > 0.0f ? float_clamp(0.5f / pixels, STEP_MIN, STEP_MAX) : STEP_MAX;
}

ag_status texture_set_add(texture_set *set, const texture *item, uint32_t *out_index)
{
    uint32_t cost = 1;
    float step = own_step(set, item);
    for (size_t i = 0; i < sizeof item->inputs / sizeof *item->inputs; i++)
        if (item->inputs[i].texture_index != SCENE_NO_TEXTURE) {
            const texture *input = &set->items[item->inputs[i].texture_index];
            cost += input->cost; /* each is at most TEXTURE_MAX_COST */
            step = float_min(step, input->step);
        }
    if (cost > TEXTURE_MAX_COST)
        return AG_ERROR_SCENE;
    if (!array_grow((void **)&set->items, set->count, sizeof *set->items))
        return AG_ERROR_MEMORY;
    *out_index = set->count;
    set->items[set->count] = *item;
    set->items[set->count].step = step;
    set->items[set->count].cost = cost;
    texture_find_pictures(set, &set->items[set->count++]);
    return AG_OK;
}

ag_status texture_set_add_image(texture_set *set, texture_image *item, uint32_t *out_index)
{
    if (!array_grow((void **)&set->images, set->image_count, sizeof *set->images)) {
        texture_image_destroy(item);
        return AG_ERROR_MEMORY;
    }
    *out_index = set->image_count;
    set->images[set->image_count++] = item;
    return AG_OK;
}

void texture_set_reset(texture_set *set)
{
    for (uint32_t i = 0; i < set->image_count; i++)
        texture_image_destroy(set->images[i]);
    texture_store_destroy(set->store);
    free(set->images);
    free(set->items);
    *set = (texture_set){0};
}
