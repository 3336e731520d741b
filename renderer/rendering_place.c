/* rendering_place.c: where the camera of a rendering stands, for who is about to move it.
 * Flow: rendering -> [here] -> ag_rendering_create_view. Threads: the context's. */
#include "rays/transmittance.h"
#include "rendering.h"

static void put(vec3 v, float out[3])
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

/* Of a pinhole whose screen is as the field of view alone says. */
static bool is_plain(const camera *c)
{
    return c->kind == CAMERA_PERSPECTIVE && c->lens_radius == 0.0f && !c->has_screen_window &&
           c->screen_shift[0] == 0.0f && c->screen_shift[1] == 0.0f && c->frame_aspect_ratio == 0.0f;
}

void ag_rendering_find_place(const ag_rendering *r, float out_from[3], float out_to[3], float out_up[3],
                             float out_right[3], float *out_fov_degrees)
{
    if (!r || !out_from || !out_to || !out_up || !out_right || !out_fov_degrees)
        return;
    const scene *s = r->s;
    const camera *c = &s->camera;
    const transform at = c->is_moving ? camera_transform_at(c, 0.0f) : c->world_from_camera;
    const vec3 from = transform_point(&at, vec3_make(0.0f, 0.0f, 0.0f));
    const vec3 way = vec3_normalize(transform_vector(&at, vec3_make(0.0f, 0.0f, 1.0f)));
    const vec3 up = vec3_normalize(transform_vector(&at, vec3_make(0.0f, 1.0f, 0.0f)));
    const scene_ray middle = camera_generate_ray(c, 0.5f, 0.5f, r->aspect, (vec2){0.5f, 0.5f}, 0.0f);
    surface_hit hit;
    float distance = 0.5f * vec3_length(vec3_sub(s->bounds_max, s->bounds_min));
    if (scene_find_surface(s, middle, INFINITY, &hit))
        distance = vec3_length(vec3_sub(hit.position, from));
    if (!(distance > 0.0f && isfinite(distance)))
        distance = 1.0f;
    put(from, out_from);
    put(vec3_add(from, vec3_scale(way, distance)), out_to);
    put(up, out_up);
    put(vec3_normalize(transform_vector(&at, vec3_make(1.0f, 0.0f, 0.0f))), out_right);
    *out_fov_degrees = is_plain(c) ? c->fov_degrees : 0.0f;
}
