/* emission_guide.c: see emission_guide.h. */
#include "emission_guide.h"

#include <stdlib.h>
#include <string.h>

/* A node is divided while at least USEFUL_LEAST of its trials have contributed; each number is halved at most
 * HALVINGS_MAX times. */
enum { USEFUL_LEAST = 16, HALVINGS_MAX = 14, DEPTH_MAX = 56, QUARTERS = 4 };
/* Sums of roots that differ by less, relatively, do not tell which axis is better. */
static const double ALIKE = 0.03;
/* The density of a leaf's parent counts as this many trials of the leaf: a leaf in which a few trials contributed
 * nothing need not be dark. */
static const double PRIOR_TRIALS = 1.0;

struct emission_guide_node {
    uint32_t low;    /* the child of the lower half, the other one follows; 0: a leaf */
    uint32_t axis;   /* that is halved; EMISSION_DIMENSIONS: a leaf */
    float low_share; /* of the mass, that the lower half has */
    float density;   /* of a leaf, by the tree alone */
    double mass;     /* while the tree grows */
};

typedef struct box {
    float low[EMISSION_DIMENSIONS], extent[EMISSION_DIMENSIONS];
} box;

static box whole_cube(void)
{
    box b;
    for (int a = 0; a < EMISSION_DIMENSIONS; a++)
        b.low[a] = 0.0f, b.extent[a] = 1.0f;
    return b;
}

static void halve(box *b, uint32_t axis, bool is_high)
{
    b->extent[axis] *= 0.5f;
    if (is_high)
        b->low[axis] += b->extent[axis];
}

typedef struct builder {
    emission_guide_node *nodes;
    uint32_t count, capacity;
    emission_trial *trials;
    double total;   /* of all trials */
    double squares; /* expected of a mean over the cube: by power alone */
} builder;

/* A trial's part in the mean of the squares over all starts. */
static double square_of(const emission_trial *t) { return (double)t->value * t->value / t->density; }

/* Sums over the useful trials of a node, by quarters along each axis, and by sixteenths along each pair of axes. */
typedef struct quarters {
    double one[EMISSION_DIMENSIONS][QUARTERS];
    double two[EMISSION_DIMENSIONS][EMISSION_DIMENSIONS][QUARTERS * QUARTERS]; /* of axes a < b */
} quarters;

static void sum_quarters(const builder *b, uint32_t begin, uint32_t end, const box *where, quarters *out)
{
    memset(out, 0, sizeof *out);
    for (uint32_t i = begin; i < end; i++) {
        const emission_trial *t = &b->trials[i];
        int at[EMISSION_DIMENSIONS];
        if (!(t->value > 0.0f))
            continue;
        double square = square_of(t);
        for (int a = 0; a < EMISSION_DIMENSIONS; a++) {
            int quarter = (int)((t->start.u[a] - where->low[a]) / where->extent[a] * QUARTERS);
            at[a] = quarter < QUARTERS ? quarter : QUARTERS - 1;
            out->one[a][at[a]] += square;
            for (int k = 0; k < a; k++)
                out->two[k][a][at[k] * QUARTERS + at[a]] += square;
        }
    }
}

static double sum_of_roots(const double *values, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++)
        sum += sqrt(values[i]);
    return sum;
}

/* Picks the axis to halve. The least sum of roots is the least variance, if each part has a density of its own; it is
 * looked for among the sixteenths of pairs of axes, since useful trials may lie along a diagonal, which no axis alone
 * shows. Returns false where no axis can be halved. */
static bool pick_axis(const builder *b, uint32_t begin, uint32_t end, const box *where, uint32_t *out_axis)
{
    quarters q;
    double least = INFINITY, one[EMISSION_DIMENSIONS];
    sum_quarters(b, begin, end, where, &q);
    for (int a = 0; a < EMISSION_DIMENSIONS; a++)
        one[a] = where->extent[a] > ldexpf(1.0f, -HALVINGS_MAX) ? sum_of_roots(q.one[a], QUARTERS) : INFINITY;
    for (uint32_t a = 0; a < EMISSION_DIMENSIONS; a++)
        for (uint32_t k = a + 1; k < EMISSION_DIMENSIONS; k++) {
            double roots = sum_of_roots(q.two[a][k], QUARTERS * QUARTERS);
            if (roots >= least || (one[a] == INFINITY && one[k] == INFINITY))
                continue;
            least = roots;
            bool is_alike = fabs(one[a] - one[k]) < ALIKE * one[a];
            *out_axis = (is_alike ? where->extent[a] >= where->extent[k] : one[a] < one[k]) ? a : k;
        }
    return least < INFINITY;
}

static uint32_t partition(builder *b, uint32_t begin, uint32_t end, uint32_t axis, float middle)
{
    uint32_t at = begin;
    for (uint32_t i = begin; i < end; i++)
        if (b->trials[i].start.u[axis] < middle) {
            emission_trial t = b->trials[at];
            b->trials[at++] = b->trials[i];
            b->trials[i] = t;
        }
    return at;
}

static bool add_children(builder *b, uint32_t *out_low)
{
    if (b->count + 2 > b->capacity) {
        uint32_t capacity = 2 * b->capacity;
        emission_guide_node *larger = realloc(b->nodes, capacity * sizeof *larger);
        if (!larger)
            return false;
        b->nodes = larger;
        b->capacity = capacity;
    }
    *out_low = b->count;
    b->count += 2;
    return true;
}

/* above: mean square that the parent tells. */
static bool grow(builder *b, uint32_t node, uint32_t begin, uint32_t end, box where, int depth, double above)
{
    double squares = 0.0, volume = ldexp(1.0, -depth), count = (double)(end - begin);
    uint32_t useful = 0, axis, low;
    for (uint32_t i = begin; i < end; i++) {
        squares += square_of(&b->trials[i]);
        useful += b->trials[i].value > 0.0f;
    }
    double mean = squares / (b->total * volume);
    if (depth > 0)
        mean = (count * mean + PRIOR_TRIALS * above) / (count + PRIOR_TRIALS);
    if (useful < USEFUL_LEAST || depth == DEPTH_MAX || !pick_axis(b, begin, end, &where, &axis)) {
        b->nodes[node] = (emission_guide_node){.axis = EMISSION_DIMENSIONS, .mass = volume * sqrt(mean)};
        b->nodes[node].density = (float)sqrt(mean);
        return true;
    }
    box high = where;
    halve(&where, axis, false);
    halve(&high, axis, true);
    uint32_t middle = partition(b, begin, end, axis, high.low[axis]);
    if (!add_children(b, &low) || !grow(b, low, begin, middle, where, depth + 1, mean) ||
        !grow(b, low + 1, middle, end, high, depth + 1, mean))
        return false;
    double low_mass = b->nodes[low].mass, mass = low_mass + b->nodes[low + 1].mass;
    b->nodes[node] = (emission_guide_node){.low = low, .axis = axis, .mass = mass};
    b->nodes[node].low_share = mass > 0.0 ? (float)(low_mass / mass) : 0.5f;
    return true;
}

static const emission_guide_node *find_leaf(const emission_guide *guide, const emission_start *start)
{
    box where = whole_cube();
    const emission_guide_node *node = guide->nodes;
    while (node->axis < EMISSION_DIMENSIONS) {
        bool is_high = start->u[node->axis] >= where.low[node->axis] + 0.5f * where.extent[node->axis];
        halve(&where, node->axis, is_high);
        node = &guide->nodes[node->low + is_high];
    }
    return node;
}

ag_status emission_guide_create(emission_trial *trials, uint32_t count, float share, const emission_guide *other,
                                emission_guide *out_guide)
{
    *out_guide = (emission_guide){.share = 0.0f, .gain = 1.0f};
    double squares = 0.0;
    for (uint32_t i = 0; i < count; i++)
        squares += square_of(&trials[i]);
    if (!(squares > 0.0))
        return AG_OK;
    builder b = {.capacity = 1024, .count = 1, .trials = trials, .total = (double)count};
    b.nodes = malloc(b.capacity * sizeof *b.nodes);
    if (!b.nodes || !grow(&b, 0, 0, count, whole_cube(), 0, 0.0)) {
        free(b.nodes);
        return AG_ERROR_MEMORY;
    }
    emission_guide made = {.nodes = b.nodes, .node_count = b.count, .share = share, .other = other};
    double mass = b.nodes[0].mass, guided = 0.0;
    for (uint32_t i = 0; i < b.count; i++)
        b.nodes[i].density = b.nodes[i].axis == EMISSION_DIMENSIONS ? (float)(b.nodes[i].density / mass) : 0.0f;
    for (uint32_t i = 0; i < count; i++)
        guided += square_of(&trials[i]) / (double)emission_guide_density(&made, &trials[i].start);
    made.gain = (float)(squares / guided);
    *out_guide = made;
    return AG_OK;
}

void emission_guide_reset(emission_guide *guide)
{
    free(guide->nodes);
    *guide = (emission_guide){0};
}

float emission_guide_density(const emission_guide *guide, const emission_start *start)
{
    if (!guide->nodes)
        return 1.0f;
    float by_trees = find_leaf(guide, start)->density;
    if (guide->other)
        by_trees = 0.5f * (by_trees + find_leaf(guide->other, start)->density);
    return 1.0f - guide->share + guide->share * by_trees;
}

emission_start emission_start_draw(rng *random)
{
    emission_start start;
    start.u[0] = rng_float(random);
    for (int a = 1; a < EMISSION_DIMENSIONS - 1; a += 2) {
        vec2 pair = rng_vec2(random);
        start.u[a] = pair.x;
        start.u[a + 1] = pair.y;
    }
    start.u[EMISSION_DIMENSIONS - 1] = rng_float(random);
    return start;
}

/* A leaf picked by its mass: the number is stretched anew at each node. */
static void pick_leaf(const emission_guide *guide, double u, box *out_where)
{
    const emission_guide_node *node = guide->nodes;
    *out_where = whole_cube();
    while (node->axis < EMISSION_DIMENSIONS) {
        double low_share = (double)node->low_share;
        bool is_high = u >= low_share;
        u = is_high ? (u - low_share) / (1.0 - low_share) : u / low_share;
        halve(out_where, node->axis, is_high);
        node = &guide->nodes[node->low + is_high];
    }
}

emission_start emission_guide_sample(const emission_guide *guide, rng *random, float *out_density)
{
    if (!guide->nodes) {
        *out_density = 1.0f;
        return emission_start_draw(random);
    }
    float u_guided = rng_float(random);
    double u = (double)(rng_next(random) >> 11) * 0x1p-53;
    emission_start start = emission_start_draw(random);
    if (u_guided < guide->share) {
        box where;
        bool is_other = guide->other && u_guided < 0.5f * guide->share;
        pick_leaf(is_other ? guide->other : guide, u, &where);
        for (int a = 0; a < EMISSION_DIMENSIONS; a++) {
            float end = where.low[a] + where.extent[a];
            start.u[a] = float_min(where.low[a] + where.extent[a] * start.u[a], end * (1.0f - 0x1p-24f));
        }
    }
    *out_density = emission_guide_density(guide, &start);
    return start;
}

emission_numbers emission_start_numbers(const emission_start *start, const light_target *focus)
{
    return (emission_numbers){{start->u[1], start->u[2]}, {start->u[3], start->u[4]}, start->u[5], focus};
}

emission_start emission_start_of(float u_light, const emission_numbers *numbers)
{
    const emission_numbers *n = numbers;
    return (emission_start){{u_light, n->direction.x, n->direction.y, n->position.x, n->position.y, n->part}};
}
