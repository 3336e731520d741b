/* pbrt_parameters.c: parameter lists, "type name" [ values ], of a pbrt-v4 scene file.
 * Rests on the format's description, pbrt.org/fileformat-v4, "Parameter Lists".
 * Flow: pbrt_files -> [here] -> parameter_list. Threads: one per scene. */
#define _POSIX_C_SOURCE 200809L
#include "pbrt/pbrt_private.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The number and kind of the numbers that a value of a type has. */
typedef struct value_type {
    const char *name;
    parameter_type type;
    unsigned components; /* numbers of one value; 0: none */
    bool strings, bools;
    const char *new_name; /* what an old name is now called */
} value_type;

static const value_type VALUE_TYPES[] = {
    {"float", PARAMETER_FLOAT, 1, false, false, NULL},
    {"integer", PARAMETER_INTEGER, 1, false, false, NULL},
    {"string", PARAMETER_STRING, 0, true, false, NULL},
    {"bool", PARAMETER_BOOL, 0, false, true, NULL},
    {"point2", PARAMETER_POINT2, 2, false, false, NULL},
    {"vector2", PARAMETER_VECTOR2, 2, false, false, NULL},
    {"point3", PARAMETER_POINT3, 3, false, false, NULL},
    {"vector3", PARAMETER_VECTOR3, 3, false, false, NULL},
    {"normal", PARAMETER_NORMAL, 3, false, false, NULL},
    {"rgb", PARAMETER_RGB, 3, false, false, NULL},
    {"spectrum", PARAMETER_SPECTRUM, 2, true, false, NULL},
    {"blackbody", PARAMETER_BLACKBODY, 1, false, false, NULL},
    {"texture", PARAMETER_TEXTURE, 0, true, false, NULL},
    {"point", PARAMETER_POINT3, 3, false, false, "point3"},
    {"vector", PARAMETER_VECTOR3, 3, false, false, "vector3"},
    {"normal3", PARAMETER_NORMAL, 3, false, false, "normal"},
    {"color", PARAMETER_RGB, 3, false, false, "rgb"},
};

/* A parameter while its values are read. */
typedef struct builder {
    parameter *p;
    const value_type *type;
    char label[80]; /* "float radius", quoted, for messages */
    size_t capacity;
} builder;

static const value_type *find_type(const char *text, size_t length)
{
    for (size_t i = 0; i < sizeof VALUE_TYPES / sizeof *VALUE_TYPES; i++)
        if (strlen(VALUE_TYPES[i].name) == length && memcmp(VALUE_TYPES[i].name, text, length) == 0)
            return &VALUE_TYPES[i];
    return NULL;
}

/* Makes room for at least one more item; the kinds of values in one parameter never mix. */
static ag_status make_room(builder *b, size_t wanted, void **items, size_t item_bytes)
{
    if (*items && b->p->count + wanted <= b->capacity)
        return AG_OK;
    size_t capacity = 2 * b->capacity > b->p->count + wanted ? 2 * b->capacity : b->p->count + wanted;
    void *larger = realloc(*items, capacity * item_bytes);
    if (!larger)
        return AG_ERROR_MEMORY;
    *items = larger;
    b->capacity = capacity;
    return AG_OK;
}

static ag_status refuse_value(pbrt_parser *parser, const builder *b, const pbrt_token *token)
{
    const char *expected = b->type->bools        ? "true or false"
                           : !b->type->strings   ? "numbers"
                           : b->type->components ? (b->p->numbers ? "numbers" : "a name or numbers")
                                                 : "quoted strings";
    return pbrt_unexpected(parser, token, b->label, expected);
}

static ag_status add_value(pbrt_parser *parser, builder *b, const pbrt_token *token)
{
    parameter *p = b->p;
    double number;
    bool is_true = token->length == 4 && memcmp(token->text, "true", 4) == 0;
    bool is_false = token->length == 5 && memcmp(token->text, "false", 5) == 0;
    bool is_text = token->kind == PBRT_TOKEN_STRING || token->kind == PBRT_TOKEN_WORD;
    if (b->type->bools && is_text && (is_true || is_false)) {
        AG_TRY(make_room(b, 1, (void **)&p->bools, 1));
        p->bools[p->count++] = is_true;
        return AG_OK;
    }
    if (b->type->strings && !p->numbers && token->kind == PBRT_TOKEN_STRING) {
        AG_TRY(make_room(b, 1, (void **)&p->strings, sizeof *p->strings));
        p->strings[p->count] = strndup(token->text, token->length);
        if (!p->strings[p->count])
            return AG_ERROR_MEMORY;
        p->count++;
        return AG_OK;
    }
    if (b->type->components && !p->strings && pbrt_token_number(token, &number)) {
        if (!isfinite(number))
            return pbrt_error(parser, token->where, token->width, "the number is too large");
        AG_TRY(make_room(b, 1, (void **)&p->numbers, sizeof *p->numbers));
        p->numbers[p->count++] = number;
        return AG_OK;
    }
    return refuse_value(parser, b, token);
}

/* Reads numbers as long as there are any: the fast way through long arrays. */
static ag_status add_numbers(pbrt_parser *parser, builder *b)
{
    enum { BLOCK = 16384 };
    parameter *p = b->p;
    size_t count, wanted = 16;
    pbrt_file *file = &parser->files[parser->file_count - 1];
    if (p->strings || file->value.has_tokens)
        return AG_OK;
    do {
        AG_TRY(make_room(b, wanted, (void **)&p->numbers, sizeof *p->numbers));
        count = pbrt_lexer_numbers(&file->lexer, wanted, p->numbers + p->count);
        p->count += count;
        if (wanted == BLOCK)
            AG_TRY(pbrt_tell_progress(parser));
        if (count < wanted)
            break;
        wanted = 4 * wanted < BLOCK ? 4 * wanted : BLOCK;
    } while (true);
    if (p->count == 0) { /* strings may still come */
        free(p->numbers);
        p->numbers = NULL;
        b->capacity = 0;
    }
    return AG_OK;
}

static ag_status read_values(pbrt_parser *parser, builder *b)
{
    pbrt_token token;
    AG_TRY(pbrt_next(parser, &token));
    if (token.kind != PBRT_TOKEN_OPEN)
        return add_value(parser, b, &token);
    for (;;) {
        if (b->type->components)
            AG_TRY(add_numbers(parser, b));
        AG_TRY(pbrt_next(parser, &token));
        if (token.kind == PBRT_TOKEN_CLOSE)
            return AG_OK;
        AG_TRY(add_value(parser, b, &token));
    }
}

static ag_status check_values(pbrt_parser *parser, const builder *b, size_t width)
{
    const parameter *p = b->p;
    if (p->numbers && p->count % b->type->components != 0)
        return pbrt_error(parser, p->where, width, "%s has %zu numbers, which is no multiple of %u", b->label, p->count,
                          b->type->components);
    if (p->type == PARAMETER_INTEGER)
        for (size_t i = 0; i < p->count; i++) {
            double v = p->numbers[i];
            if (!(v >= -2147483648.0 && v <= 2147483647.0) || v != floor(v))
                return pbrt_error(parser, p->where, width, "%s: %g (value %zu) is not an integer of 32 bits", b->label,
                                  v, i + 1);
        }
    return AG_OK;
}

/* Reads "type name" from the quoted string that begins a parameter. */
static ag_status read_declaration(pbrt_parser *parser, const pbrt_token *token, builder *b)
{
    enum { SHOWN = 60 };
    const char *text = token->text, *end = text + token->length, *words[2];
    size_t lengths[2], count = 0;
    for (const char *p = text; p < end;) {
        const char *start = p;
        while (p < end && *p != ' ' && *p != '\t')
            p++;
        if (p > start) {
            if (count < 2) {
                words[count] = start;
                lengths[count] = (size_t)(p - start);
            }
            count++;
        } else {
            p++;
        }
    }
    int shown = token->length > SHOWN ? SHOWN : (int)token->length;
    if (count != 2)
        return pbrt_error(parser, token->where, token->width, "\"%.*s\" should be a parameter's \"type name\"", shown,
                          text);
    b->type = find_type(words[0], lengths[0]);
    if (!b->type)
        return pbrt_error(parser, token->where, token->width, "\"%.*s\": unknown parameter type", shown, text);
    b->p->type = b->type->type;
    b->p->name = strndup(words[1], lengths[1]);
    if (!b->p->name)
        return AG_ERROR_MEMORY;
    snprintf(b->label, sizeof b->label, "\"%s %.50s\"", b->type->name, b->p->name);
    if (b->type->new_name)
        log_at_once(parser->log, AG_LOG_WARNING, token->where, b->type->name,
                    "the parameter type \"%s\" is called \"%s\" in pbrt-v4 and is read as that", b->type->name,
                    b->type->new_name);
    return AG_OK;
}

/* Drops all but the last of parameters with one name, as pbrt does. */
static void drop_shadowed(pbrt_parser *parser, parameter_list *list)
{
    parameter *last = &list->items[list->count - 1];
    for (parameter *p = list->items; p < last; p++)
        if (strcmp(p->name, last->name) == 0) {
            log_at(parser->log, AG_LOG_WARNING, last->where,
                   "%s: \"%s\" is given twice, first at %d:%d: the last counts", list->directive, last->name,
                   p->where.line, p->where.column);
            parameter_reset(p);
            *p = *last;
            list->count--;
            return;
        }
}

static ag_status read_parameter(pbrt_parser *parser, parameter_list *list)
{
    pbrt_token token;
    AG_TRY(pbrt_next(parser, &token));
    if (list->count == PBRT_MAX_PARAMETERS)
        return pbrt_error(parser, token.where, token.width, "%s has more than %d parameters", list->directive,
                          PBRT_MAX_PARAMETERS);
    builder b = {.p = &list->items[list->count]};
    memset(b.p, 0, sizeof *b.p);
    b.p->where = token.where;
    list->count++; /* from here on the list owns it, whatever happens */
    AG_TRY(read_declaration(parser, &token, &b));
    AG_TRY(read_values(parser, &b));
    AG_TRY(check_values(parser, &b, token.width));
    AG_TRY(pbrt_settle_color(parser, b.p, token.width));
    drop_shadowed(parser, list);
    return AG_OK;
}

/* Takes the parameters of a call, which have their types already. */
static ag_status take_given(pbrt_parser *parser, parameter_list *list)
{
    pbrt_given *given = parser->given;
    list->items = calloc(given->item_count + 1, sizeof *list->items);
    if (!list->items)
        return AG_ERROR_MEMORY;
    for (size_t i = 0; i < given->item_count; i++) {
        parameter *p = &list->items[list->count++];
        *p = given->items[i];
        given->items[i] = (parameter){0};
        AG_TRY(pbrt_settle_color(parser, p, 1));
        drop_shadowed(parser, list);
    }
    return AG_OK;
}

static ag_status read_all(pbrt_parser *parser, parameter_list *list)
{
    if (parser->given)
        return take_given(parser, list);
    size_t capacity = 0;
    for (;;) {
        pbrt_token token;
        AG_TRY(pbrt_peek(parser, &token));
        if (token.kind != PBRT_TOKEN_STRING)
            return AG_OK;
        if (list->count == capacity) {
            capacity = capacity ? 2 * capacity : 8;
            parameter *larger = realloc(list->items, capacity * sizeof *larger);
            if (!larger)
                return AG_ERROR_MEMORY;
            list->items = larger;
        }
        AG_TRY(read_parameter(parser, list));
    }
}

static ag_status read_list(pbrt_parser *parser, const char *directive, const char *expected, file_location where,
                           parameter_list *out_list)
{
    memset(out_list, 0, sizeof *out_list);
    out_list->where = where;
    out_list->source = &parser->source;
    out_list->directive = strdup(directive);
    ag_status status = out_list->directive ? AG_OK : AG_ERROR_MEMORY;
    if (status == AG_OK && expected)
        status = pbrt_read_string(parser, directive, expected, &out_list->name, NULL);
    if (status == AG_OK)
        status = read_all(parser, out_list);
    if (status == AG_OK)
        status = pbrt_append_attributes(parser, out_list);
    if (status == AG_OK)
        status = pbrt_upgrade_parameters(parser, out_list);
    if (status != AG_OK)
        parameter_list_reset(out_list);
    return status;
}

ag_status pbrt_read_parameters(pbrt_parser *parser, const char *directive, file_location where,
                               parameter_list *out_list)
{
    return read_list(parser, directive, NULL, where, out_list);
}

ag_status pbrt_read_named_parameters(pbrt_parser *parser, const char *directive, const char *expected,
                                     file_location where, parameter_list *out_list)
{
    return read_list(parser, directive, expected, where, out_list);
}

ag_status pbrt_refuse(pbrt_parser *parser, const parameter_list *list, const char *name, const char *format, ...)
{
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    const parameter *p = parameter_list_find(list, name);
    if (!p)
        return pbrt_error(parser, list->where, strlen(list->directive), "%s", message);
    return pbrt_error(parser, p->where, strlen(parameter_type_name(p->type)) + strlen(p->name) + 3, "%s", message);
}
