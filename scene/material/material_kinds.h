/* material_kinds.h: the kinds of material and of lobes, what a scene file says of a material, and what is kept of it at
 * a point of a surface. A new kind adds its rows and members here; the rest of it is one file (README.md).
 * Flow: [here] -> material (what the file says), material_point, bsdf (lobes). Threads: types and lists alone. */
#ifndef AFTERGLOW_MATERIAL_KINDS_H
#define AFTERGLOW_MATERIAL_KINDS_H

#include "material/coat.h"
#include "material/hair.h"
#include "material/principled.h"
#include "material/sheen.h"
#include "medium/phase_function.h"

#include <stdbool.h>
#include <stdint.h>

/* --- kinds of material, each with its material_type (material_type.h) and the most lobes that it adds --- */

#define MATERIAL_KIND_LIST(X)                                                                                          \
    X(MATERIAL_DIFFUSE, diffuse_material, 1)                                                                           \
    X(MATERIAL_DIFFUSE_TRANSMISSION, diffuse_transmission_material, 2)                                                 \
    X(MATERIAL_CONDUCTOR, conductor_material, 1)                                                                       \
    X(MATERIAL_DIELECTRIC, dielectric_material, 1)                                                                     \
    X(MATERIAL_THIN_DIELECTRIC, thin_dielectric_material, 1)                                                           \
    X(MATERIAL_INTERFACE, no_material,                                                                                 \
      0) /* no surface: light passes straight (transmittance.h), perhaps into a medium */                              \
    X(MATERIAL_COATED_DIFFUSE, coated_diffuse_material, 3)     /* a dielectric coat on a diffuse base */               \
    X(MATERIAL_COATED_CONDUCTOR, coated_conductor_material, 3) /* a dielectric coat on a conductor */                  \
    X(MATERIAL_HAIR, hair_material, 1)             /* a fibre, coloured within (hair.h); mostly on curves */           \
    X(MATERIAL_PRINCIPLED, principled_material, 4) /* glTF 2.0's, with its extensions (principled.h) */                \
    X(MATERIAL_MIX, no_material, 0)                /* one of two others, picked by position */

typedef enum material_kind {
#define MATERIAL_KIND_ENUM(kind, type, lobes) kind,
    MATERIAL_KIND_LIST(MATERIAL_KIND_ENUM)
#undef MATERIAL_KIND_ENUM
        MATERIAL_KIND_COUNT
} material_kind;

/* --- kinds of lobes, each with its bsdf_lobe_type (bsdf_lobe.h) --- */

#define BSDF_LOBE_LIST(X)                                                                                              \
    X(LOBE_DIFFUSE, bsdf_lobe_diffuse)                 /* to the side it came from */                                  \
    X(LOBE_DIFFUSE_THROUGH, bsdf_lobe_diffuse_through) /* to the other side */                                         \
    X(LOBE_COATED_BASE, bsdf_lobe_coated_base)         /* diffuse, under a coat */                                     \
    X(LOBE_PRINCIPLED_BASE, bsdf_lobe_principled_base) /* diffuse, under the interface of the principled one */        \
    X(LOBE_CONDUCTOR, bsdf_lobe_conductor)                                                                             \
    X(LOBE_DIELECTRIC, bsdf_lobe_dielectric)           /* reflection and refraction */                                 \
    X(LOBE_THIN_DIELECTRIC, bsdf_lobe_thin_dielectric) /* a pane: reflection, and straight through */                  \
    X(LOBE_SLAB, bsdf_lobe_slab) /* a slab passed straight: reflection by both faces, and straight through */          \
    X(LOBE_COAT, bsdf_lobe_coat) /* reflection by a dielectric coat */                                                 \
    X(LOBE_CONDUCTOR_UNDER_COAT, bsdf_lobe_conductor_under_coat) /* refracted in, reflected, refracted out */          \
    X(LOBE_COAT_SCATTERED, bsdf_lobe_coat_scattered)             /* light that leaves a coat at any angle (coat.h) */  \
    X(LOBE_HAIR, bsdf_lobe_hair)                                 /* all light of a fibre (hair.h) */                   \
    X(LOBE_PRINCIPLED, bsdf_lobe_principled) /* of metal and dielectric: reflection, and straight or refracted */      \
    X(LOBE_CLEARCOAT, bsdf_lobe_clearcoat)   /* reflection by the coat of the principled one */                        \
    X(LOBE_SHEEN, bsdf_lobe_sheen)           /* reflection by the fibres of cloth (sheen.h) */                         \
    X(LOBE_PHASE, bsdf_lobe_phase)           /* of a point in a medium (phase_function.h) */

typedef enum bsdf_lobe_kind {
#define BSDF_LOBE_ENUM(kind, type) kind,
    BSDF_LOBE_LIST(BSDF_LOBE_ENUM)
#undef BSDF_LOBE_ENUM
        LOBE_KIND_COUNT
} bsdf_lobe_kind;

/* --- what a file says of a material: type, name, default --- */

/* Raised when a default of the list below changes, which the fingerprint of a scene would not show. */
enum { MATERIAL_HASH_FORM = 1 };

/* Members of `material`: with MATERIAL_TEXTURE_LIST all that it has beside its kind, the two that it mixes, and what
 * scene_add_material works out. From this list follow the members, their defaults (those of pbrt-v4, and of glTF for
 * principled ones; a kind's `init` has others) and the fingerprint of a scene, which adds the name and value of what
 * differs from the default: a new row leaves the photon maps valid that builds of the same version have kept of scenes
 * without it. A reader checks ranges. Who uses a list includes texture.h too. A material is flat and no union, since
 * its main members serve several kinds each: the reflectance five, ior six, the roughness five. */
#define MATERIAL_VALUE_LIST(X)                                                                                         \
    X(rgb, reflectance, rgb_gray(0.5f))   /* of the diffuse base, [0, 1] */                                            \
    X(rgb, transmittance, rgb_gray(0.0f)) /* diffuse transmission: to the other side, [0, 1] */                        \
    X(rgb, eta, rgb_gray(0.0f))           /* conductor: index of refraction (> 0), from air or from the coat */        \
    X(rgb, k, rgb_gray(0.0f))             /* its absorption (>= 0), likewise */                                        \
    X(float, ior, 1.5f)                   /* dielectric or coat: inside over outside, > 0 */                           \
    X(float, alpha_u, 0.0f)               /* GGX roughness after remapping, >= 0, of the outer interface */            \
    X(float, alpha_v, 0.0f)                                                                                            \
    X(float, base_alpha_u, 0.0f) /* of the conductor under a coat */                                                   \
    X(float, base_alpha_v, 0.0f)                                                                                       \
    X(bool, remaps_roughness, false)     /* alpha is the square root of its texture's value */                         \
    X(float, coat_thickness, 0.0f)       /* in mean free paths of the coat's medium, which absorbs; >= 0 */            \
    X(rgb, coat_albedo, rgb_gray(0.0f))  /* of that medium, [0, 1]; black: it does not scatter */                      \
    X(float, coat_g, 0.0f)               /* mean cosine of its scattering, in (-1, 1) */                               \
    X(int, coat_bounces, 0)              /* most reflections by the base under the coat, 0: unbounded */               \
    X(rgb, hair_sigma_a, rgb_gray(0.0f)) /* absorption per radius within a fibre, >= 0; ior is the fibre's */          \
    X(float, hair_beta_m, 0.3f)          /* roughness along the fibre, [0, 1] */                                       \
    X(float, hair_beta_n, 0.3f)          /* roughness about the fibre, [0, 1] */                                       \
    X(float, hair_tilt_degrees, 2.0f)    /* of its scales */                                                           \
    X(float, mix_amount, 0.5f)           /* mix: the share of the second, [0, 1] */                                    \
    /* Of principled materials, whose reflectance is the base colour, and ior >= 1 or 0 (infinite): */                 \
    X(float, metallic, 1.0f)               /* [0, 1] */                                                                \
    X(float, roughness, 1.0f)              /* as it is perceived, [0, 1]; alpha_u is its square, alpha_v too */        \
    X(float, roughness_v, -1.0f)           /* as it is perceived, of alpha_v alone; less than 0: that of u */          \
    X(float, anisotropy, 0.0f)             /* of KHR_materials_anisotropy, which makes alpha_u larger; [0, 1] */       \
    X(float, transmission, 0.0f)           /* share of what enters a dielectric that goes through, [0, 1] */           \
    X(float, specular, 1.0f)               /* of the dielectric's reflection, [0, 1] */                                \
    X(rgb, specular_color, rgb_gray(1.0f)) /* of that reflection at normal incidence, >= 0 */                          \
    X(float, clearcoat, 0.0f)              /* [0, 1] */                                                                \
    X(float, clearcoat_roughness, 0.0f)    /* as it is perceived, [0, 1] */                                            \
    X(rgb, sheen, rgb_gray(0.0f))          /* factor of its reflectance, >= 0, bounded by sheen_factor_max */          \
    X(float, sheen_roughness, 0.0f)        /* as it is perceived, or the sigma of a SHEEN_VELVET, [0, 1] */            \
    X(sheen_model, sheen_model, SHEEN_CHARLIE)                                                                         \
    X(bool, is_thin, true) /* transmission of a thin wall, straight on; else of a volume's surface */                  \
    /* Textures that tilt the shading normal, SCENE_NO_TEXTURE: none (shading_frame.h). Of a mix these and the grain   \
     * below are those of the material that is picked. */                                                              \
    X(uint32_t, displacement_texture, SCENE_NO_TEXTURE) /* a float: apparent height along the normal, scene units */   \
    X(uint32_t, normal_map_texture, SCENE_NO_TEXTURE)   /* a colour: 2 c - 1 along dp/du, dp/dv, shading normal */     \
    X(float, normal_scale, 1.0f)                        /* factor of its first two components, usually 1 */            \
    /* The direction along which alpha_u is the roughness: dp/du, turned by these. In whole turns, [-0.5, 0.5], from   \
     * dp/du towards dp/dv, on meshes with tangents of their own from these counterclockwise about the normal; and by  \
     * a colour, of which 2 c - 1 of red and green is the direction to turn along dp/du and dp/dv, or a mesh's own     \
     * tangent and the one to its left. */                                                                             \
    X(float, grain_turn, 0.0f)                                                                                         \
    X(uint32_t, grain_texture, SCENE_NO_TEXTURE)

/* Textures that replace the values of their names, or for MATERIAL_PRINCIPLED are multiplied with them; a metal's
 * indices are from air. SCENE_NO_TEXTURE where there is none. They are read only where material.is_textured. */
#define MATERIAL_TEXTURE_LIST(X)                                                                                       \
    X(reflectance_texture)                                                                                             \
    X(transmittance_texture)                                                                                           \
    X(alpha_u_texture)                                                                                                 \
    X(alpha_v_texture)                                                                                                 \
    X(mix_amount_texture)                                                                                              \
    X(eta_texture)                                                                                                     \
    X(k_texture)                                                                                                       \
    X(base_alpha_u_texture)                                                                                            \
    X(base_alpha_v_texture)                                                                                            \
    X(metallic_texture)                                                                                                \
    X(roughness_texture)                                                                                               \
    X(roughness_v_texture)                                                                                             \
    X(anisotropy_texture)                                                                                              \
    X(transmission_texture)                                                                                            \
    X(specular_texture)                                                                                                \
    X(specular_color_texture)                                                                                          \
    X(clearcoat_texture)                                                                                               \
    X(clearcoat_roughness_texture)                                                                                     \
    X(sheen_texture)                                                                                                   \
    X(sheen_roughness_texture)

/* --- what is kept of a material at a point, from which lobes are evaluated --- */

typedef struct diffuse_point {
    rgb reflectance, transmittance; /* [0, 1], together at most 1 */
} diffuse_point;

typedef struct metal_point {
    ggx facets;
    rgb eta, k;
} metal_point;

typedef struct glass_point {
    ggx facets; /* none for thin glass */
    float ior;
} glass_point;

/* Both faces of a plate and the medium between them, treated as one surface (slab.h). */
typedef struct slab_point {
    rgb reflected, through;
} slab_point;

typedef struct material_point {
    material_kind kind; /* never MATERIAL_MIX */
    union {
        diffuse_point diffuse;       /* MATERIAL_DIFFUSE, MATERIAL_DIFFUSE_TRANSMISSION */
        metal_point metal;           /* MATERIAL_CONDUCTOR */
        glass_point glass;           /* MATERIAL_DIELECTRIC, MATERIAL_THIN_DIELECTRIC */
        coat_point coat;             /* MATERIAL_COATED_DIFFUSE, MATERIAL_COATED_CONDUCTOR */
        principled_point principled; /* MATERIAL_PRINCIPLED */
        hair_point hair;             /* MATERIAL_HAIR; bsdf_init adds the direction to fibre and colour */
        slab_point slab;             /* for a bsdf with LOBE_SLAB, whatever the kind */
        phase_function phase;        /* for a bsdf with LOBE_PHASE, whose kind is MATERIAL_INTERFACE */
    };
} material_point;

_Static_assert(sizeof(material_point) <= 96, "each hit on a surface makes a material_point");

#endif
