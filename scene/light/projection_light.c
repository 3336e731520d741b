/* projection_light.c: a point that throws a picture, as a slide projector does.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 12.2.3. Threads: read-only. */
#include "light/light_type.h"
#include "light/projection.h"
#include "scene.h"

static void init(light *l) { l->as.projection.world_from_light = frame_identity(); }

static void reset(light *l) { projection_destroy(l->as.projection.picture); }

static void add_hash(const light *l, hash128 *h)
{
    const projection_source *source = &l->as.projection;
    const projection *p = source->picture;
    HASH128_ADD(h, source->position);
    HASH128_ADD(h, source->world_from_light);
    HASH128_ADD(h, source->intensity);
    HASH128_ADD(h, p->width);
    HASH128_ADD(h, p->height);
    HASH128_ADD(h, p->reach_x);
    HASH128_ADD(h, p->reach_y);
    hash128_add(h, p->pixels, (size_t)p->width * p->height * sizeof *p->pixels);
}

static rgb power(const scene *s, const light *l)
{
    (void)s;
    return rgb_mul(l->as.projection.intensity, l->as.projection.picture->integral);
}

static rgb intensity(const light *l, vec3 direction)
{
    return rgb_mul(
        l->as.projection.intensity,
        projection_value(l->as.projection.picture, frame_to_local(&l->as.projection.world_from_light, direction)));
}

static bool emit(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                 light_emission *out)
{
    float pdf;
    vec3 local;
    (void)s;
    if (light_aim_point(l, target, 1.0f - projection_corner_cosine(l->as.projection.picture), numbers, out))
        return !rgb_is_black(out->flux);
    if (!projection_sample(l->as.projection.picture, numbers->direction, &local, &out->flux, &pdf))
        return false;
    out->direction = vec3_normalize(frame_to_world(&l->as.projection.world_from_light, local));
    out->flux = rgb_scale(rgb_mul(l->as.projection.intensity, out->flux), 1.0f / pdf);
    return true;
}

static bool emission_numbers_of(const scene *s, const light *l, vec3 point, vec2 u, const light_sample *towards,
                                emission_numbers *in_out)
{
    (void)s, (void)point, (void)u;
    const vec3 local = frame_to_local(&l->as.projection.world_from_light, vec3_negate(towards->direction));
    return projection_sample_numbers(l->as.projection.picture, local, &in_out->direction);
}

static void narrow_bounds(const scene *s, const light *l, light_bounds *b)
{
    light_narrow_to_point(s, l, b);
    float corner = projection_corner_cosine(l->as.projection.picture);
    b->axis = l->as.projection.world_from_light.z;
    b->cos_normals = 1.0f;
    b->cos_emission = corner - LIGHT_BOUNDS_SLACK;
    b->intensity = rgb_mean(l->power) / (2.0f * AG_PI * float_max(1.0f - corner, 1e-6f));
}

const light_type projection_light = {.init = init,
                                     .reset = reset,
                                     .add_hash = add_hash,
                                     .power = power,
                                     .intensity = intensity,
                                     .sample_from_point = light_sample_of_point,
                                     .emit = emit,
                                     .emission_numbers_of = emission_numbers_of,
                                     .narrow_bounds = narrow_bounds};
