/* eye_path.c: see eye_path.h. */
#include "integrator/eye_path.h"

#include "integrator/direct_lighting.h"
#include "integrator/first_hit.h"

eye_path eye_path_begin(const camera_sample *from, eye_roulette roulette, bool wants_parts)
{
    return (eye_path){.where = from->where,
                      .ray = from->ray,
                      .throughput = rgb_gray(1.0f),
                      .share = 1.0f,
                      .roulette = roulette,
                      .scattered_from = from->ray.origin,
                      .scatter_count = 1,
                      .shared = 1.0f / (float)split_camera_rays(from->split),
                      .is_further = from->is_further,
                      .wants_parts = wants_parts,
                      .parts = {.of = {[PART_EMISSION] = rgb_gray(1.0f)}}};
}

/* --- the parts of the light --- */

/* Returns the shares of the parts behind a surface of whose scattered light the gathered lobes have this share. */
static part_shares shares_behind(const part_shares *before, rgb gathered)
{
    rgb traced = rgb_sub(rgb_gray(1.0f), gathered);
    rgb from_lamp = rgb_add(before->of[PART_DIRECT], before->of[PART_CAUSTIC]);
    part_shares after;
    after.of[PART_EMISSION] = rgb_gray(0.0f);
    after.of[PART_DIRECT] = rgb_mul(before->of[PART_EMISSION], gathered);
    after.of[PART_CAUSTIC] = rgb_mul(from_lamp, traced);
    after.of[PART_INDIRECT] = rgb_add(before->of[PART_INDIRECT], rgb_mul(from_lamp, gathered));
    after.of[PART_SPECULAR] = rgb_add(before->of[PART_SPECULAR], rgb_mul(before->of[PART_EMISSION], traced));
    return after;
}

/* Returns the share that the gathered ones among these lobes have in the light that they scatter out of a direction. */
static rgb gathered_share(const bsdf *b, bsdf_lobes lobes, vec3 direction)
{
    if (lobes != BSDF_ALL)
        return rgb_gray(lobes == BSDF_GATHERED ? 1.0f : 0.0f);
    rgb gathered = bsdf_evaluate(b, BSDF_GATHERED, BSDF_RADIANCE, direction);
    rgb traced = bsdf_evaluate(b, BSDF_TRACED, BSDF_RADIANCE, direction), all = rgb_add(gathered, traced);
    return (rgb){all.r > 0.0f ? gathered.r / all.r : 0.0f, all.g > 0.0f ? gathered.g / all.g : 0.0f,
                 all.b > 0.0f ? gathered.b / all.b : 0.0f};
}

/* Returns the shares of the parts behind the vertex, whose light was scattered by these lobes out of a direction. Light
 * that a medium scatters is traced on: specular, as seen by way of a mirror; but indirect behind a diffuse surface, as
 * gather rays find it. */
static part_shares shares_behind_vertex(const part_shares *before, const vertex *v, bsdf_lobes lobes, vec3 direction)
{
    if (!v->is_in_medium)
        return shares_behind(before, gathered_share(&v->scattering, lobes, direction));
    part_shares after = shares_behind(before, rgb_gray(0.0f));
    after.of[PART_INDIRECT] = rgb_add(after.of[PART_INDIRECT], after.of[PART_CAUSTIC]);
    after.of[PART_CAUSTIC] = rgb_gray(0.0f);
    return after;
}

/* Adds light to the sample and to the parts of it, which are NULL where nobody asks for them. is_sky: the light is an
 * infinite light's. Returns the factor by which the light was bounded. */
static float add_light(eye_sample *sample, const eye_path *path, const part_shares *parts, int scatterings, rgb brought,
                       bool is_sky)
{
    float kept = eye_sample_bound(sample, eye_path_shared(path), scatterings, brought);
    if (kept < 1.0f)
        brought = rgb_scale(brought, kept);
    sample->radiance = rgb_add(sample->radiance, brought);
    for (int i = 0; parts && i < LIGHT_PART_COUNT; i++)
        eye_sample_add_part(sample, (light_part)i, rgb_mul(brought, parts->of[i]));
    if (parts && is_sky)
        sample->layers->sky = rgb_add(sample->layers->sky, rgb_mul(brought, parts->of[PART_DIRECT]));
    return kept;
}

/* --- the steps --- */

/* Notes for layers what the camera ray meets first: a surface, also where a medium before it has scattered the ray. */
static void fill_first_hit(const transport *t, eye_worker *worker, const eye_path *path, const vertex *met,
                           first_hit *out_first)
{
    vertex behind;
    if (!met->is_in_medium)
        first_hit_fill(t, worker, met, &path->where, out_first);
    else if (transport_trace(t, worker, path->ray, &behind))
        first_hit_fill(t, worker, &behind, &path->where, out_first);
}

bool eye_path_trace(const transport *t, eye_worker *worker, eye_path *path, eye_sample *sample, vertex *out)
{
    bool is_camera_ray = path->vertex == 0;
    if (is_camera_ray && path->is_further)
        worker->rays_further++;
    else if (is_camera_ray)
        worker->rays_camera++;
    else
        worker->rays_path++;
    vec2 u = {0.0f, 0.0f};
    if (t->s->has_scattering_media)
        u = sampler_2d(&path->where, SAMPLE_DISTANCE, eye_path_key(path));
    bool is_met = transport_travel(t, worker, path->ray, path->throughput, u, out);
    path->throughput = rgb_mul(path->throughput, out->transmittance);
    worker->camera_rays_met += is_met && is_camera_ray;
    if (is_camera_ray && t->wants_layers) {
        float alpha = is_met ? 1.0f : float_max(1.0f - rgb_mean(out->transmittance), 0.0f);
        sample->layers->alpha += path->shared * alpha;
        if (is_met && !path->is_further)
            fill_first_hit(t, worker, path, out, &sample->layers->first);
    }
    return is_met;
}

/* Returns the samples that the path's light is weighted against. */
static light_counts weighted_against(const eye_path *path) { return (light_counts){1, (float)path->scatter_count}; }

void eye_path_add_escaped(const transport *t, const eye_path *path, eye_sample *sample)
{
    light_group_sums groups;
    rgb *by_group = light_group_sums_begin(&groups, t->wants_groups);
    rgb weight = rgb_scale(path->throughput, eye_path_shared(path));
    rgb escaped = direct_light_escaped(t, path->scattered_from, path->scattered_normal, path->ray.direction,
                                       path->scattered_pdf, weighted_against(path), by_group);
    float kept = add_light(sample, path, path->wants_parts ? &path->parts : NULL, path->scatterings,
                           rgb_mul(weight, escaped), true);
    eye_sample_add_groups(sample, by_group, rgb_scale(weight, kept));
}

void eye_path_add_emitted(const transport *t, const eye_path *path, const vertex *v, eye_sample *sample)
{
    rgb emitted = vertex_emission(t->s, v);
    if (rgb_is_black(emitted))
        return;
    float weight = eye_path_shared(path);
    if (path->scattered_pdf > 0.0f)
        weight *= direct_light_scatter_weight(t, path->scattered_from, path->scattered_normal, v, path->scattered_pdf,
                                              weighted_against(path));
    rgb seen = rgb_scale(rgb_mul(path->throughput, emitted), weight);
    float kept = add_light(sample, path, path->wants_parts ? &path->parts : NULL, path->scatterings, seen, false);
    if (t->wants_groups)
        eye_sample_add_group(sample, v->lamp->group, rgb_scale(seen, kept));
}

void eye_path_add_direct(const transport *t, eye_worker *worker, const eye_path *path, const vertex *v,
                         bsdf_lobes lobes, int scatter_count, eye_sample *sample)
{
    int key = eye_path_key(path);
    float u_pick = sampler_2d(&path->where, SAMPLE_LIGHT_PICK, key).x;
    lamp_light direct = direct_light_sample_lamp(t, worker, v, lobes, u_pick,
                                                 sampler_2d(&path->where, SAMPLE_LIGHT, key), 1, (float)scatter_count);
    rgb brought = rgb_mul(rgb_scale(path->throughput, eye_path_shared(path)), direct.radiance);
    if (rgb_is_black(brought))
        return;
    const light *lamp = &t->s->lights[direct.lamp];
    part_shares parts;
    if (path->wants_parts)
        parts = shares_behind_vertex(&path->parts, v, lobes, direct.direction);
    float kept =
        add_light(sample, path, path->wants_parts ? &parts : NULL, path->scatterings + 1, brought, light_is_sky(lamp));
    if (t->wants_groups)
        eye_sample_add_group(sample, lamp->group, rgb_scale(brought, kept));
}

/* The share of the samples of rough lobes, of those that gather guiding has of gather rays, that glints guide. They are
 * few, since these rays bring other light too, whose mean square grows by a seventh at most if they are an eighth. */
static const float GLINT_SHARE = 0.25f;

/* Photons guide from within this many of the largest radii of the caustic map's estimates. */
static const float GLINT_REACH = 4.0f;

const glint_guide *eye_path_find_glints(const transport *t, const vertex *v, glint_guide *out_guide)
{
    bool may_meet_lamps = t->caustic && t->can_meet_lights && transport_wants_all_light(t);
    if (!may_meet_lamps || !(t->settings->gather_guiding > 0.0f) || v->is_in_medium ||
        !bsdf_is_rough_reflection(&v->scattering, BSDF_TRACED))
        return NULL;
    map_point at = vertex_map_point(t->s, v);
    float reach = GLINT_REACH * t->caustic->max_radius;
    return glint_guide_find(&t->caustic->tree, at.position, at.facing_normal, reach, out_guide) ? out_guide : NULL;
}

/* Samples a direction by the lobes or, for a share of the samples, by glints, and weighs it by the density of both
 * together. Its pdf is that of the lobes alone, against which shadow rays are weighted. */
static bool sample_guided(const transport *t, const bsdf *b, bsdf_lobes lobes, const glint_guide *glints, float u_lobe,
                          vec2 u, bsdf_sample *out)
{
    float share = GLINT_SHARE * t->settings->gather_guiding;
    if (u_lobe < share) {
        vec3 direction = glint_guide_sample(glints, u_lobe / share, u);
        float pdf = bsdf_pdf(b, lobes, BSDF_RADIANCE, direction);
        if (!(pdf > 0.0f))
            return false;
        float density = share * glint_guide_density(glints, direction) + (1.0f - share) * pdf;
        rgb value = bsdf_evaluate(b, lobes, BSDF_RADIANCE, direction);
        *out = (bsdf_sample){
            .direction = direction, .weight = rgb_scale(value, 1.0f / density), .pdf_solid_angle = pdf, .group = lobes};
        return !rgb_is_black(value);
    }
    if (!bsdf_sample_direction(b, lobes, BSDF_RADIANCE, float_below_one((u_lobe - share) / (1.0f - share)), u, out))
        return false;
    float density = share * glint_guide_density(glints, out->direction) + (1.0f - share) * out->pdf_solid_angle;
    out->weight = rgb_scale(out->weight, out->pdf_solid_angle / density);
    return true;
}

bool eye_path_go_on(const transport *t, const vertex *v, bsdf_lobes lobes, const glint_guide *glints, float u_lobe,
                    int branch_count, eye_path *path)
{
    bsdf_sample next;
    int key = eye_path_key(path);
    bool is_last = eye_path_is_last(t, path), may_go_straight = transport_is_open_pane(t, v);
    if ((is_last && !may_go_straight) || !bsdf_has(&v->scattering, lobes))
        return false;
    vec2 u = sampler_2d(&path->where, SAMPLE_SCATTER, key);
    if (glints ? !sample_guided(t, &v->scattering, lobes, glints, u_lobe, u, &next)
               : !bsdf_sample_direction(&v->scattering, lobes, BSDF_RADIANCE, u_lobe, u, &next))
        return false;
    bool goes_straight = may_go_straight && next.is_straight;
    if (is_last && !goes_straight)
        return false;
    path->throughput = rgb_mul(path->throughput, next.weight);
    path->in_media += v->is_in_medium;
    float level = path->in_media > 0 ? medium_roulette_level(path->in_media) : path->roulette.level;
    if (path->vertex >= path->roulette.after &&
        !transport_survives(&path->throughput, level, sampler_2d(&path->where, SAMPLE_ROULETTE, key).x))
        return false;
    path->vertex++;
    if (goes_straight) {
        path->ray = vertex_ray_straight(v);
        return true;
    }
    path->scatterings++;
    if (path->first_gathered == 0 && next.group == BSDF_GATHERED)
        path->first_gathered = path->scatterings;
    if (path->wants_parts)
        path->parts = shares_behind_vertex(&path->parts, v, next.is_delta ? next.group : lobes, next.direction);
    path->scattered_from = vertex_position(v);
    path->scattered_normal = vertex_light_normal(v, lobes);
    path->scattered_pdf = next.is_delta ? 0.0f : next.pdf_solid_angle;
    path->scatter_count = branch_count;
    path->ray = transport_scattered_ray(t, v, next.direction, next.is_delta);
    path->ray.cone = transport_scattered_cone(t, v, &next);
    return true;
}
