/* splitting.c: see splitting.h. */
#include "film/splitting.h"

#include "film/adaptive.h"
#include "film/film.h"
#include "status.h"

#include <stdlib.h>

/* The split is decided again each time that there are so many times as many samples. */
enum { BARRIER_STEP = 4 };

/* Light samples of the first camera samples, at least: the pilot may have looked past small things. Where blocks choose
 * later, also of each of their camera rays: from one the variance cannot be told. */
enum { FIRST_LIGHTS_MIN = 4, FIRST_LIGHTS_OF_RAY_MIN = 2 };

/* Where blocks cannot trade camera samples for rays, the frame needs no standard error (noise.h) below this, which
 * nobody sees. */
static const double CLEAN = 0.003;

/* The frame's numbers depend on its variance and cost, and these on the numbers: each is computed from the other in so
 * many rounds. The pilot's pixels are summed by squares of GROUP by GROUP, since the variance of four samples is hardly
 * known. */
enum { FRAME_ROUNDS = 16, GROUP = 4 };

/* A block is told of by so many of the pilot's pixels on each side of its middle, at least: four samples of one alone
 * do not tell a variance. */
static const double PILOT_HALF_WINDOW = 2.0;

/* The least share of the variance between samples that counts as the camera samples' own: the rest that remains after
 * subtracting the others is not well known. */
static const double LEAST_REST = 1.0 / 64.0;

static const double SQRT_2 = 1.4142135623730951;

/* The number of a block's pixels, and sums over them: of variances of one sample, as shown, and of its costs. */
typedef struct block_sums {
    double pixels, all, own, by_parts; /* own: of light that the samples' own camera rays alone bring */
    double by_ray, by_light, by_camera_ray, caustic;
    double cost_of_ray, cost_of_light, cost_of_caustic, cost_of_further, cost_of_rest;
} block_sums;

/* The bounds of a block's choice. */
typedef struct choice {
    double scale; /* from radiance to what is shown */
    split_counts least, most;
    uint32_t least_lights; /* of all camera rays */
    double uneven;         /* the share of variance between camera rays that is left in the mean of a pixel's samples */
    double variance_allowed; /* of a sample where the least number is enough; 0: no pixel has more */
    double most_of_least;    /* the most samples of a pixel, as a multiple of the least */
} choice;

/* Returns the variance of a sum over samples. */
static double variance_of(float sum, float squares, double count)
{
    return double_max((double)squares - (double)sum * (double)sum / count, 0.0) / (count - 1.0);
}

/* Adds a pixel that has had so many samples, two or more. */
static void add_pixel(const split_sums *pixel, double count, const choice *c, block_sums *sums)
{
    double mean = (double)pixel->value / count, lights_known = (double)pixel->lights_known;
    double variance = variance_of(pixel->value, pixel->square, count);
    double own = variance_of(pixel->own, pixel->own_square, count);
    double by_light = lights_known > 0.0 ? (double)pixel->by_light / lights_known : 0.0;
    double weight = noise_shown_variance(c->scale * mean, c->scale * c->scale);
    /* not cut at 0 here, since variances of few samples differ by chance */
    double shared = variance - own - by_light * (double)pixel->per_light / count;
    sums->pixels += 1.0;
    sums->all += weight * variance;
    sums->own += weight * own;
    sums->by_parts += weight * (double)pixel->by_parts / count;
    sums->by_ray += weight * (double)pixel->by_ray / count;
    sums->by_light += weight * by_light;
    sums->by_camera_ray += weight * c->uneven * shared * count / (double)pixel->per_camera_ray;
    sums->caustic += weight * (double)pixel->caustic / count;
    sums->cost_of_ray += (double)pixel->cost_of_ray / count;
    sums->cost_of_light += (double)pixel->cost_of_light / count;
    sums->cost_of_caustic += (double)pixel->cost_of_caustic / count;
    sums->cost_of_further += (double)pixel->cost_of_further / count;
    sums->cost_of_rest += (double)pixel->cost_of_rest / count;
}

/* Variance and cost of camera samples without the parts that are chosen, summed over the block. */
typedef struct camera_part {
    double variance, cost;
} camera_part;

/* caustics: how many times their mean square is in the variance, beyond that of caustics which are always asked for.
 * cost: of all but the camera rays beyond one. */
static camera_part camera_part_of(const block_sums *sums, double caustics, double cost, double camera_rays)
{
    double own = double_max(sums->own - sums->by_parts + caustics * sums->caustic, 0.0);
    double variance = own + double_max(sums->by_camera_ray, 0.0) / camera_rays;
    return (camera_part){double_max(variance, LEAST_REST * sums->all),
                         cost + sums->cost_of_further * (camera_rays - 1.0)};
}

static double cost_per_variance_of(camera_part part) { return part.variance > 0.0 ? part.cost / part.variance : 0.0; }

/* Returns the number of samples of a part that is best for each camera sample. by_one, cost_of_one: the variance by one
 * of them, and its cost. */
static double wanted_count(double cost_per_variance, double by_one, double cost_of_one)
{
    return cost_per_variance > 0.0 && cost_of_one > 0.0 ? sqrt(by_one / cost_of_one * cost_per_variance) : 1.0;
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

static double wanted_camera_rays(double cost_per_variance, const block_sums *sums)
{
    return wanted_count(cost_per_variance, double_max(sums->by_camera_ray, 0.0), sums->cost_of_further);
}

/* Returns the next larger number of further camera rays. */
static uint32_t more_further(uint32_t further) { return further > 0 ? 2 * further : 1; }

/* Returns the number of further camera rays with which all camera rays are nearest by ratio to the number that is
 * wanted, within bounds. */
static uint32_t best_further(double wanted, uint32_t least, uint32_t most)
{
    uint32_t further = least;
    for (uint32_t next = more_further(further);
         next <= most && wanted * wanted > (1.0 + (double)further) * (1.0 + (double)next); next = more_further(next))
        further = next;
    return further;
}

/* Returns the least number of light samples of each of so many camera rays. */
static uint32_t least_lights_of_ray(const choice *c, uint32_t camera_rays)
{
    uint32_t lights = c->least.lights;
    while (lights * camera_rays < c->least_lights)
        lights *= 2;
    return lights;
}

/* Returns the number of light samples of each camera ray, a power of two, for so many of all of them. */
static uint32_t lights_of_ray(double wanted, uint32_t further, const choice *c)
{
    return best_count(wanted / (1.0 + (double)further), least_lights_of_ray(c, 1 + further), c->most.lights);
}

static split_counts counts_at(double cost_per_variance, uint32_t further, const block_sums *sums, const choice *c)
{
    double rays = wanted_count(cost_per_variance, sums->by_ray, sums->cost_of_ray);
    double lights = wanted_count(cost_per_variance, sums->by_light, sums->cost_of_light);
    double caustics = wanted_count(cost_per_variance, sums->caustic, sums->cost_of_caustic);
    return (split_counts){.further = further,
                          .caustic_bits = best_caustic_bits(caustics, c->most.caustic_bits),
                          .rays = best_count(rays, c->least.rays, c->most.rays),
                          .lights = lights_of_ray(lights, further, c)};
}

/* Returns the share of camera samples that ask for caustics. */
static double share_that_asks(uint32_t caustic_bits) { return 1.0 / (double)(1u << caustic_bits); }

/* Returns camera_part_of where that share asks. */
static camera_part camera_part_asking(const block_sums *sums, double share, double camera_rays)
{
    return camera_part_of(sums, 1.0 / share - 1.0, sums->cost_of_rest + sums->cost_of_caustic * share, camera_rays);
}

/* The numbers that a camera sample is split into, on average. */
typedef struct mean_counts {
    double rays, lights, camera_rays; /* lights: of all camera rays */
    double caustics;                  /* the share of camera samples that ask for caustics */
} mean_counts;

static mean_counts mean_counts_of(split_counts counts)
{
    const double camera_rays = (double)split_camera_rays(counts);
    return (mean_counts){(double)counts.rays, (double)counts.lights * camera_rays, camera_rays,
                         share_that_asks(counts.caustic_bits)};
}

/* Variance and cost of a camera sample that is split by these counts. */
static camera_part split_by(const block_sums *sums, mean_counts counts)
{
    camera_part part = camera_part_asking(sums, counts.caustics, counts.camera_rays);
    part.variance += sums->by_ray / counts.rays + sums->by_light / counts.lights;
    part.cost += sums->cost_of_ray * counts.rays + sums->cost_of_light * counts.lights;
    return part;
}

/* Returns what is best with one camera ray for a block that goes on until it is quiet enough, whatever others do. */
static split_counts best_with_one_ray(const block_sums *sums, const choice *c)
{
    camera_part rest = camera_part_of(sums, -1.0, sums->cost_of_rest, 1.0);
    uint32_t bits = counts_at(cost_per_variance_of(rest), 0, sums, c).caustic_bits;
    rest = camera_part_asking(sums, share_that_asks(bits), 1.0);
    split_counts counts = counts_at(cost_per_variance_of(rest), 0, sums, c);
    counts.caustic_bits = bits;
    return counts;
}

/* Returns best_with_one_ray, but with the camera rays for which the product of variance and cost is least. */
static split_counts best_of_block(const block_sums *sums, const choice *c)
{
    const split_counts one = best_with_one_ray(sums, c);
    split_counts best = one;
    double least = INFINITY; /* as are products of blinding light, none of which is less */
    for (uint32_t further = c->least.further; further <= c->most.further; further = more_further(further)) {
        split_counts n = one;
        n.further = further;
        n.lights = lights_of_ray((double)one.lights, further, c);
        camera_part part = split_by(sums, mean_counts_of(n));
        if (part.variance * part.cost < least) {
            least = part.variance * part.cost;
            best = n;
        }
    }
    return best;
}

/* Returns how many times the least number of samples so many pixels have. variance: of a sample, summed over them. */
static double times_least(double variance, double pixels, const choice *c)
{
    if (!(c->variance_allowed > 0.0))
        return 1.0;
    return double_clamp(variance / (c->variance_allowed * pixels), 1.0, c->most_of_least);
}

/* Returns the variance that a split leaves, and its cost in terms of variance, as the frame counts it. */
static double loss_by(split_counts counts, double cost_per_variance, const block_sums *sums, const choice *c)
{
    const camera_part part = split_by(sums, mean_counts_of(counts));
    const double times = times_least(part.variance, sums->pixels, c);
    return part.variance / times + part.cost * times / cost_per_variance;
}

static split_counts best_counts(const struct ag_film *film, const block_sums *sums, const choice *c)
{
    double of_frame = film->prior.cost_per_variance;
    if (!(of_frame > 0.0))
        return best_of_block(sums, c);
    uint32_t further = best_further(wanted_camera_rays(of_frame, sums), c->least.further, c->most.further);
    split_counts by_frame = counts_at(of_frame, further, sums, c);
    if (!(c->variance_allowed > 0.0))
        return by_frame;
    split_counts by_block = best_of_block(sums, c);
    return loss_by(by_block, of_frame, sums, c) < loss_by(by_frame, of_frame, sums, c) ? by_block : by_frame;
}

static choice make_choice(const struct ag_film *film, const ag_render_settings *settings)
{
    const double samples = (double)adaptive_least_samples(settings), level = (double)settings->noise_level;
    choice c = {.scale = noise_shown_scale(settings) * (double)settings->exposure,
                .least = {.rays = 1, .lights = 1},
                .most = sample_split_most(settings, true),
                .least_lights = 1,
                .uneven = 1.0 / sqrt(samples),
                .variance_allowed = level * level * samples,
                .most_of_least = (double)settings->samples_per_pixel / samples};
    c.most.further = film_further(film, c.most.further);
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
            add_pixel(&film->splits[pixel], (double)barrier, c, &sums);
        }
    split_counts before = film->splits[film_pixel_at(film, block.x0, block.y0)].counts;
    split_counts counts = best_counts(film, &sums, c);
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
    double half = double_max(0.5 * scale * (end - begin), PILOT_HALF_WINDOW);
    *out_first = (int)double_max(floor(middle - half), 0.0);
    *out_last = (int)double_min(ceil(middle + half), (double)size) - 1;
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
            add_pixel(&pilot->splits[pixel], (double)pilot->counts[pixel], c, &sums);
        }
    split_counts counts = best_counts(film, &sums, c), unknown = sample_split_first(settings, true);
    if (!(sums.cost_of_ray > 0.0)) /* the pilot has met nothing there that gathers */
        counts.rays = unknown.rays;
    if (!(sums.cost_of_light > 0.0))
        counts.lights = unknown.lights;
    return counts;
}

static size_t group_count(const struct ag_film *pilot)
{
    const int columns = (pilot->full_width + GROUP - 1) / GROUP, rows = (pilot->full_height + GROUP - 1) / GROUP;
    return (size_t)columns * (size_t)rows;
}

/* Sums the pilot's pixels, GROUP by GROUP. out_sums: group_count of them. */
static void sum_groups(const struct ag_film *pilot, const choice *c, block_sums *out_sums)
{
    for (int y0 = 0; y0 < pilot->full_height; y0 += GROUP)
        for (int x0 = 0; x0 < pilot->full_width; x0 += GROUP, out_sums++) {
            *out_sums = (block_sums){0};
            for (int y = y0; y < y0 + GROUP && y < pilot->full_height; y++)
                for (int x = x0; x < x0 + GROUP && x < pilot->full_width; x++) {
                    size_t pixel = film_pixel_at(pilot, x, y);
                    add_pixel(&pilot->splits[pixel], (double)pilot->counts[pixel], c, out_sums);
                }
            /* of edges in the light that the own camera rays alone bring, as much is left as of those in the other */
            out_sums->own = out_sums->by_parts + c->uneven * (out_sums->own - out_sums->by_parts);
        }
}

/* Adds variance and cost of a group's camera samples, with the numbers that are best at this cost per variance. */
static void add_group(const block_sums *sums, double cost_per_variance, const choice *c, camera_part *whole)
{
    double rays = wanted_count(cost_per_variance, sums->by_ray, sums->cost_of_ray);
    double lights = wanted_count(cost_per_variance, sums->by_light, sums->cost_of_light);
    double caustics = wanted_count(cost_per_variance, sums->caustic, sums->cost_of_caustic);
    double camera_rays = wanted_camera_rays(cost_per_variance, sums);
    camera_rays = double_clamp(camera_rays, 1.0 + (double)c->least.further, 1.0 + (double)c->most.further);
    mean_counts best = {
        .rays = double_clamp(rays, (double)c->least.rays, (double)c->most.rays),
        .lights = double_clamp(lights, double_max((double)c->least_lights, (double)c->least.lights * camera_rays),
                               (double)c->most.lights * camera_rays),
        .camera_rays = camera_rays,
        .caustics = double_clamp(caustics, share_that_asks(c->most.caustic_bits), 1.0)};
    camera_part part = split_by(sums, best);
    const double times = times_least(part.variance, sums->pixels, c);
    whole->variance += part.variance / times;
    whole->cost += part.cost * times;
}

/* Writes the cost of the frame's camera samples divided by their variance, when all blocks have the best numbers.
 * fixed: each camera sample's share of the cost that does not depend on their number. clean: the least variance of a
 * camera sample that counts. Errors: AG_ERROR_MEMORY. */
static ag_status find_cost_per_variance(const struct ag_film *pilot, const choice *c, double fixed, double clean,
                                        double *out)
{
    const size_t count = group_count(pilot);
    block_sums *groups = malloc(count * sizeof *groups);
    if (!groups)
        return AG_ERROR_MEMORY;
    sum_groups(pilot, c, groups);
    *out = 0.0;
    for (int round = 0; round < FRAME_ROUNDS; round++) {
        camera_part whole = {0};
        double pixels = 0.0;
        for (size_t i = 0; i < count; i++) {
            add_group(&groups[i], *out, c, &whole);
            pixels += groups[i].pixels;
        }
        *out = (whole.cost + fixed * pixels) / double_max(whole.variance, clean * pixels);
    }
    free(groups);
    return AG_OK;
}

ag_status splitting_begin(struct ag_film *film, const struct ag_film *pilot, double fixed_cost,
                          const ag_render_settings *settings)
{
    const film_area *all = &film->area;
    const int right = all->x0 + all->width, bottom = all->y0 + all->height;
    choice c = make_choice(film, settings);
    const double samples = (double)adaptive_least_samples(settings);
    const double fixed = fixed_cost / (samples * (double)settings->width * (double)settings->height);
    const double clean = CLEAN * CLEAN * samples;
    split_prior *prior = &film->prior;
    AG_TRY(find_cost_per_variance(pilot, &c, fixed, clean, &prior->cost_per_variance));
    c.least.further = film_first_split(film, settings).further;
    if (sample_split_goes_on(settings, true)) {
        c.least.rays = SPLIT_FIRST_RAYS_MIN;
        c.least.lights = FIRST_LIGHTS_OF_RAY_MIN;
    }
    c.least_lights = FIRST_LIGHTS_MIN;
    if (!prior->first)
        prior->first = malloc((film_block_number(film, right - 1, bottom - 1) + 1) * sizeof *prior->first);
    if (!prior->first)
        return AG_ERROR_MEMORY;
    for (int y = all->y0 / FILM_BLOCK * FILM_BLOCK; y < bottom; y += FILM_BLOCK)
        for (int x = all->x0 / FILM_BLOCK * FILM_BLOCK; x < right; x += FILM_BLOCK)
            prior->first[film_block_number(film, x, y)] = counts_by_pilot(film, pilot, x, y, &c, settings);
    film_set_first_splits(film, settings);
    return AG_OK;
}

uint32_t splitting_decide(struct ag_film *film, const ag_render_settings *settings, uint32_t wanted)
{
    uint32_t least = least_count(film, wanted);
    uint64_t barrier = SPLIT_FIRST_BARRIER;
    while (barrier < least)
        barrier *= BARRIER_STEP;
    if (barrier == least && least < wanted) {
        choice c = make_choice(film, settings);
        for (int row = 0; row * FILM_BLOCK < film->area.height; row++)
            for (int column = 0; column * FILM_BLOCK < film->area.width; column++)
                decide_block(film, film_block_at(film, column, row), least, &c);
        barrier *= BARRIER_STEP;
    }
    return barrier < wanted ? (uint32_t)barrier : wanted;
}
