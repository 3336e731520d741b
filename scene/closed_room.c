/* closed_room.c: see closed_room.h. Threads: one. */
#include "closed_room.h"

#include "math/sampling.h"
#include "rays/transmittance.h"

/* Candidate positions along and across, and heights; directions tried around each; and headings to look along. */
enum { GRID = 12, HEIGHTS = 3, DIRECTIONS = 64, HEADINGS = 32, OPEN_HEADINGS_MAX = 4, PANES_MAX = 16 };
static const float HEIGHT_SHARES[HEIGHTS] = {0.45f, 0.25f, 0.7f};

/* Least shares of the directions from a place in a room. */
static const float ENCLOSED = 0.85f; /* that end at a surface */
static const float FACING = 0.7f;    /* of these, that end at a surface's front, where walls have two sides */
static const float ON_BOUNDS = 0.5f; /* of these, that end on the bounds, where walls have one side */
static const float CONTENT = 0.01f;  /* of these, that end at the front of things inside, where walls have one side */
static const float ON_BOUNDS_REACH = 0.01f; /* of the bounds' width: what is so near to them lies on them */
static const float ELBOW_ROOM = 0.02f;      /* nothing is nearer to the eye than this share of the diagonal */
static const float EYE_HEIGHT = 0.5f;       /* between floor and ceiling */
static const float LAMP_HEIGHT = 0.85f;     /* between floor and ceiling */
static const float FOV_DEGREES = 60.0f;
static const float IRRADIANCE = 2.0f; /* W/m^2, of the lamp on walls as far away as they are on average */

typedef struct surroundings {
    float enclosed;          /* share of the directions that end at a surface */
    float facing, on_bounds; /* shares of these directions that end at its front, and on the bounds */
    float nearest;           /* scene units */
    float distance_squared;  /* mean */
} surroundings;

/* The surface that stops the eye: thin glass does not. */
static bool cast(const scene *s, vec3 origin, vec3 direction, surface_hit *out_hit)
{
    scene_ray ray = scene_ray_make(origin, direction);
    for (int i = 0; i < PANES_MAX; i++) {
        if (!scene_find_surface(s, ray, INFINITY, out_hit))
            return false;
        if (!material_is_clear_glass(s, s->shapes[out_hit->shape_index].material_index))
            return true;
        ray = scene_ray_continue(out_hit, &ray);
    }
    return false;
}

static float free_distance(const scene *s, vec3 origin, vec3 direction)
{
    surface_hit hit;
    return cast(s, origin, direction, &hit) ? sqrtf(vec3_distance_squared(hit.position, origin)) : -1.0f;
}

static bool is_on_bounds(const scene *s, vec3 p)
{
    const vec3 size = vec3_sub(s->bounds_max, s->bounds_min), low = vec3_sub(p, s->bounds_min),
               high = vec3_sub(s->bounds_max, p);
    return low.x < ON_BOUNDS_REACH * size.x || low.y < ON_BOUNDS_REACH * size.y || low.z < ON_BOUNDS_REACH * size.z ||
           high.x < ON_BOUNDS_REACH * size.x || high.y < ON_BOUNDS_REACH * size.y || high.z < ON_BOUNDS_REACH * size.z;
}

static surroundings look_around(const scene *s, vec3 position)
{
    surroundings r = {.nearest = INFINITY};
    int met = 0, facing = 0, on_bounds = 0;
    double squares = 0.0;
    for (int i = 0; i < DIRECTIONS; i++) {
        const float turn = (float)i * 0.618034f;
        const vec3 direction = sample_uniform_sphere((vec2){((float)i + 0.5f) / DIRECTIONS, turn - floorf(turn)});
        surface_hit hit;
        if (!cast(s, position, direction, &hit))
            continue;
        const float square = vec3_distance_squared(hit.position, position);
        met++;
        facing += vec3_dot(hit.geometric_normal, direction) < 0.0f;
        on_bounds += is_on_bounds(s, hit.position);
        squares += (double)square;
        r.nearest = float_min(r.nearest, sqrtf(square));
    }
    if (met == 0)
        return r;
    r.enclosed = (float)met / DIRECTIONS;
    r.facing = (float)facing / (float)met;
    r.on_bounds = (float)on_bounds / (float)met;
    r.distance_squared = (float)(squares / met);
    return r;
}

/* Whether the model shows fronts from outside: then fronts inside are inner walls, and no solid turned inside out. */
static bool has_outer_walls(const scene *s)
{
    int met = 0, facing = 0;
    for (int i = 0; i < DIRECTIONS; i++) {
        const float turn = (float)i * 0.618034f;
        const vec3 direction = sample_uniform_sphere((vec2){((float)i + 0.5f) / DIRECTIONS, turn - floorf(turn)});
        const vec3 outside = vec3_add_scaled(s->bounding_center, direction, -1.5f * s->bounding_radius);
        surface_hit hit;
        if (cast(s, outside, direction, &hit)) {
            met++;
            facing += vec3_dot(hit.geometric_normal, direction) < 0.0f;
        }
    }
    return (float)facing >= FACING * (float)met;
}

static bool is_room(const surroundings *r, bool has_outer)
{
    if (r->enclosed < ENCLOSED)
        return false;
    return (has_outer && r->facing >= FACING) || (r->on_bounds >= ON_BOUNDS && r->facing >= CONTENT);
}

/* Between the floor below and the ceiling above. */
static bool find_height(const scene *s, vec3 position, float share, vec3 *out_position)
{
    const vec3 upwards = s->world_from_upright.y;
    const float down = free_distance(s, position, vec3_negate(upwards)), up = free_distance(s, position, upwards);
    *out_position = vec3_add_scaled(position, upwards, share * (down + up) - down);
    return down >= 0.0f && up >= 0.0f;
}

/* Where to stand, and which way to look: where most of the view is free. */
typedef struct view {
    vec3 eye, heading;
    float distance; /* along it; below 0: none */
} view;

static void find_heading(const scene *s, vec3 eye, view *best)
{
    float distances[HEADINGS];
    vec3 headings[HEADINGS];
    int open_count = 0;
    for (int i = 0; i < HEADINGS; i++) {
        const double angle = 2.0 * 3.14159265358979323846 * i / HEADINGS;
        headings[i] = vec3_add(vec3_scale(s->world_from_upright.x, (float)sin(angle)),
                               vec3_scale(s->world_from_upright.z, (float)cos(angle)));
        distances[i] = free_distance(s, eye, headings[i]);
        open_count += distances[i] < 0.0f;
    }
    if (open_count > OPEN_HEADINGS_MAX) /* a wall is missing, by which the model is looked into */
        return;
    for (int i = 0; i < HEADINGS; i++) { /* free on both sides as well: 22 degrees */
        float sum = 0.0f;
        for (int k = -2; k <= 2; k++)
            sum += float_max(distances[(i + k + HEADINGS) % HEADINGS], 0.0f);
        if (0.2f * sum > best->distance)
            *best = (view){eye, headings[i], 0.2f * sum};
    }
}

static view find_view(const scene *s, bool has_outer, const run_context *run)
{
    const vec3 size = vec3_sub(s->bounds_max, s->bounds_min);
    const vec3 middle = vec3_add_scaled(s->bounds_min, size, 0.5f);
    const frame *f = &s->world_from_upright;
    const float width = fabsf(vec3_dot(size, f->x)), height = fabsf(vec3_dot(size, f->y)),
                depth = fabsf(vec3_dot(size, f->z));
    const float elbow_room = ELBOW_ROOM * vec3_length(size);
    view best = {.distance = -1.0f};
    for (int h = 0; h < HEIGHTS && best.distance < 0.0f; h++)
        for (int i = 0; i < GRID * GRID && !run_is_cancelled(run); i++) {
            const float x = ((float)(i % GRID) + 0.5f) / GRID - 0.5f, z = ((float)(i / GRID) + 0.5f) / GRID - 0.5f;
            const vec3 upright = vec3_make(x * width, (HEIGHT_SHARES[h] - 0.5f) * height, z * depth);
            const vec3 position = vec3_add(middle, frame_to_world(f, upright));
            vec3 eye;
            surroundings around = look_around(s, position);
            if (!is_room(&around, has_outer) || !find_height(s, position, EYE_HEIGHT, &eye))
                continue;
            around = look_around(s, eye);
            if (is_room(&around, has_outer) && around.nearest >= elbow_room)
                find_heading(s, eye, &best);
        }
    return best;
}

static void set_camera(scene *s, const view *v, log_sink *log)
{
    const vec3 up = s->world_from_upright.y, right = vec3_cross(v->heading, up);
    const double m[4][4] = {{(double)right.x, (double)up.x, (double)v->heading.x, (double)v->eye.x},
                            {(double)right.y, (double)up.y, (double)v->heading.y, (double)v->eye.y},
                            {(double)right.z, (double)up.z, (double)v->heading.z, (double)v->eye.z},
                            {0.0, 0.0, 0.0, 1.0}};
    if (!transform_from_matrix(m, &s->camera.world_from_camera))
        return;
    s->camera.fov_degrees = FOV_DEGREES;
    s->camera.focal_distance = v->distance;
    log_message(
        log, AG_LOG_INFO,
        "the model is a closed room: the camera stands inside, at (%g, %g, %g), and looks along (%.3g, %.3g, %.3g)",
        (double)v->eye.x, (double)v->eye.y, (double)v->eye.z, (double)v->heading.x, (double)v->heading.y,
        (double)v->heading.z);
}

/* Adds a lamp in the middle of the view. The sky and the sun that were added stay where the room has openings. */
static ag_status add_lamp(scene *s, const view *v, log_sink *log)
{
    const vec3 middle = vec3_add_scaled(v->eye, v->heading, 0.5f * v->distance);
    light lamp = light_make(LIGHT_POINT);
    uint32_t index;
    if (!find_height(s, middle, LAMP_HEIGHT, &lamp.as.point.position) &&
        !find_height(s, v->eye, LAMP_HEIGHT, &lamp.as.point.position))
        lamp.as.point.position = middle;
    const surroundings around = look_around(s, lamp.as.point.position);
    lamp.as.point.intensity = rgb_gray(IRRADIANCE * around.distance_squared);
    if (around.enclosed == 1.0f)
        scene_drop_lights(s, light_is_everywhere);
    log_message(log, AG_LOG_INFO, "a sun outside does not light a closed room: a lamp of %.3g W at (%g, %g, %g) does",
                4.0 * 3.14159265358979323846 * (double)lamp.as.point.intensity.g, (double)lamp.as.point.position.x,
                (double)lamp.as.point.position.y, (double)lamp.as.point.position.z);
    return scene_add_light(s, &lamp, &index);
}

/* From the file's own camera, where that is in a room. */
static view own_view(const scene *s, bool has_outer)
{
    const double(*m)[4] = s->camera.world_from_camera.m;
    view v = {.distance = -1.0f};
    v.eye = vec3_make((float)m[0][3], (float)m[1][3], (float)m[2][3]);
    const surroundings around = look_around(s, v.eye);
    if (is_room(&around, has_outer)) {
        v.heading = vec3_normalize(vec3_make((float)m[0][2], (float)m[1][2], (float)m[2][2]));
        v.distance = float_max(free_distance(s, v.eye, v.heading), 0.0f);
    }
    return v;
}

ag_status closed_room_furnish(scene *s, const run_context *run)
{
    if ((!s->is_camera_made_up && !s->is_light_made_up) || s->shape_count == 0 || s->bounds_min.x > s->bounds_max.x)
        return AG_OK;
    const bool has_outer = has_outer_walls(s);
    const view v = s->is_camera_made_up ? find_view(s, has_outer, run) : own_view(s, has_outer);
    if (run_is_cancelled(run))
        return AG_CANCELLED;
    if (v.distance < 0.0f)
        return AG_OK;
    if (s->is_camera_made_up)
        set_camera(s, &v, run->log);
    return s->is_light_made_up ? add_lamp(s, &v, run->log) : AG_OK;
}
