/* photon_tree.c: see photon_tree.h.
 * Building: the upper levels node by node with all threads at once, then the subtrees each by one.
 * Searching: depth first, near side first; a stack entry carries its box's offset from the query along each axis.
 * Threads: build by the run's workers; searches read only. */
#include "photon_tree.h"

#include "parallel_for.h"

#include <assert.h>
#include <stdlib.h>

enum { DEPTH_MAX = 32, PARALLEL_LEVELS = 9 };
/* How often long loops look whether to stop: every 65,536 photons, some tenths of a millisecond. */
enum { CANCEL_MASK = 0xffff };

/* --- build --- */

typedef struct range {
    uint32_t low, high; /* photons */
} range;

/* The photons below the node at that place of its level: those of the blocks that are its leaves, as far as there are
 * any. */
static range node_range(const photon_tree *tree, uint32_t level, uint64_t place)
{
    uint64_t each = (uint64_t)PHOTON_BLOCK_LANES << (tree->depth - level);
    uint64_t low = place * each, high = low + each, count = tree->count;
    return (range){(uint32_t)(low < count ? low : count), (uint32_t)(high < count ? high : count)};
}

static void swap_photons(photon *a, photon *b)
{
    /* the slots are all empty while the tree is built; copied like the rest */
    unsigned char hold[sizeof(photon)];
    __builtin_memcpy(hold, a, sizeof hold);
    __builtin_memcpy(a, b, sizeof hold);
    __builtin_memcpy(b, hold, sizeof hold);
}

/* Hoare's quickselect (1961): afterwards nothing before `middle` is greater than it along the axis, and nothing after
 * is less. Equal keys are swapped too, which keeps the halves even when all photons coincide. */
static void select_middle(const run_context *run, photon *p, range r, int64_t middle, uint32_t axis)
{
    int64_t low = r.low, high = (int64_t)r.high - 1;
    uint64_t pick = (uint64_t)r.low << 32 | r.high;
    while (low < high) {
        /* the median of three places that depend on the range alone */
        uint64_t span = (uint64_t)(high - low + 1);
        float k[3];
        for (int i = 0; i < 3; i++) {
            pick = hash_mix64(pick + 0x9e3779b97f4a7c15u);
            k[i] = p[low + (int64_t)((pick >> 32) * span >> 32)].position[axis];
        }
        float pivot = fmaxf(fminf(k[0], k[1]), fminf(fmaxf(k[0], k[1]), k[2]));
        int64_t i = low, j = high;
        while (i <= j) {
            while (p[i].position[axis] < pivot)
                i++;
            while (p[j].position[axis] > pivot)
                j--;
            if (i <= j)
                swap_photons(&p[i++], &p[j--]);
            if ((i & CANCEL_MASK) == 0 && run_is_cancelled(run))
                return;
        }
        /* [low, j] <= pivot, [i, high] >= pivot, and what is between equals it */
        if (middle <= j)
            high = j;
        else if (middle >= i)
            low = i;
        else
            return;
    }
}

static void split_node(const run_context *run, photon_tree *tree, photon *p, uint32_t level, uint64_t place)
{
    range r = node_range(tree, level, place);
    uint32_t node = (1u << level) - 1 + (uint32_t)place, middle = node_range(tree, level + 1, 2 * place).high;
    if (middle >= r.high) { /* all is on the left */
        tree->nodes[node] = (photon_tree_node){INFINITY, 0};
        return;
    }
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = r.low; i < r.high; i++) {
        if ((i & CANCEL_MASK) == 0 && run_is_cancelled(run))
            return;
        for (int a = 0; a < 3; a++) {
            low[a] = fminf(low[a], p[i].position[a]);
            high[a] = fmaxf(high[a], p[i].position[a]);
        }
    }
    uint32_t axis = 0;
    for (uint32_t a = 1; a < 3; a++)
        if (high[a] - low[a] > high[axis] - low[axis])
            axis = a;
    select_middle(run, p, r, middle, axis);
    tree->nodes[node] = (photon_tree_node){p[middle].position[axis], axis};
}

static void split_subtree(const run_context *run, photon_tree *tree, photon *p, uint32_t level, uint64_t place)
{
    range r = node_range(tree, level, place);
    if (r.low == r.high || run_is_cancelled(run))
        return;
    if (level == tree->depth) {
        photon_block_from_records(&tree->blocks[place], r.high - r.low);
        return;
    }
    split_node(run, tree, p, level, place);
    split_subtree(run, tree, p, level + 1, 2 * place);
    split_subtree(run, tree, p, level + 1, 2 * place + 1);
}

typedef struct level_job {
    const run_context *run;
    photon_tree *tree;
    photon *photons;
    uint32_t level;
    bool whole_subtrees;
} level_job;

static void split_level_block(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)block, (void)worker;
    const level_job *job = user;
    for (uint64_t place = begin; place < end; place++)
        if (job->whole_subtrees)
            split_subtree(job->run, job->tree, job->photons, job->level, place);
        else
            split_node(job->run, job->tree, job->photons, job->level, place);
}

ag_status photon_tree_build(run_context *run, photon *photons, uint32_t count, double progress_begin,
                            double progress_end, photon_tree *out_tree)
{
    photon_tree tree = {.blocks = (photon_block *)(void *)photons, .count = count};
    while (((uint64_t)1 << tree.depth) < photon_block_count(count))
        tree.depth++;
    assert(tree.depth < DEPTH_MAX);
    if (tree.depth > 0) {
        tree.nodes = calloc(((size_t)1 << tree.depth) - 1, sizeof *tree.nodes); /* zeros where nothing is below */
        if (!tree.nodes)
            return AG_ERROR_MEMORY;
    }
    /* each level costs about the same */
    double step = (progress_end - progress_begin) / (tree.depth + 1);
    uint32_t parallel_levels = tree.depth < PARALLEL_LEVELS ? tree.depth : PARALLEL_LEVELS;
    ag_status status = AG_OK;
    for (uint32_t level = 0; level <= parallel_levels && status == AG_OK; level++) {
        level_job job = {run, &tree, photons, level, level == parallel_levels};
        double begin = progress_begin + step * level;
        status = parallel_for(run, (uint64_t)1 << level, 1, split_level_block, &job, AG_PHASE_MAP, begin,
                              job.whole_subtrees ? progress_end : begin + step);
    }
    if (status == AG_OK && run_is_cancelled(run))
        status = AG_CANCELLED; /* the last nodes may have been left undone */
    if (status != AG_OK) {
        photon_tree_reset(&tree);
        return status;
    }
    *out_tree = tree;
    return AG_OK;
}

void photon_tree_reset(photon_tree *tree)
{
    free(tree->nodes);
    *tree = (photon_tree){0};
}

uint64_t photon_tree_bytes(const photon_tree *tree)
{
    return tree->depth ? (((uint64_t)1 << tree->depth) - 1) * sizeof(photon_tree_node) : 0;
}

/* --- search --- */

uint32_t photon_tree_leaf(const photon_tree *tree, vec3 position)
{
    const float at[3] = {position.x, position.y, position.z};
    uint32_t leaf_base = (1u << tree->depth) - 1, node = 0;
    while (node < leaf_base) {
        photon_tree_node n = tree->nodes[node];
        node = 2 * node + 1 + (at[n.axis] >= n.split);
    }
    return node - leaf_base;
}

/* A part of the tree still to visit: how far the query is outside its box, along each axis and in all. */
typedef struct visit {
    float offset[3];
    float distance_squared;
    uint32_t node;
} visit;

typedef struct query {
    const photon_tree *tree;
    float position[3];
    vec3 normal;
    float min_cos;
    uint32_t similar_code, other_code; /* normals, as photons have them, that were last found similar and not */
    bool other_is_behind;              /* that other one is turned by more than 120 degrees */
    uint32_t visits;                   /* on the stack */
    visit stack[DEPTH_MAX];
} query;

#define NO_CODE UINT32_MAX

/* Rounding may make a box seem farther than its photons: what is within a hair of the limit is visited. */
static float hair_beyond(float limit) { return limit * 1.00001f; }

/* Goes down to the leaf on the query's side, leaving on the stack the other sides that are within the limit. Returns
 * the leaf's block. */
static uint32_t descend(query *q, visit v, float limit)
{
    uint32_t leaf_base = (1u << q->tree->depth) - 1, node = v.node;
    float most = hair_beyond(limit);
    while (node < leaf_base) {
        photon_tree_node n = q->tree->nodes[node];
        float from_plane = q->position[n.axis] - n.split, offset = v.offset[n.axis];
        uint32_t is_right = from_plane >= 0.0f;
        float beyond = v.distance_squared - offset * offset + from_plane * from_plane;
        if (beyond <= most && beyond < INFINITY) { /* beyond a plane at infinity there is nothing */
            visit *far = &q->stack[q->visits++];
            *far = v;
            far->offset[n.axis] = from_plane;
            far->distance_squared = beyond;
            far->node = 2 * node + 2 - is_right;
        }
        node = 2 * node + 1 + is_right;
    }
    return node - leaf_base;
}

/* Takes the next visit from the stack and goes down to its leaf; false when nothing within the limit is left. */
static bool next_leaf(query *q, float limit, uint32_t *out_block)
{
    float most = hair_beyond(limit);
    while (q->visits > 0) {
        visit v = q->stack[--q->visits];
        if (v.distance_squared > most)
            continue;
        *out_block = descend(q, v, limit);
        return true;
    }
    return false;
}

/* The leaf that the query is in. The way down is not kept: what has been found there tells which other sides matter. */
static uint32_t first_leaf(const query *q)
{
    return photon_tree_leaf(q->tree, (vec3){q->position[0], q->position[1], q->position[2]});
}

/* Puts on the stack the sides that the way to the first leaf left aside, as far as they are within the limit; the
 * nearest to the leaf on top. By the offset from their plane alone, which may be too little, and is never too much. */
static void stack_other_sides(query *q, uint32_t first_block, float limit)
{
    uint32_t leaf = (1u << q->tree->depth) - 1 + first_block;
    float most = hair_beyond(limit);
    q->visits = 0;
    for (uint32_t up = q->tree->depth; up > 0; up--) { /* the heap's order: the ancestor `up` levels above the leaf */
        uint32_t node = ((leaf + 1) >> up) - 1, child = ((leaf + 1) >> (up - 1)) - 1;
        photon_tree_node n = q->tree->nodes[node];
        float from_plane = q->position[n.axis] - n.split, beyond = from_plane * from_plane;
        if (beyond > most || !(beyond < INFINITY))
            continue;
        visit *far = &q->stack[q->visits++];
        *far = (visit){.distance_squared = beyond, .node = ((child + 1) ^ 1) - 1};
        far->offset[n.axis] = from_plane;
    }
}

/* Neighbours mostly share a normal: the last answers are kept. */
static inline bool has_similar_normal(query *q, uint16_t code)
{
    if (code == q->similar_code)
        return true;
    if (code == q->other_code)
        return false;
    /* the cosine against min_cos >= 0, without a square root */
    vec3 n = direction_decode_unnormalized(code);
    float d = vec3_dot(n, q->normal), square = vec3_length_squared(n);
    if (d > 0.0f && d * d > q->min_cos * q->min_cos * square) {
        q->similar_code = code;
        return true;
    }
    q->other_code = code;
    q->other_is_behind = d < 0.0f && d * d > 0.25f * square;
    return false;
}

static void query_init(query *q, const photon_tree *tree, vec3 position, vec3 normal, float min_cos)
{
    q->tree = tree;
    q->position[0] = position.x, q->position[1] = position.y, q->position[2] = position.z;
    q->normal = normal;
    q->min_cos = min_cos;
    q->similar_code = q->other_code = NO_CODE;
    q->other_is_behind = false;
}

/* The nearest so far. */
typedef struct nearest {
    float distance_squared;
    uint32_t index;
} nearest;

static void scan_for_nearest(query *q, uint32_t block, nearest *best)
{
    const photon_block *b = &q->tree->blocks[block];
    _Alignas(16) float d[PHOTON_BLOCK_LANES];
    uint32_t within = photon_block_within(b, q->position, best->distance_squared, d);
    while (within) {
        uint32_t lane = photon_block_nearest_lane(d, within), index = block * PHOTON_BLOCK_LANES + lane;
        uint16_t code = b->normal[lane];
        if (has_similar_normal(q, code)) {
            if (d[lane] < best->distance_squared || index < best->index)
                *best = (nearest){d[lane], index};
            return;
        }
        within &= ~photon_block_with_normal(b, code);
    }
}

uint32_t photon_tree_nearest(const photon_tree *tree, vec3 position, vec3 normal, float min_cos, float radius,
                             float *out_distance_squared)
{
    query q;
    query_init(&q, tree, position, normal, min_cos);
    nearest best = {radius * radius, PHOTON_NONE};
    if (tree->count > 0) {
        uint32_t block = first_leaf(&q);
        scan_for_nearest(&q, block, &best);
        stack_other_sides(&q, block, best.distance_squared);
        while (next_leaf(&q, best.distance_squared, &block))
            scan_for_nearest(&q, block, &best);
    }
    *out_distance_squared = best.distance_squared;
    return best.index;
}

/* Quickselect over neighbours, which are all different: the `wanted` nearest come first, the farthest of them at
 * wanted - 1. */
static void quickselect(photon_neighbor *n, uint32_t count, uint32_t wanted)
{
    int64_t low = 0, high = (int64_t)count - 1, target = (int64_t)wanted - 1;
    while (low < high) {
        photon_neighbor a = n[low], b = n[low + (high - low) / 2], c = n[high];
        photon_neighbor pivot = a < b ? (b < c ? b : (a < c ? c : a)) : (a < c ? a : (b < c ? c : b));
        int64_t i = low, j = high;
        while (i <= j) {
            while (n[i] < pivot)
                i++;
            while (n[j] > pivot)
                j--;
            if (i <= j) {
                photon_neighbor hold = n[i];
                n[i++] = n[j];
                n[j--] = hold;
            }
        }
        if (target <= j)
            high = j;
        else if (target >= i)
            low = i;
        else
            return;
    }
}

/* The same, for neighbours within the limit. On a surface the squared distances are spread evenly, so a histogram of
 * them leaves only a few to be compared; all else moves without a branch to be mispredicted. */
static void select_nearest(photon_neighbor *n, uint32_t count, uint32_t wanted, float limit)
{
    enum { BINS = 256, BIN_MAX = 64 };
    uint32_t histogram[BINS] = {0};
    float scale = limit > 0x1p-100f ? (float)(BINS - 1) / limit : 0.0f; /* smaller ones share a bin: no overflow */
    for (uint32_t i = 0; i < count; i++)
        histogram[(uint32_t)(photon_neighbor_distance_squared(n[i]) * scale)]++;
    uint32_t before = 0, bin = 0; /* the bin of the last one wanted, and how many lie in those before it */
    while (before + histogram[bin] < wanted)
        before += histogram[bin++];
    if (histogram[bin] > BIN_MAX) {
        quickselect(n, count, wanted);
        return;
    }
    photon_neighbor in_bin[BIN_MAX + 1];
    uint32_t kept = 0, in_bin_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        photon_neighbor x = n[i];
        uint32_t its_bin = (uint32_t)(photon_neighbor_distance_squared(x) * scale);
        n[kept] = x;
        kept += its_bin < bin;
        in_bin[in_bin_count] = x;
        in_bin_count += its_bin == bin;
    }
    quickselect(in_bin, in_bin_count, wanted - kept);
    for (uint32_t i = 0; kept < wanted; i++)
        n[kept++] = in_bin[i];
}

/* What has been collected: those of the `wanted` nearest that lie within the limit, which shrinks. */
typedef struct collection {
    photon_neighbor *neighbors;
    uint32_t count, wanted, capacity;
    float limit;
    float other; /* squared distance of the nearest photon with another normal, but none about the opposite */
} collection;

static void keep_nearest(collection *c)
{
    select_nearest(c->neighbors, c->count, c->wanted, c->limit);
    c->count = c->wanted;
}

static void scan_for_all(query *q, uint32_t block, collection *c)
{
    const photon_block *b = &q->tree->blocks[block];
    _Alignas(16) float d[PHOTON_BLOCK_LANES];
    uint32_t within = photon_block_within(b, q->position, c->limit, d);
    uint32_t similar = q->similar_code == NO_CODE ? 0 : within & photon_block_with_normal(b, (uint16_t)q->similar_code);
    uint32_t rest = within & ~similar;
    while (rest) {
        uint32_t lane = (uint32_t)__builtin_ctz(rest);
        rest &= rest - 1;
        if (has_similar_normal(q, b->normal[lane]))
            similar |= 1u << lane;
        else if (!q->other_is_behind)
            c->other = fminf(c->other, d[lane]);
    }
    photon_neighbor *end = c->neighbors + c->count;
    for (; similar; similar &= similar - 1) {
        uint32_t lane = (uint32_t)__builtin_ctz(similar);
        *end++ = photon_neighbor_make(d[lane], block * PHOTON_BLOCK_LANES + lane);
    }
    c->count = (uint32_t)(end - c->neighbors);
    if (c->count + PHOTON_BLOCK_LANES > c->capacity) {
        /* full: keep the nearest, and look no farther than they reach */
        keep_nearest(c);
        c->limit = photon_neighbor_distance_squared(c->neighbors[c->wanted - 1]);
    }
}

static void collect(query *q, uint32_t first_block, collection *c)
{
    uint32_t block;
    c->count = 0;
    c->other = INFINITY;
    scan_for_all(q, first_block, c);
    stack_other_sides(q, first_block, c->limit);
    while (next_leaf(q, c->limit, &block))
        scan_for_all(q, block, c);
    if (c->count >= c->wanted)
        keep_nearest(c);
}

/* A first radius squared, within which the wanted photons may be expected: the leaf around the query tells how dense
 * they lie there. A function of the tree and the query alone. */
static float guess_radius_squared(query *q, uint32_t first_block, uint32_t wanted, float largest)
{
    const photon_block *b = &q->tree->blocks[first_block];
    _Alignas(16) float d[PHOTON_BLOCK_LANES];
    float reach = 0.0f;
    uint32_t similar = 0;
    for (uint32_t all = photon_block_within(b, q->position, INFINITY, d); all; all &= all - 1) {
        uint32_t lane = (uint32_t)__builtin_ctz(all);
        if (!has_similar_normal(q, b->normal[lane]))
            continue;
        reach = fmaxf(reach, d[lane]);
        similar++;
    }
    if (similar < 4)
        return largest;
    float guess = reach * (float)wanted / (float)similar;
    return guess > 0.0f ? fminf(guess, largest) : largest;
}

uint32_t photon_tree_k_nearest(const photon_tree *tree, vec3 position, vec3 normal, float min_cos, float radius,
                               uint32_t wanted, photon_neighbor *neighbors, float *out_other_squared)
{
    *out_other_squared = INFINITY;
    if (tree->count == 0)
        return 0;
    query q;
    query_init(&q, tree, position, normal, min_cos);
    uint32_t block = first_leaf(&q);
    float largest = radius * radius, limit = guess_radius_squared(&q, block, wanted, largest);
    for (;;) {
        collection c = {
            .neighbors = neighbors, .wanted = wanted, .capacity = photon_neighbors_capacity(wanted), .limit = limit};
        collect(&q, block, &c);
        *out_other_squared = c.other;
        if (c.count == wanted || limit >= largest)
            return c.count;
        /* too few: by how many tells how much farther to look */
        limit = fminf(limit * fminf(4.0f, 1.3f * (float)wanted / (float)(c.count + 1)), largest);
    }
}
