/* light_emission.c: rays of light that leave a lamp: see light_sample_emission in light.h.
 * Rests on: Jensen, "Realistic Image Synthesis Using Photon Mapping", 2001, ch. 5; Jensen 1996 (projection maps).
 * Threads: read-only. */
#include "light/light_type.h"
#include "math/rng.h"
#include "math/sampling.h"
#include "rays/rays.h"
#include "scene.h"

/* Beyond this, 1 - cos of its half angle, a cone to the target is hardly better than sampling the light's own way. */
static const float TARGET_CONE_MAX = 0.5f;

bool light_aim_at(const light_target *target, vec3 origin, float own_cone, vec2 u, vec3 *out_direction, float *out_pdf)
{
    if (!target)
        return false;
    float one_minus_cos;
    if (!light_ball_cone(target->center, target->radius, origin, &one_minus_cos) ||
        one_minus_cos > float_min(own_cone, TARGET_CONE_MAX))
        return false;
    vec3 to_center = vec3_sub(target->center, origin);
    frame f = frame_from_z(vec3_scale(to_center, 1.0f / vec3_length(to_center)));
    *out_direction = frame_to_world(&f, sample_uniform_cone(u, one_minus_cos));
    *out_pdf = 1.0f / (2.0f * AG_PI * one_minus_cos);
    return true;
}

/* Where small things stand among giants, or a room in a landscape, light from afar that were spread evenly over the
 * scene would hardly find them. Balls around them, each twice as large as the one before, get equal shares of it: so
 * photons thin out with the square of the distance, about as what far light does to what is in the middle. */
typedef struct nested_balls {
    light_target inner, whole; /* the first and the last of them */
    int count;
} nested_balls;

static nested_balls nested_balls_make(const scene *s, const light_target *whole, const light_target *focus)
{
    nested_balls balls = {focus ? *focus : (light_target){s->detail_center, s->detail_radius}, *whole, 1};
    if (!(balls.inner.radius > 0.0f) || balls.inner.radius >= whole->radius)
        return balls;
    /* the octaves, rounded up: by its bits, since no two machines agree on logarithms */
    int octaves;
    float fraction = frexpf(float_min(whole->radius / balls.inner.radius, 0x1p100f), &octaves);
    balls.count = 1 + octaves - (fraction == 0.5f);
    return balls;
}

static light_target nested_ball(const nested_balls *balls, int i)
{
    return i == balls->count - 1 ? balls->whole : (light_target){balls->inner.center, ldexpf(balls->inner.radius, i)};
}

/* The density, per area across direction, with which rays along it come through that point. */
static float nested_density(const nested_balls *balls, vec3 point, vec3 direction)
{
    float density = 0.0f;
    for (int i = 0; i < balls->count; i++) {
        light_target ball = nested_ball(balls, i);
        vec3 offset = vec3_sub(point, ball.center);
        offset = vec3_add_scaled(offset, direction, -vec3_dot(offset, direction));
        if (i == balls->count - 1 || vec3_dot(offset, offset) <= ball.radius * ball.radius)
            density += 1.0f / ((float)balls->count * AG_PI * ball.radius * ball.radius);
    }
    return density;
}

/* A start outside all there is, with its density per area; on the disc of the ball that faces the way the light goes,
 * or those of balls within. False: beside the ball. */
static bool start_from_afar(const scene *s, const light_target *whole, vec3 direction, const emission_numbers *numbers,
                            vec3 *out_origin, float *out_density)
{
    frame f = frame_from_z(direction);
    const nested_balls balls = nested_balls_make(s, whole, numbers->focus);
    int picked = balls.count - 1;
    if (balls.count > 1)
        picked = (int)float_min(numbers->part * (float)balls.count, (float)balls.count - 1.0f);
    light_target ball = nested_ball(&balls, picked);
    vec2 d = sample_disk_concentric(numbers->position);
    vec3 point = vec3_add(ball.center, frame_to_world(&f, (vec3){d.x * ball.radius, d.y * ball.radius, 0.0f}));
    *out_density = 1.0f / (AG_PI * ball.radius * ball.radius);
    if (balls.count > 1) {
        vec3 offset = vec3_sub(point, whole->center);
        offset = vec3_add_scaled(offset, direction, -vec3_dot(offset, direction));
        if (picked < balls.count - 1 && vec3_dot(offset, offset) > whole->radius * whole->radius)
            return false;
        *out_density = nested_density(&balls, point, direction);
    }
    /* the plane that touches the scene's own ball from behind */
    float behind = vec3_dot(vec3_sub(ball.center, s->bounding_center), direction) + 1.01f * s->bounding_radius;
    *out_origin = vec3_add(ball.center, frame_to_world(&f, (vec3){d.x * ball.radius, d.y * ball.radius, -behind}));
    return true;
}

bool light_numbers_from_afar(const scene *s, const light *l, vec3 point, vec2 u, const light_sample *towards,
                             emission_numbers *in_out_numbers)
{
    (void)l;
    light_target whole = {s->bounding_center, s->bounding_radius}, ball;
    const nested_balls balls = nested_balls_make(s, &whole, in_out_numbers->focus);
    const frame f = frame_from_z(vec3_negate(towards->direction));
    vec3 local;
    int i = -1;
    do { /* of the balls that it passes, the smallest sends most */
        ball = nested_ball(&balls, ++i);
        local = frame_to_local(&f, vec3_sub(point, ball.center));
    } while (i < balls.count - 1 && local.x * local.x + local.y * local.y > ball.radius * ball.radius);
    const float inverse = 1.0f / ball.radius;
    in_out_numbers->direction = u;
    in_out_numbers->position = sample_disk_concentric_inverse((vec2){local.x * inverse, local.y * inverse});
    if (balls.count > 1)
        in_out_numbers->part = float_below_one(((float)i + in_out_numbers->part) / (float)balls.count);
    return true;
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
    const medium_stretch way = {out->origin, vec3_negate(out->direction), INFINITY};
    if (out->medium < s->medium_count)
        out->flux = rgb_mul(out->flux, medium_transmittance(&s->media[out->medium], &way));
    return !rgb_is_black(out->flux);
}

bool light_emit_from_afar(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                          vec3 direction, rgb radiance, float pdf, light_emission *out)
{
    light_target whole = {s->bounding_center, s->bounding_radius};
    const light_target *ball = target && target->radius < whole.radius ? target : &whole;
    float density;
    if (!start_from_afar(s, ball, direction, numbers, &out->origin, &density))
        return false;
    out->direction = direction;
    out->flux = rgb_scale(radiance, 1.0f / (density * pdf));
    return come_through_space(s, l, out);
}

bool light_emit(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                light_emission *out_emission)
{
    out_emission->medium = l->medium; /* of area lights: by the side */
    return light_type_of(l->kind)->emit(s, l, target, numbers, out_emission);
}

bool light_emission_numbers(const scene *s, const light *l, vec3 point, vec2 u, const light_sample *towards,
                            emission_numbers *in_out_numbers)
{
    const light_type *type = light_type_of(l->kind);
    return type->emission_numbers_of && type->emission_numbers_of(s, l, point, u, towards, in_out_numbers);
}

emission_numbers emission_numbers_draw(rng *random)
{
    emission_numbers numbers;
    numbers.direction = rng_vec2(random);
    numbers.position = rng_vec2(random);
    numbers.part = rng_float(random);
    numbers.focus = NULL;
    return numbers;
}

bool light_sample_emission(const scene *s, const light *l, const light_target *target, rng *random,
                           light_emission *out_emission)
{
    emission_numbers numbers = emission_numbers_draw(random);
    return light_emit(s, l, target, &numbers, out_emission);
}
