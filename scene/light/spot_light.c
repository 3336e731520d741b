/* spot_light.c: a point that shines into a cone, with a ramp at its rim.
 * Rests on: pbrt-v4's spot light (smoothstep in the cosine); Blender's, whose Cycles multiplied that by the cosine
 * itself before version 3.5, as was measured with 3.4. Threads: read-only. */
#include "light/light_type.h"
#include "math/rng.h"
#include "math/sampling.h"
#include "scene.h"

static void init(light *l) { l->as.spot.direction = (vec3){0.0f, 0.0f, 1.0f}; }

static void add_hash(const light *l, hash128 *h)
{
    const spot_source *spot = &l->as.spot;
    HASH128_ADD(h, spot->position);
    HASH128_ADD(h, spot->direction);
    HASH128_ADD(h, spot->intensity);
    HASH128_ADD(h, spot->falloff_start);
    HASH128_ADD(h, spot->falloff_end);
    HASH128_ADD(h, spot->dims_by_cosine);
}

void light_set_cone(light *l, double full_angle, double dark_angle)
{
    /* 1 - cos without the cancellation that narrow cones would suffer from */
    double full = sin(0.5 * full_angle), dark = sin(0.5 * dark_angle);
    l->as.spot.falloff_start = (float)(2.0 * full * full);
    l->as.spot.falloff_end = (float)(2.0 * dark * dark);
}

/* 1 - cos of the angle between two unit directions, without cancellation. */
static float one_minus_cos(vec3 a, vec3 b) { return 0.5f * vec3_distance_squared(a, b); }

/* 1 inside falloff_start, 0 outside falloff_end, smoothstep in the cosine between, as pbrt-v4. height: 1 - cos. */
static float ramp_at(const light *l, float height)
{
    if (height <= l->as.spot.falloff_start)
        return 1.0f;
    if (height >= l->as.spot.falloff_end)
        return 0.0f;
    float x = (l->as.spot.falloff_end - height) / (l->as.spot.falloff_end - l->as.spot.falloff_start);
    return x * x * (3.0f - 2.0f * x);
}

static float dimming_at(const light *l, float height)
{
    return l->as.spot.dims_by_cosine ? fmaxf(1.0f - height, 0.0f) : 1.0f;
}

static rgb intensity(const light *l, vec3 direction)
{
    float height = one_minus_cos(l->as.spot.direction, direction);
    return rgb_scale(l->as.spot.intensity, ramp_at(l, height) * dimming_at(l, height));
}

/* The integrals of ramp and dimming over the solid angle: half of the ramp's; a cone that dims ends at 90 degrees. */
static rgb power(const scene *s, const light *l)
{
    float start = l->as.spot.falloff_start, ramp = l->as.spot.falloff_end - start;
    (void)s;
    if (!l->as.spot.dims_by_cosine)
        return rgb_scale(l->as.spot.intensity, AG_PI * (start + l->as.spot.falloff_end));
    float full = start - 0.5f * start * start, edge = ramp * (0.5f * (1.0f - l->as.spot.falloff_end) + 0.35f * ramp);
    return rgb_scale(l->as.spot.intensity, 2.0f * AG_PI * (full + edge));
}

/* A direction in the cone, uniform but thinned by the falloff, so that all photons are equal: on average at least a
 * third are accepted, and what 64 trials refuse goes along the axis. */
static vec3 sample_spot(const light *l, const emission_numbers *numbers, rng *random)
{
    frame f = frame_from_z(l->as.spot.direction);
    vec3 local = {0.0f, 0.0f, 1.0f};
    float ramp = l->as.spot.falloff_end - l->as.spot.falloff_start;
    for (int trial = 0; trial < 64; trial++) {
        vec2 u = trial == 0 ? numbers->direction : rng_vec2(random);
        float x = ramp > 0.0f ? fminf((1.0f - u.x) * l->as.spot.falloff_end / ramp, 1.0f) : 1.0f;
        float dimming = dimming_at(l, u.x * l->as.spot.falloff_end);
        if (rng_float(random) < x * x * (3.0f - 2.0f * x) * dimming) {
            local = sample_uniform_cone(u, l->as.spot.falloff_end);
            break;
        }
    }
    return frame_to_world(&f, local);
}

static bool emit(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                 rng *random, light_emission *out)
{
    (void)s;
    if (!light_aim_point(l, target, l->as.spot.falloff_end, numbers, out)) {
        out->direction = sample_spot(l, numbers, random);
        out->flux = l->power;
    }
    return !rgb_is_black(out->flux);
}

static void narrow_bounds(const scene *s, const light *l, light_bounds *b)
{
    light_narrow_to_point(s, l, b);
    b->axis = l->as.spot.direction;
    b->cos_normals = 1.0f;
    b->cos_emission = fmaxf(1.0f - l->as.spot.falloff_end - LIGHT_BOUNDS_SLACK, LIGHT_BOUNDS_ALL_AROUND);
    b->intensity = rgb_mean(l->as.spot.intensity);
}

const light_type spot_light = {.init = init,
                               .add_hash = add_hash,
                               .power = power,
                               .intensity = intensity,
                               .sample_from_point = light_sample_of_point,
                               .emit = emit,
                               .narrow_bounds = narrow_bounds};
