/* camera.c: see camera.h.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 5.2 and 5.3; Clarberg, "Fast
 * Equal-Area Mapping of the (Hemi)Sphere using SIMD", 2008.
 * Threads: read-only. */
#include "camera.h"

#include "light/environment.h"
#include "math/sampling.h"

#include <string.h>

/* x0, x1, y0, y1 of the screen: its shorter axis spans [-1, 1], unless a window says otherwise, before it is
 * shifted. */
static void screen_edges(const camera *c, float aspect, float out[4])
{
    float frame_aspect = c->frame_aspect_ratio > 0.0f ? c->frame_aspect_ratio : aspect;
    out[0] = out[2] = -1.0f;
    out[1] = out[3] = 1.0f;
    if (c->has_screen_window)
        memcpy(out, c->screen_window, sizeof c->screen_window);
    else if (frame_aspect > 1.0f)
        out[0] = -frame_aspect, out[1] = frame_aspect;
    else
        out[2] = -1.0f / frame_aspect, out[3] = 1.0f / frame_aspect;
    for (int k = 0; k < 4; k++)
        out[k] += c->screen_shift[k / 2];
}

static vec2 screen_point(const camera *c, float film_x, float film_y, float aspect)
{
    float e[4];
    screen_edges(c, aspect, e);
    return (vec2){e[0] + film_x * (e[1] - e[0]), e[3] + film_y * (e[2] - e[3])};
}

bool camera_film_from_camera(const camera *c, float aspect, double near, double far, double out[4][4])
{
    if (c->kind != CAMERA_PERSPECTIVE && c->kind != CAMERA_ORTHOGRAPHIC)
        return false;
    bool is_perspective = c->kind == CAMERA_PERSPECTIVE;
    float e[4];
    screen_edges(c, aspect, e);
    double zoom = is_perspective ? (double)c->tan_half_fov : 1.0;
    double width = (double)e[1] - (double)e[0], height = (double)e[2] - (double)e[3];
    int last = is_perspective ? 2 : 3; /* what stands for 1: the depth that all is divided by */
    memset(out, 0, 16 * sizeof **out);
    out[0][0] = 1.0 / (zoom * width);
    out[0][last] = -(double)e[0] / width;
    out[1][1] = 1.0 / (zoom * height);
    out[1][last] = -(double)e[3] / height;
    out[2][2] = is_perspective ? far / (far - near) : 1.0 / (far - near);
    out[2][3] = is_perspective ? -far * near / (far - near) : -near / (far - near);
    out[3][last] = 1.0;
    return true;
}

bool camera_look(vec3 from, vec3 to, vec3 up, bool is_left, transform *out_world_from_camera)
{
    const vec3 way = vec3_sub(to, from), across = is_left ? vec3_cross(up, way) : vec3_cross(way, up);
    const float distance = vec3_length(way), width = vec3_length(across);
    if (!(distance > 0.0f && width > 0.0f && isfinite(distance) && isfinite(width) && vec3_is_finite(from)))
        return false;
    const vec3 z = vec3_scale(way, 1.0f / distance), x = vec3_scale(across, 1.0f / width);
    const vec3 y = is_left ? vec3_cross(z, x) : vec3_cross(x, z);
    const vec3 columns[4] = {x, y, z, from};
    double matrix[4][4] = {{0.0}};
    for (int k = 0; k < 4; k++) {
        matrix[0][k] = (double)columns[k].x;
        matrix[1][k] = (double)columns[k].y;
        matrix[2][k] = (double)columns[k].z;
    }
    matrix[3][3] = 1.0;
    return transform_from_matrix((const double(*)[4])matrix, out_world_from_camera);
}

/* Makes the ray in camera space; its direction need not be unit. */
static void projective_ray(const camera *c, vec2 screen, vec2 lens_u, vec3 *out_origin, vec3 *out_direction)
{
    bool is_perspective = c->kind == CAMERA_PERSPECTIVE;
    vec3 origin = {0.0f, 0.0f, 0.0f}, direction = {0.0f, 0.0f, 1.0f};
    if (is_perspective) /* the screen at distance 1 */
        direction = (vec3){screen.x * c->tan_half_fov, screen.y * c->tan_half_fov, 1.0f};
    else
        origin = (vec3){screen.x, screen.y, 0.0f};

    /* Thin lens: all rays through one point of the film meet on the plane in focus. Of an orthographic camera each such
     * point has a lens of its own around it, so that the picture stays a parallel one; pbrt-v4 has one lens for all. */
    if (c->lens_radius > 0.0f) {
        vec2 lens = sample_disk_concentric(lens_u);
        vec3 focus = vec3_add_scaled(origin, direction, c->focal_distance);
        origin = (vec3){origin.x + lens.x * c->lens_radius, origin.y + lens.y * c->lens_radius, 0.0f};
        direction = vec3_sub(focus, origin);
    }
    *out_origin = origin;
    *out_direction = direction;
}

/* Both spherical mappings have their pole at z, the camera's is y. */
static vec3 spherical_direction(camera_kind kind, double x, double y)
{
    if (kind == CAMERA_EQUIRECTANGULAR) {
        float s, z, sin_phi, cos_phi;
        sincos_turns((float)(0.5 * y), &s, &z);
        sincos_turns((float)(x - floor(x)), &sin_phi, &cos_phi);
        return (vec3){s * cos_phi, z, s * sin_phi};
    }
    /* beyond an edge of the square the map goes on from that edge's other half */
    if (x < 0.0 || x > 1.0) {
        x = x < 0.0 ? -x : 2.0 - x;
        y = 1.0 - y;
    }
    if (y < 0.0 || y > 1.0) {
        y = y < 0.0 ? -y : 2.0 - y;
        x = 1.0 - x;
    }
    vec3 d = environment_octahedral_direction(double_clamp(x, 0.0, 1.0), double_clamp(y, 0.0, 1.0));
    return (vec3){d.x, d.z, d.y};
}

transform camera_transform_at(const camera *c, float time)
{
    if (!c->is_moving)
        return c->world_from_camera;
    double moved[3][4], matrix[4][4] = {{0.0}, {0.0}, {0.0}, {0.0, 0.0, 0.0, 1.0}};
    motion_at(&c->motion, (double)time, moved);
    memcpy(matrix, moved, sizeof moved);
    transform now;
    return transform_from_matrix((const double(*)[4])matrix, &now) ? now : c->world_from_camera;
}

scene_ray camera_generate_ray(const camera *c, float film_x, float film_y, float aspect, vec2 lens_u, float time)
{
    vec3 origin = {0.0f, 0.0f, 0.0f}, direction;
    if (c->kind == CAMERA_PERSPECTIVE || c->kind == CAMERA_ORTHOGRAPHIC)
        projective_ray(c, screen_point(c, film_x, film_y, aspect), lens_u, &origin, &direction);
    else
        direction = spherical_direction(c->kind, (double)film_x, (double)film_y);
    scene_ray ray;
    if (c->is_moving) {
        transform now = transform_identity(); /* of which only the matrix is used */
        motion_at(&c->motion, (double)time, now.m);
        ray = scene_ray_make(transform_point(&now, origin), vec3_normalize(transform_vector(&now, direction)));
    } else {
        ray = scene_ray_make(transform_point(&c->world_from_camera, origin),
                             vec3_normalize(transform_vector(&c->world_from_camera, direction)));
    }
    ray.time = time;
    ray.medium = c->medium;
    return ray;
}

/* The side of a square of that area. */
static float mean_side(vec3 from, vec3 right, vec3 down)
{
    float across = vec3_distance_squared(right, from), along = vec3_distance_squared(down, from);
    return sqrtf(sqrtf(across) * sqrtf(along));
}

ray_cone camera_ray_cone(const camera *c, const scene_ray *ray, float film_x, float film_y, float step_x, float step_y,
                         float aspect, vec2 lens_u)
{
    scene_ray right = camera_generate_ray(c, film_x + step_x, film_y, aspect, lens_u, ray->time);
    scene_ray down = camera_generate_ray(c, film_x, film_y + step_y, aspect, lens_u, ray->time);
    return (ray_cone){mean_side(ray->origin, right.origin, down.origin),
                      mean_side(ray->direction, right.direction, down.direction), false};
}
