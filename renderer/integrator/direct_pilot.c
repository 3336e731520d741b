/* direct_pilot.c: see direct_pilot.h. */
#include "integrator/direct_pilot.h"

#include "integrator/direct_lighting.h"
#include "integrator/eye_pilot.h"
#include "light/light_tree.h"
#include "parallel_for.h"
#include "status.h"

#include <stdlib.h>

/* The pilot first casts a few rays for each of 8 by 8 parts of the square: where most of those above the horizon see
 * the sky, no more are needed. Elsewhere it casts one for each bin. For lamps it casts some from each point. */
enum { COARSE_SIDE = 8, COARSE_RAYS = 2, FINE = DIRECT_GUIDE_SIDE / COARSE_SIDE, LAMP_RAYS = 2 };
/* A cell's points are sorted by place: bins that are neighbours are looked at from points that are not. */
enum { POINT_STRIDE = 7 };
static const float OPEN_SKY = 0.6f;
static const uint64_t PILOT_SEED = 0x646972656374u;

typedef struct learning {
    const transport *t;
    direct_guide *guide;
    const lit_point *points;
    const uint32_t *order; /* of the points, by cells */
    direct_bins *bins;     /* [workers][histogram_count]: scratch of each worker */
    atomic_u64 rays;       /* shadow rays cast; order does not matter: relaxed */
} learning;

static float mean(rgb c) { return (c.r + c.g + c.b) * (1.0f / 3.0f); }

static float cosine_at(const lit_point *point, vec3 direction)
{
    bool has_normal = point->normal.x != 0.0f || point->normal.y != 0.0f || point->normal.z != 0.0f;
    return has_normal ? float_max(vec3_dot(point->normal, direction), 0.0f) : 1.0f;
}

/* The light that one sample of a lamp or sky brings, over the density of its numbers. *in_out_possible counts the
 * samples that would bring some if nothing were in their way; NULL: they are not counted. */
static float look_at(const transport *t, eye_worker *worker, const lit_point *point, uint32_t light_index, vec2 u,
                     uint32_t *in_out_possible)
{
    light_sample sample;
    if (!light_sample_from_point(t->s, &t->s->lights[light_index], point->hit.position, u, &sample))
        return 0.0f;
    float brought = cosine_at(point, sample.direction) * mean(sample.radiance) / sample.pdf_solid_angle;
    if (!(brought > 0.0f && isfinite(brought)))
        return 0.0f;
    if (in_out_possible)
        (*in_out_possible)++;
    const scene_ray shadow = surface_ray(&point->hit, point->arrived, sample.direction);
    return brought * mean(direct_light_transmittance(t, worker, shadow, &sample));
}

typedef struct cell_view {
    const learning *l;
    eye_worker worker;
    const uint32_t *points; /* [count], of the list */
    uint32_t count;
    rng random;
} cell_view;

static const lit_point *point_of(const cell_view *c, uint32_t i) { return &c->l->points[c->points[i % c->count]]; }

/* Random numbers in one of side by side parts of the unit square. */
static vec2 numbers_in_part(cell_view *c, uint32_t x, uint32_t y, uint32_t side)
{
    vec2 u = rng_vec2(&c->random);
    return (vec2){float_below_one(((float)x + u.x) / (float)side), float_below_one(((float)y + u.y) / (float)side)};
}

/* Takes the root mean square over each bin and its neighbours, since each bin is seen by one ray, from one of many
 * points. */
static void blur(const float squares[DIRECT_GUIDE_SIDE][DIRECT_GUIDE_SIDE], direct_bins *out)
{
    for (int y = 0; y < DIRECT_GUIDE_SIDE; y++)
        for (int x = 0; x < DIRECT_GUIDE_SIDE; x++) {
            float sum = 0.0f, weights = 0.0f;
            for (int dy = -1; dy <= 1; dy++)
                for (int dx = -1; dx <= 1; dx++) {
                    int at_x = x + dx, at_y = y + dy;
                    if (at_x < 0 || at_y < 0 || at_x >= DIRECT_GUIDE_SIDE || at_y >= DIRECT_GUIDE_SIDE)
                        continue;
                    float weight = (dx == 0 ? 2.0f : 1.0f) * (dy == 0 ? 2.0f : 1.0f);
                    sum += weight * squares[at_y][at_x];
                    weights += weight;
                }
            out->of[y][x] = sqrtf(sum / weights);
        }
}

/* Looks at an infinite light bin by bin, and returns the light that it brings by samples that go by the bins. */
static float look_at_sky(cell_view *c, uint32_t light_index, direct_bins *out)
{
    float squares[DIRECT_GUIDE_SIDE][DIRECT_GUIDE_SIDE];
    uint32_t possible = 0, seen = 0, number = 0;
    for (uint32_t y = 0; y < COARSE_SIDE; y++)
        for (uint32_t x = 0; x < COARSE_SIDE; x++) {
            float square = 0.0f;
            for (uint32_t i = 0; i < COARSE_RAYS; i++) {
                float brought = look_at(c->l->t, &c->worker, point_of(c, number++), light_index,
                                        numbers_in_part(c, x, y, COARSE_SIDE), &possible);
                seen += brought > 0.0f;
                square += brought * brought / COARSE_RAYS;
            }
            for (uint32_t k = 0; k < FINE * FINE; k++)
                squares[FINE * y + k / FINE][FINE * x + k % FINE] = square;
        }
    if ((float)seen < OPEN_SKY * (float)possible)
        for (uint32_t y = 0; y < DIRECT_GUIDE_SIDE; y++)
            for (uint32_t x = 0; x < DIRECT_GUIDE_SIDE; x++) {
                float brought = look_at(c->l->t, &c->worker, point_of(c, number++ * POINT_STRIDE), light_index,
                                        numbers_in_part(c, x, y, DIRECT_GUIDE_SIDE), NULL);
                squares[y][x] = brought * brought;
            }
    blur((const float(*)[DIRECT_GUIDE_SIDE])squares, out);
    double sum = 0.0;
    for (int y = 0; y < DIRECT_GUIDE_SIDE; y++)
        for (int x = 0; x < DIRECT_GUIDE_SIDE; x++)
            sum += (double)out->of[y][x];
    return (float)(sum / (DIRECT_GUIDE_SIDE * DIRECT_GUIDE_SIDE));
}

/* Looks from each point at a light that is everywhere and has no bins. */
static float look_at_light(cell_view *c, uint32_t light_index)
{
    float square = 0.0f;
    for (uint32_t i = 0; i < c->count; i++) {
        float brought = look_at(c->l->t, &c->worker, point_of(c, i), light_index, rng_vec2(&c->random), NULL);
        square += brought * brought / (float)c->count;
    }
    return sqrtf(square);
}

static float look_at_lamps(cell_view *c)
{
    const transport *t = c->l->t;
    float square = 0.0f;
    for (uint32_t i = 0; i < c->count * LAMP_RAYS; i++) {
        const lit_point *point = point_of(c, i);
        float probability;
        uint32_t lamp =
            light_tree_pick(t->s->light_tree, point->hit.position, point->normal, rng_float(&c->random), &probability);
        vec2 u = rng_vec2(&c->random);
        if (!(probability > 0.0f))
            continue;
        float brought = look_at(t, &c->worker, point, lamp, u, NULL) / probability;
        square += brought * brought / (float)(c->count * LAMP_RAYS);
    }
    return sqrtf(square);
}

static void learn_cells(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker_index)
{
    (void)block;
    learning *l = user;
    direct_guide *g = l->guide;
    const scene *s = l->t->s;
    direct_bins *bins = l->bins + (size_t)worker_index * g->histogram_count;
    for (uint64_t cell = begin; cell < end; cell++) {
        cell_view c = {.l = l,
                       .worker = {.index = worker_index},
                       .points = l->order + g->cells[cell].begin,
                       .count = g->cells[cell].count,
                       .random = rng_make(l->t->settings->seed ^ PILOT_SEED, 0, cell)};
        float brought[DIRECT_GUIDE_SHARES_MAX];
        for (uint32_t i = 0; i < g->share_count; i++) {
            uint32_t histogram = g->histogram_of[i];
            if (i == s->everywhere_count)
                brought[i] = look_at_lamps(&c);
            else if (histogram < g->histogram_count)
                brought[i] = look_at_sky(&c, s->everywhere_lights[i], &bins[histogram]);
            else
                brought[i] = look_at_light(&c, s->everywhere_lights[i]);
        }
        direct_guide_fill(g, (uint32_t)cell, l->t->settings->direct_guiding, brought, bins);
        fetch_add_relaxed_u64(&l->rays, c.worker.rays_shadow);
    }
}

/* Makes cells for the points. out_order: [count]. Errors: AG_ERROR_MEMORY. */
static ag_status make_cells(learning *l, uint32_t count, uint32_t *out_order)
{
    vec3 *positions = malloc(((size_t)count + 1) * sizeof *positions),
         *normals = malloc(((size_t)count + 1) * sizeof *normals);
    ag_status status = positions && normals ? AG_OK : AG_ERROR_MEMORY;
    for (uint32_t i = 0; status == AG_OK && i < count; i++) {
        positions[i] = l->points[i].hit.position;
        normals[i] = l->points[i].normal;
    }
    if (status == AG_OK)
        status = direct_guide_create(l->t->s, positions, normals, count, out_order, l->guide);
    free(positions);
    free(normals);
    return status;
}

/* Makes cells for the points, and looks from them. */
static ag_status learn(learning *l, run_context *run, uint32_t count)
{
    uint32_t *order = malloc(((size_t)count + 1) * sizeof *order);
    ag_status status = order ? make_cells(l, count, order) : AG_ERROR_MEMORY;
    if (status == AG_OK && l->guide->cell_count > 0) {
        size_t workers = thread_pool_worker_count(run->pool);
        l->order = order;
        l->bins = malloc((workers * l->guide->histogram_count + 1) * sizeof *l->bins);
        status = l->bins ? parallel_for(run, l->guide->cell_count, 4, learn_cells, l, AG_PHASE_RENDER, 0.0, 0.0)
                         : AG_ERROR_MEMORY;
        free(l->bins);
    }
    free(order);
    return status;
}

ag_status direct_pilot_learn(const transport *t, run_context *run, direct_guide *out_guide, uint64_t *out_rays)
{
    transport unguided = *t;
    learning l = {.t = &unguided, .guide = out_guide};
    lit_point *points;
    uint32_t count;
    unguided.direct_guide = NULL;
    *out_guide = (direct_guide){0};
    *out_rays = 0;
    if (!(t->settings->direct_guiding > 0.0f) || !direct_guide_serves(t->s))
        return AG_OK;
    AG_TRY(eye_pilot_find_lit(t->s, run, t->settings, &points, &count));
    l.points = points;
    ag_status status = learn(&l, run, count);
    free(points);
    *out_rays = load_relaxed_u64(&l.rays);
    if (status != AG_OK)
        direct_guide_reset(out_guide);
    return status;
}
