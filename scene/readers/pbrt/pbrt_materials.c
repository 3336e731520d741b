/* pbrt_materials.c: Material, MakeNamedMaterial and NamedMaterial of a pbrt-v4 scene.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Materials".
 * Flow: pbrt_parser -> [here] -> scene.materials. Threads: one per scene. */
#define _POSIX_C_SOURCE 200809L
#include "pbrt/pbrt_private.h"

#include <stdlib.h>
#include <string.h>

static ag_status find_or_reserve(pbrt_parser *parser, const char *name, file_location where, uint32_t *out_index);

ag_status pbrt_read_mix(pbrt_parser *parser, parameter_list *list, material *m)
{
    const parameter *names = parameter_list_find(list, "materials");
    const char *ignored;
    AG_TRY(pbrt_get_float_texture(parser, list, "amount", &m->mix_amount, &m->mix_amount_texture));
    if (!names || names->type != PARAMETER_STRING || names->count != 2)
        return pbrt_refuse(parser, list, "materials", "\"mix\" needs \"string materials\" with two names");
    (void)parameter_get_string(list, NULL, "materials", &ignored); /* marks it as known */
    for (int i = 0; i < 2; i++)
        AG_TRY(find_or_reserve(parser, names->strings[i], names->where, &m->mixed[i]));
    return AG_OK;
}

static ag_status read_material(pbrt_parser *parser, parameter_list *list, const char *type, material *out_material)
{
    *out_material = material_make(MATERIAL_DIFFUSE);
    AG_TRY(pbrt_upgrade_material(parser, list, &type));
    const pbrt_material_row *row = pbrt_material_row_of(type);
    if (!row)
        return pbrt_error(parser, list->where, strlen(list->directive), "unknown material \"%s\"", type);
    *out_material = material_make(row->kind);
    AG_TRY(row->read(parser, list, out_material));
    if (row->kind != MATERIAL_MIX && row->kind != MATERIAL_INTERFACE) /* mixes have those of the two they mix */
        AG_TRY(pbrt_read_maps(parser, list, out_material));
    parameter_list_warn_unused(list, parser->log);
    return AG_OK;
}

ag_status pbrt_add_default_material(pbrt_parser *parser)
{
    material m = material_make(MATERIAL_DIFFUSE);
    return scene_add_material(parser->scene, &m, &parser->state.material_index);
}

ag_status pbrt_material(pbrt_parser *parser, file_location where)
{
    parameter_list list;
    material m;
    AG_TRY(pbrt_read_named_parameters(parser, "Material", "a quoted type", where, &list));
    ag_status status = read_material(parser, &list, list.name, &m);
    parameter_list_reset(&list);
    if (status == AG_OK)
        status = scene_add_material(parser->scene, &m, &parser->state.material_index);
    parser->state.has_no_surface = m.kind == MATERIAL_INTERFACE;
    return status;
}

static pbrt_named_material *find_named_material(pbrt_parser *parser, const char *name)
{
    uint32_t found;
    return name_table_find(&parser->material_names, name, &found) ? &parser->named_materials[found] : NULL;
}

/* Adds a name that is not there yet, for the scene's material of that index. */
static ag_status add_named_material(pbrt_parser *parser, const char *name, pbrt_named_material added)
{
    size_t count = parser->named_material_count;
    if ((count & (count - 1)) == 0) { /* room has doubled at every power of two */
        size_t capacity = count ? 2 * count : 16;
        pbrt_named_material *larger =
            count < UINT32_MAX / 2 ? realloc(parser->named_materials, capacity * sizeof *larger) : NULL;
        if (!larger)
            return AG_ERROR_MEMORY;
        parser->named_materials = larger;
    }
    added.name = strdup(name);
    if (!added.name || name_table_set(&parser->material_names, name, (uint32_t)count)) {
        free(added.name);
        return AG_ERROR_MEMORY;
    }
    parser->named_materials[count] = added;
    parser->named_material_count++;
    return scene_set_name(parser->scene, NAMED_MATERIAL, added.index, name);
}

static ag_status make_named(pbrt_parser *parser, parameter_list *list)
{
    const char *type = NULL;
    material m;
    pbrt_named_material made = {.is_defined = true, .where = list->where};
    AG_TRY(parameter_get_string(list, parser->log, "type", &type));
    if (!type)
        return pbrt_error(parser, list->where, strlen("MakeNamedMaterial"),
                          "MakeNamedMaterial \"%s\" has no \"string type\"", list->name);
    pbrt_named_material *named = find_named_material(parser, list->name);
    if (named && named->is_defined)
        return pbrt_error(parser, list->where, strlen("MakeNamedMaterial"),
                          "material \"%s\" is made twice, first at %s:%d:%d", list->name, named->where.file,
                          named->where.line, named->where.column);
    AG_TRY(read_material(parser, list, type, &m));
    AG_TRY(scene_add_material(parser->scene, &m, &made.index));
    named = find_named_material(parser, list->name); /* anew: a mix may have made entries for others, or for itself */
    if (!named)
        return add_named_material(parser, list->name, made);
    /* it has been used before: fill the entry that was made for it then */
    parser->scene->materials[named->index] = parser->scene->materials[made.index];
    named->is_defined = true;
    named->where = made.where;
    return AG_OK;
}

ag_status pbrt_make_named_material(pbrt_parser *parser, file_location where)
{
    parameter_list list;
    AG_TRY(pbrt_read_named_parameters(parser, "MakeNamedMaterial", "a quoted name", where, &list));
    ag_status status = make_named(parser, &list);
    parameter_list_reset(&list);
    return status;
}

/* Finds a named material, or makes an empty entry for one that is not made yet, as pbrt allows. */
static ag_status find_or_reserve(pbrt_parser *parser, const char *name, file_location where, uint32_t *out_index)
{
    pbrt_named_material *named = find_named_material(parser, name);
    if (!named) {
        pbrt_named_material used = {.where = where};
        material reserved = material_make(MATERIAL_DIFFUSE);
        AG_TRY(scene_add_material(parser->scene, &reserved, &used.index));
        AG_TRY(add_named_material(parser, name, used));
        named = find_named_material(parser, name);
    }
    named->is_excused = false;
    *out_index = named->index;
    return AG_OK;
}

static ag_status use_named(pbrt_parser *parser, const char *name, file_location where)
{
    AG_TRY(find_or_reserve(parser, name, where, &parser->state.material_index));
    parser->state.has_no_surface = parser->scene->materials[parser->state.material_index].kind == MATERIAL_INTERFACE;
    return AG_OK;
}

ag_status pbrt_use_named_material(pbrt_parser *parser, file_location where)
{
    char *name;
    AG_TRY(pbrt_read_string(parser, "NamedMaterial", "a quoted name", &name, NULL));
    ag_status status = use_named(parser, name, where);
    free(name);
    return status;
}

/* Checks that mixes of mixes end: none is more than so many deep, so there is no cycle. */
static ag_status check_mixes(pbrt_parser *parser)
{
    enum { DEPTH_MAX = 16 };
    const scene *s = parser->scene;
    unsigned char *depth = calloc((size_t)s->material_count + 1, 1);
    uint32_t too_deep = s->material_count; /* none */
    bool has_changed = true;
    if (!depth)
        return AG_ERROR_MEMORY;
    while (has_changed && too_deep == s->material_count) {
        has_changed = false;
        for (uint32_t i = 0; i < s->material_count; i++) {
            const material *m = &s->materials[i];
            for (int k = 0; k < 2 && m->kind == MATERIAL_MIX; k++)
                if (depth[i] <= depth[m->mixed[k]]) {
                    depth[i] = (unsigned char)(depth[m->mixed[k]] + 1);
                    has_changed = true;
                    if (depth[i] > DEPTH_MAX)
                        too_deep = m->mixed[k]; /* by its name */
                }
        }
    }
    free(depth);
    for (size_t i = 0; i < parser->named_material_count; i++) {
        const pbrt_named_material *named = &parser->named_materials[i];
        if (named->index == too_deep)
            return pbrt_error(parser, named->where, strlen("MakeNamedMaterial"),
                              "the mix \"%s\" mixes itself by way of others, or mixes are more than %d deep",
                              named->name, DEPTH_MAX);
    }
    return AG_OK;
}

/* Removes the light of interfaces: a material may turn out to be one after lamps of it were made. */
static void put_out_interfaces(pbrt_parser *parser)
{
    scene *s = parser->scene;
    for (uint32_t i = 0; i < s->shape_count; i++) {
        shape *lamp = &s->shapes[i];
        if (lamp->light_index == SHAPE_NO_LIGHT || s->materials[lamp->material_index].kind != MATERIAL_INTERFACE)
            continue;
        s->lights[lamp->light_index].as.area.radiance = rgb_gray(0.0f);
        lamp->light_index = SHAPE_NO_LIGHT;
        log_once(parser->log, AG_LOG_WARNING, "interface made late",
                 "%s: warning: shapes with the material \"interface\" cannot shine: their area lights are left out",
                 s->file_names[0]);
    }
}

ag_status pbrt_check_named_materials(pbrt_parser *parser)
{
    for (size_t i = 0; i < parser->named_material_count; i++) {
        const pbrt_named_material *named = &parser->named_materials[i];
        if (!named->is_defined && !named->is_excused)
            return pbrt_error(parser, named->where, strlen("NamedMaterial"), "no material is named \"%s\"",
                              named->name);
    }
    put_out_interfaces(parser);
    return check_mixes(parser);
}
