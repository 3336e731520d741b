/* distant_light.c: light from infinitely far away in one direction, as the sun's nearly is. Threads: read-only. */
#include "light/light_type.h"
#include "scene.h"

static rgb power(const scene *s, const light *l)
{
    float disc = AG_PI * s->bounding_radius * s->bounding_radius;
    return rgb_scale(l->radiance, disc);
}

static bool sample_from_point(const scene *s, const light *l, vec3 point, vec2 u, light_sample *out)
{
    (void)s, (void)u;
    out->is_delta = true;
    out->pdf_solid_angle = 1.0f;
    out->direction = vec3_negate(l->direction);
    out->distance = INFINITY;
    out->shadow_target = point;
    out->radiance = l->radiance;
    return true;
}

static bool emit(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                 struct rng *random, light_emission *out)
{
    (void)random;
    return light_emit_from_afar(s, l, target, numbers, l->direction, l->radiance, 1.0f, out) &&
           !rgb_is_black(out->flux);
}

const light_type distant_light = {
    .is_everywhere = true, .power = power, .sample_from_point = sample_from_point, .emit = emit};
