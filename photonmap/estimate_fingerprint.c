/* estimate_fingerprint.c: see estimate_fingerprint.h. */
#include "estimate_fingerprint.h"

#include "caustic_radius.h"
#include "math/rng.h"
#include "status.h"

#include <assert.h>
#include <stdlib.h>

/* The built-in scene is a heap of discs: a large one, and smaller ones over and through it, flat, nearly flat or at any
 * angle, most of them less than a hundredth above or below it. So estimates meet all that they have rules for: walls,
 * corners, ledges, floors close above each other, surfaces that end, and photons that stand denser or are brighter
 * beyond a line. */
enum { DISCS = 64, PHOTONS = 4096, PHOTONS_OF_FLOOR = 1536, ESTIMATE_EVERY = 8 };
/* Caustic photons of several fluxes, so faint that no other bound decides how far their estimates reach. */
enum { CAUSTIC_PHOTONS = 16 };
static const float CAUSTIC_FLUX = 1e-4f;
/* Estimates of few photons and of many go by other bounds. */
static const uint32_t NEAREST[] = {20, 96};

/* A disc in a frame whose z is its normal. */
typedef struct built_in_disc {
    vec3 center;
    frame axes;
    float radius;
} built_in_disc;

static float between(rng *random, float least, float most) { return least + (most - least) * rng_float(random); }

static void make_discs(built_in_disc discs[DISCS])
{
    rng random = rng_make(1, 2, 4);
    discs[0] = (built_in_disc){{0.0f, 0.0f, 0.0f}, frame_identity(), 1.0f};
    for (int i = 1; i < DISCS; i++) {
        float x = between(&random, -0.8f, 0.8f), y = between(&random, -0.8f, 0.8f), z = between(&random, -0.3f, 0.3f);
        float tilt = i % 3 == 0 ? 0.0f : i % 3 == 1 ? 0.1f : 2.0f;
        vec3 normal = {between(&random, -tilt, tilt), between(&random, -tilt, tilt), 1.0f};
        discs[i] =
            (built_in_disc){{x, y, z * z * z}, frame_from_z(vec3_normalize(normal)), between(&random, 0.05f, 0.35f)};
    }
}

static ag_status add_disc(scene *s, const built_in_disc *d)
{
    shape disc = shape_make(SHAPE_DISK);
    uint32_t index;
    const double m[4][4] = {{(double)d->axes.x.x, (double)d->axes.y.x, (double)d->axes.z.x, (double)d->center.x},
                            {(double)d->axes.x.y, (double)d->axes.y.y, (double)d->axes.z.y, (double)d->center.y},
                            {(double)d->axes.x.z, (double)d->axes.y.z, (double)d->axes.z.z, (double)d->center.z},
                            {0.0, 0.0, 0.0, 1.0}};
    disc.as.quadric = (quadric){.radius = d->radius, .turn = 1.0f};
    bool is_regular = transform_from_matrix(m, &disc.as.quadric.world_from_object);
    assert(is_regular);
    (void)is_regular;
    return scene_add_shape(s, &disc, &index);
}

static ag_status make_scene(run_context *run, const char *isa, const built_in_disc discs[DISCS], scene **out_scene)
{
    material gray = material_make(MATERIAL_DIFFUSE);
    uint32_t index;
    scene *s = scene_create();
    if (!s)
        return AG_ERROR_MEMORY;
    gray.reflectance = rgb_gray(0.5f);
    ag_status status = scene_add_material(s, &gray, &index);
    for (int i = 0; i < DISCS && status == AG_OK; i++)
        status = add_disc(s, &discs[i]);
    if (status == AG_OK)
        status = scene_commit(s, run, isa);
    if (status == AG_OK)
        *out_scene = s;
    else
        scene_destroy(s);
    return status;
}

/* Distributes photons of other colours over the floor, where they are dense or bright in parts, and evenly over the
 * smaller discs. */
static ag_status make_map(run_context *run, const scene *surfaces, const built_in_disc discs[DISCS], uint32_t nearest,
                          photon_map *out_map)
{
    photon_set set = {.photons = photon_records_create(PHOTONS), .emitted_paths = PHOTONS};
    photon_map_settings settings = {.nearest = nearest, .surface_area = 2.0f * AG_PI, .surfaces = surfaces};
    if (!set.photons)
        return AG_ERROR_MEMORY;
    rng random = rng_make(1, 2, 3);
    while (set.count < PHOTONS) {
        const built_in_disc *d = set.count < PHOTONS_OF_FLOOR ? &discs[0] : &discs[set.count % DISCS];
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

/* At photons, and beside them, where no photon is the nearest by nothing. */
static void add_estimates(const photon_map *map, irradiance_estimate_fn *find, photon_neighbor *scratch, hash128 *hash)
{
    for (uint32_t i = 0; i < PHOTONS; i += ESTIMATE_EVERY) {
        vec3 at = photon_block_position(map->blocks, i);
        vec3 normal = direction_decode(photon_block_normal(map->blocks, i));
        at.x += i % (2 * ESTIMATE_EVERY) == 0 ? 0.0f : 0.0078125f;
        uint64_t rays = 0;
        rgb irradiance;
        uint32_t answer[2] = {(uint32_t)find(map, at, normal, scratch, &rays, &irradiance)};
        answer[1] = photon_map_encode_irradiance(map, irradiance, i);
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

static ag_status add_map(run_context *run, const scene *surfaces, const built_in_disc discs[DISCS], uint32_t nearest,
                         irradiance_estimate_fn *find, hash128 *in_out_hash)
{
    photon_map map;
    AG_TRY(make_map(run, surfaces, discs, nearest, &map));
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

ag_status estimate_fingerprint(const run_context *run, const char *isa, irradiance_estimate_fn *find, hash128 *out_hash)
{
    run_context quiet; /* progress is not reported for the built-in scene */
    scene *surfaces;
    built_in_disc discs[DISCS];
    hash128 hash = hash128_begin();
    make_discs(discs);
    run_context_init(&quiet, run->pool, run->log, NULL, NULL);
    ag_status status = make_scene(&quiet, isa, discs, &surfaces);
    if (status == AG_OK) {
        for (size_t i = 0; i < sizeof NEAREST / sizeof *NEAREST && status == AG_OK; i++)
            status = add_map(&quiet, surfaces, discs, NEAREST[i], find, &hash);
        scene_destroy(surfaces);
    }
    run_context_reset(&quiet);
    if (status == AG_OK)
        *out_hash = hash;
    return status;
}
