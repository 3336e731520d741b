/* rays_embree.c: casts rays at the scene's shapes, singly and as fans, and evaluates their hits. Only the files
 * *_embree.c know Embree. Rests on: Wald et al., "Embree: A Kernel Framework for Efficient
 * CPU Ray Tracing", 2014. Flow: bvh_embree -> [here] -> transmittance. Threads: rays may be cast from any. */
#include "rays/bvh_embree.h"
#include "rays/geometry_embree.h"
#include "rays/glued_faces.h"
#include "rays/rays.h"

static struct RTCRay embree_ray(const scene_ray *r, float max_distance)
{
    struct RTCRay ray = {.org_x = r->origin.x,
                         .org_y = r->origin.y,
                         .org_z = r->origin.z,
                         .tnear = 0.0f,
                         .dir_x = r->direction.x,
                         .dir_y = r->direction.y,
                         .dir_z = r->direction.z,
                         .time = r->time,
                         .tfar = max_distance,
                         .mask = 0xffffffffu,
                         .id = (unsigned)r->alpha_rule,
                         .flags = 0};
    return ray;
}

static void fill_instance_hit(const scene *s, const scene_ray *ray, const ray_meeting *met, surface_hit *out_hit)
{
    uint32_t index = met->instance - s->shape_count;
    const scene_object *o = &s->objects[s->instances[index].object_index];
    affine world_from_object = instance_at(s, index, ray->time);
    double t = (double)met->distance;
    const double world[3] = {(double)ray->origin.x + t * (double)ray->direction.x,
                             (double)ray->origin.y + t * (double)ray->direction.y,
                             (double)ray->origin.z + t * (double)ray->direction.z};
    out_hit->instance_index = index;
    out_hit->shape_index = s->object_shapes[o->first_shape + met->geometry];
    const shape *at = &s->shapes[out_hit->shape_index];
    vec3 direction = ray->direction;
    if (at->kind == SHAPE_CURVES)
        direction = instance_direction_in_object(&world_from_object, direction);
    shape_surface_at(at, met->primitive, met->u, met->v, instance_point_in_object(&world_from_object, world), direction,
                     ray->time, out_hit);
    instance_transform_hit(&world_from_object, out_hit);
}

static void fill_hit(const scene *s, const scene_ray *ray, const ray_meeting *met, surface_hit *out_hit)
{
    out_hit->distance = met->distance;
    out_hit->primitive_index = met->primitive;
    out_hit->time = ray->time;
    out_hit->slab.thickness = 0.0f;
    out_hit->footprint.width = 0.0f;
    if (met->instance != RTC_INVALID_GEOMETRY_ID) {
        fill_instance_hit(s, ray, met, out_hit);
        return;
    }
    out_hit->shape_index = met->geometry;
    out_hit->instance_index = SCENE_NO_INSTANCE;
    vec3 position = vec3_add_scaled(ray->origin, ray->direction, met->distance);
    const shape *at = &s->shapes[met->geometry];
    if (ray->skips_uv && s->textures.count == 0)
        shape_hit_at(at, met->primitive, met->u, met->v, position, ray->direction, ray->time, out_hit);
    else
        shape_surface_at(at, met->primitive, met->u, met->v, position, ray->direction, ray->time, out_hit);
}

/* Embree accepts nothing beyond 1.8e18, and ends the process where it was built with asserts, as Debian's is.
 * Comparisons with NaN are false. */
static bool is_in_reach(vec3 v) { return fabsf(v.x) <= 1.8e18f && fabsf(v.y) <= 1.8e18f && fabsf(v.z) <= 1.8e18f; }

static bool can_be_cast(const scene_ray *r, float max_distance)
{
    return is_in_reach(r->origin) && is_in_reach(r->direction) && max_distance >= 0.0f;
}

/* Returns a ray to cast, which has met nothing yet. */
static struct RTCRayHit ray_hit_of(const scene_ray *ray, float max_distance)
{
    struct RTCRayHit r;
    r.ray = embree_ray(ray, max_distance);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return r;
}

static ray_meeting meeting_of(const struct RTCRayHit *ray_hit)
{
    const struct RTCHit *h = &ray_hit->hit;
    bool is_met = h->geomID != RTC_INVALID_GEOMETRY_ID;
    return (ray_meeting){is_met ? ray_hit->ray.tfar : INFINITY, h->u, h->v, h->geomID, h->primID, h->instID[0]};
}

static void cast_one(const scene *s, const scene_ray *ray, float max_distance, ray_meeting *out_met)
{
    struct RTCRayHit ray_hit = ray_hit_of(ray, max_distance);
    embree_intersect(s->bvh->scene, &ray_hit);
    *out_met = meeting_of(&ray_hit);
}

/* scene_intersect_role, without evaluating the hit. */
static bool cast_by_role(const scene *s, const scene_ray *ray, float from, float to, unsigned roles,
                         ray_meeting *out_met)
{
    struct RTCRayHit ray_hit = ray_hit_of(ray, to);
    ray_hit.ray.tnear = from;
    ray_hit.ray.id |= roles << EMBREE_ROLES_SHIFT;
    embree_intersect_filtered(s->bvh->scene, &ray_hit, embree_filter_by_role);
    *out_met = meeting_of(&ray_hit);
    return out_met->geometry != RTC_INVALID_GEOMETRY_ID;
}

bool scene_intersect_role(const scene *s, scene_ray ray, float from, float to, unsigned roles, surface_hit *out_hit)
{
    ray_meeting met;
    if (!can_be_cast(&ray, to) || !cast_by_role(s, &ray, from, to, roles, &met))
        return false;
    fill_hit(s, &ray, &met, out_hit);
    return true;
}

static const shape *shape_met(const scene *s, const ray_meeting *met)
{
    if (met->instance == RTC_INVALID_GEOMETRY_ID)
        return &s->shapes[met->geometry];
    const scene_object *o = &s->objects[s->instances[met->instance - s->shape_count].object_index];
    return &s->shapes[s->object_shapes[o->first_shape + met->geometry]];
}

/* Puts the opaque face that glass is glued to in the place of the glass that was met; else leaves *in_out_met alone. */
static void meet_glued(const scene *s, const scene_ray *ray, ray_meeting *in_out_met)
{
    surface_hit glass, face;
    ray_meeting behind;
    if (in_out_met->geometry == RTC_INVALID_GEOMETRY_ID || !shape_met(s, in_out_met)->is_glued)
        return;
    fill_hit(s, ray, in_out_met, &glass);
    const float window = glued_faces_window(&glass, ray->direction), t = in_out_met->distance;
    if (!cast_by_role(s, ray, float_max(t - window, 0.0f), t + window, SHAPE_IS_OPAQUE, &behind))
        return;
    fill_hit(s, ray, &behind, &face);
    if (glued_faces_touch(&glass, &face))
        *in_out_met = behind;
}

bool scene_intersect(const scene *s, scene_ray ray, float max_distance, surface_hit *out_hit)
{
    ray_meeting met;
    if (!can_be_cast(&ray, max_distance))
        return false;
    cast_one(s, &ray, max_distance, &met);
    if (s->has_glued_faces)
        meet_glued(s, &ray, &met);
    if (met.geometry == RTC_INVALID_GEOMETRY_ID || met.distance > max_distance)
        return false;
    fill_hit(s, &ray, &met, out_hit);
    return true;
}

/* --- fans --- */

/* Up to SINGLES_MAX rays are cast singly: a packet whose rays soon diverge takes longer than its rays alone
 * (cornell-box, 8 rays a gather: 1.15 times in all). */
enum { PACKET = 8, SINGLES_MAX = 15 };

/* Sorts rays by octant, and there by one coordinate, so that rays of about one direction are cast together. */
static void put_in_order(const ray_fan *f, uint8_t out_order[RAY_FAN_MAX])
{
    enum { SLICES = 8, KEYS = 8 * SLICES };
    uint8_t keys[RAY_FAN_MAX], begins[KEYS] = {0}, sum = 0;
    for (uint32_t i = 0; i < f->count; i++) {
        float x = f->direction[0][i], y = f->direction[1][i], z = f->direction[2][i];
        float above = (z + 1.0f) * (0.5f * SLICES);
        int slice = above >= SLICES - 1 ? SLICES - 1 : above > 0.0f ? (int)above : 0;
        keys[i] = (uint8_t)(((x < 0.0f) | (y < 0.0f) << 1 | (z < 0.0f) << 2) * SLICES + slice);
    }
    for (uint32_t i = 0; i < f->count; i++)
        begins[keys[i]]++;
    for (uint32_t k = 0; k < KEYS; k++) {
        uint8_t of_key = begins[k];
        begins[k] = sum;
        sum = (uint8_t)(sum + of_key);
    }
    for (uint32_t i = 0; i < f->count; i++)
        out_order[begins[keys[i]]++] = (uint8_t)i;
}

static void fill(float lanes[PACKET], float value)
{
    for (int k = 0; k < PACKET; k++)
        lanes[k] = value;
}

static void cast_packet(const scene *s, ray_fan *f, const uint8_t *numbers, uint32_t count)
{
    _Alignas(32) int valid[PACKET];
    struct RTCRayHit8 p;
    const scene_ray *c = &f->common;
    fill(p.ray.org_x, c->origin.x), fill(p.ray.org_y, c->origin.y), fill(p.ray.org_z, c->origin.z);
    fill(p.ray.tnear, 0.0f), fill(p.ray.tfar, INFINITY), fill(p.ray.time, c->time);
    for (uint32_t k = 0; k < PACKET; k++) {
        p.ray.mask[k] = 0xffffffffu;
        p.ray.id[k] = (unsigned)c->alpha_rule;
        p.ray.flags[k] = 0;
        p.hit.geomID[k] = p.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        vec3 d = ray_fan_direction(f, numbers[k < count ? k : 0]);
        bool is_good = is_in_reach(d);
        p.ray.dir_x[k] = is_good ? d.x : 1.0f, p.ray.dir_y[k] = is_good ? d.y : 1.0f;
        p.ray.dir_z[k] = is_good ? d.z : 1.0f;
        valid[k] = k < count && is_good ? -1 : 0;
    }
    embree_intersect_8(valid, s->bvh->scene, &p);
    for (uint32_t k = 0; k < count; k++) {
        bool is_met = valid[k] && p.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
        f->met[numbers[k]] = (ray_meeting){is_met ? p.ray.tfar[k] : INFINITY,
                                           p.hit.u[k],
                                           p.hit.v[k],
                                           p.hit.geomID[k],
                                           p.hit.primID[k],
                                           p.hit.instID[0][k]};
    }
}

static scene_ray ray_of(const ray_fan *f, uint32_t i)
{
    scene_ray ray = f->common;
    ray.direction = ray_fan_direction(f, i);
    return ray;
}

static void cast_fan(const scene *s, ray_fan *f)
{
    uint8_t order[RAY_FAN_MAX];
    if (f->count <= SINGLES_MAX) {
        for (uint32_t i = 0; i < f->count; i++) {
            scene_ray ray = ray_of(f, i);
            if (is_in_reach(ray.direction))
                cast_one(s, &ray, INFINITY, &f->met[i]);
            else
                f->met[i].distance = INFINITY;
        }
        return;
    }
    put_in_order(f, order);
    for (uint32_t i = 0; i < f->count; i += PACKET)
        cast_packet(s, f, order + i, f->count - i < PACKET ? f->count - i : PACKET);
}

void scene_intersect_fan(const scene *s, ray_fan *f)
{
    if (!is_in_reach(f->common.origin)) {
        for (uint32_t i = 0; i < f->count; i++)
            f->met[i].distance = INFINITY;
        return;
    }
    cast_fan(s, f);
    for (uint32_t i = 0; s->has_glued_faces && i < f->count; i++)
        if (!isinf(f->met[i].distance)) {
            scene_ray ray = ray_of(f, i);
            meet_glued(s, &ray, &f->met[i]);
        }
}

void ray_fan_hit(const scene *s, const ray_fan *f, uint32_t i, surface_hit *out_hit)
{
    scene_ray ray = ray_of(f, i);
    fill_hit(s, &ray, &f->met[i], out_hit);
}

const rgb *ray_fan_plain_point(const scene *s, const ray_fan *f, uint32_t i, surface_point *out_point)
{
    const ray_meeting *met = &f->met[i];
    if (met->instance != RTC_INVALID_GEOMETRY_ID)
        return NULL;
    const shape *at = &s->shapes[met->geometry];
    const rgb *albedo = material_plain_albedo(&s->materials[at->material_index]);
    vec3 direction = ray_fan_direction(f, i);
    vec3 position = vec3_add_scaled(f->common.origin, direction, met->distance);
    if (!albedo || !shape_bare_point_at(at, met->primitive, met->u, met->v, position, out_point))
        return NULL;
    if (vec3_dot(out_point->normal, direction) > 0.0f)
        out_point->normal = vec3_negate(out_point->normal);
    return albedo;
}

float scene_first_distance(const scene *s, scene_ray ray)
{
    ray_meeting met;
    cast_one(s, &ray, INFINITY, &met);
    return met.distance;
}

bool scene_occluded(const scene *s, scene_ray ray, float max_distance)
{
    if (!can_be_cast(&ray, max_distance))
        return false;
    struct RTCRay cast = embree_ray(&ray, max_distance);
    embree_occluded(s->bvh->scene, &cast);
    return cast.tfar < 0.0f;
}
