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

#include "material/material.h"
#include "material/microfacet.h"

/* A coat and its base at a point, textures looked up. The values mean what those of `material` do. */
typedef struct coat_point {
    ggx interface, base; /* facets; of the base where it is a metal */
    float ior, thickness;
    const struct coat_table *table; /* NULL: the material needs none */
    rgb eta, k;                     /* of a metal, from the coat */
    rgb reflectance;                /* of a diffuse base */
    int bounces;
    bool has_metal; /* the base is a metal */
    bool scatters;  /* the gap between coat and base scatters light */
} coat_point;

/* Of a material without textures, or before they are looked up. */
coat_point coat_point_of(const material *m);

/* Whether the material's values are those of a coat_table, which its `table` must be then. */
bool coat_needs_table(const material *m);

/* Whether the interface does not scatter: smooth, or of an index of 1. */
bool coat_is_smooth(const coat_point *m);

/* A direction refracted into the coat by a smooth interface, on the same side of the base as it was. */
vec3 coat_refract(const coat_point *m, vec3 v);

/* The share of light at that cosine outside that a smooth interface and one way through the gap leave. */
float coat_crossing(const coat_point *m, float cos_theta);

/* t: of light at that cosine outside, what gets to a diffuse base. */
float coat_entry(const coat_point *m, float cos_theta);

/* The albedo of a diffuse base under a coat: the share of light that got in which gets out again; f is this times t(o)
 * t(i) / pi. */
rgb coat_diffuse_albedo(const coat_point *m);

/* Smooth on smooth: in through the coat, to and fro between metal and coat, and out again. metal: its reflectance. */
rgb coat_series(const coat_point *m, rgb metal, float cos_theta);

/* The lobe of a metal that is not smooth on smooth: value (f |cos i|) and density of its sampling, 0 where o and i are
 * not on one side. o, i: in the shading frame. */
void coat_metal_lobe(const coat_point *m, vec3 o, vec3 i, rgb *out_value, float *out_pdf);
/* A direction of it; o is above. false: kept in by the coat. */
bool coat_sample_metal_lobe(const coat_point *m, vec3 o, vec2 u, vec3 *out_i);
/* About its albedo. */
rgb coat_metal_lobe_albedo(const coat_point *m, float cos_o);

/* f of the scattered lobe, times pi, and what of light at a cosine leaves by it; black where there is none. */
rgb coat_scattered(const coat_point *m, vec3 o, vec3 i);
rgb coat_scattered_albedo(const coat_point *m, float cos_o);

#endif
