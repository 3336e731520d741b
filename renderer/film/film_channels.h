/* film_channels.h: the picture and its layers, made of the sums of each pixel; and the same by the public interface.
 * Flow: film_sums -> [here] -> film_tiles, files. Threads: film_develop by the thread that owns the pixel; the others
 * when none is at work. */
#ifndef AFTERGLOW_FILM_CHANNELS_H
#define AFTERGLOW_FILM_CHANNELS_H

#include "film/film.h"

/* Gives one pixel of the area as the picture shows it. */
void film_develop(const struct ag_film *film, size_t pixel, float out[3]);

/* Reads a channel of the layout from a resolved film: width * height floats, stride apart. */
void film_read_channel(const struct ag_film *film, int channel, float *out, size_t stride);

/* Reads the means of a sum of 3 that the layout has: width * height pixels, packed, 3 floats each. */
void film_read_sum(const struct ag_film *film, film_sum sum, float *out);

#endif
