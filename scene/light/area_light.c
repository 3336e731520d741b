/* area_light.c: a shape that shines, by its own sampling, by the cone of a sphere, by the solid angles of a mesh's
 * triangles, or by a radiance map.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, 12.4 and 6.2.4 (the cone of a
 * sphere). Threads: read-only. */
#include "light/lamp_value.h"
#include "light/light_type.h"
#include "light/mesh_light.h"
#include "light/radiance_map.h"
#include "math/sampling.h"
#include "scene.h"
#include "shape/alpha.h"
#include "status.h"

static void init(light *l) { l->as.area.radiance_texture = SCENE_NO_TEXTURE; }

static void reset(light *l) { radiance_map_destroy(l->as.area.map); }

static void add_hash(const light *l, hash128 *h)
{
    HASH128_ADD(h, l->as.area.shape_index);
    HASH128_ADD(h, l->as.area.two_sided);
    HASH128_ADD(h, l->as.area.radiance);
    HASH128_ADD(h, l->as.area.radiance_texture);
}

static ag_status commit(const scene *s, light *l)
{
    return lamp_varies(s, l) && !l->as.area.map ? radiance_map_create(s, l, &l->as.area.map) : AG_OK;
}

static rgb power(const scene *s, const light *l)
{
    rgb mean = rgb_mul(l->as.area.radiance, l->as.area.map ? l->as.area.map->mean : lamp_sampled_value(s, l, NULL));
    return rgb_scale(mean, AG_PI * s->shapes[l->as.area.shape_index].area * (l->as.area.two_sided ? 2.0f : 1.0f));
}

/* --- how bright --- */

static rgb emitted_radiance(const scene *s, const light *l, const surface_hit *hit, vec3 direction)
{
    if (!l->as.area.two_sided && vec3_dot(hit->geometric_normal, direction) <= 0.0f)
        return rgb_gray(0.0f);
    return l->as.area.radiance_texture == SCENE_NO_TEXTURE
               ? l->as.area.radiance
               : rgb_mul(l->as.area.radiance, lamp_texture_value(s, l, hit));
}

/* --- towards a point --- */

static bool is_whole_sphere(const shape *s) { return s->kind == SHAPE_SPHERE && s->as.quadric.uniform_radius > 0.0f; }

/* The point of a whole sphere in the direction n from its centre. */
static surface_sample sphere_point(const shape *lamp, vec3 n)
{
    vec3 center = lamp->as.quadric.center;
    float r = lamp->as.quadric.uniform_radius;
    surface_sample at = {0};
    at.position = vec3_add_scaled(center, n, r);
    at.geometric_normal = lamp->flip_normal ? vec3_negate(n) : n;
    at.epsilon = (vec3_max_abs(center) + r) * SHAPE_EPSILON_RELATIVE;
    return at;
}

/* light_ball_cone of a lamp that is a whole sphere. */
static bool sphere_cone(const shape *s, vec3 point, float *out_one_minus_cos)
{
    if (!is_whole_sphere(s))
        return false;
    return light_ball_cone(s->as.quadric.center, s->as.quadric.uniform_radius, point, out_one_minus_cos);
}

/* A point on a lamp seen from outside its sphere, uniform in solid angle: a direction in the cone, then the near
 * intersection by plane geometry. */
static surface_sample sample_sphere_cone(const shape *lamp, vec3 point, vec2 u, float cone)
{
    vec3 center = lamp->as.quadric.center, to_center = vec3_sub(center, point);
    float distance = vec3_length(to_center), r = lamp->as.quadric.uniform_radius;
    frame f = frame_from_z(vec3_scale(to_center, 1.0f / distance));
    vec3 local = sample_uniform_cone(u, cone);
    float sin2 = float_max(local.x * local.x + local.y * local.y, 0.0f);
    float along = distance * local.z - sqrtf(float_max(r * r - distance * distance * sin2, 0.0f));
    return sphere_point(lamp,
                        vec3_normalize(vec3_sub(vec3_add_scaled(point, frame_to_world(&f, local), along), center)));
}

/* How a point on the lamp is sampled from a lit point. */
typedef enum lamp_sampling {
    BY_CONE,         /* uniform in solid angle; a whole sphere seen from outside */
    BY_SOLID_ANGLES, /* of a mesh's triangles */
    BY_MAP,          /* by the radiance map of a mesh, which knows its density at a hit */
    BY_AREA
} lamp_sampling;

/* *out_cone: one minus the cosine of the cone's half angle, with BY_CONE alone. */
static lamp_sampling sampling_from(const light *l, const shape *lamp, vec3 point, float *out_cone)
{
    if (lamp->kind == SHAPE_MESH)
        return l->as.area.map ? BY_MAP : BY_SOLID_ANGLES;
    return sphere_cone(lamp, point, out_cone) ? BY_CONE : BY_AREA;
}

static float pdf_of(mesh_light_density density, float distance_squared, float cos_lamp)
{
    return (float)(density.is_by_area ? density.value * (double)distance_squared / (double)cos_lamp : density.value);
}

/* A point on the lamp, sampled from a lit point. */
typedef struct lamp_point {
    surface_sample at;
    lamp_sampling sampling;
    float cone;                 /* BY_CONE */
    mesh_light_density density; /* BY_SOLID_ANGLES */
    float map_density;          /* the factor of the density by area; 1 but BY_MAP */
} lamp_point;

static bool sample_lamp(const light *l, const shape *lamp, vec3 point, vec2 u, lamp_point *out)
{
    out->sampling = sampling_from(l, lamp, point, &out->cone);
    out->map_density = 1.0f;
    if (out->sampling == BY_SOLID_ANGLES)
        return mesh_light_sample(lamp, l->as.area.two_sided, point, u, &out->at, &out->density);
    if (out->sampling == BY_MAP && !radiance_map_sample(l->as.area.map, u, &u, &out->map_density))
        return false;
    out->at = out->sampling == BY_CONE ? sample_sphere_cone(lamp, point, u, out->cone) : shape_sample_area(lamp, u);
    return true;
}

static bool sample_from_point(const scene *s, const light *l, vec3 point, vec2 u, light_sample *out)
{
    const shape *lamp = &s->shapes[l->as.area.shape_index];
    lamp_point picked;
    if (!sample_lamp(l, lamp, point, u, &picked))
        return false;
    const surface_sample at = picked.at;
    vec3 to_lamp = vec3_sub(at.position, point);
    float distance_squared = vec3_length_squared(to_lamp);
    if (!(distance_squared > 0.0f))
        return false;
    out->distance = sqrtf(distance_squared);
    out->direction = vec3_scale(to_lamp, 1.0f / out->distance);
    out->radiance = rgb_gray(0.0f);
    if (l->as.area.two_sided || vec3_dot(at.geometric_normal, out->direction) < 0.0f)
        out->radiance = rgb_mul(l->as.area.radiance, lamp_sampled_value(s, l, &at));
    float cos_lamp = fabsf(vec3_dot(at.geometric_normal, out->direction));
    if (rgb_is_black(out->radiance) || cos_lamp <= 1e-6f)
        return false;
    switch (picked.sampling) {
    case BY_CONE: out->pdf_solid_angle = 1.0f / (2.0f * AG_PI * picked.cone); break;
    case BY_SOLID_ANGLES: out->pdf_solid_angle = pdf_of(picked.density, distance_squared, cos_lamp); break;
    default: out->pdf_solid_angle = at.pdf_area * picked.map_density * distance_squared / cos_lamp;
    }
    out->shadow_target =
        vec3_add_scaled(at.position, vec3_face_forward(at.geometric_normal, vec3_negate(out->direction)), at.epsilon);
    out->is_delta = shape_is_invisible(lamp); /* then shadow rays alone find it */
    out->lamp_normal = at.geometric_normal;
    out->lamp_triangle = at.primitive_index;
    out->lamp_barycentrics = at.barycentrics;
    return true;
}

static float pdf_from_point(const scene *s, const light *l, vec3 point, const surface_hit *hit)
{
    const shape *lamp = &s->shapes[l->as.area.shape_index];
    float cone;
    vec2 u;
    lamp_sampling sampling = sampling_from(l, lamp, point, &cone);
    if (sampling == BY_CONE)
        return 1.0f / (2.0f * AG_PI * cone);
    vec3 to_lamp = vec3_sub(hit->position, point);
    float distance_squared = vec3_length_squared(to_lamp);
    float cos_lamp = fabsf(vec3_dot(hit->geometric_normal, to_lamp)) / sqrtf(distance_squared);
    if (!(cos_lamp > 0.0f))
        return 0.0f;
    if (sampling == BY_SOLID_ANGLES)
        return pdf_of(mesh_light_density_of(lamp, l->as.area.two_sided, point, hit->primitive_index), distance_squared,
                      cos_lamp);
    float density =
        sampling == BY_MAP && shape_sample_inverse(lamp, hit, &u) ? radiance_map_density(l->as.area.map, u) : 1.0f;
    return shape_pdf_area(lamp, hit->geometric_normal) * density * distance_squared / cos_lamp;
}

/* --- from the lamp --- */

/* Photons of a whole sphere start by the direction of their line in the world, and by where it passes the centre: all
 * lines that meet a sphere are alike, so that the direction's two numbers alone say where the light goes. Light that is
 * aimed is not sent so: its direction is within the target's cone, and says which part of the target it meets. */
static bool starts_by_lines(const light *l, const shape *lamp) { return is_whole_sphere(lamp) && !l->as.area.map; }

static bool finish_emission(const scene *s, const light *l, const surface_sample *at, vec3 n, float weight,
                            light_emission *out)
{
    const shape *lamp = &s->shapes[l->as.area.shape_index];
    out->flux = rgb_scale(rgb_mul(l->as.area.radiance, lamp_sampled_value(s, l, at)), weight);
    out->origin = vec3_add_scaled(at->position, n, at->epsilon);
    out->medium = vec3_dot(n, at->geometric_normal) > 0.0f ? lamp->medium_outside : lamp->medium_inside;
    return !rgb_is_black(out->flux);
}

static bool emit_line(const scene *s, const light *l, const emission_numbers *numbers, light_emission *out)
{
    const shape *lamp = &s->shapes[l->as.area.shape_index];
    const float r = lamp->as.quadric.uniform_radius;
    out->direction = sample_uniform_sphere(numbers->direction);
    const bool is_behind = l->as.area.two_sided && numbers->part < 0.5f, is_inward = lamp->flip_normal != is_behind;
    const vec2 across = sample_disk_concentric(numbers->position);
    const float rise = sqrtf(float_max(1.0f - across.x * across.x - across.y * across.y, 0.0f));
    const frame f = frame_from_z(out->direction);
    surface_sample at = sphere_point(lamp, frame_to_world(&f, vec3_make(across.x, across.y, is_inward ? -rise : rise)));
    at.epsilon = lamp->as.quadric.epsilon;
    const vec3 n = is_behind ? vec3_negate(at.geometric_normal) : at.geometric_normal;
    const float lines = 4.0f * AG_PI * (AG_PI * r * r) * (l->as.area.two_sided ? 2.0f : 1.0f);
    return finish_emission(s, l, &at, n, lines, out);
}

static bool emit(const scene *s, const light *l, const light_target *target, const emission_numbers *numbers,
                 light_emission *out)
{
    const shape *lamp = &s->shapes[l->as.area.shape_index];
    if (!target && starts_by_lines(l, lamp))
        return emit_line(s, l, numbers, out);
    vec2 u = numbers->position;
    float density = 1.0f, pdf;
    if (l->as.area.map && !radiance_map_sample(l->as.area.map, u, &u, &density))
        return false;
    surface_sample at = shape_sample_area(lamp, u);
    vec3 n = at.geometric_normal;
    if (light_aim_at(target, at.position, 1.0f, numbers->direction, &out->direction, &pdf)) {
        float cosine = vec3_dot(n, out->direction);
        if (l->as.area.two_sided && cosine < 0.0f) {
            n = vec3_negate(n);
            cosine = -cosine;
        }
        return finish_emission(s, l, &at, n, float_max(cosine, 0.0f) / (at.pdf_area * density * pdf), out);
    }
    if (l->as.area.two_sided && numbers->part < 0.5f)
        n = vec3_negate(n);
    frame f = frame_from_z(n);
    out->direction = frame_to_world(&f, sample_cosine_hemisphere(numbers->direction));
    /* L cos / (pdf_area cos/pi): the same for every photon but on ellipsoids, and nearly so by a radiance map */
    float weight = AG_PI * (l->as.area.two_sided ? 2.0f : 1.0f) / (at.pdf_area * density);
    return finish_emission(s, l, &at, n, weight, out);
}

static bool emission_numbers_of(const scene *s, const light *l, vec3 point, vec2 u, const light_sample *towards,
                                emission_numbers *in_out)
{
    const shape *lamp = &s->shapes[l->as.area.shape_index];
    float cone;
    lamp_sampling sampling = sampling_from(l, lamp, point, &cone);
    if (l->as.area.map && sampling != BY_MAP)
        return false; /* not by the numbers of the position */
    vec3 n = towards->lamp_normal, direction = vec3_negate(towards->direction);
    if (l->as.area.two_sided) {
        bool is_behind = vec3_dot(n, direction) < 0.0f;
        in_out->part = float_below_one(0.5f * in_out->part + (is_behind ? 0.0f : 0.5f));
        n = is_behind ? vec3_negate(n) : n;
    }
    if (starts_by_lines(l, lamp)) {
        frame f = frame_from_z(direction);
        vec3 across = frame_to_local(&f, vec3_sub(point, lamp->as.quadric.center));
        const float inverse = 1.0f / lamp->as.quadric.uniform_radius;
        in_out->direction = sample_uniform_sphere_inverse(direction);
        in_out->position = sample_disk_concentric_inverse((vec2){across.x * inverse, across.y * inverse});
        return true;
    }
    in_out->position = sampling == BY_SOLID_ANGLES
                           ? shape_sample_numbers(lamp, towards->lamp_triangle, towards->lamp_barycentrics)
                           : u;
    frame f = frame_from_z(n);
    vec3 local = frame_to_local(&f, direction);
    in_out->direction = sample_disk_concentric_inverse((vec2){local.x, local.y});
    return local.z > 0.0f;
}

/* --- bounds --- */

/* The triangle's normals: as surface_hit has it, vertex normals say which way is outside, and may disagree. */
static void add_normal(const mesh *m, uint32_t triangle, vec3 n, vec3 axis, float *least_cos)
{
    const uint32_t *index = m->indices + 3 * (size_t)triangle;
    bool is_turned = false, is_kept = !m->normals;
    for (int k = 0; m->normals && k < 3; k++)
        *(vec3_dot(n, m->normals[index[k]]) < 0.0f ? &is_turned : &is_kept) = true;
    float cosine = vec3_dot(n, axis);
    if (is_kept)
        *least_cos = float_min(*least_cos, cosine);
    if (is_turned)
        *least_cos = float_min(*least_cos, -cosine);
}

static vec3 triangle_normal(const shape *s, uint32_t triangle, float *out_area)
{
    const mesh *m = &s->as.mesh;
    const uint32_t *index = m->indices + 3 * (size_t)triangle;
    vec3 p = m->positions[index[0]];
    vec3 n = vec3_cross(vec3_sub(m->positions[index[1]], p), vec3_sub(m->positions[index[2]], p));
    float length = vec3_length(n);
    *out_area = 0.5f * length;
    if (!(length > 0.0f && isfinite(length)))
        return (vec3){0.0f, 0.0f, 0.0f};
    return vec3_scale(n, (s->flip_normal ? -1.0f : 1.0f) / length);
}

/* Finds the mean normal, and the greatest angle of the others to it. */
static void find_mesh_normals(const shape *s, light_bounds *b)
{
    const mesh *m = &s->as.mesh;
    vec3 sum = {0.0f, 0.0f, 0.0f};
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        float area;
        vec3 n = triangle_normal(s, i, &area);
        if (m->normals)
            n = vec3_face_forward(n, m->normals[m->indices[3 * (size_t)i]]);
        sum = vec3_add_scaled(sum, n, area / s->area);
    }
    float length = vec3_length(sum);
    if (!(length > LIGHT_BOUNDS_SLACK))
        return;
    b->axis = vec3_scale(sum, 1.0f / length);
    float least = 1.0f;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        float area;
        vec3 n = triangle_normal(s, i, &area);
        if (area > 0.0f)
            add_normal(m, i, n, b->axis, &least);
        else
            least = LIGHT_BOUNDS_ALL_AROUND; /* a sliver, whose normal single precision does not know */
    }
    b->cos_normals = float_max(least - LIGHT_BOUNDS_SLACK, LIGHT_BOUNDS_ALL_AROUND);
}

static void narrow_bounds(const scene *s, const light *l, light_bounds *b)
{
    const shape *lamp = &s->shapes[l->as.area.shape_index];
    vec3 low, high;
    shape_bounds(lamp, &low, &high);
    b->center = vec3_add_scaled(low, vec3_sub(high, low), 0.5f);
    b->radius = 0.5f * vec3_length(vec3_sub(high, low));
    b->cos_emission = 0.0f;
    b->least_cos = 0.0f;
    b->two_sided = l->as.area.two_sided;
    b->intensity = rgb_mean(l->power) * AG_INV_PI * (l->as.area.two_sided ? 0.5f : 1.0f);
    if (lamp->kind == SHAPE_DISK) {
        surface_sample at = shape_sample_area(lamp, (vec2){0.5f, 0.5f});
        b->axis = at.geometric_normal;
        b->cos_normals = 1.0f - LIGHT_BOUNDS_SLACK;
    } else if (lamp->kind == SHAPE_MESH) {
        find_mesh_normals(lamp, b);
    }
    if (b->cos_normals < 0.0f)
        b->intensity *= 0.25f; /* Cauchy: a convex body shows a quarter of its surface, on average */
}

const light_type area_light = {.can_be_met = true,
                               .init = init,
                               .reset = reset,
                               .add_hash = add_hash,
                               .commit = commit,
                               .power = power,
                               .sample_from_point = sample_from_point,
                               .pdf_from_point = pdf_from_point,
                               .emitted_radiance = emitted_radiance,
                               .emit = emit,
                               .emission_numbers_of = emission_numbers_of,
                               .narrow_bounds = narrow_bounds};
