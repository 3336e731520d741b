/* adaptive.c: see adaptive.h. */
#include "film/adaptive.h"

#include "parallel_for.h"

#include <stdlib.h>

/* What lies so near counts too: a bright sample that a pixel has not met may be met next door. */
enum { NEIGHBORHOOD = 2 };
/* In the dark, noise below this part of white is not seen. */
static const double DARKEST = 1e-3;

typedef struct decision {
    struct ag_film *film;
    double level;
    double *means, *variances;
    uint32_t next;
    atomic_u64 active; /* pixels that need more; order does not matter: relaxed */
} decision;

uint32_t adaptive_barrier(const struct ag_film *film)
{
    uint32_t most = 0;
    for (size_t i = 0; i < (size_t)film->width * (size_t)film->height; i++)
        most = film->wanted[i] > most ? film->wanted[i] : most;
    return most;
}

static void read_rows(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)block, (void)worker;
    const decision *d = user;
    size_t width = (size_t)d->film->width;
    for (size_t i = (size_t)begin * width; i < (size_t)end * width; i++)
        film_read_noise(d->film, i, &d->means[i], &d->variances[i]);
}

/* The standard error of a pixel as it is shown, root mean square over the neighbourhood. */
static double noise_at(const decision *d, int x, int y)
{
    int width = d->film->width, height = d->film->height, count = 0;
    double mean = 0.0, variance = 0.0;
    for (int j = y - NEIGHBORHOOD; j <= y + NEIGHBORHOOD; j++)
        for (int i = x - NEIGHBORHOOD; i <= x + NEIGHBORHOOD; i++)
            if (i >= 0 && i < width && j >= 0 && j < height) {
                size_t at = (size_t)j * (size_t)width + (size_t)i;
                mean += d->means[at];
                variance += d->variances[at];
                count++;
            }
    mean /= count;
    variance /= count;
    return 0.5 * sqrt(variance / fmax(mean, DARKEST)); /* d sqrt(x) = dx / (2 sqrt(x)) */
}

static void decide_rows(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)block, (void)worker;
    decision *d = user;
    uint64_t active = 0;
    for (uint64_t y = begin; y < end; y++)
        for (int x = 0; x < d->film->width; x++) {
            size_t pixel = (size_t)y * (size_t)d->film->width + (size_t)x;
            bool is_active = noise_at(d, x, (int)y) > d->level;
            d->film->wanted[pixel] = is_active ? d->next : d->film->counts[pixel];
            active += is_active;
        }
    fetch_add_relaxed_u64(&d->active, active);
}

ag_status adaptive_decide(struct ag_film *film, run_context *run, const ag_render_settings *settings, bool *out_is_done)
{
    size_t count = (size_t)film->width * (size_t)film->height;
    uint32_t barrier = adaptive_barrier(film), most = (uint32_t)settings->samples_per_pixel;
    uint32_t least = (uint32_t)settings->noise_min_samples;
    *out_is_done = false;
    if (barrier == 0) {
        for (size_t i = 0; i < count; i++)
            film->wanted[i] = least < most ? least : most;
        return AG_OK;
    }
    uint32_t step = barrier / 4 > 4 ? barrier / 4 : 4;
    decision d = {.film = film,
                  .level = (double)settings->noise_level,
                  .means = malloc(count * sizeof *d.means),
                  .variances = malloc(count * sizeof *d.variances),
                  .next = barrier + step < most ? barrier + step : most};
    ag_status status = d.means && d.variances ? AG_OK : AG_ERROR_MEMORY;
    double share = (double)barrier / (double)most;
    if (status == AG_OK)
        status = parallel_for(run, (uint64_t)film->height, 8, read_rows, &d, AG_PHASE_RENDER, share, share);
    if (status == AG_OK)
        status = parallel_for(run, (uint64_t)film->height, 8, decide_rows, &d, AG_PHASE_RENDER, share, share);
    *out_is_done = load_relaxed_u64(&d.active) == 0;
    free(d.means);
    free(d.variances);
    return status;
}
