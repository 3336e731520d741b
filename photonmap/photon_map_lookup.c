/* photon_map_lookup.c: which irradiance photon stands for a point, and whether the point sees it; see photon_map.h.
 * Threads: read only, but for the caller's walk. */
#include "photon_map.h"

#include "lookup_kernels.h"
#include "quarter_octave.h"
#include "rays/transmittance.h"

#include <string.h>

/* An irradiance photon stands for points up to this share of the largest disc's radius away. The light through the
 * nearest photon is right in the mean as long as the disc around the point that holds no photon lies within the
 * photon's own, which ends here. Where the empty disc is larger, an estimate at the point is too low by what estimates
 * at other points are too high, so that the mean is right: for n photons a disc, by exp(-n / 4) / 4 of n. */
static const float NEAREST_SHARE = 0.5f;

float photon_map_nearest_radius(const photon_map *map) { return NEAREST_SHARE * map->max_radius; }

/* Lines from a point to a photon, some way above the surface at both. */
typedef struct sight {
    vec3 position, normal, photon_position, photon_normal;
    float distance;
    float bulge; /* what a curved surface bulges between the two, as a share of the distance: on a sphere an eighth of
                    the angle */
    const clear_space *space; /* of the photon's leaf; NULL: none is known */
    clear_space spare;
} sight;

static void sight_make(const photon_map *map, const photon_block *blocks, vec3 position, vec3 normal, uint32_t index,
                       sight *out)
{
    out->position = position, out->normal = normal;
    out->photon_position = photon_block_position(blocks, index);
    out->photon_normal = direction_decode(photon_block_normal(blocks, index));
    out->distance = sqrtf(vec3_distance_squared(position, out->photon_position));
    out->bulge = 0.125f * sqrtf(vec3_distance_squared(normal, out->photon_normal));
    out->space = NULL;
    if (!map->spaces)
        return;
    uint32_t photon_index = blocks == map->blocks ? index : photon_map_index(map, index);
    out->space = clear_spaces_get(map->spaces, photon_index / PHOTON_BLOCK_LANES, &out->spare);
}

/* Returns whether the line is blocked at this share of its length above the surface. */
static bool is_blocked_above(const photon_map *map, const sight *line, float share, uint64_t *in_out_rays)
{
    float lift = line->distance * (share + line->bulge);
    vec3 from = vec3_add_scaled(line->position, line->normal, lift),
         to = vec3_add_scaled(line->photon_position, line->photon_normal, lift);
    if (line->space && clear_space_has_line(map->surfaces, line->space, from, to))
        return false;
    ++*in_out_rays;
    return scene_is_blocked(map->surfaces, scene_ray_make(from, vec3_sub(to, from)), 1.0f);
}

/* Lower things (a carpet, a skirting) are no walls. */
static const float WALL_SHARE = 1.0f / 32.0f;

bool photon_map_is_behind_wall(const photon_map *map, const photon_block *blocks, vec3 position, vec3 normal,
                               uint32_t index, uint64_t *in_out_rays)
{
    sight line;
    sight_make(map, blocks, position, normal, index, &line);
    return is_blocked_above(map, &line, WALL_SHARE, in_out_rays);
}

/* A wall or door may end a little above the surface: what is lit on its one side is not lit on the other. */
static const float GAP_SHARE = 1.0f / 4.0f;

bool photon_map_is_hidden(const photon_map *map, const photon_block *blocks, vec3 position, vec3 normal, uint32_t index,
                          uint64_t *in_out_rays)
{
    sight line;
    sight_make(map, blocks, position, normal, index, &line);
    return is_blocked_above(map, &line, WALL_SHARE, in_out_rays) ||
           is_blocked_above(map, &line, GAP_SHARE, in_out_rays);
}

/* An irradiance photon higher or lower than the point by this share of its distance may lie on a board or a frame. */
static const float SURFACE_SLOPE = 0.1f;

/* A distance in mean spacings of the irradiance photons. */
static const float SIGHT_SPACINGS = 1.4f;

float photon_map_sight_distance(const photon_map *map)
{
    float photons_per_irradiance_photon = (float)map->set.count / (float)map->irradiance_photons.count;
    if (map->is_steady)
        photons_per_irradiance_photon = quarter_octave_nearest(photons_per_irradiance_photon);
    return SIGHT_SPACINGS * map->mean_radius * sqrtf(photons_per_irradiance_photon / (float)map->nearest);
}

/* Returns the irradiance photon found; PHOTON_HIDDEN where the point has to see it, and does not. sight_distance:
 * photon_map_sight_distance, whose division and root are needed once for all points. */
static uint32_t unless_hidden(const photon_map *map, float sight_distance, vec3 position, vec3 normal, uint32_t found,
                              float distance_squared, uint64_t *in_out_rays)
{
    if (found == PHOTON_NONE || !map->surfaces)
        return found;
    float height = vec3_dot(vec3_sub(photon_block_position(map->irradiance_photons.blocks, found), position), normal);
    if (distance_squared <= sight_distance * sight_distance &&
        height * height <= SURFACE_SLOPE * SURFACE_SLOPE * distance_squared)
        return found;
    return photon_map_is_hidden(map, map->irradiance_photons.blocks, position, normal, found, in_out_rays)
               ? PHOTON_HIDDEN
               : found;
}

uint32_t photon_map_nearest(const photon_map *map, vec3 position, vec3 normal, uint64_t *in_out_rays)
{
    float d;
    uint32_t found = photon_tree_nearest(&map->irradiance_photons, position, normal, PHOTON_NEAREST_MIN_COS,
                                         photon_map_nearest_radius(map), &d);
    return unless_hidden(map, photon_map_sight_distance(map), position, normal, found, d, in_out_rays);
}

void photon_map_nearest_many(const photon_map *map, photon_walk *walk, const photon_lookup *lookups, uint32_t count,
                             uint64_t *in_out_rays, uint32_t *out_irradiance_photons, float *out_distances_squared)
{
    const float sight_distance = photon_map_sight_distance(map);
    photon_neighbor nearest[PHOTON_LOOKUPS_MAX];
    photon_walk_nearest_many(walk, lookups, count, PHOTON_NEAREST_MIN_COS, photon_map_nearest_radius(map), nearest);
    for (uint32_t i = 0; i < count; i++) {
        out_distances_squared[i] = photon_neighbor_distance_squared(nearest[i]);
        out_irradiance_photons[i] =
            unless_hidden(map, sight_distance, lookups[i].position, lookups[i].normal,
                          photon_neighbor_index(nearest[i]), out_distances_squared[i], in_out_rays);
    }
}

uint32_t photon_map_leaf(const photon_map *map, vec3 position)
{
    return map->irradiance_photons.count > 0 ? photon_tree_leaf(&map->irradiance_photons, position) : 0;
}

void photon_map_leaves(const photon_map *map, const float *positions, uint32_t stride, uint32_t count,
                       uint32_t *out_leaves)
{
    if (map->irradiance_photons.count > 0)
        lookup_kernels_best()->find_leaves(&map->irradiance_photons, positions, stride, count, out_leaves);
    else
        memset(out_leaves, 0, count * sizeof *out_leaves);
}
