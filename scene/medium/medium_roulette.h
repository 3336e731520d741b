/* medium_roulette.h: how paths of light end that media scatter again and again. Media that absorb nothing take nothing
 * off a path, so that roulette by what it carries never ends it; and a path never leaves a medium without bounds.
 * Rests on: Arvo, Kirk, "Particle Transport and Image Synthesis", 1990 (Russian roulette).
 * Flow: eye paths, gather rays and photons ask here where a medium has scattered them. Threads: pure functions. */
#ifndef AFTERGLOW_MEDIUM_ROULETTE_H
#define AFTERGLOW_MEDIUM_ROULETTE_H

enum {
    MEDIUM_ROULETTE_AFTER = 100, /* roulette begins behind so many scatterings by media */
    /* A path ends at so many. What is lost is less than 0.001 of the light that comes back out of a medium without
     * bound that absorbs nothing. */
    MEDIUM_SCATTERINGS_MAX = 1 << 20
};

/* Returns what roulette makes a path carry, in units of what it would without, behind so many scatterings by media: as
 * many times MEDIUM_ROULETTE_AFTER as there were, and at least 1. Of the paths that absorption does not end, one in
 * n / 100 then has n scatterings. In a white medium without bounds that is 1,030 scatterings a path on average. The
 * light that comes out of a white ball of 400 mean free paths has a standard deviation below its mean, since few paths
 * stay there for long. */
static inline float medium_roulette_level(int scatterings)
{
    return scatterings > MEDIUM_ROULETTE_AFTER ? (float)scatterings * (1.0f / (float)MEDIUM_ROULETTE_AFTER) : 1.0f;
}

#endif
