/* medium_flight.h: how far light goes through media until one of them scatters it, sampled.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 11.2.1 and 14.2; Wilkie, Nawaz,
 * Droske, Weidlich, Hanika, "Hero Wavelength Spectral Sampling", 2014 (one colour is sampled, and the result is
 * weighed by the density of all of them together).
 * Flow: transmittance.c follows rays from surface to surface, and asks here at each stretch between them.
 * Threads: pure functions. */
#ifndef AFTERGLOW_MEDIUM_FLIGHT_H
#define AFTERGLOW_MEDIUM_FLIGHT_H

#include "medium/medium.h"

/* A flight picks one colour channel, and the optical thickness in it at which light is scattered. It goes through one
 * medium after another. Media that do not scatter have no part in that: they absorb. */
typedef struct medium_flight {
    int channel;       /* 0 to 2: red, green, blue */
    rgb probability;   /* of each channel to be picked */
    float thickness;   /* of that channel, that is left until light is scattered */
    rgb transmittance; /* so far; where light has been scattered, times sigma_s there */
    rgb density; /* of having come so far, if a channel were the picked one; where light has been scattered, times the
                    extinction there, 1 / scene unit */
} medium_flight;

/* Begins a flight by two random numbers in [0, 1). carried: what the light that flies carries already, in any unit; a
 * channel is picked in proportion to it. The sum of what is carried times the flight's weight is then never larger than
 * that of what was carried, after however many flights; picked evenly, channels would weigh up to three times as much
 * after each. */
medium_flight medium_flight_begin(rgb carried, vec2 u);

/* Goes on over a stretch within one medium. Returns whether light is scattered on the way, and then writes the distance
 * from the stretch's origin to there, less than its length. */
bool medium_flight_pass(medium_flight *f, const medium *m, const medium_stretch *way, float *out_distance);

/* Returns the weight of the light at the end of the flight: transmittance over the density of all channels, by their
 * probabilities. A channel that carries nothing has none. */
rgb medium_flight_weight(const medium_flight *f);

#endif
