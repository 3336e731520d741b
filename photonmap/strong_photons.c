/* strong_photons.c: see strong_photons.h. */
#include "strong_photons.h"

#include "caustic_radius.h"
#include "math/sampling.h"
#include "photon_map.h"
#include "rays/transmittance.h"
#include "status.h"

#include <stdlib.h>
#include <string.h>

/* Rays along the surface begin at this share of the radius above it: lower things are no wall. */
static const float LIFT = 1.0f / 32.0f;
/* The point from which parts' places are looked at is at most so far up as the parts lie out, and in a gap so far up as
 * this share of it. */
static const float GAP_SHARE = 0.5f;
/* A place that is higher or lower than this share of its distance is on another surface. */
static const float STEEPEST = 0.5f;
/* Neighbouring points of a spiral are this part of a turn apart, by which they lie evenly in the disc (Vogel, "A Better
 * Way to Construct the Sunflower Head", 1979). */
static const float GOLDEN_TURN = 0.381966f;

/* The surface that a strong photon lies on, and the point above it from which its parts' places are looked at. */
typedef struct photon_ground {
    vec3 position, normal; /* on the side of the photon's arrival */
    uint32_t shape, instance;
    vec3 above;
} photon_ground;

static bool find_surface(const scene *s, vec3 origin, vec3 direction, float farthest, surface_hit *out_hit)
{
    scene_ray ray = scene_ray_make(origin, direction);
    ray.alpha_rule = RAY_MEETS_ALPHA;
    return scene_find_surface(s, ray, farthest, out_hit);
}

/* reach: how far from the photon its parts may lie. Returns false where the surface is not found. */
static bool find_ground(const scene *s, const photon *p, float radius, float reach, photon_ground *out)
{
    surface_hit foot, over;
    vec3 position = {p->position[0], p->position[1], p->position[2]}, normal = direction_decode(p->normal);
    float lift = radius * LIFT;
    vec3 low = vec3_add_scaled(position, normal, lift);
    if (!find_surface(s, low, vec3_negate(normal), 2.0f * lift, &foot))
        return false;
    normal = vec3_face_forward(foot.geometric_normal, normal);
    bool is_gap = find_surface(s, low, normal, reach / GAP_SHARE, &over);
    float height = is_gap ? fmaxf(GAP_SHARE * over.distance, lift) : reach;
    *out = (photon_ground){.position = position,
                           .normal = normal,
                           .shape = foot.shape_index,
                           .instance = foot.instance_index,
                           .above = vec3_add_scaled(position, normal, height)};
    return true;
}

/* Finds the place on the surface in the direction of a point of the tangent plane. Returns false where another surface
 * is seen there, or none. */
static bool find_place(const scene *s, const photon_ground *ground, vec3 offset, vec3 *out_position, vec3 *out_normal)
{
    surface_hit hit;
    vec3 to = vec3_sub(vec3_add(ground->position, offset), ground->above);
    float distance = vec3_length(to);
    if (!find_surface(s, ground->above, vec3_scale(to, 1.0f / distance), 2.0f * distance, &hit) ||
        hit.shape_index != ground->shape || hit.instance_index != ground->instance)
        return false;
    vec3 normal = vec3_face_forward(hit.geometric_normal, vec3_negate(to)),
         from = vec3_sub(hit.position, ground->position);
    float height = vec3_dot(from, ground->normal), steepest = STEEPEST * vec3_length(offset);
    if (!(vec3_dot(normal, ground->normal) > PHOTON_ESTIMATE_MIN_COS) || fabsf(height) > steepest)
        return false;
    *out_position = hit.position;
    *out_normal = normal;
    return true;
}

static uint32_t count_parts(const photon *p, double each)
{
    double ratio = (double)flux_largest(p->flux) / each;
    return ratio > (double)STRONG_PHOTON_RATIO ? (uint32_t)ceil(ratio) : 1;
}

/* Writes the parts of a photon; the first one takes its place in the array. */
static void divide(const scene *s, float radius, uint32_t parts, double each, photon *whole, photon *others)
{
    uint64_t key = hash_of_ray(parts, (vec3){whole->position[0], whole->position[1], whole->position[2]},
                               direction_decode(whole->normal));
    const photon strong = *whole;
    float reach = radius * sqrtf((float)((double)flux_largest(strong.flux) / (each * (double)STRONG_PHOTON_RATIO)));
    float turn = (float)(key >> 40) * 0x1p-24f;
    photon_ground ground;
    bool has_ground = find_ground(s, &strong, radius, reach, &ground);
    const frame around = frame_from_z(has_ground ? ground.normal : direction_decode(strong.normal));
    for (uint32_t i = 0; i < parts; i++) {
        photon *part = i == 0 ? whole : &others[i - 1];
        vec3 position, normal;
        float sine, cosine, length = reach * sqrtf(((float)i + 0.5f) / (float)parts);
        float turns = turn + GOLDEN_TURN * (float)i;
        sincos_turns(turns - floorf(turns), &sine, &cosine);
        vec3 offset = frame_to_world(&around, (vec3){length * cosine, length * sine, 0.0f});
        *part = strong;
        part->flux = flux_encode(rgb_scale(flux_decode(strong.flux), 1.0f / (float)parts), hash_combine(key, i));
        if (!has_ground || !find_place(s, &ground, offset, &position, &normal))
            continue;
        part->position[0] = position.x;
        part->position[1] = position.y;
        part->position[2] = position.z;
        part->normal = direction_encode(normal);
    }
}

/* Makes room for so many photons more. */
static ag_status grow(photon_set *set, uint32_t added)
{
    photon *larger = photon_records_create(set->count + added);
    if (!larger)
        return AG_ERROR_MEMORY;
    memcpy(larger, set->photons, set->count * sizeof *larger);
    free(set->photons);
    set->photons = larger;
    return AG_OK;
}

ag_status strong_photons_divide(const scene *s, float radius, photon_set *in_out_set)
{
    const double each = caustic_flux_each(in_out_set);
    uint32_t added = 0;
    for (uint32_t i = 0; each > 0.0 && i < in_out_set->count; i++)
        added += count_parts(&in_out_set->photons[i], each) - 1;
    if (added == 0 || !(radius > 0.0f))
        return AG_OK;
    AG_TRY(grow(in_out_set, added));
    uint32_t count = in_out_set->count;
    for (uint32_t i = 0; i < in_out_set->count; i++) {
        uint32_t parts = count_parts(&in_out_set->photons[i], each);
        if (parts == 1)
            continue;
        divide(s, radius, parts, each, &in_out_set->photons[i], &in_out_set->photons[count]);
        count += parts - 1;
    }
    in_out_set->count = count;
    return AG_OK;
}
