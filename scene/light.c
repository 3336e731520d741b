/* light.c: see light.h.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 12 and 6.2.4; Jensen 2001, ch. 5.
 * Threads: read-only. */
#include "light.h"

#include "bvh.h"
#include "environment.h"
#include "math/rng.h"
#include "math/sampling.h"

/* 1 inside cos_falloff_start, 0 outside cos_total_width, smoothstep in the cosine between, as pbrt-v4. */
static float spot_falloff(const light *l, float cos_theta)
{
    float width = l->cos_falloff_start - l->cos_total_width;
    if (cos_theta >= l->cos_falloff_start)
        return 1.0f;
    if (cos_theta <= l->cos_total_width || width <= 0.0f)
        return 0.0f;
    float x = (cos_theta - l->cos_total_width) / width;
    return x * x * (3.0f - 2.0f * x);
}

rgb light_power(const scene *s, const light *l)
{
    float scale = 0.0f;
    switch (l->kind) {
    case LIGHT_POINT: return rgb_scale(l->intensity, 4.0f * AG_PI);
    case LIGHT_SPOT:
        /* smoothstep has mean 1/2 over its ramp */
        scale = 2.0f * AG_PI *
                ((1.0f - l->cos_falloff_start) + 0.5f * (l->cos_falloff_start - l->cos_total_width));
        return rgb_scale(l->intensity, scale);
    case LIGHT_DISTANT: return rgb_scale(l->radiance, AG_PI * s->bounding_radius * s->bounding_radius);
    case LIGHT_AREA: return rgb_scale(l->radiance, AG_PI * s->shapes[l->shape_index].area * (l->two_sided ? 2.0f : 1.0f));
    case LIGHT_INFINITE: return rgb_scale(environment_integral(l), AG_PI * s->bounding_radius * s->bounding_radius);
    }
    return rgb_gray(0.0f);
}

rgb light_emitted_radiance(const light *l, vec3 emitter_normal, vec3 direction)
{
    if (l->kind != LIGHT_AREA || (!l->two_sided && vec3_dot(emitter_normal, direction) <= 0.0f))
        return rgb_gray(0.0f);
    return l->radiance;
}

/* The cone under which a ball is seen from a point outside it: true, and 1 - cos of its half angle; false when the point is
 * inside or too close for the cone to be precise. */
static bool ball_cone(vec3 center, float radius, vec3 point, float *out_one_minus_cos)
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
    return ball_cone(s->as.quadric.center, s->as.quadric.uniform_radius, point, out_one_minus_cos);
}

static bool sample_area(const scene *s, const light *l, vec3 point, vec2 u, light_sample *out)
{
    const shape *lamp = &s->shapes[l->shape_index];
    vec3 position, normal;
    float epsilon, one_minus_cos, pdf;
    bool is_cone = sphere_cone(lamp, point, &one_minus_cos);
    if (is_cone) {
        /* a direction in the cone, then the near intersection by plane geometry */
        vec3 to_center = vec3_sub(lamp->as.quadric.center, point);
        float distance = vec3_length(to_center), r = lamp->as.quadric.uniform_radius;
        frame f = frame_from_z(vec3_scale(to_center, 1.0f / distance));
        vec3 local = sample_uniform_cone(u, one_minus_cos);
        float sin2 = fmaxf(0.0f, local.x * local.x + local.y * local.y);
        float along = distance * local.z - sqrtf(fmaxf(0.0f, r * r - distance * distance * sin2));
        vec3 n = vec3_normalize(vec3_sub(vec3_add_scaled(point, frame_to_world(&f, local), along), lamp->as.quadric.center));
        position = vec3_add_scaled(lamp->as.quadric.center, n, r);
        normal = lamp->flip_normal ? vec3_negate(n) : n;
        epsilon = (vec3_max_abs(lamp->as.quadric.center) + r) * SHAPE_EPSILON_RELATIVE;
        pdf = 1.0f / (2.0f * AG_PI * one_minus_cos);
    } else {
        surface_sample at = shape_sample_area(lamp, u);
        position = at.position;
        normal = at.geometric_normal;
        epsilon = at.epsilon;
        pdf = at.pdf_area; /* made solid angle below */
    }
    vec3 to_lamp = vec3_sub(position, point);
    float distance_squared = vec3_length_squared(to_lamp);
    if (!(distance_squared > 0.0f))
        return false;
    out->distance = sqrtf(distance_squared);
    out->direction = vec3_scale(to_lamp, 1.0f / out->distance);
    out->radiance = light_emitted_radiance(l, normal, vec3_negate(out->direction));
    float cos_lamp = fabsf(vec3_dot(normal, out->direction));
    if (rgb_is_black(out->radiance) || cos_lamp <= 1e-6f)
        return false;
    out->pdf_solid_angle = is_cone ? pdf : pdf * distance_squared / cos_lamp;
    out->shadow_target = vec3_add_scaled(position, vec3_face_forward(normal, vec3_negate(out->direction)), epsilon);
    out->is_delta = false;
    return true;
}

bool light_sample_from_point(const scene *s, const light *l, vec3 point, vec2 u, light_sample *out_sample)
{
    if (l->kind == LIGHT_AREA)
        return sample_area(s, l, point, u, out_sample);
    if (l->kind == LIGHT_INFINITE) {
        out_sample->is_delta = false;
        out_sample->distance = INFINITY;
        out_sample->shadow_target = point;
        return environment_sample(l, u, &out_sample->direction, &out_sample->radiance, &out_sample->pdf_solid_angle);
    }
    out_sample->is_delta = true;
    out_sample->pdf_solid_angle = 1.0f;
    if (l->kind == LIGHT_DISTANT) {
        out_sample->direction = vec3_negate(l->direction);
        out_sample->distance = INFINITY;
        out_sample->shadow_target = point;
        out_sample->radiance = l->radiance;
        return true;
    }
    vec3 to_light = vec3_sub(l->position, point);
    float distance_squared = vec3_length_squared(to_light);
    if (!(distance_squared > 0.0f))
        return false;
    out_sample->distance = sqrtf(distance_squared);
    out_sample->direction = vec3_scale(to_light, 1.0f / out_sample->distance);
    out_sample->shadow_target = l->position;
    float falloff = l->kind == LIGHT_SPOT ? spot_falloff(l, -vec3_dot(l->direction, out_sample->direction)) : 1.0f;
    out_sample->radiance = rgb_scale(l->intensity, falloff / distance_squared);
    return falloff > 0.0f;
}

float light_pdf_from_point(const scene *s, const light *l, vec3 point, vec3 hit_position, vec3 hit_geometric_normal)
{
    if (l->kind != LIGHT_AREA)
        return 0.0f;
    const shape *lamp = &s->shapes[l->shape_index];
    float one_minus_cos;
    if (sphere_cone(lamp, point, &one_minus_cos))
        return 1.0f / (2.0f * AG_PI * one_minus_cos);
    vec3 to_lamp = vec3_sub(hit_position, point);
    float distance_squared = vec3_length_squared(to_lamp);
    float cos_lamp = fabsf(vec3_dot(hit_geometric_normal, to_lamp)) / sqrtf(distance_squared);
    return cos_lamp > 0.0f ? shape_pdf_area(lamp, hit_geometric_normal) * distance_squared / cos_lamp : 0.0f;
}

/* Beyond this, 1 - cos of its half angle, a cone to the target is hardly better than sampling the light's own way. */
static const float TARGET_CONE_MAX = 0.5f;

/* A direction from a place uniformly in the cone to the target; false where all directions are as good. */
static bool aim_at(const light_target *target, vec3 origin, rng *random, vec3 *out_direction, float *out_pdf)
{
    if (!target)
        return false;
    float one_minus_cos;
    if (!ball_cone(target->center, target->radius, origin, &one_minus_cos) || one_minus_cos > TARGET_CONE_MAX)
        return false;
    vec3 to_center = vec3_sub(target->center, origin);
    frame f = frame_from_z(vec3_scale(to_center, 1.0f / vec3_length(to_center)));
    *out_direction = frame_to_world(&f, sample_uniform_cone(rng_vec2(random), one_minus_cos));
    *out_pdf = 1.0f / (2.0f * AG_PI * one_minus_cos);
    return true;
}

static bool emit_area(const scene *s, const light *l, const light_target *target, rng *random, light_emission *out)
{
    const shape *lamp = &s->shapes[l->shape_index];
    surface_sample at = shape_sample_area(lamp, rng_vec2(random));
    vec3 n = at.geometric_normal;
    float pdf;
    if (aim_at(target, at.position, random, &out->direction, &pdf)) {
        float cosine = vec3_dot(n, out->direction);
        if (l->two_sided && cosine < 0.0f) {
            n = vec3_negate(n);
            cosine = -cosine;
        }
        out->flux = rgb_scale(l->radiance, fmaxf(cosine, 0.0f) / (at.pdf_area * pdf));
    } else {
        if (l->two_sided && rng_float(random) < 0.5f)
            n = vec3_negate(n);
        frame f = frame_from_z(n);
        out->direction = frame_to_world(&f, sample_cosine_hemisphere(rng_vec2(random)));
        /* L cos / (pdf_area cos/pi): the same for every photon but on ellipsoids */
        out->flux = rgb_scale(l->radiance, AG_PI * (l->two_sided ? 2.0f : 1.0f) / at.pdf_area);
    }
    out->origin = vec3_add_scaled(at.position, n, at.epsilon);
    out->medium = vec3_dot(n, at.geometric_normal) > 0.0f ? lamp->medium_outside : lamp->medium_inside;
    return !rgb_is_black(out->flux);
}

/* A start outside all there is, on the disc of the ball that faces the way the light goes. */
static vec3 start_from_afar(const scene *s, const light_target *ball, vec3 direction, rng *random)
{
    frame f = frame_from_z(direction);
    vec2 d = sample_disk_concentric(rng_vec2(random));
    /* the plane that touches the scene's own ball from behind */
    float behind = vec3_dot(vec3_sub(ball->center, s->bounding_center), direction) + 1.01f * s->bounding_radius;
    return vec3_add(ball->center, frame_to_world(&f, (vec3){d.x * ball->radius, d.y * ball->radius, -behind}));
}

/* Light from infinitely far has lost in a medium that absorbs whatever that takes. The first interface that it meets
 * says what lies before it, as for shadow rays that go the other way; where there is none, the light's own medium
 * counts. */
static bool come_through_space(const scene *s, const light *l, light_emission *out)
{
    surface_hit hit;
    if (l->medium >= s->medium_count)
        return true;
    if (scene_intersect(s, scene_ray_make(out->origin, out->direction), INFINITY, &hit) && hit.has_medium_interface)
        out->medium = vec3_dot(hit.geometric_normal, out->direction) < 0.0f ? hit.medium_outside : hit.medium_inside;
    if (out->medium < s->medium_count)
        out->flux = rgb_mul(out->flux, medium_transmittance(&s->media[out->medium], INFINITY));
    return !rgb_is_black(out->flux);
}

bool light_sample_emission(const scene *s, const light *l, const light_target *target, rng *random,
                           light_emission *out_emission)
{
    light_emission *out = out_emission;
    light_target whole = {s->bounding_center, s->bounding_radius};
    const light_target *ball = target && target->radius < whole.radius ? target : &whole;
    float disc = AG_PI * ball->radius * ball->radius, pdf;
    out->medium = l->medium; /* of area lights: by the side, below */
    switch (l->kind) {
    case LIGHT_AREA: return emit_area(s, l, target, random, out);
    case LIGHT_POINT:
        out->origin = l->position;
        if (aim_at(target, l->position, random, &out->direction, &pdf)) {
            out->flux = rgb_scale(l->intensity, 1.0f / pdf);
            return true;
        }
        out->direction = sample_uniform_sphere(rng_vec2(random));
        out->flux = l->power;
        return true;
    case LIGHT_SPOT: {
        out->origin = l->position;
        if (aim_at(target, l->position, random, &out->direction, &pdf)) {
            out->flux = rgb_scale(l->intensity, spot_falloff(l, vec3_dot(out->direction, l->direction)) / pdf);
            return !rgb_is_black(out->flux);
        }
        /* uniform in the cone, thinned by the falloff, so that all photons are equal; in a cone no wider than a half space
         * at least half are accepted on average, and what 64 trials refuse goes along the axis */
        frame f = frame_from_z(l->direction);
        vec3 local = {0.0f, 0.0f, 1.0f};
        for (int trial = 0; trial < 64; trial++) {
            vec3 candidate = sample_uniform_cone(rng_vec2(random), 1.0f - l->cos_total_width);
            if (rng_float(random) < spot_falloff(l, candidate.z)) {
                local = candidate;
                break;
            }
        }
        out->direction = frame_to_world(&f, local);
        out->flux = l->power;
        return true;
    }
    case LIGHT_DISTANT:
        out->origin = start_from_afar(s, ball, l->direction, random);
        out->direction = l->direction;
        out->flux = rgb_scale(l->radiance, disc);
        return come_through_space(s, l, out);
    case LIGHT_INFINITE: {
        vec3 to_light;
        rgb radiance;
        if (!environment_sample(l, rng_vec2(random), &to_light, &radiance, &pdf))
            return false;
        out->direction = vec3_negate(to_light);
        out->origin = start_from_afar(s, ball, out->direction, random);
        out->flux = rgb_scale(radiance, disc / pdf);
        return come_through_space(s, l, out);
    }
    }
    return false;
}
