/* distant_light.c: light from infinitely far away in one direction, or from a small disc around it, as the sun's is.
 * Threads: read-only. */
#include "light/light_type.h"
#include "math/sampling.h"
#include "scene.h"

static void init(light *l) { l->as.distant.direction = (vec3){0.0f, 0.0f, 1.0f}; }

static void add_hash(const light *l, hash128 *h)
{
    HASH128_ADD(h, l->as.distant.direction);
    HASH128_ADD(h, l->as.distant.irradiance);
    HASH128_ADD(h, l->as.distant.disc_one_minus_cos);
}

void light_set_disc(light *l, double angle)
{
    const double quarter = sin(0.25 * angle);
    l->as.distant.disc_one_minus_cos = (float)(2.0 * quarter * quarter);
}

/* Returns the irradiance on a surface that faces a point of the disc; the mean cosine of the others there is 1 -
 * disc_one_minus_cos / 2. */
static rgb irradiance(const light *l)
{
    return rgb_scale(l->as.distant.irradiance, 1.0f / (1.0f - 0.5f * l->as.distant.disc_one_minus_cos));
}

/* The way of the light from a point of the disc. */
static vec3 direction_from(const light *l, vec2 u)
{
    if (!(l->as.distant.disc_one_minus_cos > 0.0f))
        return l->as.distant.direction;
    const frame f = frame_from_z(l->as.distant.direction);
    return vec3_normalize(frame_to_world(&f, sample_uniform_cone(u, l->as.distant.disc_one_minus_cos)));
}

static rgb power(const scene *s, const light *l)
{
    float disc = AG_PI * s->bounding_radius * s->bounding_radius;
    return rgb_scale(irradiance(l), disc);
}

static bool sample_from_point(const scene *s, const light *l, vec3 point, vec2 u, light_sample *out)
{
    (void)s;
    out->is_delta = true;
    out->pdf_solid_angle = 1.0f;
    out->direction = vec3_negate(direction_from(l, u));
    out->distance = INFINITY;
    out->shadow_target = point;
    out->radiance = irradiance(l);
    return true;
}

static bool emit(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                 light_emission *out)
{
    return light_emit_from_afar(s, l, target, numbers, direction_from(l, numbers->direction), irradiance(l), 1.0f,
                                out) &&
           !rgb_is_black(out->flux);
}

static bool reaches(const light *l, vec3 point, vec3 normal)
{
    (void)point;
    const float height = l->as.distant.disc_one_minus_cos,
                sine = sqrtf(height * (2.0f - height)); /* of half its angle */
    return vec3_is_zero(normal) || vec3_dot(normal, l->as.distant.direction) < LIGHT_REACH_SLACK + sine;
}

const light_type distant_light = {.is_everywhere = true,
                                  .init = init,
                                  .add_hash = add_hash,
                                  .power = power,
                                  .sample_from_point = sample_from_point,
                                  .emit = emit,
                                  .emission_numbers_of = light_numbers_from_afar,
                                  .reaches = reaches};
