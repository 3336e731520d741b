/* sample_split.c: see sample_split.h. */
#include "film/sample_split.h"

#include <math.h>
#include <stdlib.h>

/* So many samples of a pixel are expected with a level of noise: AG_DEFAULT_GATHER_RAYS_PER_PIXEL is shared out among
 * them. */
enum { ADAPTIVE_SAMPLES = 64 };

/* Without a choice there is a light sample for so many gather rays. With it there are many at first: blocks where few
 * are enough find that out, and behind windows, where light comes from is what is known least. */
enum { GATHER_RAYS_PER_LIGHT_SAMPLE = 8, FIRST_LIGHTS = 16 };
enum { RAYS_MAX = 64, LIGHTS_MAX = 16, FURTHER_MAX = 8 };
/* Further camera rays of each of the first samples, before a block has chosen: with a level of noise; and at least,
 * with a fixed number of samples that is small, since the small picture may have looked past small things. */
enum { FIRST_FURTHER = 2, FURTHER_OF_FEW = 1, FEW_SAMPLES = 8 };
/* Caustics that a block's first samples have missed are 2 to this power times as bright, at most; blocks that stop at a
 * level of noise might stop before they are asked for. */
enum { CAUSTIC_BITS_FIXED = 2, CAUSTIC_BITS_ADAPTIVE = 1 };

bool sample_split_is_open(const ag_render_settings *settings, bool splits_samples)
{
    return splits_samples && settings->gather_samples == 0;
}

bool sample_split_goes_on(const ag_render_settings *settings, bool splits_samples)
{
    return sample_split_is_open(settings, splits_samples) &&
           (settings->noise_level > 0.0f || settings->samples_per_pixel > SPLIT_FIRST_BARRIER);
}

/* How many samples a pixel is expected to get, at most: with a level of noise, few get as many as they may. */
static int expected_samples(const ag_render_settings *settings)
{
    const int samples = settings->samples_per_pixel;
    return settings->noise_level > 0.0f && samples > ADAPTIVE_SAMPLES ? ADAPTIVE_SAMPLES : samples;
}

/* Returns the most further camera rays that a sample may have. They bring nothing where indirect light alone is asked
 * for. */
static uint32_t most_further(const ag_render_settings *settings, bool splits_samples)
{
    return sample_split_is_open(settings, splits_samples) && settings->only == AG_ONLY_ALL ? FURTHER_MAX : 0;
}

static uint32_t first_further(const ag_render_settings *settings, bool splits_samples)
{
    if (most_further(settings, splits_samples) == 0)
        return 0;
    return settings->noise_level > 0.0f                 ? FIRST_FURTHER
           : settings->samples_per_pixel <= FEW_SAMPLES ? FURTHER_OF_FEW
                                                        : 0;
}

split_counts sample_split_first(const ag_render_settings *settings, bool splits_samples)
{
    uint32_t rays = (uint32_t)settings->gather_samples;
    if (rays > 0)
        return (split_counts){.rays = rays,
                              .lights = (rays + GATHER_RAYS_PER_LIGHT_SAMPLE - 1) / GATHER_RAYS_PER_LIGHT_SAMPLE};
    const int samples = expected_samples(settings);
    if (samples > 0 && AG_DEFAULT_GATHER_RAYS_PER_PIXEL / samples > SPLIT_FIRST_RAYS_MIN)
        rays = (uint32_t)(AG_DEFAULT_GATHER_RAYS_PER_PIXEL / samples);
    split_counts first = {.rays = rays > 0 ? rays : SPLIT_FIRST_RAYS_MIN,
                          .further = first_further(settings, splits_samples),
                          .lights = FIRST_LIGHTS};
    while (first.lights > 1 && first.lights * split_camera_rays(first) > FIRST_LIGHTS)
        first.lights /= 2;
    return first;
}

split_counts sample_split_most(const ag_render_settings *settings, bool splits_samples)
{
    split_counts most = sample_split_first(settings, splits_samples);
    if (!sample_split_is_open(settings, splits_samples))
        return most;
    most.lights = LIGHTS_MAX;
    most.further = most_further(settings, splits_samples);
    if (!(settings->clamp_indirect > 0.0f)) /* a bound would cut what chance has made brighter */
        most.caustic_bits = settings->noise_level > 0.0f ? CAUSTIC_BITS_ADAPTIVE : CAUSTIC_BITS_FIXED;
    if (settings->noise_level > 0.0f && most.rays < RAYS_MAX) /* else the first rays bound the time */
        most.rays = RAYS_MAX;
    return most;
}

void split_prior_reset(split_prior *prior)
{
    free(prior->first);
    *prior = (split_prior){0};
}

/* Where there is no further camera ray, one is taken to cost what the sample's own costs without its way into the film;
 * in the units of eye_worker_cost. */
static const float COST_INTO_FILM = 16.0f, FURTHER_COST_MIN = 8.0f;

static float cost_of_further(const eye_sample *sample, uint32_t further)
{
    return further > 0 ? (float)sample->further_cost / (float)further
                       : float_max((float)sample->rest_cost - COST_INTO_FILM, FURTHER_COST_MIN);
}

void split_sums_add(split_sums *sums, const eye_sample *sample)
{
    const split_counts counts = sums->counts;
    const float value = rgb_mean(sample->radiance), asked = (float)(1u << counts.caustic_bits);
    const float rays = (float)counts.rays, camera_rays = (float)split_camera_rays(counts);
    const float lights = (float)counts.lights * camera_rays;
    sums->value += value;
    sums->square += value * value;
    sums->own += sample->own;
    sums->own_square += sample->own * sample->own;
    sums->by_parts += sample->gather_variance + sample->caustic_square * (asked - 1.0f);
    sums->by_ray += sample->gather_variance * rays;
    sums->caustic += sample->caustic_square;
    sums->per_light += 1.0f / lights;
    sums->per_camera_ray += 1.0f / camera_rays;
    sums->cost_of_ray += (float)sample->gather_cost / rays;
    sums->cost_of_light += (float)sample->light_cost / lights;
    sums->cost_of_caustic += (float)sample->caustic_cost * asked;
    sums->cost_of_further += cost_of_further(sample, counts.further);
    sums->cost_of_rest += (float)sample->rest_cost;
    if (counts.lights < 2)
        return;
    sums->by_light += sample->light_variance * lights;
    sums->lights_known++;
}
