/* point_light.c: a point that shines alike in all directions, and what all lights that are points share.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 12.2. Threads: read-only. */
#include "light/light_type.h"
#include "math/sampling.h"
#include "scene.h"

bool light_sample_of_point(const scene *s, const light *l, vec3 point, vec2 u, light_sample *out)
{
    (void)s, (void)u;
    out->is_delta = true;
    out->pdf_solid_angle = 1.0f;
    vec3 to_light = vec3_sub(l->as.point.position, point);
    float distance_squared = vec3_length_squared(to_light);
    if (!(distance_squared > 0.0f))
        return false;
    out->distance = sqrtf(distance_squared);
    out->direction = vec3_scale(to_light, 1.0f / out->distance);
    out->shadow_target = l->as.point.position;
    out->radiance = rgb_scale(light_intensity(l, vec3_negate(out->direction)), 1.0f / distance_squared);
    return !rgb_is_black(out->radiance);
}

bool light_aim_point(const light *l, const light_target *target, float own_cone, const emission_numbers *numbers,
                     light_emission *out)
{
    float pdf;
    out->origin = l->as.point.position;
    if (!light_aim_at(target, l->as.point.position, own_cone, numbers->direction, &out->direction, &pdf))
        return false;
    out->flux = rgb_scale(light_intensity(l, out->direction), 1.0f / pdf);
    return true;
}

void light_narrow_to_point(const scene *s, const light *l, light_bounds *b)
{
    (void)s;
    b->center = l->as.point.position;
}

static void add_hash(const light *l, hash128 *h)
{
    HASH128_ADD(h, l->as.point.position);
    HASH128_ADD(h, l->as.point.intensity);
}

static rgb power(const scene *s, const light *l)
{
    (void)s;
    return rgb_scale(l->as.point.intensity, 4.0f * AG_PI);
}

static rgb intensity(const light *l, vec3 direction)
{
    (void)direction;
    return l->as.point.intensity;
}

static bool emit(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                 light_emission *out)
{
    (void)s;
    if (!light_aim_point(l, target, 2.0f, numbers, out)) {
        out->direction = sample_uniform_sphere(numbers->direction);
        out->flux = l->power;
    }
    return !rgb_is_black(out->flux);
}

static bool emission_numbers_of(const scene *s, const light *l, vec3 point, vec2 u, const light_sample *towards,
                                emission_numbers *in_out)
{
    (void)s, (void)l, (void)point, (void)u;
    in_out->direction = sample_uniform_sphere_inverse(vec3_negate(towards->direction));
    return true;
}

const light_type point_light = {.add_hash = add_hash,
                                .power = power,
                                .intensity = intensity,
                                .sample_from_point = light_sample_of_point,
                                .emit = emit,
                                .emission_numbers_of = emission_numbers_of,
                                .narrow_bounds = light_narrow_to_point};
