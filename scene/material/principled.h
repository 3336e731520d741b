/* principled.h: MATERIAL_PRINCIPLED's layers: what each reflects and lets through, and the values that follow from
 * those the file gives. Rests on: Khronos, "glTF 2.0 Specification", appendix B, KHR_materials_specular, _transmission,
 * _ior, _clearcoat; for the diffuse base, Kulla, Conty, "Revisiting Physically Based Shading at Imageworks", 2017.
 * Flow: material, material_point -> [here] -> lobes_principled. Threads: pure functions.
 *
 * Layers, from above: a coat; an interface of metal and dielectric; what enters the dielectric goes through it or to a
 * diffuse base. glTF leaves to the base what each facet lets in, 1 - F(half vector), which is no product of a function
 * of each direction. Here it is t(in) t(out) / (mean of t), where t is what coat and interface do not reflect in all: a
 * product, reciprocal, and a white base under a clear interface gives back all that got through. */
#ifndef AFTERGLOW_PRINCIPLED_H
#define AFTERGLOW_PRINCIPLED_H

#include "material/material.h"

/* MATERIAL_PRINCIPLED at a point, textures looked up. The values mean what those of `material` do. */
typedef struct principled_point {
    rgb reflectance;   /* the base colour */
    rgb dielectric_f0; /* of facets at normal incidence; at grazing they reflect `specular` */
    float ior;
    float alpha; /* of the interface's facets, all round */
    float metallic, transmission, specular, clearcoat, clearcoat_roughness;
    float base_through; /* of diffuse light from outside, what gets to the diffuse base */
    bool is_thin;
} principled_point;

/* Bounds the material's values, and sets those that follow from them. material_prepare calls it. */
void principled_prepare(material *m);

/* Of a prepared material without textures, or before they are looked up. */
principled_point principled_point_of(const material *m);

/* Bounds values that textures have changed, and sets those that follow: alpha, dielectric_f0 and base_through. */
void principled_resolve(principled_point *p, rgb specular_color, float roughness);

bool principled_transmits(const principled_point *m);
/* Whether it does so into a volume, refracted; else both sides of the surface are the same. */
bool principled_is_solid(const principled_point *m);
bool principled_has_interface(const principled_point *m);

/* Of light that meets a facet of the interface at a cosine (>= 0), what is reflected, and what goes through, tinted.
 * is_inside: within the volume of a solid. The two are at most 1 together. */
void principled_interface(const principled_point *m, float cosine, bool is_inside, rgb *out_reflected,
                          rgb *out_through);

/* The share of light at a cosine that the coat's facets reflect. */
float principled_coat_reflectance(const principled_point *m, float cosine);

/* The factor of light that passes the coat to and from the interface, of light between cosines to the normal; signed,
 * negative: inside. */
float principled_coat_factor(const principled_point *m, float cos_o, float cos_i);

/* t and A of the diffuse base (bsdf.h); cosine: of either sign. */
float principled_base_transmittance(const principled_point *m, float cosine);
rgb principled_base_albedo(const principled_point *m);

/* About what the layers reflect of light at that cosine (>= 0), to pick among them. */
typedef struct principled_shares {
    float coat, interface, base;
} principled_shares;
principled_shares principled_shares_at(const principled_point *m, float cosine);

#endif
