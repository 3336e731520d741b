/* material.h: materials as scene files describe them. material_point.h holds a material's values at a hit, from
 * which bsdf.h evaluates scattering. The parameters and their defaults are pbrt-v4's (pbrt.org/fileformat-v4,
 * "Materials"), those of MATERIAL_PRINCIPLED glTF's (Khronos, "glTF 2.0 Specification", appendix B;
 * KHR_materials_transmission, _ior, _specular, _clearcoat, _sheen, _anisotropy).
 * Threads: read-only once the scene is committed. */
#ifndef AFTERGLOW_MATERIAL_H
#define AFTERGLOW_MATERIAL_H

#include "material/sheen.h"
#include "math/vec3.h"

#include <stdint.h>

/* Below this GGX alpha a surface is perfectly smooth (pbrt-v4 draws the same line). */
#define MATERIAL_SMOOTH_ALPHA 1e-3f

/* All kinds, each with its material_type (material_type.h). */
#define MATERIAL_KIND_LIST(X)                                                                                          \
    X(MATERIAL_DIFFUSE, diffuse_material)                                                                              \
    X(MATERIAL_DIFFUSE_TRANSMISSION, diffuse_transmission_material)                                                    \
    X(MATERIAL_CONDUCTOR, conductor_material)                                                                          \
    X(MATERIAL_DIELECTRIC, dielectric_material)                                                                        \
    X(MATERIAL_THIN_DIELECTRIC, thin_dielectric_material)                                                              \
    X(MATERIAL_INTERFACE,                                                                                              \
      no_material) /* no surface: light passes straight (transmittance.h), perhaps into a medium */                    \
    X(MATERIAL_COATED_DIFFUSE, coated_diffuse_material)     /* a dielectric coat on a diffuse base */                  \
    X(MATERIAL_COATED_CONDUCTOR, coated_conductor_material) /* a dielectric coat on a conductor */                     \
    X(MATERIAL_HAIR, hair_material)                         /* a fibre, coloured within (hair.h); mostly on curves */  \
    X(MATERIAL_PRINCIPLED, principled_material)             /* glTF 2.0's, with its extensions (principled.h) */       \
    X(MATERIAL_MIX, no_material)                            /* one of two others, picked by position */

typedef enum material_kind {
#define MATERIAL_KIND_ENUM(kind, type) kind,
    MATERIAL_KIND_LIST(MATERIAL_KIND_ENUM)
#undef MATERIAL_KIND_ENUM
        MATERIAL_KIND_COUNT
} material_kind;

typedef struct material {
    const void *table; /* precomputed table of its kind, NULL: none (material_table.h); set by scene_add_material */
    material_kind kind;
    rgb reflectance;        /* of the diffuse base, [0, 1] */
    rgb transmittance;      /* diffuse transmission: to the other side, [0, 1] */
    rgb eta, k;             /* conductor: index of refraction (> 0) and absorption (>= 0), from air or from the coat */
    float ior;              /* dielectric or coat: inside over outside, > 0 */
    float alpha_u, alpha_v; /* GGX roughness after remapping, >= 0, of the outer interface */
    float base_alpha_u, base_alpha_v; /* of the conductor under a coat */
    float coat_thickness;             /* in mean free paths of the coat's medium, which absorbs; >= 0 */
    rgb coat_albedo;                  /* of that medium, [0, 1]; black: it does not scatter */
    float coat_g;                     /* mean cosine of its scattering, in (-1, 1) */
    int coat_bounces; /* most reflections of light by the base under the coat, 0: unbounded; pbrt's maxdepth */
    rgb hair_sigma_a; /* absorption per radius of the path within a fibre, >= 0; ior is the fibre's */
    float hair_beta_m, hair_beta_n; /* roughness along the fibre and about it, [0, 1] */
    float hair_tilt_degrees;        /* of its scales */
    uint32_t mixed[2];              /* mix: indices of materials made before */
    float mix_amount;               /* mix: the share of the second, [0, 1] */

    /* Principled materials, whose reflectance is the base colour, and ior >= 1 or 0 (infinite): */
    float metallic;            /* [0, 1] */
    float roughness;           /* as it is perceived, [0, 1]; of this the square is alpha_u, and alpha_v too */
    float roughness_v;         /* as it is perceived, of which alpha_v alone is the square; less than 0: that of u */
    float anisotropy;          /* strength of KHR_materials_anisotropy, which makes alpha_u larger; [0, 1] */
    float transmission;        /* share of what enters a dielectric that goes through, [0, 1] */
    float specular;            /* of the dielectric's reflection, [0, 1] */
    rgb specular_color;        /* colour of the dielectric's reflection at normal incidence, >= 0 */
    float clearcoat;           /* [0, 1] */
    float clearcoat_roughness; /* as it is perceived, [0, 1] */
    rgb sheen;                 /* factor of the sheen's reflectance, >= 0, bounded by sheen_factor_max */
    float sheen_roughness;     /* as it is perceived, or of a SHEEN_VELVET its sigma, [0, 1] */
    sheen_model sheen_model;
    bool is_thin; /* transmission is that of a thin wall: straight on; else it is the surface of a volume */

    /* Principled materials, set by scene_add_material: */
    rgb dielectric_f0;  /* of facets at normal incidence; at grazing they reflect `specular` */
    float base_through; /* share of diffuse light from outside that reaches the diffuse base */

    /* Textures, SCENE_NO_TEXTURE where there is none, and read only where is_textured. They replace the values above;
     * for MATERIAL_PRINCIPLED they are multiplied with them. */
    bool is_textured;      /* set by scene_add_material */
    bool remaps_roughness; /* alpha is the square root of the texture's value */
    union {
        struct {
            uint32_t reflectance_texture, transmittance_texture, alpha_u_texture, alpha_v_texture, mix_amount_texture;
            uint32_t eta_texture, k_texture; /* conductor, from air */
            uint32_t base_alpha_u_texture, base_alpha_v_texture;
            uint32_t metallic_texture, roughness_texture, transmission_texture, specular_texture,
                specular_color_texture, clearcoat_texture, clearcoat_roughness_texture, sheen_texture,
                sheen_roughness_texture, roughness_v_texture, anisotropy_texture; /* principled */
        };
        uint32_t value_textures[20]; /* all of these */
    };

    /* Textures that tilt the shading normal, SCENE_NO_TEXTURE: none; for a mix, those of the material that is picked
     * (shading_frame.h). */
    uint32_t displacement_texture; /* a float: apparent height of the surface along its normal, scene units */
    uint32_t normal_map_texture;   /* a colour: 2 c - 1 is the normal along dp/du, dp/dv and the shading normal */
    float normal_scale;            /* factor of its first two components, usually 1 */

    /* The direction along which alpha_u is the roughness: dp/du, turned by these. For a mix, those of the material that
     * is picked. */
    float grain_turn;       /* in whole turns, from dp/du towards dp/dv, on meshes with tangents of their own from these
                               counterclockwise about the normal; [-0.5, 0.5] */
    uint32_t grain_texture; /* a colour, SCENE_NO_TEXTURE: none; 2 c - 1 of red and green is the direction to turn along
                               dp/du and dp/dv, or a mesh's own tangent and the one to its left */

    /* The material is Lambertian and nothing else, uniform, and nothing tilts its shading normal. Set by
     * scene_add_material. Some code needs no bsdf then (README.md). */
    bool is_lambertian;
} material;

/* Returns the albedo of a material that is_lambertian; else NULL. Not for curves, whose lobes are traced (bsdf.h). */
static inline const rgb *material_plain_albedo(const material *m) { return m->is_lambertian ? &m->reflectance : NULL; }

/* Returns the k with which a conductor of index 1 reflects r at normal incidence, as in pbrt-v4. */
static inline float material_k_from_reflectance(float r)
{
    float clamped = fminf(fmaxf(r, 0.0f), 0.9999f);
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
