/* irradiance_estimate.c: see irradiance_estimate.h. Flux is summed in whole numbers, so its bits do not depend on the
 * order in which photons are found. */
#include "irradiance_estimate.h"

#include "disc_kernels.h"
#include "rays/transmittance.h"
#include "surface_region.h"

/* Photons this much higher or lower than the point, as a share of the radius, may lie on another surface. */
static const float LEVEL = 1.0f / 32.0f;

/* Photons that crowd to one side of the disc, by more than this share of its radius on average, hint at an edge. */
static const float LOPSIDED = 0.15f;

/* Along the surface, as far as that is its point's plane: on a sphere all photons lie below it. */
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

/* Whether a photon within the radius, so high or low that it may lie on a floor above or below, lies on that at the
 * point. */
static bool is_of_this_level(const photon_map *map, const photon_disc *disc, uint32_t index, uint64_t *in_out_rays)
{
    vec3 at = photon_block_position(map->blocks, index);
    float height = vec3_dot(vec3_sub(at, disc->position), disc->normal);
    if (height > 0.0f)
        return !photon_map_is_behind_wall(map, map->blocks, disc->position, disc->normal, index, in_out_rays);
    /* the space above a low photon must be empty */
    scene_ray up =
        scene_ray_make(vec3_add_scaled(at, disc->normal, 0.5f * disc->level), vec3_scale(disc->normal, -height));
    ++*in_out_rays;
    return !scene_is_blocked(map->surfaces, up, 1.0f);
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

/* Returns whether the photons no farther than `inner` lack flux: there may be fewer of them because they were thinned,
 * each being brighter for it. Sums are of integers, in any order. */
static bool rings_lack_flux(const photon_found *found, float inner, float share)
{
    enum { FRACTION_BITS = 8 };
    int exponent_max = FLUX_EXPONENT_MIN;
    const uint32_t slots = found->leaf_count * PHOTON_BLOCK_LANES;
    for (uint32_t i = 0; i < slots; i++)
        if (found->distances_squared[i] <= found->limit) {
            int exponent = flux_exponent(photon_block_flux(found->blocks, photon_found_index(found, i)));
            exponent_max = exponent > exponent_max ? exponent : exponent_max;
        }
    uint64_t all = 0, inside = 0, squares = 0;
    for (uint32_t i = 0; i < slots; i++) {
        if (!(found->distances_squared[i] <= found->limit))
            continue;
        uint32_t code = photon_block_flux(found->blocks, photon_found_index(found, i));
        int shift = exponent_max - flux_exponent(code);
        uint64_t r = code >> 16 & 255, g = code >> 8 & 255, b = code & 255, largest = r > g ? r : g;
        uint64_t flux = shift > 2 * FRACTION_BITS ? 0 : ((largest > b ? largest : b) << FRACTION_BITS) >> shift;
        all += flux;
        squares += flux * flux;
        inside += found->distances_squared[i] <= inner ? flux : 0;
    }
    double missing = (double)share * (double)all - (double)inside;
    double variance = (double)(share * (1.0f - share)) * (double)squares;
    return missing > 0.0 && missing * missing > (double)(RIM_SIGMAS * RIM_SIGMAS) * variance;
}

/* The largest number that is less than a positive one. */
static float next_below(float x) { return nextafterf(x, 0.0f); }

/* How many rings, from the innermost, have no more light than the point itself; RINGS where all are so. */
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

/* Makes the disc smaller until its rim is as bright as its middle, or has no photons. By their number as well as by
 * their flux: one bright photon, which is a matter of chance, would take itself out of the disc where it lies far from
 * the point. */
static void leave_brighter_rim(photon_found *found, float *in_out_radius_squared)
{
    for (uint32_t rings; (rings = rings_of_one_light(found, *in_out_radius_squared)) < RINGS;) {
        *in_out_radius_squared *= (float)rings / (float)RINGS;
        found->limit = next_below(*in_out_radius_squared);
        found->count = count_within(found, found->limit);
    }
}

/* A region holds an estimate if it is at least this share of the disc, and if photons of the disc's density, or of the
 * scene's mean where that is greater, would leave at least this many in it. Three walls meet in a quarter disc. */
static const float REGION_SHARE_MIN = 0.2f, REGION_PHOTONS_MIN = 10.0f;

static bool region_holds(const photon_map *map, double area, float radius)
{
    float share_min = fminf(fmaxf(REGION_SHARE_MIN, REGION_PHOTONS_MIN / (float)map->nearest), 1.0f);
    float least_radius = fminf(radius, map->mean_radius);
    return area >= (double)share_min * (double)AG_PI * (double)least_radius * (double)least_radius;
}

/* The share of the photons found that must lie on the point's own level, else other levels have set the radius. */
static const float LEVEL_SHARE_MIN = 0.5f;

/* Returns the reach of an estimate. Among equally far photons their order decides which of them count. */
static float reach_of(const photon_map *map, const photon_found *found)
{
    if (found->count <= map->nearest)
        return map->max_radius * map->max_radius;
    bool is_clear =
        found->limit > map->min_radius_squared && count_within(found, next_below(found->limit)) == map->nearest;
    return is_clear ? found->limit : 0.0f;
}

irradiance_extent irradiance_estimate_find(const photon_map *map, vec3 position, vec3 normal, photon_neighbor *scratch,
                                           uint64_t *in_out_rays, rgb *out_irradiance)
{
    return irradiance_estimate_find_reach(map, position, normal, scratch, NULL, in_out_rays, out_irradiance, NULL);
}

irradiance_extent irradiance_estimate_find_reach(const photon_map *map, vec3 position, vec3 normal,
                                                 photon_neighbor *scratch, photon_search_hint *in_out_hint,
                                                 uint64_t *in_out_rays, rgb *out_irradiance, float *out_reach_squared)
{
    *out_irradiance = rgb_gray(0.0f);
    if (map->set.count == 0)
        return IRRADIANCE_HOLDS_EVERYWHERE;
    const uint32_t wanted = map->nearest + 1;
    const disc_kernels *kernels = disc_kernels_best();
    photon_found found;
    photon_found_init(&found, &map->tree, wanted, scratch);
    photon_found_search(&found, &map->tree, position, normal, PHOTON_ESTIMATE_MIN_COS, map->max_radius, wanted,
                        in_out_hint);
    if (out_reach_squared)
        *out_reach_squared = reach_of(map, &found);
    const bool has_next = found.count == wanted;
    float radius_squared = map->max_radius * map->max_radius;
    if (has_next) {
        radius_squared = found.limit;
        photon_found_forget(&found, found.farthest);
    }
    radius_squared = fmaxf(radius_squared, map->min_radius_squared);
    leave_brighter_rim(&found, &radius_squared);
    radius_squared = fmaxf(radius_squared, map->min_radius_squared);
    float radius = sqrtf(radius_squared);
    double area = (double)AG_PI * (double)radius_squared;
    photon_disc disc = {map->blocks,           position, normal, radius, map->surfaces ? radius * LEVEL : INFINITY,
                        map->flux_exponent_max};
    photon_disc_sums sums;
    const uint32_t count = found.count, on_level = kernels->sum_on_level(&disc, &found, &sums, scratch);
    for (uint32_t i = 0; i < count - on_level; i++) {
        uint32_t slot = photon_neighbor_index(scratch[i]), index = photon_found_index(&found, slot);
        if (is_of_this_level(map, &disc, index, in_out_rays))
            photon_disc_add(&disc, index, &sums);
        else
            photon_found_forget_slot(&found, slot);
    }
    const uint32_t kept = found.count;
    surface_region region;
    irradiance_extent extent = kept < count ? IRRADIANCE_HOLDS_IN_SIGHT : IRRADIANCE_HOLDS_EVERYWHERE;
    bool may_end =
        map->surfaces &&
        (kept < count || found.other <= radius_squared || is_lopsided(&sums, normal, kept) ||
         !surface_region_reaches_rim(map->surfaces, position, normal, PHOTON_ESTIMATE_MIN_COS, radius, in_out_rays));
    if (has_next && (float)kept < LEVEL_SHARE_MIN * (float)count) {
        extent = IRRADIANCE_HOLDS_NOWHERE;
    } else if (may_end && surface_region_find(map->surfaces, position, normal, PHOTON_ESTIMATE_MIN_COS, radius,
                                              in_out_rays, &region)) {
        double region_area = surface_region_area(&region, radius);
        photon_disc_sums whole = sums;
        uint32_t inside = kernels->sum_in_region(&disc, &region, &found, &sums);
        bool is_k = has_next && inside == map->nearest;
        if (is_k || region_holds(map, region_area, radius)) {
            area = region_area;
            /* farther points must see the photon anyway */
            if (region.nearest_end < photon_map_far(map))
                extent = IRRADIANCE_HOLDS_IN_SIGHT;
        } else {
            extent = IRRADIANCE_HOLDS_NOWHERE;
            sums = whole;
        }
    }
    double scale = ldexp(1.0, map->flux_exponent_max - 32) / ((double)map->set.emitted_paths * area);
    *out_irradiance = (rgb){(float)((double)sums.flux[0] * scale), (float)((double)sums.flux[1] * scale),
                            (float)((double)sums.flux[2] * scale)};
    return extent;
}
