/* scene_call_take.c: what scene_call.h says of taking a call from a description and of copying it. */
#define _POSIX_C_SOURCE 200809L
#include "scene_call.h"

#include "call_matrix.h"
#include "image/image_reader.h"
#include "math/motion.h"
#include "scene_parameters.h"
#include "status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- taking --- */

static ag_status refuse(log_sink *log, const scene_call *c, const char *what)
{
    log_at(log, AG_LOG_ERROR, c->where, "%s", what);
    return AG_ERROR_ARGUMENT;
}

/* Copies a struct of the caller's, which begins with its size. */
static ag_status take_struct(log_sink *log, const scene_call *c, const void *given, size_t size, void *out)
{
    size_t given_size;
    if (!given)
        return refuse(log, c, "there is no description");
    memcpy(&given_size, given, sizeof given_size);
    if (given_size != size)
        return refuse(log, c,
                      "struct_size is not that of this library: ag_default_...() sets it, and the program is to be "
                      "compiled with the headers of this release");
    memcpy(out, given, size);
    return AG_OK;
}

/* A text that is NULL stays NULL. */
static ag_status take_text(const char *given, char **out)
{
    *out = given ? strdup(given) : NULL;
    return !given || *out ? AG_OK : AG_ERROR_MEMORY;
}

static ag_status take_parameters(log_sink *log, scene_call *c, const ag_parameter *given, size_t count)
{
    return scene_parameters_copy(log, c->where, given, count, &c->items);
}

/* end: `end_count` matrices; NULL where it does not move. */
static ag_status take_matrices(log_sink *log, scene_call *c, const double *start, const double *end, size_t end_count)
{
    if (end && (end_count < 1 || end_count > MOTION_STEPS_MAX - 1))
        return refuse(log, c, "end_count should be from 1 to 128");
    AG_TRY(call_matrix_copy(log, c->where, start, 1, &c->start));
    AG_TRY(call_matrix_copy(log, c->where, end, end_count, &c->end));
    c->end_count = end_count;
    if (!end || end_count == 1)
        return AG_OK;
    c->between = malloc((end_count - 1) * sizeof *c->between);
    for (size_t i = 0; c->between && i < end_count - 1; i++)
        (void)call_matrix_transform(end + 16 * i, &c->between[i]); /* they have been checked */
    return c->between ? AG_OK : AG_ERROR_MEMORY;
}

ag_status scene_call_name(scene_call *c, const char *name, bool is_float)
{
    AG_TRY(take_text(name, &c->texts[0]));
    return take_text(is_float ? "float" : "spectrum", &c->texts[1]);
}

/* Whether a parameter is one of those that are borrowed; what is wrong with it goes to *out_wrong, else it is NULL. */
static bool is_borrowed(const ag_parameter *p, pbrt_borrowed *out, const char **out_wrong)
{
    const bool is_floats = p->floats && !p->doubles && !p->integers && !p->strings && !p->bools;
    *out_wrong = NULL;
    if (!p->name)
        return false;
    if (strcmp(p->name, "P") == 0 && p->type == AG_PARAMETER_POINT3) {
        out->positions = p->floats;
        out->vertex_count = p->count / 3;
        *out_wrong = !is_floats          ? "what is borrowed of it should be floats"
                     : p->count % 3 != 0 ? "its count is no multiple of 3"
                                         : NULL;
    } else if (strcmp(p->name, "uv") == 0 && p->type == AG_PARAMETER_POINT2) {
        out->uvs = p->floats;
        out->uv_count = p->count;
        *out_wrong = is_floats ? NULL : "what is borrowed of it should be floats";
    } else if (strcmp(p->name, "indices") == 0 && p->type == AG_PARAMETER_INTEGER) {
        out->indices = p->integers;
        out->index_count = p->count;
        if (!p->integers || p->floats || p->doubles || p->strings || p->bools)
            *out_wrong = "what is borrowed of it should be integers";
    } else {
        return false;
    }
    const uintptr_t address = p->floats ? (uintptr_t)p->floats : (uintptr_t)p->integers;
    if (!*out_wrong && address % sizeof(float) != 0)
        *out_wrong = "to be borrowed it should begin at an address that is a multiple of 4";
    for (size_t k = 0; !*out_wrong && p->floats && k < p->count; k++)
        if (!isfinite(p->floats[k]))
            *out_wrong = "a value is not finite";
    return true;
}

/* Notes the arrays that are borrowed, and leaves them out of the parameters, whose numbers stay. */
static ag_status borrow_arrays(log_sink *log, scene_call *c, size_t count, ag_parameter *in_out_parameters)
{
    for (size_t i = 0; i < count; i++) {
        ag_parameter *p = &in_out_parameters[i];
        file_location where = c->where;
        const char *wrong;
        if (!is_borrowed(p, &c->borrowed, &wrong))
            continue;
        if (wrong) {
            where.column = (int)i + 1;
            log_at(log, AG_LOG_ERROR, where, "\"%s\": %s", p->name, wrong);
            return AG_ERROR_ARGUMENT;
        }
        *p = (ag_parameter){.name = p->name, .type = p->type};
    }
    if (!c->borrowed.positions || !c->borrowed.indices)
        return refuse(log, c, "to be borrowed there should be \"point3 P\" and \"integer indices\"");
    return AG_OK;
}

static ag_status take_borrowing_shape(log_sink *log, scene_call *c, const ag_shape *s)
{
    if (strcmp(s->type, "trianglemesh") != 0)
        return refuse(log, c, "of a \"trianglemesh\" alone arrays can be borrowed");
    if (s->parameter_count > SCENE_PARAMETERS_MAX || !s->parameters)
        return take_parameters(log, c, NULL,
                               s->parameter_count > 0 ? s->parameter_count : 1); /* which says what is wrong */
    ag_parameter *rest = malloc((s->parameter_count + 1) * sizeof *rest);
    if (!rest)
        return AG_ERROR_MEMORY;
    memcpy(rest, s->parameters, s->parameter_count * sizeof *rest);
    ag_status status = borrow_arrays(log, c, s->parameter_count, rest);
    if (status == AG_OK)
        status = take_parameters(log, c, rest, s->parameter_count);
    free(rest);
    return status;
}

static ag_status take_shape(log_sink *log, const void *given, scene_call *c)
{
    ag_shape s = ag_default_shape();
    AG_TRY(take_struct(log, c, given, sizeof s, &s));
    if (!s.type)
        return refuse(log, c, "the shape has no type");
    c->reverse_orientation = s.reverse_orientation;
    c->is_light = s.is_light;
    AG_TRY(take_text(s.type, &c->texts[0]));
    AG_TRY(take_text(s.material, &c->material));
    AG_TRY(take_text(s.object, &c->object));
    AG_TRY(take_text(s.medium_inside, &c->medium_inside));
    AG_TRY(take_text(s.medium_outside, &c->medium_outside));
    AG_TRY(take_matrices(log, c, s.world_from_shape, s.world_from_shape_end, s.end_count));
    AG_TRY(s.borrows_arrays ? take_borrowing_shape(log, c, &s)
                            : take_parameters(log, c, s.parameters, s.parameter_count));
    return scene_parameters_copy(log, c->where, s.light_parameters, s.light_parameter_count, &c->light_items);
}

static ag_status take_light(log_sink *log, const void *given, scene_call *c)
{
    ag_light l = ag_default_light();
    AG_TRY(take_struct(log, c, given, sizeof l, &l));
    if (!l.type)
        return refuse(log, c, "the light has no type");
    AG_TRY(take_text(l.type, &c->texts[0]));
    AG_TRY(take_text(l.medium_outside, &c->medium_outside));
    AG_TRY(take_matrices(log, c, l.world_from_light, NULL, 0));
    return take_parameters(log, c, l.parameters, l.parameter_count);
}

static ag_status take_instance(log_sink *log, const void *given, scene_call *c)
{
    ag_instance i = ag_default_instance();
    AG_TRY(take_struct(log, c, given, sizeof i, &i));
    if (!i.object)
        return refuse(log, c, "the instance names no object");
    AG_TRY(take_text(i.object, &c->object));
    return take_matrices(log, c, i.world_from_object, i.world_from_object_end, i.end_count);
}

static ag_status take_camera(log_sink *log, const void *given, scene_call *c)
{
    ag_camera seen = ag_default_camera();
    AG_TRY(take_struct(log, c, given, sizeof seen, &seen));
    if (!seen.type)
        return refuse(log, c, "the camera has no type");
    AG_TRY(take_text(seen.type, &c->texts[0]));
    AG_TRY(take_text(seen.medium, &c->medium_outside));
    AG_TRY(take_matrices(log, c, seen.world_from_camera, seen.world_from_camera_end, 1));
    return take_parameters(log, c, seen.parameters, seen.parameter_count);
}

static ag_status take_texture(log_sink *log, const void *given, scene_call *c)
{
    ag_texture t = ag_default_texture();
    AG_TRY(take_struct(log, c, given, sizeof t, &t));
    if (!t.name || !t.type || (unsigned)t.value > AG_TEXTURE_SPECTRUM)
        return refuse(log, c, "the texture has no name, no type or no kind of value");
    AG_TRY(take_text(t.name, &c->texts[0]));
    AG_TRY(take_text(t.value == AG_TEXTURE_FLOAT ? "float" : "spectrum", &c->texts[1]));
    AG_TRY(take_text(t.type, &c->texts[2]));
    AG_TRY(take_matrices(log, c, t.world_from_texture, NULL, 0));
    return take_parameters(log, c, t.parameters, t.parameter_count);
}

static ag_status take_image(log_sink *log, const call_given *given, scene_call *c)
{
    static const int64_t PIXELS_MAX = (int64_t)1 << 28;
    ag_image i = ag_default_image();
    AG_TRY(take_struct(log, c, given->description, sizeof i, &i));
    if (!given->name || !given->name[0])
        return refuse(log, c, "the picture has no name");
    if (i.width < 1 || i.height < 1 || (int64_t)i.width * i.height > PIXELS_MAX || i.channel_count < 1 ||
        i.channel_count > 4)
        return refuse(log, c, "a picture has 1 to 2^28 pixels and 1 to 4 channels");
    if (!i.bytes == !i.floats)
        return refuse(log, c, "either bytes or floats should be there");
    const image borrowed = {.width = i.width,
                            .height = i.height,
                            .full_width = i.width,
                            .full_height = i.height,
                            .channel_count = i.channel_count,
                            .type = i.bytes ? IMAGE_UINT8 : IMAGE_FLOAT,
                            .pixels = (float *)(uintptr_t)i.floats, /* image_copy reads them only */
                            .bytes = (unsigned char *)(uintptr_t)i.bytes};
    c->picture = calloc(1, sizeof *c->picture);
    if (!c->picture || !image_copy(&borrowed, false, c->picture))
        return AG_ERROR_MEMORY;
    return take_text(given->name, &c->texts[0]);
}

/* Takes the name, type and parameters of a call that has no place in the scene. */
static ag_status take_statement(log_sink *log, const call_given *given, scene_call *c)
{
    const bool is_hint = c->kind == CALL_HINT;
    if (is_hint && (unsigned)given->hint > AG_HINT_PIXEL_FILTER)
        return refuse(log, c, "there is no such hint");
    if (!given->type || (!is_hint && !given->name))
        return refuse(log, c, "a name or a type is NULL");
    c->hint = given->hint;
    AG_TRY(take_text(is_hint ? given->type : given->name, &c->texts[0]));
    AG_TRY(take_text(is_hint ? NULL : given->type, &c->texts[1]));
    return take_parameters(log, c, given->parameters, given->parameter_count);
}

ag_status scene_call_take(log_sink *log, const call_given *given, scene_call *c)
{
    switch (c->kind) {
    case CALL_SHAPE: return take_shape(log, given->description, c);
    case CALL_LIGHT: return take_light(log, given->description, c);
    case CALL_INSTANCE: return take_instance(log, given->description, c);
    case CALL_CAMERA: return take_camera(log, given->description, c);
    case CALL_TEXTURE: return take_texture(log, given->description, c);
    case CALL_IMAGE: return take_image(log, given, c);
    default: return take_statement(log, given, c);
    }
}

/* --- copying --- */

/* Copies everything but the matrices and the material. */
static ag_status copy_rest(const scene_call *from, scene_call *c)
{
    c->number = from->number;
    c->reverse_orientation = from->reverse_orientation;
    c->is_light = from->is_light;
    c->arrays_hash = from->arrays_hash;
    c->is_stale = from->is_stale;
    for (int i = 0; i < 3; i++)
        AG_TRY(take_text(from->texts[i], &c->texts[i]));
    AG_TRY(take_text(from->object, &c->object));
    AG_TRY(take_text(from->medium_inside, &c->medium_inside));
    AG_TRY(take_text(from->medium_outside, &c->medium_outside));
    AG_TRY(scene_parameters_duplicate(&from->items, &c->items));
    AG_TRY(scene_parameters_duplicate(&from->light_items, &c->light_items));
    if (!from->mesh)
        return AG_OK;
    shape shared;
    AG_TRY(shape_share(from->mesh, &shared));
    c->mesh = malloc(sizeof *c->mesh);
    if (c->mesh)
        *c->mesh = shared;
    else
        shape_reset(&shared);
    return c->mesh ? AG_OK : AG_ERROR_MEMORY;
}

ag_status scene_call_move(log_sink *log, const scene_call *from, const double *start, const double *end, scene_call *c)
{
    if (from->mesh)
        return refuse(log, c,
                      "a mesh is moved by an instance of its object, or by ag_scene_change_shape with its arrays: they "
                      "are not kept");
    if (from->kind == CALL_LIGHT && end)
        return refuse(log, c, "a light does not move while the shutter is open");
    AG_TRY(take_matrices(log, c, start, end, 1));
    AG_TRY(take_text(from->material, &c->material));
    return copy_rest(from, c);
}

ag_status scene_call_assign(const scene_call *from, const char *material_name, scene_call *c)
{
    AG_TRY(take_matrices(NULL, c, from->start, from->end, from->end_count));
    AG_TRY(take_text(material_name, &c->material));
    return copy_rest(from, c);
}
