/* coat_table.c: see coat_table.h. */
#include "material/coat_table.h"

#include "texture/texture.h"

#include <stdlib.h>
#include <string.h>

enum {
    SIDE = 8,            /* roughnesses along an axis that a texture decides */
    WALKS = 8192,        /* to a metal, for each cosine */
    WALKS_OF_SIDE = 1024 /* where there are many cells */
};

/* Roughnesses of cells lie evenly in their square roots between these. */
static const float ALPHA_MIN = 0.01f, ALPHA_MAX = 1.0f;

typedef struct coat_key {
    material_kind kind;
    float ior, alpha_u, alpha_v, base_alpha_u, base_alpha_v, thickness, g;
    rgb albedo;
    int bounces;
    bool varies, base_varies; /* textures say the roughness of the interface, of the base */
} coat_key;

struct coat_table {
    coat_key key;
    int count, base_count; /* cells along the axes */
    bool has_smooth;       /* before them, cells of a perfectly smooth interface */
    coat_cell cells[];
};

static coat_key key_of(const material *m)
{
    coat_key key;
    memset(&key, 0, sizeof key); /* compared as bytes */
    bool is_metal = m->kind == MATERIAL_COATED_CONDUCTOR;
    key.kind = m->kind;
    key.ior = m->ior;
    key.thickness = m->coat_thickness;
    key.albedo = m->coat_albedo;
    key.g = m->coat_g;
    key.bounces = m->coat_bounces;
    key.varies = m->alpha_u_texture != SCENE_NO_TEXTURE || m->alpha_v_texture != SCENE_NO_TEXTURE;
    key.base_varies =
        is_metal && (m->base_alpha_u_texture != SCENE_NO_TEXTURE || m->base_alpha_v_texture != SCENE_NO_TEXTURE);
    if (!key.varies)
        key.alpha_u = m->alpha_u, key.alpha_v = m->alpha_v;
    if (is_metal && !key.base_varies)
        key.base_alpha_u = m->base_alpha_u, key.base_alpha_v = m->base_alpha_v;
    return key;
}

bool coat_table_serves(const coat_table *table, const material *m)
{
    coat_key key = key_of(m);
    return memcmp(&key, &table->key, sizeof key) == 0;
}

void coat_table_destroy(coat_table *table) { free(table); }

/* --- cells --- */

static float side_alpha(int step)
{
    float root = (float)step / (float)(SIDE - 1);
    return ALPHA_MIN + (ALPHA_MAX - ALPHA_MIN) * root * root;
}

coat_table *coat_table_create(const material *m)
{
    coat_key key = key_of(m);
    int smooth = key.varies, count = key.varies ? SIDE : 1, base_count = key.base_varies ? SIDE : 1;
    size_t cells = (size_t)(count + smooth) * (size_t)base_count;
    coat_table *table = calloc(1, sizeof *table + cells * sizeof table->cells[0]);
    if (!table)
        return NULL;
    table->key = key;
    table->count = count;
    table->base_count = base_count;
    table->has_smooth = smooth != 0;
    for (size_t k = 0; k < cells; k++) {
        material one = *m;
        int step = (int)(k / (size_t)base_count) - smooth;
        if (key.varies)
            one.alpha_u = one.alpha_v = step < 0 ? 0.0f : side_alpha(step);
        if (key.base_varies)
            one.base_alpha_u = one.base_alpha_v = side_alpha((int)(k % (size_t)base_count));
        if (!coat_cell_fill(&table->cells[k], &one, cells > 1 ? WALKS_OF_SIDE : WALKS, k)) {
            free(table);
            return NULL;
        }
    }
    return table;
}

static float side_coordinate(ggx facets)
{
    float alpha = float_clamp(sqrtf(facets.alpha_u * facets.alpha_v), ALPHA_MIN, ALPHA_MAX);
    return sqrtf((alpha - ALPHA_MIN) / (ALPHA_MAX - ALPHA_MIN)) * (float)(SIDE - 1);
}

void coat_table_find(const coat_table *table, ggx interface, ggx base, coat_blend *out)
{
    out->cells[0] = table->cells;
    out->weights[0] = 1.0f;
    out->count = 1;
    if (table->count == 1 && table->base_count == 1)
        return;
    int base_step = 0, step = 0, across = 1, along = 1;
    float base_u = 0.0f, u = 0.0f;
    if (table->base_count > 1) {
        float coordinate = side_coordinate(base);
        base_step = coordinate < (float)(SIDE - 2) ? (int)coordinate : SIDE - 2;
        base_u = coordinate - (float)base_step;
        across = 2;
    }
    if (table->has_smooth && !material_is_smooth(interface.alpha_u, interface.alpha_v)) {
        float coordinate = side_coordinate(interface);
        step = coordinate < (float)(SIDE - 2) ? (int)coordinate : SIDE - 2;
        u = coordinate - (float)step;
        step++; /* past those of a smooth one */
        along = 2;
    }
    out->count = 0;
    for (int a = 0; a < along; a++)
        for (int b = 0; b < across; b++) {
            out->cells[out->count] = &table->cells[(step + a) * table->base_count + base_step + b];
            out->weights[out->count++] = (along == 1 ? 1.0f
                                          : a        ? u
                                                     : 1.0f - u) *
                                         (across == 1 ? 1.0f
                                          : b         ? base_u
                                                      : 1.0f - base_u);
        }
}

float coat_blend_at(const coat_blend *blend, coat_function function, float cosine)
{
    float sum = 0.0f;
    for (int k = 0; k < blend->count; k++) {
        const coat_cell *cell = blend->cells[k];
        const float *values = function == COAT_ENTRY       ? cell->entry
                              : function == COAT_SCALE     ? cell->scale
                              : function == COAT_ALBEDO    ? cell->albedo
                              : function == COAT_SCATTERED ? cell->scattered
                                                           : cell->forward;
        sum += blend->weights[k] * coat_interpolate(values, cosine);
    }
    return sum;
}
