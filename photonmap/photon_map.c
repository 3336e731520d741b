/* photon_map.c: see photon_map.h.
 * Threads: see photon_map.h. */
#include "photon_map.h"

#include "lookup_kernels.h"
#include "parallel_for.h"
#include "photon_survey.h"
#include "quarter_octave.h"
#include "rays/transmittance.h"
#include "status.h"

#include <stdlib.h>
#include <string.h>

/* The automatic radius: this many times what an estimate needs where the light is spread evenly. Darker regions then
 * take the photons of the whole disc, which is right, only noisier. */
static const float RADIUS_FACTOR = 4.0f;
/* Behind a glass on a plain of kilometres the discs of a caustic are a millionth of what its photons' number lets
 * expect. So the smallest disc, which is a safeguard against photons at one point, is as small as a slot allows:
 * between the estimate on it and a thousandth of a photon on the largest disc lie these octaves. */
enum { IRRADIANCE_OCTAVES = 64, OCTAVES_OF_A_THOUSAND = 10 };
/* A steady map's largest exponent of flux is a multiple of this: photons of another brightness seldom change it. */
enum { STEADY_EXPONENTS = 4 };

/* Where most of the scene is dark, its area does not tell how far apart the photons lie. Estimates need no more than
 * this many times the radius of the median photon's. */
static const float MEDIAN_FACTOR = 4.0f;
/* Half of the photons may lie at one point, a share of the largest radius that is no use. */
static const float LEAST_MEDIAN = 0x1p-16f;

/* The radius of the estimate at a photon: max_radius where it has no k neighbours. */
static float radius_at(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch)
{
    float other_squared;
    uint32_t found = photon_tree_k_nearest(&map->tree, position, normal, PHOTON_ESTIMATE_MIN_COS, map->max_radius,
                                           map->nearest + 1, scratch, &other_squared);
    return found == map->nearest + 1 ? sqrtf(photon_neighbor_distance_squared(scratch[map->nearest])) : map->max_radius;
}

static ag_status bound_radii(photon_map *map)
{
    float radius[PHOTON_SURVEY_MAX];
    uint32_t count;
    AG_TRY(photon_survey(map, radius_at, radius, &count));
    float median = fmaxf(radius[count / 2], LEAST_MEDIAN * map->max_radius);
    if (map->is_steady)
        median = quarter_octave_nearest(median);
    map->mean_radius = fminf(map->mean_radius, MEDIAN_FACTOR * median);
    map->max_radius = fminf(map->max_radius, RADIUS_FACTOR * map->mean_radius);
    return AG_OK;
}

/* Against photons that coincide, which have no area of their own. */
static float smallest_radius(const photon_map *map)
{
    int octaves = IRRADIANCE_OCTAVES - OCTAVES_OF_A_THOUSAND - 1 - ilogbf((float)map->nearest + 1.0f);
    if (map->is_steady)
        octaves -= STEADY_EXPONENTS - 1;
    return ldexpf(map->max_radius, -(octaves / 2));
}

/* The least multiple of STEADY_EXPONENTS that is no smaller. */
static int steady_exponent(int exponent)
{
    int below = exponent & (STEADY_EXPONENTS - 1);
    return below > 0 ? exponent - below + STEADY_EXPONENTS : exponent;
}

/* An irradiance photon stands for points up to this share of the largest disc's radius away. The light through the
 * nearest photon is right in the mean as long as the disc around the point that holds no photon lies within the
 * photon's own, which ends here. Where the empty disc is larger, an estimate at the point is too low by what estimates
 * at other points are too high, so that the mean is right: for n photons a disc, by exp(-n / 4) / 4 of n. */
static const float NEAREST_SHARE = 0.5f;

static float nearest_reach(const photon_map *map) { return NEAREST_SHARE * map->max_radius; }

ag_status photon_map_create(run_context *run, photon_set *set, const photon_map_settings *settings,
                            double progress_begin, double progress_end, photon_map *out_map)
{
    photon_map map = {
        .set = *set, .nearest = settings->nearest, .surfaces = settings->surfaces, .is_steady = settings->is_steady};
    *set = (photon_set){0};
    *out_map = (photon_map){0};
    float density = settings->surface_area > 0.0f ? (float)map.set.count / settings->surface_area : 0.0f;
    map.mean_radius = density > 0.0f ? sqrtf((float)map.nearest / (AG_PI * density)) : 0.0f;
    if (map.is_steady)
        map.mean_radius = quarter_octave_nearest(map.mean_radius);
    map.max_radius = settings->max_radius > 0.0f ? settings->max_radius : RADIUS_FACTOR * map.mean_radius;
    if (settings->max_radius == 0.0f && settings->radius_bound > 0.0f)
        map.max_radius = fminf(map.max_radius, settings->radius_bound);
    if (map.mean_radius > map.max_radius)
        map.mean_radius = map.max_radius;
    if (map.set.count == 0) {
        *out_map = map;
        return AG_OK;
    }
    photon *records = map.set.photons;
    map.set.photons = NULL;
    map.blocks = (photon_block *)(void *)records;
    ag_status status = photon_tree_build(run, records, map.set.count, progress_begin, progress_end, &map.tree);
    map.irradiance_photons = map.tree;
    if (status == AG_OK && settings->max_radius == 0.0f && !(settings->radius_bound > 0.0f))
        status = bound_radii(&map);
    if (status == AG_OK && settings->irradiance_fraction > 0.0f && settings->irradiance_fraction < 1.0f)
        status = irradiance_photons_create(run, &map.tree, settings->irradiance_fraction, nearest_reach(&map),
                                           PHOTON_NEAREST_MIN_COS, progress_end, &map.irradiance_photons);
    if (status == AG_OK && map.is_steady) {
        map.reaches = calloc(map.irradiance_photons.count, sizeof *map.reaches);
        status = map.reaches ? AG_OK : AG_ERROR_MEMORY;
    }
    if (status != AG_OK) {
        photon_map_reset(&map);
        return status;
    }
    float min_radius = smallest_radius(&map);
    map.min_radius_squared = min_radius * min_radius;
    map.flux_exponent_max = FLUX_EXPONENT_MIN;
    for (uint32_t i = 0; i < map.set.count; i++) {
        if ((i & 0xffff) == 0 && run_is_cancelled(run)) {
            photon_map_reset(&map);
            return AG_CANCELLED;
        }
        uint32_t code = photon_block_flux(map.blocks, i);
        int exponent = flux_exponent(code);
        if (code != 0 && exponent > map.flux_exponent_max)
            map.flux_exponent_max = exponent;
    }
    if (map.is_steady)
        map.flux_exponent_max = steady_exponent(map.flux_exponent_max);
    /* The largest estimate: all k photons of the largest flux on the smallest disc; its mantissa's exponent is 63's. */
    double largest = 255.0 * ldexp(1.0, map.flux_exponent_max) * (map.nearest + 1.0) /
                     ((double)map.set.emitted_paths * (double)AG_PI * (double)map.min_radius_squared);
    photon_map_derive(&map, shared_exponent_of((float)fmin(largest, 1e38)) - 63);
    *out_map = map;
    return AG_OK;
}

/* An irradiance is rejected where this many photons, on average, would lie nearer to the point than its own. */
static const double EMPTY_DISC_PHOTONS = 8.0;

/* Rounding in float brings no product below this share of the limit past the limit itself. */
static const double SURELY = 0.999;

static double photons_each(const photon_map *map)
{
    return photon_map_all_have_irradiance(map) ? 1.0 : (double)map->set.count / (double)map->irradiance_photons.count;
}

void photon_map_derive(photon_map *map, int irradiance_bias)
{
    map->irradiance_bias = irradiance_bias;
    for (int i = 0; i < 64; i++)
        map->irradiance_unit[i] = ldexpf(1.0f, i + irradiance_bias);
    map->surely_reaches =
        (float)(SURELY * EMPTY_DISC_PHOTONS * photons_each(map) / ((double)AG_PI * (double)map->set.emitted_paths));
}

/* Unused lanes of the last block are left out: but for their positions nothing is set there. */
static void add_blocks_hash(const photon_block *blocks, uint32_t photon_count, hash128 *in_out_hash)
{
    for (uint32_t i = 0; i < photon_count; i += PHOTON_BLOCK_LANES) {
        const photon_block *b = &blocks[i / PHOTON_BLOCK_LANES];
        size_t lanes = photon_count - i < PHOTON_BLOCK_LANES ? photon_count - i : PHOTON_BLOCK_LANES;
        for (int axis = 0; axis < 3; axis++)
            hash128_add(in_out_hash, b->position[axis], lanes * sizeof b->position[0][0]);
        hash128_add(in_out_hash, b->flux, lanes * sizeof b->flux[0]);
        hash128_add(in_out_hash, b->direction, lanes * sizeof b->direction[0]);
        hash128_add(in_out_hash, b->normal, lanes * sizeof b->normal[0]);
    }
}

void photon_map_add_hash(const photon_map *map, hash128 *in_out_hash)
{
    HASH128_ADD(in_out_hash, map->set.emitted_paths);
    HASH128_ADD(in_out_hash, map->set.count);
    add_blocks_hash(map->blocks, map->set.count, in_out_hash);
    HASH128_ADD(in_out_hash, map->irradiance_photons.count);
    if (!photon_map_all_have_irradiance(map))
        add_blocks_hash(map->irradiance_photons.blocks, map->irradiance_photons.count, in_out_hash);
}

void photon_map_reset(photon_map *map)
{
    if (!map->is_borrowed) {
        if (!photon_map_all_have_irradiance(map)) {
            free(map->irradiance_photons.blocks);
            photon_tree_reset(&map->irradiance_photons);
        }
        free(map->blocks);
        photon_tree_reset(&map->tree);
    }
    map->tree = map->irradiance_photons = (photon_tree){0};
    map->blocks = NULL;
    free(map->reaches);
    map->reaches = NULL;
    photon_map_drop_spaces(map);
    photon_set_reset(&map->set);
}

uint64_t photon_map_count_ready(const photon_map *map)
{
    uint64_t ready = 0;
    for (uint32_t i = 0; i < map->irradiance_photons.count; i++)
        ready += irradiance_word_is_ready(irradiance_slot_read(photon_map_slot(map, i)));
    return ready;
}

uint64_t photon_map_bytes(const photon_map *map)
{
    uint64_t bytes = photon_block_count(map->set.count) * sizeof(photon_block) + photon_tree_bytes(&map->tree);
    if (!photon_map_all_have_irradiance(map))
        bytes += photon_block_count(map->irradiance_photons.count) * sizeof(photon_block) +
                 photon_tree_bytes(&map->irradiance_photons);
    if (map->reaches)
        bytes += map->irradiance_photons.count * sizeof *map->reaches;
    if (map->spaces)
        bytes += clear_spaces_bytes(photon_block_count(map->set.count));
    return bytes;
}

/* Discs of estimates, which are the largest thing to be asked for, mostly reach so far. */
static const float SPACE_RADII = 3.0f;

uint64_t photon_map_spaces_bytes(const scene *s, uint64_t photon_count)
{
    return photon_count > 0 && clear_space_is_told(s) ? clear_spaces_bytes(photon_block_count(photon_count)) : 0;
}

void photon_map_make_spaces(photon_map *map, uint64_t spare)
{
    if (map->spaces || !map->surfaces || photon_map_spaces_bytes(map->surfaces, map->set.count) == 0)
        return;
    map->spaces = clear_spaces_create(map->surfaces, map->blocks, photon_block_count(map->set.count),
                                      SPACE_RADII * map->mean_radius);
    /* a limit of memory counts what is reserved, too; without spaces the picture is the same */
    void *volatile later = malloc((size_t)spare); /* volatile: or the compiler takes it to succeed */
    if (!later)
        photon_map_drop_spaces(map);
    free(later);
}

void photon_map_drop_spaces(photon_map *map)
{
    free(map->spaces);
    map->spaces = NULL;
}

uint32_t photon_map_scratch_count(const photon_map *map) { return photon_neighbors_capacity(map->nearest + 1); }

/* Lines from a point to a photon. */
typedef struct sight {
    vec3 position, normal, at, its_normal;
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
    out->at = photon_block_position(blocks, index);
    out->its_normal = direction_decode(photon_block_normal(blocks, index));
    out->distance = sqrtf(vec3_distance_squared(position, out->at));
    out->bulge = 0.125f * sqrtf(vec3_distance_squared(normal, out->its_normal));
    out->space = NULL;
    if (!map->spaces)
        return;
    uint32_t photon_index = blocks == map->blocks ? index : photon_map_index(map, index);
    out->space = clear_spaces_get(map->spaces, photon_index / PHOTON_BLOCK_LANES, &out->spare);
}

/* Whether the line is blocked at this share of its length above the surface. */
static bool is_blocked_above(const photon_map *map, const sight *line, float share, uint64_t *in_out_rays)
{
    float lift = line->distance * (share + line->bulge);
    vec3 from = vec3_add_scaled(line->position, line->normal, lift),
         to = vec3_add_scaled(line->at, line->its_normal, lift);
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

bool photon_map_is_beyond_gap(const photon_map *map, const photon_block *blocks, vec3 position, vec3 normal,
                              uint32_t index, uint64_t *in_out_rays)
{
    sight line;
    sight_make(map, blocks, position, normal, index, &line);
    return is_blocked_above(map, &line, WALL_SHARE, in_out_rays) ||
           is_blocked_above(map, &line, GAP_SHARE, in_out_rays);
}

/* An irradiance photon higher or lower than the point by this share of its distance may lie on a board or a frame. */
static const float LEVEL_SLOPE = 0.1f;

/* A distance in mean spacings of the irradiance photons. */
static const float FAR_SPACINGS = 1.4f;

float photon_map_far(const photon_map *map)
{
    float photons_each = (float)map->set.count / (float)map->irradiance_photons.count;
    if (map->is_steady)
        photons_each = quarter_octave_nearest(photons_each);
    return FAR_SPACINGS * map->mean_radius * sqrtf(photons_each / (float)map->nearest);
}

/* The irradiance photon found, or PHOTON_HIDDEN where it does not stand for the point. far: photon_map_far, a division
 * and a root for all points. */
static uint32_t in_sight(const photon_map *map, float far, vec3 position, vec3 normal, uint32_t found,
                         float distance_squared, uint64_t *in_out_rays)
{
    if (found == PHOTON_NONE || !map->surfaces)
        return found;
    float height = vec3_dot(vec3_sub(photon_block_position(map->irradiance_photons.blocks, found), position), normal);
    if (distance_squared <= far * far && height * height <= LEVEL_SLOPE * LEVEL_SLOPE * distance_squared)
        return found;
    return photon_map_is_beyond_gap(map, map->irradiance_photons.blocks, position, normal, found, in_out_rays)
               ? PHOTON_HIDDEN
               : found;
}

uint32_t photon_map_nearest(const photon_map *map, vec3 position, vec3 normal, uint64_t *in_out_rays)
{
    float d;
    uint32_t found =
        photon_tree_nearest(&map->irradiance_photons, position, normal, PHOTON_NEAREST_MIN_COS, nearest_reach(map), &d);
    return in_sight(map, photon_map_far(map), position, normal, found, d, in_out_rays);
}

void photon_map_nearest_many(const photon_map *map, photon_walk *walk, const photon_lookup *lookups, uint32_t count,
                             uint64_t *in_out_rays, uint32_t *out_irradiance_photons, float *out_distances_squared)
{
    const float far = photon_map_far(map);
    photon_neighbor nearest[PHOTON_LOOKUPS_MAX];
    photon_walk_nearest_many(walk, lookups, count, PHOTON_NEAREST_MIN_COS, nearest_reach(map), nearest);
    for (uint32_t i = 0; i < count; i++) {
        out_distances_squared[i] = photon_neighbor_distance_squared(nearest[i]);
        out_irradiance_photons[i] = in_sight(map, far, lookups[i].position, lookups[i].normal,
                                             photon_neighbor_index(nearest[i]), out_distances_squared[i], in_out_rays);
    }
}

bool photon_map_reaches(const photon_map *map, uint32_t irradiance_photon, float distance_squared, rgb irradiance)
{
    float flux = flux_largest(photon_block_flux(map->blocks, photon_map_index(map, irradiance_photon)));
    float largest = rgb_max(irradiance);
    if (largest * distance_squared < map->surely_reaches * flux)
        return true; /* mostly; without a division */
    double in_disc = (double)largest * (double)AG_PI * (double)distance_squared;
    return in_disc <= EMPTY_DISC_PHOTONS * photons_each(map) * ((double)flux / (double)map->set.emitted_paths);
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

uint32_t photon_map_encode_irradiance(const photon_map *map, rgb irradiance, uint64_t key)
{
    float largest = rgb_max(irradiance);
    if (!(largest > 0.0f))
        return 0;
    int exponent = shared_exponent_of(largest) - map->irradiance_bias;
    if (exponent < 0)
        exponent = 0;
    if (exponent > 63)
        exponent = 63;
    uint32_t value = (uint32_t)exponent << 24 |
                     shared_mantissas(irradiance, exponent + map->irradiance_bias, hash_mix64(key ^ 0x69727261u));
    return value == PHOTON_NO_IRRADIANCE ? value - 1 : value;
}

rgb photon_map_decode_irradiance(const photon_map *map, uint32_t value)
{
    float scale = map->irradiance_unit[value >> 24 & 63];
    return (rgb){(float)(value >> 16 & 255) * scale, (float)(value >> 8 & 255) * scale, (float)(value & 255) * scale};
}
