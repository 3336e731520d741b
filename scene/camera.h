/* camera.h: from a point on the film to a ray.
 * Rests on: Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, ch. 5 (perspective, orthographic,
 * thin lens, spherical). Threads: read-only once the scene is committed. */
#ifndef AFTERGLOW_CAMERA_H
#define AFTERGLOW_CAMERA_H

#include "math/motion.h"
#include "math/transform.h"
#include "rays/ray.h"

typedef enum camera_kind {
    CAMERA_PERSPECTIVE,
    CAMERA_ORTHOGRAPHIC,
    CAMERA_EQUAL_AREA,     /* all directions, on the octahedral map of equal area */
    CAMERA_EQUIRECTANGULAR /* all directions, by longitude and latitude; y is up */
} camera_kind;

typedef struct camera {
    camera_kind kind;
    transform world_from_camera; /* of one that moves: at the start of its motion */
    motion motion;               /* if is_moving: world_from_camera while the shutter is open */
    bool is_moving;
    float shutter_open, shutter_close; /* s, open < close; default 0 and 1 */
    float fov_degrees;                 /* perspective: across the shorter image axis, (0, 180); default 90 */
    float frame_aspect_ratio;          /* width / height; 0: the film's */
    float screen_window[4]; /* x0, x1, y0, y1 in units of tan(fov/2) at distance 1 (orthographic: scene units); used if
                             * has_screen_window */
    bool has_screen_window;
    float screen_shift[2]; /* by which the screen, with a window or without, is moved right and up, in its units */
    float lens_radius;     /* scene units, >= 0; 0 is a pinhole; perspective and orthographic */
    float focal_distance;  /* scene units, > 0 */
    float exposure;        /* what pixels are of the radiance: the shutter's time, times what a lens leaves; 0: 1 */
    float tan_half_fov;    /* set by scene_commit */
    uint32_t medium;       /* that the eye is in; set by scene_commit, from scene.camera_medium */
} camera;

/* Returns the ray through a point of the film. film_x, film_y: in [0, 1] from the left and from the top of the full
 * image, and a filter's radius beyond; aspect: its width / height; lens_u in [0,1)^2 picks the point on the lens; time:
 * of the shutter, see scene_ray. The direction is unit. */
scene_ray camera_generate_ray(const camera *c, float film_x, float film_y, float aspect, vec2 lens_u, float time);

/* Returns the cone of such a ray, as wide as neighbouring rays are apart, which are steps of film_x and film_y away. */
ray_cone camera_ray_cone(const camera *c, const scene_ray *ray, float film_x, float film_y, float step_x, float step_y,
                         float aspect, vec2 lens_u);

/* Writes world_from_camera of a camera at a point that looks at another one. is_left: the world is left-handed, as
 * pbrt's. Returns false where the points are the same, or up is parallel to the view. */
bool camera_look(vec3 from, vec3 to, vec3 up, bool is_left, transform *out_world_from_camera);

/* Returns world_from_camera at a time of the shutter, [0, 1]. */
transform camera_transform_at(const camera *c, float time);

/* Writes the projection of cameras with a pinhole: rows 0, 1 and 3 of a projective map, as transform.h's, from camera
 * space to film_x and film_y; row 2 maps depths from near to far to [0, 1]. Returns false for spherical cameras. */
bool camera_film_from_camera(const camera *c, float aspect, double near, double far, double out[4][4]);

#endif
