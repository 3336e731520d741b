/* estimate_fingerprint.c: see estimate_fingerprint.h. First photons that are traced, then estimates from photons that
 * are laid where estimates have to decide most. */
#include "estimate_fingerprint.h"

#include "caustic_radius.h"
#include "fingerprint_scene.h"
#include "onward_ways.h"
#include "status.h"
#include "strong_photons.h"

#include <stdlib.h>

enum { PHOTONS = 4096, PHOTONS_OF_FLOOR = 1536, ESTIMATE_EVERY = 8 };
/* Caustic photons of several fluxes, so faint that no other bound decides how far their estimates reach. */
enum { CAUSTIC_PHOTONS = 16 };
static const float CAUSTIC_FLUX = 1e-4f;
/* Of as many photons on a line from the floor's centre, one is divided. Lengths are shares of the floor's radius. */
enum { DIVIDED = 5 };
static const float DIVIDED_FLUX = 100.0f, DIVIDED_FROM_CENTER = 0.9f, DIVIDED_RADIUS = 0.05f;
/* Estimates of few photons and of many go by other bounds. */
static const uint32_t NEAREST[] = {20, 96};
/* Of the photons of a steady map, which keep irradiances. */
static const float STEADY_FRACTION = 0.25f;
/* Numbers of photons and paths that are traced, and of scatterings of a path. */
enum { TRACED_PHOTONS = 768, GUIDED_PATHS = 512, CAUSTIC_PATHS = 2048, SCATTERINGS_MAX = 5 };
enum { TRIALS = 1024, ASKED_POINTS = 256 };

static float between(rng *random, float least, float most) { return least + (most - least) * rng_float(random); }

/* --- photons that are traced --- */

/* The maps and tables that guide photons to a part of the floor. */
typedef struct guidance {
    importance_map asked, onward;
    onward_ways ways;
    emission_guide guide;
} guidance;

static void guidance_reset(guidance *g)
{
    importance_map_reset(&g->asked);
    importance_map_reset(&g->onward);
    onward_ways_reset(&g->ways);
    emission_guide_reset(&g->guide);
}

static ag_status add_photons(const scene *s, run_context *run, photon_tracing_fn *trace,
                             const photon_tracing_settings *settings, hash128 *in_out_hash)
{
    photon_set set;
    AG_TRY(trace(s, run, settings, &set));
    HASH128_ADD(in_out_hash, set.emitted_paths);
    hash128_add(in_out_hash, set.photons, set.count * sizeof *set.photons);
    photon_set_reset(&set);
    return AG_OK;
}

/* Lays importons on the floor whose lines pass above its middle. */
static ag_status make_ways(run_context *run, const query_point points[ASKED_POINTS], onward_ways *out_ways)
{
    photon *importons = photon_records_create(ASKED_POINTS);
    if (!importons)
        return AG_ERROR_MEMORY;
    rng random = rng_make(1, 2, 6);
    for (uint32_t i = 0; i < ASKED_POINTS; i++) {
        vec3 at = points[i].position;
        vec3 from = {between(&random, -0.1f, 0.1f), between(&random, -0.1f, 0.1f), 0.4f};
        importons[i] = (photon){.position = {at.x, at.y, at.z},
                                .normal = direction_encode(points[i].normal),
                                .direction = arrival_encode(vec3_normalize(vec3_sub(at, from)), true),
                                .flux = flux_encode(rgb_gray(1.0f), i)};
    }
    return onward_ways_create(run, importons, ASKED_POINTS, out_ways);
}

static ag_status make_guide(const scene *s, run_context *run, const photon_tracing_settings *settings,
                            emission_guide *out_guide)
{
    trial_counts counts = {0};
    emission_trial *trials = malloc(TRIALS * sizeof *trials);
    ag_status status = trials ? photon_tracing_try(s, run, settings, 0, TRIALS, trials, &counts) : AG_ERROR_MEMORY;
    if (status == AG_OK)
        status = emission_guide_create(trials, TRIALS, 0.8f, NULL, out_guide);
    free(trials);
    return status;
}

/* Makes what guides photons with these settings; *out is to be reset, on failure too. */
static ag_status make_guidance(const scene *s, run_context *run, const photon_tracing_settings *settings, guidance *out)
{
    query_point points[ASKED_POINTS];
    rng random = rng_make(1, 2, 5);
    for (int i = 0; i < ASKED_POINTS; i++)
        points[i] =
            (query_point){{between(&random, -0.7f, -0.2f), between(&random, -0.5f, 0.5f), 0.0f}, {0.0f, 0.0f, 1.0f}};
    *out = (guidance){0};
    AG_TRY(importance_map_create(points, ASKED_POINTS, &out->asked));
    AG_TRY(importance_map_create_smooth(points, ASKED_POINTS, 2 * ASKED_POINTS, s->bounds_min, s->bounds_max,
                                        &out->onward));
    AG_TRY(make_ways(run, points, &out->ways));
    photon_tracing_settings asking = *settings;
    asking.asked = &out->asked;
    return make_guide(s, run, &asking, &out->guide);
}

/* Adds a map's photons by guided paths, of which some are split. */
static ag_status add_guided_photons(const scene *s, run_context *run, photon_tracing_fn *trace,
                                    photon_tracing_settings settings, hash128 *in_out_hash)
{
    guidance g;
    ag_status status = make_guidance(s, run, &settings, &g);
    settings.guide = &g.guide;
    settings.asked = &g.asked;
    settings.onward = settings.kind == PHOTON_GLOBAL ? &g.onward : NULL;
    settings.ways = &g.ways;
    settings.stored_share = 0.5f;
    settings.split_above = 0.1f * rgb_max(s->light_power);
    settings.caustic_root = 1.0f;
    if (status == AG_OK)
        status = add_photons(s, run, trace, &settings, in_out_hash);
    guidance_reset(&g);
    return status;
}

/* By power alone the global map gets a number of photons; else a number of paths, since photons may be few. */
static ag_status add_traced(const scene *s, run_context *run, photon_tracing_fn *trace, hash128 *in_out_hash)
{
    photon_tracing_settings global = {.kind = PHOTON_GLOBAL,
                                      .wanted = TRACED_PHOTONS,
                                      .max_scatterings = SCATTERINGS_MAX,
                                      .panes_are_direct = true,
                                      .filters_textures = true,
                                      .seed = 1};
    AG_TRY(add_photons(s, run, trace, &global, in_out_hash));
    global.wanted = PHOTONS;
    global.paths = GUIDED_PATHS;
    AG_TRY(add_guided_photons(s, run, trace, global, in_out_hash));
    photon_tracing_settings caustic = global;
    caustic.kind = PHOTON_CAUSTIC;
    caustic.paths = CAUSTIC_PATHS;
    AG_TRY(add_photons(s, run, trace, &caustic, in_out_hash));
    return add_guided_photons(s, run, trace, caustic, in_out_hash);
}

/* --- estimates --- */

/* Distributes photons of other colours over the floor, where they are dense or bright in parts, and evenly over the
 * smaller discs. */
static ag_status make_map(run_context *run, const scene *surfaces, const fingerprint_disc discs[FINGERPRINT_DISCS],
                          uint32_t nearest, bool is_steady, photon_map *out_map)
{
    photon_set set = {.photons = photon_records_create(PHOTONS), .emitted_paths = PHOTONS};
    photon_map_settings settings = {.nearest = nearest,
                                    .surface_area = 2.0f * AG_PI,
                                    .irradiance_fraction = is_steady ? STEADY_FRACTION : 1.0f,
                                    .is_steady = is_steady,
                                    .surfaces = surfaces};
    if (!set.photons)
        return AG_ERROR_MEMORY;
    rng random = rng_make(1, 2, 3);
    while (set.count < PHOTONS) {
        const fingerprint_disc *d = set.count < PHOTONS_OF_FLOOR ? &discs[0] : &discs[set.count % FINGERPRINT_DISCS];
        float x = between(&random, -1.0f, 1.0f), y = between(&random, -1.0f, 1.0f);
        bool is_sparse = x > 0.1f, is_bright = x * y > 0.1f;
        rgb flux = {0.5f + rng_float(&random), rng_float(&random), 2.0f * rng_float(&random)};
        if (x * x + y * y > 1.0f || (is_sparse && rng_float(&random) > 0.2f))
            continue;
        vec3 at = vec3_add(d->center, frame_to_world(&d->axes, (vec3){d->radius * x, d->radius * y, 0.0f}));
        set.photons[set.count] = (photon){.position = {at.x, at.y, at.z},
                                          .normal = direction_encode(d->axes.z),
                                          .direction = arrival_encode(vec3_negate(d->axes.z), false),
                                          .flux = flux_encode(rgb_scale(flux, is_bright ? 5.0f : 1.0f), set.count)};
        set.count++;
    }
    return photon_map_create(run, &set, &settings, 0.0, 0.0, out_map);
}

/* Adds estimates and slots' words, in turn at an irradiance photon, and a little beside one, where the nearest photon
 * is not at distance 0. */
static void add_estimates(const photon_map *map, irradiance_estimate_fn *find, photon_neighbor *scratch, hash128 *hash)
{
    const photon_block *blocks = map->irradiance_photons.blocks;
    for (uint32_t i = 0; i < map->irradiance_photons.count; i += ESTIMATE_EVERY) {
        vec3 at = photon_block_position(blocks, i);
        vec3 normal = direction_decode(photon_block_normal(blocks, i));
        at.x += i % (2 * ESTIMATE_EVERY) == 0 ? 0.0f : 0.0078125f;
        uint64_t rays = 0;
        rgb irradiance;
        irradiance_extent extent = find(map, at, normal, scratch, &rays, &irradiance);
        uint32_t answer[2] = {(uint32_t)extent, irradiance_estimate_word(map, i, extent, irradiance)};
        HASH128_ADD(hash, irradiance);
        HASH128_ADD(hash, answer);
    }
}

/* Adds the largest radius of caustic estimates, which a map file keeps. */
static ag_status add_caustic_radius(const photon_map *global, hash128 *in_out_hash)
{
    photon photons[CAUSTIC_PHOTONS] = {0};
    photon_set caustic = {.photons = photons, .count = CAUSTIC_PHOTONS, .emitted_paths = PHOTONS};
    float radius;
    for (uint32_t i = 0; i < CAUSTIC_PHOTONS; i++)
        photons[i].flux = flux_encode(rgb_gray(CAUSTIC_FLUX * (float)(i + 1)), i);
    AG_TRY(caustic_radius_find(global, &caustic, &radius));
    HASH128_ADD(in_out_hash, radius);
    return AG_OK;
}

/* Adds a set of photons on the floor, of which one is divided because it is far stronger than the others. */
static ag_status add_divided(const run_context *run, const scene *surfaces, const fingerprint_disc *floor,
                             hash128 *in_out_hash)
{
    photon_set set = {.photons = photon_records_create(CAUSTIC_PHOTONS), .count = CAUSTIC_PHOTONS, .emitted_paths = 1};
    if (!set.photons)
        return AG_ERROR_MEMORY;
    for (uint32_t i = 0; i < CAUSTIC_PHOTONS; i++) {
        float along = DIVIDED_FROM_CENTER * (float)i / (float)CAUSTIC_PHOTONS;
        set.photons[i] = (photon){.normal = direction_encode(floor->axes.z),
                                  .direction = arrival_encode(vec3_negate(floor->axes.z), false),
                                  .flux = flux_encode(rgb_gray(i == DIVIDED ? DIVIDED_FLUX : 1.0f), i)};
        photon_set_position(&set.photons[i], vec3_add_scaled(floor->center, floor->axes.x, along * floor->radius));
    }
    ag_status status = strong_photons_divide(surfaces, run, DIVIDED_RADIUS * floor->radius, &set);
    hash128_add(in_out_hash, set.photons, set.count * sizeof *set.photons);
    photon_set_reset(&set);
    return status;
}

static ag_status add_map(run_context *run, const scene *surfaces, const fingerprint_disc discs[FINGERPRINT_DISCS],
                         uint32_t nearest, bool is_steady, irradiance_estimate_fn *find, hash128 *in_out_hash)
{
    photon_map map;
    AG_TRY(make_map(run, surfaces, discs, nearest, is_steady, &map));
    photon_map_add_hash(&map, in_out_hash);
    photon_neighbor *scratch = malloc(photon_map_scratch_count(&map) * sizeof *scratch);
    ag_status status = scratch ? add_caustic_radius(&map, in_out_hash) : AG_ERROR_MEMORY;
    if (status == AG_OK) {
        add_estimates(&map, find, scratch, in_out_hash);
        map.surfaces = NULL;
        add_estimates(&map, find, scratch, in_out_hash);
    }
    photon_map_reset(&map);
    free(scratch);
    return status;
}

ag_status estimate_fingerprint(const run_context *run, const char *isa, photon_tracing_fn *trace,
                               irradiance_estimate_fn *find, hash128 *out_hash)
{
    run_context quiet; /* progress is not reported for the built-in scene */
    scene *surfaces;
    fingerprint_disc discs[FINGERPRINT_DISCS];
    hash128 hash = hash128_begin();
    run_context_init(&quiet, run->pool, run->log, NULL, NULL);
    ag_status status = fingerprint_scene_create(&quiet, isa, discs, &surfaces);
    if (status == AG_OK) {
        status = add_traced(surfaces, &quiet, trace, &hash);
        for (size_t i = 0; i < sizeof NEAREST / sizeof *NEAREST && status == AG_OK; i++)
            status = add_map(&quiet, surfaces, discs, NEAREST[i], false, find, &hash);
        if (status == AG_OK)
            status = add_map(&quiet, surfaces, discs, NEAREST[0], true, find, &hash);
        if (status == AG_OK)
            status = add_divided(&quiet, surfaces, &discs[0], &hash);
        scene_destroy(surfaces);
    }
    run_context_reset(&quiet);
    if (status == AG_OK)
        *out_hash = hash;
    return status;
}
