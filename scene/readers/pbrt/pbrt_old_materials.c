/* pbrt_old_materials.c: materials by pbrt-v3's names, as pbrt-v4's own "--upgrade" makes new ones of them.
 * Rests on pbrt-v4's src/pbrt/parser.cpp (which name becomes which, and what is lost); the parameters that remain get
 * pbrt-v4's defaults, as they do there.
 * Flow: pbrt_materials -> [here]: the list is changed before it is read. Threads: one per scene. */
#define _POSIX_C_SOURCE 200809L
#include "pbrt/pbrt_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static parameter *find(parameter_list *list, const char *name) { return (parameter *)parameter_list_find(list, name); }

static bool is_constant(const parameter *p, double value)
{
    if (!p->numbers || (p->type != PARAMETER_RGB && p->type != PARAMETER_FLOAT) || p->count == 0)
        return false;
    for (size_t i = 0; i < p->count; i++)
        if (p->numbers[i] != value)
            return false;
    return true;
}

/* Marks a parameter as read that the new material does not have, and says so unless it has the value that changes
 * nothing. Returns whether it has. */
static bool drop(pbrt_parser *parser, parameter_list *list, const char *type, const char *name, double without_effect)
{
    parameter *p = find(list, name);
    if (!p)
        return false;
    bool is_silent = is_constant(p, without_effect);
    char key[96];
    snprintf(key, sizeof key, "dropped:%s:%s", type, name);
    p->looked_up = true;
    if (!is_silent)
        log_at_once(parser->log, AG_LOG_WARNING, p->where, key, "\"%s\" of pbrt-v3's material \"%s\" is not used", name,
                    type);
    return is_silent;
}

/* Returns the kind that "uber" and "plastic" become: without gloss they are diffuse alone. */
static const char *plastic_kind(pbrt_parser *parser, parameter_list *list, const char *type)
{
    static const char *const OF_COAT[] = {"roughness", "uroughness", "vroughness", "eta", "remaproughness"};
    if (!drop(parser, list, type, "Ks", 0.0))
        return "coateddiffuse";
    for (size_t i = 0; i < sizeof OF_COAT / sizeof *OF_COAT; i++)
        if (find(list, OF_COAT[i]))
            find(list, OF_COAT[i])->looked_up = true;
    return "diffuse";
}

/* pbrt-v3's "amount" is the share of the first material, pbrt-v4's that of the second. */
static ag_status upgrade_mix(pbrt_parser *parser, parameter_list *list)
{
    parameter *first = find(list, "namedmaterial1"), *second = find(list, "namedmaterial2"),
              *amount = find(list, "amount");
    if (amount && amount->type == PARAMETER_RGB && amount->count == 3) {
        if (amount->numbers[0] != amount->numbers[1] || amount->numbers[1] != amount->numbers[2])
            log_at_once(parser->log, AG_LOG_WARNING, amount->where, "mix amount",
                        "\"rgb amount\" of \"mix\" is not supported: the mean of its components is used");
        AG_TRY(parameter_own(amount));
        amount->type = PARAMETER_FLOAT;
        amount->numbers[0] = (amount->numbers[0] + amount->numbers[1] + amount->numbers[2]) / 3.0;
        amount->count = 1;
    }
    if (!first || !second || find(list, "materials") || first->type != PARAMETER_STRING || first->count != 1 ||
        second->type != PARAMETER_STRING || second->count != 1)
        return AG_OK;
    AG_TRY(parameter_own(first));
    AG_TRY(parameter_own(second));
    char **names = realloc(first->strings, 2 * sizeof *names);
    if (!names)
        return AG_ERROR_MEMORY;
    first->strings = names;
    names[1] = names[0];
    names[0] = second->strings[0];
    first->count = 2;
    second->strings[0] = NULL;
    second->count = 0;
    second->looked_up = true;
    return pbrt_rename_parameter(list, "namedmaterial1", "materials");
}

static ag_status upgrade(pbrt_parser *parser, parameter_list *list, const char *old, const char **out_new)
{
    *out_new = NULL;
    bool is_uber = strcmp(old, "uber") == 0, is_glass = strcmp(old, "glass") == 0;
    if (is_uber || is_glass)
        AG_TRY(pbrt_rename_parameter(list, "index", "eta"));
    if (is_uber || strcmp(old, "plastic") == 0) {
        *out_new = plastic_kind(parser, list, old);
        if (is_uber) {
            drop(parser, list, old, "Kr", 0.0);
            drop(parser, list, old, "Kt", 0.0);
            drop(parser, list, old, "opacity", 1.0);
        }
        return pbrt_rename_parameter(list, "Kd", "reflectance");
    }
    if (is_glass) {
        *out_new = "dielectric";
        drop(parser, list, old, "Kr", 1.0);
        drop(parser, list, old, "Kt", 1.0);
    } else if (strcmp(old, "matte") == 0) {
        *out_new = "diffuse";
        drop(parser, list, old, "sigma", 0.0);
        AG_TRY(pbrt_rename_parameter(list, "Kd", "reflectance"));
    } else if (strcmp(old, "substrate") == 0) {
        *out_new = "coateddiffuse";
        drop(parser, list, old, "Ks", 1.0);
        AG_TRY(pbrt_rename_parameter(list, "Kd", "reflectance"));
    } else if (strcmp(old, "metal") == 0) {
        *out_new = "conductor";
        drop(parser, list, old, "Kr", 1.0);
    } else if (strcmp(old, "mirror") == 0) {
        *out_new = "conductor";
        drop(parser, list, old, "Kr", 0.0);
        AG_TRY(pbrt_add_string(list, "eta", PARAMETER_SPECTRUM, "metal-Ag-eta"));
        AG_TRY(pbrt_add_string(list, "k", PARAMETER_SPECTRUM, "metal-Ag-k"));
    } else if (strcmp(old, "translucent") == 0) {
        *out_new = "diffusetransmission";
        drop(parser, list, old, "reflect", 0.0);
        drop(parser, list, old, "transmit", 1.0);
        drop(parser, list, old, "Ks", 0.0);
        drop(parser, list, old, "roughness", 0.0);
        AG_TRY(pbrt_rename_parameter(list, "Kd", "transmittance"));
    } else if (strcmp(old, "kdsubsurface") == 0) {
        *out_new = "subsurface";
        AG_TRY(pbrt_rename_parameter(list, "Kd", "reflectance"));
    } else if (strcmp(old, "disney") == 0) {
        *out_new = "diffuse";
        AG_TRY(pbrt_rename_parameter(list, "color", "reflectance"));
        for (size_t i = 0; i < list->count; i++)
            if (strcmp(list->items[i].name, "reflectance") != 0 && strcmp(list->items[i].name, "bumpmap") != 0)
                list->items[i].looked_up = true;
    }
    return AG_OK;
}

ag_status pbrt_upgrade_material(pbrt_parser *parser, parameter_list *list, const char **type)
{
    const char *new_name, *old = *type;
    if (strcmp(old, "mix") == 0)
        return upgrade_mix(parser, list);
    AG_TRY(upgrade(parser, list, old, &new_name));
    AG_TRY(pbrt_rename_parameter(list, "bumpmap", "displacement"));
    if (!new_name)
        return AG_OK;
    char key[96];
    snprintf(key, sizeof key, "material:%s", old);
    log_at_once(parser->log, AG_LOG_WARNING, list->where, key,
                "material \"%s\" is pbrt-v3's: it is read as \"%s\", as pbrt-v4's \"--upgrade\" does", old, new_name);
    *type = new_name;
    return AG_OK;
}
