/* import_view.c: cameras and lights of foreign formats as ours; see importer.h.
 * Lights of rasterizers become physical ones of the same brightness: color c at distance d on a white surface that
 * faces the light is an irradiance of pi c, so an intensity of pi c d^2; where the light does not fall off with the
 * square of the distance, that of the centre of the scene counts. Lights of Blender's are physical already, per metre.
 * Threads: one per scene. */
#include "model/importer.h"
#include "scene_extent.h"
#include "scene_overrides.h"
#include "status.h"

#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
static const double DEFAULT_ASPECT = 1280.0 / 720.0; /* of the picture where nothing is said of it */

/* Cameras */

static bool normalize(double v[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if (!(length > 0.0 && isfinite(length)))
        return false;
    for (int k = 0; k < 3; k++)
        v[k] /= length;
    return true;
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Makes the transform of a camera in a right-handed world: right is forward x up. size: what 1 on the screen of an
 * orthographic camera stands for. */
static bool place_camera(const import_camera *source, double size, transform *out_transform)
{
    double forward[3], up[3], right[3], matrix[4][4] = {{0.0}};
    memcpy(forward, source->forward, sizeof forward);
    cross(forward, source->up, right);
    if (!normalize(forward) || !normalize(right))
        return false;
    cross(right, forward, up);
    for (int k = 0; k < 3; k++) {
        matrix[k][0] = right[k] * size;
        matrix[k][1] = up[k] * size;
        matrix[k][2] = forward[k];
        matrix[k][3] = source->position[k];
    }
    matrix[3][3] = 1.0;
    return transform_from_matrix((const double(*)[4])matrix, out_transform);
}

static double aspect_of(const import_camera *source)
{
    return source->aspect > 0.0f && isfinite(source->aspect) ? (double)source->aspect : DEFAULT_ASPECT;
}

/* Returns the field of view across the shorter side of the picture, from that across its width; 0 where it makes no
 * sense. */
static double shorter_fov_degrees(const import_camera *source)
{
    double half = 0.5 * (double)source->horizontal_fov;
    if (!(half > 0.0 && half < 0.5 * PI))
        return 0.0;
    return (aspect_of(source) > 1.0 ? atan(tan(half) / aspect_of(source)) : half) * 360.0 / PI;
}

/* The longer side of the file's picture is 2 aspect long, or 2 / aspect, whatever picture is rendered. */
static void shift_picture(const import_camera *source, camera *c)
{
    const double aspect = aspect_of(source), longer_side = 2.0 * double_max(aspect, 1.0 / aspect);
    if (!isfinite(source->shift[0] + source->shift[1]))
        return;
    for (int k = 0; k < 2; k++)
        c->screen_shift[k] = (float)(longer_side * (double)source->shift[k]);
}

ag_status importer_add_camera(importer *i, const import_camera *source)
{
    camera c = {.kind = CAMERA_PERSPECTIVE, .fov_degrees = 90.0f, .focal_distance = 1e6f};
    double size = 1.0;
    bool is_wanted;
    AG_TRY(scene_overrides_meet_camera(i->scene, source->name, NULL, &is_wanted));
    if (!is_wanted) {
        log_at(i->log, AG_LOG_INFO, i->where, "camera \"%s\" is not used: --camera takes its name", source->name);
        return AG_OK;
    }
    if (source->orthographic_half_width > 0.0f) {
        c.kind = CAMERA_ORTHOGRAPHIC;
        size = (double)source->orthographic_half_width / double_max(aspect_of(source), 1.0);
    } else {
        c.fov_degrees = (float)shorter_fov_degrees(source);
    }
    if (!(c.fov_degrees > 0.0f && c.fov_degrees < 180.0f) || !place_camera(source, size, &c.world_from_camera)) {
        log_at(i->log, AG_LOG_WARNING, i->where, "camera \"%s\" makes no sense and is left out", source->name);
        return AG_OK;
    }
    shift_picture(source, &c);
    i->scene->camera = c;
    i->scene->has_camera = true;
    return AG_OK;
}

/* Lights */

/* pi d^2 / attenuation, for d far away or where the scene's centre is. */
static ag_status find_intensity_factor(const importer *i, const import_light *source, double *out_factor)
{
    if (source->measure == IMPORT_LIGHT_WATTS) {
        const double per_metre = (double)source->units_per_metre;
        *out_factor = (source->kind == IMPORT_LIGHT_AREA ? 0.25 : 0.25 / PI) * per_metre * per_metre;
        return AG_OK;
    }
    double c = (double)source->attenuation[0], l = (double)source->attenuation[1], q = (double)source->attenuation[2];
    *out_factor = PI / q;
    if (q > 0.0)
        return AG_OK;
    vec3 low, high;
    double square = 0.0, radius = 0.0;
    AG_TRY(scene_find_bounds(i->scene, NULL, &low, &high));
    const double a[3] = {(double)low.x, (double)low.y, (double)low.z},
                 b[3] = {(double)high.x, (double)high.y, (double)high.z};
    for (int k = 0; k < 3 && a[0] <= b[0]; k++) {
        double away = 0.5 * (a[k] + b[k]) - source->position[k];
        square += away * away;
        radius += 0.25 * (b[k] - a[k]) * (b[k] - a[k]);
    }
    square = double_max(square, 0.01 * radius); /* a lamp in the very middle */
    double attenuation = c + l * sqrt(square);
    *out_factor = PI * square / (attenuation > 0.0 ? attenuation : 1.0);
    return AG_OK;
}

static rgb scale_color(rgb color, double factor)
{
    return rgb_make((float)((double)color.r * factor), (float)((double)color.g * factor),
                    (float)((double)color.b * factor));
}

static bool is_sound(rgb c)
{
    return rgb_is_finite(c) && c.r >= 0.0f && c.g >= 0.0f && c.b >= 0.0f && !rgb_is_black(c);
}

/* Adds a rectangle around its position that shines to one side. */
static ag_status add_area_light(importer *i, const import_light *source, rgb intensity)
{
    double n[3], up[3], right[3], area = (double)source->size[0] * (double)source->size[1];
    memcpy(n, source->direction, sizeof n);
    cross(n, source->up, right);
    if (!normalize(n) || !normalize(right) || !(area > 0.0 && isfinite(area)))
        return AG_OK;
    cross(right, n, up);
    shape s = shape_make(SHAPE_MESH);
    light l = light_make(LIGHT_AREA);
    material black = material_make(MATERIAL_DIFFUSE);
    uint32_t index;
    static const uint32_t INDICES[6] = {0, 1, 2, 0, 2, 3};
    black.reflectance = rgb_gray(0.0f);
    mesh *q = &s.as.mesh;
    q->vertex_count = 4;
    q->triangle_count = 2;
    q->positions = calloc(5, sizeof *q->positions);
    q->indices = malloc(sizeof INDICES);
    if (!q->positions || !q->indices || scene_add_material(i->scene, &black, &s.material_index) != AG_OK) {
        free(q->positions);
        free(q->indices);
        return AG_ERROR_MEMORY;
    }
    memcpy(q->indices, INDICES, sizeof INDICES);
    for (int corner = 0; corner < 4; corner++) { /* so that the normal is along the light */
        double x = (corner == 1 || corner == 2 ? 0.5 : -0.5) * (double)source->size[0];
        double y = (corner < 2 ? 0.5 : -0.5) * (double)source->size[1], p[3];
        for (int k = 0; k < 3; k++)
            p[k] = source->position[k] + x * right[k] + y * up[k];
        q->positions[corner] = vec3_make((float)p[0], (float)p[1], (float)p[2]);
        if (!vec3_is_finite(q->positions[corner])) {
            free(q->positions);
            free(q->indices);
            return AG_OK;
        }
    }
    if (source->measure == IMPORT_LIGHT_WATTS)
        s.alpha = 0.0f; /* Blender's lamps light, but are not seen */
    AG_TRY(scene_add_shape(i->scene, &s, &l.as.area.shape_index));
    l.as.area.radiance = scale_color(intensity, 1.0 / area);
    return scene_add_light(i->scene, &l, &index);
}

ag_status importer_add_light(importer *i, const import_light *light_source)
{
    if (i->scene->request && i->scene->request->drops_lights)
        return AG_OK;                    /* nor would their surfaces be there */
    import_light source = *light_source; /* its direction becomes unit, its colour the working space's */
    if (is_sound(source.color))
        source.color = working_space_light(&i->scene->space, source.color);
    double factor;
    AG_TRY(find_intensity_factor(i, &source, &factor));
    rgb intensity = scale_color(source.color, factor);
    vec3 position = {(float)source.position[0], (float)source.position[1], (float)source.position[2]};
    light l;
    uint32_t index;
    bool is_aimed = source.kind != IMPORT_LIGHT_POINT && source.kind != IMPORT_LIGHT_AMBIENT;
    if (!is_sound(source.color) || !is_sound(intensity) || !vec3_is_finite(position) ||
        source.kind > IMPORT_LIGHT_AREA || (is_aimed && !normalize(source.direction))) {
        log_at(i->log, AG_LOG_WARNING, i->where, "light \"%s\" is dark or makes no sense, and is left out",
               source.name);
        return AG_OK;
    }
    const vec3 direction = {(float)source.direction[0], (float)source.direction[1], (float)source.direction[2]};
    switch ((import_light_kind)source.kind) {
    case IMPORT_LIGHT_POINT:
        l = light_make(LIGHT_POINT);
        l.as.point = (point_source){position, intensity};
        break;
    case IMPORT_LIGHT_SPOT: {
        double outer = double_clamp(0.5 * (double)source.outer_cone, 1e-3, PI); /* NaN: the first */
        double inner = double_clamp(0.5 * (double)source.inner_cone, 0.0, outer);
        l = light_make(LIGHT_SPOT);
        l.as.spot.position = position;
        l.as.spot.direction = direction;
        l.as.spot.intensity = intensity;
        light_set_cone(&l, inner, outer);
        l.as.spot.dims_by_cosine = source.dims_by_cosine == 1 && outer <= 0.5 * PI;
        break;
    }
    case IMPORT_LIGHT_DIRECTIONAL:
        l = light_make(LIGHT_DISTANT);
        l.as.distant.direction = direction;
        l.as.distant.irradiance = scale_color(source.color, source.measure == IMPORT_LIGHT_WATTS ? 1.0 : PI);
        break;
    case IMPORT_LIGHT_AMBIENT:
        l = light_make(LIGHT_INFINITE);
        l.as.infinite.radiance.value = source.color;
        break;
    case IMPORT_LIGHT_AREA:
    default: return add_area_light(i, &source, intensity);
    }
    return scene_add_light(i->scene, &l, &index);
}
