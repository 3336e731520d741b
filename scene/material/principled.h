/* principled.h: MATERIAL_PRINCIPLED's layers: what each reflects and lets through, and the values that follow from
 * those the file gives. Rests on: Khronos, "glTF 2.0 Specification", appendix B, KHR_materials_specular, _transmission,
 * _ior, _clearcoat; for the diffuse base, Kulla, Conty, "Revisiting Physically Based Shading at Imageworks", 2017.
 * Flow: material -> [here] -> bsdf_principled. Threads: pure functions.
 *
 * Layers, from above: a coat; an interface of metal and dielectric; what enters the dielectric goes through it or to a
 * diffuse base. glTF leaves to the base what each facet lets in, 1 - F(half vector), which is no product of a function
 * of each direction. Here it is t(in) t(out) / (mean of t), where t is what coat and interface do not reflect in all: a
 * product, reciprocal, and a white base under a clear interface gives back all that got through. */
#ifndef AFTERGLOW_PRINCIPLED_H
#define AFTERGLOW_PRINCIPLED_H

#include "material/material.h"

/* Bounds the values, and works out those that follow. material_prepare and material_at call it. */
void principled_resolve(material *m);

bool principled_transmits(const material *m);
/* Whether it does so into a volume, refracted; else both sides of the surface are the same. */
bool principled_is_solid(const material *m);
bool principled_has_interface(const material *m);

/* Of light that meets a facet of the interface at a cosine (>= 0), what is reflected, and what goes through, tinted.
 * is_inside: within the volume of a solid. The two are at most 1 together. */
void principled_interface(const material *m, float cosine, bool is_inside, rgb *out_reflected, rgb *out_through);

/* The share of light at a cosine that the coat's facets reflect. */
float principled_coat_reflectance(const material *m, float cosine);

/* The factor of light that passes the coat to and from the interface, of light between cosines to the normal; signed,
 * negative: inside. */
float principled_coat_factor(const material *m, float cos_o, float cos_i);

/* t and A of the diffuse base (bsdf.h); cosine: of either sign. */
float principled_base_transmittance(const material *m, float cosine);
rgb principled_base_albedo(const material *m);

/* About what the layers reflect of light at that cosine (>= 0), to pick among them. */
typedef struct principled_shares {
    float coat, interface, base;
} principled_shares;
principled_shares principled_shares_at(const material *m, float cosine);

#endif
