/* pbrt_parser.c: the directives of a pbrt-v4 scene file: which there are and where they may stand.
 * Rests on the format's description, pbrt.org/fileformat-v4. What is not supported yet is read to its end, named in a
 * warning and left out.
 * Flow: pbrt_files -> [here] -> pbrt_state, pbrt_transforms, pbrt_shapes, pbrt_textures, pbrt_materials, pbrt_media,
 * pbrt_lights, pbrt_camera, pbrt_hints -> scene. Threads: one per scene. */
#include "pbrt/pbrt_parser.h"

#include "image/image_reader.h"
#include "pbrt/pbrt_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Reads an Accelerator, which has no effect: Embree's BVH is used, and the picture is the same. */
static ag_status accelerator(pbrt_parser *parser, file_location where)
{
    parameter_list list;
    AG_TRY(pbrt_read_named_parameters(parser, "Accelerator", "a quoted type", where, &list));
    parameter_list_reset(&list);
    return AG_OK;
}

static ag_status include(pbrt_parser *parser, file_location where)
{
    char *name;
    file_location name_where;
    (void)where;
    AG_TRY(pbrt_read_string(parser, "Include", "a quoted file name", &name, &name_where));
    ag_status status = pbrt_push_file(parser, name, name_where, strlen(name) + 2);
    free(name);
    return status;
}

/* The table of directives */

typedef enum section { ANYWHERE, BEFORE_WORLD, IN_WORLD } section;

static const struct {
    const char *name;
    section where;
    pbrt_handler *handle;
} DIRECTIVES[] = {
    {"Shape", IN_WORLD, pbrt_shape},
    {"AttributeBegin", IN_WORLD, pbrt_attribute_begin},
    {"AttributeEnd", IN_WORLD, pbrt_attribute_end},
    {"NamedMaterial", IN_WORLD, pbrt_use_named_material},
    {"Material", IN_WORLD, pbrt_material},
    {"Translate", ANYWHERE, pbrt_translate},
    {"Scale", ANYWHERE, pbrt_scale},
    {"Rotate", ANYWHERE, pbrt_rotate},
    {"Transform", ANYWHERE, pbrt_transform},
    {"ConcatTransform", ANYWHERE, pbrt_concat_transform},
    {"Identity", ANYWHERE, pbrt_identity},
    {"LookAt", ANYWHERE, pbrt_look_at},
    {"CoordinateSystem", ANYWHERE, pbrt_coordinate_system},
    {"CoordSysTransform", ANYWHERE, pbrt_coord_sys_transform},
    {"ActiveTransform", ANYWHERE, pbrt_active_transform},
    {"TransformTimes", BEFORE_WORLD, pbrt_transform_times},
    {"ReverseOrientation", IN_WORLD, pbrt_reverse_orientation},
    {"TransformBegin", IN_WORLD, pbrt_transform_begin},
    {"TransformEnd", IN_WORLD, pbrt_transform_end},
    {"MakeNamedMaterial", IN_WORLD, pbrt_make_named_material},
    {"AreaLightSource", IN_WORLD, pbrt_area_light_source},
    {"LightSource", IN_WORLD, pbrt_light_source},
    {"ObjectBegin", IN_WORLD, pbrt_object_begin},
    {"ObjectEnd", IN_WORLD, pbrt_object_end},
    {"ObjectInstance", IN_WORLD, pbrt_object_instance},
    {"Texture", IN_WORLD, pbrt_texture},
    {"Import", IN_WORLD, pbrt_import},
    {"Include", ANYWHERE, include},
    {"Attribute", ANYWHERE, pbrt_attribute_directive},
    {"ColorSpace", ANYWHERE, pbrt_color_space},
    {"MakeNamedMedium", ANYWHERE, pbrt_make_named_medium},
    {"MediumInterface", ANYWHERE, pbrt_medium_interface},
    {"Camera", BEFORE_WORLD, pbrt_camera},
    {"Sampler", BEFORE_WORLD, pbrt_sampler},
    {"Integrator", BEFORE_WORLD, pbrt_integrator},
    {"Film", BEFORE_WORLD, pbrt_film},
    {"PixelFilter", BEFORE_WORLD, pbrt_pixel_filter},
    {"Accelerator", BEFORE_WORLD, accelerator},
    {"Option", BEFORE_WORLD, pbrt_option},
    {"WorldBegin", BEFORE_WORLD, pbrt_world_begin},
    {"WorldEnd", IN_WORLD, pbrt_world_end},
};

static ag_status do_directive(pbrt_parser *parser, const pbrt_token *token)
{
    enum { SHOWN = 60 };
    for (size_t i = 0; i < sizeof DIRECTIVES / sizeof *DIRECTIVES; i++) {
        const char *name = DIRECTIVES[i].name;
        if (!pbrt_token_is(token, PBRT_TOKEN_WORD, name))
            continue;
        if (DIRECTIVES[i].where == BEFORE_WORLD && parser->in_world)
            return pbrt_error(parser, token->where, token->width,
                              DIRECTIVES[i].handle == pbrt_world_begin ? "%s may only stand once"
                                                                       : "%s may only stand before WorldBegin",
                              name);
        if (DIRECTIVES[i].where == IN_WORLD && !parser->in_world)
            return pbrt_error(parser, token->where, token->width, "%s may only stand after WorldBegin", name);
        return DIRECTIVES[i].handle(parser, token->where);
    }
    int shown = token->length > SHOWN ? SHOWN : (int)token->length;
    double number;
    if (token->kind == PBRT_TOKEN_WORD && !pbrt_token_number(token, &number))
        return pbrt_error(parser, token->where, token->width, "unknown directive %.*s%s", shown, token->text,
                          token->length > SHOWN ? "..." : "");
    return pbrt_error(parser, token->where, token->width, "a directive should stand here, not %s%.*s%s%s",
                      token->kind == PBRT_TOKEN_STRING ? "\"" : "", shown, token->text,
                      token->length > SHOWN ? "..." : "", token->kind == PBRT_TOKEN_STRING ? "\"" : "");
}

/* Checks what can be checked only at the end of the text. end: the location of the end of the first file. */
static ag_status check_end(pbrt_parser *parser, file_location end)
{
    if (!parser->in_world)
        return pbrt_error(parser, end, 1, "the file ends without WorldBegin");
    AG_TRY(pbrt_check_blocks(parser, end));
    AG_TRY(pbrt_end_objects(parser));
    AG_TRY(pbrt_check_named_media(parser));
    return pbrt_check_named_materials(parser);
}

static ag_status parse(pbrt_parser *parser)
{
    AG_TRY(pbrt_add_default_material(parser));
    run_progress(parser->run, AG_PHASE_LOAD, 0.0);
    for (;;) {
        pbrt_token token;
        AG_TRY(pbrt_tell_progress(parser));
        AG_TRY(pbrt_next(parser, &token));
        if (token.kind == PBRT_TOKEN_END && parser->files[parser->file_count - 1].is_import) {
            AG_TRY(pbrt_end_import(parser, token.where));
            continue;
        }
        if (token.kind == PBRT_TOKEN_END) {
            AG_TRY(check_end(parser, token.where));
            break;
        }
        AG_TRY(do_directive(parser, &token));
    }
    run_progress(parser->run, AG_PHASE_LOAD, 1.0);
    return AG_OK;
}

pbrt_parser *pbrt_parser_create(run_context *run, scene *out_scene)
{
    pbrt_parser *parser = calloc(1, sizeof *parser);
    if (parser) {
        parser->run = run;
        parser->log = run->log;
        parser->scene = out_scene;
        parser->state.world_from_object = parser->state.world_from_object_end = transform_identity();
        parser->state.start_is_active = parser->state.end_is_active = true;
        parser->transform_times[1] = 1.0;
        parser->shapes_object_index = SCENE_NO_OBJECT;
        parser->curves_object_index = SCENE_NO_OBJECT;
        parser->source = (parameter_source){pbrt_excerpt, parser, &parser->scene->space};
        parser->state.medium_inside = parser->state.medium_outside = PBRT_NO_MEDIUM;
    }
    return parser;
}

void pbrt_parser_destroy(pbrt_parser *parser)
{
    while (parser->file_count > 0)
        pbrt_pop_file(parser);
    for (size_t i = 0; i < parser->named_material_count; i++)
        free(parser->named_materials[i].name);
    for (size_t i = 0; i < parser->named_medium_count; i++)
        free(parser->named_media[i].name);
    for (size_t i = 0; i < parser->picture_count; i++)
        free(parser->pictures[i].name);
    free(parser->pictures);
    pbrt_reset_objects(parser);
    name_table_reset(&parser->material_names);
    name_table_reset(&parser->medium_names);
    name_table_reset(&parser->float_texture_names);
    name_table_reset(&parser->spectrum_texture_names);
    name_table_reset(&parser->coordinate_system_names);
    pbrt_reset_hints(parser);
    pbrt_free_attributes(parser);
    free(parser->named_materials);
    free(parser->named_media);
    free(parser->coordinate_systems);
    free(parser->curves_between);
    free(parser->saved);
    free(parser->top_directory);
    free(parser);
}

/* Parses what has been pushed, unless pushing it has failed, and destroys the parser. */
static ag_status parse_pushed(pbrt_parser *parser, ag_status status)
{
    if (status == AG_OK)
        status = parse(parser);
    if (status == AG_OK)
        pbrt_warn_unused_attributes(parser);
    pbrt_parser_destroy(parser);
    return status;
}

ag_status pbrt_parse_file(run_context *run, const char *path, scene *out_scene)
{
    pbrt_parser *parser = pbrt_parser_create(run, out_scene);
    if (!parser)
        return AG_ERROR_MEMORY;
    return parse_pushed(parser, pbrt_push_file(parser, path, (file_location){NULL, 0, 0}, 0));
}

ag_status pbrt_parse_text(run_context *run, const char *name, const char *text, size_t size, scene *out_scene)
{
    pbrt_parser *parser = pbrt_parser_create(run, out_scene);
    if (!parser)
        return AG_ERROR_MEMORY;
    return parse_pushed(parser, pbrt_push_text(parser, name, text, size));
}
