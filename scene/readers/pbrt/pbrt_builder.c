/* pbrt_builder.c: see pbrt_builder.h. */
#define _POSIX_C_SOURCE 200809L
#include "pbrt/pbrt_builder.h"

#include "pbrt/pbrt_private.h"

#include <stdlib.h>
#include <string.h>

/* The scene's name in messages that no call has caused. */
static const char NAME[] = "scene from memory";

struct pbrt_builder {
    pbrt_parser *parser;
};

static ag_status begin(pbrt_parser *parser)
{
    const transform identity = transform_identity();
    AG_TRY(pbrt_push_text(parser, NAME, "", 0));
    AG_TRY(pbrt_add_default_material(parser));
    parser->in_world = true;
    return pbrt_name_coordinate_system(parser, "world", &identity, &identity);
}

pbrt_builder *pbrt_builder_create(run_context *run, scene *out_scene)
{
    pbrt_builder *b = calloc(1, sizeof *b);
    if (b)
        b->parser = pbrt_parser_create(run, out_scene);
    if (b && b->parser && begin(b->parser) == AG_OK)
        return b;
    pbrt_builder_destroy(b);
    return NULL;
}

void pbrt_builder_destroy(pbrt_builder *b)
{
    if (b && b->parser)
        pbrt_parser_destroy(b->parser);
    free(b);
}

/* --- directives --- */

static ag_status direct(pbrt_parser *parser, const pbrt_call *call, pbrt_handler *handle, const char *const *strings,
                        size_t string_count, pbrt_items items)
{
    pbrt_given given = {.strings = strings,
                        .string_count = string_count,
                        .items = items.items,
                        .item_count = items.count,
                        .where = call->where,
                        .label = call->label};
    parser->given = &given;
    const ag_status status = handle(parser, call->where);
    parser->given = NULL;
    parser->has_peeked = false;
    return status;
}

static const pbrt_items NOTHING = {NULL, 0};

/* Frees what was not taken. */
static ag_status end_call(ag_status status, pbrt_items items)
{
    for (size_t i = 0; i < items.count; i++)
        parameter_reset(&items.items[i]);
    return status;
}

/* After a call that failed: the names of materials that it was the first to use. */
static void excuse_materials(pbrt_parser *parser, size_t known_count)
{
    for (size_t i = known_count; i < parser->named_material_count; i++)
        parser->named_materials[i].is_excused = true;
}

/* Puts a placement into the graphics state. */
static ag_status enter_placement(pbrt_parser *parser, const pbrt_call *call, const pbrt_placement *at)
{
    parser->state.world_from_object = at->start;
    parser->state.world_from_object_end = at->end;
    parser->state.between = at->between;
    parser->state.between_count = at->between_count;
    parser->state.reverse_orientation = at->reverse_orientation;
    if (at->material)
        AG_TRY(direct(parser, call, pbrt_use_named_material, &at->material, 1, NOTHING));
    if (at->medium_inside || at->medium_outside) {
        const char *sides[2] = {at->medium_inside ? at->medium_inside : "",
                                at->medium_outside ? at->medium_outside : ""};
        AG_TRY(direct(parser, call, pbrt_medium_interface, sides, 2, NOTHING));
    }
    return AG_OK;
}

/* Runs one directive under a placement; the graphics state is afterwards as it was before. */
static ag_status direct_at(pbrt_parser *parser, const pbrt_call *call, const pbrt_placement *at, pbrt_handler *handle,
                           const char *const *strings, size_t string_count, pbrt_items items, pbrt_items *emission)
{
    static const char *const AREA_LIGHT = "diffuse";
    const pbrt_state before = parser->state;
    const size_t known_count = parser->named_material_count;
    ag_status status = enter_placement(parser, call, at);
    const pbrt_mark mark = pbrt_set_mark(parser);
    if (status == AG_OK && emission)
        status = direct(parser, call, pbrt_area_light_source, &AREA_LIGHT, 1, *emission);
    if (status == AG_OK)
        status = direct(parser, call, handle, strings, string_count, items);
    if (status != AG_OK) {
        excuse_materials(parser, known_count);
        pbrt_go_back(parser, &mark);
    }
    parser->state = before;
    return status;
}

ag_status pbrt_builder_shape(pbrt_builder *b, const pbrt_call *call, const pbrt_placement *at, const char *type,
                             pbrt_items items, pbrt_items *emission)
{
    pbrt_parser *parser = b->parser;
    ag_status status = AG_OK;
    pbrt_given named = {.where = call->where, .label = call->label};
    parser->given = &named;
    if (at->object)
        status = pbrt_enter_object(parser, at->object, call->where);
    parser->given = NULL;
    parser->made_mesh = at->made_mesh;
    if (status == AG_OK)
        status = direct_at(parser, call, at, pbrt_shape, &type, 1, items, emission);
    parser->made_mesh = NULL;
    if (status == AG_OK && at->object)
        parser->open_object->is_defined = true;
    pbrt_leave_object(parser);
    end_call(status, emission ? *emission : NOTHING);
    return end_call(status, items);
}

bool pbrt_builder_makes_mesh(const char *type)
{
    static const char *const TYPES[] = {"trianglemesh", "bilinearmesh", "loopsubdiv", "plymesh"};
    for (size_t i = 0; i < sizeof TYPES / sizeof *TYPES; i++)
        if (strcmp(type, TYPES[i]) == 0)
            return true;
    return false;
}

ag_status pbrt_builder_mesh(pbrt_builder *b, const pbrt_call *call, const pbrt_placement *at, const char *type,
                            pbrt_items items, bool shines, const pbrt_borrowed *borrowed, shape *out_mesh)
{
    static const pbrt_area_light LAMP = {.is_set = true, .radiance_texture = SCENE_NO_TEXTURE, .mean_luminance = 1.0};
    const pbrt_placement alone = {.start = at->start,
                                  .end = at->end,
                                  .between = at->between,
                                  .between_count = at->between_count,
                                  .reverse_orientation = at->reverse_orientation};
    pbrt_parser *parser = b->parser;
    scene *s = parser->scene;
    const pbrt_mark empty = pbrt_set_mark(parser);
    if (shines)
        parser->state.area_light = LAMP;
    parser->borrowed = borrowed;
    parser->is_material_unknown = true;
    const ag_status status = direct_at(parser, call, &alone, pbrt_shape, &type, 1, items, NULL);
    parser->borrowed = NULL;
    parser->is_material_unknown = false;
    parser->state.area_light = (pbrt_area_light){0};
    *out_mesh = shape_make(SHAPE_MESH);
    if (status == AG_OK && s->shape_count > 0) {
        *out_mesh = s->shapes[--s->shape_count];
        out_mesh->light_index = SHAPE_NO_LIGHT;
        out_mesh->object_index = SCENE_NO_OBJECT;
    }
    pbrt_go_back(parser, &empty);
    s->object_count = 0;
    return end_call(status, items);
}

ag_status pbrt_builder_light(pbrt_builder *b, const pbrt_call *call, const pbrt_placement *at, const char *type,
                             pbrt_items items)
{
    return end_call(direct_at(b->parser, call, at, pbrt_light_source, &type, 1, items, NULL), items);
}

ag_status pbrt_builder_camera(pbrt_builder *b, const pbrt_call *call, const pbrt_placement *at, const char *type,
                              pbrt_items items)
{
    return end_call(direct_at(b->parser, call, at, pbrt_camera, &type, 1, items, NULL), items);
}

ag_status pbrt_builder_instance(pbrt_builder *b, const pbrt_call *call, const pbrt_placement *at)
{
    return direct_at(b->parser, call, at, pbrt_object_instance, &at->object, 1, NOTHING, NULL);
}

ag_status pbrt_builder_texture(pbrt_builder *b, const pbrt_call *call, const pbrt_placement *at,
                               const char *const strings[3], pbrt_items items)
{
    return end_call(direct_at(b->parser, call, at, pbrt_texture, strings, 3, items, NULL), items);
}

/* Makes a named thing, with its type as a parameter, as the directive wants it. */
static ag_status make_named(pbrt_parser *parser, const pbrt_call *call, pbrt_handler *handle,
                            const char *const *strings, pbrt_items items)
{
    parameter type = {
        .name = strdup("type"), .type = PARAMETER_STRING, .where = call->where, .strings = calloc(1, sizeof(char *))};
    parameter *all = calloc(items.count + 1, sizeof *all);
    const size_t known_count = parser->named_material_count;
    ag_status status = AG_ERROR_MEMORY;
    if (type.strings && (type.strings[0] = strdup(strings[1])) != NULL)
        type.count = 1;
    if (all && type.name && type.count == 1) {
        if (items.count > 0)
            memcpy(all, items.items, items.count * sizeof *all);
        all[items.count] = type;
        type = (parameter){0};
        for (size_t i = 0; i < items.count; i++)
            items.items[i] = (parameter){0};
        const pbrt_items with_type = {all, items.count + 1};
        status = end_call(direct(parser, call, handle, strings, 1, with_type), with_type);
    }
    if (status != AG_OK)
        excuse_materials(parser, known_count);
    parameter_reset(&type);
    free(all);
    return status;
}

ag_status pbrt_builder_state(pbrt_builder *b, const pbrt_call *call, pbrt_statement statement,
                             const char *const *strings, pbrt_items items)
{
    static pbrt_handler *const HANDLERS[] = {pbrt_make_named_material, pbrt_make_named_medium, pbrt_film, pbrt_sampler,
                                             pbrt_integrator,          pbrt_pixel_filter};
    pbrt_handler *handle = HANDLERS[statement];
    const bool is_named = statement == PBRT_MATERIAL || statement == PBRT_MEDIUM;
    return end_call(is_named ? make_named(b->parser, call, handle, strings, items)
                             : direct(b->parser, call, handle, strings, 1, items),
                    items);
}

ag_status pbrt_builder_picture(pbrt_builder *b, const pbrt_call *call, const char *name, const image *picture,
                               uint64_t version)
{
    pbrt_parser *parser = b->parser;
    if (pbrt_find_picture(parser, name)) {
        log_at(parser->log, AG_LOG_ERROR, call->where, "there is a picture \"%s\" already", name);
        return AG_ERROR_SCENE;
    }
    pbrt_picture *larger = realloc(parser->pictures, (parser->picture_count + 1) * sizeof *larger);
    if (!larger)
        return AG_ERROR_MEMORY;
    parser->pictures = larger;
    larger[parser->picture_count] = (pbrt_picture){strdup(name), picture, version};
    if (!larger[parser->picture_count].name)
        return AG_ERROR_MEMORY;
    parser->picture_count++;
    return AG_OK;
}

void pbrt_builder_set_quiet(pbrt_builder *b, bool is_quiet) { b->parser->log = is_quiet ? NULL : b->parser->run->log; }

ag_status pbrt_builder_finish(pbrt_builder *b)
{
    pbrt_parser *parser = b->parser;
    AG_TRY(pbrt_settle_hints(parser));
    AG_TRY(pbrt_settle_realistic(parser));
    AG_TRY(pbrt_end_objects(parser));
    AG_TRY(pbrt_check_named_media(parser));
    return pbrt_check_named_materials(parser);
}
