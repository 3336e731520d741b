/* bsdf_lobe.h: one lobe of a bsdf: its value, its density, and sampling it. Private to bsdf.c.
 * Rests on: Walter et al. 2007; Heitz 2018; Weidlich, Wilkie 2007; Pharr, Jakob, Humphreys, 4th ed., 2023, ch. 9.
 * Threads: pure functions. */
#ifndef AFTERGLOW_BSDF_LOBE_H
#define AFTERGLOW_BSDF_LOBE_H

#include "material/bsdf.h"
#include "material/microfacet.h"

/* The share of light at that cosine outside that a coat lets through, once; 1 where there is no coat. */
float bsdf_lobe_transmittance(const material *m, float cos_theta);

/* A of the diffuse reflection, under a coat what gets out of it. */
rgb bsdf_lobe_diffuse_albedo(const material *m);

/* Refraction by rough facets from o to i, on different sides, Fresnel's term left out: its value (f |cos|), its
 * density, and the cosine (>= 0) at which o meets the facet. false: there is no such facet. */
bool bsdf_lobe_refraction(ggx facets, float ior, bsdf_transport transport, vec3 o, vec3 i, float *out_cosine,
                          float *out_value, float *out_pdf);

/* Whether a direction is on out's side; judged by the geometry, which alone cannot leak. */
bool bsdf_is_same_side(const bsdf *b, vec3 direction);

/* Whether radiance leaves it in all directions alike, but for a coat. Flux leaves it by the cosine to the geometric
 * normal then, whatever the shading normal, which counts where flux arrives. */
static inline bool bsdf_lobe_is_diffuse(bsdf_lobe_kind kind)
{
    return kind == LOBE_DIFFUSE || kind == LOBE_DIFFUSE_THROUGH;
}

/* Whether it is made of facets about the shading normal. Where they send light the shading normal alone decides, even
 * through the surface, as pbrt has it: on a coarse mesh with smooth normals that light finds its way out again. */
static inline bool bsdf_lobe_has_facets(bsdf_lobe_kind kind)
{
    return !bsdf_lobe_is_diffuse(kind) && kind != LOBE_COAT_SCATTERED && kind != LOBE_HAIR;
}

/* Value (f |cos|) and density of one lobe that is not smooth. direction: world; o, i: out and direction in the frame.
 * Of flux the value holds the shading normal's correction where the lobe is diffuse, and the density is flux's. */
void bsdf_lobe_evaluate(const bsdf *b, const bsdf_lobe *lobe, bsdf_transport transport, vec3 direction, vec3 o, vec3 i,
                        rgb *out_value, float *out_pdf);

/* A smooth lobe's one direction, and its weight once it has been picked. */
bool bsdf_lobe_sample_smooth(const bsdf *b, bsdf_lobe_kind kind, bsdf_transport transport, vec3 o, float u_lobe,
                             vec3 *out_local, rgb *out_weight);

/* A direction of a lobe that is not smooth, in the shading frame; for flux of a diffuse lobe, in the geometric one. */
bool bsdf_lobe_sample_rough(const bsdf *b, bsdf_lobe_kind kind, vec3 o, float u_lobe, vec2 u, vec3 *out_local);

#endif
