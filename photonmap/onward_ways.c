/* onward_ways.c: see onward_ways.h. */
#include "onward_ways.h"

#include "math/compare_floats.h"
#include "math/sampling.h"
#include "parallel_for.h"
#include "status.h"

#include <stdlib.h>

/* How much importons decide by a histogram where they are many. */
static const float HISTOGRAM_SHARE = 1.0f;
/* The widest cone's angle is 30 degrees; thinner ones than the least are not precise in floats. */
static const float CONE_SINE_MAX = 0.5f, CONE_SINE_MIN = 1e-3f;
/* The point where lines meet is estimated from PAIRS pairs of them; the best estimate is refined in ROUNDS rounds,
 * without the lines that pass it at more than this many times the median angle, which are then left out of the ball
 * too. */
enum { PAIRS = 32, ROUNDS = 3 };
static const float OUTLIER = 2.0f;
/* A ball that a smaller share of the lines pass is no opening; nor is one whose distance is less than this many times
 * its width, since the histogram represents it as well. */
static const float PASSING_LEAST = 0.6f, FAR = 3.0f;
/* Factor of the radius that the lines give, since they are few, and rounded to 0.7 degrees. */
static const float MARGIN = 1.25f;
/* Parallel lines have no point where they meet: each line draws a little towards its origin, so that there is one. */
static const double ORIGIN_PULL = 1e-6;
/* The least squared sine between two lines that tell where they meet. */
static const float SINE_SQUARED_LEAST = 1e-4f;

/* The way of an importon, which came from behind `at` along the direction. */
typedef struct line {
    vec3 at, direction;
} line;

/* How far from a point a line passes, over how far from its beginning it does; infinite where the line goes away from
 * the point. *out_distance: how far from the point. */
static float passing_angle(const line *l, vec3 point, float *out_distance)
{
    vec3 to = vec3_sub(point, l->at);
    float along = -vec3_dot(to, l->direction);
    *out_distance = vec3_length(vec3_add_scaled(to, l->direction, along));
    return along > 0.0f ? *out_distance / along : INFINITY;
}

static float median_angle(const line *lines, uint32_t count, vec3 point, float *angles)
{
    float distance;
    for (uint32_t i = 0; i < count; i++)
        angles[i] = passing_angle(&lines[i], point, &distance);
    qsort(angles, count, sizeof *angles, compare_floats);
    return angles[count / 2];
}

/* Finds the middle of the shortest way between two lines. Returns false where they are too parallel to tell. */
static bool meeting_point(const line *a, const line *b, vec3 *out_point)
{
    vec3 between = vec3_sub(b->at, a->at);
    float cosine = vec3_dot(a->direction, b->direction), sine_squared = 1.0f - cosine * cosine;
    float on_a = vec3_dot(between, a->direction), on_b = vec3_dot(between, b->direction);
    if (!(sine_squared > SINE_SQUARED_LEAST))
        return false;
    float s = (on_a - cosine * on_b) / sine_squared, t = (cosine * on_a - on_b) / sine_squared;
    vec3 near_a = vec3_add_scaled(a->at, a->direction, s), near_b = vec3_add_scaled(b->at, b->direction, t);
    *out_point = vec3_scale(vec3_add(near_a, near_b), 0.5f);
    return true;
}

/* Solves m x = b by Cramer's rule. Returns false where the determinant is not positive. */
static bool solve(double m[3][3], const double b[3], vec3 *out_x)
{
    double cofactors[3][3], determinant = 0.0;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            cofactors[r][c] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
        }
    for (int c = 0; c < 3; c++)
        determinant += m[0][c] * cofactors[0][c];
    if (!(determinant > 0.0))
        return false;
    float x[3];
    for (int c = 0; c < 3; c++)
        x[c] = (float)((cofactors[0][c] * b[0] + cofactors[1][c] * b[1] + cofactors[2][c] * b[2]) / determinant);
    *out_x = (vec3){x[0], x[1], x[2]};
    return true;
}

/* Returns the point whose squared angles, as seen from the lines' beginnings, from these lines are least in sum: of the
 * lines that pass `around` at no more than that angle. `around` where there is no such point. */
static vec3 nearest_point(const line *lines, uint32_t count, vec3 around, float angle)
{
    double m[3][3] = {{0.0}}, b[3] = {0.0};
    vec3 origin = lines[0].at;
    for (uint32_t i = 0; i < count; i++) {
        float distance;
        if (!(passing_angle(&lines[i], around, &distance) <= angle))
            continue;
        vec3 at = vec3_sub(lines[i].at, origin), to = vec3_sub(around, lines[i].at);
        const double weight = 1.0 / double_max((double)vec3_dot(to, to), 1e-30),
                     x[3] = {(double)at.x, (double)at.y, (double)at.z};
        const double d[3] = {(double)lines[i].direction.x, (double)lines[i].direction.y, (double)lines[i].direction.z};
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) {
                double entry = weight * ((r == c ? 1.0 + ORIGIN_PULL : 0.0) - d[r] * d[c]);
                m[r][c] += entry;
                b[r] += entry * x[c];
            }
    }
    vec3 from_origin;
    return solve(m, b, &from_origin) ? vec3_add(origin, from_origin) : around;
}

/* Where most of the lines meet, and the median of the angles that they pass it at; infinite: nowhere. angles: room for
 * one of each line. */
static float find_meeting(const line *lines, uint32_t count, float *angles, vec3 *out_center)
{
    float least = INFINITY;
    for (uint32_t i = 0; i < PAIRS; i++) {
        const line *a = &lines[i * count / PAIRS], *b = &lines[(i * count / PAIRS + count / 2) % count];
        vec3 guess;
        float angle = meeting_point(a, b, &guess) ? median_angle(lines, count, guess, angles) : INFINITY;
        if (angle < least) {
            least = angle;
            *out_center = guess;
        }
    }
    for (int round = 0; round < ROUNDS && least < INFINITY; round++) {
        vec3 better = nearest_point(lines, count, *out_center, OUTLIER * least);
        float angle = median_angle(lines, count, better, angles);
        if (!(angle < least))
            break;
        least = angle;
        *out_center = better;
    }
    return least;
}

static ways_opening find_opening(const line *lines, uint32_t count, float *room)
{
    ways_opening found = {{0.0f, 0.0f, 0.0f}, 0.0f};
    float least = find_meeting(lines, count, room, &found.center);
    uint32_t passing = 0;
    for (uint32_t i = 0; i < count; i++) {
        float distance;
        if (passing_angle(&lines[i], found.center, &distance) <= OUTLIER * least)
            room[passing++] = distance;
    }
    if (!(least < INFINITY) || (float)passing < PASSING_LEAST * (float)count)
        return found;
    qsort(room, passing, sizeof *room, compare_floats);
    found.radius = MARGIN * OUTLIER * room[passing / 2];
    return found;
}

static void find_opening_of(void *user, uint32_t histogram, const uint32_t *importons, uint32_t count)
{
    onward_ways *ways = user;
    const photon_block *blocks = ways->importons.blocks;
    line lines[INCIDENT_CELL_MAX];
    float distances[INCIDENT_CELL_MAX];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t k = importons[i];
        lines[i] = (line){photon_block_position(blocks, k),
                          arrival_direction(blocks[k / PHOTON_BLOCK_LANES].direction[k % PHOTON_BLOCK_LANES])};
    }
    ways->openings[histogram] = find_opening(lines, count, distances);
}

static ag_status find_openings(run_context *run, onward_ways *ways)
{
    uint32_t count = ways->histograms.histogram_count;
    ways->openings = malloc((count + 1) * sizeof *ways->openings);
    return ways->openings ? incident_light_visit(run, &ways->histograms, find_opening_of, ways) : AG_ERROR_MEMORY;
}

ag_status onward_ways_create(run_context *run, photon *importons, uint32_t count, onward_ways *out_ways)
{
    *out_ways = (onward_ways){0};
    if (count == 0) {
        free(importons);
        return AG_OK;
    }
    onward_ways made = {0};
    ag_status status = photon_tree_build(run, importons, count, 0.0, 0.0, &made.importons);
    if (status != AG_OK) {
        free(importons);
        return status;
    }
    status = incident_light_create(run, &made.importons, HISTOGRAM_SHARE, &made.histograms);
    if (status == AG_OK)
        status = find_openings(run, &made);
    if (status == AG_OK)
        *out_ways = made;
    else
        onward_ways_reset(&made);
    return status;
}

void onward_ways_reset(onward_ways *ways)
{
    free(ways->openings);
    incident_light_reset(&ways->histograms);
    free(ways->importons.blocks);
    photon_tree_reset(&ways->importons);
    *ways = (onward_ways){0};
}

/* Cones around the ball, and around balls that double from it on, as far as CONE_SINE_MAX: each has half the share of
 * the one within, so that a way that misses the ball by little is not rare by much. */
static void set_cones(vec3 to, float distance, float radius, onward_guide *out)
{
    float share = 1.0f, sum = 0.0f;
    out->towards = frame_from_z(vec3_scale(to, 1.0f / distance));
    float sine = float_max(radius / distance, CONE_SINE_MIN);
    for (; out->cone_count < ONWARD_CONES_MAX && sine <= CONE_SINE_MAX; sine *= 2.0f) {
        uint32_t i = out->cone_count++;
        out->sine_squared[i] = sine * sine;
        out->one_minus_cos[i] = sine * sine / (1.0f + sqrtf(1.0f - sine * sine));
        out->share[i] = share;
        sum += share;
        share *= 0.5f;
    }
    for (uint32_t i = 0; i < out->cone_count; i++)
        out->share[i] /= sum;
}

bool onward_ways_find(const onward_ways *ways, vec3 position, vec3 normal, onward_guide *out_guide)
{
    if (!incident_light_find(&ways->histograms, position, normal, &out_guide->by_histogram))
        return false;
    const ways_opening *opening = &ways->openings[out_guide->by_histogram.histogram - ways->histograms.histograms];
    vec3 to = vec3_sub(opening->center, position);
    float distance = vec3_length(to);
    out_guide->cone_count = 0;
    if (opening->radius > 0.0f && distance > FAR * opening->radius)
        set_cones(to, distance, opening->radius, out_guide);
    return true;
}

vec3 onward_guide_sample(const onward_guide *guide, vec2 u)
{
    if (guide->cone_count == 0) {
        incident_guide_warp_one(&guide->by_histogram, &u);
        return vec3_normalize(frame_to_world(&guide->by_histogram.around, sample_cosine_hemisphere(u)));
    }
    uint32_t i = 0;
    while (i + 1 < guide->cone_count && u.x >= guide->share[i])
        u.x -= guide->share[i++];
    u.x = float_below_one(u.x / guide->share[i]);
    return vec3_normalize(frame_to_world(&guide->towards, sample_uniform_cone(u, guide->one_minus_cos[i])));
}

float onward_guide_density(const onward_guide *guide, vec3 direction)
{
    if (guide->cone_count == 0)
        return incident_guide_density(&guide->by_histogram, direction);
    vec3 aside = vec3_cross(direction, guide->towards.z); /* precise where cones are thin */
    float density = 0.0f, sine_squared = vec3_dot(aside, aside);
    for (uint32_t i = 0; i < guide->cone_count; i++)
        if (sine_squared <= guide->sine_squared[i])
            density += guide->share[i] / (2.0f * AG_PI * guide->one_minus_cos[i]);
    return vec3_dot(direction, guide->towards.z) > 0.0f ? density : 0.0f;
}

float onward_guide_gain(const onward_guide *guide)
{
    if (guide->cone_count == 0)
        return 1.0f;
    /* a cone may be mostly below the surface: the part above has about its own sine as cosine */
    float cosine =
        float_max(vec3_dot(guide->towards.z, guide->by_histogram.around.z), 0.5f * sqrtf(guide->sine_squared[0]));
    return float_max(onward_guide_density(guide, guide->towards.z) * AG_PI / cosine, 1.0f);
}
