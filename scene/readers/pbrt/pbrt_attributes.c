/* pbrt_attributes.c: Attribute of a pbrt-v4 scene: parameters for the shapes, lights, materials, media or textures that
 * follow, until the block ends.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Attributes". What a directive says itself comes first,
 * then the latest Attribute. Flow: pbrt_parser -> [here] -> pbrt_parameters. Threads: one per scene. */
#include "pbrt/pbrt_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *directive;
    pbrt_target target;
} TARGETS[] = {
    {"Shape", PBRT_TARGET_SHAPE},
    {"LightSource", PBRT_TARGET_LIGHT},
    {"AreaLightSource", PBRT_TARGET_LIGHT},
    {"Material", PBRT_TARGET_MATERIAL},
    {"MakeNamedMaterial", PBRT_TARGET_MATERIAL},
    {"MakeNamedMedium", PBRT_TARGET_MEDIUM},
    {"Texture", PBRT_TARGET_TEXTURE},
};

static size_t find_in_force(const pbrt_attributes *of, const char *name)
{
    size_t i = 0;
    while (i < of->count && strcmp(of->in_force[i]->item.name, name) != 0)
        i++;
    return i;
}

/* Takes a parameter and puts it into force in the place of another of its name. The end of the block brings that one
 * back where it is from outside of the block. */
static ag_status add_attribute(pbrt_parser *parser, parameter *p, pbrt_target target, const char *name)
{
    pbrt_attributes *of = &parser->attributes_of[target];
    const size_t place = find_in_force(of, p->name);
    if (place == PBRT_MAX_PARAMETERS)
        return pbrt_error(parser, p->where, strlen(parameter_type_name(p->type)) + strlen(p->name) + 3,
                          "more than %d attributes of different names for \"%s\"", PBRT_MAX_PARAMETERS, name);
    pbrt_attribute *added = calloc(1, sizeof *added);
    if (!added)
        return AG_ERROR_MEMORY;
    added->item = *p;
    *p = (parameter){0};
    added->item.may_be_unused = true;
    added->item.used = &added->is_used;
    added->target = name;
    added->block = parser->saved_count;
    added->older_of_all = parser->attributes;
    parser->attributes = added;
    if (place == of->count) {
        of->count++;
    } else {
        pbrt_attribute *before = of->in_force[place];
        added->outside = before->block == added->block ? before->outside : before;
    }
    of->in_force[place] = added;
    return AG_OK;
}

static ag_status add_attributes(pbrt_parser *parser, parameter_list *list, pbrt_target target, const char *name)
{
    for (size_t i = 0; i < list->count; i++)
        AG_TRY(add_attribute(parser, &list->items[i], target, name));
    return AG_OK;
}

void pbrt_leave_attributes(pbrt_parser *parser)
{
    for (int target = 0; target < PBRT_TARGET_COUNT; target++) {
        pbrt_attributes *of = &parser->attributes_of[target];
        size_t kept = 0;
        for (size_t i = 0; i < of->count; i++) {
            pbrt_attribute *a = of->in_force[i];
            if (a->block > parser->saved_count)
                a = a->outside;
            if (a)
                of->in_force[kept++] = a;
        }
        of->count = kept;
    }
}

ag_status pbrt_attribute_directive(pbrt_parser *parser, file_location where)
{
    static const char *const NAMES[PBRT_TARGET_COUNT] = {"shape", "light", "material", "medium", "texture"};
    parameter_list list;
    AG_TRY(pbrt_read_named_parameters(parser, "Attribute", "a quoted target", where, &list));
    int target = 0;
    while (target < PBRT_TARGET_COUNT && strcmp(list.name, NAMES[target]) != 0)
        target++;
    ag_status status =
        target < PBRT_TARGET_COUNT
            ? add_attributes(parser, &list, (pbrt_target)target, NAMES[target])
            : pbrt_error(parser, where, strlen("Attribute"),
                         "unknown target \"%s\"; known are shape, light, material, medium and texture", list.name);
    parameter_list_reset(&list);
    return status;
}

ag_status pbrt_append_attributes(pbrt_parser *parser, parameter_list *list)
{
    const pbrt_attributes *of = NULL;
    for (size_t i = 0; i < sizeof TARGETS / sizeof *TARGETS; i++)
        if (strcmp(list->directive, TARGETS[i].directive) == 0)
            of = &parser->attributes_of[TARGETS[i].target];
    if (!of || of->count == 0)
        return AG_OK;
    const size_t said_count = list->count;
    parameter *larger = realloc(list->items, (list->count + of->count) * sizeof *larger);
    if (!larger)
        return AG_ERROR_MEMORY;
    list->items = larger;
    const parameter_list said = {.items = larger, .count = said_count};
    for (size_t i = 0; i < of->count; i++) {
        const parameter *item = &of->in_force[i]->item;
        if (parameter_list_find(&said, item->name))
            continue;
        if (!parameter_borrow(item, &larger[list->count]))
            return AG_ERROR_MEMORY;
        list->count++;
    }
    return AG_OK;
}

void pbrt_warn_unused_attributes(const pbrt_parser *parser)
{
    for (const pbrt_attribute *a = parser->attributes; a; a = a->older_of_all) {
        char key[160];
        snprintf(key, sizeof key, "unused attribute:%s:%s", a->target, a->item.name);
        if (!a->is_used)
            log_at_once(parser->log, AG_LOG_WARNING, a->item.where, key,
                        "Attribute \"%s\": \"%s %s\" is used by nothing that follows", a->target,
                        parameter_type_name(a->item.type), a->item.name);
    }
}

void pbrt_free_attributes(pbrt_parser *parser)
{
    while (parser->attributes) {
        pbrt_attribute *a = parser->attributes;
        parser->attributes = a->older_of_all;
        parameter_reset(&a->item);
        free(a);
    }
}
