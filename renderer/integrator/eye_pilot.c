/* eye_pilot.c: see eye_pilot.h. */
#include "integrator/eye_pilot.h"

#include "integrator/direct_lighting.h"
#include "integrator/eye_path.h"
#include "integrator/gather_path.h"
#include "integrator/pilot_lists.h"
#include "parallel_for.h"
#include "rays/transmittance.h"
#include "status.h"

#include <stdlib.h>

/* Eye paths over the frame, about one for so many photons and within bounds; gather rays of each point that they
 * see. */
enum { PHOTONS_PER_PATH = 100, EYE_PATHS_MIN = 1024, EYE_PATHS_MAX = 9216, GATHER_RAYS = 8, GRID_MAX = 4096 };
/* One importon for so many points that are asked, and the scatterings that it has at most. */
enum { POINTS_PER_IMPORTON = 2, IMPORTON_SCATTERINGS_MAX = 8 };
/* Eye paths that look for points that are lit, and that look how much is enclosed. */
enum { LIT_PATHS = 12288, ENCLOSURE_PATHS = 2048 };
/* The stream of the lamps that importons look for. */
enum { STREAM_LAMPS = 1 };
/* All points that a path finds count alike, so that roulette alone makes them as frequent as its light is bright. */
static const eye_roulette ROULETTE = {4, 1.0f};
/* Below this throughput a surface itself is noted in place of the ends of its gather rays, of which it sends few. */
static const float FAINT = 0.03f;

/* Sampler keys apart from the picture's own. */
static const uint64_t PILOT_SEED = 0x70696c6f74u;

static void add_point(pilot_row *row, pilot_list which, vec3 position, vec3 normal)
{
    pilot_row_add(row, which, &(query_point){position, normal});
}

/* Adds importance that arrives along a direction, as a photon. */
static void add_importon(pilot_row *row, pilot_list which, vec3 position, vec3 normal, vec3 direction)
{
    photon p = {.position = {position.x, position.y, position.z},
                .flux = flux_encode(rgb_gray(1.0f), 0),
                .direction = arrival_encode(direction, true),
                .normal = direction_encode(normal)};
    pilot_row_add(row, which, &p);
}

/* The eye paths of a pilot look for one of these: where the picture asks the maps for light, points of direct light, or
 * how much of the view is enclosed. */
typedef enum pilot_goal { PILOT_GOAL_REQUESTS, PILOT_GOAL_LIT, PILOT_GOAL_ENCLOSURE } pilot_goal;

typedef struct pilot_job {
    transport t;
    int width, height; /* of the grid */
    float aspect;
    pilot_goal goal;
    pilot_row *rows; /* [height] */
} pilot_job;

/* Adds the vertex to a list of points on each side that its diffuse lobes take light from. */
static void add_sides(const transport *t, const vertex *v, pilot_row *out, pilot_list which)
{
    map_point at = vertex_map_point(t->s, v);
    if (!rgb_is_black(bsdf_gathered_reflection(&v->scattering)))
        add_point(out, which, at.position, at.facing_normal);
    if (!rgb_is_black(bsdf_gathered_transmission(&v->scattering)))
        add_point(out, which, at.position, vec3_negate(at.facing_normal));
}

/* Looks for a lamp that is picked by its power, as photons' are, from a vertex, and notes how a photon begins
 * that comes straight from there. throughput: of the light that the vertex sends back. */
static void look_for_lamp(const transport *t, eye_worker *worker, const vertex *v, rgb throughput, rng random,
                          pilot_row *out)
{
    const scene *s = t->s;
    float probability;
    if (s->light_count == 0)
        return;
    emission_trial found = {.start = emission_start_draw(&random), .density = 1.0f};
    vec2 u = rng_vec2(&random);
    const light *lamp = &s->lights[scene_pick_light_by_power(s, found.start.u[0], &probability)];
    light_sample towards;
    if (!(probability > 0.0f) || !light_sample_from_point(s, lamp, vertex_position(v), u, &towards))
        return;
    emission_numbers numbers = emission_start_numbers(&found.start, NULL);
    rgb reflected = bsdf_evaluate(&v->scattering, BSDF_ALL, BSDF_RADIANCE, towards.direction);
    rgb brought = rgb_mul(rgb_mul(throughput, reflected), towards.radiance);
    if (rgb_is_black(brought) || !light_emission_numbers(s, lamp, vertex_position(v), u, &towards, &numbers))
        return;
    brought = rgb_mul(brought, direct_light_transmittance(t, worker, vertex_ray(v, towards.direction), &towards));
    found.value = sqrtf(rgb_mean(brought) / (towards.pdf_solid_angle * probability));
    found.start = emission_start_of(found.start.u[0], &numbers);
    if (found.value > 0.0f)
        pilot_row_add(out, PILOT_STARTS, &found);
}

/* Importance goes back along the light's ways from where it is asked for: where it is scattered by diffuse lobes, light
 * that arrives on that side will arrive there in part. */
static void trace_importon(const transport *t, eye_worker *worker, const gather_end *end, rng random, pilot_row *out)
{
    vertex v;
    rgb throughput = rgb_gray(1.0f);
    int left = end->scatterings_left < IMPORTON_SCATTERINGS_MAX ? end->scatterings_left : IMPORTON_SCATTERINGS_MAX;
    gather_end_make_white(end, &v);
    for (int scatterings = 0;;) {
        look_for_lamp(t, worker, &v, throughput, rng_make(random.state, STREAM_LAMPS, 0), out);
        bsdf_sample next;
        float u_lobe = rng_float(&random);
        vec2 u = rng_vec2(&random);
        if (!bsdf_sample_direction(&v.scattering, BSDF_ALL, BSDF_RADIANCE, u_lobe, u, &next))
            return;
        throughput = rgb_mul(throughput, next.weight);
        if (!transport_survives(&throughput, 1.0f, rng_float(&random)))
            return;
        if (scatterings > 0 && next.group == BSDF_GATHERED) {
            map_point at = vertex_map_point(t->s, &v);
            bool is_through = vec3_dot(vertex_facing_normal(&v), next.direction) < 0.0f;
            add_point(out, PILOT_ONWARD, at.position, is_through ? vec3_negate(at.facing_normal) : at.facing_normal);
            if (!is_through)
                add_importon(out, PILOT_WAYS, at.position, at.facing_normal, v.arrived.direction);
        }
        bool goes_straight = transport_is_open_pane(t, &v) && next.is_straight;
        scatterings += !goes_straight;
        if (scatterings == left)
            return;
        scene_ray ray = goes_straight ? vertex_ray_straight(&v)
                                      : transport_scattered_ray(t, &v, next.direction, next.group == BSDF_TRACED);
        ray.skips_uv = true;
        if (!transport_trace(t, worker, ray, &v))
            return;
        throughput = rgb_mul(throughput, v.transmittance);
    }
}

/* Where light may come to what is seen from a traced lobe that is rough. met: of a ray from there, not complete yet. */
static void note_caustic_way(const transport *t, const vertex *met, pilot_row *out)
{
    vertex v = *met;
    transport_complete(t, &v);
    if (!bsdf_has(&v.scattering, BSDF_TRACED) || !bsdf_is_sampled_from_light(&v.scattering, BSDF_TRACED))
        return;
    map_point at = vertex_map_point(t->s, &v);
    add_importon(out, PILOT_SEEN_WAYS, at.position, at.facing_normal, v.arrived.direction);
}

/* Sends the i-th gather ray of a vertex. Returns whether it meets something. out_first: its direction and weight;
 * out_random: its random numbers, for what follows; out_met: as of transport_travel_to. */
static bool send_gather_ray(const transport *t, eye_worker *worker, const vertex *v, const sampler *where,
                            int path_vertex, uint32_t i, rng *out_random, bsdf_sample *out_first, vertex *out_met)
{
    *out_random = rng_make(where->key, (uint64_t)path_vertex, i);
    vec2 u = sampler_2d_of(where, SAMPLE_GATHER, path_vertex, GATHER_RAYS, i);
    if (!bsdf_sample_direction(&v->scattering, BSDF_GATHERED, BSDF_RADIANCE, rng_float(out_random), u, out_first))
        return false;
    scene_ray ray = transport_scattered_ray(t, v, out_first->direction, false);
    ray.skips_uv = true;
    return transport_travel_to(t, worker, ray, out_first->weight, out_random, out_met);
}

static void gather_points(const transport *t, eye_worker *worker, const vertex *v, const sampler *where,
                          int path_vertex, int scatterings_left, pilot_row *out)
{
    for (uint32_t i = 0; scatterings_left >= 1 && i < GATHER_RAYS; i++) {
        rng random, side = rng_make(where->key, (uint64_t)path_vertex, GATHER_RAYS + i);
        bsdf_sample first;
        vertex met;
        gather_ends ends;
        rgb known = rgb_gray(0.0f);
        if (!send_gather_ray(t, worker, v, where, path_vertex, i, &random, &first, &met))
            continue;
        if (!met.is_in_medium)
            note_caustic_way(t, &met, out);
        if (!gather_path_follow(t, worker, &met, random, scatterings_left, first.weight, 1.0f, &known, &ends))
            continue;
        /* of two ends chance takes one, by its weight, so that a curtain counts no more than a wall */
        gather_ends_pick(&ends, rng_float(&side));
        add_point(out, PILOT_GATHERED, ends.end[0].point.position, ends.end[0].point.normal);
        if (i % POINTS_PER_IMPORTON == 0) {
            out->importons++;
            trace_importon(t, worker, &ends.end[0], rng_make(random.state, (uint64_t)path_vertex, i), out);
        }
    }
}

/* Adds the squared share of a point's gather rays that meet something. */
static void note_enclosure(const transport *t, eye_worker *worker, const vertex *v, const sampler *where,
                           int path_vertex, pilot_row *out)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < GATHER_RAYS; i++) {
        rng random;
        bsdf_sample first;
        vertex met;
        count += send_gather_ray(t, worker, v, where, path_vertex, i, &random, &first, &met);
    }
    const double share = (double)count / GATHER_RAYS;
    out->points++;
    out->enclosures += share * share;
}

/* Notes what the path looks for at a vertex from which it can go on. Returns whether it has found all that it looks
 * for. */
static bool note_vertex(const pilot_job *job, eye_worker *worker, const vertex *v, const sampler *where,
                        const eye_path *path, pilot_row *out)
{
    const transport *t = &job->t;
    const bool gathers = bsdf_has(&v->scattering, BSDF_GATHERED);
    if (job->goal == PILOT_GOAL_LIT) {
        if (bsdf_is_sampled_from_light(&v->scattering, BSDF_ALL))
            pilot_row_add(
                out, PILOT_LIT,
                &(lit_point){v->hit, v->arrived, vertex_light_normal(v, gathers ? BSDF_GATHERED : BSDF_TRACED)});
        return false;
    }
    if (!gathers)
        return false;
    if (job->goal == PILOT_GOAL_ENCLOSURE) {
        note_enclosure(t, worker, v, where, path->vertex, out);
        return true;
    }
    if (path->vertex > 0 && rgb_max(path->throughput) < FAINT) {
        add_sides(t, v, out, PILOT_GATHERED);
    } else {
        add_sides(t, v, out, PILOT_SEEN);
        gather_points(t, worker, v, where, path->vertex, eye_path_scatterings_left(t, path) - 1, out);
    }
    return false;
}

/* Follows an eye path as shading.c does, but looks for no light. */
static void look(const pilot_job *job, eye_worker *worker, int x, int y, pilot_row *out)
{
    const transport *t = &job->t;
    const scene *s = t->s;
    sampler where = sampler_make(t->settings->photon_seed ^ PILOT_SEED, x, y, 0, 0);
    vec2 within = sampler_2d(&where, SAMPLE_PIXEL, 0);
    float time = s->has_motion ? sampler_2d(&where, SAMPLE_TIME, 0).x : 0.0f;
    camera_sample from = {.where = where,
                          .ray = camera_generate_ray(&s->camera, ((float)x + within.x) / (float)job->width,
                                                     ((float)y + within.y) / (float)job->height, job->aspect,
                                                     sampler_2d(&where, SAMPLE_LENS, 0), time)};
    eye_path path = eye_path_begin(&from, ROULETTE, false);
    for (;;) {
        vertex v;
        if (!eye_path_trace(t, worker, &path, NULL, &v)) {
            out->escapes++;
            return;
        }
        if (!eye_path_is_last(t, &path) && note_vertex(job, worker, &v, &where, &path, out))
            return;
        if (!eye_path_go_on(t, &v, BSDF_TRACED, NULL, eye_path_u_lobe(&path), 1, &path))
            return;
    }
}

static void look_along_rows(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker_index)
{
    (void)block;
    const pilot_job *job = user;
    eye_worker worker = {.index = worker_index};
    for (uint64_t row = begin; row < end; row++)
        for (int x = 0; x < job->width && !run_is_cancelled(job->t.run); x++)
            look(job, &worker, x, (int)row, &job->rows[row]);
}

/* Cells about as wide as high. */
static void divide_frame(int paths, float aspect, int *out_width, int *out_height)
{
    float width = sqrtf((float)paths * aspect);
    *out_width = (int)float_clamp(width + 0.5f, 1.0f, (float)GRID_MAX);
    int height = paths / *out_width;
    *out_height = height < 1 ? 1 : height > GRID_MAX ? GRID_MAX : height;
}

static ag_status merge_asked(const pilot_job *job, pilot_list which, importance_map *out_importance)
{
    void *points;
    uint32_t count;
    AG_TRY(pilot_rows_merge(job->rows, job->height, which, &points, &count));
    ag_status status = importance_map_create(points, count, out_importance);
    free(points);
    return status;
}

static ag_status merge_onward(const pilot_job *job, importance_map *out_importance)
{
    const scene *s = job->t.s;
    void *points;
    uint32_t count, importons = 0;
    for (int i = 0; i < job->height; i++)
        importons += job->rows[i].importons;
    AG_TRY(pilot_rows_merge(job->rows, job->height, PILOT_ONWARD, &points, &count));
    vec3 radius = {s->bounding_radius, s->bounding_radius, s->bounding_radius};
    ag_status status = importance_map_create_smooth(points, count, importons, vec3_sub(s->bounding_center, radius),
                                                    vec3_add(s->bounding_center, radius), out_importance);
    free(points);
    return status;
}

static ag_status merge_ways(const pilot_job *job, run_context *run, pilot_list which, onward_ways *out_ways)
{
    uint32_t count;
    AG_TRY(pilot_rows_count(job->rows, job->height, which, &count));
    if (count == 0)
        return AG_OK;
    photon *importons = photon_records_create(count);
    if (!importons)
        return AG_ERROR_MEMORY;
    pilot_rows_copy(job->rows, job->height, which, importons);
    return onward_ways_create(run, importons, count, out_ways);
}

static ag_status merge_starts(const pilot_job *job, emission_starts *out_starts)
{
    void *trials;
    AG_TRY(pilot_rows_merge(job->rows, job->height, PILOT_STARTS, &trials, &out_starts->count));
    out_starts->trials = trials;
    return AG_OK;
}

/* The rows are to be freed by pilot_rows_destroy, on failure too. */
static ag_status look_over_frame(pilot_job *job, run_context *run, int paths, const ag_render_settings *settings)
{
    job->t.media_are_bounded = settings_bound_media(settings);
    job->t.panes_are_direct = job->t.s->has_panes && settings_panes_are_direct(settings);
    job->t.settings = settings;
    job->aspect = (float)settings->width / (float)settings->height;
    divide_frame(paths, job->aspect, &job->width, &job->height);
    job->rows = calloc((size_t)job->height, sizeof *job->rows);
    if (!job->rows)
        return AG_ERROR_MEMORY;
    return parallel_for(run, (uint64_t)job->height, 1, look_along_rows, job, AG_PHASE_PHOTONS, 0.0, 0.0);
}

static ag_status merge_lists(const pilot_job *job, run_context *run, eye_pilot *out_pilot)
{
    AG_TRY(merge_asked(job, PILOT_GATHERED, &out_pilot->gathered));
    AG_TRY(merge_onward(job, &out_pilot->onward));
    AG_TRY(merge_ways(job, run, PILOT_WAYS, &out_pilot->ways));
    AG_TRY(merge_ways(job, run, PILOT_SEEN_WAYS, &out_pilot->seen_ways));
    AG_TRY(merge_starts(job, &out_pilot->starts));
    emission_starts_move(job->t.s, &out_pilot->gathered, &out_pilot->starts);
    return merge_asked(job, PILOT_SEEN, &out_pilot->seen);
}

ag_status eye_pilot_look(const scene *s, run_context *run, const ag_render_settings *settings, eye_pilot *out_pilot)
{
    *out_pilot = (eye_pilot){0};
    uint64_t wanted = settings->photon_count / PHOTONS_PER_PATH;
    int paths = wanted < EYE_PATHS_MIN ? EYE_PATHS_MIN : wanted > EYE_PATHS_MAX ? EYE_PATHS_MAX : (int)wanted;
    pilot_job job = {.t = {.s = s, .run = run}};
    eye_pilot made = {0};
    ag_status status = look_over_frame(&job, run, paths, settings);
    if (status == AG_OK)
        status = merge_lists(&job, run, &made);
    pilot_rows_destroy(job.rows, job.height);
    if (status == AG_OK)
        *out_pilot = made;
    else
        eye_pilot_reset(&made);
    return status;
}

void eye_pilot_reset(eye_pilot *pilot)
{
    importance_map_reset(&pilot->gathered);
    importance_map_reset(&pilot->onward);
    importance_map_reset(&pilot->seen);
    onward_ways_reset(&pilot->ways);
    onward_ways_reset(&pilot->seen_ways);
    free(pilot->starts.trials);
    pilot->starts = (emission_starts){0};
}

ag_status eye_pilot_find_lit(const scene *s, run_context *run, const ag_render_settings *settings,
                             lit_point **out_points, uint32_t *out_count)
{
    pilot_job job = {.t = {.s = s, .run = run}, .goal = PILOT_GOAL_LIT};
    void *points = NULL;
    ag_status status = look_over_frame(&job, run, LIT_PATHS, settings);
    if (status == AG_OK)
        status = pilot_rows_merge(job.rows, job.height, PILOT_LIT, &points, out_count);
    pilot_rows_destroy(job.rows, job.height);
    *out_points = points;
    return status;
}

ag_status eye_pilot_find_enclosure(const scene *s, run_context *run, const ag_render_settings *settings,
                                   double *out_enclosure)
{
    pilot_job job = {.t = {.s = s, .run = run}, .goal = PILOT_GOAL_ENCLOSURE};
    ag_status status = look_over_frame(&job, run, ENCLOSURE_PATHS, settings);
    double sum = 0.0, count = 0.0;
    for (int i = 0; status == AG_OK && i < job.height; i++) {
        sum += job.rows[i].enclosures;
        count += (double)job.rows[i].points + (double)job.rows[i].escapes;
    }
    pilot_rows_destroy(job.rows, job.height);
    *out_enclosure = count > 0.0 ? sqrt(sum / count) : 1.0;
    return status == AG_OK && run_is_cancelled(run) ? AG_CANCELLED : status;
}
