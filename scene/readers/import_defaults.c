/* import_defaults.c: see import_defaults.h. Threads: one per scene. */
#include "import_defaults.h"

#include "scene_extent.h"
#include "scene_overrides.h"
#include "status.h"

static const float FOV_DEGREES = 45.0f;
static const double TAN_HALF_FOV = 0.41421356237309505;  /* tan 22.5 degrees = sqrt 2 - 1 */
static const double MARGIN = 1.05;                       /* around the bounds */
static const double FROM_CENTER[3] = {0.47, 0.34, 0.81}; /* 30 degrees to the right, 20 above the horizon */

static const rgb SKY_RADIANCE = {0.5f, 0.5f, 0.5f};
static const rgb SUN_IRRADIANCE = {1.5f, 1.5f, 1.5f};
static const double TO_SUN[3] = {-0.5, 0.8, -0.6}; /* in camera space: right, up, forward */

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void normalize(double v[3])
{
    double length = sqrt(dot(v, v));
    for (int i = 0; i < 3; i++)
        v[i] /= length;
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* The camera's axes in the world: right, up, forward. Right is on the right in a right-handed world. */
static void default_axes(const frame *world_from_upright, double axes[3][3])
{
    const vec3 columns[3] = {world_from_upright->x, world_from_upright->y, world_from_upright->z};
    const double up[3] = {(double)columns[1].x, (double)columns[1].y, (double)columns[1].z};
    for (int k = 0; k < 3; k++) {
        const double column[3] = {(double)columns[k].x, (double)columns[k].y, (double)columns[k].z};
        for (int i = 0; i < 3; i++)
            axes[2][i] = (k > 0 ? axes[2][i] : 0.0) - FROM_CENTER[k] * column[i];
    }
    normalize(axes[2]);
    cross(axes[2], up, axes[0]);
    normalize(axes[0]);
    cross(axes[0], axes[2], axes[1]);
}

/* Returns how far from the centre the camera has to be to see all corners of the bounds; 0 where they are one point. */
static double distance_to_see(double axes[3][3], const double half[3])
{
    double distance = 0.0;
    for (int corner = 0; corner < 8; corner++) {
        double p[3];
        for (int i = 0; i < 3; i++)
            p[i] = corner >> i & 1 ? half[i] : -half[i];
        double across = double_max(fabs(dot(p, axes[0])), fabs(dot(p, axes[1])));
        distance = double_max(distance, across * MARGIN / TAN_HALF_FOV - dot(p, axes[2]));
    }
    return distance;
}

ag_status import_add_default_camera(scene *s, log_sink *log)
{
    vec3 low, high;
    double axes[3][3], center[3] = {0.0, 0.0, 0.0}, half[3] = {1.0, 1.0, 1.0}, m[4][4] = {{0.0}};
    if (s->request && (s->request->has_camera || s->request->camera_name))
        return AG_OK; /* scene_overrides sets the camera that is asked for, or refuses */
    s->world_from_upright = scene_overrides_upright(s);
    default_axes(&s->world_from_upright, axes);
    AG_TRY(scene_find_bounds(s, NULL, &low, &high));
    if (low.x <= high.x) {
        const double a[3] = {(double)low.x, (double)low.y, (double)low.z};
        const double b[3] = {(double)high.x, (double)high.y, (double)high.z};
        for (int i = 0; i < 3; i++) {
            center[i] = 0.5 * (a[i] + b[i]);
            half[i] = 0.5 * (b[i] - a[i]);
        }
    }
    double distance = distance_to_see(axes, half);
    if (!(distance > 0.0))
        distance = 1.0;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            m[i][k] = axes[k][i];
        m[i][3] = center[i] - distance * axes[2][i];
    }
    m[3][3] = 1.0;
    camera c = {.fov_degrees = FOV_DEGREES, .focal_distance = (float)distance};
    if (!transform_from_matrix((const double(*)[4])m, &c.world_from_camera))
        c.world_from_camera = transform_identity(); /* bounds are finite, so there is an inverse */
    s->camera = c;
    s->has_camera = s->is_camera_made_up = true;
    log_message(log, AG_LOG_INFO, "the file has no camera: one is set at (%g, %g, %g), looking at (%g, %g, %g)",
                m[0][3], m[1][3], m[2][3], center[0], center[1], center[2]);
    return AG_OK;
}

/* The direction in which the sun's light goes. */
static vec3 sun_direction(const scene *s)
{
    double axes[3][3], way[3] = {0.0, 0.0, 0.0};
    default_axes(&s->world_from_upright, axes);
    if (s->has_camera)
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < 3; i++)
                axes[k][i] = s->camera.world_from_camera.m[i][k];
            normalize(axes[k]);
        }
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            way[i] -= TO_SUN[k] * axes[k][i];
    normalize(way);
    return vec3_make((float)way[0], (float)way[1], (float)way[2]);
}

ag_status import_add_default_light(scene *s, log_sink *log)
{
    light sky = light_make(LIGHT_INFINITE), sun = light_make(LIGHT_DISTANT);
    uint32_t index;
    if (scene_overrides_light(s))
        return AG_OK;
    s->world_from_upright = scene_overrides_upright(s);
    sky.as.infinite.radiance.value = SKY_RADIANCE;
    sun.as.distant.irradiance = SUN_IRRADIANCE;
    sun.as.distant.direction = sun_direction(s);
    AG_TRY(scene_add_light(s, &sky, &index));
    AG_TRY(scene_add_light(s, &sun, &index));
    s->is_light_made_up = true;
    log_message(log, AG_LOG_INFO, "the file has no light: an even sky and a sun light it");
    return AG_OK;
}
