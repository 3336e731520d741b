/* film_sums.h: how the sums of a pixel grow by a sample, and what they tell: means and variances.
 * Flow: eye_sample -> [here] -> film_channels, adaptive. Threads: a pixel belongs to one worker at a time. */
#ifndef AFTERGLOW_FILM_SUMS_H
#define AFTERGLOW_FILM_SUMS_H

#include "film/film.h"

/* Adds the next sample of a pixel, by the number of the pixel in the area. It has layers where the layout or the
 * noise's lattice wants them. */
void film_add(struct ag_film *film, size_t pixel, const eye_sample *sample);

/* Gives the means of count <= 3 sums that follow each other, from this offset among the pixel's sums on; of filters
 * with negative lobes with the samples' signs. All are 0 where the pixel has had no sample. */
void film_sums_mean(const struct ag_film *film, size_t pixel, int offset, int count, double out[3]);

/* Returns the mean of a sum over the samples that met a surface, whatever their sign; 0 where none did. The film must
 * sum SUM_HITS. */
double film_sums_hit_mean(const struct ag_film *film, size_t pixel, int offset);

/* Returns the variance of the samples, not of their mean, of a channel whose source is a variance; is_relative: over
 * the mean, as in pbrt. 0 where there are fewer than two. */
double film_sums_variance(const struct ag_film *film, size_t pixel, const film_channel *channel, bool is_relative);

/* Gives, of a pixel as the film develops it, the mean over the three colours, and the mean of the variances of these
 * means; both are 0 where there are fewer than two samples. The film must sum SUM_SQUARES. */
void film_read_noise(const struct ag_film *film, size_t pixel, double *out_mean, double *out_variance);

#endif
