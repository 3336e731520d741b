/* splitting.c: see splitting.h. */
#include "film/splitting.h"

#include "film/film.h"

#include <stdlib.h>

/* The split is decided at FIRST_BARRIER samples, and each time that there are BARRIER_STEP times as many. */
enum { FIRST_BARRIER = 4, BARRIER_STEP = 4 };

/* So many samples of a pixel are expected with a level of noise: AG_DEFAULT_GATHER_RAYS_PER_PIXEL is shared out among
 * them. */
enum { ADAPTIVE_SAMPLES = 64 };

/* Without a choice there is a light sample for so many gather rays. With it there are many at first: blocks where few
 * are enough find that out, and behind windows, where light comes from is what is known least. */
enum { GATHER_RAYS_PER_LIGHT_SAMPLE = 8, FIRST_LIGHTS = 16 };
enum { RAYS_MAX = 64, LIGHTS_MAX = 16 };
/* Caustics that a block's first samples have missed are 2 to this power times as bright, at most; blocks that stop at a
 * level of noise might stop before they are asked for. */
enum { CAUSTIC_BITS_FIXED = 2, CAUSTIC_BITS_ADAPTIVE = 1 };

/* Rays and light samples of the first camera samples, at least: from one the variance cannot be told, and the pilot may
 * have looked past small things. */
enum { FIRST_RAYS_MIN = 4, FIRST_LIGHTS_MIN = 4 };

/* With a fixed number of camera samples each block has so many gather rays for each, or half of the most: samples along
 * edges vary much, but are spread so well that little of that is left in the mean (Mitchell, "Consequences of
 * Stratified Sampling in Graphics", 1996). So inner samples are worth more than the variance of single camera samples
 * says: by the root of how many of these there are, but no more than twice, as measured in five scenes. */
enum { FIXED_LEAST = 8 };
static const double FIXED_FACTOR_MOST = 2.0;
/* With a fixed number of camera samples no block needs a standard error (noise.h) below this, which nobody sees. */
static const double FIXED_CLEAN = 0.003;

/* A block is told of by so many of the pilot's pixels on each side of its middle, at least: four samples of one alone
 * do not tell a variance. */
static const double PILOT_HALF_WINDOW = 2.0;

/* The least share of the variance between samples that counts as the camera samples' own: the rest that remains after
 * subtracting the others is not well known. */
static const double LEAST_REST = 1.0 / 64.0;

static const double SQRT_2 = 1.4142135623730951;

bool splitting_is_open(const ag_render_settings *settings, bool splits_samples)
{
    return splits_samples && settings->gather_samples == 0;
}

bool splitting_goes_on(const ag_render_settings *settings, bool splits_samples)
{
    return splitting_is_open(settings, splits_samples) &&
           (settings->noise_level > 0.0f || settings->samples_per_pixel > FIRST_BARRIER);
}

int splitting_expected_samples(const ag_render_settings *settings)
{
    const int samples = settings->samples_per_pixel;
    return settings->noise_level > 0.0f && samples > ADAPTIVE_SAMPLES ? ADAPTIVE_SAMPLES : samples;
}

split_counts splitting_first(const ag_render_settings *settings)
{
    uint32_t rays = (uint32_t)settings->gather_samples;
    if (rays > 0)
        return (split_counts){.rays = rays,
                              .lights = (rays + GATHER_RAYS_PER_LIGHT_SAMPLE - 1) / GATHER_RAYS_PER_LIGHT_SAMPLE};
    const int samples = splitting_expected_samples(settings);
    if (samples > 0 && AG_DEFAULT_GATHER_RAYS_PER_PIXEL / samples > FIRST_RAYS_MIN)
        rays = (uint32_t)(AG_DEFAULT_GATHER_RAYS_PER_PIXEL / samples);
    return (split_counts){.rays = rays > 0 ? rays : FIRST_RAYS_MIN, .lights = FIRST_LIGHTS};
}

split_counts splitting_most(const ag_render_settings *settings, bool splits_samples)
{
    split_counts most = splitting_first(settings);
    if (!splitting_is_open(settings, splits_samples))
        return most;
    most.lights = LIGHTS_MAX;
    if (!(settings->clamp_indirect > 0.0f)) /* a bound would cut what chance has made brighter */
        most.caustic_bits = settings->noise_level > 0.0f ? CAUSTIC_BITS_ADAPTIVE : CAUSTIC_BITS_FIXED;
    if (settings->noise_level > 0.0f && most.rays < RAYS_MAX) /* else the first rays bound the time */
        most.rays = RAYS_MAX;
    return most;
}

void split_trial_add(split_trial *trial, const eye_sample *sample)
{
    rgb radiance = sample->radiance;
    float value = rgb_mean(radiance), rays = (float)trial->counts.rays, lights = (float)trial->counts.lights;
    float asked = (float)(1u << trial->counts.caustic_bits);
    trial->value += value;
    trial->square += value * value;
    trial->by_parts += sample->gather_variance;
    trial->by_ray += sample->gather_variance * rays;
    trial->cost_of_ray += (float)sample->gather_cost / rays;
    trial->cost_of_light += (float)sample->light_cost / lights;
    trial->by_parts += sample->caustic_square * (asked - 1.0f);
    trial->caustic += sample->caustic_square;
    trial->cost_of_caustic += (float)sample->caustic_cost * asked;
    trial->cost_of_rest += (float)sample->rest_cost;
    if (trial->counts.lights < 2)
        return;
    trial->by_parts += sample->light_variance;
    trial->by_light += sample->light_variance * lights;
    trial->lights_known++;
}

/* --- deciding --- */

/* Over a block: how many pixels, their variances of what is shown of one sample, and costs. */
typedef struct block_sums {
    double pixels, all, by_parts, by_ray, by_light, caustic;
    double cost_of_ray, cost_of_light, cost_of_caustic, cost_of_rest;
} block_sums;

static void add_pixel(const split_trial *trial, double count, double scale, block_sums *sums)
{
    double mean = (double)trial->value / count, lights_known = (double)trial->lights_known;
    double variance = fmax((double)trial->square - (double)trial->value * mean, 0.0) / (count - 1.0);
    double weight = noise_shown_variance(scale * mean, scale * scale);
    sums->pixels += 1.0;
    sums->all += weight * variance;
    sums->by_parts += weight * (double)trial->by_parts / count;
    sums->by_ray += weight * (double)trial->by_ray / count;
    sums->by_light += lights_known > 0.0 ? weight * (double)trial->by_light / lights_known : 0.0;
    sums->caustic += weight * (double)trial->caustic / count;
    sums->cost_of_ray += (double)trial->cost_of_ray;
    sums->cost_of_light += (double)trial->cost_of_light;
    sums->cost_of_caustic += (double)trial->cost_of_caustic;
    sums->cost_of_rest += (double)trial->cost_of_rest;
}

/* The bounds of a block's choice. */
typedef struct choice {
    double scale;  /* from radiance to what is shown */
    double factor; /* of the numbers that are best for single camera samples */
    double clean;  /* the variance of a sample that does no harm; 0: none */
    split_counts least, most;
} choice;

/* Variance and cost of camera samples without the parts that are chosen, summed over the block. */
typedef struct camera_part {
    double variance, cost;
} camera_part;

/* caustics: how many times their mean square is in the variance, beyond that of caustics which are always asked for. */
static camera_part camera_part_of(const block_sums *sums, const choice *c, double caustics, double cost)
{
    double variance = fmax(sums->all - sums->by_parts + caustics * sums->caustic, LEAST_REST * sums->all);
    return (camera_part){fmax(variance, c->clean * sums->pixels), cost};
}

/* The number of samples of a part that is best for each camera sample. */
static double wanted_count(const camera_part *rest, const choice *c, double by_one, double cost_of_one)
{
    if (!(rest->variance > 0.0 && cost_of_one > 0.0))
        return 1.0;
    return c->factor * sqrt(by_one / rest->variance * rest->cost / cost_of_one);
}

/* The power of two nearest by ratio to the number that is wanted, within bounds. */
static uint32_t best_count(double wanted, uint32_t least, uint32_t most)
{
    uint32_t count = 1;
    while (count < most && (double)count * SQRT_2 < wanted)
        count *= 2;
    count = count > least ? count : least;
    return count < most ? count : most;
}

static uint32_t best_caustic_bits(double wanted, uint32_t most)
{
    uint32_t bits = 0;
    while (bits < most && wanted * (double)(2u << bits) < SQRT_2)
        bits++;
    return bits;
}

static split_counts best_counts(const block_sums *sums, const choice *c)
{
    camera_part rest = camera_part_of(sums, c, -1.0, sums->cost_of_rest);
    uint32_t bits =
        best_caustic_bits(wanted_count(&rest, c, sums->caustic, sums->cost_of_caustic), c->most.caustic_bits);
    double shared = (double)(1u << bits); /* so many samples share an estimate of caustics */
    rest = camera_part_of(sums, c, shared - 1.0, sums->cost_of_rest + sums->cost_of_caustic / shared);
    return (split_counts){
        .caustic_bits = bits,
        .rays = best_count(wanted_count(&rest, c, sums->by_ray, sums->cost_of_ray), c->least.rays, c->most.rays),
        .lights =
            best_count(wanted_count(&rest, c, sums->by_light, sums->cost_of_light), c->least.lights, c->most.lights)};
}

static choice make_choice(const ag_render_settings *settings)
{
    choice c = {noise_shown_scale(settings) * (double)settings->exposure,
                1.0,
                0.0,
                {.rays = 1, .lights = 1},
                splitting_most(settings, true)};
    if (settings->noise_level > 0.0f)
        return c;
    c.factor = fmin(sqrt((double)settings->samples_per_pixel), FIXED_FACTOR_MOST);
    c.least.rays = (c.most.rays + 1) / 2 < FIXED_LEAST ? (c.most.rays + 1) / 2 : FIXED_LEAST;
    c.clean = FIXED_CLEAN * FIXED_CLEAN * settings->samples_per_pixel;
    return c;
}

/* A block all of whose pixels have had `barrier` samples; another was decided on before, or needs no more. */
static void decide_block(struct ag_film *film, film_area block, uint32_t barrier, const choice *c)
{
    block_sums sums = {0};
    for (int y = block.y0; y < block.y0 + block.height; y++)
        for (int x = block.x0; x < block.x0 + block.width; x++) {
            size_t pixel = film_pixel_at(film, x, y);
            if (film->counts[pixel] != barrier)
                return;
            add_pixel(&film->splits[pixel], (double)barrier, c->scale, &sums);
        }
    split_counts before = film->splits[film_pixel_at(film, block.x0, block.y0)].counts;
    split_counts counts = best_counts(&sums, c);
    uint32_t used = (barrier + before.ray_shift) * before.rays;
    counts.ray_shift = (used + counts.rays - 1) / counts.rays - barrier;
    for (int y = block.y0; y < block.y0 + block.height; y++)
        for (int x = block.x0; x < block.x0 + block.width; x++)
            film->splits[film_pixel_at(film, x, y)].counts = counts;
}

/* The least number of samples of a pixel that is to have more; `wanted` where none is. */
static uint32_t least_count(const struct ag_film *film, uint32_t wanted)
{
    uint32_t least = wanted;
    for (size_t i = 0; i < film_area_count(film); i++)
        if (film->counts[i] < film_goal(film, i, wanted) && film->counts[i] < least)
            least = film->counts[i];
    return least;
}

/* The pixels of the pilot, within [0, size), that tell of the block that begins at a pixel of the large picture: those
 * that lie there, and enough of those around. */
static void find_window(int begin, int large_size, int size, int *out_first, int *out_last)
{
    int end = begin + FILM_BLOCK < large_size ? begin + FILM_BLOCK : large_size;
    double scale = (double)size / (double)large_size, middle = 0.5 * scale * (begin + end);
    double half = fmax(0.5 * scale * (end - begin), PILOT_HALF_WINDOW);
    *out_first = (int)fmax(floor(middle - half), 0.0);
    *out_last = (int)fmin(ceil(middle + half), (double)size) - 1;
}

static split_counts counts_by_pilot(const struct ag_film *film, const struct ag_film *pilot, int x, int y,
                                    const choice *c, const ag_render_settings *settings)
{
    int x0, x1, y0, y1;
    block_sums sums = {0};
    find_window(x, film->full_width, pilot->full_width, &x0, &x1);
    find_window(y, film->full_height, pilot->full_height, &y0, &y1);
    for (int row = y0; row <= y1; row++)
        for (int column = x0; column <= x1; column++) {
            size_t pixel = film_pixel_at(pilot, column, row);
            add_pixel(&pilot->splits[pixel], (double)pilot->counts[pixel], c->scale, &sums);
        }
    split_counts counts = best_counts(&sums, c), unknown = splitting_first(settings);
    if (!(sums.cost_of_ray > 0.0)) /* the pilot has met nothing there that gathers */
        counts.rays = unknown.rays;
    if (!(sums.cost_of_light > 0.0))
        counts.lights = unknown.lights;
    return counts;
}

ag_status splitting_begin(struct ag_film *film, const struct ag_film *pilot, const ag_render_settings *settings)
{
    const film_area *all = &film->area;
    const int right = all->x0 + all->width, bottom = all->y0 + all->height;
    choice c = make_choice(settings);
    c.least.rays = c.least.rays > FIRST_RAYS_MIN ? c.least.rays : FIRST_RAYS_MIN;
    c.least.lights = FIRST_LIGHTS_MIN;
    if (!film->first_splits)
        film->first_splits = malloc((film_block_number(film, right - 1, bottom - 1) + 1) * sizeof *film->first_splits);
    if (!film->first_splits)
        return AG_ERROR_MEMORY;
    for (int y = all->y0 / FILM_BLOCK * FILM_BLOCK; y < bottom; y += FILM_BLOCK)
        for (int x = all->x0 / FILM_BLOCK * FILM_BLOCK; x < right; x += FILM_BLOCK)
            film->first_splits[film_block_number(film, x, y)] = counts_by_pilot(film, pilot, x, y, &c, settings);
    film_begin_splits(film, settings);
    return AG_OK;
}

uint32_t splitting_decide(struct ag_film *film, const ag_render_settings *settings, uint32_t wanted)
{
    uint32_t least = least_count(film, wanted);
    uint64_t barrier = FIRST_BARRIER;
    while (barrier < least)
        barrier *= BARRIER_STEP;
    if (barrier == least && least < wanted) {
        choice c = make_choice(settings);
        for (int row = 0; row * FILM_BLOCK < film->area.height; row++)
            for (int column = 0; column * FILM_BLOCK < film->area.width; column++)
                decide_block(film, film_block_at(film, column, row), least, &c);
        barrier *= BARRIER_STEP;
    }
    return barrier < wanted ? (uint32_t)barrier : wanted;
}
