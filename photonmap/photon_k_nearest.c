/* photon_k_nearest.c: the k nearest photons; see photon_tree.h.
 * Threads: read only. */
#include "disc_kernels.h"

#include <string.h>

/* The leaf that the query is in. The way down is not kept: what has been found there tells which other sides matter. */
static uint32_t first_leaf(const photon_query *q)
{
    return photon_tree_leaf(q->tree, (vec3){q->position[0], q->position[1], q->position[2]});
}

/* Pushes the sides that the path to a node above the leaves has left aside, as far as they are within the limit; the
 * nearest to the node on top. Their distance is the offset from their plane alone, which may be too small, but never
 * too large. */
static void stack_other_sides(photon_query *q, uint32_t node, uint32_t height, float limit)
{
    uint32_t heap_index = node + 1;
    float most = photon_query_hair_beyond(limit);
    q->visits = 0;
    for (uint32_t up = q->tree->depth - height; up > 0; up--) {
        photon_tree_node n = photon_tree_node_at(q->tree, (heap_index >> up) - 1);
        photon_query_push(q, photon_lanes_fill(0.0f), q->at - photon_lanes_fill(n.split), n.axis,
                          ((heap_index >> (up - 1)) ^ 1) - 1, most);
    }
}

/* Collects the photons within the limit; where they are too many, keeps the nearest and shrinks the limit. Leaves are
 * prefetched while others are searched. */
static void collect(const disc_kernels *kernels, photon_query *q, uint32_t first_leaf, uint32_t wanted, photon_found *f)
{
    enum { LEAVES = 3 * DISC_SUBTREE_LEAVES_MAX };
    uint32_t leaves[LEAVES], depth = q->tree->depth, levels = kernels->subtree_levels,
                             height = depth < levels ? 0 : levels;
    photon_subtree next = {photon_lanes_fill(0.0f), (((1u << depth) + first_leaf) >> height) - 1};
    stack_other_sides(q, next.node, height, f->limit);
    for (bool is_left = true; is_left;) {
        uint32_t count = 0, before = 0;
        do {
            if (height > 0)
                count += kernels->find_leaves(q, next, photon_query_hair_beyond(f->limit), leaves + count);
            else
                leaves[count++] = next.node - ((1u << depth) - 1);
            for (; before < count; before++)
                photon_block_prefetch(&q->tree->blocks[leaves[before]]);
            is_left = photon_query_next(q, f->limit, height, &next);
        } while (is_left && count + DISC_SUBTREE_LEAVES_MAX <= LEAVES);
        uint32_t done = kernels->collect(q, leaves, count, f);
        for (; done < count; done += kernels->collect(q, leaves + done, count - done, f)) {
            photon_found_keep_nearest(kernels, f, wanted); /* each leaf has a photon: they are more than wanted */
            photon_found_drop_empty_leaves(f);
        }
    }
    if (f->count >= wanted)
        photon_found_keep_nearest(kernels, f, wanted);
}

/* A first radius squared, within which the wanted photons may be expected: the few leaves around the query tell how
 * dense they lie. A rectangle of photons has the area 12 sqrt(var u var v); of a plane that lies askew, var u var v is
 * the sum of the principal minors of their covariance. A function of the tree and the query alone; what it is changes
 * the time of a search only. */
static float guess_radius_squared(const photon_query *q, uint32_t first_block, uint32_t wanted, float largest)
{
    enum { LEAVES = 4, PHOTONS = LEAVES * PHOTON_BLOCK_LANES };
    static const float MARGIN = 1.2f;
    uint32_t begin = first_block & ~(uint32_t)(LEAVES - 1);
    if (((uint64_t)begin + LEAVES) * PHOTON_BLOCK_LANES > q->tree->count)
        return largest;
    /* relative to the query, which is near: nothing cancels */
    float sum[3] = {0.0f, 0.0f, 0.0f}, xx = 0.0f, yy = 0.0f, zz = 0.0f, xy = 0.0f, yz = 0.0f, zx = 0.0f;
    for (uint32_t block = begin; block < begin + LEAVES; block++) {
        const photon_block *b = &q->tree->blocks[block];
        photon_lanes sums[9] = {{0.0f}};
        for (uint32_t i = 0; i < PHOTON_BLOCK_LANES; i += 4) {
            photon_lanes x, y, z;
            memcpy(&x, &b->position[0][i], sizeof x);
            memcpy(&y, &b->position[1][i], sizeof y);
            memcpy(&z, &b->position[2][i], sizeof z);
            x -= photon_lanes_fill(q->position[0]);
            y -= photon_lanes_fill(q->position[1]);
            z -= photon_lanes_fill(q->position[2]);
            sums[0] += x, sums[1] += y, sums[2] += z;
            sums[3] += x * x, sums[4] += y * y, sums[5] += z * z;
            sums[6] += x * y, sums[7] += y * z, sums[8] += z * x;
        }
        float *const to[9] = {&sum[0], &sum[1], &sum[2], &xx, &yy, &zz, &xy, &yz, &zx};
        for (int k = 0; k < 9; k++)
            *to[k] += (sums[k][0] + sums[k][1]) + (sums[k][2] + sums[k][3]);
    }
    float n = 1.0f / PHOTONS, mx = sum[0] * n, my = sum[1] * n, mz = sum[2] * n;
    xx = xx * n - mx * mx, yy = yy * n - my * my, zz = zz * n - mz * mz;
    xy = xy * n - mx * my, yz = yz * n - my * mz, zx = zx * n - mz * mx;
    float minors = xx * yy - xy * xy + yy * zz - yz * yz + zz * xx - zx * zx;
    float area = 12.0f * sqrtf(minors > 0.0f ? minors : 0.0f);
    float guess = MARGIN * AG_INV_PI * area * n * (float)wanted;
    return guess > 0.0f && guess < largest ? guess : largest;
}

/* A disc whose centre is so near, in radii squared, mostly has nearly the same radius. */
static const float HINT_NEAR = 0.25f, HINT_MARGIN = 1.1f;

void photon_found_search_by(const disc_kernels *kernels, photon_found *found, const photon_tree *tree, vec3 position,
                            vec3 normal, float min_cos, float radius, uint32_t wanted, photon_search_hint *in_out_hint)
{
    found->leaf_count = found->count = 0;
    found->other_squared = INFINITY;
    if (tree->count == 0)
        return;
    photon_query q;
    photon_query_init(&q, tree, position, normal, min_cos);
    const photon_search_hint none = {.leaf = PHOTON_NONE}, *hint = in_out_hint ? in_out_hint : &none;
    uint32_t leaf = hint->leaf != PHOTON_NONE ? hint->leaf : first_leaf(&q);
    float largest = radius * radius, limit = HINT_MARGIN * hint->radius_squared;
    if (!(vec3_distance_squared(hint->position, position) < HINT_NEAR * hint->radius_squared))
        limit = guess_radius_squared(&q, leaf, wanted, largest);
    limit = float_min(limit, largest);
    for (;;) {
        found->leaf_count = found->count = 0;
        found->limit = limit;
        found->other_squared = INFINITY;
        collect(kernels, &q, leaf, wanted, found);
        if (found->count == wanted || limit >= largest)
            break;
        /* too few: by how many tells how much farther to look, the better the more there are */
        float margin = found->count > wanted / 2 ? 1.15f : 1.3f;
        limit = float_min(limit * float_min(margin * (float)wanted / (float)(found->count + 1), 4.0f), largest);
    }
    if (found->other_squared > found->limit)
        found->other_squared = INFINITY; /* what is known beyond the limit depends on where the search began */
    if (in_out_hint)
        *in_out_hint = (photon_search_hint){position, found->limit, PHOTON_NONE};
}

void photon_found_search(photon_found *found, const photon_tree *tree, vec3 position, vec3 normal, float min_cos,
                         float radius, uint32_t wanted, photon_search_hint *in_out_hint)
{
    photon_found_search_by(disc_kernels_best(), found, tree, position, normal, min_cos, radius, wanted, in_out_hint);
}

uint32_t photon_tree_k_nearest_by(const disc_kernels *kernels, const photon_tree *tree, vec3 position, vec3 normal,
                                  float min_cos, float radius, uint32_t wanted, photon_neighbor *neighbors,
                                  float *out_other_squared)
{
    photon_found found;
    photon_found_init(&found, tree, wanted, neighbors);
    photon_found_search_by(kernels, &found, tree, position, normal, min_cos, radius, wanted, NULL);
    *out_other_squared = found.other_squared;
    uint32_t count = kernels->list_between(&found, -1.0f, found.limit, neighbors), last = count - 1;
    for (uint32_t i = 0; count == wanted && i < last; i++)
        if (neighbors[i] == found.farthest) {
            neighbors[i] = neighbors[last];
            neighbors[last] = found.farthest;
        }
    return count;
}

uint32_t photon_tree_k_nearest(const photon_tree *tree, vec3 position, vec3 normal, float min_cos, float radius,
                               uint32_t wanted, photon_neighbor *neighbors, float *out_other_squared)
{
    return photon_tree_k_nearest_by(disc_kernels_best(), tree, position, normal, min_cos, radius, wanted, neighbors,
                                    out_other_squared);
}
