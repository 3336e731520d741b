/* estimate_fingerprint.c: see estimate_fingerprint.h. */
#include "estimate_fingerprint.h"

#include "math/rng.h"
#include "status.h"

#include <stdlib.h>

/* On a disc of radius 1, a smaller one lies this much above its half x > 0: photons of both are in many estimates. */
static const float LEDGE_RADIUS = 0.4f, LEDGE_X = 0.3f, LEDGE_HEIGHT = 0.01f;
enum { PHOTONS = 1024, NEAREST = 24, ESTIMATE_EVERY = 16 };

static const vec3 UP = {0.0f, 0.0f, 1.0f};

static ag_status add_disc(scene *s, vec3 center, float radius)
{
    shape disc = shape_make(SHAPE_DISK);
    uint32_t index;
    disc.as.quadric = (quadric){
        .world_from_object = transform_translate(center.x, center.y, center.z), .radius = radius, .turn = 1.0f};
    return scene_add_shape(s, &disc, &index);
}

static ag_status make_scene(run_context *run, const char *isa, scene **out_scene)
{
    material gray = material_make(MATERIAL_DIFFUSE);
    uint32_t index;
    scene *s = scene_create();
    if (!s)
        return AG_ERROR_MEMORY;
    gray.reflectance = rgb_gray(0.5f);
    ag_status status = scene_add_material(s, &gray, &index);
    if (status == AG_OK)
        status = add_disc(s, vec3_make(0.0f, 0.0f, 0.0f), 1.0f);
    if (status == AG_OK)
        status = add_disc(s, vec3_make(LEDGE_X, 0.0f, LEDGE_HEIGHT), LEDGE_RADIUS);
    if (status == AG_OK)
        status = scene_commit(s, run, isa);
    if (status == AG_OK)
        *out_scene = s;
    else
        scene_destroy(s);
    return status;
}

/* Distributes photons evenly over the parts of the discs that are visible from above, each of another colour. */
static ag_status make_map(run_context *run, const scene *surfaces, photon_map *out_map)
{
    photon_set set = {.photons = photon_records_create(PHOTONS), .emitted_paths = PHOTONS};
    photon_map_settings settings = {.nearest = NEAREST, .surface_area = AG_PI, .surfaces = surfaces};
    if (!set.photons)
        return AG_ERROR_MEMORY;
    rng random = rng_make(1, 2, 3);
    while (set.count < PHOTONS) {
        float x = 2.0f * rng_float(&random) - 1.0f, y = 2.0f * rng_float(&random) - 1.0f;
        bool is_on_ledge = (x - LEDGE_X) * (x - LEDGE_X) + y * y < LEDGE_RADIUS * LEDGE_RADIUS;
        rgb flux = {0.5f + rng_float(&random), rng_float(&random), 2.0f * rng_float(&random)};
        if (x * x + y * y < 1.0f) {
            photon *p = &set.photons[set.count];
            *p = (photon){.position = {x, y, is_on_ledge ? LEDGE_HEIGHT : 0.0f},
                          .normal = direction_encode(UP),
                          .direction = arrival_encode(vec3_negate(UP), false),
                          .flux = flux_encode(flux, set.count)};
            set.count++;
        }
    }
    return photon_map_create(run, &set, &settings, 0.0, 0.0, out_map);
}

/* At photons, and beside them, where no photon is the nearest by nothing. */
static void add_estimates(const photon_map *map, irradiance_estimate_fn *find, photon_neighbor *scratch, hash128 *hash)
{
    for (uint32_t i = 0; i < PHOTONS; i += ESTIMATE_EVERY) {
        vec3 at = photon_block_position(map->blocks, i);
        at.x += i % (2 * ESTIMATE_EVERY) == 0 ? 0.0f : 0.0078125f;
        uint64_t rays = 0;
        rgb irradiance;
        uint32_t answer[2] = {(uint32_t)find(map, at, UP, scratch, &rays, &irradiance)};
        answer[1] = photon_map_encode_irradiance(map, irradiance, i);
        HASH128_ADD(hash, irradiance);
        HASH128_ADD(hash, answer);
    }
}

static ag_status find_fingerprint(run_context *run, const scene *surfaces, irradiance_estimate_fn *find,
                                  hash128 *out_hash)
{
    photon_map map;
    AG_TRY(make_map(run, surfaces, &map));
    photon_neighbor *scratch = malloc(photon_map_scratch_count(&map) * sizeof *scratch);
    if (scratch) {
        *out_hash = hash128_begin();
        add_estimates(&map, find, scratch, out_hash);
        map.surfaces = NULL;
        add_estimates(&map, find, scratch, out_hash);
    }
    photon_map_reset(&map);
    free(scratch);
    return scratch ? AG_OK : AG_ERROR_MEMORY;
}

ag_status estimate_fingerprint(const run_context *run, const char *isa, irradiance_estimate_fn *find, hash128 *out_hash)
{
    run_context quiet; /* progress is not reported for the built-in scene */
    scene *surfaces;
    run_context_init(&quiet, run->pool, run->log, NULL, NULL);
    ag_status status = make_scene(&quiet, isa, &surfaces);
    if (status == AG_OK) {
        status = find_fingerprint(&quiet, surfaces, find, out_hash);
        scene_destroy(surfaces);
    }
    run_context_reset(&quiet);
    return status;
}
