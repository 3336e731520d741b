/* adaptive.c: see adaptive.h. */
#include "film/adaptive.h"

#include "film/film_sums.h"
#include "parallel_for.h"

#include <stdlib.h>

typedef struct decision {
    struct ag_film *film;
    double level_squared, scale;
    uint32_t next;
    atomic_u64 active; /* blocks that need more; order does not matter: relaxed */
} decision;

int adaptive_least_samples(const ag_render_settings *settings)
{
    const int most = settings->samples_per_pixel, least = settings->noise_min_samples;
    return settings->noise_level > 0.0f && least < most ? least : most;
}

uint32_t adaptive_barrier(const struct ag_film *film)
{
    uint32_t most = 0;
    for (size_t i = 0; i < film_area_count(film); i++)
        most = film->wanted[i] > most ? film->wanted[i] : most;
    return most;
}

/* The variance of what is shown, mean over the block. A rare bright sample keeps a block going: of a pixel that has met
 * one alone, the variance is the square of the mean that it makes. */
static double block_variance(const decision *d, film_area block)
{
    double shown = 0.0;
    for (int y = block.y0; y < block.y0 + block.height; y++)
        for (int x = block.x0; x < block.x0 + block.width; x++) {
            double mean, variance;
            film_read_noise(d->film, film_pixel_at(d->film, x, y), &mean, &variance);
            shown += noise_shown_variance(d->scale * mean, d->scale * d->scale * variance);
        }
    return shown / ((double)block.width * (double)block.height);
}

static void decide_rows(void *user, uint64_t begin, uint64_t end, uint64_t block_of_rows, unsigned worker)
{
    (void)block_of_rows, (void)worker;
    decision *d = user;
    struct ag_film *film = d->film;
    int columns = (film->area.width + FILM_BLOCK - 1) / FILM_BLOCK;
    uint64_t active = 0;
    for (uint64_t row = begin; row < end; row++)
        for (int column = 0; column < columns; column++) {
            film_area block = film_block_at(film, column, (int)row);
            bool is_active = block_variance(d, block) > d->level_squared;
            active += is_active;
            for (int y = block.y0; y < block.y0 + block.height; y++)
                for (int x = block.x0; x < block.x0 + block.width; x++) {
                    size_t pixel = film_pixel_at(film, x, y);
                    film->wanted[pixel] = is_active ? d->next : film->counts[pixel];
                }
        }
    fetch_add_relaxed_u64(&d->active, active);
}

ag_status adaptive_decide(struct ag_film *film, run_context *run, const ag_render_settings *settings, bool *out_is_done)
{
    uint32_t barrier = adaptive_barrier(film), most = (uint32_t)settings->samples_per_pixel;
    *out_is_done = false;
    if (barrier == 0) {
        const uint32_t least = (uint32_t)adaptive_least_samples(settings);
        for (size_t i = 0; i < film_area_count(film); i++)
            film->wanted[i] = least;
        return AG_OK;
    }
    uint32_t step = barrier / 4 > 4 ? barrier / 4 : 4;
    double level = (double)settings->noise_level, share = (double)barrier / (double)most;
    decision d = {.film = film,
                  .level_squared = level * level,
                  .scale = noise_shown_scale(settings),
                  .next = barrier + step < most ? barrier + step : most};
    uint64_t rows = (uint64_t)((film->area.height + FILM_BLOCK - 1) / FILM_BLOCK);
    ag_status status = parallel_for(run, rows, 1, decide_rows, &d, AG_PHASE_RENDER, share, share);
    *out_is_done = load_relaxed_u64(&d.active) == 0;
    return status;
}
