/* glint_guide.c: see glint_guide.h. */
#include "glint_guide.h"

#include "math/sampling.h"

/* The cones around a photon's direction: 1 - the cosine of 2, 6 and 18 degrees. Photons keep their direction within a
 * degree and a half; from a near lamp it changes much between the photons. */
enum { CONES = 3 };
static const float CONE[CONES] = {6.0917e-4f, 5.4781e-3f, 4.8943e-2f};

/* Rounding may put a sample of a cone just beyond its rim. The density takes each cone as this much wider, so that no
 * sample has a density of 0. */
static const float ROUNDED_UP = 1.0f + 1e-5f;

/* The least number of photons of a guide, and the least cosine between their normals and the point's. */
enum { LEAST = 8 };
static const float NORMAL_MIN_COS = 0.8f;

bool glint_guide_find(const photon_tree *tree, vec3 position, vec3 normal, float reach, glint_guide *out_guide)
{
    out_guide->count = 0;
    if (tree->count == 0)
        return false;
    uint32_t first = photon_tree_leaf(tree, position) / GLINT_BLOCKS * GLINT_PHOTONS;
    uint32_t last_code = UINT32_MAX; /* of a normal: neighbours mostly have the same one */
    bool faces_alike = false;
    float sum = 0.0f;
    for (uint32_t i = first; i < tree->count && i < first + GLINT_PHOTONS; i++) {
        if (!(vec3_distance_squared(photon_block_position(tree->blocks, i), position) < reach * reach))
            continue;
        uint16_t code = photon_block_normal(tree->blocks, i);
        if (code != last_code)
            faces_alike = vec3_dot(direction_decode(code), normal) > NORMAL_MIN_COS;
        last_code = code;
        if (!faces_alike)
            continue;
        const photon_block *b = &tree->blocks[i / PHOTON_BLOCK_LANES];
        sum += flux_largest(photon_block_flux(tree->blocks, i));
        out_guide->to_light[out_guide->count] = vec3_negate(arrival_direction(b->direction[i % PHOTON_BLOCK_LANES]));
        out_guide->end[out_guide->count++] = sum;
    }
    if (out_guide->count < LEAST || !(sum > 0.0f && sum < INFINITY))
        return false;
    for (uint32_t i = 0; i < out_guide->count; i++)
        out_guide->end[i] /= sum;
    return true;
}

vec3 glint_guide_sample(const glint_guide *guide, float u_pick, vec2 u)
{
    uint32_t i = 0;
    float begin = 0.0f;
    while (i + 1 < guide->count && guide->end[i] <= u_pick)
        begin = guide->end[i++];
    /* where in the photon's share the number lies picks the cone */
    int cone = (int)((float)CONES * (u_pick - begin) / (guide->end[i] - begin));
    frame f = frame_from_z(guide->to_light[i]);
    return frame_to_world(&f, sample_uniform_cone(u, CONE[cone < CONES ? cone : CONES - 1]));
}

float glint_guide_density(const glint_guide *guide, vec3 direction)
{
    float inside[CONES] = {0.0f}, begin = 0.0f, density = 0.0f; /* the share of the photons around whose directions
                                                                     each cone contains this one */
    for (uint32_t i = 0; i < guide->count; i++) {
        float away = 1.0f - vec3_dot(guide->to_light[i], direction), share = guide->end[i] - begin;
        begin = guide->end[i];
        for (int k = 0; k < CONES; k++)
            inside[k] += away <= CONE[k] * ROUNDED_UP ? share : 0.0f;
    }
    for (int k = 0; k < CONES; k++)
        density += inside[k] / (CONES * 2.0f * AG_PI * CONE[k]);
    return density;
}
