/* first_hit.c: see first_hit.h. */
#include "integrator/first_hit.h"

/* Returns the albedo of a vertex: of gathered lobes in closed form, of all others by one sample, whose mean is the
 * share of light that they reflect and let through (1 for glass, the metal's colour for metal). */
static rgb albedo_at(const vertex *v, const sampler *where)
{
    rgb sum = rgb_add(bsdf_gathered_reflection(&v->scattering), bsdf_gathered_transmission(&v->scattering));
    bsdf_sample next;
    if (bsdf_has(&v->scattering, BSDF_TRACED) &&
        bsdf_sample_direction(&v->scattering, BSDF_TRACED, BSDF_FLUX,
                              sampler_2d(where, SAMPLE_LOBE, SAMPLER_KEY_ALBEDO).x,
                              sampler_2d(where, SAMPLE_SCATTER, SAMPLER_KEY_ALBEDO), &next))
        sum = rgb_add(sum, next.weight);
    return rgb_clamp(sum, 0.0f, 1.0f);
}

static rgb irradiance_at(const transport *t, eye_worker *worker, const vertex *v)
{
    const photon_map *map = t->cache->map;
    map_point at = vertex_map_point(t->s, v);
    arena_mark mark = arena_save(worker->scratch);
    photon_neighbor *neighbors = eye_worker_neighbors(worker, map);
    rgb irradiance;
    uint64_t rays = worker->rays_estimate;
    irradiance_estimate_find(map, at.position, at.facing_normal, neighbors, &worker->rays_estimate, &irradiance);
    /* not charged to the sample: asking for a layer must not change how samples are split */
    worker->uncharged_cost += worker->rays_estimate - rays;
    arena_restore(worker->scratch, mark);
    return irradiance;
}

void first_hit_fill(const transport *t, eye_worker *worker, const vertex *v, const sampler *where, first_hit *out)
{
    const scene *s = t->s;
    const surface_hit *hit = &v->hit;
    out->is_hit = true;
    out->position = hit->position;
    out->geometric_normal = vertex_facing_normal(v);
    out->normal = vec3_face_forward(v->scattering.shading.z, v->scattering.out);
    out->uv = hit->uv;
    out->depth = hit->distance;
    if (aov_has(t->layout, SUM_ALBEDO))
        out->albedo = albedo_at(v, where);
    if (aov_has(t->layout, SUM_IRRADIANCE))
        out->irradiance = irradiance_at(t, worker, v);
    out->object_id =
        hit->instance_index == SCENE_NO_INSTANCE ? hit->shape_index + 1 : s->shape_count + hit->instance_index + 1;
    out->material_id = s->shapes[hit->shape_index].material_index + 1;
}

/* Returns how much deeper, along the camera's axis, the surface's plane is where the next pixel's ray meets it. */
static float slope(const transport *t, const transform *camera_from_world, const first_hit *first,
                   const film_point *from, float step_x, float step_y)
{
    scene_ray beside = camera_generate_ray(&t->s->camera, from->film_x + step_x, from->film_y + step_y, from->aspect,
                                           from->lens, from->time);
    float towards = vec3_dot(beside.direction, first->geometric_normal);
    if (towards == 0.0f)
        return 0.0f;
    float distance = vec3_dot(vec3_sub(first->position, beside.origin), first->geometric_normal) / towards;
    vec3 moved = vec3_sub(vec3_add_scaled(beside.origin, beside.direction, distance), first->position);
    float dz = transform_vector(camera_from_world, moved).z;
    return isfinite(dz) ? dz : 0.0f;
}

void first_hit_project(const transport *t, const film_point *from, first_hit *in_out)
{
    const camera *c = &t->s->camera;
    if (!in_out->is_hit)
        return;
    transform world_from_camera = camera_transform_at(c, from->time);
    transform camera_from_world = transform_invert(&world_from_camera);
    vec3 in_camera = transform_point(&camera_from_world, in_out->position);
    if (c->kind == CAMERA_PERSPECTIVE || c->kind == CAMERA_ORTHOGRAPHIC)
        in_out->depth = in_camera.z;
    if (!aov_has(t->layout, SUM_SLOPE))
        return;
    in_out->slope.x = slope(t, &camera_from_world, in_out, from, 1.0f / (float)t->settings->width, 0.0f);
    in_out->slope.y = slope(t, &camera_from_world, in_out, from, 0.0f, 1.0f / (float)t->settings->height);
    if (!t->settings->layers_in_camera_space)
        return;
    in_out->position = in_camera;
    in_out->normal = transform_normal(&camera_from_world, in_out->normal);
    in_out->geometric_normal = transform_normal(&camera_from_world, in_out->geometric_normal);
}
