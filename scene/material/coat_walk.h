/* coat_walk.h: random walks of light between the two interfaces of a coated surface.
 * Rests on: Guo, Hašan, Zhao, "Position-Free Monte Carlo Simulation for Arbitrary Layered BSDFs", 2018; Pharr,
 * Jakob, Humphreys, 4th ed., 2023, 14.3 (the model, with its parameters); Henyey, Greenstein, "Diffuse Radiation in
 * the Galaxy", 1941; Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018. Flow: material ->
 * [here] -> coat_table. Threads: pure functions. */
#ifndef AFTERGLOW_COAT_WALK_H
#define AFTERGLOW_COAT_WALK_H

#include "material/microfacet.h"
#include "math/rng.h"

/* The coat's interface is at height `thickness`, the base at 0. The gap extinguishes with a coefficient of 1. */
typedef struct coat_layers {
    float ior;           /* of the gap over that outside, > 0; 1: the interface has no effect */
    ggx interface, base; /* facets; those of the base only where it is a metal */
    bool interface_is_smooth, base_is_smooth;
    bool base_is_metal;  /* of reflectance 1; else the walk ends at the base */
    float thickness;     /* >= 0 */
    bool scatters;       /* whether the gap scatters; else it only absorbs */
    float g;             /* mean cosine of that scattering, in (-1, 1) */
    int event_count_max; /* interfaces met and scatterings, from the first crossing on */
} coat_layers;

typedef enum coat_end { COAT_END_LOST, COAT_END_OUTSIDE, COAT_END_BASE } coat_end;

typedef struct coat_path {
    coat_end end;
    vec3 direction;  /* of light that left the coat: away from the surface */
    float weight;    /* remaining weight of 1, without the albedos of gap and base */
    int metal_count; /* reflections by the metal */
    int scatter_count;
    bool was_trapped; /* a facet of the interface reflected it totally from below */
} coat_path;

/* The random numbers of a walk: first the k-th point of an evenly spread lattice, then random numbers. Some of the
 * lattice point's numbers may be used before the walk begins. */
enum { COAT_POINTS = 6 };

typedef struct coat_numbers {
    float points[COAT_POINTS];
    int taken;
    rng random;
} coat_numbers;

coat_numbers coat_numbers_make(uint64_t key, uint64_t stream, uint32_t k);
float coat_numbers_next(coat_numbers *numbers);

/* Walks with light from `out`, outside and unit, that the interface transmits; its reflection is left out, and so is
 * its share of the weight. */
coat_path coat_walk_in(const coat_layers *layers, vec3 out, coat_numbers *numbers);

/* Walks with light that leaves a diffuse base along `up`, until it is outside or back at the base. Where the gap does
 * not scatter, the weight is that of returning, and nothing leaves. */
coat_path coat_walk_up(const coat_layers *layers, vec3 up, coat_numbers *numbers);

#endif
