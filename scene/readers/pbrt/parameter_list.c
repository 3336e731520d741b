/* parameter_list.c: see parameter_list.h.
 * Threads: one at a time. */
#define _POSIX_C_SOURCE 200809L
#include "pbrt/parameter_list.h"
#include "status.h"

#include <float.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *parameter_type_name(parameter_type type)
{
    static const char *const NAMES[] = {"float",   "integer", "string", "bool",     "point2",    "vector2", "point3",
                                        "vector3", "normal",  "rgb",    "spectrum", "blackbody", "texture"};
    return NAMES[type];
}

void parameter_reset(parameter *p)
{
    if (!p->is_borrowed) {
        if (p->strings)
            for (size_t i = 0; i < p->count; i++)
                free(p->strings[i]);
        free(p->strings);
        free(p->numbers);
        free(p->bools);
    }
    free(p->name);
    memset(p, 0, sizeof *p);
}

void parameter_list_reset(parameter_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        parameter_reset(&list->items[i]);
    free(list->items);
    free(list->directive);
    free(list->name);
    memset(list, 0, sizeof *list);
}

/* Copies values; returns NULL where there is nothing to copy, which is no failure. */
static void *copy_values(const void *values, size_t bytes, bool *in_out_is_good)
{
    if (!values)
        return NULL;
    void *copy = malloc(bytes ? bytes : 1);
    if (copy)
        memcpy(copy, values, bytes);
    *in_out_is_good = *in_out_is_good && copy;
    return copy;
}

bool parameter_copy(const parameter *p, parameter *out_copy)
{
    bool is_good = true;
    *out_copy = *p;
    out_copy->is_borrowed = false;
    out_copy->name = copy_values(p->name, strlen(p->name) + 1, &is_good);
    out_copy->numbers = copy_values(p->numbers, p->count * sizeof *p->numbers, &is_good);
    out_copy->bools = copy_values(p->bools, p->count, &is_good);
    out_copy->strings = p->strings ? calloc(p->count + 1, sizeof *p->strings) : NULL;
    is_good = is_good && (out_copy->strings || !p->strings);
    for (size_t i = 0; out_copy->strings && i < p->count; i++)
        out_copy->strings[i] = copy_values(p->strings[i], strlen(p->strings[i]) + 1, &is_good);
    if (!is_good)
        parameter_reset(out_copy);
    return is_good;
}

bool parameter_borrow(const parameter *p, parameter *out_parameter)
{
    *out_parameter = *p;
    out_parameter->is_borrowed = true;
    out_parameter->name = strdup(p->name);
    if (!out_parameter->name)
        parameter_reset(out_parameter);
    return out_parameter->name != NULL;
}

ag_status parameter_own(parameter *p)
{
    parameter own;
    if (!p->is_borrowed)
        return AG_OK;
    if (!parameter_copy(p, &own))
        return AG_ERROR_MEMORY;
    parameter_reset(p);
    *p = own;
    return AG_OK;
}

/* Tells the error with the line that the parameter is in; always returns AG_ERROR_SCENE. */
static ag_status refuse(const parameter_list *list, log_sink *log, const parameter *p, const char *format, ...)
    AG_PRINTF(4, 5);
static ag_status refuse(const parameter_list *list, log_sink *log, const parameter *p, const char *format, ...)
{
    char excerpt[320] = "";
    if (list->source)
        list->source->excerpt(list->source->user, p->where, strlen(parameter_type_name(p->type)) + strlen(p->name) + 3,
                              excerpt, sizeof excerpt);
    va_list arguments;
    va_start(arguments, format);
    log_at_with_excerpt(log, p->where, excerpt, format, arguments);
    va_end(arguments);
    return AG_ERROR_SCENE;
}

const parameter *parameter_list_find(const parameter_list *list, const char *name)
{
    for (size_t i = 0; i < list->count; i++)
        if (strcmp(list->items[i].name, name) == 0)
            return &list->items[i];
    return NULL;
}

/* Finds the parameter and checks that it is of the type. *out_parameter is NULL where there is none to be used: it is
 * absent, or a texture, which is told. */
static ag_status look_up(parameter_list *list, log_sink *log, const char *name, parameter_type type,
                         const parameter **out_parameter)
{
    *out_parameter = NULL;
    parameter *p = (parameter *)parameter_list_find(list, name);
    if (!p)
        return AG_OK;
    p->looked_up = true;
    if (p->type == PARAMETER_TEXTURE && type != PARAMETER_TEXTURE) {
        char key[160];
        snprintf(key, sizeof key, "texture parameter:%s", name);
        log_at_once(log, AG_LOG_WARNING, p->where, key,
                    "\"texture %s\" is not supported here: it is ignored and the default is used", name);
        return AG_OK;
    }
    if (p->type != type)
        return refuse(list, log, p, "\"%s %s\" should be \"%s %s\"", parameter_type_name(p->type), name,
                      parameter_type_name(type), name);
    *out_parameter = p;
    return AG_OK;
}

static ag_status look_up_counted(parameter_list *list, log_sink *log, const char *name, parameter_type type,
                                 size_t count, const parameter **out_parameter)
{
    AG_TRY(look_up(list, log, name, type, out_parameter));
    if (!*out_parameter || (*out_parameter)->count == count)
        return AG_OK;
    return refuse(list, log, *out_parameter, "\"%s %s\" should have %zu value%s, but has %zu",
                  parameter_type_name(type), name, count, count == 1 ? "" : "s", (*out_parameter)->count);
}

static ag_status check_float(const parameter_list *list, log_sink *log, const parameter *p)
{
    for (size_t i = 0; i < p->count; i++)
        if (!(fabs(p->numbers[i]) <= (double)FLT_MAX))
            return refuse(list, log, p, "\"%s %s\": %g is too large", parameter_type_name(p->type), p->name,
                          p->numbers[i]);
    return AG_OK;
}

ag_status parameter_get_float(parameter_list *list, log_sink *log, const char *name, float *out_value)
{
    const parameter *p;
    AG_TRY(look_up_counted(list, log, name, PARAMETER_FLOAT, 1, &p));
    if (!p)
        return AG_OK;
    AG_TRY(check_float(list, log, p));
    *out_value = (float)p->numbers[0];
    return AG_OK;
}

ag_status parameter_get_int(parameter_list *list, log_sink *log, const char *name, int64_t *out_value)
{
    const parameter *p;
    AG_TRY(look_up_counted(list, log, name, PARAMETER_INTEGER, 1, &p));
    if (p)
        *out_value = (int64_t)p->numbers[0]; /* the reader holds integers to 32 bits */
    return AG_OK;
}

ag_status parameter_get_bool(parameter_list *list, log_sink *log, const char *name, bool *out_value)
{
    const parameter *p;
    AG_TRY(look_up_counted(list, log, name, PARAMETER_BOOL, 1, &p));
    if (p)
        *out_value = p->bools[0] != 0;
    return AG_OK;
}

ag_status parameter_get_string(parameter_list *list, log_sink *log, const char *name, const char **out_value)
{
    const parameter *p;
    AG_TRY(look_up_counted(list, log, name, PARAMETER_STRING, 1, &p));
    if (p)
        *out_value = p->strings[0];
    return AG_OK;
}

ag_status parameter_get_texture(parameter_list *list, log_sink *log, const char *name, const char **out_texture_name)
{
    const parameter *p = parameter_list_find(list, name);
    if (!p || p->type != PARAMETER_TEXTURE)
        return AG_OK;
    AG_TRY(look_up_counted(list, log, name, PARAMETER_TEXTURE, 1, &p));
    *out_texture_name = p->strings[0];
    return AG_OK;
}

ag_status parameter_get_vec3(parameter_list *list, log_sink *log, const char *name, parameter_type type,
                             vec3 *out_value)
{
    const parameter *p;
    AG_TRY(look_up_counted(list, log, name, type, 3, &p));
    if (!p)
        return AG_OK;
    AG_TRY(check_float(list, log, p));
    *out_value = vec3_make((float)p->numbers[0], (float)p->numbers[1], (float)p->numbers[2]);
    return AG_OK;
}

spectrum_use parameter_spectrum_use(const char *name)
{
    static const char *const EMITTED[] = {"L", "I", "Le"};
    static const char *const INDICES[] = {"eta", "k", "conductor.eta", "conductor.k", "interface.eta"};
    static const char *const DENSITIES[] = {"sigma_a", "sigma_s", "mfp"};
    for (size_t i = 0; i < sizeof EMITTED / sizeof *EMITTED; i++)
        if (strcmp(name, EMITTED[i]) == 0)
            return SPECTRUM_LIGHT;
    for (size_t i = 0; i < sizeof INDICES / sizeof *INDICES; i++)
        if (strcmp(name, INDICES[i]) == 0)
            return SPECTRUM_INDEX;
    for (size_t i = 0; i < sizeof DENSITIES / sizeof *DENSITIES; i++)
        if (strcmp(name, DENSITIES[i]) == 0)
            return SPECTRUM_DENSITY;
    return SPECTRUM_REFLECTANCE;
}

/* Gets a spectrum by its name. The reader has replaced the names of files by their values, so a name that is left is
 * one of pbrt's. */
static ag_status get_spectrum(const parameter_list *list, log_sink *log, const parameter *p, rgb *out_value)
{
    const working_space *space = list->source ? list->source->space : NULL;
    if (p->count == 0 || (p->strings && p->count != 1))
        return refuse(list, log, p, "\"spectrum %s\" should have %s", p->name,
                      p->count == 0 ? "values" : "one name, or numbers");
    if (p->strings) {
        if (!spectra_find_named(p->strings[0], space, out_value)) {
            char key[160];
            snprintf(key, sizeof key, "named spectrum:%s", p->strings[0]);
            log_at_once(log, AG_LOG_WARNING, p->where, key,
                        "the spectrum \"%s\" is not known, or not supported yet: the default of \"%s\" is used",
                        p->strings[0], p->name);
        }
        return AG_OK;
    }
    for (size_t i = 0; i < p->count; i += 2) {
        if (i > 0 && !(p->numbers[i] > p->numbers[i - 2]))
            return refuse(list, log, p, "\"spectrum %s\": the wavelengths should increase, but %g follows %g", p->name,
                          p->numbers[i], p->numbers[i - 2]);
        if (!(p->numbers[i + 1] >= 0.0))
            return refuse(list, log, p, "\"spectrum %s\" has a negative value, %g", p->name, p->numbers[i + 1]);
    }
    AG_TRY(check_float(list, log, p));
    *out_value = spectra_sampled(p->numbers, p->count / 2, parameter_spectrum_use(p->name), space);
    return AG_OK;
}

static ag_status get_blackbody(parameter_list *list, log_sink *log, const char *name, rgb *out_value)
{
    const parameter *p;
    AG_TRY(look_up_counted(list, log, name, PARAMETER_BLACKBODY, 1, &p));
    if (!p)
        return AG_OK;
    double kelvin = p->numbers[0];
    if (!(kelvin >= SPECTRA_MIN_KELVIN && kelvin <= SPECTRA_MAX_KELVIN))
        return refuse(list, log, p, "\"blackbody %s\": %g is not a temperature from %g to %g kelvin", name, kelvin,
                      SPECTRA_MIN_KELVIN, SPECTRA_MAX_KELVIN);
    *out_value = spectra_blackbody(kelvin, list->source ? list->source->space : NULL);
    return AG_OK;
}

ag_status parameter_get_rgb(parameter_list *list, log_sink *log, const char *name, rgb *out_value)
{
    parameter *found = (parameter *)parameter_list_find(list, name);
    if (found && found->type == PARAMETER_SPECTRUM) {
        found->looked_up = true;
        return get_spectrum(list, log, found, out_value);
    }
    if (found && found->type == PARAMETER_BLACKBODY)
        return get_blackbody(list, log, name, out_value);
    const parameter *p;
    AG_TRY(look_up_counted(list, log, name, PARAMETER_RGB, 3, &p));
    if (!p)
        return AG_OK;
    AG_TRY(check_float(list, log, p));
    for (int i = 0; i < 3; i++)
        if (p->numbers[i] < 0.0)
            return refuse(list, log, p, "\"rgb %s\" has a negative component, %g", name, p->numbers[i]);
    *out_value = rgb_make((float)p->numbers[0], (float)p->numbers[1], (float)p->numbers[2]);
    return AG_OK;
}

ag_status parameter_get_numbers(parameter_list *list, log_sink *log, const char *name, parameter_type type,
                                const double **out_values, size_t *out_count)
{
    const parameter *p;
    *out_values = NULL;
    *out_count = 0;
    AG_TRY(look_up(list, log, name, type, &p));
    if (!p)
        return AG_OK;
    AG_TRY(check_float(list, log, p));
    *out_values = p->numbers;
    *out_count = p->count;
    return AG_OK;
}

/* Returns the kind, "sphere", "diffuse", ...: named materials and media have it in a parameter, since their name is the
 * user's own. */
static const char *kind_of(const parameter_list *list)
{
    const parameter *type = parameter_list_find(list, "type");
    if (strncmp(list->directive, "MakeNamed", strlen("MakeNamed")) == 0 && type && type->type == PARAMETER_STRING &&
        type->count == 1)
        return type->strings[0];
    return list->name ? list->name : "";
}

void parameter_list_warn_unused(const parameter_list *list, log_sink *log)
{
    const char *kind = kind_of(list);
    for (size_t i = 0; i < list->count; i++) {
        const parameter *p = &list->items[i];
        if (p->looked_up && p->used)
            *p->used = true;
        if (p->looked_up || p->may_be_unused)
            continue;
        char key[160];
        snprintf(key, sizeof key, "unused parameter:%s:%s:%s", list->directive, kind, p->name);
        log_at_once(log, AG_LOG_WARNING, p->where, key,
                    "%s \"%s\": \"%s %s\" is not known, or not supported yet, and is ignored", list->directive, kind,
                    parameter_type_name(p->type), p->name);
    }
}
