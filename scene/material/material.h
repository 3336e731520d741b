/* material.h: materials as scene files describe them. material_kinds.h has what is kept of one at a hit, from
 * which bsdf.h evaluates scattering. The parameters and their defaults are pbrt-v4's (pbrt.org/fileformat-v4,
 * "Materials"), those of MATERIAL_PRINCIPLED glTF's (Khronos, "glTF 2.0 Specification", appendix B;
 * KHR_materials_transmission, _ior, _specular, _clearcoat, _sheen, _anisotropy).
 * Threads: read-only once the scene is committed. */
#ifndef AFTERGLOW_MATERIAL_H
#define AFTERGLOW_MATERIAL_H

#include "material/material_kinds.h"

/* Below this GGX alpha a surface is perfectly smooth (pbrt-v4 draws the same line). */
#define MATERIAL_SMOOTH_ALPHA 1e-3f

typedef struct material {
    material_kind kind;

    /* Set by scene_add_material: */
    bool is_textured;   /* it has any of MATERIAL_TEXTURE_LIST */
    bool is_lambertian; /* it is uniform and Lambertian alone, and nothing tilts its shading normal: some code needs no
                           bsdf then (shortcuts.md) */
    const void *table;  /* precomputed table of its kind, NULL: none (material_table.h) */
    rgb dielectric_f0;  /* principled: of facets at normal incidence; at grazing they reflect `specular` */
    float base_through; /* principled: share of diffuse light from outside that reaches the diffuse base */

    /* Said by the file: the rows of both lists, and: */
#define MATERIAL_VALUE(type, name, otherwise) type name;
    MATERIAL_VALUE_LIST(MATERIAL_VALUE)
#undef MATERIAL_VALUE
#define MATERIAL_TEXTURE(name) uint32_t name;
    MATERIAL_TEXTURE_LIST(MATERIAL_TEXTURE)
#undef MATERIAL_TEXTURE
    uint32_t mixed[2]; /* mix: indices of materials made before */
} material;

/* Returns the albedo of a material that is_lambertian; else NULL. Not for curves, whose lobes are traced (bsdf.h). */
static inline const rgb *material_plain_albedo(const material *m) { return m->is_lambertian ? &m->reflectance : NULL; }

/* Returns the k with which a conductor of index 1 reflects r at normal incidence, as in pbrt-v4. */
static inline float material_k_from_reflectance(float r)
{
    float clamped = float_clamp(r, 0.0f, 0.9999f);
    return 2.0f * sqrtf(clamped) / sqrtf(1.0f - clamped);
}

static inline bool material_is_smooth(float alpha_u, float alpha_v)
{
    return alpha_u < MATERIAL_SMOOTH_ALPHA && alpha_v < MATERIAL_SMOOTH_ALPHA;
}

struct scene;
struct surface_hit;

/* Returns a material without textures, with the defaults of pbrt-v4, or for MATERIAL_PRINCIPLED those of glTF: white,
 * metallic, rough, a thin wall. eta and k of a conductor are 0, and must be set. */
material material_make(material_kind kind);

/* Computes derived values; called by scene_add_material. */
void material_prepare(material *m);

/* Returns whether the material, or one that it mixes, has lobes that are traced (bsdf.h). */
bool material_is_traced(const struct scene *s, uint32_t material_index);

/* Returns whether the material, or one that it mixes, is smooth glass, thin or not, through which light passes on one
 * path only. */
bool material_is_clear_glass(const struct scene *s, uint32_t material_index);

/* Returns whether the material, or one that it mixes, lets light through to the other side anywhere. */
bool material_transmits(const struct scene *s, uint32_t material_index);

/* Returns whether it lets through, all over, most of what it does not reflect, as glass and interfaces do: it has no
 * colour of its own to speak of. A mix does where both of its materials do. */
bool material_is_transparent(const struct scene *s, uint32_t material_index);

/* Returns whether rays pass straight at a hit, as through an interface. */
bool material_is_interface(const struct scene *s, const struct surface_hit *hit);

/* Returns whether that is so anywhere on surfaces of the material. */
bool material_may_be_interface(const struct scene *s, uint32_t material_index);

/* Returns the material that a mix picks at a hit; a material that is no mix itself. */
const material *material_resolve_mix(const struct scene *s, const material *m, const struct surface_hit *hit);

/* Returns the material, or the first of those mixed, that has a diffuse base anywhere; NULL: none. */
const material *material_with_base(const struct scene *s, uint32_t material_index);

/* Raises the smaller of two roughnesses to a least value where only one of them is rough, to avoid division by zero. */
void material_make_rough_on_both_axes(float *alpha_u, float *alpha_v);

#endif
