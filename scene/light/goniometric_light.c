/* goniometric_light.c: a point whose intensity is a picture over all directions.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 12.2.4. Threads: read-only. */
#include "light/environment.h"
#include "light/light_type.h"
#include "scene.h"

static void init(light *l) { l->as.goniometric.intensity = light_directions_make(); }

static environment *picture(const light *l) { return l->as.goniometric.intensity.picture; }

static void reset(light *l) { environment_destroy(l->as.goniometric.intensity.picture); }

static void add_hash(const light *l, hash128 *h)
{
    HASH128_ADD(h, l->as.goniometric.position);
    light_directions_add_hash(&l->as.goniometric.intensity, h);
}

static rgb power(const scene *s, const light *l)
{
    (void)s;
    return environment_integral(&l->as.goniometric.intensity);
}

static rgb intensity(const light *l, vec3 direction)
{
    return environment_whole_radiance(&l->as.goniometric.intensity, direction);
}

static bool emit(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                 light_emission *out)
{
    float pdf;
    (void)s;
    if (light_aim_point(l, target, 2.0f, numbers, out))
        return !rgb_is_black(out->flux);
    if (!environment_sample_whole(&l->as.goniometric.intensity, numbers->direction, &out->direction, &out->flux, &pdf))
        return false;
    out->flux = rgb_scale(out->flux, 1.0f / pdf);
    return true;
}

static bool emission_numbers_of(const scene *s, const light *l, vec3 point, vec2 u, const light_sample *towards,
                                emission_numbers *in_out)
{
    (void)s, (void)point, (void)u;
    return environment_sample_whole_numbers(&l->as.goniometric.intensity, vec3_negate(towards->direction),
                                            &in_out->direction);
}

const light_type goniometric_light = {.init = init,
                                      .reset = reset,
                                      .add_hash = add_hash,
                                      .power = power,
                                      .intensity = intensity,
                                      .picture = picture,
                                      .sample_from_point = light_sample_of_point,
                                      .emit = emit,
                                      .emission_numbers_of = emission_numbers_of,
                                      .narrow_bounds = light_narrow_to_point};
