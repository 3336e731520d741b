/* parameter_list.h: the typed, named parameters of one scene directive, as they stand in the file.
 * Rests on the pbrt-v4 file format, "Parameter Lists" (pbrt.org/fileformat-v4).
 * Flow: pbrt_parser fills them; who interprets a directive looks parameters up and so marks them as known; what nobody
 * asked for is warned about. Threads: one at a time. */
#ifndef AFTERGLOW_PARAMETER_LIST_H
#define AFTERGLOW_PARAMETER_LIST_H

#include "color/spectra.h"
#include "math/vec3.h"
#include "text/file_location.h"

#include <stddef.h>
#include <stdint.h>

typedef enum parameter_type {
    PARAMETER_FLOAT,
    PARAMETER_INTEGER,
    PARAMETER_STRING,
    PARAMETER_BOOL,
    PARAMETER_POINT2,
    PARAMETER_VECTOR2,
    PARAMETER_POINT3,
    PARAMETER_VECTOR3,
    PARAMETER_NORMAL,
    PARAMETER_RGB,
    PARAMETER_SPECTRUM,
    PARAMETER_BLACKBODY,
    PARAMETER_TEXTURE
} parameter_type;

/* Returns the type's name as the scene file spells it: "float", "point3", ... */
const char *parameter_type_name(parameter_type type);

typedef struct parameter {
    char *name;
    parameter_type type;
    file_location where; /* of the quoted "type name" */
    size_t count;        /* numbers (3 per point3), strings or bools */
    double *numbers;     /* floats, integers, points, ...; NULL for strings and bools */
    double most_in_file; /* largest component of colours before their colour space was changed; 0: it was not */
    char **strings;      /* strings, texture names, spectrum names */
    unsigned char *bools;
    bool is_borrowed; /* numbers, strings and bools are another's, who outlives this one: not to be written to */
    bool looked_up;
    bool may_be_unused; /* it is an Attribute's, which need not fit every directive */
    bool *used;         /* set by parameter_list_warn_unused where it was looked up; borrowed; NULL: nobody asks */
} parameter;

/* The source of parameters: their text, for messages that quote it, and the space of their colours. */
typedef struct parameter_source {
    /* Writes a line of text with a mark below it ("\n    line\n    ^~~"), or nothing where it is no longer there. */
    void (*excerpt)(const void *user, file_location where, size_t width, char *out_text, size_t size);
    const void *user;
    const working_space *space; /* of colours that are asked for; NULL: Rec. 709 */
} parameter_source;

typedef struct parameter_list {
    parameter *items;
    size_t count;
    file_location where;            /* of the directive */
    char *directive;                /* "Shape", "Integrator", ... */
    char *name;                     /* "sphere", "photonmap", ... */
    const parameter_source *source; /* borrowed; NULL: errors show no text */
} parameter_list;

void parameter_list_reset(parameter_list *list); /* frees what it holds; leaves it zeroed */
/* Copies a parameter with all that it holds. Returns false, with *out_copy zeroed, when out of memory. */
bool parameter_copy(const parameter *p, parameter *out_copy);
/* Makes a parameter that borrows the values of another. Returns false, with *out_parameter zeroed, when out
 * of memory. */
bool parameter_borrow(const parameter *p, parameter *out_parameter);
/* Makes borrowed values the parameter's own, so that they can be written to. Errors: AG_ERROR_MEMORY. */
ag_status parameter_own(parameter *p);
void parameter_reset(parameter *p); /* frees what it holds; leaves it zeroed */

/* Returns the parameter of a name, whatever its type; NULL where there is none. It is not marked as used. */
const parameter *parameter_list_find(const parameter_list *list, const char *name);

/* Single values. Each returns AG_OK and writes the value where the parameter stands with a fitting type and count,
 * AG_OK and leaves *out alone where it is absent, AG_ERROR_SCENE (with a message that names the parameter) where it is
 * of another type or count. */
ag_status parameter_get_float(parameter_list *list, log_sink *log, const char *name, float *out_value);
ag_status parameter_get_int(parameter_list *list, log_sink *log, const char *name, int64_t *out_value);
ag_status parameter_get_bool(parameter_list *list, log_sink *log, const char *name, bool *out_value);
ag_status parameter_get_string(parameter_list *list, log_sink *log, const char *name, const char **out_value);
/* Gets the name of a texture; it is also left alone, and the parameter not marked as looked up, where that is of
 * another type. */
ag_status parameter_get_texture(parameter_list *list, log_sink *log, const char *name, const char **out_texture_name);
ag_status parameter_get_vec3(parameter_list *list, log_sink *log, const char *name, parameter_type type,
                             vec3 *out_value);
/* Returns whether a colour of that name is emitted ("L", "I", "Le"), refracts or absorbs ("eta", "k", "sigma_a", "mfp",
 * ...), or reflects or transmits: all others. */
spectrum_use parameter_spectrum_use(const char *name);
/* Gets a colour of an rgb, spectrum or blackbody parameter. Where the spectrum is one of pbrt's that is not supported,
 * a warning names it and *out is left alone. */
ag_status parameter_get_rgb(parameter_list *list, log_sink *log, const char *name, rgb *out_value);
/* Get arrays: *out_values stays the list's; *out_count counts numbers (3 per point3), 0 where absent. */
ag_status parameter_get_numbers(parameter_list *list, log_sink *log, const char *name, parameter_type type,
                                const double **out_values, size_t *out_count);

/* Warns, once for each directive, kind and name, of the parameters that nobody looked up. */
void parameter_list_warn_unused(const parameter_list *list, log_sink *log);

#endif
