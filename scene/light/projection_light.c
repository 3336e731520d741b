/* projection_light.c: a point that throws a picture, as a slide projector does.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 12.2.3. Threads: read-only. */
#include "light/light_type.h"
#include "light/projection.h"
#include "scene.h"

static rgb power(const scene *s, const light *l)
{
    (void)s;
    return rgb_mul(l->intensity, l->projection->integral);
}

static rgb intensity(const light *l, vec3 direction)
{
    return rgb_mul(l->intensity, projection_value(l->projection, frame_to_local(&l->world_from_light, direction)));
}

static bool emit(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                 struct rng *random, light_emission *out)
{
    float pdf;
    vec3 local;
    (void)s, (void)random;
    if (light_aim_point(l, target, 1.0f - projection_corner_cosine(l->projection), numbers, out))
        return !rgb_is_black(out->flux);
    if (!projection_sample(l->projection, numbers->direction, &local, &out->flux, &pdf))
        return false;
    out->direction = vec3_normalize(frame_to_world(&l->world_from_light, local));
    out->flux = rgb_scale(rgb_mul(l->intensity, out->flux), 1.0f / pdf);
    return true;
}

static void narrow_bounds(const scene *s, const light *l, light_bounds *b)
{
    (void)s;
    float corner = projection_corner_cosine(l->projection);
    b->cos_normals = 1.0f;
    b->cos_emission = corner - LIGHT_BOUNDS_SLACK;
    b->intensity = rgb_mean(l->power) / (2.0f * AG_PI * fmaxf(1.0f - corner, 1e-6f));
}

const light_type projection_light = {.power = power,
                                     .intensity = intensity,
                                     .sample_from_point = light_sample_of_point,
                                     .emit = emit,
                                     .narrow_bounds = narrow_bounds};
