/* scene_memory.c: scenes of the public interface that are made by calls.
 * Rests on: pbrt-v4's file format, whose directives the calls are. Flow: afterglow.h -> [here] -> pbrt_builder ->
 * scene. Threads: as in afterglow.h. */
#define _POSIX_C_SOURCE 200809L
#include "scene_load.h"

#include "floating_point.h"
#include "image/image_reader.h"
#include "pbrt/pbrt_builder.h"
#include "scene_overrides.h"
#include "scene_parameters.h"
#include "status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char NAME[] = "scene from memory";

/* The functions, for messages; each counts its calls. */
typedef enum call_kind {
    CALL_SHAPE,
    CALL_LIGHT,
    CALL_INSTANCE,
    CALL_CAMERA,
    CALL_MATERIAL,
    CALL_MEDIUM,
    CALL_TEXTURE,
    CALL_HINT,
    CALL_IMAGE,
    CALL_KIND_COUNT
} call_kind;

static const char *const FUNCTIONS[CALL_KIND_COUNT] = {
    "ag_scene_add_shape",   "ag_scene_add_light",    "ag_scene_add_instance",
    "ag_scene_set_camera",  "ag_scene_add_material", "ag_scene_add_medium",
    "ag_scene_add_texture", "ag_scene_set_hint",     "ag_scene_add_image"};

typedef struct scene_making {
    ag_context *context; /* the scene's */
    scene *s;
    pbrt_builder *builder; /* NULL after a commit that failed */
    scene_request request;
    char *sky_file, *camera_name; /* of the request */
    int call_counts[CALL_KIND_COUNT];
    bool is_change;  /* of a scene that is complete */
    bool has_moving; /* shapes or instances, whose motion was made for the camera's shutter */
} scene_making;

void scene_making_destroy(scene_making *making)
{
    if (!making)
        return;
    pbrt_builder_destroy(making->builder);
    scene_destroy(making->s);
    free(making->sky_file);
    free(making->camera_name);
    free(making);
}

ag_status scene_check_complete(ag_context *context, const ag_scene *made)
{
    if (made->s)
        return AG_OK;
    log_message(context->log, AG_LOG_ERROR, "the scene is not complete: ag_scene_commit comes first");
    return AG_ERROR_ARGUMENT;
}

/* --- beginning and end --- */

static ag_status copy_request(const ag_scene_settings *settings, scene_making *making)
{
    AG_TRY(scene_request_make(making->context, settings, &making->request));
    if (settings->definition_count > 0)
        return scene_settings_refuse(making->context, "a scene from memory has no text for definitions");
    making->sky_file = settings->sky_file ? strdup(settings->sky_file) : NULL;
    making->camera_name = settings->camera_name ? strdup(settings->camera_name) : NULL;
    making->request.sky_file = making->sky_file;
    making->request.camera_name = making->camera_name;
    return (making->sky_file || !settings->sky_file) && (making->camera_name || !settings->camera_name)
               ? AG_OK
               : AG_ERROR_MEMORY;
}

static ag_status begin(ag_context *context, const ag_scene_settings *settings, ag_scene *made)
{
    made->context = context;
    scene_making *making = made->making = calloc(1, sizeof *making);
    if (!making)
        return AG_ERROR_MEMORY;
    making->context = context;
    making->s = scene_create();
    if (!making->s)
        return AG_ERROR_MEMORY;
    AG_TRY(copy_request(settings, making));
    AG_TRY(scene_prepare(context, "", &making->request, making->s, &made->inputs));
    making->builder = pbrt_builder_create(&context->run, making->s);
    return making->builder ? AG_OK : AG_ERROR_MEMORY;
}

ag_status ag_scene_create(ag_context *context, const ag_scene_settings *settings, ag_scene **out_scene)
{
    const ag_scene_settings defaults = ag_default_scene_settings();
    if (context && !out_scene)
        log_message(context->log, AG_LOG_ERROR, "ag_scene_create: out_scene is NULL");
    if (!context || !out_scene)
        return AG_ERROR_ARGUMENT;
    ag_scene *made = calloc(1, sizeof *made);
    if (!made)
        return AG_ERROR_MEMORY;
    const unsigned callers_arithmetic = floating_point_enter();
    const ag_status status = begin(context, settings ? settings : &defaults, made);
    floating_point_leave(callers_arithmetic);
    if (status == AG_OK)
        *out_scene = made;
    else
        ag_scene_destroy(made);
    return status;
}

static ag_status complete(scene_making *making)
{
    ag_context *context = making->context;
    scene *s = making->s;
    run_progress(&context->run, AG_PHASE_LOAD, 0.0);
    AG_TRY(pbrt_builder_finish(making->builder));
    AG_TRY(scene_overrides_apply(&context->run, NAME, true, s));
    run_progress(&context->run, AG_PHASE_LOAD, 1.0);
    s->defined = strdup("");
    return s->defined ? scene_complete(context, s) : AG_ERROR_MEMORY;
}

/* Whether a scene takes calls; says in the log why not. */
static bool is_open(const ag_scene *made, const char *function)
{
    if (made->making && made->making->builder)
        return true;
    log_message(made->context->log, AG_LOG_ERROR, "%s: the scene %s", function,
                made->s ? "is complete already" : "can only be destroyed after the commit that failed");
    return false;
}

ag_status ag_scene_commit(ag_scene *made)
{
    if (!made || !is_open(made, "ag_scene_commit"))
        return AG_ERROR_ARGUMENT;
    scene_making *making = made->making;
    const unsigned callers_arithmetic = floating_point_enter();
    making->context->run.inputs = &made->inputs;
    const ag_status status = complete(making);
    making->context->run.inputs = NULL;
    made->inputs.scene = NULL;
    pbrt_builder_destroy(making->builder);
    making->builder = NULL;
    if (status == AG_OK) {
        made->s = making->s;
        making->s = NULL;
        scene_making_destroy(making);
        made->making = NULL;
    }
    floating_point_leave(callers_arithmetic);
    return status;
}

/* --- calls --- */

/* One call on its way. */
typedef struct making_call {
    scene_making *making;
    unsigned callers_arithmetic;
    phase_begin begin;
    char label[200];
    pbrt_call call;
    pbrt_items items, light_items;
} making_call;

/* False where the scene takes no more calls. */
static bool begin_call(ag_scene *made, call_kind kind, making_call *out)
{
    if (!made || !is_open(made, FUNCTIONS[kind]))
        return false;
    scene_making *making = made->making;
    *out =
        (making_call){.making = making, .callers_arithmetic = floating_point_enter(), .begin = context_begin_phase()};
    out->call.where = (file_location){FUNCTIONS[kind], ++making->call_counts[kind], 0};
    out->call.label = out->label;
    making->context->run.inputs = &made->inputs;
    return true;
}

static ag_status end_call(making_call *c, ag_status status)
{
    ag_context *context = c->making->context;
    if (status == AG_ERROR_MEMORY)
        log_at(context->log, AG_LOG_ERROR, c->call.where, "out of memory");
    scene_parameters_free(&c->items);
    scene_parameters_free(&c->light_items);
    context->run.inputs = NULL;
    context_add_to_phase(context, AG_PHASE_LOAD, c->begin);
    floating_point_leave(c->callers_arithmetic);
    return status;
}

static ag_status refuse(const making_call *c, const char *what)
{
    log_at(c->making->context->log, AG_LOG_ERROR, c->call.where, "%s", what);
    return AG_ERROR_ARGUMENT;
}

/* Copies a struct of the caller's, which begins with its size. */
static ag_status take_struct(const making_call *c, const void *given, size_t size, void *out)
{
    size_t given_size;
    if (!given)
        return refuse(c, "there is no description");
    memcpy(&given_size, given, sizeof given_size);
    if (given_size != size)
        return refuse(
            c,
            "struct_size is not that of this library: ag_default_...() sets it, and the program is to be compiled with "
            "the headers of this release");
    memcpy(out, given, size);
    return AG_OK;
}

static ag_status take_parameters(making_call *c, const ag_parameter *given, size_t count, pbrt_items *out_items)
{
    return scene_parameters_copy(c->making->context->log, c->call.where, given, count, out_items);
}

/* Whether the last row is 0 0 0 1, up to the rounding of whoever has undone a matrix. */
static bool is_affine(const double *rows)
{
    static const double ROUNDING = 1e-6;
    return fabs(rows[12]) <= ROUNDING && fabs(rows[13]) <= ROUNDING && fabs(rows[14]) <= ROUNDING &&
           fabs(rows[15] - 1.0) <= ROUNDING;
}

/* Rows of world from own space; NULL: no change. */
static ag_status take_matrix(const making_call *c, const double *rows, transform *out_transform)
{
    double m[4][4];
    *out_transform = transform_identity();
    if (!rows)
        return AG_OK;
    memcpy(m, rows, sizeof m);
    for (int i = 0; i < 16; i++)
        if (!isfinite(rows[i]))
            return refuse(c, "a number of its matrix is not finite");
    if (!is_affine(rows))
        return refuse(c, "the last row of its matrix is not 0 0 0 1: the 16 numbers go row by row, and the translation "
                         "is in the last column");
    if (!transform_from_matrix((const double(*)[4])m, out_transform))
        return refuse(c, "its matrix cannot be undone");
    return AG_OK;
}

/* end NULL: it does not move. */
static ag_status take_matrices(const making_call *c, const double *start, const double *end, pbrt_placement *out)
{
    AG_TRY(take_matrix(c, start, &out->start));
    out->end = out->start;
    return end ? take_matrix(c, end, &out->end) : AG_OK;
}

static void describe(making_call *c, const char *directive, const char *type, const char *of, const char *name)
{
    snprintf(c->label, sizeof c->label, "%s \"%.60s\"%s%s%.60s%s", directive, type, name ? of : "", name ? " \"" : "",
             name ? name : "", name ? "\"" : "");
}

static ag_status add_shape(making_call *c, const ag_shape *given)
{
    ag_shape s = ag_default_shape();
    AG_TRY(take_struct(c, given, sizeof s, &s));
    if (!s.type)
        return refuse(c, "the shape has no type");
    describe(c, "Shape", s.type, s.object ? " of object" : " of material", s.object ? s.object : s.material);
    pbrt_placement at = {.reverse_orientation = s.reverse_orientation,
                         .material = s.material,
                         .object = s.object,
                         .medium_inside = s.medium_inside,
                         .medium_outside = s.medium_outside};
    AG_TRY(take_matrices(c, s.world_from_shape, s.world_from_shape_end, &at));
    AG_TRY(take_parameters(c, s.parameters, s.parameter_count, &c->items));
    AG_TRY(take_parameters(c, s.light_parameters, s.light_parameter_count, &c->light_items));
    AG_TRY(
        pbrt_builder_shape(c->making->builder, &c->call, &at, s.type, c->items, s.is_light ? &c->light_items : NULL));
    c->making->has_moving = c->making->has_moving || s.world_from_shape_end;
    return AG_OK;
}

ag_status ag_scene_add_shape(ag_scene *made, const ag_shape *shape_to_add)
{
    making_call c;
    return begin_call(made, CALL_SHAPE, &c) ? end_call(&c, add_shape(&c, shape_to_add)) : AG_ERROR_ARGUMENT;
}

static ag_status add_light(making_call *c, const ag_light *given)
{
    ag_light l = ag_default_light();
    pbrt_placement at = {0};
    AG_TRY(take_struct(c, given, sizeof l, &l));
    if (!l.type)
        return refuse(c, "the light has no type");
    describe(c, "LightSource", l.type, "", NULL);
    at.medium_outside = l.medium_outside;
    AG_TRY(take_matrices(c, l.world_from_light, NULL, &at));
    AG_TRY(take_parameters(c, l.parameters, l.parameter_count, &c->items));
    return pbrt_builder_light(c->making->builder, &c->call, &at, l.type, c->items);
}

ag_status ag_scene_add_light(ag_scene *made, const ag_light *light_to_add)
{
    making_call c;
    return begin_call(made, CALL_LIGHT, &c) ? end_call(&c, add_light(&c, light_to_add)) : AG_ERROR_ARGUMENT;
}

static ag_status add_instance(making_call *c, const ag_instance *given)
{
    ag_instance i = ag_default_instance();
    pbrt_placement at = {0};
    AG_TRY(take_struct(c, given, sizeof i, &i));
    if (!i.object)
        return refuse(c, "the instance names no object");
    describe(c, "ObjectInstance", i.object, "", NULL);
    at.object = i.object;
    AG_TRY(take_matrices(c, i.world_from_object, i.world_from_object_end, &at));
    AG_TRY(pbrt_builder_instance(c->making->builder, &c->call, &at));
    c->making->has_moving = c->making->has_moving || i.world_from_object_end;
    return AG_OK;
}

ag_status ag_scene_add_instance(ag_scene *made, const ag_instance *instance)
{
    making_call c;
    return begin_call(made, CALL_INSTANCE, &c) ? end_call(&c, add_instance(&c, instance)) : AG_ERROR_ARGUMENT;
}

static ag_status add_image(making_call *c, const char *name, const ag_image *given)
{
    static const int64_t PIXELS_MAX = (int64_t)1 << 28;
    ag_image i = ag_default_image();
    image copy;
    AG_TRY(take_struct(c, given, sizeof i, &i));
    if (!name || !name[0])
        return refuse(c, "the picture has no name");
    if (i.width < 1 || i.height < 1 || (int64_t)i.width * i.height > PIXELS_MAX || i.channel_count < 1 ||
        i.channel_count > 4)
        return refuse(c, "a picture has 1 to 2^28 pixels and 1 to 4 channels");
    if (!i.bytes == !i.floats)
        return refuse(c, "either bytes or floats should be there");
    const image borrowed = {.width = i.width,
                            .height = i.height,
                            .full_width = i.width,
                            .full_height = i.height,
                            .channel_count = i.channel_count,
                            .type = i.bytes ? IMAGE_UINT8 : IMAGE_FLOAT,
                            .pixels = (float *)(uintptr_t)i.floats, /* to be copied */
                            .bytes = (unsigned char *)(uintptr_t)i.bytes};
    return image_copy(&borrowed, false, &copy) ? pbrt_builder_picture(c->making->builder, &c->call, name, &copy)
                                               : AG_ERROR_MEMORY;
}

ag_status ag_scene_add_image(ag_scene *made, const char *name, const ag_image *picture)
{
    making_call c;
    return begin_call(made, CALL_IMAGE, &c) ? end_call(&c, add_image(&c, name, picture)) : AG_ERROR_ARGUMENT;
}

static ag_status add_texture(making_call *c, const ag_texture *given)
{
    ag_texture t = ag_default_texture();
    pbrt_placement at = {0};
    AG_TRY(take_struct(c, given, sizeof t, &t));
    if (!t.name || !t.type || (unsigned)t.value > AG_TEXTURE_SPECTRUM)
        return refuse(c, "the texture has no name, no type or no kind of value");
    describe(c, "Texture", t.name, ",", t.type);
    const char *const strings[] = {t.name, t.value == AG_TEXTURE_FLOAT ? "float" : "spectrum", t.type};
    AG_TRY(take_matrices(c, t.world_from_texture, NULL, &at));
    AG_TRY(take_parameters(c, t.parameters, t.parameter_count, &c->items));
    return pbrt_builder_texture(c->making->builder, &c->call, &at, strings, c->items);
}

ag_status ag_scene_add_texture(ag_scene *made, const ag_texture *texture_to_add)
{
    making_call c;
    return begin_call(made, CALL_TEXTURE, &c) ? end_call(&c, add_texture(&c, texture_to_add)) : AG_ERROR_ARGUMENT;
}

static ag_status set_camera(making_call *c, const ag_camera *given)
{
    ag_camera seen = ag_default_camera();
    pbrt_placement at = {0};
    AG_TRY(take_struct(c, given, sizeof seen, &seen));
    if (!seen.type)
        return refuse(c, "the camera has no type");
    describe(c, "Camera", seen.type, "", NULL);
    if (c->making->has_moving)
        return refuse(c, "the camera comes before what moves: its shutter says when");
    if (c->making->is_change && (seen.medium || strcmp(seen.type, "realistic") == 0))
        return refuse(c, "of a scene that is complete the camera stays in its medium, and has no lens file");
    at.medium_outside = seen.medium;
    AG_TRY(take_matrices(c, seen.world_from_camera, seen.world_from_camera_end, &at));
    at.start = transform_invert(&at.start);
    at.end = transform_invert(&at.end);
    AG_TRY(take_parameters(c, seen.parameters, seen.parameter_count, &c->items));
    return pbrt_builder_camera(c->making->builder, &c->call, &at, seen.type, c->items);
}

/* What a new camera may not change in a scene that is complete; NULL: nothing is wrong. */
static const char *find_conflict(const scene *s, const camera *c)
{
    const bool has_shutter = c->shutter_open == s->camera.shutter_open && c->shutter_close == s->camera.shutter_close;
    return s->instance_step_count > s->instance_count && !has_shutter
               ? "what moves was made for another shutter: \"shutteropen\" and \"shutterclose\" should stay"
               : NULL;
}

/* Of a scene that is complete, from a file or not: the camera is read into an empty scene. */
static ag_status change_camera(ag_scene *made, const ag_camera *given)
{
    scene_making making = {.context = made->context, .s = scene_create(), .is_change = true};
    making_call c = {.making = &making, .callers_arithmetic = floating_point_enter(), .begin = context_begin_phase()};
    c.call.where = (file_location){FUNCTIONS[CALL_CAMERA], ++made->camera_calls, 0};
    c.call.label = c.label;
    ag_status status = AG_ERROR_MEMORY;
    if (making.s) {
        making.s->space = made->s->space;
        making.builder = pbrt_builder_create(&made->context->run, making.s);
    }
    if (making.builder && made->rendering_count > 0)
        status = refuse(&c, "a rendering of the scene is not finished yet");
    else if (making.builder)
        status = set_camera(&c, given);
    const char *conflict = status == AG_OK ? find_conflict(made->s, &making.s->camera) : NULL;
    if (conflict)
        status = refuse(&c, conflict);
    if (status == AG_OK) {
        scene_set_camera(made->s, &making.s->camera);
        made->s->has_camera = true;
        made->s->is_camera_made_up = false;
    }
    pbrt_builder_destroy(making.builder);
    scene_destroy(making.s);
    return end_call(&c, status);
}

ag_status ag_scene_set_camera(ag_scene *made, const ag_camera *camera_to_set)
{
    making_call c;
    if (made && made->s)
        return change_camera(made, camera_to_set);
    return begin_call(made, CALL_CAMERA, &c) ? end_call(&c, set_camera(&c, camera_to_set)) : AG_ERROR_ARGUMENT;
}

/* --- what is nowhere in particular --- */

/* strings: [3], of which the first string_count are to be there. */
static ag_status state(making_call *c, pbrt_statement statement, const char *directive, const char *const *strings,
                       int string_count, const ag_parameter *parameters, size_t count)
{
    for (int i = 0; i < string_count; i++)
        if (!strings[i])
            return refuse(c, "a name or a type is NULL");
    describe(c, directive, strings[0], ",", string_count > 1 ? strings[string_count - 1] : NULL);
    AG_TRY(take_parameters(c, parameters, count, &c->items));
    return pbrt_builder_state(c->making->builder, &c->call, statement, strings, c->items);
}

ag_status ag_scene_add_material(ag_scene *made, const char *name, const char *type, const ag_parameter *parameters,
                                size_t count)
{
    making_call c;
    const char *const strings[] = {name, type, NULL};
    if (!begin_call(made, CALL_MATERIAL, &c))
        return AG_ERROR_ARGUMENT;
    return end_call(&c, state(&c, PBRT_MATERIAL, "MakeNamedMaterial", strings, 2, parameters, count));
}

ag_status ag_scene_add_medium(ag_scene *made, const char *name, const char *type, const ag_parameter *parameters,
                              size_t count)
{
    making_call c;
    const char *const strings[] = {name, type, NULL};
    if (!begin_call(made, CALL_MEDIUM, &c))
        return AG_ERROR_ARGUMENT;
    return end_call(&c, state(&c, PBRT_MEDIUM, "MakeNamedMedium", strings, 2, parameters, count));
}

ag_status ag_scene_set_hint(ag_scene *made, ag_scene_hint hint, const char *type, const ag_parameter *parameters,
                            size_t count)
{
    static const struct {
        pbrt_statement statement;
        const char *directive;
    } HINTS[] = {{PBRT_FILM, "Film"},
                 {PBRT_SAMPLER, "Sampler"},
                 {PBRT_INTEGRATOR, "Integrator"},
                 {PBRT_PIXEL_FILTER, "PixelFilter"}};
    making_call c;
    const char *const strings[] = {type, NULL, NULL};
    if (!begin_call(made, CALL_HINT, &c))
        return AG_ERROR_ARGUMENT;
    if ((unsigned)hint > AG_HINT_PIXEL_FILTER)
        return end_call(&c, refuse(&c, "there is no such hint"));
    return end_call(&c, state(&c, HINTS[hint].statement, HINTS[hint].directive, strings, 1, parameters, count));
}
