/* bsdf_lobe.h: the kinds of lobes of a bsdf, one row each: its value, its density, and sampling it. Private to bsdf.c,
 * bsdf_init.c and the files of lobes.
 * Rests on: Walter et al. 2007; Heitz 2018; Weidlich, Wilkie 2007; Pharr, Jakob, Humphreys, 4th ed., 2023, ch. 9.
 * Threads: pure functions. */
#ifndef AFTERGLOW_BSDF_LOBE_H
#define AFTERGLOW_BSDF_LOBE_H

#include "material/bsdf.h"
#include "material/microfacet.h"

/* The directions in which a lobe scatters light from `out`. */
typedef enum bsdf_lobe_side {
    LOBE_REFLECTS,  /* to the side it came from, judged by the geometry, which alone cannot leak */
    LOBE_TRANSMITS, /* to the other side, judged likewise */
    /* By facets about the shading normal, which alone decides, even through the surface, as in pbrt: on a coarse mesh
     * with smooth normals such light leaves again elsewhere. Where a map tilts the normal (is_tilted of a bsdf), both
     * normals must agree on whether it is a reflection. */
    LOBE_BY_FACETS,
    LOBE_BY_FIBRE, /* in all directions, whatever the normals */
    LOBE_BY_MEDIUM /* in all directions; there are no normals */
} bsdf_lobe_side;

/* A kind of lobe. o, i: out and the other direction in the shading frame. */
typedef struct bsdf_lobe_type {
    bsdf_lobe_side side;
    /* Evaluates a lobe that is not smooth: sets value (f |cos|) and density, which come in as 0. direction: i in world
     * space. For flux, the value of a diffuse lobe includes the shading normal's correction, and the density is that of
     * flux. NULL: the lobe is always smooth. */
    void (*evaluate)(const bsdf *b, bsdf_transport transport, vec3 direction, vec3 o, vec3 i, rgb *out_value,
                     float *out_pdf);
    /* Writes the only direction of a smooth lobe, and its weight once it has been picked. NULL: the lobe is never
     * smooth. */
    bool (*sample_smooth)(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec3 *out_local,
                          rgb *out_weight);
    /* Returns the share of u_lobe, from 0 up, in which sample_smooth reflects; elsewhere it transmits. NULL: no lobe of
     * this type passes. */
    float (*reflection_share)(const bsdf *b, vec3 o);
    /* Samples a lobe that is not smooth; for flux of a diffuse lobe, in the geometric frame. NULL: always smooth. */
    bool (*sample_rough)(const bsdf *b, bsdf_transport transport, vec3 o, float u_lobe, vec2 u, vec3 *out_local);
    bool passes; /* it transmits light */
    /* Returns whether the lobe transmits light with this material. NULL: with all. */
    bool (*passes_with)(const material_point *m);
    /* Returns A of a diffuse lobe, whose radiance is the same in all directions, apart from t of a coat (bsdf.h). Flux
     * leaves it by the cosine to the geometric normal; the shading normal counts where flux arrives. NULL: the lobe is
     * not diffuse. */
    rgb (*albedo)(const material_point *m);
    /* Returns t of a diffuse lobe: the share of light at a cosine outside, of either sign, that reaches it. NULL: 1. */
    float (*transmittance)(const material_point *m, float cosine);
    /* Returns the index inside over that outside by which it refracts. NULL: it transmits straight. */
    float (*index)(const material_point *m);
} bsdf_lobe_type;

/* Each is defined in one of the files lobes_*.c. */
#define BSDF_LOBE_DECLARATION(kind, type) extern const bsdf_lobe_type type;
BSDF_LOBE_LIST(BSDF_LOBE_DECLARATION)
#undef BSDF_LOBE_DECLARATION

extern const bsdf_lobe_type *const bsdf_lobe_types[LOBE_KIND_COUNT];

static inline const bsdf_lobe_type *bsdf_lobe_type_of(const bsdf *b, int lobe)
{
    return bsdf_lobe_types[b->lobes[lobe]];
}

/* Returns the share of light at a cosine that reaches a diffuse lobe of the type. */
static inline float bsdf_lobe_transmittance(const bsdf_lobe_type *type, const material_point *m, float cosine)
{
    return type->transmittance ? type->transmittance(m, cosine) : 1.0f;
}

/* Returns the diffuse lobe that reflects, which is then the first; NULL: there is none. */
static inline const bsdf_lobe_type *bsdf_base_of(const bsdf *b)
{
    const bsdf_lobe_type *first = b->lobe_count > 0 ? bsdf_lobe_type_of(b, 0) : NULL;
    return first && first->albedo ? first : NULL;
}

/* Returns the type of a diffuse base of the material's kind, whether or not it reflects anything at this point. */
const bsdf_lobe_type *bsdf_base_of_kind(material_kind kind);

/* Returns whether a direction is on out's side, by the geometric normal, which alone cannot leak. */
static inline bool bsdf_is_same_side(const bsdf *b, vec3 direction)
{
    return vec3_dot(b->out, b->geometric_normal) * vec3_dot(direction, b->geometric_normal) > 0.0f;
}

/* --- what several files of lobes share --- */

/* Returns the mirror direction of o. out_normal: the normal on o's side. */
vec3 bsdf_lobe_mirror(vec3 o, vec3 *out_normal);

/* Samples a facet visible from o; writes its side, +1 or -1, and o on the upper side. Returns false where facets have
 * no density. */
bool bsdf_lobe_sample_facet(ggx facets, vec3 o, vec2 u, vec3 *out_upper, vec3 *out_facet, float *out_side);

/* Evaluates reflection by rough facets from o to i on one side, without Fresnel's term: its value (f |cos|), its
 * density, and the cosine (>= 0) between o and the facet. Returns false where they are not on one side. */
bool bsdf_lobe_reflection(ggx facets, vec3 o, vec3 i, float *out_cosine, float *out_value, float *out_pdf);

/* Samples a direction of that density. Returns false where there is none, or where the facet reflects below the
 * surface, towards another facet. */
bool bsdf_lobe_sample_reflection(ggx facets, vec3 o, vec2 u, vec3 *out_local);

/* Evaluates refraction by rough facets from o to i on different sides, without Fresnel's term: its value (f |cos|), its
 * density, and the cosine (>= 0) between o and the facet. Returns false where there is no such facet. */
bool bsdf_lobe_refraction(ggx facets, float ior, bsdf_transport transport, vec3 o, vec3 i, float *out_cosine,
                          float *out_value, float *out_pdf);

#endif
