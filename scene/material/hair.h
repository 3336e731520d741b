/* hair.h: how a hair scatters: a rough dielectric fibre with tilted scales, coloured within.
 * Rests on: Chiang, Bitterli, Tappan, Burley, "A Practical and Controllable Hair and Fur Model for Production Path
 * Tracing", 2016; d'Eon et al., "An Energy-Conserving Hair Reflectance Model", 2011 (longitudinal scattering);
 * Marschner et al., "Light Scattering from Human Hair Fibers", 2003; parameters as in Pharr, Jakob, Humphreys, 4th ed.,
 * 2023, 9.9. Flow: material + surface hit -> [here] -> bsdf_lobe. Threads: pure functions.
 *
 * Light that meets the fibre is reflected (R), passes it (TT), is reflected once within (TRT), or more often. The
 * lobes depend on the place across the fibre, on its roughness, and on the angles to its axis, x of the shading frame;
 * of the normal nothing is read, so that curves may be flat and turn to each ray. */
#ifndef AFTERGLOW_HAIR_H
#define AFTERGLOW_HAIR_H

#include "material/material.h"

enum { HAIR_TILTED = 3, HAIR_LOBES = 4 }; /* R, TT, TRT, whose angles the scales shift, and all longer paths */

typedef struct hair_fibre {
    double ior;                  /* of the fibre in air */
    double sigma_a[3];           /* absorbed per radius of the path within */
    double offset;               /* place across: sine of the normal's angle to the ray, [-1, 1] */
    double variance[HAIR_LOBES]; /* of the angle to the axis */
    double width;                /* scale of the logistic distribution about the axis, radians */
    double sin_tilt[HAIR_TILTED], cos_tilt[HAIR_TILTED]; /* of once, twice and four times the scales' angle */
} hair_fibre;

/* The colour within hair that scatters much light back in this colour, each channel in [0, 1] (Chiang 2016, eq. 9). */
rgb hair_absorption_from_reflectance(rgb reflectance, float beta_n);

/* v: the second surface parameter of the place. */
hair_fibre hair_fibre_at(const material *m, float v);

/* f |cos| of radiance that comes from `light` and leaves to `eye`; directions in the shading frame, unit. */
rgb hair_scatter(const hair_fibre *h, vec3 eye, vec3 light);

/* Of flux, what is scattered from `light` to `eye` per flux that meets the fibre, which seems the narrower
 * the more it points to the light. */
rgb hair_scatter_flux(const hair_fibre *h, vec3 light, vec3 eye);

/* Samples a direction from o, and its density per solid angle. */
vec3 hair_sample(const hair_fibre *h, vec3 o, float u_lobe, vec2 u);
float hair_pdf(const hair_fibre *h, vec3 o, vec3 i);

#endif
