/* disc_kernels.h: the inner loops of an estimate, in plain C and for AVX2: finding a leaf's photons, selecting the
 * nearest, and summing the photons of a disc. Both versions do the same operations on the same numbers, so that
 * their results have the same bits, which tests/photonmap checks. The plain ones stand for processors without AVX2;
 * the others stay because without them a frame of the Cornell box takes 9 % more CPU time (cornell-box -t 1 --noise
 * 0 --size 160x90 --spp 4 --photons 300000; median of pairs of runs, AMD EPYC).
 * Rests on: Intel, "64 and IA-32 Architectures Optimization Reference Manual", ch. on AVX2 (gathers, compaction by
 * permutation). Flow: photon_k_nearest, irradiance_estimate -> [here]. Threads: pure but for what the caller owns. */
#ifndef AFTERGLOW_DISC_KERNELS_H
#define AFTERGLOW_DISC_KERNELS_H

#include "photon_query.h"

#include <string.h>

/* The photons found so far. */
typedef struct photon_collection {
    photon_neighbor *neighbors;
    uint32_t count, capacity; /* capacity - count >= PHOTON_BLOCK_LANES */
    float limit;              /* squared distance */
    float other; /* squared distance of the nearest photon whose normal differs but is not about opposite */
} photon_collection;

/* The sums over a disc's photons, in integers, so that they do not depend on the order of the photons. */
typedef struct photon_disc_sums {
    int64_t flux[3];   /* in units of 2^(flux_exponent_max - 32); red, green, blue */
    int32_t offset[3]; /* from the point, in units of the radius / 2^12; does not overflow for up to 2^19 photons */
} photon_disc_sums;

#define PHOTON_DISC_OFFSET_UNIT 0x1p12f

typedef struct photon_disc {
    const photon_block *blocks;
    vec3 position, normal;
    float radius;          /* > 0 */
    float level;           /* photons within this height of the point's plane lie on its surface */
    int flux_exponent_max; /* of any photon of the map */
} photon_disc;

typedef struct disc_kernels {
    /* Finds the leaves, PHOTON_SUBTREE_LEVELS below a node, whose boxes are within `most`, a squared distance.
     * out_leaves: room for all of them. Returns their number. */
    uint32_t (*find_leaves)(const photon_query *query, photon_subtree subtree, float most, uint32_t *out_leaves);

    /* Appends the photons of leaves that lie within the limit and have similar normals. Returns the number of leaves
     * read, which is less than leaf_count where the collection is full. */
    uint32_t (*collect)(photon_query *query, const uint32_t *leaves, uint32_t leaf_count,
                        photon_collection *collection);

    /* Partitions `count` neighbours so that the `wanted` nearest come first, the farthest of these last; 1 <= wanted <=
     * count. All lie within the limit, a squared distance. */
    void (*select)(photon_neighbor *neighbors, uint32_t count, uint32_t wanted, float limit);

    /* Sums the neighbours that lie on the point's surface, as heights and normals tell, and keeps them in front in
     * their order; the others go to out_doubtful in their order, which has room for count + 4. Returns the number
     * kept. */
    uint32_t (*sum_on_level)(const photon_disc *disc, photon_neighbor *neighbors, uint32_t count,
                             photon_disc_sums *out_sums, photon_neighbor *out_doubtful);
} disc_kernels;

/* Returns whether a photon lies on the surface of the point, as heights and normals tell: no lower than on a convex
 * surface with the two normals, and no higher than the level. */
static inline bool photon_disc_is_on_level(const photon_disc *disc, vec3 offset, uint16_t normal_code)
{
    float height = vec3_dot(offset, disc->normal), below = -height - disc->level;
    if (fabsf(height) <= disc->level)
        return true;
    /* below <= lateral tan(angle between the normals), squared; the angle is less than 90 degrees */
    vec3 n = direction_decode_unnormalized(normal_code);
    float d = vec3_dot(n, disc->normal), square = d * d;
    float lateral_squared = vec3_dot(offset, offset) - height * height;
    return below > 0.0f && below * below * square <= lateral_squared * (vec3_dot(n, n) - square);
}

/* Adds a photon to the sums. */
static inline void photon_disc_add(const photon_disc *disc, photon_neighbor n, photon_disc_sums *sums)
{
    uint32_t index = photon_neighbor_index(n), code = photon_block_flux(disc->blocks, index);
    uint32_t below = (uint32_t)(disc->flux_exponent_max - flux_exponent(code));
    for (int c = 0; c < 3 && below < 64; c++) /* fainter photons add 0 */
        sums->flux[c] += (int64_t)((uint64_t)(code >> (16 - 8 * c) & 255) << 32 >> below);
    vec3 offset = vec3_sub(photon_block_position(disc->blocks, index), disc->position);
    float scale = PHOTON_DISC_OFFSET_UNIT / disc->radius;
    sums->offset[0] += (int32_t)(offset.x * scale);
    sums->offset[1] += (int32_t)(offset.y * scale);
    sums->offset[2] += (int32_t)(offset.z * scale);
}

/* Adds a photon to the sums if it lies on the point's level; else returns false. */
static inline bool photon_disc_keep(const photon_disc *disc, photon_neighbor n, photon_disc_sums *sums)
{
    uint32_t index = photon_neighbor_index(n);
    vec3 offset = vec3_sub(photon_block_position(disc->blocks, index), disc->position);
    if (!photon_disc_is_on_level(disc, offset, photon_block_normal(disc->blocks, index)))
        return false;
    photon_disc_add(disc, n, sums);
    return true;
}

/* sum_on_level of the neighbours from `begin` to `end`, when *in_out_kept of those before have been kept. */
static inline void photon_disc_part(const photon_disc *disc, photon_neighbor *n, uint32_t begin, uint32_t end,
                                    uint32_t *in_out_kept, photon_disc_sums *sums, photon_neighbor *doubtful)
{
    for (uint32_t i = begin; i < end; i++) {
        photon_neighbor x = n[i];
        bool keeps = photon_disc_keep(disc, x, sums);
        doubtful[i - *in_out_kept] = x; /* the others */
        n[*in_out_kept] = x;
        *in_out_kept += keeps;
    }
}

/* disc_kernels.select by comparisons alone. */
void photon_neighbors_quickselect(photon_neighbor *neighbors, uint32_t count, uint32_t wanted);

/* --- the steps of selecting the nearest, for the plain kernels and those of AVX2 --- */

/* Neighbours are told apart by so many steps of squared distance before they are compared; where more than BIN_MAX
 * share the step of the last one wanted, all are compared. */
enum { DISC_BINS = 64, DISC_BIN_MAX = 64 };

typedef struct photon_selection {
    float scale; /* from squared distance to bin */
    uint32_t histogram[DISC_BINS];
    uint32_t bin;                /* of the last one wanted */
    uint32_t kept, in_bin_count; /* moved to the front; put aside, since they are of that bin */
    photon_neighbor in_bin[DISC_BIN_MAX + 1];
} photon_selection;

static inline void photon_selection_begin(photon_selection *s, float limit)
{
    memset(s->histogram, 0, sizeof s->histogram);
    s->scale = limit > 0x1p-100f ? (float)(DISC_BINS - 1) / limit : 0.0f; /* smaller ones share a bin: no overflow */
    s->kept = s->in_bin_count = 0;
}

static inline uint32_t photon_selection_bin(const photon_selection *s, photon_neighbor n)
{
    return (uint32_t)(photon_neighbor_distance_squared(n) * s->scale);
}

static inline void photon_selection_count(photon_selection *s, const photon_neighbor *n, uint32_t begin, uint32_t end)
{
    for (uint32_t i = begin; i < end; i++)
        s->histogram[photon_selection_bin(s, n[i])]++;
}

/* To be called when all are counted. Returns false where too many photons share the bin; all have been compared
 * instead. */
static inline bool photon_selection_find_bin(photon_selection *s, photon_neighbor *n, uint32_t count, uint32_t wanted)
{
    uint32_t before = 0;
    for (s->bin = 0; before + s->histogram[s->bin] < wanted; s->bin++)
        before += s->histogram[s->bin];
    if (s->histogram[s->bin] <= DISC_BIN_MAX)
        return true;
    photon_neighbors_quickselect(n, count, wanted);
    return false;
}

/* Moves every photon by the same instructions, so that no branch is mispredicted. */
static inline void photon_selection_part(photon_selection *s, photon_neighbor *n, uint32_t begin, uint32_t end)
{
    for (uint32_t i = begin; i < end; i++) {
        photon_neighbor x = n[i];
        uint32_t its_bin = photon_selection_bin(s, x);
        n[s->kept] = x;
        s->kept += its_bin < s->bin;
        s->in_bin[s->in_bin_count] = x;
        s->in_bin_count += its_bin == s->bin;
    }
}

/* Called once all photons are parted. */
static inline void photon_selection_end(photon_selection *s, photon_neighbor *n, uint32_t wanted)
{
    photon_neighbors_quickselect(s->in_bin, s->in_bin_count, wanted - s->kept);
    memcpy(n + s->kept, s->in_bin, (wanted - s->kept) * sizeof *n);
}

extern const disc_kernels disc_kernels_plain;

/* Returns NULL where the compiler or the processor does not support AVX2. */
const disc_kernels *disc_kernels_avx2(void);

/* Returns the fastest kernels that this processor supports. */
const disc_kernels *disc_kernels_best(void);

/* photon_tree_k_nearest with given kernels. */
uint32_t disc_kernels_k_nearest(const disc_kernels *kernels, const photon_tree *tree, vec3 position, vec3 normal,
                                float min_cos, float radius, uint32_t wanted, photon_neighbor *neighbors,
                                float *out_other_squared);

#endif
