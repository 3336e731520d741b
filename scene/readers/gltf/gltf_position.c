/* gltf_position.c: where a value of the document stands in the file's text, for messages: jansson keeps no positions,
 * so the text is walked along the value's path. Rests on: RFC 8259 (JSON). Flow: gltf_json -> [here]. Threads: pure
 * functions. */
#include "gltf/gltf_private.h"

#include <limits.h>
#include <string.h>

/* The text is known to be JSON, and ends with a NUL. */

static const char *skip_blanks(const char *c) { return c + strspn(c, " \t\r\n"); }

/* Returns what stands behind a string; c: at the quote that it begins with. */
static const char *skip_string(const char *c)
{
    for (c++; *c && *c != '"'; c++)
        c += *c == '\\' && c[1];
    return *c ? c + 1 : c;
}

static const char *skip_value(const char *c)
{
    size_t depth = 0;
    for (; *c; c++) {
        if (*c == '"') {
            c = skip_string(c);
            if (depth == 0 || !*c)
                return c;
            c--;
        } else if (*c == '{' || *c == '[') {
            depth++;
        } else if (*c == '}' || *c == ']') {
            if (depth == 0)
                return c; /* of what is around a number or a word */
            if (--depth == 0)
                return c + 1;
        } else if (depth == 0 && strchr(", \t\r\n", *c)) {
            return c;
        }
    }
    return c;
}

/* Returns the next item of an array or object, behind one that ends at c; NULL: there is none. */
static const char *next_item(const char *c)
{
    c = skip_blanks(c);
    return *c == ',' ? skip_blanks(c + 1) : NULL;
}

static const char *first_item(const char *c)
{
    c = skip_blanks(c + 1);
    return *c && *c != '}' && *c != ']' ? c : NULL;
}

/* Finds a member by its name. The last one of that name counts, as it does to jansson. Keys with escapes are
 * not found. */
static const char *find_member(const char *object, const char *key)
{
    const size_t length = strlen(key);
    const char *found = NULL;
    for (const char *c = first_item(object); c && *c == '"';) {
        const char *name = c + 1, *behind = skip_string(c);
        const bool is_it = (size_t)(behind - name) == length + 1 && memcmp(name, key, length) == 0;
        c = skip_blanks(behind);
        if (*c != ':')
            break;
        c = skip_blanks(c + 1);
        if (is_it)
            found = c;
        c = next_item(skip_value(c));
    }
    return found;
}

static const char *find_element(const char *array, size_t index)
{
    const char *c = first_item(array);
    for (; c && index > 0; index--)
        c = next_item(skip_value(c));
    return c;
}

/* Finds where the value stands, or where that stands from which it is missing. */
static const char *find_value(const char *text, const gltf_value *v)
{
    if (!v->parent)
        return skip_blanks(text);
    const char *around = find_value(text, v->parent), *found = NULL;
    if (v->parent->json && v->key && *around == '{')
        found = find_member(around, v->key);
    else if (v->parent->json && !v->key && *around == '[')
        found = find_element(around, v->index);
    return found ? found : around;
}

file_location gltf_position(const gltf_reader *r, const gltf_value *v)
{
    file_location where = {r->where.file, 1, 1};
    if (!r->is_text)
        return r->where;
    const char *begin = r->text + (strncmp(r->text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0);
    const char *end = find_value(begin, v);
    for (const char *c = begin; c < end; c++) {
        if (*c == '\n') {
            where.line += where.line < INT_MAX;
            where.column = 1;
        } else { /* one for each character of UTF-8; texts may be longer than an int tells */
            where.column += ((unsigned char)*c & 0xc0) != 0x80 && where.column < INT_MAX;
        }
    }
    return where;
}
