/* coat.h: a dielectric coat over a base, as pbrt has it: what it lets through, what it sends back, and what of that
 * gets out in the end. Rests on: Weidlich, Wilkie, "Arbitrarily Layered Micro-Facet Surfaces", 2007; Pharr, Jakob,
 * Humphreys, 4th ed., 2023, 14.3 (the random walk that this stands for); Kulla, Conty, "Revisiting Physically Based
 * Shading at Imageworks", 2017 (a lobe that gives back what others lose). Flow: material -> [here] -> bsdf_lobe.
 * Threads: coat_prepare while the scene is built; the rest are pure functions.
 *
 * A rough conductor sends part of its light where the coat reflects totally. It comes back to the conductor until it
 * gets out, at any angle: the lobe "trapped", a product g(o) g(i) of the share that is caught, scaled to all that
 * escapes. */
#ifndef AFTERGLOW_COAT_H
#define AFTERGLOW_COAT_H

#include "material/material.h"

/* Works out coat_return and coat_trap; material_prepare calls it once the roughness is set. */
void coat_prepare(material *m);

/* A direction refracted into the coat, on the same side of the base as it was. */
vec3 coat_refract(const material *m, vec3 v);

/* What the coat lets through, once, of light at that cosine outside. */
float coat_transmittance(const material *m, float cos_theta);

/* Of a diffuse base: all that gets out of light that got in. */
rgb coat_diffuse_albedo(const material *m);

/* In through the coat, to and fro between conductor and coat, and out again. metal: its reflectance. */
rgb coat_series(const material *m, rgb metal, float cos_o, float cos_i);

/* What the coat's own facets reflect at a cosine to them; of light between cosines to the normal. */
float coat_reflectance(const material *m, float cos_facet, float cos_o, float cos_i);

/* f of the trapped lobe, times pi. */
bool coat_has_trapped(const material *m);
rgb coat_trapped(const material *m, float cos_o, float cos_i);
/* Of light at a cosine, what leaves by it. */
rgb coat_trapped_albedo(const material *m, float cos_o);

#endif
