/* definitions.h: values that a scene's text leaves open: $name, ${name}, ${name:-otherwise}, filled in as it is read.
 * Rests on Mitsuba's -D NAME=VALUE and $NAME (mitsuba.cpp, xml.cpp), and on the shell's way to say "otherwise".
 * Flow: command line -> [here] -> pbrt_files. Threads: one per scene. */
#ifndef AFTERGLOW_DEFINITIONS_H
#define AFTERGLOW_DEFINITIONS_H

#include "afterglow/base.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct definition {
    const char *name, *value; /* borrowed */
    bool is_optional;         /* that no scene uses it is no mistake */
    bool is_used;             /* set by definitions_expand */
} definition;

typedef struct definitions {
    definition *items; /* borrowed; names are valid and differ */
    size_t count;
} definitions;

/* Letters, digits and _, no digit first. */
bool definition_name_is_valid(const char *name);

/* The text with values for names; NULL where it has none; else to be freed, with a NUL behind it. Values are not looked
 * through again. A name without a value is an error, but left as it stands in quotes where nothing is defined, or only
 * what is optional: it may be part of a file's name. definitions: NULL: none. Errors: AG_ERROR_SCENE (message says
 * which name), AG_ERROR_MEMORY. */
ag_status definitions_expand(const definitions *d, const char *text, size_t length, bool is_quoted, char *message,
                             size_t message_size, char **out_text, size_t *out_length);

/* The first that is neither used nor optional; NULL: there is none. */
const definition *definitions_unused(const definitions *d);

/* "name=value, name=value" of those used, for metadata; "" where there are none. To be freed; NULL when out of
 * memory. */
char *definitions_describe(const definitions *d);

#endif
