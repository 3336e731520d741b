/* scene_call.c: see scene_call.h. */
#define _POSIX_C_SOURCE 200809L
#include "scene_call.h"

#include "call_matrix.h"
#include "image/image_reader.h"
#include "scene_parameters.h"
#include "shape/borrowed_arrays.h"
#include "status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *call_kind_name(call_kind kind)
{
    static const char *const NAMES[CALL_KIND_COUNT] = {"shape",  "light",   "instance", "camera", "material",
                                                       "medium", "texture", "hint",     "picture"};
    return NAMES[kind];
}

scene_call *scene_call_create(call_kind kind, file_location where)
{
    scene_call *c = calloc(1, sizeof *c);
    if (c) {
        c->holder_count = 1;
        c->kind = kind;
        c->where = where;
    }
    return c;
}

scene_call *scene_call_hold(scene_call *c)
{
    c->holder_count++;
    return c;
}

void scene_call_release(scene_call *c)
{
    if (!c || --c->holder_count > 0)
        return;
    for (int i = 0; i < 3; i++)
        free(c->texts[i]);
    free(c->material);
    free(c->object);
    free(c->medium_inside);
    free(c->medium_outside);
    free(c->start);
    free(c->end);
    free(c->between);
    scene_parameters_free(&c->items);
    scene_parameters_free(&c->light_items);
    if (c->mesh)
        shape_reset(c->mesh);
    if (c->picture)
        image_reset(c->picture);
    free(c->mesh);
    free(c->picture);
    free(c);
}

/* --- running --- */

static void describe(const scene_call *c, char *label, size_t size)
{
    static const char *const HINTS[] = {"Film", "Sampler", "Integrator", "PixelFilter"};
    static const char *const DIRECTIVES[CALL_KIND_COUNT] = {[CALL_SHAPE] = "Shape",
                                                            [CALL_LIGHT] = "LightSource",
                                                            [CALL_INSTANCE] = "ObjectInstance",
                                                            [CALL_CAMERA] = "Camera",
                                                            [CALL_MATERIAL] = "MakeNamedMaterial",
                                                            [CALL_MEDIUM] = "MakeNamedMedium",
                                                            [CALL_TEXTURE] = "Texture",
                                                            [CALL_IMAGE] = "picture"};
    const char *directive = c->kind == CALL_HINT ? HINTS[c->hint] : DIRECTIVES[c->kind], *of = "", *name = NULL;
    const char *type = c->kind == CALL_INSTANCE ? c->object : c->texts[0];
    if (c->kind == CALL_SHAPE) {
        of = c->object ? " of object" : " of material";
        name = c->object ? c->object : c->material;
    } else if (c->texts[1]) {
        of = ",";
        name = c->texts[c->kind == CALL_TEXTURE ? 2 : 1];
    }
    snprintf(label, size, "%s \"%.60s\"%s%s%.60s%s", directive, type, name ? of : "", name ? " \"" : "",
             name ? name : "", name ? "\"" : "");
}

/* Making a transform cannot fail here: call_matrix_copy has checked the matrices. */
static pbrt_placement placement_of(const scene_call *c)
{
    pbrt_placement at = {.reverse_orientation = c->reverse_orientation,
                         .material = c->material,
                         .object = c->object,
                         .medium_inside = c->medium_inside,
                         .medium_outside = c->medium_outside,
                         .made_mesh = c->mesh,
                         .between = c->between,
                         .between_count = c->end ? (uint32_t)c->end_count - 1 : 0};
    (void)call_matrix_transform(c->start, &at.start);
    at.end = at.start;
    if (c->end)
        (void)call_matrix_transform(c->end + 16 * (c->end_count - 1), &at.end);
    if (c->kind == CALL_CAMERA) {
        at.start = transform_invert(&at.start);
        at.end = transform_invert(&at.end);
    }
    return at;
}

/* Whether a parameter stays with the call once the mesh is made of the others. */
static bool is_of_shape(const parameter *p)
{
    return strcmp(p->name, "alpha") == 0 || strcmp(p->name, "shadowalpha") == 0 || strcmp(p->name, "filename") == 0;
}

ag_status scene_call_make_mesh(scene_call *c, pbrt_builder *builder)
{
    char label[200];
    pbrt_items arrays, rest;
    if (c->kind != CALL_SHAPE || !pbrt_builder_makes_mesh(c->texts[0]))
        return AG_OK;
    describe(c, label, sizeof label);
    rest = (pbrt_items){calloc(c->items.count + 1, sizeof *rest.items), 0};
    arrays = (pbrt_items){calloc(c->items.count + 1, sizeof *arrays.items), 0};
    c->mesh = calloc(1, sizeof *c->mesh);
    ag_status status = rest.items && arrays.items && c->mesh ? AG_OK : AG_ERROR_MEMORY;
    for (size_t i = 0; i < c->items.count && status == AG_OK; i++) {
        parameter *p = &c->items.items[i];
        const bool is_file = strcmp(p->name, "filename") == 0;
        if (is_file && !parameter_copy(p, &arrays.items[arrays.count++]))
            status = AG_ERROR_MEMORY;
        pbrt_items *to = is_of_shape(p) ? &rest : &arrays;
        to->items[to->count++] = *p;
        *p = (parameter){0};
    }
    const pbrt_placement at = placement_of(c);
    const pbrt_call call = {c->where, label};
    if (c->mesh)
        *c->mesh = shape_make(SHAPE_MESH);
    if (status == AG_OK)
        status = pbrt_builder_mesh(builder, &call, &at, c->texts[0], arrays, c->is_light,
                                   c->borrowed.positions ? &c->borrowed : NULL, c->mesh);
    if (status == AG_OK) {
        borrowed_arrays_note(c->mesh);
        c->arrays_hash = shape_hash_borrowed(c->mesh);
    }
    scene_parameters_free(&arrays);
    scene_parameters_free(&c->items);
    c->items = rest;
    return status;
}

static ag_status run_statement(const scene_call *c, const pbrt_call *call, pbrt_builder *b, pbrt_items items)
{
    static const pbrt_statement HINTS[] = {PBRT_FILM, PBRT_SAMPLER, PBRT_INTEGRATOR, PBRT_PIXEL_FILTER};
    const pbrt_statement statement = c->kind == CALL_HINT       ? HINTS[c->hint]
                                     : c->kind == CALL_MATERIAL ? PBRT_MATERIAL
                                                                : PBRT_MEDIUM;
    const char *const texts[] = {c->texts[0], c->texts[1], NULL};
    return pbrt_builder_state(b, call, statement, texts, items);
}

static ag_status run(const scene_call *c, pbrt_builder *b, pbrt_items items, pbrt_items *light_items)
{
    char label[200];
    const pbrt_call call = {c->where, label};
    const pbrt_placement at = placement_of(c);
    const char *const texts[] = {c->texts[0], c->texts[1], c->texts[2]};
    describe(c, label, sizeof label);
    switch (c->kind) {
    case CALL_SHAPE: return pbrt_builder_shape(b, &call, &at, texts[0], items, c->is_light ? light_items : NULL);
    case CALL_LIGHT: return pbrt_builder_light(b, &call, &at, texts[0], items);
    case CALL_INSTANCE: return pbrt_builder_instance(b, &call, &at);
    case CALL_CAMERA: return pbrt_builder_camera(b, &call, &at, texts[0], items);
    case CALL_TEXTURE: return pbrt_builder_texture(b, &call, &at, texts, items);
    case CALL_IMAGE: return pbrt_builder_picture(b, &call, texts[0], c->picture, c->version);
    default: return run_statement(c, &call, b, items);
    }
}

ag_status scene_call_run(scene_call *c, pbrt_builder *builder, bool can_repeat)
{
    if (!can_repeat) {
        const ag_status status = run(c, builder, c->items, &c->light_items);
        scene_parameters_free(&c->items);
        scene_parameters_free(&c->light_items);
        return status;
    }
    pbrt_items items, light_items = {0};
    AG_TRY(scene_parameters_duplicate(&c->items, &items));
    ag_status status = scene_parameters_duplicate(&c->light_items, &light_items);
    if (status == AG_OK)
        status = run(c, builder, items, &light_items);
    scene_parameters_free(&items);
    scene_parameters_free(&light_items);
    return status;
}
