/* photon_field.h: photons spread evenly over a surface without edges, whose irradiance is known. For the tests of the
 * photon map and of the irradiance cache. Threads: the map's. */
#ifndef AFTERGLOW_TESTS_PHOTON_FIELD_H
#define AFTERGLOW_TESTS_PHOTON_FIELD_H

#include "irradiance_cache.h"

#include "test_scene.h"

typedef enum field_kind {
    FIELD_SPHERE, /* the unit sphere seen from inside; a disc of a chord's radius has just the cap's area */
    FIELD_PLANE   /* the unit square, repeated a little way beyond its edges */
} field_kind;

static const rgb FIELD_FLUX = {10.0f, 1.0f, 0.1f}; /* of the whole, W */

typedef struct field_place {
    vec3 position, normal;
} field_place;

static inline field_place field_place_at(field_kind kind, vec2 u)
{
    if (kind == FIELD_PLANE)
        return (field_place){{u.x, u.y, 0.0f}, {0.0f, 0.0f, 1.0f}};
    vec3 p = sample_uniform_sphere(u);
    return (field_place){p, vec3_negate(p)};
}

/* W/m^2 per W of flux. */
static inline double field_irradiance(field_kind kind) { return kind == FIELD_PLANE ? 1.0 : 1.0 / (4.0 * PI); }

static inline void field_add(photon_set *set, vec3 position, vec3 normal, uint32_t flux)
{
    photon *p = &set->photons[set->count++];
    memset(p, 0, sizeof *p);
    p->position[0] = position.x, p->position[1] = position.y, p->position[2] = position.z;
    p->normal = direction_encode(normal);
    p->direction = arrival_encode(vec3_negate(normal), false);
    p->flux = flux;
}

/* Where a photon of a finished map is. */
static inline field_place field_photon(const photon_map *map, uint32_t index)
{
    return (field_place){photon_block_position(map->blocks, index),
                         direction_decode(photon_block_normal(map->blocks, index))};
}

/* count photons on the surface proper, one for each path; a plane has some more beyond its edges. */
static inline photon_set field_photons(field_kind kind, uint32_t count, uint64_t seed)
{
    const float beyond = 0.15f;
    photon_set set = {.emitted_paths = count};
    set.photons = photon_records_create(count * 2 + 4096);
    assert_non_null(set.photons);
    rng random = test_random(seed);
    for (uint32_t i = 0; i < count; i++) {
        field_place at = field_place_at(kind, rng_vec2(&random));
        uint32_t flux = flux_encode(FIELD_FLUX, hash_combine(seed, i));
        for (int tile = 0; tile < (kind == FIELD_PLANE ? 9 : 1); tile++) {
            vec3 p = at.position;
            if (kind == FIELD_PLANE)
                p = vec3_add(p, (vec3){(float)(tile % 3 - 1), (float)(tile / 3 - 1), 0.0f});
            if (kind == FIELD_SPHERE || (fabsf(p.x - 0.5f) < 0.5f + beyond && fabsf(p.y - 0.5f) < 0.5f + beyond))
                field_add(&set, p, at.normal, flux);
        }
    }
    return set;
}

static inline photon_map field_map(test_run *r, photon_set *set, uint32_t nearest, float max_radius)
{
    photon_map map;
    photon_map_settings settings = {.nearest = nearest, .max_radius = max_radius, .surface_area = 4.0f * AG_PI};
    assert_int_equal(photon_map_create(&r->run, set, &settings, 0.0, 1.0, &map), AG_OK);
    return map;
}

#endif
