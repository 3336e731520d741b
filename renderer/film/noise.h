/* noise.h: how noisy a picture is, and which part of its light brings the noise.
 * Rests on: the standard error of a mean; measured as an eye sees it, of the square root of the value, which is about
 * how displays encode; above white, which they clip, relative to the value.
 * Flow: film -> [here] -> what the program says at the end. Threads: a pixel belongs to one worker at a time; read when
 * none is at work.
 *
 * The parts' variances are kept for some pixels alone, a lattice over the picture: enough to compare the parts. */
#ifndef AFTERGLOW_NOISE_H
#define AFTERGLOW_NOISE_H

#include "film/eye_sample.h"
#include "film/film_response.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct noise_lattice {
    int width, height; /* pixels of the area that it lies over */
    int stride;        /* from pixel to pixel of the lattice, in x and y */
    int columns, rows;
    double *sums; /* [rows * columns][NOISE_VALUES]; owned */
} noise_lattice;

/* Makes a lattice without samples over an area of that many pixels. Errors: AG_ERROR_MEMORY. */
ag_status noise_lattice_create(int width, int height, noise_lattice *out_lattice);
void noise_lattice_reset(noise_lattice *lattice);

/* Returns the size of its sums. */
size_t noise_lattice_bytes(const noise_lattice *lattice);

/* Returns whether the lattice holds a pixel, by its number in the area. */
static inline bool noise_lattice_holds(const noise_lattice *lattice, size_t pixel)
{
    int x = (int)(pixel % (size_t)lattice->width), y = (int)(pixel / (size_t)lattice->width);
    return x % lattice->stride == 0 && y % lattice->stride == 0;
}

/* Adds a sample of such a pixel; the sample has layers. */
void noise_lattice_add(noise_lattice *lattice, const film_response *response, size_t pixel, const eye_sample *sample);

/* Returns the variance of what is shown of a value with this mean and variance; white is 1. */
double noise_shown_variance(double mean, double variance);

/* Returns the ratio of shown values to the film's, by the settings' exposure. */
static inline double noise_shown_scale(const ag_render_settings *settings)
{
    return exp2((double)settings->shown_exposure_stops);
}

typedef struct noise_summary {
    double level; /* standard error of what is shown, root mean square over the picture; negative:
                     not known, too few samples */
    double share[AG_NOISE_SOURCE_COUNT]; /* of the variance, summing to 1; all 0: there is none */
    double sky_seen;                     /* share of the samples, of those that brought light, that the sky lit */
    double level_with_grain;             /* the level, with the grain of the caustics */
    bool is_caustic_grain;               /* most of the caustics' share does not get less by more samples */
} noise_summary;

/* Returns how noisy the lattice's pixels are. scale: noise_shown_scale. caustic_nearest: photons of a caustic's
 * estimate, whose grain counts as the caustics' noise; 0: there is no caustic map. The level is without the grain. */
noise_summary noise_lattice_read(const noise_lattice *lattice, double scale, int caustic_nearest);

#endif
