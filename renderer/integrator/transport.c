/* transport.c: see transport.h. */
#include "integrator/transport.h"

#include "caustic_radius.h"
#include "rays/transmittance.h"

enum { LIGHT_SAMPLES_PER_SCATTER_SAMPLE = 4 };

sample_counts transport_sample_counts(const transport *t, uint32_t lights, bool is_first)
{
    sample_counts n = {.light = (int)lights, .scatter_probability = 1.0f};
    if (t->can_meet_lights)
        n.scatter = (n.light + LIGHT_SAMPLES_PER_SCATTER_SAMPLE - 1) / LIGHT_SAMPLES_PER_SCATTER_SAMPLE;
    /* a bound would cut what chance has made brighter */
    if (n.scatter == 1 && !is_first && !(t->settings->clamp_indirect > 0.0f))
        n.scatter_probability = (float)n.light / (float)LIGHT_SAMPLES_PER_SCATTER_SAMPLE;
    return n;
}

bool transport_meet(const transport *t, eye_worker *worker, scene_ray ray, vertex *out_vertex)
{
    bool is_met = transmittance_intersect(t->s, &ray, &worker->rays_cut, &out_vertex->hit, &out_vertex->transmittance);
    out_vertex->arrived = ray;
    out_vertex->is_in_medium = false;
    if (is_met)
        surface_widen_cone(&out_vertex->arrived, &out_vertex->hit);
    return is_met;
}

/* Moves along the ray as transport_travel does, without completing the vertex. */
static bool travel(const transport *t, eye_worker *worker, scene_ray ray, rgb carried, vec2 u, vertex *out)
{
    ray_end end = transmittance_travel(t->s, &ray, carried, u, &worker->rays_cut, &out->hit, &out->transmittance);
    out->arrived = ray;
    out->is_in_medium = end == RAY_ENDS_IN_MEDIUM;
    if (end == RAY_ENDS_NOWHERE)
        return false;
    surface_widen_cone(&out->arrived, &out->hit);
    return true;
}

bool transport_travel_to(const transport *t, eye_worker *worker, scene_ray ray, rgb carried, rng *random,
                         vertex *out_vertex)
{
    return t->s->has_scattering_media ? travel(t, worker, ray, carried, rng_vec2(random), out_vertex)
                                      : transport_meet(t, worker, ray, out_vertex);
}

bool transport_travel(const transport *t, eye_worker *worker, scene_ray ray, rgb carried, vec2 u, vertex *out_vertex)
{
    if (!t->s->has_scattering_media)
        return transport_trace(t, worker, ray, out_vertex);
    if (!travel(t, worker, ray, carried, u, out_vertex))
        return false;
    transport_complete(t, out_vertex);
    return true;
}

/* Directions whose cosine is above this are one: what is thin bends nothing, and a cone goes through as it is. */
static const float STRAIGHT_COSINE = 0.99999f;

ray_cone transport_scattered_cone(const transport *t, const vertex *v, const bsdf_sample *next)
{
    const ray_cone *c = &v->arrived.cone;
    if (!ray_cone_is_wide(c) || c->is_coarse || vec3_dot(v->arrived.direction, next->direction) > STRAIGHT_COSINE)
        return *c;
    if (next->group == BSDF_GATHERED)
        return transport_gather_cone(v);
    return next->is_delta
               ? ray_cone_bent(t->s, c, &v->hit, v->arrived.direction, next->direction, bsdf_index(&v->scattering))
               : ray_cone_scattered(c, next->pdf_solid_angle);
}

void transport_complete(const transport *t, vertex *v)
{
    const scene *s = t->s;
    if (v->is_in_medium) {
        bsdf_init_in_medium(&s->media[v->arrived.medium], vec3_negate(v->arrived.direction), &v->scattering);
        v->lamp = NULL;
        return;
    }
    const shape *where = &s->shapes[v->hit.shape_index];
    bsdf_init(s, &v->hit, vec3_negate(v->arrived.direction), &v->scattering);
    v->lamp = where->light_index == SHAPE_NO_LIGHT ? NULL : &s->lights[where->light_index];
}

bool transport_trace(const transport *t, eye_worker *worker, scene_ray ray, vertex *out_vertex)
{
    if (!transport_meet(t, worker, ray, out_vertex))
        return false;
    transport_complete(t, out_vertex);
    return true;
}

bool transport_trace_through_panes(const transport *t, eye_worker *worker, scene_ray ray, vertex *out)
{
    bool is_met = transport_trace(t, worker, ray, out);
    rgb left = out->transmittance;
    for (int crossings = 0; is_met && transport_is_open_pane(t, out); crossings++) {
        rgb passed = bsdf_straight_transmittance(&out->scattering);
        if (rgb_is_black(passed))
            break;
        bool is_cut = crossings == TRANSMITTANCE_CROSSINGS_MAX;
        worker->rays_cut += is_cut;
        left = is_cut ? rgb_gray(0.0f) : rgb_mul(left, passed);
        if (rgb_is_black(left)) {
            is_met = false;
            break;
        }
        is_met = transport_trace(t, worker, vertex_ray_straight(out), out);
        left = rgb_mul(left, out->transmittance);
    }
    out->transmittance = left;
    return is_met;
}

rgb transport_caustics(const transport *t, eye_worker *worker, const vertex *v)
{
    if (!t->caustic || t->caustic->set.count == 0)
        return rgb_gray(0.0f);
    map_point at = vertex_map_point(t->s, v);
    arena_mark mark = arena_save(worker->scratch);
    photon_neighbor *neighbors = eye_worker_neighbors(worker, t->caustic);
    rgb reflected = bsdf_gathered_reflection(&v->scattering), transmitted = bsdf_gathered_transmission(&v->scattering);
    const double least_area = caustic_least_area(t->caustic);
    worker->estimates_caustic += rgb_is_black(transmitted) ? 1 : 2;
    rgb sum = rgb_mul(reflected, irradiance_estimate_seen(t->caustic, at.position, at.facing_normal, least_area,
                                                          neighbors, &worker->rays_estimate));
    if (!rgb_is_black(transmitted))
        sum = rgb_add(
            sum, rgb_mul(transmitted, irradiance_estimate_seen(t->caustic, at.position, vec3_negate(at.facing_normal),
                                                               least_area, neighbors, &worker->rays_estimate)));
    arena_restore(worker->scratch, mark);
    return rgb_scale(sum, AG_INV_PI);
}

/* Caustics are looked up where this share of them, or more, reaches the eye; below that by chance, in proportion. */
static const float CAUSTIC_SHARE_MAX = 0.25f;

float transport_caustic_probability(const transport *t, float share_seen)
{
    if (t->settings->clamp_indirect > 0.0f)
        return 1.0f; /* a bound would cut what chance has made brighter */
    return float_min(share_seen / CAUSTIC_SHARE_MAX, 1.0f);
}

rgb transport_some_caustics(const transport *t, eye_worker *worker, const vertex *v, float probability, float u)
{
    return u < probability ? rgb_scale(transport_caustics(t, worker, v), 1.0f / probability) : rgb_gray(0.0f);
}
