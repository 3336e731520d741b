/* hair.h: how a hair scatters: a rough dielectric fibre with tilted scales, coloured within.
 * Rests on: Chiang, Bitterli, Tappan, Burley, "A Practical and Controllable Hair and Fur Model for Production Path
 * Tracing", 2016; d'Eon et al., "An Energy-Conserving Hair Reflectance Model", 2011 (longitudinal scattering);
 * Marschner et al., "Light Scattering from Human Hair Fibers", 2003; parameters as in Pharr, Jakob, Humphreys, 4th ed.,
 * 2023, 9.9. Flow: material + surface hit -> [here] -> bsdf_lobe. Threads: pure functions.
 *
 * Light that meets the fibre is reflected (R), passes it (TT), is reflected once within (TRT), or more often. The
 * lobes depend on the offset across the fibre, on its roughness, and on the angles to its axis, x of the shading frame;
 * of the normal nothing is read, so that curves may be flat and turn to each ray. */
#ifndef AFTERGLOW_HAIR_H
#define AFTERGLOW_HAIR_H

#include "math/vec3.h"

enum { HAIR_TILTED = 3, HAIR_LOBES = 4 }; /* R, TT, TRT, whose angles the scales shift, and all longer paths */

/* The constants of a fibre, for all its points. */
typedef struct hair_fibre {
    double ior;                                     /* of the fibre in air */
    double precision[HAIR_LOBES], norm[HAIR_LOBES]; /* 1 / variance of the inclination, and its density's factor */
    double width, width_norm; /* scale of the logistic distribution of the azimuth, and the factor */
    double sin_tilt[HAIR_TILTED], cos_tilt[HAIR_TILTED]; /* of once, twice and four times the scales' angle */
} hair_fibre;

/* How light along one direction enters and crosses the fibre; the lobes' shares and centres follow from it. */
typedef struct hair_crossing {
    double reflected;           /* by the surface */
    double left[3];             /* transmittance of each channel after one crossing */
    double gamma, gamma_inside; /* angles of the ray to the normal, outside and within, across the fibre */
} hair_crossing;

/* Which surface has the fibre as its material: this decides how an offset across it appears from another direction. */
typedef enum hair_surface {
    HAIR_FACES_RAYS, /* a curve that turns to each ray, so that directions share no point of it: all offsets are as
                      * likely from each, and one stands for the others */
    HAIR_RIBBON,     /* a point stays where it is; from behind, the ribbon's left is its right */
    HAIR_OTHER       /* the offset is that of a mesh's own parameter from either side, as in pbrt */
} hair_surface;

/* A point of a fibre, and a direction of light scattered there. */
typedef struct hair_point {
    const hair_fibre *fibre;
    double azimuth;         /* of the direction: its angle about the axis */
    hair_crossing crossing; /* of the direction */
    rgb sigma_a;            /* absorbed per radius of the path within */
    float offset;           /* across the fibre, from 0 to 1 */
    float sine;             /* of the direction's inclination */
    hair_surface surface;
} hair_point;

/* Returns the absorption of hair that scatters light in a given colour, each channel in [0, 1] (Chiang 2016, eq. 9). */
rgb hair_absorption_from_reflectance(rgb reflectance, float beta_n);

hair_fibre hair_fibre_make(float ior, float beta_m, float beta_n, float tilt_degrees);

/* Initialises a point. v: its second surface parameter. out: in the shading frame, unit. It keeps the fibre's address,
 * and its surface faces rays. */
hair_point hair_point_at(const hair_fibre *fibre, rgb sigma_a, float v, vec3 out);

/* Computes f |cos|, and the density per solid angle with which hair_sample picks the direction: of radiance from
 * `direction` that leaves to `out`; or of flux from `out` that leaves to `direction`, per flux that meets the fibre. A
 * fibre that faces rays appears narrower the more it points to the light; for others the caller knows the normal, and
 * multiplies by the ratio of its cosines. is_same_side: whether `direction` and `out` are on one side of it. */
void hair_evaluate(const hair_point *p, bool is_flux, bool is_same_side, vec3 direction, rgb *out_value,
                   float *out_pdf);

vec3 hair_sample(const hair_point *point, bool is_flux, float u_lobe, vec2 u);

#endif
