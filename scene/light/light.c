/* light.c: see light.h.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 12 and 6.2.4; Jensen 2001, ch. 5.
 * Threads: read-only. */
#include "light/light.h"

#include "light/environment.h"
#include "light/portal.h"
#include "light/projection.h"
#include "light/radiance_map.h"
#include "math/sampling.h"
#include "scene.h"
#include "shape/alpha.h"
#include "status.h"

light light_make(light_kind kind)
{
    frame axes = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    return (light){.kind = kind,
                   .direction = axes.z,
                   .radiance_texture = SCENE_NO_TEXTURE,
                   .medium = SCENE_NO_MEDIUM,
                   .photons = 1.0f,
                   .world_from_light = axes};
}

void light_set_cone(light *l, double full_angle, double dark_angle)
{
    /* 1 - cos without the cancellation that narrow cones would suffer from */
    double full = sin(0.5 * full_angle), dark = sin(0.5 * dark_angle);
    l->falloff_start = (float)(2.0 * full * full);
    l->falloff_end = (float)(2.0 * dark * dark);
}

void light_reset(light *l)
{
    environment_destroy(l->environment);
    projection_destroy(l->projection);
    portal_destroy(l->portal);
    radiance_map_destroy(l->radiance_map);
    *l = light_make(l->kind);
}

static rgb find_power(const scene *s, const light *l)
{
    float disc = AG_PI * s->bounding_radius * s->bounding_radius;
    switch (l->kind) {
    case LIGHT_POINT: return rgb_scale(l->intensity, 4.0f * AG_PI);
    case LIGHT_SPOT: return rgb_scale(l->intensity, AG_PI * (l->falloff_start + l->falloff_end)); /* half of the ramp */
    case LIGHT_GONIOMETRIC: return environment_integral(l);
    case LIGHT_PROJECTION: return rgb_mul(l->intensity, l->projection->integral);
    case LIGHT_DISTANT: return rgb_scale(l->radiance, disc);
    case LIGHT_AREA: {
        rgb mean = rgb_mul(l->radiance, l->radiance_map ? l->radiance_map->mean : light_sampled_value(s, l, NULL));
        return rgb_scale(mean, AG_PI * s->shapes[l->shape_index].area * (l->two_sided ? 2.0f : 1.0f));
    }
    case LIGHT_INFINITE:
        return l->portal ? rgb_scale(l->portal->irradiance, l->portal->width * l->portal->height)
                         : rgb_scale(environment_integral(l), disc);
    }
    return rgb_gray(0.0f);
}

ag_status light_commit(const scene *s, light *l)
{
    if (l->kind == LIGHT_AREA && light_varies(s, l) && !l->radiance_map)
        AG_TRY(radiance_map_create(s, l, &l->radiance_map));
    l->power = find_power(s, l);
    return AG_OK;
}

/* --- how bright --- */

/* 1 - cos of the angle between two unit directions, without cancellation. */
static float one_minus_cos(vec3 a, vec3 b) { return 0.5f * vec3_distance_squared(a, b); }

/* 1 inside falloff_start, 0 outside falloff_end, smoothstep in the cosine between, as pbrt-v4. */
static float spot_falloff(const light *l, vec3 direction)
{
    float height = one_minus_cos(l->direction, direction);
    if (height <= l->falloff_start)
        return 1.0f;
    if (height >= l->falloff_end)
        return 0.0f;
    float x = (l->falloff_end - height) / (l->falloff_end - l->falloff_start);
    return x * x * (3.0f - 2.0f * x);
}

rgb light_intensity(const light *l, vec3 direction)
{
    switch (l->kind) {
    case LIGHT_SPOT: return rgb_scale(l->intensity, spot_falloff(l, direction));
    case LIGHT_GONIOMETRIC: return environment_whole_radiance(l, direction);
    case LIGHT_PROJECTION:
        return rgb_mul(l->intensity, projection_value(l->projection, frame_to_local(&l->world_from_light, direction)));
    default: return l->intensity;
    }
}

rgb light_texture_value(const scene *s, const light *l, const surface_hit *hit)
{
    if (l->radiance_texture == SCENE_NO_TEXTURE)
        return rgb_gray(1.0f);
    rgb c = texture_evaluate_rgb(s, l->radiance_texture, hit);
    return rgb_make(fmaxf(c.r, 0.0f), fmaxf(c.g, 0.0f), fmaxf(c.b, 0.0f));
}

bool light_varies(const scene *s, const light *l)
{
    const shape *lamp = &s->shapes[l->shape_index];
    return l->radiance_texture != SCENE_NO_TEXTURE ||
           (lamp->alpha_texture != SCENE_NO_TEXTURE && !shape_is_invisible(lamp));
}

rgb light_sampled_value(const scene *s, const light *l, const surface_sample *at)
{
    const shape *lamp = &s->shapes[l->shape_index];
    if (l->radiance_texture == SCENE_NO_TEXTURE && shape_is_opaque(lamp))
        return rgb_gray(1.0f);
    surface_hit hit = {.distance = 0.0f};
    if (light_varies(s, l))
        shape_sample_surface(lamp, l->shape_index, at, &hit);
    rgb value = light_texture_value(s, l, &hit);
    if (shape_is_opaque(lamp) || shape_is_invisible(lamp))
        return value;
    return rgb_scale(value, alpha_at(s, lamp, &hit));
}

rgb light_emitted_radiance(const scene *s, const light *l, const surface_hit *hit, vec3 direction)
{
    if (l->kind != LIGHT_AREA || (!l->two_sided && vec3_dot(hit->geometric_normal, direction) <= 0.0f))
        return rgb_gray(0.0f);
    return l->radiance_texture == SCENE_NO_TEXTURE ? l->radiance : rgb_mul(l->radiance, light_texture_value(s, l, hit));
}

/* --- towards a point --- */

bool light_ball_cone(vec3 center, float radius, vec3 point, float *out_one_minus_cos)
{
    float r2 = radius * radius, distance_squared = vec3_distance_squared(point, center);
    if (distance_squared <= r2 * 1.0001f)
        return false;
    float sin2 = r2 / distance_squared;
    *out_one_minus_cos = sin2 / (1.0f + sqrtf(fmaxf(0.0f, 1.0f - sin2))); /* 1 - sqrt(1 - x), without cancellation */
    return true;
}

/* The same of a lamp that is a whole sphere. */
static bool sphere_cone(const shape *s, vec3 point, float *out_one_minus_cos)
{
    if (s->kind != SHAPE_SPHERE || s->as.quadric.uniform_radius <= 0.0f)
        return false;
    return light_ball_cone(s->as.quadric.center, s->as.quadric.uniform_radius, point, out_one_minus_cos);
}

/* A place on a lamp seen from outside its sphere, uniform in solid angle: a direction in the cone, then the near
 * intersection by plane geometry. */
static surface_sample sample_sphere_cone(const shape *lamp, vec3 point, vec2 u, float cone)
{
    vec3 center = lamp->as.quadric.center, to_center = vec3_sub(center, point);
    float distance = vec3_length(to_center), r = lamp->as.quadric.uniform_radius;
    frame f = frame_from_z(vec3_scale(to_center, 1.0f / distance));
    vec3 local = sample_uniform_cone(u, cone);
    float sin2 = fmaxf(0.0f, local.x * local.x + local.y * local.y);
    float along = distance * local.z - sqrtf(fmaxf(0.0f, r * r - distance * distance * sin2));
    vec3 n = vec3_normalize(vec3_sub(vec3_add_scaled(point, frame_to_world(&f, local), along), center));
    surface_sample at = {0};
    at.position = vec3_add_scaled(center, n, r);
    at.geometric_normal = lamp->flip_normal ? vec3_negate(n) : n;
    at.epsilon = (vec3_max_abs(center) + r) * SHAPE_EPSILON_RELATIVE;
    return at;
}

/* Whether direct light is sampled by the lamp's radiance map too: where its density is known at a hit. */
static bool is_sampled_by_map(const light *l, const shape *lamp) { return l->radiance_map && lamp->kind == SHAPE_MESH; }

static bool sample_area(const scene *s, const light *l, vec3 point, vec2 u, light_sample *out)
{
    const shape *lamp = &s->shapes[l->shape_index];
    surface_sample at;
    float cone, density = 1.0f;
    bool is_cone = sphere_cone(lamp, point, &cone);
    if (is_sampled_by_map(l, lamp) && !radiance_map_sample(l->radiance_map, u, &u, &density))
        return false;
    at = is_cone ? sample_sphere_cone(lamp, point, u, cone) : shape_sample_area(lamp, u);
    vec3 to_lamp = vec3_sub(at.position, point);
    float distance_squared = vec3_length_squared(to_lamp);
    if (!(distance_squared > 0.0f))
        return false;
    out->distance = sqrtf(distance_squared);
    out->direction = vec3_scale(to_lamp, 1.0f / out->distance);
    out->radiance = rgb_gray(0.0f);
    if (l->two_sided || vec3_dot(at.geometric_normal, out->direction) < 0.0f)
        out->radiance = rgb_mul(l->radiance, light_sampled_value(s, l, &at));
    float cos_lamp = fabsf(vec3_dot(at.geometric_normal, out->direction));
    if (rgb_is_black(out->radiance) || cos_lamp <= 1e-6f)
        return false;
    out->pdf_solid_angle = is_cone ? 1.0f / (2.0f * AG_PI * cone) : at.pdf_area * density * distance_squared / cos_lamp;
    out->shadow_target =
        vec3_add_scaled(at.position, vec3_face_forward(at.geometric_normal, vec3_negate(out->direction)), at.epsilon);
    out->is_delta = shape_is_invisible(lamp); /* then shadow rays alone find it */
    return true;
}

bool light_sample_from_point(const scene *s, const light *l, vec3 point, vec2 u, light_sample *out_sample)
{
    light_sample *out = out_sample;
    if (l->kind == LIGHT_AREA)
        return sample_area(s, l, point, u, out);
    if (l->kind == LIGHT_INFINITE) {
        out->is_delta = false;
        out->distance = INFINITY;
        out->shadow_target = point;
        return environment_sample(l, point, u, &out->direction, &out->radiance, &out->pdf_solid_angle);
    }
    out->is_delta = true;
    out->pdf_solid_angle = 1.0f;
    if (l->kind == LIGHT_DISTANT) {
        out->direction = vec3_negate(l->direction);
        out->distance = INFINITY;
        out->shadow_target = point;
        out->radiance = l->radiance;
        return true;
    }
    vec3 to_light = vec3_sub(l->position, point);
    float distance_squared = vec3_length_squared(to_light);
    if (!(distance_squared > 0.0f))
        return false;
    out->distance = sqrtf(distance_squared);
    out->direction = vec3_scale(to_light, 1.0f / out->distance);
    out->shadow_target = l->position;
    out->radiance = rgb_scale(light_intensity(l, vec3_negate(out->direction)), 1.0f / distance_squared);
    return !rgb_is_black(out->radiance);
}

float light_pdf_from_point(const scene *s, const light *l, vec3 point, const surface_hit *hit)
{
    if (l->kind != LIGHT_AREA)
        return 0.0f;
    const shape *lamp = &s->shapes[l->shape_index];
    float cone;
    vec2 u;
    if (sphere_cone(lamp, point, &cone))
        return 1.0f / (2.0f * AG_PI * cone);
    vec3 to_lamp = vec3_sub(hit->position, point);
    float distance_squared = vec3_length_squared(to_lamp);
    float cos_lamp = fabsf(vec3_dot(hit->geometric_normal, to_lamp)) / sqrtf(distance_squared);
    float density = is_sampled_by_map(l, lamp) && shape_sample_inverse(lamp, hit, &u)
                        ? radiance_map_density(l->radiance_map, u)
                        : 1.0f;
    return cos_lamp > 0.0f ? shape_pdf_area(lamp, hit->geometric_normal) * density * distance_squared / cos_lamp : 0.0f;
}
