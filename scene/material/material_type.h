/* material_type.h: the functions of a kind of material, in one row of MATERIAL_KIND_LIST each, in the file of its
 * family.
 * Flow: material.c, material_point.c, material_mips.c, pane.c, slab.c and bsdf_init.c ask the row of a material's
 * kind.
 * Threads: read-only tables of pure functions. */
#ifndef AFTERGLOW_MATERIAL_TYPE_H
#define AFTERGLOW_MATERIAL_TYPE_H

#include "material/bsdf.h"
#include "material/material_table.h"

#include <assert.h>

/* The point at which textures are evaluated. footprint: NULL where they are not filtered. */
typedef struct material_lookup {
    const scene *s;
    const surface_hit *hit;
    const struct surface_footprint *footprint;
} material_lookup;

/* A predicate of a material that is no mix. */
typedef bool material_predicate(const scene *s, const material *m);

/* Reflectance and transmittance of a plate's faces, for light from outside (outer, in) and from within (inner, out). */
typedef struct material_faces {
    rgb outer, in, inner, out;
} material_faces;

/* Functions may be NULL where their comments say what that means. */
typedef struct material_type {
    /* --- of the file's description --- */

    /* Sets defaults that differ from those of material_make; NULL: none. */
    void (*init)(material *m);
    /* Computes derived values; NULL: none. */
    void (*prepare)(material *m);
    /* The table that is kept at material.table once the values are prepared; NULL: none. */
    const material_table_type *table;
    /* Predicates; NULL: never true. */
    material_predicate *is_traced;      /* material_is_traced */
    material_predicate *is_clear_glass; /* material_is_clear_glass */
    material_predicate *transmits;      /* material_transmits; interfaces do without it */
    material_predicate *is_transparent; /* material_is_transparent, likewise */
    material_predicate *has_base;       /* it has a diffuse base anywhere */
    material_predicate *may_be_pane;    /* pane_may_be_of */
    material_predicate *may_be_slab;    /* slab_may_be_of, of a smooth one without textures whose ior is not 1 */
    material_predicate *is_filtered;    /* material_is_filtered */

    /* --- at a point --- */

    /* Sets the values without textures; NULL: there are none. */
    void (*init_point)(const material *m, material_point *p);
    /* Replaces them by textures' values; NULL: there are none. */
    void (*look_up)(const material_lookup *at, const material *m, material_point *p);
    /* material_point_has_grain; NULL: never. */
    bool (*has_grain)(const material_point *p);
    /* pane_is_of; NULL: never. */
    bool (*is_pane)(const material_point *p);
    /* pane_transmittance; cosine of either sign. NULL: it is never a pane. */
    rgb (*pane_transmittance)(const material_point *p, float cosine);
    /* Returns the index of a material that may_be_slab, and writes what its faces do with light at cosines (>= 0)
     * outside and within. */
    float (*index)(const material_point *p);
    material_faces (*faces)(const material_point *p, float cosine, float cosine_within);
    /* Adds its lobes, a diffuse one that reflects before all others; NULL: rays pass. */
    void (*add_lobes)(bsdf *b, const surface_hit *hit);
    /* The kind of that diffuse lobe; LOBE_DIFFUSE also where there is none. */
    bsdf_lobe_kind base;
} material_type;

/* Each is defined in the file of its family, except no_material: rays pass an interface, and mixes are resolved
 * before. */
#define MATERIAL_TYPE_DECLARATION(kind, type, lobes) extern const material_type type;
MATERIAL_KIND_LIST(MATERIAL_TYPE_DECLARATION)
#undef MATERIAL_TYPE_DECLARATION

extern const material_type *const material_types[MATERIAL_KIND_COUNT];

/* The most lobes that add_lobes of a kind adds, by its row. */
extern const uint8_t material_lobes_max[MATERIAL_KIND_COUNT];

#define MATERIAL_LOBES_FIT(kind, type, lobes)                                                                          \
    _Static_assert((lobes) <= BSDF_LOBES_MAX, "a bsdf has no room for the lobes of " #kind);
MATERIAL_KIND_LIST(MATERIAL_LOBES_FIT)
#undef MATERIAL_LOBES_FIT

static inline const material_type *material_type_of(material_kind kind) { return material_types[kind]; }

/* --- what several kinds share --- */

/* A predicate that always holds. */
bool material_always(const scene *s, const material *m);

static inline bool facets_are_smooth(ggx facets) { return material_is_smooth(facets.alpha_u, facets.alpha_v); }
static inline bool facets_have_grain(ggx facets) { return facets.alpha_u != facets.alpha_v; }

/* Each leaves a value unchanged where its texture is SCENE_NO_TEXTURE. Colours are clamped to [0, 1], and filtered. */
void material_look_up_color(const material_lookup *at, uint32_t texture_index, rgb *in_out_color);
void material_look_up_facets(const material_lookup *at, const material *m, uint32_t texture_u, uint32_t texture_v,
                             ggx *in_out_facets);
/* Evaluates a metal's index; from_air: factor of the index from air. */
void material_look_up_metal(const material_lookup *at, const material *m, float from_air, rgb *in_out_eta,
                            rgb *in_out_k);

static inline void bsdf_remove_lobes(bsdf *b)
{
    b->lobe_count = b->gathered_lobes = b->traced_lobes = b->smooth_lobes = 0;
}

/* Adds a lobe; bsdf_init.c normalises the shares to probabilities once all are added. */
static inline void bsdf_add_lobe(bsdf *b, bsdf_lobe_kind kind, bsdf_lobes group, bool is_delta, float share)
{
    const int k = b->lobe_count++;
    assert(k < BSDF_LOBES_MAX);
    uint8_t *set = group == BSDF_GATHERED ? &b->gathered_lobes : &b->traced_lobes;
    *set = (uint8_t)(*set | 1 << k);
    b->smooth_lobes = (uint8_t)(b->smooth_lobes | is_delta << k);
    b->lobes[k] = (uint8_t)kind;
    b->probabilities[k] = share;
}

#endif
