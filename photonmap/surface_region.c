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
/* Before what stands in the way the surface is looked for up to this share of the way there: a rod beside another one
 * ends before it, and so does the ridge of a moulding before the next one. */
static const float PROBE_BEFORE = 0.98f;
/* On strips ends are found within this share of how far they are, so that the strip's direction is known. */
static const float FINE = 1.0f / 64.0f;
enum { BISECTIONS = 7, BISECTIONS_MOST = 12, FOOT_TRIALS = 3 };
/* A surface that falls by less than this share of the way is taken as flat: its area is right within 0.04 %. The plane
 * that bounds a clear space is level if the cosine between the normals is above FLAT_COS. */
static const float FLAT_SLOPE = 0.02f, FLAT_COS = 0.9999f;
/* The largest tangent of half the angle by which a surface bends: normals are alike up to the angle whose cosine is
 * PHOTON_ESTIMATE_MIN_COS. */
static const float HALF_BEND_MOST = 0.333333f;
/* The drop tells nothing of a bend across the tangent: the cosine between the two counts as no less than this. */
static const float ALONG_LEAST = 0.25f;
/* Lateral distances are no shorter than this share of the radius. */
static const float SHORTEST = 0x1p-10f;

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
    bool is_fine; /* short distances are found as accurately as long ones */
    ray_alpha_rule alpha_rule;
    uint64_t *rays; /* counts them */
} probe;

/* The probe of a point above which rays have yet to begin: see find_foot. */
static probe probe_make(const scene *s, const clear_space *space, float min_cos, float radius, uint64_t *in_out_rays)
{
    return (probe){.s = s,
                   .space = space,
                   .radius = radius,
                   .min_cos = min_cos,
                   .alpha_rule = RAY_MEETS_ALPHA,
                   .rays = in_out_rays};
}

static bool find_surface(const probe *p, vec3 origin, vec3 direction, float farthest, surface_hit *out_hit)
{
    scene_ray ray = scene_ray_make(origin, direction);
    ray.alpha_rule = p->alpha_rule;
    ++*p->rays;
    return scene_find_surface(p->s, ray, farthest, out_hit);
}

/* Returns whether an alpha texture may cut holes into the surface, on which no photon falls. */
static bool has_holes(const scene *s, const surface_hit *hit)
{
    return s->shapes[hit->shape_index].alpha_texture != SCENE_NO_TEXTURE;
}

bool surface_region_find_foot(const scene *s, vec3 position, vec3 normal, float radius, uint64_t *in_out_rays,
                              surface_hit *out_foot, float *out_lift)
{
    const vec3 down = vec3_negate(normal);
    float lift = radius * LIFT;
    for (int trial = 0; trial < FOOT_TRIALS; trial++, lift *= 0.125f) {
        scene_ray ray = scene_ray_make(vec3_add_scaled(position, normal, lift), down);
        ++*in_out_rays;
        if (!scene_find_surface(s, ray, 2.0f * lift, out_foot) || !is_alike(out_foot, normal, down, 0.9f))
            continue;
        if (vec3_distance_squared(out_foot->position, position) >
            out_foot->epsilon * out_foot->epsilon + 0.01f * lift * lift)
            continue; /* another surface, between */
        *out_lift = lift;
        return lift > 2.0f * out_foot->epsilon;
    }
    return false;
}

/* Takes the surface at the point, and a start above it, for the probe's. */
static bool find_foot(probe *p, vec3 position, vec3 normal, surface_hit *out_foot)
{
    if (!surface_region_find_foot(p->s, position, normal, p->radius, p->rays, out_foot, &p->lift))
        return false;
    p->normal = vec3_face_forward(out_foot->geometric_normal, normal);
    p->above = vec3_add_scaled(position, p->normal, p->lift);
    return true;
}

/* The surface that a probe has found below. Nothing is known of it where no ray has met it, but a clear space has told
 * that it is there. */
typedef struct below {
    bool is_met; /* by a ray */
    bool has_holes;
    float drop; /* below the plane through the point, scene units */
    vec3 normal;
} below;

static vec3 start_of_probe(const probe *p, vec3 tangent, float lateral)
{
    return vec3_add_scaled(p->above, tangent, lateral);
}

bool surface_region_is_below_step(float radius, float lateral_squared, float drop, float cosine)
{
    float excess = drop - LIFT * radius;
    return excess > 0.0f && excess * excess * cosine * cosine > lateral_squared * (1.0f - cosine * cosine);
}

/* Whether a ray meets the surface so far along a unit tangent: as deep as photons within the radius may lie. */
static bool meet_below(const probe *p, vec3 tangent, float lateral, float farthest, below *out)
{
    surface_hit hit;
    vec3 down = vec3_negate(p->normal);
    if (!find_surface(p, start_of_probe(p, tangent, lateral), down, farthest, &hit) ||
        !is_alike(&hit, p->normal, down, p->min_cos))
        return false;
    *out = (below){.is_met = true,
                   .has_holes = has_holes(p->s, &hit),
                   .drop = hit.distance - p->lift,
                   .normal = vec3_face_forward(hit.geometric_normal, p->normal)};
    return !surface_region_is_below_step(p->radius, lateral * lateral, out->drop, vec3_dot(out->normal, p->normal));
}

/* Returns whether the surface that a clear space is of lies no lower than a step: it may have been found at another
 * point, and be the wall behind the point's board. */
static bool is_of_same_level(const probe *p)
{
    if (p->space->plane_count == 0)
        return false;
    const clear_space_plane *plane = &p->space->plane[0];
    float cosine = vec3_dot(plane->normal, p->normal), above = vec3_dot(plane->normal, p->above) - plane->height;
    return cosine > 0.0f && above < (p->lift + 0.5f * LIFT * p->radius) * cosine;
}

/* Returns what meet_below does, without a ray where the clear space tells the answer. */
static bool find_below(const probe *p, vec3 tangent, float lateral, below *out)
{
    float farthest = p->lift + sqrtf(float_max(p->radius * p->radius - lateral * lateral, 0.0f));
    *out = (below){0};
    return (p->space && is_of_same_level(p) &&
            clear_space_ends_ray(p->s, p->space, start_of_probe(p, tangent, lateral), vec3_negate(p->normal), farthest,
                                 p->min_cos)) ||
           meet_below(p, tangent, lateral, farthest, out);
}

/* How a surface bends on its way out along a unit tangent to what was found below: its normal's part in the plane there
 * by how far that is, if it were an arc of a circle. The drop tells it rather than the normal, since most of a board
 * with a round edge is flat; the normal tells which way it bends. */
static vec3 find_bend(const probe *p, vec3 tangent, float lateral, const below *found)
{
    below met = *found;
    const vec3 flat = {0.0f, 0.0f, 0.0f};
    if (!met.is_met) {
        bool is_level =
            p->space && p->space->plane_count > 0 && vec3_dot(p->space->plane[0].normal, p->normal) > FLAT_COS;
        if (is_level || !meet_below(p, tangent, lateral, INFINITY, &met))
            return flat;
    }
    float slope = met.drop / lateral; /* the tangent of half the angle */
    vec3 tilt = vec3_add_scaled(met.normal, p->normal, -vec3_dot(met.normal, p->normal));
    float length = vec3_length(tilt);
    if (fabsf(slope) < FLAT_SLOPE || !(length > FLAT_SLOPE))
        return flat;
    /* the drop is along the tangent, the bend along the tilt */
    float along = float_max(fabsf(vec3_dot(tilt, tangent)) / length, ALONG_LEAST);
    float half = float_min(fabsf(slope) / along, HALF_BEND_MOST), sine = 2.0f * half / (1.0f + half * half);
    return vec3_scale(tilt, sine / (length * lateral));
}

/* How far the surface goes along a unit tangent; radius where nothing ends it. */
static float find_extent(const probe *p, vec3 tangent, vec3 *out_bend)
{
    surface_hit hit;
    *out_bend = (vec3){0.0f, 0.0f, 0.0f};
    float end = p->radius, high = PROBE_AT * p->radius, low = 0.0f;
    bool is_free =
        p->space && clear_space_has_line(p->s, p->space, p->above, vec3_add_scaled(p->above, tangent, p->radius));
    if (!is_free && find_surface(p, p->above, tangent, p->radius, &hit)) {
        end = is_alike(&hit, p->normal, tangent, p->min_cos) ? p->radius : hit.distance;
        high = float_min(high, PROBE_BEFORE * hit.distance);
    }
    below last, found;
    if (find_below(p, tangent, high, &last)) {
        *out_bend = find_bend(p, tangent, high, &last);
        return end;
    }
    for (int i = 0; i < BISECTIONS || (p->is_fine && i < BISECTIONS_MOST && high - low > FINE * low); i++) {
        float middle = 0.5f * (low + high);
        if (find_below(p, tangent, middle, &found)) {
            low = middle;
            last = found;
        } else {
            high = middle;
        }
    }
    if (low > 0.0f)
        *out_bend = find_bend(p, tangent, low, &last);
    return low;
}

/* The line with line . p = 1 at both the ends of two neighbouring directions. */
static void line_through(const float *extent, int first, float *out_line)
{
    int second = (first + 1) % SURFACE_REGION_OCTANTS;
    float ax = SURFACE_REGION_BOUND[first][0] * extent[first], ay = SURFACE_REGION_BOUND[first][1] * extent[first];
    float bx = SURFACE_REGION_BOUND[second][0] * extent[second], by = SURFACE_REGION_BOUND[second][1] * extent[second];
    float inverse = 1.0f / (ax * by - ay * bx);
    out_line[0] = (by - ay) * inverse;
    out_line[1] = (ax - bx) * inverse;
}

/* Between two ends the chord: straight walls and edges are met exactly. Where an edge runs out of the disc between two
 * directions it goes on straight; where that is not known, a chord to the rim leaves some surface out, but takes in
 * none that is not there. */
static void bound_octant(const float *extent, float radius, int i, float *out_line)
{
    enum { COUNT = SURFACE_REGION_OCTANTS };
    int next = (i + 1) % COUNT, before = (i + COUNT - 1) % COUNT, after = (i + 2) % COUNT;
    bool is_open = extent[i] >= radius, next_is_open = extent[next] >= radius;
    out_line[0] = out_line[1] = 0.0f;
    if (is_open && next_is_open)
        return;
    if (is_open != next_is_open) {
        int neighbor = is_open ? after : before, open = is_open ? i : next;
        if (extent[neighbor] < radius) {
            line_through(extent, is_open ? next : before, out_line);
            if (radius * (out_line[0] * SURFACE_REGION_BOUND[open][0] + out_line[1] * SURFACE_REGION_BOUND[open][1]) <=
                1.0f)
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
    int all = 0, there = 0; /* points of the region; those where the surface is */
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
        below found;
        surface_hit rise;
        all++;
        bool has_risen = find_surface(&what_is_there, p->above, tangent, length * p->radius, &rise) &&
                         is_alike(&rise, p->normal, tangent, p->min_cos);
        there += has_risen || find_below(&what_is_there, tangent, length * p->radius, &found);
    }
    /* the centre counts too: (n + 1) / (N + 1) makes 1 / share of a binomial count nearly unbiased */
    return ((float)there + 1.0f) / ((float)all + 1.0f);
}

bool surface_region_reaches_rim(const scene *s, const clear_space *space, vec3 position, vec3 normal, float min_cos,
                                float radius, uint64_t *in_out_rays)
{
    vec3 x, y;
    probe p = probe_make(s, space, min_cos, radius, in_out_rays);
    p.normal = normal;
    p.lift = LIFT * radius;
    p.above = vec3_add_scaled(position, normal, p.lift);
    find_tangents(position, normal, &x, &y);
    for (int i = 0; i < SURFACE_REGION_OCTANTS; i += 2) {
        below found;
        vec3 tangent = vec3_add_scaled(vec3_scale(x, SURFACE_REGION_BOUND[i][0]), y, SURFACE_REGION_BOUND[i][1]);
        if (!find_below(&p, tangent, PROBE_AT * radius, &found) || found.has_holes)
            return false;
    }
    return true;
}

bool surface_region_is_whole(const scene *s, const clear_space *space, vec3 position, vec3 normal, float min_cos,
                             float radius)
{
    return clear_space_holds_disc(s, space, position, normal, radius, PROBE_AT, min_cos);
}

/* Finds the region in the frame x, y. Returns false where the surface has neither an end nor a hole. */
static bool fill_region(probe *p, bool may_be_empty, surface_region *r)
{
    float extent[SURFACE_REGION_OCTANTS];
    if (may_be_empty)
        p->alpha_rule = RAY_MEETS_EMPTY_ALPHA; /* holes are no ends: there may be one in every direction */
    r->nearest_end = p->radius;
    for (int i = 0; i < SURFACE_REGION_OCTANTS; i++) {
        vec3 bend;
        extent[i] = find_extent(
            p, vec3_add_scaled(vec3_scale(r->x, SURFACE_REGION_BOUND[i][0]), r->y, SURFACE_REGION_BOUND[i][1]), &bend);
        r->bend[i][0] = vec3_dot(bend, r->x);
        r->bend[i][1] = vec3_dot(bend, r->y);
        r->nearest_end = float_min(r->nearest_end, extent[i]);
        extent[i] = float_max(extent[i], SHORTEST * p->radius);
    }
    if (r->nearest_end >= p->radius && !may_be_empty && !r->has_steps)
        return false;
    for (int i = 0; i < SURFACE_REGION_OCTANTS; i++)
        bound_octant(extent, p->radius, i, r->line[i]);
    r->share = may_be_empty ? share_that_is_there(p, r) : 1.0f;
    return r->nearest_end < p->radius || r->share < 1.0f || r->has_steps;
}

bool surface_region_find(const scene *s, const clear_space *space, vec3 position, vec3 normal, float min_cos,
                         float radius, uint64_t *in_out_rays, surface_region *in_out_region)
{
    probe p = probe_make(s, space, min_cos, radius, in_out_rays);
    surface_hit foot;
    if (!find_foot(&p, position, normal, &foot))
        return false;
    in_out_region->center = position;
    find_tangents(position, p.normal, &in_out_region->x, &in_out_region->y);
    return fill_region(&p, has_holes(s, &foot), in_out_region);
}

void surface_region_leave_steps(const scene *s, const clear_space *space, vec3 normal, float min_cos, float radius,
                                uint64_t *in_out_rays, surface_region *in_out_region)
{
    probe p = probe_make(s, space, min_cos, radius, in_out_rays);
    surface_hit foot;
    if (find_foot(&p, in_out_region->center, normal, &foot))
        in_out_region->share = share_that_is_there(&p, in_out_region);
}

/* Turns the frame so that x runs along the nearest of the region's bounds. */
static void turn_along_edge(surface_region *r)
{
    float largest = 0.0f, along[2] = {1.0f, 0.0f};
    for (int i = 0; i < SURFACE_REGION_OCTANTS; i++) {
        float a = r->line[i][0], b = r->line[i][1], square = a * a + b * b;
        if (square > largest) {
            float inverse = 1.0f / sqrtf(square);
            largest = square;
            along[0] = b * inverse;
            along[1] = -a * inverse;
        }
    }
    vec3 x = vec3_add_scaled(vec3_scale(r->x, along[0]), r->y, along[1]);
    r->y = vec3_add_scaled(vec3_scale(r->y, along[0]), r->x, -along[1]);
    r->x = x;
}

void surface_region_follow_strip(const scene *s, const clear_space *space, vec3 normal, float min_cos, float radius,
                                 uint64_t *in_out_rays, surface_region *in_out_region)
{
    probe p = probe_make(s, space, min_cos, radius, in_out_rays);
    surface_hit foot;
    p.is_fine = true;
    if (!find_foot(&p, in_out_region->center, normal, &foot))
        return;
    surface_region turned = *in_out_region;
    turn_along_edge(&turned);
    if (fill_region(&p, has_holes(s, &foot), &turned) &&
        surface_region_area(&turned, radius) > surface_region_area(in_out_region, radius))
        *in_out_region = turned;
}

bool surface_region_contains(const surface_region *region, vec3 position)
{
    vec3 offset = vec3_sub(position, region->center);
    float x = vec3_dot(offset, region->x), y = vec3_dot(offset, region->y);
    const float *line =
        region->line[SURFACE_REGION_OCTANT_BY_SIGNS[(y < 0.0f) * 4 + (x < 0.0f) * 2 + (fabsf(y) > fabsf(x))]];
    return line[0] * x + line[1] * y <= 1.0f;
}
