/* surface_region.c: see surface_region.h.
 * Threads: pure functions. */
#include "surface_region.h"

#include "math/rng.h"
#include "math/sampling.h"
#include "rays/transmittance.h"

#include <string.h>

/* Height of rays along the surface, as a share of the radius: a photon's normal is accurate to a degree, and anything
 * lower (a carpet, a skirting) is no wall. */
static const float LIFT = 1.0f / 32.0f;
/* Where nothing stands in the way the surface is looked for this far out; beyond lie 2 % of the disc at most. */
static const float PROBE_AT = 0.9f;
enum { BISECTIONS = 7, FOOT_TRIALS = 3 };
/* Lateral distances are no shorter than this share of the radius. */
static const float SHORTEST = 0x1p-10f;

/* The bounds of the octants, counter-clockwise. */
#define DIAGONAL 0.70710678f
static const float UNIT[SURFACE_REGION_SECTORS][2] = {
    {1.0f, 0.0f},  {DIAGONAL, DIAGONAL},   {0.0f, 1.0f},  {-DIAGONAL, DIAGONAL},
    {-1.0f, 0.0f}, {-DIAGONAL, -DIAGONAL}, {0.0f, -1.0f}, {DIAGONAL, -DIAGONAL}};

static bool is_alike(const surface_hit *hit, vec3 normal, vec3 arrival, float min_cos)
{
    return vec3_dot(vec3_face_forward(hit->geometric_normal, vec3_negate(arrival)), normal) > min_cos;
}

/* The constants of one search. Its rays begin, or end, `lift` above the plane through the point. */
typedef struct probe {
    const scene *s;
    const clear_space *space; /* may be NULL */
    vec3 above, normal;       /* the point, lifted along its normal */
    float lift, radius, min_cos;
    ray_alpha_rule alpha_rule;
    uint64_t *rays; /* counts them */
} probe;

static bool find_surface(const probe *p, vec3 origin, vec3 direction, float farthest, surface_hit *out_hit)
{
    scene_ray ray = scene_ray_make(origin, direction);
    ray.alpha_rule = p->alpha_rule;
    ++*p->rays;
    return scene_find_surface(p->s, ray, farthest, out_hit);
}

/* A picture cuts holes into it, which no photon falls on. */
static bool has_holes(const scene *s, const surface_hit *hit)
{
    return s->shapes[hit->shape_index].alpha_texture != SCENE_NO_TEXTURE;
}

/* The surface at the point itself, from above: its normal, and a start above it, which become the probe's. A narrow
 * corner may have no room for the full lift. */
static bool find_foot(probe *p, vec3 position, vec3 normal, surface_hit *out_foot)
{
    vec3 down = vec3_negate(normal);
    p->lift = p->radius * LIFT;
    for (int trial = 0; trial < FOOT_TRIALS; trial++, p->lift *= 0.125f) {
        vec3 above = vec3_add_scaled(position, normal, p->lift);
        if (!find_surface(p, above, down, 2.0f * p->lift, out_foot) || !is_alike(out_foot, normal, down, 0.9f))
            continue;
        if (vec3_distance_squared(out_foot->position, position) >
            out_foot->epsilon * out_foot->epsilon + 0.01f * p->lift * p->lift)
            continue; /* another surface, between */
        p->normal = vec3_face_forward(out_foot->geometric_normal, normal);
        p->above = vec3_add_scaled(position, p->normal, p->lift);
        return p->lift > 2.0f * out_foot->epsilon;
    }
    return false;
}

/* Whether the surface is there so far along a unit tangent: as deep as photons within the radius may lie. out_holes:
 * whether with holes; may be NULL. */
static bool find_below(const probe *p, vec3 tangent, float lateral, bool *out_holes)
{
    surface_hit hit;
    vec3 start = vec3_add_scaled(p->above, tangent, lateral), down = vec3_negate(p->normal);
    float farthest = p->lift + sqrtf(fmaxf(0.0f, p->radius * p->radius - lateral * lateral));
    if (out_holes)
        *out_holes = false;
    if (p->space && clear_space_ends_ray(p->s, p->space, start, down, farthest, p->min_cos))
        return true;
    bool is_there = find_surface(p, start, down, farthest, &hit) && is_alike(&hit, p->normal, down, p->min_cos);
    if (is_there && out_holes)
        *out_holes = has_holes(p->s, &hit);
    return is_there;
}

/* How far the surface goes along a unit tangent; radius where nothing ends it. */
static float find_extent(const probe *p, vec3 tangent)
{
    surface_hit hit;
    bool is_free =
        p->space && clear_space_has_line(p->s, p->space, p->above, vec3_add_scaled(p->above, tangent, p->radius));
    if (!is_free && find_surface(p, p->above, tangent, p->radius, &hit))
        return is_alike(&hit, p->normal, tangent, p->min_cos) ? p->radius : hit.distance;
    float high = PROBE_AT * p->radius, low = 0.0f;
    if (find_below(p, tangent, high, NULL))
        return p->radius;
    for (int i = 0; i < BISECTIONS; i++) {
        float middle = 0.5f * (low + high);
        if (find_below(p, tangent, middle, NULL))
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* The line with line . p = 1 at both the ends of two neighbouring directions. */
static void line_through(const float *extent, int first, float *out_line)
{
    int second = (first + 1) % SURFACE_REGION_SECTORS;
    float ax = UNIT[first][0] * extent[first], ay = UNIT[first][1] * extent[first];
    float bx = UNIT[second][0] * extent[second], by = UNIT[second][1] * extent[second];
    float inverse = 1.0f / (ax * by - ay * bx);
    out_line[0] = (by - ay) * inverse;
    out_line[1] = (ax - bx) * inverse;
}

/* Between two ends the chord: straight walls and edges are met exactly. Where an edge runs out of the disc between two
 * directions it goes on straight; where that is not known, a chord to the rim leaves some surface out, but takes in
 * none that is not there. */
static void bound_sector(const float *extent, float radius, int i, float *out_line)
{
    enum { COUNT = SURFACE_REGION_SECTORS };
    int next = (i + 1) % COUNT, before = (i + COUNT - 1) % COUNT, after = (i + 2) % COUNT;
    bool is_open = extent[i] >= radius, next_is_open = extent[next] >= radius;
    out_line[0] = out_line[1] = 0.0f;
    if (is_open && next_is_open)
        return;
    if (is_open != next_is_open) {
        int neighbor = is_open ? after : before, open = is_open ? i : next;
        if (extent[neighbor] < radius) {
            line_through(extent, is_open ? next : before, out_line);
            if (radius * (out_line[0] * UNIT[open][0] + out_line[1] * UNIT[open][1]) <= 1.0f)
                return;
        }
    }
    line_through(extent, i, out_line);
}

/* Two tangents at right angles, turned at random by the point, so that no direction is favoured. */
static void find_tangents(vec3 position, vec3 normal, vec3 *out_x, vec3 *out_y)
{
    uint32_t bits[3];
    memcpy(bits, &position, sizeof bits);
    float turn = (float)(hash_combine(hash_combine(bits[0], bits[1]), bits[2]) >> 40) * 0x1p-24f, sine, cosine;
    sincos_turns(turn, &sine, &cosine);
    frame f = frame_from_z(normal);
    *out_x = vec3_add_scaled(vec3_scale(f.x, cosine), f.y, sine);
    *out_y = vec3_add_scaled(vec3_scale(f.y, cosine), f.x, -sine);
}

/* The share of the region where surface is, looked up at one point in each of 8 by 8 parts of the disc. */
static float share_that_is_there(const probe *p, const surface_region *r)
{
    enum { PARTS = 8 };
    uint32_t bits[3];
    memcpy(bits, &r->center, sizeof bits);
    rng random = rng_make(hash_combine(bits[0], bits[1]), 0, bits[2]);
    probe what_is_there = *p;
    what_is_there.alpha_rule = RAY_MEETS_ALPHA;
    int all = 0, there = 0; /* with holes and without */
    for (int i = 0; i < PARTS * PARTS; i++) {
        vec2 u = rng_vec2(&random);
        vec2 d = sample_disk_concentric(
            (vec2){((float)(i % PARTS) + u.x) / (float)PARTS, ((float)(i / PARTS) + u.y) / (float)PARTS});
        float length = sqrtf(d.x * d.x + d.y * d.y);
        if (!(length > 0.0f))
            continue;
        vec3 tangent = vec3_add_scaled(vec3_scale(r->x, d.x / length), r->y, d.y / length);
        if (!surface_region_contains(r, vec3_add_scaled(r->center, tangent, length * p->radius)))
            continue;
        bool is_there = find_below(&what_is_there, tangent, length * p->radius, NULL);
        there += is_there;
        all += is_there || find_below(p, tangent, length * p->radius, NULL);
    }
    /* one more of each, the point itself: of a binomial count that makes the mean of 1 / share right */
    return ((float)there + 1.0f) / ((float)all + 1.0f);
}

bool surface_region_reaches_rim(const scene *s, const clear_space *space, vec3 position, vec3 normal, float min_cos,
                                float radius, uint64_t *in_out_rays)
{
    float lift = LIFT * radius;
    vec3 above = vec3_add_scaled(position, normal, lift), x, y;
    probe p = {s, space, above, normal, lift, radius, min_cos, RAY_MEETS_ALPHA, in_out_rays};
    find_tangents(position, normal, &x, &y);
    for (int i = 0; i < SURFACE_REGION_SECTORS; i += 2) {
        bool has_holes_there;
        vec3 tangent = vec3_add_scaled(vec3_scale(x, UNIT[i][0]), y, UNIT[i][1]);
        if (!find_below(&p, tangent, PROBE_AT * radius, &has_holes_there) || has_holes_there)
            return false;
    }
    return true;
}

bool surface_region_is_whole(const scene *s, const clear_space *space, vec3 position, vec3 normal, float min_cos,
                             float radius)
{
    return clear_space_holds_disc(s, space, position, normal, radius, PROBE_AT, min_cos);
}

bool surface_region_find(const scene *s, const clear_space *space, vec3 position, vec3 normal, float min_cos,
                         float radius, uint64_t *in_out_rays, surface_region *out_region)
{
    float extent[SURFACE_REGION_SECTORS];
    surface_region *r = out_region;
    probe p = {s, space, position, normal, 0.0f, radius, min_cos, RAY_MEETS_ALPHA, in_out_rays};
    surface_hit foot;
    if (!find_foot(&p, position, normal, &foot))
        return false;
    bool may_be_empty = has_holes(s, &foot);
    r->center = position;
    find_tangents(position, p.normal, &r->x, &r->y);

    if (may_be_empty)
        p.alpha_rule = RAY_MEETS_EMPTY_ALPHA; /* holes are no ends: there may be one in every direction */
    r->nearest_end = radius;
    for (int i = 0; i < SURFACE_REGION_SECTORS; i++) {
        extent[i] = find_extent(&p, vec3_add_scaled(vec3_scale(r->x, UNIT[i][0]), r->y, UNIT[i][1]));
        r->nearest_end = fminf(r->nearest_end, extent[i]);
        extent[i] = fmaxf(extent[i], SHORTEST * radius);
    }
    if (r->nearest_end >= radius && !may_be_empty)
        return false;
    for (int i = 0; i < SURFACE_REGION_SECTORS; i++)
        bound_sector(extent, radius, i, r->line[i]);
    r->share = may_be_empty ? share_that_is_there(&p, r) : 1.0f;
    return r->nearest_end < radius || r->share < 1.0f;
}

bool surface_region_contains(const surface_region *region, vec3 position)
{
    vec3 offset = vec3_sub(position, region->center);
    float x = vec3_dot(offset, region->x), y = vec3_dot(offset, region->y);
    const float *line = region->line[SURFACE_REGION_OCTANT[(y < 0.0f) * 4 + (x < 0.0f) * 2 + (fabsf(y) > fabsf(x))]];
    return line[0] * x + line[1] * y <= 1.0f;
}

double surface_region_area(const surface_region *region, float radius)
{
    /* the middles of eight parts of an octant, by cosine and sine */
    enum { PARTS = 8 };
    static const float PART[PARTS][2] = {
        {0.99879546f, 0.04906767f}, {0.98917651f, 0.14673047f}, {0.97003125f, 0.24298018f}, {0.94154407f, 0.33688985f},
        {0.90398929f, 0.42755509f}, {0.85772861f, 0.51410274f}, {0.80320753f, 0.59569930f}, {0.74095113f, 0.67155895f}};
    double sum = 0.0;
    for (int i = 0; i < SURFACE_REGION_SECTORS; i++) {
        float a = region->line[i][0], b = region->line[i][1], ux = UNIT[i][0], uy = UNIT[i][1];
        float along = a * ux + b * uy, across = b * ux - a * uy;
        for (int k = 0; k < PARTS; k++) {
            float nearness = along * PART[k][0] + across * PART[k][1]; /* one over the distance of the chord */
            float reach = nearness * radius > 1.0f ? 1.0f / nearness : radius;
            sum += (double)reach * (double)reach;
        }
    }
    return (double)region->share * sum * (double)AG_PI / (SURFACE_REGION_SECTORS * PARTS);
}
