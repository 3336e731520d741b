/* light.c: what all lights have, and which file knows the rest: see light_type.h. Threads: read-only. */
#include "light/light_type.h"
#include "scene.h"
#include "status.h"

#include <string.h>

light light_make(light_kind kind)
{
    const light_type *type = light_type_of(kind);
    light l;
    memset(&l, 0, sizeof l);
    l.kind = kind;
    l.medium = SCENE_NO_MEDIUM;
    l.photons = 1.0f;
    if (type->init)
        type->init(&l);
    return l;
}

void light_reset(light *l)
{
    const light_type *type = light_type_of(l->kind);
    if (type->reset)
        type->reset(l);
    *l = light_make(l->kind);
}

bool light_can_be_met(const light *l) { return light_type_of(l->kind)->can_be_met; }

bool light_is_everywhere(const light *l) { return light_type_of(l->kind)->is_everywhere; }

bool light_is_sky(const light *l) { return light_type_of(l->kind)->escaped_radiance != NULL; }

struct environment *light_picture_of(const light *l)
{
    const light_type *type = light_type_of(l->kind);
    return type->picture ? type->picture(l) : NULL;
}

ag_status light_commit(const scene *s, light *l)
{
    const light_type *type = light_type_of(l->kind);
    if (type->commit)
        AG_TRY(type->commit(s, l));
    l->power = type->power(s, l);
    return AG_OK;
}

rgb light_intensity(const light *l, vec3 direction) { return light_type_of(l->kind)->intensity(l, direction); }

rgb light_emitted_radiance(const scene *s, const light *l, const surface_hit *hit, vec3 direction)
{
    const light_type *type = light_type_of(l->kind);
    return type->emitted_radiance ? type->emitted_radiance(s, l, hit, direction) : rgb_gray(0.0f);
}

bool light_sample_from_point(const scene *s, const light *l, vec3 point, vec2 u, light_sample *out_sample)
{
    return light_type_of(l->kind)->sample_from_point(s, l, point, u, out_sample);
}

float light_pdf_from_point(const scene *s, const light *l, vec3 point, const surface_hit *hit)
{
    const light_type *type = light_type_of(l->kind);
    return type->pdf_from_point ? type->pdf_from_point(s, l, point, hit) : 0.0f;
}

rgb light_escaped_radiance(const light *l, vec3 point, vec3 direction)
{
    return light_type_of(l->kind)->escaped_radiance(l, point, direction);
}

float light_escaped_pdf(const light *l, vec3 point, vec3 direction)
{
    return light_type_of(l->kind)->escaped_pdf(l, point, direction);
}

bool light_has_direction_numbers(const light *l)
{
    const light_type *type = light_type_of(l->kind);
    return type->has_direction_numbers && type->has_direction_numbers(l);
}

bool light_direction_numbers(const light *l, vec3 direction, vec2 *out_u)
{
    return light_type_of(l->kind)->direction_numbers(l, direction, out_u);
}

bool light_ball_cone(vec3 center, float radius, vec3 point, float *out_one_minus_cos)
{
    float r2 = radius * radius, distance_squared = vec3_distance_squared(point, center);
    if (distance_squared <= r2 * 1.0001f)
        return false;
    float sin2 = r2 / distance_squared;
    *out_one_minus_cos =
        sin2 / (1.0f + sqrtf(float_max(1.0f - sin2, 0.0f))); /* 1 - sqrt(1 - x), without cancellation */
    return true;
}
