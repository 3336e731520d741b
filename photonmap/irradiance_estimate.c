/* irradiance_estimate.c: see irradiance_estimate.h. Flux is summed in whole numbers, so its bits do not depend on the
 * order in which photons are found. */
#include "irradiance_estimate.h"

#include "disc_kernels.h"
#include "rays/transmittance.h"
#include "surface_region.h"

/* A photon whose height above or below the tangent plane is more than this share of the disc's radius may lie on
 * another surface: rays tell whether the point sees it. */
static const float FLAT_HEIGHT_SHARE = 1.0f / 32.0f;

/* Photons that crowd to one side of the disc, by more than this share of its radius on average, hint at an edge. */
static const float LOPSIDED = 0.15f;

/* Returns whether the photons crowd to one side. Their offsets count along the point's plane alone, since on a sphere
 * all photons lie below it. */
static bool is_lopsided(const photon_disc_sums *sums, vec3 normal, uint32_t count)
{
    double sum[3], n[3] = {(double)normal.x, (double)normal.y, (double)normal.z}, along = 0.0, square = 0.0;
    for (int a = 0; a < 3; a++) {
        sum[a] = (double)sums->offset[a] * (1.0 / (double)PHOTON_DISC_OFFSET_UNIT);
        along += sum[a] * n[a];
    }
    for (int a = 0; a < 3; a++)
        square += (sum[a] - along * n[a]) * (sum[a] - along * n[a]);
    return square > (double)LOPSIDED * (double)LOPSIDED * count * count;
}

/* Returns whether a photon that lies so high or low that it may be on a floor above or below is on the point's own.
 * *out_is_below: it is seen, but lies below a step, as behind the edge of a board. */
static bool is_on_own_surface(const photon_map *map, const photon_disc *disc, uint32_t index, bool *out_is_below,
                              uint64_t *in_out_rays)
{
    vec3 at = photon_block_position(map->blocks, index), offset = vec3_sub(at, disc->position);
    *out_is_below = false;
    float height = vec3_dot(offset, disc->normal), lateral_squared = vec3_dot(offset, offset) - height * height;
    if (height > 0.0f)
        return !photon_map_is_behind_wall(map, map->blocks, disc->position, disc->normal, index, in_out_rays);
    /* the space above a low photon must be empty */
    scene_ray up =
        scene_ray_make(vec3_add_scaled(at, disc->normal, 0.5f * disc->flat_height), vec3_scale(disc->normal, -height));
    ++*in_out_rays;
    if (scene_is_blocked(map->surfaces, up, 1.0f))
        return false;
    float cosine = vec3_dot(direction_decode(photon_block_normal(map->blocks, index)), disc->normal);
    *out_is_below = surface_region_is_below_step(disc->radius, lateral_squared, -height, cosine);
    return !*out_is_below;
}

static uint32_t count_within(const photon_found *found, float most)
{
    const float same[DISC_COUNTS] = {most, most, most};
    uint32_t counts[DISC_COUNTS];
    disc_kernels_best()->count_within(found, same, counts);
    return counts[0];
}

/* Under uniform irradiance each ring of a quarter of the disc's area holds a quarter of the photons and of their flux.
 * Where inner rings hold less of both than chance explains, by this many standard deviations, the disc has reached a
 * brighter region. */
static const float RIM_SIGMAS = 3.25f;
enum { RINGS = 4 };

/* Returns whether the photons no farther than `inner` have less than their share of the flux, beyond chance. Their
 * number alone does not tell: there may be fewer because they were thinned, and each is then brighter. The sums are of
 * integers, so that their order does not matter. */
static bool rings_lack_flux(const photon_found *found, float inner, float share)
{
    enum { FRACTION_BITS = 8 };
    int exponent_max = FLUX_EXPONENT_MIN;
    const uint32_t entries = found->leaf_count * PHOTON_BLOCK_LANES;
    for (uint32_t i = 0; i < entries; i++)
        if (found->distances_squared[i] <= found->limit) {
            int exponent = flux_exponent(photon_block_flux(found->blocks, photon_found_index(found, i)));
            exponent_max = exponent > exponent_max ? exponent : exponent_max;
        }
    uint64_t all = 0, inside = 0, squares = 0; /* of fluxes' largest channels, in units of 2^(exponent_max - 8) */
    for (uint32_t i = 0; i < entries; i++) {
        if (!(found->distances_squared[i] <= found->limit))
            continue;
        uint32_t code = photon_block_flux(found->blocks, photon_found_index(found, i));
        int shift = exponent_max - flux_exponent(code);
        uint64_t largest = flux_largest_mantissa(code);
        /* less than 0: the file that the map is in is being overwritten */
        uint64_t flux = shift < 0 || shift > 2 * FRACTION_BITS ? 0 : largest << FRACTION_BITS >> shift;
        all += flux;
        squares += flux * flux;
        inside += found->distances_squared[i] <= inner ? flux : 0;
    }
    double missing = (double)share * (double)all - (double)inside;
    double variance = (double)(share * (1.0f - share)) * (double)squares;
    return missing > 0.0 && missing * missing > (double)(RIM_SIGMAS * RIM_SIGMAS) * variance;
}

/* Returns the largest number that is less than a positive one. */
static float next_below(float x) { return nextafterf(x, 0.0f); }

/* Returns how many rings, from the innermost, have the light of the point: all of them where the inner ones lack
 * nothing. */
static uint32_t rings_of_one_light(const photon_found *found, float radius_squared)
{
    float ring_of = (float)RINGS / radius_squared, most[RINGS - 1];
    uint32_t within[RINGS - 1];
    for (uint32_t rings = 1; rings < RINGS; rings++) {
        /* the largest squared distance in these rings: times ring_of, as rounded, it is less than their number */
        float d = (float)rings / ring_of;
        while (d * ring_of < (float)rings)
            d = nextafterf(d, INFINITY);
        while (d * ring_of >= (float)rings)
            d = next_below(d);
        most[rings - 1] = d;
    }
    disc_kernels_best()->count_within(found, most, within);
    for (uint32_t rings = RINGS - 1; rings > 0; rings--) {
        float share = (float)rings / (float)RINGS, expected = share * (float)found->count;
        float missing = expected - (float)within[rings - 1];
        if (missing > 0.0f && missing * missing > RIM_SIGMAS * RIM_SIGMAS * expected * (1.0f - share) &&
            rings_lack_flux(found, next_below(share * radius_squared), share))
            return rings;
    }
    return RINGS;
}

/* Makes the disc smaller until its rim is as bright as its middle, or has no photons. Returns whether it has become so.
 * Inner rings must lack photons as well as flux: by flux alone one bright photon far from the point, which is a matter
 * of chance, would take itself out of the disc. */
static bool leave_brighter_rim(photon_found *found, float *in_out_radius_squared)
{
    bool is_left = false;
    for (uint32_t rings; (rings = rings_of_one_light(found, *in_out_radius_squared)) < RINGS; is_left = true) {
        *in_out_radius_squared *= (float)rings / (float)RINGS;
        found->limit = next_below(*in_out_radius_squared);
        found->count = count_within(found, found->limit);
    }
    return is_left;
}

/* A region holds an estimate if it is at least this share of the disc, and if photons of the disc's density, or of the
 * scene's mean where that is greater, would leave at least this many in it. Three walls meet in a quarter disc. */
static const float REGION_SHARE_MIN = 0.2f, REGION_PHOTONS_MIN = 10.0f;

static bool region_holds(const photon_map *map, double area, float radius)
{
    float share_min = float_clamp(REGION_PHOTONS_MIN / (float)map->nearest, REGION_SHARE_MIN, 1.0f);
    float least_radius = float_min(radius, map->mean_radius);
    return area >= (double)share_min * (double)AG_PI * (double)least_radius * (double)least_radius;
}

/* The share of the photons found that must lie on the point's own surface, else surfaces above or below have set the
 * radius. */
static const float OWN_SHARE_MIN = 0.5f;

/* Returns the reach of an estimate. Among equally far photons their order decides which of them count. */
static float reach_of(const photon_map *map, const photon_found *found)
{
    if (found->count <= map->nearest)
        return map->max_radius * map->max_radius;
    bool is_clear =
        found->limit > map->min_radius_squared && count_within(found, next_below(found->limit)) == map->nearest;
    return is_clear ? found->limit : 0.0f;
}

/* Returns the squared radius of the disc that the photons found fill. Where there are k + 1 of them, the farthest one,
 * which does not count, tells how far it reaches; *out_has_next: there are. */
static float find_disc(const photon_map *map, photon_found *found, bool *out_has_next)
{
    float radius_squared = map->max_radius * map->max_radius;
    *out_has_next = found->count == map->nearest + 1;
    if (*out_has_next) {
        radius_squared = found->limit;
        photon_found_forget(found, found->farthest);
    }
    return float_max(radius_squared, map->min_radius_squared);
}

/* The photons that are seen below a step. */
typedef struct step_photons {
    photon_neighbor *entries; /* of the photons found; borrowed: the estimate's scratch */
    uint32_t count;
    bool are_more; /* others were seen in a larger disc */
} step_photons;

/* Sums the photons that lie on the point's own surface, and forgets those that lie above or below it. in_out_steps:
 * its entries have room for all photons. */
static void sum_own_surface(const photon_map *map, const photon_disc *disc, photon_found *found,
                            step_photons *in_out_steps, uint64_t *in_out_rays, photon_disc_sums *out_sums)
{
    photon_neighbor *scratch = in_out_steps->entries;
    in_out_steps->are_more = in_out_steps->count > 0;
    in_out_steps->count = 0;
    const uint32_t count = found->count;
    const uint32_t on_surface = disc_kernels_best()->sum_on_surface(disc, found, out_sums, scratch);
    for (uint32_t i = 0; i < count - on_surface; i++) {
        uint32_t entry = photon_neighbor_index(scratch[i]), index = photon_found_index(found, entry);
        bool is_below;
        if (is_on_own_surface(map, disc, index, &is_below, in_out_rays)) {
            photon_disc_add(disc, index, out_sums);
            continue;
        }
        photon_found_forget_entry(found, entry);
        if (is_below)
            scratch[in_out_steps->count++] = scratch[i];
    }
}

/* Returns whether other surfaces below a step lie below the region, by their photons. */
static bool lies_above_steps(const photon_map *map, const photon_found *found, const step_photons *steps,
                             const surface_region *region)
{
    bool does = steps->are_more;
    for (uint32_t i = 0; i < steps->count && !does; i++) {
        uint32_t index = photon_found_index(found, photon_neighbor_index(steps->entries[i]));
        does = surface_region_contains(region, photon_block_position(map->blocks, index));
    }
    return does;
}

/* Returns whether the surface may end within the disc, by what is cheap to tell. */
static bool may_end(const photon_map *map, const clear_space *space, const photon_disc *disc, const photon_found *found,
                    float radius_squared, const photon_disc_sums *sums, uint64_t *in_out_rays)
{
    if (found->other_squared <= radius_squared || is_lopsided(sums, disc->normal, found->count))
        return true;
    return !surface_region_reaches_rim(map->surfaces, space, disc->position, disc->normal, PHOTON_ESTIMATE_MIN_COS,
                                       disc->radius, in_out_rays);
}

/* Where the surface ends within the disc, takes the photons of its part alone into the sums, and that part for the
 * area, if an estimate holds there or there is a least area. extent: of the whole disc; returns that of the part. */
static irradiance_extent fit_to_surface(const photon_map *map, const clear_space *space, const photon_disc *disc,
                                        photon_found *found, bool has_next, const step_photons *steps,
                                        irradiance_extent extent, double least_area, uint64_t *in_out_rays,
                                        photon_disc_sums *in_out_sums, double *in_out_area)
{
    surface_region region = {.has_steps = steps->count > 0 || steps->are_more};
    if (!surface_region_find(map->surfaces, space, disc->position, disc->normal, PHOTON_ESTIMATE_MIN_COS, disc->radius,
                             in_out_rays, &region))
        return region.has_steps ? IRRADIANCE_HOLDS_NOWHERE : extent;
    if (lies_above_steps(map, found, steps, &region))
        surface_region_leave_steps(map->surfaces, space, disc->normal, PHOTON_ESTIMATE_MIN_COS, disc->radius,
                                   in_out_rays, &region);
    double area = surface_region_area(&region, disc->radius);
    photon_disc_sums inside;
    bool is_k = disc_kernels_best()->sum_in_region(disc, &region, found, &inside) == map->nearest && has_next;
    bool holds = is_k || region_holds(map, area, disc->radius);
    if (!holds && area < least_area) {
        surface_region_follow_strip(map->surfaces, space, disc->normal, PHOTON_ESTIMATE_MIN_COS, disc->radius,
                                    in_out_rays, &region);
        area = surface_region_area(&region, disc->radius);
        disc_kernels_best()->sum_in_region(disc, &region, found, &inside);
    }
    if (holds || least_area > 0.0) {
        *in_out_sums = inside;
        *in_out_area = holds ? area : double_max(area, least_area);
    }
    if (!holds)
        return IRRADIANCE_HOLDS_NOWHERE;
    /* farther points must see the photon anyway */
    return region.nearest_end < photon_map_sight_distance(map) ? IRRADIANCE_HOLDS_IN_SIGHT : extent;
}

/* The clear space of the leaf that the point lies in. */
static const clear_space *find_space(const photon_map *map, vec3 position, const photon_search_hint *hint,
                                     clear_space *spare)
{
    bool is_known = hint && hint->leaf != PHOTON_NONE;
    return clear_spaces_get(map->spaces, is_known ? hint->leaf : photon_tree_leaf(&map->tree, position), spare);
}

/* The disc around a point, in which offsets are summed unless it is known to be whole surface. */
static photon_disc make_disc(const photon_map *map, const clear_space *space, vec3 position, vec3 normal,
                             float radius_squared)
{
    float radius = sqrtf(radius_squared);
    bool is_whole =
        space && surface_region_is_whole(map->surfaces, space, position, normal, PHOTON_ESTIMATE_MIN_COS, radius);
    return (photon_disc){.blocks = map->blocks,
                         .position = position,
                         .normal = normal,
                         .radius = radius,
                         .flat_height = map->surfaces ? radius * FLAT_HEIGHT_SHARE : INFINITY,
                         .flux_exponent_max = map->flux_exponent_max,
                         .has_offsets = map->surfaces && !is_whole};
}

/* irradiance_estimate_find_reach. least_area: of the surface that the photons of a disc are taken to lie on, where it
 * is too small to hold an estimate; 0: the whole disc then answers. */
static irradiance_extent find(const photon_map *map, vec3 position, vec3 normal, double least_area,
                              photon_neighbor *scratch, photon_search_hint *in_out_hint, uint64_t *in_out_rays,
                              rgb *out_irradiance, float *out_reach_squared)
{
    *out_irradiance = rgb_gray(0.0f);
    if (map->set.count == 0)
        return IRRADIANCE_HOLDS_EVERYWHERE;

    clear_space spare;
    const clear_space *space = map->spaces ? find_space(map, position, in_out_hint, &spare) : NULL;

    /* the k nearest photons, and the next one */
    const uint32_t wanted = map->nearest + 1;
    photon_found found;
    photon_found_init(&found, &map->tree, wanted, scratch);
    photon_found_search(&found, &map->tree, position, normal, PHOTON_ESTIMATE_MIN_COS, map->max_radius, wanted,
                        in_out_hint);
    if (out_reach_squared)
        *out_reach_squared = reach_of(map, &found);

    /* their disc, and of its photons those on the point's surface, and none above or below it */
    bool has_next;
    float radius_squared = find_disc(map, &found, &has_next);
    photon_disc disc = make_disc(map, space, position, normal, radius_squared);
    photon_disc_sums sums;
    const uint32_t count = found.count;
    step_photons steps = {.entries = scratch};
    sum_own_surface(map, &disc, &found, &steps, in_out_rays, &sums);
    bool has_other_surfaces = found.count < count;
    bool are_mostly_others = has_next && (float)found.count < OWN_SHARE_MIN * (float)(count - steps.count);

    /* as far as it has the light of its middle */
    if (leave_brighter_rim(&found, &radius_squared)) {
        radius_squared = float_max(radius_squared, map->min_radius_squared);
        disc = make_disc(map, space, position, normal, radius_squared);
        sum_own_surface(map, &disc, &found, &steps, in_out_rays, &sums);
    }

    /* of its area what is surface */
    double area = (double)AG_PI * (double)radius_squared;
    irradiance_extent extent = has_other_surfaces ? IRRADIANCE_HOLDS_IN_SIGHT : IRRADIANCE_HOLDS_EVERYWHERE;
    if ((least_area > 0.0 || !are_mostly_others) && disc.has_offsets &&
        (has_other_surfaces || may_end(map, space, &disc, &found, radius_squared, &sums, in_out_rays)))
        extent =
            fit_to_surface(map, space, &disc, &found, has_next, &steps, extent, least_area, in_out_rays, &sums, &area);
    if (are_mostly_others)
        extent = IRRADIANCE_HOLDS_NOWHERE;

    double scale = ldexp(1.0, map->flux_exponent_max - 32) / ((double)map->set.emitted_paths * area);
    *out_irradiance = (rgb){(float)((double)sums.flux[0] * scale), (float)((double)sums.flux[1] * scale),
                            (float)((double)sums.flux[2] * scale)};
    return extent;
}

irradiance_extent irradiance_estimate_find_reach(const photon_map *map, vec3 position, vec3 normal,
                                                 photon_neighbor *scratch, photon_search_hint *in_out_hint,
                                                 uint64_t *in_out_rays, rgb *out_irradiance, float *out_reach_squared)
{
    return find(map, position, normal, 0.0, scratch, in_out_hint, in_out_rays, out_irradiance, out_reach_squared);
}

irradiance_extent irradiance_estimate_find(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch,
                                           uint64_t *in_out_rays, rgb *out_irradiance)
{
    return find(map, position, normal, 0.0, scratch, NULL, in_out_rays, out_irradiance, NULL);
}

rgb irradiance_estimate_seen(const photon_map *map, vec3 position, vec3 normal, double least_area,
                             photon_neighbor *scratch, uint64_t *in_out_rays)
{
    rgb irradiance;
    (void)find(map, position, normal, least_area, scratch, NULL, in_out_rays, &irradiance, NULL);
    return irradiance;
}

/* Returns the key that decides how an irradiance photon's value is rounded. */
static uint64_t rounding_key(const photon_map *map, uint32_t irradiance_photon)
{
    return map->is_steady ? photon_block_position_key(map->irradiance_photons.blocks, irradiance_photon)
                          : irradiance_photon;
}

uint32_t irradiance_estimate_word(const photon_map *map, uint32_t irradiance_photon, irradiance_extent extent,
                                  rgb irradiance)
{
    if (extent == IRRADIANCE_HOLDS_NOWHERE)
        return irradiance_word(IRRADIANCE_READY, PHOTON_NO_IRRADIANCE);
    return irradiance_word(extent == IRRADIANCE_HOLDS_IN_SIGHT ? IRRADIANCE_READY_IN_SIGHT : IRRADIANCE_READY,
                           photon_map_encode_irradiance(map, irradiance, rounding_key(map, irradiance_photon)));
}
