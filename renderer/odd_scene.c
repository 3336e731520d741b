/* odd_scene.c: see odd_scene.h. */
#include "odd_scene.h"

#include "integrator/integrator.h"
#include "light/light.h"
#include "material/pane.h"
#include "math/rng.h"
#include "math/sampling.h"
#include "rays/slab_faces.h"
#include "rays/transmittance.h"

#include <math.h>

/* Directions all around the eye in which the scene is probed. */
enum { DIRECTIONS = 256 };
static const float RIGHT_IN_FRONT = 1e-3f; /* of the scene's radius */
/* A share of the picture's pixels that counts for nothing, whether lit, or brighter or darker than the others; and half
 * of them. */
static const double FEW = 0.002, HALF = 0.5;
/* A picture with nothing above the first is all but black, one with next to nothing below the second all but white,
 * where white is 1. Eight bits of sRGB show 3 and 255. */
static const double DARKEST_BRIGHT_PART = 1e-3, BRIGHTEST_MIDDLE = 32.0;

/* --- the picture's brightness --- */

/* How many pixels have their brightest colour in each octave, from 2^FIRST_OCTAVE on; the first one also holds what is
 * darker, and the black. */
enum { FIRST_OCTAVE = -140, OCTAVES = 280 };
typedef struct brightness {
    uint64_t of_octave[OCTAVES];
    uint64_t all, black;
} brightness;

static void brightness_read(const struct ag_film *film, brightness *out)
{
    *out = (brightness){.all = (uint64_t)film->width * (uint64_t)film->height};
    for (uint64_t i = 0; i < out->all; i++) {
        const float *pixel = film->pixels + 3 * i;
        float most = fmaxf(pixel[0], fmaxf(pixel[1], pixel[2]));
        int exponent = FIRST_OCTAVE;
        if (most > 0.0f)
            frexpf(most, &exponent);
        else
            out->black++;
        int octave = exponent - FIRST_OCTAVE;
        out->of_octave[octave < 0 ? 0 : octave >= OCTAVES ? OCTAVES - 1 : octave]++;
    }
}

/* The value that this share of the pixels is brighter than, up to a factor of 2. */
static double brightness_above(const brightness *b, double share)
{
    uint64_t brighter = 0;
    int octave = OCTAVES - 1;
    for (; octave > 0; octave--) {
        brighter += b->of_octave[octave];
        if ((double)brighter > share * (double)b->all)
            break;
    }
    return ldexp(1.0, octave + FIRST_OCTAVE);
}

/* --- where the eye is --- */

/* Whether all that surrounds the eye is met from its inner side. */
static bool is_inside_solid(const scene *s)
{
    const camera *c = &s->camera;
    if (c->kind == CAMERA_ORTHOGRAPHIC)
        return false; /* which has no position */
    scene_ray ray = camera_generate_ray(c, 0.5f, 0.5f, 1.0f, (vec2){0.5f, 0.5f}, 0.0f);
    for (int i = 0; i < DIRECTIONS; i++) {
        surface_hit hit;
        ray.direction = sample_uniform_sphere(
            (vec2){((float)i + 0.5f) / DIRECTIONS, (float)i * 0.618034f - floorf((float)i * 0.618034f)});
        if (!scene_find_surface(s, ray, INFINITY, &hit) || vec3_dot(hit.geometric_normal, ray.direction) <= 0.0f)
            return false;
    }
    return true;
}

/* --- */

static void warn_of_scale(const struct ag_rendering *r, double value, const char *what)
{
    const scene *s = r->s;
    double stops = -log2(value), asked = stops + (double)r->settings.shown_exposure_stops;
    log_once(
        r->context->log, AG_LOG_WARNING, "odd scene",
        "the picture is about %.0f stops too %s: %s %.1g, where white is 1; the scene is %.3g across and its lights "
        "emit %.3g W: are both in the same units? --exposure %.0f shows it",
        fabs(stops), stops > 0.0 ? "dark to be seen" : "bright", what, value, 2.0 * (double)s->bounding_radius,
        (double)rgb_max(s->light_power), asked);
}

static void warn_of_view(const struct ag_rendering *r)
{
    const scene *s = r->s;
    if (s->shape_count == 0) {
        log_once(r->context->log, AG_LOG_WARNING, "odd scene", "nothing is in view: the scene has no shapes");
        return;
    }
    scene_ray ray = camera_generate_ray(&s->camera, 0.5f, 0.5f, 1.0f, (vec2){0.5f, 0.5f}, 0.0f);
    log_once(r->context->log, AG_LOG_WARNING, "odd scene",
             "nothing is in view: the camera at (%.4g, %.4g, %.4g) looks along (%.3g, %.3g, %.3g), and the shapes lie "
             "between (%.4g, %.4g, %.4g) and (%.4g, %.4g, %.4g)",
             (double)ray.origin.x, (double)ray.origin.y, (double)ray.origin.z, (double)ray.direction.x,
             (double)ray.direction.y, (double)ray.direction.z, (double)s->bounds_min.x, (double)s->bounds_min.y,
             (double)s->bounds_min.z, (double)s->bounds_max.x, (double)s->bounds_max.y, (double)s->bounds_max.z);
}

/* Whether all that shines does so from one side, into the void or onto what is right in front of it: a panel whose
 * faces were turned round. */
static bool shines_away(const scene *s)
{
    for (uint32_t i = 0; i < s->light_count; i++) {
        const light *l = &s->lights[i];
        rng random = rng_make(0, i, 0);
        if (!(rgb_max(l->power) > 0.0f))
            continue;
        if (l->kind != LIGHT_AREA || l->as.area.two_sided)
            return false;
        for (int k = 0; k < DIRECTIONS; k++) {
            light_emission start;
            surface_hit hit;
            if (light_sample_emission(s, l, NULL, &random, &start) &&
                scene_find_surface(s, scene_ray_make(start.origin, start.direction), INFINITY, &hit) &&
                hit.distance > RIGHT_IN_FRONT * s->bounding_radius)
                return false;
        }
    }
    return true;
}

/* Path tracing finds what lamps send through smooth glass by meeting the lamp, and cannot meet these. */
static bool has_lights_without_extent(const scene *s)
{
    for (uint32_t i = 0; i < s->light_count; i++)
        if (!light_can_be_met(&s->lights[i]) && rgb_max(s->lights[i].power) > 0.0f)
            return true;
    return false;
}

/* Whether light goes straight through surfaces of the material, but for a few, as the rims of slabs are. */
static bool is_all_panes(const scene *s, uint32_t material_index)
{
    static const double SLAB_SHARE = 0.75;
    return pane_may_be_of(s, material_index) || slab_faces_share(s, material_index) > SLAB_SHARE;
}

/* Warns of such light that is missing, if any is; returns whether it did. Media scatter none of it in either
 * integrator, since no shadow ray from within finds its way through the glass. */
static bool warn_of_light_behind_glass(const struct ag_rendering *r)
{
    const scene *s = r->s;
    bool is_on_surfaces = integrator_of(r->settings.integrator)->has_photon_map, has_fog = s->has_scattering_media;
    if ((is_on_surfaces && !has_fog) || !has_lights_without_extent(s))
        return false;
    for (uint32_t i = 0; i < s->shape_count; i++) {
        uint32_t material_index = s->shapes[i].material_index;
        if (!material_is_clear_glass(s, material_index) || (r->t.panes_are_direct && is_all_panes(s, material_index)))
            continue;
        const char *text =
            is_on_surfaces ? "light of suns, points and spots that comes by way of smooth glass is missing where media "
                             "scatter it: neither integrator finds it there"
            : has_fog      ? "light of suns, points and spots that comes by way of smooth glass is missing: path "
                             "tracing does not find it, the photon map does on surfaces, but not where media scatter it"
                           : "light of suns, points and spots that comes by way of smooth glass is missing: path "
                             "tracing does not find it, the photon map does";
        log_once(r->context->log, AG_LOG_WARNING, "light behind glass", "%s", text);
        return true;
    }
    return false;
}

void odd_scene_warn(const struct ag_rendering *r)
{
    const struct ag_film *film = r->film;
    const scene *s = r->s;
    log_sink *log = r->context->log;
    bool is_whole = film->width == film->full_width && film->height == film->full_height;
    if (!(rgb_max(s->light_power) > 0.0f)) {
        log_once(log, AG_LOG_WARNING, "odd scene", "the scene has no light that emits: the picture is black");
        return;
    }
    bool is_light_missing = warn_of_light_behind_glass(r);
    if (!is_whole || r->settings.only != AG_ONLY_ALL || film_count_samples(film).least == 0)
        return;
    if (r->camera_rays > 0 && r->camera_rays_met == 0) {
        warn_of_view(r);
        return;
    }
    brightness b;
    brightness_read(film, &b);
    double scale = noise_shown_scale(&r->settings);
    double bright_part = scale * brightness_above(&b, FEW), middle = scale * brightness_above(&b, HALF);
    if ((double)(b.all - b.black) <= FEW * (double)b.all && is_inside_solid(s))
        log_once(log, AG_LOG_WARNING, "odd scene",
                 "the camera is inside of a solid: it meets the inner side of a surface in every direction, and no "
                 "light comes there");
    else if (b.black == b.all && is_light_missing)
        log_once(log, AG_LOG_WARNING, "odd scene", "the picture is black: no other light comes to what is in view");
    else if (b.black == b.all && shines_away(s))
        log_once(log, AG_LOG_WARNING, "odd scene",
                 "the picture is black: what shines, with %.3g W, shines away from everything that there is: a lamp is "
                 "bright on the side that its normals point to",
                 (double)rgb_max(s->light_power));
    else if (b.black == b.all)
        log_once(log, AG_LOG_WARNING, "odd scene",
                 "the picture is black: no light comes to what is in view, from lights that emit %.3g W",
                 (double)rgb_max(s->light_power));
    else if (bright_part < DARKEST_BRIGHT_PART && (double)(b.all - b.black) > FEW * (double)b.all)
        warn_of_scale(r, bright_part, "its brightest parts have");
    else if (middle > BRIGHTEST_MIDDLE)
        warn_of_scale(r, middle, "its middle is above");
}
