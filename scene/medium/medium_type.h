/* medium_type.h: the functions of a kind of medium, in one file and one row of MEDIUM_KIND_LIST each.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 11.2 (transmittance, ratio tracking)
 * and 14.2 (null scattering).
 * Flow: medium.c and medium_flight.c ask the row of a medium's kind.
 * Threads: read-only tables of pure functions.
 *
 * Kinds that vary in space get the ray's own line, and answer for a stretch of it as a whole. One that has no closed
 * form, and tracks collisions with a majorant instead, keys its random numbers by hash_of_ray (math/rng.h) of the
 * stretch's origin and direction, as surfaces with alpha do: then no stream has to be handed down to shadow rays, and
 * the numbers depend on neither threads nor tiles nor what else was asked. A collision that only the majorant has
 * multiplies the transmittance of a flight by what is left of it, and each channel's density by that channel's own
 * probability of it; a flight's weight then comes out as for any other. */
#ifndef AFTERGLOW_MEDIUM_TYPE_H
#define AFTERGLOW_MEDIUM_TYPE_H

#include "medium/medium_flight.h"

/* Functions that may be NULL say so. */
typedef struct medium_type {
    /* Frees what the kind owns; NULL: nothing. */
    void (*reset)(medium *m);
    /* Adds the kind's members to a fingerprint. */
    void (*add_hash)(const medium *m, hash128 *h);
    bool (*scatters)(const medium *m);                                /* medium_scatters */
    rgb (*transmittance)(const medium *m, const medium_stretch *way); /* medium_transmittance */
    /* medium_flight_pass, of a medium that scatters: by medium_flight_go and medium_flight_scatter. */
    bool (*pass)(const medium *m, const medium_stretch *way, medium_flight *in_out_flight, float *out_distance);
} medium_type;

/* Each is defined in the file of its name. */
#define MEDIUM_TYPE_DECLARATION(kind, type) extern const medium_type type;
MEDIUM_KIND_LIST(MEDIUM_TYPE_DECLARATION)
#undef MEDIUM_TYPE_DECLARATION

extern const medium_type *const medium_types[MEDIUM_KIND_COUNT];

static inline const medium_type *medium_type_of(medium_kind kind) { return medium_types[kind]; }

/* --- what several kinds share --- */

/* The value of a flight's picked channel. */
static inline float medium_channel(rgb color, int channel)
{
    return channel == 0 ? color.r : channel == 1 ? color.g : color.b;
}

/* Takes a flight over a stretch by sampling in proportion to the transmittance over it. */
static inline void medium_flight_go(medium_flight *f, rgb transmittance)
{
    f->transmittance = rgb_mul(f->transmittance, transmittance);
    f->density = rgb_mul(f->density, transmittance);
}

/* Scatters it where it has come to. sigma_s, extinction: there, 1 / scene unit. */
static inline void medium_flight_scatter(medium_flight *f, rgb sigma_s, rgb extinction)
{
    f->transmittance = rgb_mul(f->transmittance, sigma_s);
    f->density = rgb_mul(f->density, extinction);
}

#endif
