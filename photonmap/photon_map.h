/* photon_map.h: photons, their tree, and the photon whose irradiance represents a point.
 * Rests on: Neilson, Yang, TR 04-21, 2004; Christensen, "Faster Photon Map Global Illumination", 1999 (irradiance at
 * the photons). Flow: photon_tracing, photon_tree -> [here] -> irradiance_estimate, irradiance_cache. Threads: built
 * by one caller on the run's workers; then read-only, but for the slots. */
#ifndef AFTERGLOW_PHOTON_MAP_H
#define AFTERGLOW_PHOTON_MAP_H

#include "clear_spaces.h"
#include "irradiance_photons.h"
#include "math/hash128.h"
#include "photon_tracing.h"
#include "photon_tree.h"

typedef struct photon_map_settings {
    uint32_t nearest;          /* photons of an estimate, >= 1; the paper: 300 */
    float max_radius;          /* of an estimate, scene units; the paper: 3.0; 0: from the density of the map */
    float surface_area;        /* of the scene, m^2: for the automatic radius */
    float radius_bound;        /* the automatic radius is no larger; 0: no bound */
    float irradiance_fraction; /* of the photons that become irradiance photons, (0, 1]; 0: all */
    bool is_steady;            /* see photon_map; the set's paths are fixed (photon_tracing_settings.paths) */
    const scene *surfaces;     /* borrowed: where discs end; NULL: nowhere */
} photon_map_settings;

typedef struct photon_map {
    photon_set set;       /* without its records, which are now the blocks: */
    photon_block *blocks; /* owned, unless is_borrowed; NULL without photons */
    photon_tree tree;     /* over the blocks */
    photon_tree
        irradiance_photons; /* a tree of these photons with their slots; `tree` itself where they are all photons */
    uint32_t nearest;
    float max_radius;
    float min_radius_squared;  /* squared radius of the least area of an estimate, for coincident photons */
    float mean_radius;         /* of an estimate, if the photons were spread evenly */
    int flux_exponent_max;     /* largest exponent of the photons' fluxes: the unit of sums */
    int irradiance_bias;       /* added to a slot's 6-bit exponent */
    float irradiance_unit[64]; /* of a slot's mantissas, by its exponent */
    float surely_holds;    /* photon_map_may_hold is true where irradiance x squared distance is below this x flux */
    const scene *surfaces; /* borrowed, or NULL */
    bool is_borrowed;      /* blocks and nodes are a photon_file's */
    atomic_u8 *checks; /* of a map from a file: irradiance_word_check of each irradiance photon, borrowed; else NULL */
    bool has_been_cached; /* a cache has been made over it: some slots may be ready */
    /* Radii and exponents, on which all estimates depend, are rounded, and an irradiance is rounded by its photon's
     * position, so that both stay the same where a few photons come and go. */
    bool is_steady;
    clear_spaces *spaces;   /* owned, of the leaves of `tree`: they save rays, and change no bit. NULL until a cache is
                               made over the map, where nothing is known of the surfaces, and where memory is short */
    float *reaches_squared; /* owned, of a steady map: of each irradiance photon whose slot is ready the squared reach
                       of its estimate (irradiance_estimate_find_reach); 0: not known */
} photon_map;

/* Returns the largest radius of the estimates of a map of so many photons, scene units, as far as the settings alone
 * bound it. */
float photon_map_largest_radius(const photon_map_settings *settings, uint32_t count);

/* Builds a map from the set's photons, which it takes over, and frees on failure. A map without photons is valid: its
 * irradiance is 0 everywhere. progress: of AG_PHASE_MAP. Errors: AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status photon_map_create(run_context *run, photon_set *set, const photon_map_settings *settings,
                            double progress_begin, double progress_end, photon_map *out_map);
void photon_map_reset(photon_map *map);

/* Adds to a hash which photons the map has, and which of them keep irradiances; not the irradiances themselves. */
void photon_map_add_hash(const photon_map *map, hash128 *in_out_hash);

/* Sets what follows from the rest of a map with photons and from its bias, for a map from a file: the values of
 * irradiance codes, and surely_holds. */
void photon_map_derive(photon_map *map, int irradiance_bias);

/* Returns whether all photons are irradiance photons; else these have blocks and indices of their own. */
static inline bool photon_map_all_have_irradiance(const photon_map *map)
{
    return map->irradiance_photons.blocks == map->blocks;
}

/* Returns the index among all photons of an irradiance photon: that of a photon even where the map's file was
 * overwritten. */
static inline uint32_t photon_map_index(const photon_map *map, uint32_t irradiance_photon)
{
    uint32_t index = photon_map_all_have_irradiance(map)
                         ? irradiance_photon
                         : irradiance_photons_source(&map->irradiance_photons, irradiance_photon);
    return index < map->set.count ? index : 0;
}

static inline irradiance_slot *photon_map_slot(const photon_map *map, uint32_t irradiance_photon)
{
    return photon_block_slot(map->irradiance_photons.blocks, irradiance_photon);
}

/* Returns the number of irradiance photons whose slots are ready. */
uint64_t photon_map_count_ready(const photon_map *map);

/* Returns the bytes of the photons, the irradiance photons, the trees and the clear spaces. */
uint64_t photon_map_bytes(const photon_map *map);

/* Allocates the clear spaces, unless the map has them. It does nothing where the map has no photons or no surfaces,
 * where nothing is known of what is near them (clear_space_is_told), or where fewer than spare_bytes would be left
 * for later allocations. */
void photon_map_make_spaces(photon_map *map, uint64_t spare_bytes);
void photon_map_drop_spaces(photon_map *map);

/* Returns the bytes that photon_map_make_spaces takes for that many photons on the surfaces of s. */
uint64_t photon_map_spaces_bytes(const scene *s, uint64_t photon_count);

/* Returns the number of neighbours that a worker's scratch memory holds. */
uint32_t photon_map_scratch_count(const photon_map *map);

/* The cosine between two normals is at least this. Photons of an estimate lie within 37 degrees: more would give the
 * front of a moulding some of the light on those of its sides that face a window. The photon whose irradiance stands
 * for a point lies within 25 degrees. */
#define PHOTON_ESTIMATE_MIN_COS 0.8f
#define PHOTON_NEAREST_MIN_COS  0.9f

/* Returns whether a surface lies between a surface point, with its normal, and a photon of the blocks. It casts one
 * ray, which is added to *in_out_rays. */
bool photon_map_is_behind_wall(const photon_map *map, const photon_block *blocks, vec3 position, vec3 normal,
                               uint32_t index, uint64_t *in_out_rays);

/* Returns whether a surface lies between a surface point and a photon, as photon_map_is_behind_wall does, or something
 * that ends a little above the surface of both: a door, or a wall with a gap. It casts one or two rays. */
bool photon_map_is_hidden(const photon_map *map, const photon_block *blocks, vec3 position, vec3 normal, uint32_t index,
                          uint64_t *in_out_rays);

/* Returns the distance, scene units, beyond which an irradiance photon must be visible from a point to represent it: in
 * a dark room the nearest irradiance photon may belong to a bright room next door. Of evenly spread photons 1 in 7 is
 * that far; the light that still leaks through a partition decreases with the square of the distance. */
float photon_map_sight_distance(const photon_map *map);

/* Returns the distance, scene units, beyond which no irradiance photon represents a point: half the largest radius. */
float photon_map_nearest_radius(const photon_map *map);

/* A result of photon_map_nearest: the nearest irradiance photon is hidden. */
#define PHOTON_HIDDEN (PHOTON_NONE - 1)

/* Returns the irradiance photon whose irradiance represents a point. PHOTON_NONE: none with a similar normal lies
 * within photon_map_nearest_radius. PHOTON_HIDDEN: the nearest one lies so far away, or so far off the point's tangent
 * plane, that it must be visible, and it is not. The rays cast for that are added to *in_out_rays. */
uint32_t photon_map_nearest(const photon_map *map, vec3 position, vec3 normal, uint64_t *in_out_rays);

/* Returns whether the irradiance, W/m^2, of the photon nearest to a point may hold there, at that squared distance from
 * it. The disc around the point out to that photon is empty; for photons with this one's flux, of the density that the
 * irradiance implies, that has a probability of one in three thousand at the limit. At the edge of a shadow, the
 * photons there are the nearest to points far in the dark, which would otherwise all be as bright as the edge. */
bool photon_map_may_hold(const photon_map *map, uint32_t irradiance_photon, float distance_squared, rgb irradiance);

/* Returns the leaf of the irradiance photons' tree that contains a point: lookups in nearby leaves touch the same
 * memory. */
uint32_t photon_map_leaf(const photon_map *map, vec3 position);

/* photon_map_leaf of many points; x, y, z are consecutive; `stride`: floats from one point to the next. */
void photon_map_leaves(const photon_map *map, const float *positions, uint32_t stride, uint32_t count,
                       uint32_t *out_leaves);

/* photon_map_nearest of many points, in the manner of photon_walk_nearest_many, with the leaves of photon_map_leaf.
 * walk: one over map->irradiance_photons. out_distances_squared: from the points to the photons found. */
void photon_map_nearest_many(const photon_map *map, photon_walk *walk, const photon_lookup *lookups, uint32_t count,
                             uint64_t *in_out_rays, uint32_t *out_irradiance_photons, float *out_distances_squared);

/* The 30 bits of a slot whose photon represents no point, since no estimate holds there. Final, like a value. */
#define PHOTON_NO_IRRADIANCE IRRADIANCE_VALUE_MASK

/* Irradiance as a slot's 30 bits, never PHOTON_NO_IRRADIANCE. The key decides the rounding: an irradiance photon's
 * index, or in a steady map its photon_block_position_key. */
uint32_t photon_map_encode_irradiance(const photon_map *map, rgb irradiance, uint64_t key);
rgb photon_map_decode_irradiance(const photon_map *map, uint32_t value);

#endif
