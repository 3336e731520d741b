/* principled.h: MATERIAL_PRINCIPLED's layers: what each reflects and lets through, and the values that follow from
 * those the file gives. Rests on: Khronos, "glTF 2.0 Specification", appendix B, KHR_materials_specular, _transmission,
 * _ior, _clearcoat, _sheen, _anisotropy; for the diffuse base, Kulla, Conty, "Revisiting Physically Based Shading at
 * Imageworks", 2017. Flow: material, material_point -> [here] -> lobes_principled. Threads: pure functions.
 *
 * Layers, from above: a coat; the sheen of fibres; an interface of metal and dielectric; what enters the dielectric
 * goes through it or to a diffuse base. glTF leaves to the base what each facet lets in, 1 - F(half vector), which is
 * no product of a function of each direction. Here it is t(in) t(out) / (mean of t), where t is what coat, sheen and
 * interface do not reflect in all: a product, reciprocal, and a white base under a clear interface gives back all that
 * got through. */
#ifndef AFTERGLOW_PRINCIPLED_H
#define AFTERGLOW_PRINCIPLED_H

#include "material/microfacet.h"

typedef struct material material; /* material.h */

/* Values in [0, 1] that have the same names in `material` and at a point, each multiplied with its texture. */
#define PRINCIPLED_SHARE_LIST(X)                                                                                       \
    X(metallic)                                                                                                        \
    X(transmission)                                                                                                    \
    X(specular)                                                                                                        \
    X(clearcoat)                                                                                                       \
    X(clearcoat_roughness)                                                                                             \
    X(sheen_roughness)

/* MATERIAL_PRINCIPLED at a point, textures evaluated. The members mean the same as those of `material`. */
typedef struct principled_point {
    rgb reflectance;   /* the base colour */
    rgb dielectric_f0; /* of facets at normal incidence; at grazing they reflect `specular` */
    float ior;
    ggx facets; /* of the interface */
#define PRINCIPLED_SHARE(name) float name;
    PRINCIPLED_SHARE_LIST(PRINCIPLED_SHARE)
#undef PRINCIPLED_SHARE
    float base_through;  /* share of diffuse light from outside that reaches the diffuse base */
    rgb sheen;           /* factor of the sheen's reflectance, as bounded by sheen_factor_max */
    uint8_t sheen_model; /* sheen_model */
    bool has_sheen;      /* it is not black */
    bool is_thin;
} principled_point;

/* Clamps the material's values, and sets derived ones. material_prepare calls it. */
void principled_prepare(material *m);

/* Returns the point of a prepared material without textures, or before they are evaluated. */
principled_point principled_point_of(const material *m);

/* Returns the GGX roughness of an interface along u and v. roughness_u, roughness_v: as they are perceived; anisotropy:
 * the strength of KHR_materials_anisotropy. All are clamped to [0, 1]; roughness_v below 0: that of u. Where they have
 * no direction both members have the same bits. */
ggx principled_facets(float roughness_u, float roughness_v, float anisotropy);

/* Clamps values that textures have changed, and sets derived ones: dielectric_f0 and base_through. The facets are set
 * already. */
void principled_resolve(principled_point *p, rgb specular_color);

bool principled_transmits(const principled_point *m);
/* Returns whether it transmits into a volume, by refraction; else both sides of the surface are the same. */
bool principled_is_solid(const principled_point *m);
bool principled_has_interface(const principled_point *m);

/* Computes, for light that meets a facet of the interface at a cosine (>= 0), its reflectance and its tinted
 * transmittance, together at most 1. is_inside: within the volume of a solid. */
void principled_interface(const principled_point *m, float cosine, bool is_inside, rgb *out_reflected,
                          rgb *out_through);

/* Returns the reflectance of the coat's facets at a cosine. */
float principled_coat_reflectance(const principled_point *m, float cosine);

/* Returns the factor of light that passes coat and sheen to and from the interface. Cosines are those with the
 * normal; where one is below 0, its direction is inside the volume. */
float principled_cover_factor(const principled_point *m, float cos_o, float cos_i);

/* Returns the factor of light that passes the coat to and from the sheen; cosines to the normal. */
float principled_sheen_factor(const principled_point *m, float cos_o, float cos_i);

/* Return t and A of the diffuse base (bsdf.h); cosine: of either sign. */
float principled_base_transmittance(const principled_point *m, float cosine);
rgb principled_base_albedo(const principled_point *m);

/* Returns the approximate reflectance of the layers at a cosine (>= 0), for picking among them. */
typedef struct principled_shares {
    float coat, interface, base, sheen;
} principled_shares;
principled_shares principled_shares_at(const principled_point *m, float cosine);

#endif
