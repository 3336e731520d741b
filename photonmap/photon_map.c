/* photon_map.c: see photon_map.h.
 * Threads: see photon_map.h. */
#include "photon_map.h"

#include "photon_survey.h"
#include "quarter_octave.h"
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
    float median = float_max(radius[count / 2], LEAST_MEDIAN * map->max_radius);
    if (map->is_steady)
        median = quarter_octave_nearest(median);
    map->mean_radius = float_min(map->mean_radius, MEDIAN_FACTOR * median);
    map->max_radius = float_min(map->max_radius, RADIUS_FACTOR * map->mean_radius);
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

/* The radius of an estimate's disc, if the photons were spread evenly over the scene's area. */
static float even_radius(const photon_map_settings *settings, uint32_t count)
{
    float density = settings->surface_area > 0.0f ? (float)count / settings->surface_area : 0.0f;
    float radius = density > 0.0f ? sqrtf((float)settings->nearest / (AG_PI * density)) : 0.0f;
    return settings->is_steady ? quarter_octave_nearest(radius) : radius;
}

float photon_map_largest_radius(const photon_map_settings *settings, uint32_t count)
{
    if (settings->max_radius > 0.0f)
        return settings->max_radius;
    float radius = RADIUS_FACTOR * even_radius(settings, count);
    return settings->radius_bound > 0.0f ? float_min(radius, settings->radius_bound) : radius;
}

/* Sets the radii that follow from the settings, and from the density of photons on the scene's area. */
static void set_radii(photon_map *map, const photon_map_settings *settings)
{
    map->max_radius = photon_map_largest_radius(settings, map->set.count);
    map->mean_radius = float_min(even_radius(settings, map->set.count), map->max_radius);
}

/* Builds the tree from the set's records, which become the blocks; and what estimates and lookups need of it. */
static ag_status build_trees(run_context *run, photon_map *map, const photon_map_settings *settings,
                             double progress_begin, double progress_end)
{
    photon *records = map->set.photons;
    map->set.photons = NULL;
    map->blocks = (photon_block *)(void *)records;
    AG_TRY(photon_tree_build(run, records, map->set.count, progress_begin, progress_end, &map->tree));
    map->irradiance_photons = map->tree;
    if (settings->max_radius == 0.0f && !(settings->radius_bound > 0.0f)) {
        AG_TRY(bound_radii(map));
    }
    if (settings->irradiance_fraction > 0.0f && settings->irradiance_fraction < 1.0f) {
        AG_TRY(irradiance_photons_create(run, &map->tree, settings->irradiance_fraction, photon_map_nearest_radius(map),
                                         PHOTON_NEAREST_MIN_COS, progress_end, &map->irradiance_photons));
    }
    if (map->is_steady) {
        map->reaches_squared = calloc(map->irradiance_photons.count, sizeof *map->reaches_squared);
        if (!map->reaches_squared)
            return AG_ERROR_MEMORY;
    }
    return AG_OK;
}

/* Finds the unit of sums and that of irradiances, by the strongest photons and the smallest disc. */
static ag_status set_units(const run_context *run, photon_map *map)
{
    float min_radius = smallest_radius(map);
    map->min_radius_squared = min_radius * min_radius;
    map->flux_exponent_max = FLUX_EXPONENT_MIN;
    for (uint32_t i = 0; i < map->set.count; i++) {
        if ((i & 0xffff) == 0 && run_is_cancelled(run))
            return AG_CANCELLED;
        uint32_t code = photon_block_flux(map->blocks, i);
        int exponent = flux_exponent(code);
        if (code != 0 && exponent > map->flux_exponent_max)
            map->flux_exponent_max = exponent;
    }
    if (map->is_steady)
        map->flux_exponent_max = steady_exponent(map->flux_exponent_max);
    /* The largest estimate has all k photons of the largest flux on the smallest disc. It is given 63, a slot's largest
     * exponent. */
    double largest = 255.0 * ldexp(1.0, map->flux_exponent_max) * (map->nearest + 1.0) /
                     ((double)map->set.emitted_paths * (double)AG_PI * (double)map->min_radius_squared);
    photon_map_derive(map, shared_exponent_of((float)double_min(largest, 1e38)) - 63);
    return AG_OK;
}

ag_status photon_map_create(run_context *run, photon_set *set, const photon_map_settings *settings,
                            double progress_begin, double progress_end, photon_map *out_map)
{
    photon_map map = {
        .set = *set, .nearest = settings->nearest, .surfaces = settings->surfaces, .is_steady = settings->is_steady};
    *set = (photon_set){0};
    *out_map = (photon_map){0};
    set_radii(&map, settings);
    if (map.set.count > 0) {
        ag_status status = build_trees(run, &map, settings, progress_begin, progress_end);
        if (status == AG_OK)
            status = set_units(run, &map);
        if (status != AG_OK) {
            photon_map_reset(&map);
            return status;
        }
    }
    *out_map = map;
    return AG_OK;
}

/* An irradiance is rejected where this many photons, on average, would lie nearer to the point than its own. */
static const double EMPTY_DISC_PHOTONS = 8.0;

/* Rounding in float brings no product below this share of the limit past the limit itself. */
static const double SURELY = 0.999;

/* Returns how many photons there are for each irradiance photon. */
static double photons_per_irradiance_photon(const photon_map *map)
{
    return photon_map_all_have_irradiance(map) ? 1.0 : (double)map->set.count / (double)map->irradiance_photons.count;
}

void photon_map_derive(photon_map *map, int irradiance_bias)
{
    map->irradiance_bias = irradiance_bias;
    for (int i = 0; i < 64; i++)
        map->irradiance_unit[i] = ldexpf(1.0f, i + irradiance_bias);
    map->surely_holds = (float)(SURELY * EMPTY_DISC_PHOTONS * photons_per_irradiance_photon(map) /
                                ((double)AG_PI * (double)map->set.emitted_paths));
}

bool photon_map_may_hold(const photon_map *map, uint32_t irradiance_photon, float distance_squared, rgb irradiance)
{
    float flux = flux_largest(photon_block_flux(map->blocks, photon_map_index(map, irradiance_photon)));
    float largest = rgb_max(irradiance);
    if (largest * distance_squared < map->surely_holds * flux)
        return true; /* mostly; without a division */
    double in_disc = (double)largest * (double)AG_PI * (double)distance_squared;
    return in_disc <=
           EMPTY_DISC_PHOTONS * photons_per_irradiance_photon(map) * ((double)flux / (double)map->set.emitted_paths);
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
    free(map->reaches_squared);
    map->reaches_squared = NULL;
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
    if (map->reaches_squared)
        bytes += map->irradiance_photons.count * sizeof *map->reaches_squared;
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

void photon_map_make_spaces(photon_map *map, uint64_t spare_bytes)
{
    if (map->spaces || !map->surfaces || photon_map_spaces_bytes(map->surfaces, map->set.count) == 0)
        return;
    map->spaces = clear_spaces_create(map->surfaces, map->blocks, photon_block_count(map->set.count),
                                      SPACE_RADII * map->mean_radius);
    /* a limit of memory counts what is reserved, too; without spaces the picture is the same */
    void *volatile later = malloc((size_t)spare_bytes); /* volatile: or the compiler takes it to succeed */
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
