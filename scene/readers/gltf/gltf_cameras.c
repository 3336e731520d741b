/* gltf_cameras.c: the camera, and the picture's size by its proportions.
 * Rests on: Khronos, "glTF 2.0 Specification", 2021, 3.10 (cameras look along -z, y up; yfov is across the height).
 * Flow: gltf_nodes -> [here] -> scene.camera, scene.hints. Threads: one per scene. */
#include "gltf/gltf_private.h"
#include "scene_overrides.h"

#include <stdio.h>
#include <string.h>

static const double DEFAULT_ASPECT = 16.0 / 9.0;
static const double LONGER_SIDE = 1280.0; /* pixels */
static const double DEGREES = 180.0 / 3.14159265358979323846;

bool gltf_matrix_axis(const gltf_matrix *m, int axis, double out_axis[3])
{
    double largest = double_max(fabs(m->m[0][axis]), double_max(fabs(m->m[1][axis]), fabs(m->m[2][axis]))),
           square = 0.0;
    if (!(largest > 0.0 && isfinite(largest)))
        return false;
    for (int i = 0; i < 3; i++) {
        out_axis[i] = m->m[i][axis] / largest;
        square += out_axis[i] * out_axis[i];
    }
    for (int i = 0; i < 3; i++)
        out_axis[i] /= sqrt(square);
    return true;
}

/* Makes the camera's transform of the node's position and rotation, without its scale; a mirror stays one. Our cameras
 * look along +z. */
static bool place_camera(const gltf_matrix *node, transform *out_world_from_camera)
{
    double x[3], y[3], z[3], m[4][4] = {{0.0}}, along = 0.0, square = 0.0, side = 0.0;
    if (!gltf_matrix_axis(node, 0, x) || !gltf_matrix_axis(node, 1, y) || !gltf_matrix_axis(node, 2, z))
        return false;
    for (int i = 0; i < 3; i++)
        along += y[i] * z[i];
    for (int i = 0; i < 3; i++) {
        y[i] -= along * z[i];
        square += y[i] * y[i];
    }
    if (!(square > 1e-12))
        return false;
    for (int i = 0; i < 3; i++)
        y[i] /= sqrt(square);
    for (int i = 0; i < 3; i++)
        side += x[i] * (y[(i + 1) % 3] * z[(i + 2) % 3] - y[(i + 2) % 3] * z[(i + 1) % 3]);
    for (int i = 0; i < 3; i++) {
        m[i][0] = copysign(1.0, side) * (y[(i + 1) % 3] * z[(i + 2) % 3] - y[(i + 2) % 3] * z[(i + 1) % 3]);
        m[i][1] = y[i];
        m[i][2] = -z[i];
        m[i][3] = node->m[i][3];
    }
    m[3][3] = 1.0;
    return transform_from_matrix((const double(*)[4])m, out_world_from_camera);
}

static ag_status read_perspective(gltf_reader *r, const gltf_value *at, camera *c)
{
    double height_angle = 0.0;
    gltf_value perspective;
    AG_TRY(gltf_require(r, at, "perspective"));
    AG_TRY(gltf_get_object(r, at, "perspective", &perspective));
    AG_TRY(gltf_require(r, &perspective, "yfov"));
    AG_TRY(gltf_get_double(r, &perspective, "yfov", &height_angle));
    AG_TRY(gltf_get_double(r, &perspective, "aspectRatio", &r->aspect));
    if (!(height_angle > 0.0 && height_angle * DEGREES < 180.0))
        return gltf_error(r, &perspective, "its yfov is %g, which should be within (0, pi)", height_angle);
    if (r->aspect != 0.0 && !(r->aspect >= 1e-3 && r->aspect <= 1e3))
        return gltf_error(r, &perspective, "its aspectRatio is %g, which should be from 0.001 to 1000", r->aspect);
    double aspect = r->aspect != 0.0 ? r->aspect : DEFAULT_ASPECT;
    double shorter_angle = aspect < 1.0 ? 2.0 * atan(aspect * tan(0.5 * height_angle)) : height_angle;
    c->fov_degrees = float_min((float)(shorter_angle * DEGREES), 179.999f);
    return AG_OK;
}

/* An orthographic camera shows all within xmag and ymag of the middle, however far away. */
static ag_status read_orthographic(gltf_reader *r, const gltf_value *at, camera *c)
{
    double half[2] = {0.0, 0.0};
    gltf_value orthographic;
    AG_TRY(gltf_require(r, at, "orthographic"));
    AG_TRY(gltf_get_object(r, at, "orthographic", &orthographic));
    AG_TRY(gltf_require(r, &orthographic, "xmag"));
    AG_TRY(gltf_require(r, &orthographic, "ymag"));
    AG_TRY(gltf_get_double(r, &orthographic, "xmag", &half[0]));
    AG_TRY(gltf_get_double(r, &orthographic, "ymag", &half[1]));
    for (int i = 0; i < 2; i++) { /* a negative one is to mirror the picture, says the format, but nobody should */
        if (!(fabs(half[i]) >= 1e-18 && fabs(half[i]) <= GLTF_MAX_COORDINATE))
            return gltf_error(r, &orthographic, "its xmag and ymag are %g and %g, which should not be 0", half[0],
                              half[1]);
        c->screen_window[2 * i] = (float)-half[i];
        c->screen_window[2 * i + 1] = (float)half[i];
    }
    r->aspect = fabs(half[0] / half[1]);
    if (!(r->aspect >= 1e-3 && r->aspect <= 1e3))
        return gltf_error(r, &orthographic, "its xmag over ymag is %g, which should be from 0.001 to 1000", r->aspect);
    c->kind = CAMERA_ORTHOGRAPHIC;
    c->has_screen_window = true;
    return AG_OK;
}

ag_status gltf_add_camera(gltf_reader *r, uint32_t index, const gltf_value *node, const gltf_matrix *world_from_node)
{
    const char *type = "", *name = "", *node_name = "";
    char number[32];
    bool is_wanted;
    gltf_value at;
    AG_TRY(gltf_get_item(r, GLTF_CAMERAS, index, &at));
    AG_TRY(gltf_require(r, &at, "type"));
    AG_TRY(gltf_get_text(r, &at, "type", &type));
    AG_TRY(gltf_get_text(r, &at, "name", &name));
    AG_TRY(gltf_get_text(r, node, "name", &node_name));
    snprintf(number, sizeof number, "cameras[%u]", index);
    const char *known_as = node_name[0] ? node_name : name[0] ? name : number;
    AG_TRY(scene_overrides_meet_camera(r->scene, known_as, name, &is_wanted));
    if (!is_wanted) {
        log_at(r->run->log, AG_LOG_INFO, r->where, "camera \"%s\" is not used: --camera takes its name", known_as);
        return AG_OK;
    }
    camera c = {.fov_degrees = 90.0f, .focal_distance = 1e6f};
    bool is_orthographic = strcmp(type, "orthographic") == 0;
    if (!is_orthographic && strcmp(type, "perspective") != 0)
        return gltf_error(r, &at, "there is no camera of type \"%s\"", type);
    AG_TRY(is_orthographic ? read_orthographic(r, &at, &c) : read_perspective(r, &at, &c));
    if (!place_camera(world_from_node, &c.world_from_camera))
        return gltf_error(r, &at, "its node leaves no room for it");
    if (r->is_blenders)
        log_at_once(r->run->log, AG_LOG_INFO, r->where, "gltf:shift",
                    "camera \"%s\" is read without a shift: glTF files have none, whatever Blender's camera has",
                    known_as);
    r->scene->camera = c;
    r->scene->has_camera = true;
    return AG_OK;
}

void gltf_set_picture_size(gltf_reader *r)
{
    double aspect = r->aspect != 0.0 ? r->aspect : DEFAULT_ASPECT;
    int64_t longer = (int64_t)LONGER_SIDE,
            shorter = (int64_t)double_max(round(LONGER_SIDE * double_min(aspect, 1.0 / aspect)), 1.0);
    r->scene->hints.width = (integer_hint){true, aspect >= 1.0 ? longer : shorter};
    r->scene->hints.height = (integer_hint){true, aspect >= 1.0 ? shorter : longer};
}
