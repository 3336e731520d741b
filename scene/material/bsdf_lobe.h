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
 * through the surface, as pbrt has it: on a coarse mesh with smooth normals that light finds its way out again. Not so
 * where a map tilts the normal (is_tilted of a bsdf). */
static inline bool bsdf_lobe_has_facets(bsdf_lobe_kind kind)
{
    return !bsdf_lobe_is_diffuse(kind) && kind != LOBE_COAT_SCATTERED && kind != LOBE_HAIR;
}

/* What a lobe of a kind does: its row in bsdf_lobe.c. o, i: out and the other direction in the shading frame. */
typedef struct bsdf_lobe_type {
    /* Of a lobe that is not smooth: sets value (f |cos|) and density, which come in as 0. direction: i in world space.
     * Of flux the value holds the shading normal's correction where the lobe is diffuse, and the density is flux's.
     * NULL: the lobe is always smooth. */
    void (*evaluate)(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                     float *out_pdf);
    /* The one direction of a smooth lobe, and its weight once it has been picked. NULL: the lobe is never smooth. */
    bool (*sample_smooth)(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                          rgb *out_weight);
    /* A direction of a lobe that is not smooth; for flux of a diffuse lobe, in the geometric frame. NULL: always
     * smooth. */
    bool (*sample_rough)(const bsdf *b, vec3 o, float u_lobe, vec2 u, vec3 *out_local);
    /* Whether it sends light on to the other side too, by this material. NULL: by none. */
    bool (*passes)(const material *m);
} bsdf_lobe_type;

const bsdf_lobe_type *bsdf_lobe_type_of(bsdf_lobe_kind kind);

#endif
