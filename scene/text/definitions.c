/* definitions.c: see definitions.h. */
#include "text/definitions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* $NAME or ${NAME:-OTHERWISE} in a text, which stands for a value. */
typedef struct placeholder {
    const char *name, *otherwise; /* NULL: there is none */
    size_t name_length, otherwise_length, length;
} placeholder;

typedef struct buffer {
    char *text;
    size_t length, capacity;
} buffer;

static bool is_name_byte(char c, bool is_first)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (!is_first && c >= '0' && c <= '9');
}

static size_t name_length(const char *text, const char *end)
{
    const char *p = text;
    while (p < end && is_name_byte(*p, p == text))
        p++;
    return (size_t)(p - text);
}

bool definition_name_is_valid(const char *name)
{
    size_t length = strlen(name);
    return length > 0 && name_length(name, name + length) == length;
}

/* Whether one begins at text, which is a $. */
static bool find_placeholder(const char *text, const char *end, placeholder *out)
{
    *out = (placeholder){.name = text + 1};
    bool has_brace = text + 1 < end && text[1] == '{';
    out->name += has_brace;
    out->name_length = name_length(out->name, end);
    if (out->name_length == 0)
        return false;
    const char *p = out->name + out->name_length;
    if (has_brace && end - p >= 2 && p[0] == ':' && p[1] == '-') {
        const char *brace = memchr(p, '}', (size_t)(end - p));
        if (!brace)
            return false;
        out->otherwise = p + 2;
        out->otherwise_length = (size_t)(brace - out->otherwise);
        p = brace;
    }
    if (has_brace && (p == end || *p != '}'))
        return false;
    out->length = (size_t)(p - text) + has_brace;
    return true;
}

static definition *find(const definitions *d, const placeholder *wanted)
{
    for (size_t i = 0; d && i < d->count; i++)
        if (strlen(d->items[i].name) == wanted->name_length &&
            memcmp(d->items[i].name, wanted->name, wanted->name_length) == 0)
            return &d->items[i];
    return NULL;
}

static bool append(buffer *b, const char *text, size_t length)
{
    if (b->length + length + 1 > b->capacity) {
        size_t capacity = 2 * (b->length + length) + 32;
        char *larger = realloc(b->text, capacity);
        if (!larger)
            return false;
        b->text = larger;
        b->capacity = capacity;
    }
    if (length > 0)
        memcpy(b->text + b->length, text, length);
    b->length += length;
    b->text[b->length] = '\0';
    return true;
}

static bool expects_all(const definitions *d, bool is_quoted)
{
    bool is_strict = !is_quoted;
    for (size_t i = 0; d && i < d->count; i++)
        is_strict = is_strict || !d->items[i].is_optional;
    return is_strict;
}

ag_status definitions_expand(const definitions *d, const char *text, size_t length, bool is_quoted, char *message,
                             size_t message_size, char **out_text, size_t *out_length)
{
    enum { SHOWN = 60 };
    buffer b = {0};
    const char *end = text + length, *copied = text;
    bool is_whole = true;
    for (const char *p = memchr(text, '$', length); p && is_whole;
         p = p < end ? memchr(p, '$', (size_t)(end - p)) : NULL) {
        placeholder at;
        if (!find_placeholder(p, end, &at)) {
            p++;
            continue;
        }
        definition *known = find(d, &at);
        if (!known && !at.otherwise && expects_all(d, is_quoted)) {
            int shown = at.name_length > SHOWN ? SHOWN : (int)at.name_length;
            snprintf(message, message_size, "$%.*s has no value here: -D %.*s=VALUE would give it one", shown, at.name,
                     shown, at.name);
            free(b.text);
            return AG_ERROR_SCENE;
        }
        if (known || at.otherwise) {
            is_whole =
                append(&b, copied, (size_t)(p - copied)) &&
                append(&b, known ? known->value : at.otherwise, known ? strlen(known->value) : at.otherwise_length);
            copied = p + at.length;
        }
        if (known)
            known->is_used = true;
        p += at.length;
    }
    if (b.text && is_whole)
        is_whole = append(&b, copied, (size_t)(end - copied));
    if (!is_whole) {
        free(b.text);
        return AG_ERROR_MEMORY;
    }
    *out_text = b.text;
    *out_length = b.length;
    return AG_OK;
}

const definition *definitions_unused(const definitions *d)
{
    for (size_t i = 0; d && i < d->count; i++)
        if (!d->items[i].is_used && !d->items[i].is_optional)
            return &d->items[i];
    return NULL;
}

char *definitions_describe(const definitions *d)
{
    buffer b = {0};
    bool is_whole = append(&b, "", 0);
    for (size_t i = 0; d && i < d->count && is_whole; i++) {
        const definition *one = &d->items[i];
        if (one->is_used)
            is_whole = append(&b, ", ", b.length > 0 ? 2 : 0) && append(&b, one->name, strlen(one->name)) &&
                       append(&b, "=", 1) && append(&b, one->value, strlen(one->value));
    }
    if (!is_whole)
        free(b.text);
    return is_whole ? b.text : NULL;
}
