/* spot_light.c: a point that shines into a cone, with a ramp at its rim.
 * Rests on: pbrt-v4's spot light (smoothstep in the cosine); Blender's, whose Cycles multiplied that by the cosine
 * itself before version 3.5, as was measured with 3.4. Threads: read-only. */
#include "light/light_type.h"
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
    return l->as.spot.dims_by_cosine ? float_max(1.0f - height, 0.0f) : 1.0f;
}

static rgb intensity(const light *l, vec3 direction)
{
    float height = one_minus_cos(l->as.spot.direction, direction);
    return rgb_scale(l->as.spot.intensity, ramp_at(l, height) * dimming_at(l, height));
}

/* The integral of the ramp, dimmed, over 1 - cos of the angle from the axis, up to that height. */
static double integral_to(const light *l, double height)
{
    const double start = (double)l->as.spot.falloff_start, end = (double)l->as.spot.falloff_end, ramp = end - start;
    const double dims = l->as.spot.dims_by_cosine ? 1.0 : 0.0, full = double_min(height, start);
    const double sum = full * (1.0 - 0.5 * dims * full);
    if (height <= start)
        return sum;
    const double x = (end - height) / ramp, cube = x * x * x; /* x: how far from the rim, in widths of the ramp */
    return sum + ramp * ((1.0 - dims * end) * (0.5 - cube * (1.0 - 0.5 * x)) +
                         dims * ramp * (0.35 - cube * x * (0.75 - 0.4 * x)));
}

/* A cone that dims ends at 90 degrees. */
static rgb power(const scene *s, const light *l)
{
    (void)s;
    return rgb_scale(l->as.spot.intensity, 2.0f * AG_PI * (float)integral_to(l, (double)l->as.spot.falloff_end));
}

/* The height below which there is that share of the light: Newton's steps, or halves where they would leave what is
 * known to hold it. Nowhere is there more light than in the full cone, where the first step is exact. */
static float height_of_share(const light *l, float share)
{
    const double end = (double)l->as.spot.falloff_end, wanted = (double)share * integral_to(l, end);
    double low = wanted, high = end, height = wanted, step = end;
    for (int i = 0; i < 64 && fabs(step) > 0x1p-30 * end; i++) {
        const double missing = wanted - integral_to(l, height);
        *(missing >= 0.0 ? &low : &high) = height;
        double next = height + missing / (double)(ramp_at(l, (float)height) * dimming_at(l, (float)height));
        if (!(next >= low && next <= high))
            next = 0.5 * (low + high);
        step = next - height;
        height = next;
    }
    return (float)height;
}

static bool emit(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                 light_emission *out)
{
    (void)s;
    if (!light_aim_point(l, target, l->as.spot.falloff_end, numbers, out)) {
        const frame f = frame_from_z(l->as.spot.direction);
        const float height = height_of_share(l, numbers->direction.x);
        out->direction = frame_to_world(&f, sample_uniform_cone((vec2){1.0f, numbers->direction.y}, height));
        out->flux = l->power;
    }
    return !rgb_is_black(out->flux);
}

static bool emission_numbers_of(const scene *s, const light *l, vec3 point, vec2 u, const light_sample *towards,
                                emission_numbers *in_out)
{
    (void)s, (void)point, (void)u;
    const vec3 direction = vec3_negate(towards->direction);
    const frame f = frame_from_z(l->as.spot.direction);
    const vec3 local = frame_to_local(&f, direction);
    const double share = integral_to(l, (double)one_minus_cos(l->as.spot.direction, direction)) /
                         integral_to(l, (double)l->as.spot.falloff_end);
    in_out->direction = (vec2){float_below_one((float)share), sample_uniform_sphere_inverse(local).y};
    return true;
}

static void narrow_bounds(const scene *s, const light *l, light_bounds *b)
{
    light_narrow_to_point(s, l, b);
    b->axis = l->as.spot.direction;
    b->cos_normals = 1.0f;
    b->cos_emission = float_max(1.0f - l->as.spot.falloff_end - LIGHT_BOUNDS_SLACK, LIGHT_BOUNDS_ALL_AROUND);
    b->intensity = rgb_mean(l->as.spot.intensity);
}

const light_type spot_light = {.init = init,
                               .add_hash = add_hash,
                               .power = power,
                               .intensity = intensity,
                               .sample_from_point = light_sample_of_point,
                               .emit = emit,
                               .emission_numbers_of = emission_numbers_of,
                               .narrow_bounds = narrow_bounds};
