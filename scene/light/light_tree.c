/* light_tree.c: see light_tree.h. Positions are in units of the scene's radius from its middle, and intensities parts
 * of the whole: nothing overflows. */
#include "light/light_tree.h"

#include <stdlib.h>

/* Slack for rounding: a lamp this little beyond a horizon still counts. */
static const float SLACK = 1e-3f;
/* Of the cosine to the point's normal and of the lamp's own: what may count for more by a shading normal, or where the
 * ball hides how the lamp lies. */
static const float COSINE_LEAST = 0.02f;
/* Nearer than this to a lamp, in scene radii, all distances count alike. */
static const float NEAREST = 1e-4f;
/* Least squared distance to a ball's contents, as a share of its squared radius. A panel's area over pi is half of
 * that, where its irradiance ends; in a group some lamp may be nearer: measured, 0.1 to 0.2 give the least noise. */
static const float LAMP_NEAR = 0.64f, GROUP_NEAR = 0.15f;
enum { BIN_COUNT = 16, ALL_AXES_MAX = 256 };

/* Children by columns, so that all eight are weighed at once; those that are not there have no intensity. */
typedef struct node {
    float center[3][LIGHT_TREE_WIDTH];
    float radius2[LIGHT_TREE_WIDTH];
    float nearest2[LIGHT_TREE_WIDTH]; /* below this all squared distances count alike */
    float axis[3][LIGHT_TREE_WIDTH];
    float cos_normals[LIGHT_TREE_WIDTH], sin_normals[LIGHT_TREE_WIDTH];
    float cos_emission[LIGHT_TREE_WIDTH];
    float least_cos[LIGHT_TREE_WIDTH];
    float behind[LIGHT_TREE_WIDTH]; /* -1: the same along -axis; else 1 */
    float intensity[LIGHT_TREE_WIDTH];
    uint32_t child[LIGHT_TREE_WIDTH]; /* a node, or where is_lamp a light of the scene */
    bool is_lamp[LIGHT_TREE_WIDTH];
    uint32_t count;
    uint32_t parent, slot; /* where it is a child; parent LIGHT_TREE_NONE: the root */
} node;

/* The node that has a lamp as a child, and which child. */
typedef struct parent_slot {
    uint32_t node, slot;
} parent_slot;

struct light_tree {
    vec3 center;
    float inverse_radius;
    node *nodes;
    uint32_t node_count;
    parent_slot *parents; /* [light_count of the scene]; LIGHT_TREE_NONE: the light is not in the tree */
};

/* --- weighing --- */

typedef struct query {
    vec3 point, normal;
    float horizon,
        least_received; /* cosines to the normal: below which nothing is received; that others are raised to */
} query;

static query make_query(const light_tree *t, vec3 point, vec3 normal)
{
    bool has_normal = !vec3_is_zero(normal);
    return (query){vec3_scale(vec3_sub(point, t->center), t->inverse_radius), normal, has_normal ? -SLACK : -2.0f,
                   has_normal ? COSINE_LEAST : 1.0f};
}

/* The sine of an angle from 0 to half a turn. */
static inline float sine_of(float cosine) { return sqrtf(float_max(1.0f - cosine * cosine, 0.0f)); }

/* The cosine of the angle a - b, or of 0 where b is larger; and its sine. */
static inline float cos_beyond(float sin_a, float cos_a, float sin_b, float cos_b)
{
    float difference = cos_a * cos_b + sin_a * sin_b;
    return cos_a > cos_b ? 1.0f : difference;
}

static inline float sin_beyond(float sin_a, float cos_a, float sin_b, float cos_b)
{
    float difference = float_max(sin_a * cos_b - cos_a * sin_b, 0.0f);
    return cos_a > cos_b ? 0.0f : difference;
}

/* About the irradiance that child k may bring to the point; 0 only where it brings none. No branches, so that compilers
 * weigh several children at once. */
static inline float weigh(const node *n, uint32_t k, const query *q)
{
    float x = q->point.x - n->center[0][k], y = q->point.y - n->center[1][k], z = q->point.z - n->center[2][k];
    float d2 = x * x + y * y + z * z;
    float inverse = 1.0f / sqrtf(float_max(d2, 1e-30f));
    /* the half angle of the ball; inside of it all directions */
    float sin2_ball = n->radius2[k] * inverse * inverse;
    float sin_ball = sqrtf(sin2_ball), cos_ball = sqrtf(float_max(1.0f - sin2_ball, 0.0f));
    sin_ball = sin2_ball < 1.0f ? sin_ball : 0.0f;
    cos_ball = sin2_ball < 1.0f ? cos_ball : -1.0f;
    /* from the axis, less the spread of the normals, less the ball */
    float cos_axis = (x * n->axis[0][k] + y * n->axis[1][k] + z * n->axis[2][k]) * inverse;
    cos_axis = float_max(cos_axis, n->behind[k] * cos_axis);
    float sin_axis = sine_of(cos_axis);
    float c = cos_beyond(sin_axis, cos_axis, n->sin_normals[k], n->cos_normals[k]);
    float s = sin_beyond(sin_axis, cos_axis, n->sin_normals[k], n->cos_normals[k]);
    float cos_lamp = cos_beyond(s, c, sin_ball, cos_ball);
    float brightness = float_max(float_max(cos_lamp, n->least_cos[k]), COSINE_LEAST);
    brightness = cos_lamp < n->cos_emission[k] ? 0.0f : brightness;
    /* from the point's normal, less the ball */
    float cos_point = -(x * q->normal.x + y * q->normal.y + z * q->normal.z) * inverse;
    float best = cos_beyond(sine_of(cos_point), cos_point, sin_ball, cos_ball);
    float received = float_max(best, q->least_received);
    received = best < q->horizon ? 0.0f : received;
    return n->intensity[k] * brightness * received / float_max(d2, n->nearest2[k]);
}

static float weigh_all(const node *n, const query *q, float out_weights[LIGHT_TREE_WIDTH])
{
    uint32_t count = (n->count + 3u) & ~3u; /* in fours */
    for (uint32_t k = 0; k < count; k++)
        out_weights[k] = weigh(n, k, q);
    float sum = 0.0f;
    for (uint32_t k = 0; k < n->count; k++)
        sum += out_weights[k];
    return sum;
}

bool light_tree_reaches(const light_tree *t, vec3 point, vec3 normal)
{
    query q = make_query(t, point, normal);
    float weights[LIGHT_TREE_WIDTH];
    return weigh_all(&t->nodes[0], &q, weights) > 0.0f;
}

uint32_t light_tree_pick(const light_tree *t, vec3 point, vec3 normal, float u, float *out_probability)
{
    query q = make_query(t, point, normal);
    float probability = 1.0f;
    uint32_t at = 0;
    *out_probability = 0.0f;
    for (;;) {
        const node *n = &t->nodes[at];
        float weights[LIGHT_TREE_WIDTH], sum = weigh_all(n, &q, weights);
        if (!(sum > 0.0f))
            return LIGHT_TREE_NONE; /* the node's bounds are wider than those of all in it */
        float wanted = u * sum, before = 0.0f;
        uint32_t picked = 0;
        for (uint32_t k = 0; k < n->count; k++) {
            if (!(weights[k] > 0.0f))
                continue;
            picked = k;
            if (wanted < before + weights[k])
                break;
            before += weights[k];
        }
        u = float_below_one(float_max((wanted - before) / weights[picked], 0.0f));
        probability *= weights[picked] / sum;
        at = n->child[picked];
        if (n->is_lamp[picked]) {
            *out_probability = probability;
            return at;
        }
    }
}

float light_tree_probability(const light_tree *t, uint32_t light_index, vec3 point, vec3 normal)
{
    query q = make_query(t, point, normal);
    parent_slot at = t->parents[light_index];
    float probability = 1.0f;
    while (at.node != LIGHT_TREE_NONE) {
        const node *n = &t->nodes[at.node];
        float weights[LIGHT_TREE_WIDTH], sum = weigh_all(n, &q, weights);
        if (!(weights[at.slot] > 0.0f))
            return 0.0f;
        probability *= weights[at.slot] / sum;
        at = (parent_slot){n->parent, n->slot};
    }
    return probability;
}

/* --- building --- */

typedef struct lamp {
    light_bounds bounds;
    vec3 low, high;
    uint32_t index;
} lamp;

/* Lamps [begin, end). */
typedef struct group {
    uint32_t begin, end;
    double cost; /* of keeping them together */
} group;

static float cos_of_sum(float cos_a, float cos_b)
{
    if (cos_a <= -cos_b) /* the sum is half a turn or more */
        return -1.0f;
    return float_max(cos_a * cos_b - sine_of(cos_a) * sine_of(cos_b), -1.0f);
}

/* Returns the bounds of all lamps together, and writes their box. */
static light_bounds bounds_of(const lamp *lamps, uint32_t begin, uint32_t end, vec3 *out_low, vec3 *out_high)
{
    light_bounds all = lamps[begin].bounds;
    vec3 low = lamps[begin].low, high = lamps[begin].high;
    if (end - begin > 1) {
        vec3 axis = {0.0f, 0.0f, 0.0f};
        all.intensity = 0.0f;
        for (uint32_t i = begin; i < end; i++) {
            const light_bounds *b = &lamps[i].bounds;
            low = vec3_min(low, lamps[i].low);
            high = vec3_max(high, lamps[i].high);
            /* two-sided ones all to one side, so that they do not cancel */
            vec3 a = b->two_sided ? vec3_face_forward(b->axis, axis) : b->axis;
            axis = vec3_add_scaled(axis, a, b->intensity);
            all.intensity += b->intensity;
            all.cos_emission = float_min(all.cos_emission, b->cos_emission);
            all.least_cos = float_max(all.least_cos, b->least_cos);
            all.two_sided = all.two_sided || b->two_sided;
        }
        float length = vec3_length(axis);
        all.cos_normals = -1.0f;
        if (length > SLACK * all.intensity) {
            all.axis = vec3_scale(axis, 1.0f / length);
            float least = 1.0f;
            for (uint32_t i = begin; i < end; i++) {
                const light_bounds *b = &lamps[i].bounds;
                float cosine = vec3_dot(b->axis, all.axis);
                cosine = b->two_sided ? fabsf(cosine) : cosine;
                least = float_min(least, cos_of_sum(float_clamp(cosine, -1.0f, 1.0f), b->cos_normals));
            }
            all.cos_normals = float_max(least - SLACK, -1.0f);
        }
        all.center = vec3_add_scaled(low, vec3_sub(high, low), 0.5f);
        all.radius = 0.5f * vec3_length(vec3_sub(high, low)) * 1.00001f;
    }
    *out_low = low;
    *out_high = high;
    return all;
}

/* Conty Estevez and Kulla, 4.4: surface area, times the solid angle that is lit, times intensity; here the cone of
 * normals and light is measured by its height, and a margin keeps points from costing nothing. */
static double cost_of(const lamp *lamps, uint32_t begin, uint32_t end)
{
    vec3 low, high;
    light_bounds b = bounds_of(lamps, begin, end, &low, &high);
    vec3 d = vec3_sub(high, low);
    double margin = 1e-3, x = d.x + margin, y = d.y + margin, z = d.z + margin;
    double lit = (b.two_sided ? 2.0 : 1.0) * (1.1 - (double)cos_of_sum(b.cos_normals, b.cos_emission));
    return (x * y + y * z + z * x) * double_min(lit, 2.1) * (double)b.intensity;
}

static float along(const lamp *l, int axis)
{
    return axis == 0 ? l->bounds.center.x : axis == 1 ? l->bounds.center.y : l->bounds.center.z;
}

static int sort_axis_compare(const lamp *a, const lamp *b, int axis)
{
    float x = along(a, axis), y = along(b, axis);
    if (x != y)
        return x < y ? -1 : 1;
    return a->index < b->index ? -1 : 1;
}

static int compare_x(const void *a, const void *b) { return sort_axis_compare(a, b, 0); }
static int compare_y(const void *a, const void *b) { return sort_axis_compare(a, b, 1); }
static int compare_z(const void *a, const void *b) { return sort_axis_compare(a, b, 2); }

typedef int compare_fn(const void *, const void *);
static compare_fn *const COMPARE[3] = {compare_x, compare_y, compare_z};

/* The axis along which the lamps are the widest apart. */
static int longest_axis(const lamp *lamps, group g)
{
    vec3 low = lamps[g.begin].bounds.center, high = low;
    for (uint32_t i = g.begin; i < g.end; i++) {
        low = vec3_min(low, lamps[i].bounds.center);
        high = vec3_max(high, lamps[i].bounds.center);
    }
    vec3 d = vec3_sub(high, low);
    return d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
}

/* Sorts the group and gives the index where it falls in two at the least cost. Of large ones only the longest axis is
 * tried. */
static uint32_t split(lamp *lamps, group g)
{
    double best = INFINITY;
    uint32_t best_at = g.begin + (g.end - g.begin) / 2, count = g.end - g.begin;
    int longest = longest_axis(lamps, g), best_axis = longest;
    for (int axis = 0; axis < 3; axis++) {
        if (count > ALL_AXES_MAX && axis != longest)
            continue;
        qsort(lamps + g.begin, count, sizeof *lamps, COMPARE[axis]);
        uint32_t step = count <= BIN_COUNT ? 1 : count / BIN_COUNT;
        for (uint32_t at = g.begin + step; at < g.end; at += step) {
            double cost = cost_of(lamps, g.begin, at) + cost_of(lamps, at, g.end);
            if (cost < best) {
                best = cost;
                best_axis = axis;
                best_at = at;
            }
        }
    }
    qsort(lamps + g.begin, count, sizeof *lamps, COMPARE[best_axis]);
    return best_at;
}

static void set_child(node *n, uint32_t k, bool is_lamp, const light_bounds *b)
{
    float near2 = (is_lamp ? LAMP_NEAR : GROUP_NEAR) * b->radius * b->radius;
    n->nearest2[k] = float_max(near2, NEAREST * NEAREST);
    n->center[0][k] = b->center.x, n->center[1][k] = b->center.y, n->center[2][k] = b->center.z;
    n->radius2[k] = float_max(b->radius * b->radius, NEAREST * NEAREST); /* nearer, directions are but rounding */
    n->axis[0][k] = b->axis.x, n->axis[1][k] = b->axis.y, n->axis[2][k] = b->axis.z;
    n->cos_normals[k] = b->cos_normals;
    n->sin_normals[k] = sine_of(b->cos_normals);
    n->cos_emission[k] = b->cos_emission - SLACK;
    n->least_cos[k] = b->least_cos;
    n->behind[k] = b->two_sided ? -1.0f : 1.0f;
    n->intensity[k] = b->intensity;
}

/* Fills a node with up to eight groups, by splitting the costliest again and again. */
static uint32_t divide(lamp *lamps, group whole, group out_groups[LIGHT_TREE_WIDTH])
{
    uint32_t count = 1;
    out_groups[0] = whole;
    while (count < LIGHT_TREE_WIDTH) {
        uint32_t costliest = LIGHT_TREE_WIDTH;
        for (uint32_t i = 0; i < count; i++)
            if (out_groups[i].end - out_groups[i].begin > 1 &&
                (costliest == LIGHT_TREE_WIDTH || out_groups[i].cost > out_groups[costliest].cost))
                costliest = i;
        if (costliest == LIGHT_TREE_WIDTH)
            break;
        group *g = &out_groups[costliest];
        uint32_t middle = split(lamps, *g);
        out_groups[count++] = (group){middle, g->end, cost_of(lamps, middle, g->end)};
        *g = (group){g->begin, middle, cost_of(lamps, g->begin, middle)};
    }
    return count;
}

/* Nodes are filled in the order in which they were made: groups wait in a queue, one for each node. */
static void build(light_tree *t, lamp *lamps, uint32_t count, group *queue)
{
    queue[0] = (group){0, count, 0.0};
    t->nodes[0].parent = LIGHT_TREE_NONE;
    t->node_count = 1;
    for (uint32_t at = 0; at < t->node_count; at++) {
        node *n = &t->nodes[at];
        group groups[LIGHT_TREE_WIDTH];
        n->count = divide(lamps, queue[at], groups);
        for (uint32_t k = n->count; k < LIGHT_TREE_WIDTH; k++)
            n->nearest2[k] = 1.0f; /* no intensity over no distance would be no number */
        for (uint32_t k = 0; k < n->count; k++) {
            vec3 low, high;
            light_bounds b = bounds_of(lamps, groups[k].begin, groups[k].end, &low, &high);
            n->is_lamp[k] = groups[k].end - groups[k].begin == 1;
            set_child(n, k, n->is_lamp[k], &b);
            if (n->is_lamp[k]) {
                n->child[k] = lamps[groups[k].begin].index;
                t->parents[n->child[k]] = (parent_slot){at, k};
                continue;
            }
            n->child[k] = t->node_count;
            t->nodes[t->node_count].parent = at;
            t->nodes[t->node_count].slot = k;
            queue[t->node_count++] = groups[k];
        }
    }
}

/* Finds the lamps' bounds and power in the tree's units. */
static void find_lamps(const scene *s, const light_tree *t, const uint32_t *lights, uint32_t count, lamp *out_lamps)
{
    double total = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        light_find_bounds(s, &s->lights[lights[i]], &out_lamps[i].bounds);
        total += (double)out_lamps[i].bounds.intensity;
    }
    for (uint32_t i = 0; i < count; i++) {
        light_bounds *b = &out_lamps[i].bounds;
        b->intensity = float_max((float)((double)b->intensity / total), 1e-20f);
        b->center = vec3_scale(vec3_sub(b->center, t->center), t->inverse_radius);
        b->radius = b->radius * t->inverse_radius * 1.0001f;
        vec3 reach = {b->radius, b->radius, b->radius};
        out_lamps[i].low = vec3_sub(b->center, reach);
        out_lamps[i].high = vec3_add(b->center, reach);
        out_lamps[i].index = lights[i];
    }
}

ag_status light_tree_create(const scene *s, const uint32_t *lights, uint32_t count, light_tree **out_tree)
{
    light_tree *t = calloc(1, sizeof *t);
    lamp *lamps = malloc(count * sizeof *lamps);
    group *queue = malloc(count * sizeof *queue);
    *out_tree = NULL;
    if (t) {
        *t = (light_tree){.center = s->bounding_center, .inverse_radius = 1.0f / s->bounding_radius};
        t->nodes =
            calloc(count, sizeof *t->nodes); /* fewer than lamps, for each has two children or more, or is the root */
        t->parents = malloc(s->light_count * sizeof *t->parents);
    }
    ag_status status = t && lamps && queue && t->nodes && t->parents ? AG_OK : AG_ERROR_MEMORY;
    if (status == AG_OK) {
        for (uint32_t i = 0; i < s->light_count; i++)
            t->parents[i] = (parent_slot){LIGHT_TREE_NONE, 0};
        find_lamps(s, t, lights, count, lamps);
        build(t, lamps, count, queue);
        node *fewer = realloc(t->nodes, t->node_count * sizeof *t->nodes);
        t->nodes = fewer ? fewer : t->nodes;
        *out_tree = t;
    } else {
        light_tree_destroy(t);
    }
    free(lamps);
    free(queue);
    return status;
}

void light_tree_destroy(light_tree *t)
{
    if (!t)
        return;
    free(t->nodes);
    free(t->parents);
    free(t);
}
