/* scene_parameters.c: see scene_parameters.h. */
#define _POSIX_C_SOURCE 200809L
#include "scene_parameters.h"

#include "pbrt/pbrt_builder.h"
#include "status.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

_Static_assert((int)AG_PARAMETER_FLOAT == (int)PARAMETER_FLOAT && (int)AG_PARAMETER_POINT2 == (int)PARAMETER_POINT2 &&
                   (int)AG_PARAMETER_RGB == (int)PARAMETER_RGB && (int)AG_PARAMETER_TEXTURE == (int)PARAMETER_TEXTURE,
               "the public types are the readers'");

/* How many numbers one value of each type has; 0: the type is not of numbers. */
static const unsigned char COMPONENTS[] = {1, 1, 0, 0, 2, 2, 3, 3, 3, 3, 2, 1, 0};

/* The points of the largest mesh, of 2^31 vertices, have fewer numbers. */
static const uint64_t VALUES_MAX = (uint64_t)1 << 33;

static bool takes_strings(ag_parameter_type type)
{
    return type == AG_PARAMETER_STRING || type == AG_PARAMETER_TEXTURE || type == AG_PARAMETER_SPECTRUM;
}

/* Says why its arrays cannot be taken; NULL where they can. */
static const char *find_wrong_array(const ag_parameter *p)
{
    const int arrays =
        (p->floats != NULL) + (p->doubles != NULL) + (p->integers != NULL) + (p->strings != NULL) + (p->bools != NULL);
    const bool is_number = p->floats || p->doubles, is_of_numbers = COMPONENTS[p->type] > 0;
    if (arrays > 1 || (arrays == 0 && p->count > 0))
        return "one of its arrays should be there, and no other";
    if (arrays == 0)
        return NULL;
    if (p->type == AG_PARAMETER_INTEGER)
        return p->integers ? NULL : "its values should be integers";
    if (p->type == AG_PARAMETER_BOOL)
        return p->bools ? NULL : "its values should be bools";
    if (p->strings && takes_strings(p->type))
        return NULL;
    if (is_number && is_of_numbers)
        return NULL;
    return is_of_numbers ? "its values should be floats or doubles" : "its values should be strings";
}

static ag_status refuse(log_sink *log, const parameter *to, const char *what)
{
    log_at(log, AG_LOG_ERROR, to->where, "\"%s %s\": %s", parameter_type_name(to->type), to->name, what);
    return AG_ERROR_ARGUMENT;
}

static ag_status copy_numbers(log_sink *log, const ag_parameter *from, parameter *to)
{
    to->numbers = malloc(from->count * sizeof *to->numbers);
    if (!to->numbers)
        return AG_ERROR_MEMORY;
    for (size_t i = 0; i < from->count; i++) {
        const double value = from->floats    ? (double)from->floats[i]
                             : from->doubles ? from->doubles[i]
                                             : (double)from->integers[i];
        if (!isfinite(value)) {
            log_at(log, AG_LOG_ERROR, to->where, "\"%s %s\": value %zu is not finite", parameter_type_name(to->type),
                   to->name, i + 1);
            return AG_ERROR_ARGUMENT;
        }
        to->numbers[i] = value;
    }
    to->count = from->count;
    return AG_OK;
}

static ag_status copy_strings(log_sink *log, const ag_parameter *from, parameter *to)
{
    to->strings = calloc(from->count, sizeof *to->strings);
    if (!to->strings)
        return AG_ERROR_MEMORY;
    for (size_t i = 0; i < from->count; i++, to->count++) {
        if (!from->strings[i])
            return refuse(log, to, "a string is NULL");
        to->strings[i] = strdup(from->strings[i]);
        if (!to->strings[i])
            return AG_ERROR_MEMORY;
    }
    return AG_OK;
}

static ag_status copy_bools(const ag_parameter *from, parameter *to)
{
    to->bools = malloc(from->count);
    if (!to->bools)
        return AG_ERROR_MEMORY;
    for (size_t i = 0; i < from->count; i++)
        to->bools[i] = from->bools[i];
    to->count = from->count;
    return AG_OK;
}

static ag_status copy_parameter(log_sink *log, const ag_parameter *from, parameter *to)
{
    if (!from->name || !from->name[0] || (unsigned)from->type > AG_PARAMETER_TEXTURE) {
        log_at(log, AG_LOG_ERROR, to->where, "a parameter has no %s",
               from->name && from->name[0] ? "type that there is" : "name");
        return AG_ERROR_ARGUMENT;
    }
    to->type = (parameter_type)from->type;
    to->name = strdup(from->name);
    if (!to->name)
        return AG_ERROR_MEMORY;
    const char *wrong = find_wrong_array(from);
    if (wrong)
        return refuse(log, to, wrong);
    if ((uint64_t)from->count > VALUES_MAX)
        return refuse(log, to, "it has more than 2^33 values");
    if (!from->strings && COMPONENTS[from->type] > 1 && from->count % COMPONENTS[from->type] != 0) {
        log_at(log, AG_LOG_ERROR, to->where, "\"%s %s\" has %zu numbers, which is no multiple of %d",
               parameter_type_name(to->type), to->name, from->count, COMPONENTS[from->type]);
        return AG_ERROR_ARGUMENT;
    }
    if (from->count == 0)
        return AG_OK;
    return from->strings ? copy_strings(log, from, to)
           : from->bools ? copy_bools(from, to)
                         : copy_numbers(log, from, to);
}

ag_status scene_parameters_copy(log_sink *log, file_location where, const ag_parameter *given, size_t count,
                                pbrt_items *out_items)
{
    *out_items = (pbrt_items){0};
    if (count > SCENE_PARAMETERS_MAX || (count > 0 && !given)) {
        log_at(log, AG_LOG_ERROR, where,
               count > SCENE_PARAMETERS_MAX ? "there are more than %d parameters"
                                            : "of %d parameters there is no array",
               count > SCENE_PARAMETERS_MAX ? SCENE_PARAMETERS_MAX : (int)count);
        return AG_ERROR_ARGUMENT;
    }
    out_items->items = calloc(count + 1, sizeof *out_items->items);
    ag_status status = out_items->items ? AG_OK : AG_ERROR_MEMORY;
    for (size_t i = 0; i < count && status == AG_OK; i++) {
        parameter *to = &out_items->items[out_items->count++];
        to->where = where;
        to->where.column = (int)i + 1;
        status = copy_parameter(log, &given[i], to);
    }
    if (status != AG_OK)
        scene_parameters_free(out_items);
    return status;
}

void scene_parameters_free(pbrt_items *items)
{
    for (size_t i = 0; i < items->count; i++)
        parameter_reset(&items->items[i]);
    free(items->items);
    *items = (pbrt_items){0};
}

ag_status scene_parameters_duplicate(const pbrt_items *from, pbrt_items *out)
{
    *out = (pbrt_items){calloc(from->count + 1, sizeof *out->items), 0};
    if (!out->items)
        return AG_ERROR_MEMORY;
    for (; out->count < from->count; out->count++)
        if (!parameter_copy(&from->items[out->count], &out->items[out->count])) {
            scene_parameters_free(out);
            return AG_ERROR_MEMORY;
        }
    return AG_OK;
}
