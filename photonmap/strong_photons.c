/* strong_photons.c: see strong_photons.h. */
#include "strong_photons.h"

#include "caustic_radius.h"
#include "math/sampling.h"
#include "photon_map.h"
#include "rays/transmittance.h"
#include "status.h"
#include "surface_region.h"

#include <stdlib.h>
#include <string.h>

/* The places of parts are looked for from a point above the photon. It is as high as the parts lie out; below a ceiling
 * that is lower it is at this share of the ceiling's height. */
static const float GAP_SHARE = 0.5f;
/* Neighbouring points of a spiral are this part of a turn apart, by which they lie evenly in the disc (Vogel, "A Better
 * Way to Construct the Sunflower Head", 1979). */
static const float GOLDEN_TURN = 0.381966f;

/* The surface that a strong photon lies on, and the point above it from which places of its parts are looked for. */
typedef struct photon_ground {
    vec3 position, normal; /* unit, on the side of the photon's arrival */
    uint32_t shape, instance;
    vec3 above;
    float reach; /* how far from the photon its parts may lie, scene units */
} photon_ground;

typedef struct divider {
    const scene *s;
    float radius;
    double each; /* the mean flux, weighted by flux */
    uint64_t rays;
} divider;

/* Returns false where the photon's surface is not found. */
static bool find_ground(divider *d, const photon *p, photon_ground *out)
{
    surface_hit foot, over;
    float lift, reach = d->radius * sqrtf((float)((double)flux_largest(p->flux) / (d->each * STRONG_PHOTON_RATIO)));
    const vec3 position = photon_position(p), arrived = direction_decode(p->normal);
    if (!surface_region_find_foot(d->s, position, arrived, d->radius, &d->rays, &foot, &lift))
        return false;
    const vec3 normal = vec3_face_forward(foot.geometric_normal, arrived);
    const scene_ray up = scene_ray_make(vec3_add_scaled(position, normal, lift), normal);
    d->rays++;
    bool is_gap = scene_find_surface(d->s, up, reach / GAP_SHARE, &over);
    float height = is_gap ? float_max(GAP_SHARE * over.distance, lift) : reach;
    *out = (photon_ground){.position = position,
                           .normal = normal,
                           .shape = foot.shape_index,
                           .instance = foot.instance_index,
                           .above = vec3_add_scaled(position, normal, height),
                           .reach = reach};
    return true;
}

/* Finds the place on the surface that is seen, from the point above, in the direction of a point of the tangent plane.
 * Returns false where it is not the photon's surface that is seen there. */
static bool find_place(divider *d, const photon_ground *ground, vec3 offset, photon *in_out_part)
{
    surface_hit hit;
    const vec3 to = vec3_sub(vec3_add(ground->position, offset), ground->above);
    float distance = vec3_length(to);
    d->rays++;
    if (!scene_find_surface(d->s, scene_ray_make(ground->above, vec3_scale(to, 1.0f / distance)), 2.0f * distance,
                            &hit) ||
        hit.shape_index != ground->shape || hit.instance_index != ground->instance)
        return false;
    const vec3 normal = vec3_face_forward(hit.geometric_normal, vec3_negate(to)),
               from = vec3_sub(hit.position, ground->position);
    float cosine = vec3_dot(normal, ground->normal), height = vec3_dot(from, ground->normal);
    float lateral_squared = vec3_dot(from, from) - height * height;
    if (!(cosine > PHOTON_ESTIMATE_MIN_COS) ||
        surface_region_is_below_step(d->radius, lateral_squared, fabsf(height), cosine))
        return false;
    photon_set_position(in_out_part, hit.position);
    in_out_part->normal = direction_encode(normal);
    return true;
}

/* Returns 1 for a photon that is not divided. */
static uint32_t count_parts(const photon *p, double each)
{
    double ratio = (double)flux_largest(p->flux) / each;
    return ratio > (double)STRONG_PHOTON_RATIO ? (uint32_t)ceil(ratio) : 1;
}

/* The point of an even spiral over the unit disc, in turns from where it begins. */
static vec2 spiral_point(uint32_t i, uint32_t count, float begin)
{
    float turns = begin + GOLDEN_TURN * (float)i, length = sqrtf(((float)i + 0.5f) / (float)count), sine, cosine;
    sincos_turns(turns - floorf(turns), &sine, &cosine);
    return (vec2){length * cosine, length * sine};
}

/* Appends the parts that have a place of their own to the set, which has room for all of them; the photon keeps the
 * flux of those that have none. */
static void divide(divider *d, uint32_t parts, uint32_t index, photon_set *set)
{
    const photon whole = set->photons[index];
    const rgb flux = flux_decode(whole.flux);
    const uint64_t key = hash_of_ray(0x70617274u, photon_position(&whole), direction_decode(whole.normal));
    const float begin = (float)(key >> 40) * 0x1p-24f;
    photon_ground ground;
    if (!find_ground(d, &whole, &ground))
        return;
    const frame around = frame_from_z(ground.normal);
    uint32_t staying = 0;
    for (uint32_t i = 0; i < parts; i++) {
        photon part = whole;
        vec2 at = spiral_point(i, parts, begin);
        vec3 offset = frame_to_world(&around, (vec3){ground.reach * at.x, ground.reach * at.y, 0.0f});
        if (!find_place(d, &ground, offset, &part) && !find_place(d, &ground, vec3_negate(offset), &part)) {
            staying++;
            continue;
        }
        part.flux = flux_encode(rgb_scale(flux, 1.0f / (float)parts), hash_combine(key, i));
        set->photons[set->count++] = part;
    }
    if (staying > 0)
        set->photons[index].flux =
            flux_encode(rgb_scale(flux, (float)staying / (float)parts), hash_combine(key, parts));
    else
        set->photons[index] = set->photons[--set->count];
}

/* Makes a set of the same photons, with room for so many more. */
static ag_status copy_with_room(const photon_set *set, uint64_t room, photon_set *out_set)
{
    *out_set = *set;
    if (room >= PHOTON_NONE - set->count)
        return AG_ERROR_MEMORY;
    out_set->photons = photon_records_create(set->count + (uint32_t)room);
    if (!out_set->photons)
        return AG_ERROR_MEMORY;
    memcpy(out_set->photons, set->photons, set->count * sizeof *set->photons);
    return AG_OK;
}

ag_status strong_photons_divide(const scene *s, const run_context *run, float radius, photon_set *in_out_set)
{
    divider d = {.s = s, .radius = radius, .each = caustic_flux_each(in_out_set)};
    uint64_t room = 0;
    for (uint32_t i = 0; d.each > 0.0 && i < in_out_set->count; i++) {
        uint32_t parts = count_parts(&in_out_set->photons[i], d.each);
        room += parts > 1 ? parts : 0;
    }
    if (room == 0 || !(radius > 0.0f))
        return AG_OK;
    photon_set divided;
    AG_TRY(copy_with_room(in_out_set, room, &divided));
    for (uint32_t i = 0; i < in_out_set->count; i++) {
        uint32_t parts = count_parts(&in_out_set->photons[i], d.each);
        if (parts == 1)
            continue;
        if (run_is_cancelled(run)) {
            photon_set_reset(&divided);
            return AG_CANCELLED;
        }
        divide(&d, parts, i, &divided);
    }
    divided.rays += d.rays;
    photon_set_reset(in_out_set);
    *in_out_set = divided;
    return AG_OK;
}
