/* transmittance.c: see transmittance.h. A ray that crosses an interface is cast anew from its other side; what a medium
 * takes is computed from surface to surface, not from where rays start.
 * Threads: pure but for the caller's counter. */
#include "rays/transmittance.h"

#include "material/bsdf.h"
#include "material/pane.h"
#include "medium/medium_flight.h"
#include "rays/slab_faces.h"

/* The share of light that is left over a stretch of a ray, in the ray's medium. */
static rgb transmittance_over(const scene *s, const scene_ray *ray, const medium_stretch *way)
{
    return ray->medium < s->medium_count ? medium_transmittance(&s->media[ray->medium], way) : rgb_gray(1.0f);
}

/* Lamps with a mix of materials stay where they are: their light starts all over them. */
static bool is_passed(const scene *s, const surface_hit *hit)
{
    return material_is_interface(s, hit) && s->shapes[hit->shape_index].light_index == SHAPE_NO_LIGHT;
}

/* The share of a ray that a surface lets through unbent: all of it, a pane's or slab's transmittance, or nothing. */
static rgb let_through(const scene *s, const surface_hit *hit, const scene_ray *ray, bool through_panes)
{
    if (is_passed(s, hit))
        return rgb_gray(1.0f);
    bool is_slab = hit->slab.thickness > 0.0f;
    if (!through_panes || !(is_slab || pane_may_be_of(s, s->shapes[hit->shape_index].material_index)))
        return rgb_gray(0.0f);
    bsdf at;
    bsdf_init(s, hit, vec3_negate(ray->direction), &at);
    return bsdf_straight_transmittance(&at);
}

scene_ray scene_ray_continue(const surface_hit *hit, const scene_ray *ray)
{
    bool is_slab = hit->slab.thickness > 0.0f;
    scene_ray next = is_slab ? *ray : surface_ray(hit, *ray, ray->direction);
    next.origin = is_slab
                      ? surface_point_behind(hit->slab.exit, hit->geometric_normal, hit->slab.epsilon, ray->direction)
                      : surface_point_behind(hit->position, hit->geometric_normal, hit->epsilon, ray->direction);
    if (is_slab && hit->has_medium_interface)
        next.medium = hit->medium_outside;
    return next;
}

static float distance_between(vec3 a, vec3 b) { return sqrtf(vec3_distance_squared(a, b)); }

/* The point of a ray where a medium scatters it, at a distance from `from`: not behind the surface that the ray has
 * met, if any (hit). travelled: the distance of `from`. */
static void scatter_at(const scene_ray *ray, vec3 from, float distance, const surface_hit *hit, float travelled,
                       surface_hit *out_point)
{
    float along = float_max(distance - distance_between(from, ray->origin), 0.0f);
    if (hit)
        along = float_max(float_min(along, distance_between(ray->origin, hit->position) - hit->epsilon), 0.0f);
    vec3 back = vec3_negate(ray->direction);
    *out_point = (surface_hit){.position = vec3_add_scaled(ray->origin, ray->direction, along),
                               .geometric_normal = back,
                               .shading_normal = back,
                               .distance = travelled + distance,
                               .instance_index = SCENE_NO_INSTANCE,
                               .time = ray->time};
}

/* Follows a ray of unit direction up to `length` and across interfaces, and panes too if so wished, to the first
 * surface that stays. *ray becomes its last stretch. Either of the last two may be NULL: in_out_left is multiplied by
 * what media and panes leave of light; a flight ends where a medium scatters the ray. Where no light is left, or there
 * are too many crossings, the way ends in the dark. */
static ray_end follow(const scene *s, scene_ray *ray, float length, bool through_panes, uint64_t *in_out_cut,
                      surface_hit *out_hit, rgb *in_out_left, medium_flight *flight)
{
    bool is_bounded = !isinf(length);
    vec3 from = ray->origin, end = is_bounded ? vec3_add_scaled(ray->origin, ray->direction, length) : ray->origin;
    float travelled = 0.0f;
    for (int crossings = 0;; crossings++) {
        bool is_hit = scene_intersect(s, *ray, length, out_hit);
        float to_end = is_bounded ? distance_between(from, end) : INFINITY;
        float distance = is_hit ? distance_between(from, out_hit->position) : to_end;
        const medium_stretch way = {from, ray->direction, distance};
        float free_path;
        if (flight && ray->medium < s->medium_count &&
            medium_flight_pass(flight, &s->media[ray->medium], &way, &free_path)) {
            surface_hit hit = *out_hit;
            scatter_at(ray, from, free_path, is_hit ? &hit : NULL, travelled, out_hit);
            return RAY_ENDS_IN_MEDIUM;
        }
        travelled += distance;
        if (in_out_left)
            *in_out_left = rgb_mul(*in_out_left, transmittance_over(s, ray, &way));
        if (!is_hit || (in_out_left && rgb_is_black(*in_out_left)) || (flight && rgb_is_black(flight->transmittance)))
            return RAY_ENDS_NOWHERE;
        slab_meet(s, ray, out_hit);
        bool is_slab = out_hit->slab.thickness > 0.0f;
        if (is_slab && is_bounded && !(vec3_dot(vec3_sub(end, out_hit->slab.exit), ray->direction) > 0.0f))
            out_hit->slab.thickness = 0.0f, is_slab = false; /* the end lies in the glass */
        rgb passed = let_through(s, out_hit, ray, through_panes);
        if (rgb_is_black(passed)) {
            out_hit->distance = travelled;
            return RAY_ENDS_AT_SURFACE;
        }
        if (in_out_left)
            *in_out_left = rgb_mul(*in_out_left, passed);
        if (crossings == TRANSMITTANCE_CROSSINGS_MAX) {
            (*in_out_cut)++;
            if (in_out_left)
                *in_out_left = rgb_gray(0.0f);
            if (flight)
                flight->transmittance = rgb_gray(0.0f);
            return RAY_ENDS_NOWHERE;
        }
        from = is_slab ? out_hit->slab.exit : out_hit->position;
        travelled += is_slab ? distance_between(out_hit->position, from) : 0.0f;
        *ray = scene_ray_continue(out_hit, ray);
        if (!is_bounded)
            continue;
        /* to the same end from the other side; it may lie within the step there */
        vec3 rest = vec3_sub(end, ray->origin);
        length = vec3_length(rest);
        if (!(vec3_dot(rest, ray->direction) > 0.0f))
            return RAY_ENDS_NOWHERE;
        ray->direction = vec3_scale(rest, 1.0f / length);
    }
}

bool transmittance_intersect(const scene *s, scene_ray *ray, uint64_t *in_out_cut, surface_hit *out_hit,
                             rgb *out_transmittance)
{
    if (s->has_interfaces) {
        scene_ray last = *ray;
        *out_transmittance = rgb_gray(1.0f);
        bool is_met = follow(s, &last, INFINITY, false, in_out_cut, out_hit, out_transmittance, NULL);
        ray->medium = last.medium;
        return is_met;
    }
    bool is_hit = scene_intersect(s, *ray, INFINITY, out_hit);
    if (is_hit)
        slab_meet(s, ray, out_hit);
    const medium_stretch way = {ray->origin, ray->direction, is_hit ? out_hit->distance : INFINITY};
    *out_transmittance = transmittance_over(s, ray, &way);
    return is_hit && !rgb_is_black(*out_transmittance);
}

ray_end transmittance_travel(const scene *s, scene_ray *ray, rgb carried, vec2 u, uint64_t *in_out_cut,
                             surface_hit *out_hit, rgb *out_weight)
{
    medium_flight flight = medium_flight_begin(carried, u);
    scene_ray last = *ray;
    ray_end end = follow(s, &last, INFINITY, false, in_out_cut, out_hit, NULL, &flight);
    ray->medium = last.medium;
    *out_weight = medium_flight_weight(&flight);
    return rgb_is_black(*out_weight) ? RAY_ENDS_NOWHERE : end;
}

/* Normalises the direction and returns its former length. */
static float normalize_direction(scene_ray *ray)
{
    float unit = vec3_length(ray->direction);
    ray->direction = vec3_scale(ray->direction, 1.0f / unit);
    return unit;
}

rgb transmittance_of_ray(const scene *s, scene_ray ray, float reach, uint64_t *in_out_cut)
{
    if (!s->has_interfaces && scene_occluded(s, ray, reach))
        return rgb_gray(0.0f);
    if (transmittance_is_one(s, &ray))
        return rgb_gray(1.0f);
    surface_hit hit;
    rgb left = rgb_gray(1.0f);
    float unit = normalize_direction(&ray);
    if (!(unit > 0.0f))
        return left; /* from a point to itself */
    if (!s->has_interfaces) {
        const medium_stretch way = {ray.origin, ray.direction, reach * unit};
        return transmittance_over(s, &ray, &way);
    }
    return follow(s, &ray, reach * unit, false, in_out_cut, &hit, &left, NULL) ? rgb_gray(0.0f) : left;
}

rgb transmittance_through_panes(const scene *s, scene_ray ray, float reach, uint64_t *in_out_cut)
{
    surface_hit hit;
    rgb left = rgb_gray(1.0f);
    float unit = normalize_direction(&ray);
    ray.slabs_are_panes = true;
    if (!(unit > 0.0f))
        return left;
    return follow(s, &ray, reach * unit, true, in_out_cut, &hit, &left, NULL) ? rgb_gray(0.0f) : left;
}

bool scene_find_surface(const scene *s, scene_ray ray, float max_distance, surface_hit *out_hit)
{
    ray.skips_uv = true;
    if (ray.alpha_rule == RAY_PASSES_ALPHA)
        ray.alpha_rule = RAY_MEETS_ALPHA;
    if (!s->has_interfaces)
        return scene_intersect(s, ray, max_distance, out_hit);
    uint64_t cut = 0;
    float unit = normalize_direction(&ray);
    if (!(unit > 0.0f) || !follow(s, &ray, max_distance * unit, false, &cut, out_hit, NULL, NULL))
        return false;
    out_hit->distance /= unit;
    return true;
}

bool scene_is_blocked(const scene *s, scene_ray ray, float max_distance)
{
    surface_hit hit;
    ray.alpha_rule = RAY_MEETS_ALPHA;
    return s->has_interfaces ? scene_find_surface(s, ray, max_distance, &hit) : scene_occluded(s, ray, max_distance);
}

void transmittance_warn_of_cut(log_sink *log, uint64_t count)
{
    if (count > 0)
        log_message(log, AG_LOG_WARNING, "%llu rays would cross more than %d interfaces or panes: they end there, dark",
                    (unsigned long long)count, TRANSMITTANCE_CROSSINGS_MAX);
}
