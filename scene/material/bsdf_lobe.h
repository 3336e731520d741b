/* bsdf_lobe.h: the kinds of lobes of a bsdf, one row each: its value, its density, and sampling it. Private to bsdf.c,
 * bsdf_init.c and the files of lobes.
 * Rests on: Walter et al. 2007; Heitz 2018; Weidlich, Wilkie 2007; Pharr, Jakob, Humphreys, 4th ed., 2023, ch. 9.
 * Threads: pure functions. */
#ifndef AFTERGLOW_BSDF_LOBE_H
#define AFTERGLOW_BSDF_LOBE_H

#include "material/bsdf.h"
#include "material/microfacet.h"

/* Where a lobe sends light that comes from `out`. */
typedef enum bsdf_lobe_side {
    LOBE_REFLECTS,  /* to the side it came from, judged by the geometry, which alone cannot leak */
    LOBE_TRANSMITS, /* to the other side, judged likewise */
    /* By facets about the shading normal, which alone decides, even through the surface, as pbrt has it: on a coarse
     * mesh with smooth normals that light finds its way out again. Not so where a map tilts the normal (is_tilted of a
     * bsdf): there both normals must agree on whether it is a reflection. */
    LOBE_BY_FACETS,
    LOBE_BY_FIBRE /* all round, whatever the normals */
} bsdf_lobe_side;

/* One kind of lobe. o, i: out and the other direction in the shading frame. */
typedef struct bsdf_lobe_type {
    bsdf_lobe_side side;
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
    bool (*passes)(const material_point *m);
    /* A of a lobe whose radiance leaves in all directions alike, but for what a coat lets through (bsdf.h): a diffuse
     * one. Flux leaves it by the cosine to the geometric normal, whatever the shading normal, which counts where flux
     * arrives. NULL: the lobe is not diffuse. */
    rgb (*albedo)(const material_point *m);
    /* t of a diffuse lobe: the share of light at a cosine outside, of either sign, that gets to it. NULL: 1. */
    float (*transmittance)(const material_point *m, float cosine);
    /* The index inside over that outside by which it refracts. NULL: what it lets through goes straight. */
    float (*index)(const material_point *m);
} bsdf_lobe_type;

/* Each is in one of the files lobes_*.c. */
#define BSDF_LOBE_DECLARATION(kind, type) extern const bsdf_lobe_type type;
BSDF_LOBE_LIST(BSDF_LOBE_DECLARATION)
#undef BSDF_LOBE_DECLARATION

extern const bsdf_lobe_type *const bsdf_lobe_types[LOBE_KIND_COUNT];

static inline const bsdf_lobe_type *bsdf_lobe_type_of(const bsdf_lobe *lobe) { return bsdf_lobe_types[lobe->kind]; }

/* The share of light at that cosine that gets to a diffuse lobe of the type. */
static inline float bsdf_lobe_transmittance(const bsdf_lobe_type *type, const material_point *m, float cosine)
{
    return type->transmittance ? type->transmittance(m, cosine) : 1.0f;
}

/* The diffuse lobe that reflects, which is the first then; NULL: there is none. */
static inline const bsdf_lobe_type *bsdf_base_of(const bsdf *b)
{
    const bsdf_lobe_type *first = b->lobe_count > 0 ? bsdf_lobe_type_of(&b->lobes[0]) : NULL;
    return first && first->albedo ? first : NULL;
}

/* The type of a diffuse base of the material's kind, whether or not it reflects anything there. */
const bsdf_lobe_type *bsdf_base_of_kind(material_kind kind);

/* Whether a direction is on out's side; judged by the geometry, which alone cannot leak. */
static inline bool bsdf_is_same_side(const bsdf *b, vec3 direction)
{
    return vec3_dot(b->out, b->geometric_normal) * vec3_dot(direction, b->geometric_normal) > 0.0f;
}

/* --- what several files of lobes share --- */

/* The normal on o's side, and the mirror's direction about it. */
vec3 bsdf_lobe_mirror(vec3 o, vec3 *out_normal);

/* A facet that o sees; its side, +1 or -1, and o on the upper side. false: facets have no density there. */
bool bsdf_lobe_sample_facet(ggx facets, vec3 o, vec2 u, vec3 *out_upper, vec3 *out_facet, float *out_side);

/* Reflection by rough facets from o to i, on one side, Fresnel's term left out: its value (f |cos|), its density, and
 * the cosine (>= 0) at which o meets the facet. false: they are not on one side. */
bool bsdf_lobe_reflection(ggx facets, vec3 o, vec3 i, float *out_cosine, float *out_value, float *out_pdf);

/* A direction of that density. false: there is none, or the facet sends it below the surface, where another facet would
 * meet it. */
bool bsdf_lobe_sample_reflection(ggx facets, vec3 o, vec2 u, vec3 *out_local);

/* Refraction by rough facets from o to i, on different sides, Fresnel's term left out: its value (f |cos|), its
 * density, and the cosine (>= 0) at which o meets the facet. false: there is no such facet. */
bool bsdf_lobe_refraction(ggx facets, float ior, bsdf_transport transport, vec3 o, vec3 i, float *out_cosine,
                          float *out_value, float *out_pdf);

#endif
