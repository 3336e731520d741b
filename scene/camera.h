/* camera.h: from a place on the film to a ray.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 5 (perspective, thin lens).
 * Threads: read-only once the scene is committed. */
#ifndef AFTERGLOW_CAMERA_H
#define AFTERGLOW_CAMERA_H

#include "math/transform.h"
#include "ray.h"

typedef struct camera {
    transform world_from_camera;
    float fov_degrees;         /* across the shorter image axis, (0, 180); default 90 */
    float frame_aspect_ratio;  /* width / height; 0: the film's */
    float screen_window[4];    /* x0, x1, y0, y1 at distance 1 in units of tan(fov/2); used if has_screen_window */
    bool has_screen_window;
    float lens_radius;         /* scene units, >= 0; 0 is a pinhole */
    float focal_distance;      /* scene units, > 0 */
    float tan_half_fov;        /* set by scene_commit */
} camera;

/* film_x, film_y: in [0, 1] from the left and from the top of the full image; aspect: its width / height;
 * lens_u in [0,1)^2 picks the place on the lens. The direction is unit. */
scene_ray camera_generate_ray(const camera *c, float film_x, float film_y, float aspect, vec2 lens_u);

#endif
