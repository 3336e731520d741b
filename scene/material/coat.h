/* coat.h: a dielectric coat over a base, as pbrt has it: what it lets through, what it sends back, and what of that
 * gets out in the end. Rests on: Pharr, Jakob, Humphreys, 4th ed., 2023, 14.3 (the random walk that this stands for, of
 * which it keeps the energy: coat_table.h); Weidlich, Wilkie, "Arbitrarily Layered Micro-Facet Surfaces", 2007 (a metal
 * under a smooth coat). Flow: material_point, coat_table -> [here] -> lobes. Threads: pure functions.
 *
 * Under a coat a diffuse base forgets where light came from, so its lobe is a product, exactly: t(o) t(i) times a
 * series of reflections to and fro. A metal has two lobes: light that facets reflected in part keeps a direction, and
 * is put into the metal's own lobe under a smooth coat, into one of GGX facets outside under a rough one, scaled at
 * both ends until the albedo is right; light that was reflected totally, or that the gap scattered, leaves at any
 * angle: the lobe "scattered", a product g(o) g(i). */
#ifndef AFTERGLOW_COAT_H
#define AFTERGLOW_COAT_H

#include "material/microfacet.h"

typedef struct material material; /* material.h */

/* A coat and its base at a point, textures evaluated. The members mean the same as those of `material`. */
typedef struct coat_point {
    ggx interface, base; /* facets; those of the base only where it is a metal */
    float ior, thickness;
    const struct coat_table *table; /* NULL: the material needs none */
    rgb eta, k;                     /* of a metal, from the coat */
    rgb reflectance;                /* of a diffuse base */
    int bounces;
    bool has_metal; /* the base is a metal */
    bool scatters;  /* the gap between coat and base scatters light */
} coat_point;

/* Returns the values of a material without textures, or before they are evaluated. */
coat_point coat_point_of(const material *m);

/* Returns whether the material needs a coat_table, which its `table` must then be. */
bool coat_needs_table(const material *m);

/* Returns whether the interface does not scatter: it is smooth, or its index is 1. */
bool coat_is_smooth(const coat_point *m);

/* Returns a direction refracted into the coat by a smooth interface, on the same side of the base. */
vec3 coat_refract(const coat_point *m, vec3 v);

/* Returns the transmittance of a smooth interface and one path through the gap, at a cosine outside. */
float coat_crossing(const coat_point *m, float cos_theta);

/* Returns t: the share of light at a cosine outside that reaches a diffuse base. */
float coat_entry(const coat_point *m, float cos_theta);

/* Returns the albedo of a diffuse base under a coat: the share of the light that got in which gets out again. f is the
 * albedo times t(o) t(i) / pi. */
rgb coat_diffuse_albedo(const coat_point *m);

/* Returns the reflectance of a smooth metal under a smooth coat, with all reflections between them. metal: its
 * reflectance. */
rgb coat_series(const coat_point *m, rgb metal, float cos_theta);

/* Evaluates the lobe of a metal where metal or coat is rough: value (f |cos i|) and density of its sampling, 0 where o
 * and i are not on one side. o, i: in the shading frame. */
void coat_metal_lobe(const coat_point *m, vec3 o, vec3 i, rgb *out_value, float *out_pdf);
/* Samples that lobe; o is above. Returns false where the coat keeps the light in. */
bool coat_sample_metal_lobe(const coat_point *m, vec3 o, vec2 u, vec3 *out_i);
/* Returns its approximate albedo. */
rgb coat_metal_lobe_albedo(const coat_point *m, float cos_o);

/* Return f of the scattered lobe, times pi; and the share of light at a cosine that leaves by it; black where there is
 * none. */
rgb coat_scattered(const coat_point *m, vec3 o, vec3 i);
rgb coat_scattered_albedo(const coat_point *m, float cos_o);

#endif
