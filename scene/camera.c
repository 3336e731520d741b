/* camera.c: see camera.h.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 5.2.
 * Threads: read-only. */
#include "camera.h"

#include "math/sampling.h"

scene_ray camera_generate_ray(const camera *c, float film_x, float film_y, float aspect, vec2 lens_u)
{
    /* the screen at distance 1: the shorter axis spans [-1, 1] times tan(fov / 2) */
    float frame_aspect = c->frame_aspect_ratio > 0.0f ? c->frame_aspect_ratio : aspect;
    float x0 = -1.0f, x1 = 1.0f, y0 = -1.0f, y1 = 1.0f;
    if (c->has_screen_window)
        x0 = c->screen_window[0], x1 = c->screen_window[1], y0 = c->screen_window[2], y1 = c->screen_window[3];
    else if (frame_aspect > 1.0f)
        x0 = -frame_aspect, x1 = frame_aspect;
    else
        y0 = -1.0f / frame_aspect, y1 = 1.0f / frame_aspect;
    vec3 origin = {0.0f, 0.0f, 0.0f};
    vec3 direction = {(x0 + film_x * (x1 - x0)) * c->tan_half_fov, (y1 + film_y * (y0 - y1)) * c->tan_half_fov, 1.0f};

    /* thin lens: all rays through one point of the film meet on the plane in focus */
    if (c->lens_radius > 0.0f) {
        vec2 lens = sample_disk_concentric(lens_u);
        vec3 focus = vec3_scale(direction, c->focal_distance);
        origin = (vec3){lens.x * c->lens_radius, lens.y * c->lens_radius, 0.0f};
        direction = vec3_sub(focus, origin);
    }
    return scene_ray_make(transform_point(&c->world_from_camera, origin),
                          vec3_normalize(transform_vector(&c->world_from_camera, direction)));
}
