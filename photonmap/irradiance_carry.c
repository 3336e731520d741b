/* irradiance_carry.c: see irradiance_carry.h.
 * Each photon is looked for in the leaves of the other map's tree that its position leads to: there are several where
 * it lies on planes of the tree, as those of a wall do. */
#include "irradiance_carry.h"

#include "irradiance_estimate.h"
#include "parallel_for.h"
#include "photon_query.h"
#include "status.h"

#include <stdlib.h>
#include <string.h>

enum { PHOTONS_AT_ONCE = 4096, BITS = 32 };
/* No photon is looked for in more leaves: where very many lie at one point, some that are there count as changed, which
 * costs their irradiances and no more. */
enum { LEAVES_MOST = 32 };
/* Of discs that contain this many changed photons on average, one in three thousand contains none. */
static const double CHANGES_MOST = 8.0;

/* --- which photons are in both maps --- */

/* A search for photons of one position and normal. */
typedef struct same_place {
    const photon_tree *tree;
    float position[PHOTON_TREE_AXES];
    uint16_t normal;
    uint32_t leaves, waiting, nodes[PHOTON_TREE_DEPTH_MAX]; /* visited; other sides of planes that it lies on */
} same_place;

static same_place same_place_begin(const photon_tree *tree, vec3 position, uint16_t normal)
{
    return (same_place){tree, {position.x, position.y, position.z}, normal, 0, 1, {0}};
}

/* Goes on to the next leaf that the position leads to. Returns false where there are no more. */
static bool next_leaf(same_place *p, uint32_t *out_block)
{
    const uint32_t leaf_base = (1u << p->tree->depth) - 1;
    if (p->waiting == 0 || p->leaves++ == LEAVES_MOST)
        return false;
    uint32_t node = p->nodes[--p->waiting];
    while (node < leaf_base) {
        photon_tree_node n = photon_tree_node_at(p->tree, node);
        uint32_t is_right = p->position[n.axis] >= n.split;
        if (p->position[n.axis] == n.split)
            p->nodes[p->waiting++] = 2 * node + 1;
        node = 2 * node + 1 + is_right;
    }
    *out_block = node - leaf_base;
    return true;
}

/* The lanes of a block that hold a photon of that position and normal, as bits. */
static uint32_t lanes_alike(const same_place *p, uint32_t block)
{
    const photon_block *b = &p->tree->blocks[block];
    uint32_t at[3], there[PHOTON_BLOCK_LANES], alike = photon_block_with_normal(b, p->normal);
    memcpy(at, p->position, sizeof at);
    for (int a = 0; a < 3 && alike; a++) {
        memcpy(there, b->position[a], sizeof there); /* as bits: 0 and -0 are not the same */
        for (uint32_t i = 0; i < PHOTON_BLOCK_LANES; i++)
            alike &= ~((uint32_t)(there[i] != at[a]) << i);
    }
    return alike;
}

typedef struct match_job {
    const run_context *run;
    const photon_map *before, *map;
    atomic_u32 *found_before, *found; /* a bit for each photon: it is in both */
} match_job;

/* Finds for a photon one of the map before that has the same 20 bytes. Returns false where none is left. */
static bool match(const match_job *job, const photon_block *own, uint32_t lane)
{
    vec3 position = {own->position[0][lane], own->position[1][lane], own->position[2][lane]};
    same_place p = same_place_begin(&job->before->tree, position, own->normal[lane]);
    for (uint32_t block; next_leaf(&p, &block);)
        for (uint32_t alike = lanes_alike(&p, block); alike; alike &= alike - 1) {
            uint32_t k = (uint32_t)__builtin_ctz(alike), index = block * PHOTON_BLOCK_LANES + k,
                     bit = 1u << index % BITS;
            const photon_block *b = &job->before->blocks[block];
            if (b->flux[k] == own->flux[lane] && b->direction[k] == own->direction[lane] &&
                !(fetch_or_relaxed_u32(&job->found_before[index / BITS], bit) & bit)) /* else another one has it */
                return true;
        }
    return false;
}

static void match_block(void *user, uint64_t begin, uint64_t end, uint64_t block_index, unsigned worker)
{
    (void)block_index, (void)worker;
    const match_job *job = user;
    if (run_is_cancelled(job->run))
        return;
    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++)
        if (match(job, &job->map->blocks[i / PHOTON_BLOCK_LANES], i % PHOTON_BLOCK_LANES))
            fetch_or_relaxed_u32(&job->found[i / BITS], 1u << i % BITS);
}

static uint64_t count_missing(const atomic_u32 *found, uint32_t count)
{
    uint64_t missing = count;
    for (uint32_t i = 0; i <= count / BITS; i++)
        missing -= (uint64_t)__builtin_popcount(load_relaxed_u32(&found[i]));
    return missing;
}

/* Appends the photons of a map that the other has not. Returns where the next one would go. */
static photon *append_missing(const photon_map *map, const atomic_u32 *found, photon *out)
{
    for (uint32_t i = 0; i < map->set.count; i++) {
        if (load_relaxed_u32(&found[i / BITS]) >> i % BITS & 1)
            continue;
        vec3 at = photon_block_position(map->blocks, i);
        *out = (photon){.position = {at.x, at.y, at.z}, .normal = photon_block_normal(map->blocks, i)};
        out++;
    }
    return out;
}

/* --- the photons that came or went, in a tree of their own --- */

/* Photons that an estimate neither sums nor takes for a sign of an edge face the other way, by more than 120 degrees;
 * the cosine's square is a little more than a quarter here, for rounding. */
static const float BEHIND_COS_SQUARED = 0.26f;

static bool is_behind(uint16_t code, vec3 normal)
{
    vec3 n = direction_decode_unnormalized(code);
    float d = vec3_dot(n, normal);
    return d < 0.0f && d * d > BEHIND_COS_SQUARED * vec3_length_squared(n);
}

/* Whether a photon that came or went lies within the reach. */
static bool is_changed(const photon_tree *changes, vec3 position, vec3 normal, float reach_squared)
{
    photon_query q;
    uint32_t block;
    float limit = photon_query_hair_beyond(reach_squared);
    if (changes->count == 0)
        return false;
    photon_query_init(&q, changes, position, normal, 0.0f);
    q.stack[0] = (photon_visit){photon_lanes_fill(0.0f), 0.0f, 0};
    q.visits = 1;
    while (photon_query_next_leaf(&q, limit, &block)) {
        _Alignas(16) float d[PHOTON_BLOCK_LANES];
        uint32_t within = photon_block_within(&changes->blocks[block], q.position, limit, d);
        for (; within; within &= within - 1)
            if (!is_behind(changes->blocks[block].normal[__builtin_ctz(within)], normal))
                return true;
    }
    return false;
}

/* Photons that came or went: a tree over them, and the records that its blocks are. */
typedef struct photon_changes {
    photon *records; /* owned; NULL where there are none */
    photon_tree tree;
    bool are_few; /* else there is no tree, and nothing is worth carrying */
} photon_changes;

static void photon_changes_reset(photon_changes *changes)
{
    photon_tree_reset(&changes->tree);
    free(changes->records);
    *changes = (photon_changes){0};
}

/* Makes the tree of the photons that are in one of two matched maps alone. */
static ag_status gather_changes(run_context *run, const match_job *matched, photon_changes *out_changes,
                                irradiance_carry *out)
{
    out->came = count_missing(matched->found, matched->map->set.count);
    out->went = count_missing(matched->found_before, matched->before->set.count);
    uint64_t all = out->came + out->went;
    out_changes->are_few =
        (double)all * matched->map->nearest <= CHANGES_MOST * (double)matched->map->set.count && all < PHOTON_NONE;
    if (!out_changes->are_few || all == 0)
        return AG_OK;
    out_changes->records = photon_records_create((uint32_t)all);
    if (!out_changes->records)
        return AG_ERROR_MEMORY;
    photon *next = append_missing(matched->map, matched->found, out_changes->records);
    append_missing(matched->before, matched->found_before, next);
    return photon_tree_build(run, out_changes->records, (uint32_t)all, 0.0, 0.0, &out_changes->tree);
}

/* Finds the photons that came or went. *out_changes is to be reset, on failure too. */
static ag_status find_changes(run_context *run, const photon_map *before, const photon_map *map,
                              photon_changes *out_changes, irradiance_carry *out)
{
    match_job job = {run, before, map, NULL, NULL};
    *out_changes = (photon_changes){0};
    job.found_before = calloc(before->set.count / BITS + 1, sizeof *job.found_before);
    job.found = calloc(map->set.count / BITS + 1, sizeof *job.found);
    ag_status status = job.found_before && job.found ? AG_OK : AG_ERROR_MEMORY;
    if (status == AG_OK)
        status = parallel_for(run, map->set.count, PHOTONS_AT_ONCE, match_block, &job, AG_PHASE_MAP, 0.0, 0.0);
    if (status == AG_OK && run_is_cancelled(run))
        status = AG_CANCELLED;
    if (status == AG_OK)
        status = gather_changes(run, &job, out_changes, out);
    free(job.found_before);
    free(job.found);
    return status;
}

/* --- carrying --- */

typedef struct carry_job {
    const run_context *run;
    const photon_map *before;
    photon_map *map;
    const photon_tree *changes;
    const scene_difference *difference;
    atomic_u64 kept;
} carry_job;

/* A ready word of the map before for an irradiance photon's place, and its reach; 0: there is none that is of use. */
static uint32_t word_before(const photon_map *before, vec3 position, uint16_t normal, float *out_reach_squared)
{
    same_place p = same_place_begin(&before->irradiance_photons, position, normal);
    for (uint32_t block; next_leaf(&p, &block);)
        for (uint32_t alike = lanes_alike(&p, block); alike; alike &= alike - 1) {
            uint32_t index = block * PHOTON_BLOCK_LANES + (uint32_t)__builtin_ctz(alike);
            uint32_t word = irradiance_slot_read(photon_map_slot(before, index));
            *out_reach_squared = before->reaches_squared[index];
            if (irradiance_word_is_ready(word) && *out_reach_squared > 0.0f)
                return word;
        }
    return 0;
}

static void carry_block(void *user, uint64_t begin, uint64_t end, uint64_t block_index, unsigned worker)
{
    (void)block_index, (void)worker;
    carry_job *job = user;
    const photon_block *blocks = job->map->irradiance_photons.blocks;
    const float rays = IRRADIANCE_REACH_OF_RAYS * IRRADIANCE_REACH_OF_RAYS;
    uint64_t kept = 0;
    if (run_is_cancelled(job->run))
        return;
    for (uint32_t i = (uint32_t)begin; i < (uint32_t)end; i++) {
        vec3 position = photon_block_position(blocks, i);
        uint16_t code = photon_block_normal(blocks, i);
        float reach_squared;
        uint32_t word = word_before(job->before, position, code, &reach_squared);
        if (!word || is_changed(job->changes, position, direction_decode(code), reach_squared) ||
            scene_difference_is_near(job->difference, position, rays * reach_squared))
            continue;
        job->map->reaches_squared[i] = reach_squared;
        store_relaxed_u32(photon_map_slot(job->map, i), word); /* the cache that reads it comes later */
        kept++;
    }
    fetch_add_relaxed_u64(&job->kept, kept);
}

/* Whether estimates of both maps sum, scale, bound and round alike. */
static bool are_alike(const photon_map *a, const photon_map *b)
{
    return a->is_steady && b->is_steady && a->reaches_squared && b->reaches_squared && a->set.count > 0 &&
           b->set.count > 0 && a->set.emitted_paths == b->set.emitted_paths && a->nearest == b->nearest &&
           a->max_radius == b->max_radius && a->min_radius_squared == b->min_radius_squared &&
           a->mean_radius == b->mean_radius && a->flux_exponent_max == b->flux_exponent_max &&
           a->irradiance_bias == b->irradiance_bias && photon_map_sight_distance(a) == photon_map_sight_distance(b);
}

ag_status irradiance_carry_over(run_context *run, const photon_map *before, const scene_difference *difference,
                                photon_map *map, irradiance_carry *out_carry)
{
    *out_carry = (irradiance_carry){0};
    if (!difference->is_known || !are_alike(before, map))
        return AG_OK;
    photon_changes changes;
    ag_status status = find_changes(run, before, map, &changes, out_carry);
    if (status == AG_OK && changes.are_few) {
        carry_job job = {run, before, map, &changes.tree, difference, 0};
        map->has_been_cached = true;
        status = parallel_for(run, map->irradiance_photons.count, PHOTONS_AT_ONCE, carry_block, &job, AG_PHASE_MAP, 0.0,
                              0.0);
        if (status == AG_OK && run_is_cancelled(run))
            status = AG_CANCELLED;
        out_carry->kept = load_relaxed_u64(&job.kept);
    }
    photon_changes_reset(&changes);
    return status;
}
