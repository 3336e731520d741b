/* sample_split.c: see sample_split.h. */
#include "film/sample_split.h"

#include <stdlib.h>

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

split_counts sample_split_first(const ag_render_settings *settings)
{
    uint32_t rays = (uint32_t)settings->gather_samples;
    if (rays > 0)
        return (split_counts){.rays = rays,
                              .lights = (rays + GATHER_RAYS_PER_LIGHT_SAMPLE - 1) / GATHER_RAYS_PER_LIGHT_SAMPLE};
    const int samples = expected_samples(settings);
    if (samples > 0 && AG_DEFAULT_GATHER_RAYS_PER_PIXEL / samples > SPLIT_FIRST_RAYS_MIN)
        rays = (uint32_t)(AG_DEFAULT_GATHER_RAYS_PER_PIXEL / samples);
    return (split_counts){.rays = rays > 0 ? rays : SPLIT_FIRST_RAYS_MIN, .lights = FIRST_LIGHTS};
}

split_counts sample_split_most(const ag_render_settings *settings, bool splits_samples)
{
    split_counts most = sample_split_first(settings);
    if (!sample_split_is_open(settings, splits_samples))
        return most;
    most.lights = LIGHTS_MAX;
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

void split_sums_add(split_sums *sums, const eye_sample *sample)
{
    rgb radiance = sample->radiance;
    float value = rgb_mean(radiance), rays = (float)sums->counts.rays, lights = (float)sums->counts.lights;
    float asked = (float)(1u << sums->counts.caustic_bits);
    sums->value += value;
    sums->square += value * value;
    sums->by_parts += sample->gather_variance;
    sums->by_ray += sample->gather_variance * rays;
    sums->cost_of_ray += (float)sample->gather_cost / rays;
    sums->cost_of_light += (float)sample->light_cost / lights;
    sums->by_parts += sample->caustic_square * (asked - 1.0f);
    sums->caustic += sample->caustic_square;
    sums->cost_of_caustic += (float)sample->caustic_cost * asked;
    sums->cost_of_rest += (float)sample->rest_cost;
    if (sums->counts.lights < 2)
        return;
    sums->by_parts += sample->light_variance;
    sums->by_light += sample->light_variance * lights;
    sums->lights_known++;
}
