/* photon_tree.c: building, see photon_tree.h; photon_nearest.c and photon_k_nearest.c search.
 * The upper levels node by node with all threads at once, then the subtrees each by one.
 * Threads: built by the run's workers. */
#include "photon_tree.h"

#include "parallel_for.h"

#include <assert.h>
#include <stdlib.h>

enum { PARALLEL_LEVELS = 9 };
/* How often long loops look whether to stop: every 65,536 photons, some tenths of a millisecond. */
enum { CANCEL_MASK = 0xffff };
/* Shorter ranges take their own middle as the pivot. */
enum { SAMPLED_MIN = 600 };
/* How far rounding moves points of a flat surface, relative to their largest coordinate: some units in the last
 * place. */
static const float ON_PLANE_RELATIVE = 5e-7f;

/* --- build --- */

typedef struct range {
    uint32_t low, high; /* photons */
} range;

/* The photons below the node of that number on its level: those of the blocks that are its leaves, as far as there are
 * any. */
static range node_range(const photon_tree *tree, uint32_t level, uint64_t number)
{
    uint64_t each = (uint64_t)PHOTON_BLOCK_LANES << (tree->depth - level);
    uint64_t low = number * each, high = low + each, count = tree->count;
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

typedef float float4 __attribute__((vector_size(16)));

/* Hoare's quickselect (1961) with Floyd and Rivest's pivots ("Expected Time Bounds for Selection", 1975): found by the
 * same selection in a small part of the range, and a little to that side of the middle where more is left, so that two
 * passes nearly always do. Afterwards nothing in [low, middle) is greater than p[middle] along the axis, and nothing in
 * (middle, high] is less. Equal keys are swapped too, which keeps the halves even when all photons coincide. */
static void select_middle(const run_context *run, photon *p, int64_t low, int64_t high, int64_t middle, uint32_t axis)
{
    while (low < high) {
        int64_t span = high - low + 1;
        if (span > SAMPLED_MIN) {
            double sample = 4.0 * sqrt((double)span), spread = 1.5 * sqrt(sample);
            double before = sample * (double)(middle - low) / (double)span;
            if (2 * (middle - low) < span)
                spread = -spread;
            int64_t first = middle - (int64_t)(before - spread), last = middle + (int64_t)(sample - before + spread);
            select_middle(run, p, first > low ? first : low, last < high ? last : high, middle, axis);
        }
        float pivot = p[middle].position[axis];
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
        /* [low, j] <= pivot, [i, high] >= pivot, and those between are equal to it */
        if (middle <= j)
            high = j;
        else if (middle >= i)
            low = i;
        else
            return;
    }
}

/* Whether the plane lies in a surface: more than an eighth of the photons are on it, but for what rounding did to them.
 * They would be shared out to both sides at random, and every search near them would have to look at both. */
static bool lies_in_surface(const photon *p, range r, photon_tree_node plane, float hair)
{
    uint32_t on_it = 0;
    for (uint32_t i = r.low; i < r.high; i++)
        on_it += fabsf(p[i].position[plane.axis] - plane.split) <= hair;
    return on_it > (r.high - r.low) / 8;
}

/* The longest first. */
static void sort_axes(const float extent[3], uint32_t out_axes[3])
{
    for (uint32_t a = 0; a < 3; a++) {
        uint32_t at = a;
        for (; at > 0 && extent[a] > extent[out_axes[at - 1]]; at--)
            out_axes[at] = out_axes[at - 1];
        out_axes[at] = a;
    }
}

static void split_node(const run_context *run, photon_tree *tree, photon *p, uint32_t level, uint64_t number)
{
    range r = node_range(tree, level, number);
    uint32_t node = (1u << level) - 1 + (uint32_t)number, middle = node_range(tree, level + 1, 2 * number).high;
    if (middle >= r.high) { /* all is on the left */
        tree->nodes[node] = (photon_tree_node){INFINITY, 0};
        return;
    }
    /* the fourth lane is what follows the position, and is not looked at */
    float4 low = {INFINITY, INFINITY, INFINITY, INFINITY}, high = -low;
    for (uint32_t i = r.low; i < r.high; i++) {
        if ((i & CANCEL_MASK) == 0 && run_is_cancelled(run))
            return;
        float4 at;
        __builtin_memcpy(&at, &p[i], sizeof at);
        for (int a = 0; a < 4; a++) {
            low[a] = at[a] < low[a] ? at[a] : low[a];
            high[a] = at[a] > high[a] ? at[a] : high[a];
        }
    }
    float size = 0.0f;
    for (int a = 0; a < 3; a++)
        size = float_max(size, float_max(fabsf(low[a]), fabsf(high[a])));
    /* across the longest way that does not lie in a surface; where all do, across the longest */
    const float extent[3] = {high[0] - low[0], high[1] - low[1], high[2] - low[2]};
    uint32_t axes[4], tried = 0;
    sort_axes(extent, axes);
    axes[3] = axes[0];
    photon_tree_node plane;
    do {
        plane.axis = axes[tried];
        select_middle(run, p, r.low, (int64_t)r.high - 1, middle, plane.axis);
        plane.split = p[middle].position[plane.axis];
    } while (tried++ < 3 && lies_in_surface(p, r, plane, ON_PLANE_RELATIVE * size));
    tree->nodes[node] = plane;
}

static void split_subtree(const run_context *run, photon_tree *tree, photon *p, uint32_t level, uint64_t number)
{
    range r = node_range(tree, level, number);
    bool is_empty = r.low == r.high;
    /* searches treat the lowest levels as a whole, so that their empty parts must lie beyond planes at infinity on all
     * levels */
    if (run_is_cancelled(run) || (is_empty && tree->depth - level >= PHOTON_SUBTREE_LEVELS))
        return;
    if (level == tree->depth) {
        if (!is_empty)
            photon_block_from_records(&tree->blocks[number], r.high - r.low);
        return;
    }
    split_node(run, tree, p, level, number);
    split_subtree(run, tree, p, level + 1, 2 * number);
    split_subtree(run, tree, p, level + 1, 2 * number + 1);
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
    for (uint64_t number = begin; number < end; number++)
        if (job->whole_subtrees)
            split_subtree(job->run, job->tree, job->photons, job->level, number);
        else
            split_node(job->run, job->tree, job->photons, job->level, number);
}

ag_status photon_tree_build(run_context *run, photon *photons, uint32_t count, double progress_begin,
                            double progress_end, photon_tree *out_tree)
{
    photon_tree tree = {.blocks = (photon_block *)(void *)photons, .count = count};
    while (((uint64_t)1 << tree.depth) < photon_block_count(count))
        tree.depth++;
    assert(tree.depth < PHOTON_TREE_DEPTH_MAX);
    if (tree.depth > 0) {
        tree.nodes = calloc(((size_t)1 << tree.depth) - 1, sizeof *tree.nodes); /* zeros where nothing is near */
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

uint32_t photon_tree_leaf(const photon_tree *tree, vec3 position)
{
    const float at[PHOTON_TREE_AXES] = {position.x, position.y, position.z};
    uint32_t leaf_base = (1u << tree->depth) - 1, node = 0;
    while (node < leaf_base) {
        photon_tree_node n = photon_tree_node_at(tree, node);
        node = 2 * node + 1 + (at[n.axis] >= n.split);
    }
    return node - leaf_base;
}
