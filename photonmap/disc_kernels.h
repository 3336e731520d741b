/* disc_kernels.h: the inner loops of an estimate, in plain C, for AVX2 and for AVX-512: finding a leaf's photons,
 * selecting the nearest, and summing the photons of a disc. All versions do the same operations on the same numbers, so
 * that their results have the same bits, which tests/photonmap checks. The plain version goes photon by photon: it
 * serves processors without AVX2, and it checks the other versions, with which it shares no code. Without the AVX2
 * version a frame of the Cornell box takes 9 % more CPU time (cornell-box -t 1 --noise 0 --size 160x90 --spp 4
 * --photons 300000; median of pairs of runs, AMD EPYC); perf/costs.md tells what AVX-512 brings.
 * Rests on: Intel, "64 and IA-32 Architectures Optimization Reference Manual", ch. on AVX2 and on AVX-512.
 * Flow: photon_k_nearest, irradiance_estimate -> [here]. Threads: pure but for what the caller owns. */
#ifndef AFTERGLOW_DISC_KERNELS_H
#define AFTERGLOW_DISC_KERNELS_H

#include "photon_found.h"
#include "photon_query.h"
#include "surface_region.h"

#include <string.h>

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
    float flat_height;     /* scene units: photons no higher above or below the point's plane lie on its surface */
    int flux_exponent_max; /* of any photon of the map */
    bool has_offsets;      /* photon_disc_sums.offset is wanted; else it need not be right */
} photon_disc;

enum { DISC_COUNTS = 3, DISC_SUBTREE_LEVELS_MAX = 4, DISC_SUBTREE_LEAVES_MAX = 1 << DISC_SUBTREE_LEVELS_MAX };
_Static_assert((int)PHOTON_SUBTREE_LEVELS <= (int)DISC_SUBTREE_LEVELS_MAX,
               "the plain and AVX2 kernels write as many leaves");

/* The codes of normals (direction_encode) that are similar to a query's for sure. */
typedef struct near_code_bound {
    short middle;    /* the query's own code */
    char most_apart; /* how far each half of a code may be from the query's */
    bool is_any;     /* false: no other code is near enough */
} near_code_bound;

/* Where the coordinates of an octahedral code change by 1, the vector changes by the square root of 3 at the most and
 * is nowhere shorter than 1 over that, so that the direction changes by 3 at the most. A step is 1 / 127, and each
 * coordinate of the query's normal is half a step from its code. */
static inline near_code_bound near_code_bound_of(const photon_query *q)
{
    float chord = sqrtf(2.0f - 2.0f * q->min_cos), steps = chord / 3.0f * 127.0f / 1.41422f;
    int most = (int)(steps - 1.0f); /* half a step is for rounding */
    return (near_code_bound){(short)direction_encode(q->normal), (char)most, steps >= 1.0f};
}

typedef struct disc_kernels {
    /* How far above the leaves the subtrees of find_leaves begin. */
    uint32_t subtree_levels;

    /* Finds the leaves below a node, so many levels above them, whose boxes are within `most`, a squared distance.
     * out_leaves: room for all of them. Returns their number. */
    uint32_t (*find_leaves)(const photon_query *query, photon_subtree subtree, float most, uint32_t *out_leaves);

    /* Appends the leaves' photons that lie within the limit and have similar normals. Returns the number of leaves
     * read, which is less than leaf_count where there is no more room. */
    uint32_t (*collect)(photon_query *query, const uint32_t *leaves, uint32_t leaf_count, photon_found *found);

    /* Counts the photons no farther than each of some squared distances. */
    void (*count_within)(const photon_found *found, const float most[DISC_COUNTS], uint32_t out_counts[DISC_COUNTS]);

    /* Writes the photons farther than `low` and no farther than `high`, squared distances. Returns their number. */
    uint32_t (*list_between)(const photon_found *found, float low, float high, photon_neighbor *out_neighbors);

    /* Sums the photons found that lie on the point's surface, as heights and normals tell. out_doubtful: the entries
     * of the others in found->distances_squared. Returns the number summed. */
    uint32_t (*sum_on_surface)(const photon_disc *disc, const photon_found *found, photon_disc_sums *out_sums,
                               photon_neighbor *out_doubtful);

    /* Sums the photons found that are in the region. Returns their number. */
    uint32_t (*sum_in_region)(const photon_disc *disc, const surface_region *region, const photon_found *found,
                              photon_disc_sums *out_sums);
} disc_kernels;

/* Returns whether a photon lies on the surface of the point, as heights and normals tell: no lower than on a convex
 * surface with the two normals, and no higher than flat_height. */
static inline bool photon_disc_is_on_surface(const photon_disc *disc, vec3 offset, uint16_t normal_code)
{
    float height = vec3_dot(offset, disc->normal), below = -height - disc->flat_height;
    if (fabsf(height) <= disc->flat_height)
        return true;
    /* below <= lateral tan(angle between the normals), squared; the angle is less than 90 degrees */
    vec3 n = direction_decode_unnormalized(normal_code);
    float d = vec3_dot(n, disc->normal), square = d * d;
    float lateral_squared = vec3_dot(offset, offset) - height * height;
    return below > 0.0f && below * below * square <= lateral_squared * (vec3_dot(n, n) - square);
}

/* Adds to a sum of offsets, modulo 2^32: it overflows where photons move while they are read, which those in a file
 * that is overwritten do. */
static inline void photon_disc_add_offset(photon_disc_sums *sums, int axis, int32_t offset)
{
    sums->offset[axis] = (int32_t)((uint32_t)sums->offset[axis] + (uint32_t)offset);
}

/* An offset as an integer; as in the vector kernels INT32_MIN where it is none, as of a photon that has moved. */
static inline int32_t photon_disc_offset(float units) { return fabsf(units) < 0x1p31f ? (int32_t)units : INT32_MIN; }

/* Adds a photon to the sums. */
static inline void photon_disc_add(const photon_disc *disc, uint32_t index, photon_disc_sums *sums)
{
    uint32_t code = photon_block_flux(disc->blocks, index);
    uint32_t below = (uint32_t)(disc->flux_exponent_max - flux_exponent(code));
    for (int c = 0; c < 3 && below < 64; c++) /* fainter photons add 0 */
        sums->flux[c] += (int64_t)((uint64_t)(code >> (16 - 8 * c) & 255) << 32 >> below);
    vec3 offset = vec3_sub(photon_block_position(disc->blocks, index), disc->position);
    float scale = PHOTON_DISC_OFFSET_UNIT / disc->radius;
    photon_disc_add_offset(sums, 0, photon_disc_offset(offset.x * scale));
    photon_disc_add_offset(sums, 1, photon_disc_offset(offset.y * scale));
    photon_disc_add_offset(sums, 2, photon_disc_offset(offset.z * scale));
}

extern const disc_kernels disc_kernels_plain;

/* Return NULL where the compiler or the processor does not support these instructions. */
const disc_kernels *disc_kernels_avx2(void);
const disc_kernels *disc_kernels_avx512(void); /* F, BW, DQ and VL, POPCNT and BMI2 */

/* Returns the fastest kernels that this processor supports. */
const disc_kernels *disc_kernels_best(void);

#endif
