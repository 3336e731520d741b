/* gltf_json.c: values of a glTF document by key and index, each of the type and in the range that the format wants, or
 * an error that names its path. Rests on: Khronos, "glTF 2.0 Specification", 2021, 5 (properties reference).
 * Flow: gltf_document -> [here] -> all other gltf_*.c. Threads: one per scene. */
#include "gltf/gltf_private.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const double LARGEST_EXACT = 9007199254740992.0; /* 2^53: JSON's integers are doubles */

static const char *const LIST_NAMES[GLTF_LIST_COUNT] = {"accessors", "buffers",  "bufferViews", "cameras",  "images",
                                                        "materials", "meshes",   "nodes",       "samplers", "scenes",
                                                        "skins",     "textures", "lights"};

/* Paths and messages */

static void append(char *text, size_t size, const char *format, ...)
{
    size_t length = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + length, size - length, format, arguments);
    va_end(arguments);
}

static void append_path(const gltf_value *v, char *path, size_t size)
{
    if (!v->parent)
        return;
    append_path(v->parent, path, size);
    if (v->key)
        append(path, size, "%s%s", path[0] ? "." : "", v->key);
    else
        append(path, size, "[%zu]", v->index);
}

static void path_of(const gltf_value *v, char *path, size_t size)
{
    path[0] = '\0';
    append_path(v, path, size);
    if (!path[0])
        snprintf(path, size, "the document");
}

ag_status gltf_error(const gltf_reader *r, const gltf_value *at, const char *format, ...)
{
    char path[256], message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    path_of(at, path, sizeof path);
    log_at(r->run->log, AG_LOG_ERROR, gltf_position(r, at), "%s: %s", path, message);
    return AG_ERROR_SCENE;
}

void gltf_warn_once(const gltf_reader *r, const gltf_value *at, const char *key, const char *format, ...)
{
    char path[256], message[1024], own_key[128];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    path_of(at, path, sizeof path);
    snprintf(own_key, sizeof own_key, "gltf:%s", key);
    log_at_once(r->run->log, AG_LOG_WARNING, r->where, own_key, "%s: %s", path, message);
}

static const char *type_name(const json_t *json)
{
    switch (json_typeof(json)) {
    case JSON_OBJECT: return "an object";
    case JSON_ARRAY: return "an array";
    case JSON_STRING: return "a string";
    case JSON_INTEGER: return "an integer";
    case JSON_REAL: return "a number";
    case JSON_NULL: return "null";
    default: return "true or false";
    }
}

static ag_status wrong_type(const gltf_reader *r, const gltf_value *at, const char *expected)
{
    return gltf_error(r, at, "should be %s, not %s", expected, type_name(at->json));
}

/* Steps */

gltf_value gltf_member(const gltf_value *object, const char *key)
{
    return (gltf_value){object->json ? json_object_get(object->json, key) : NULL, object, key, 0};
}

gltf_value gltf_element(const gltf_value *array, size_t index)
{
    return (gltf_value){array->json ? json_array_get(array->json, index) : NULL, array, NULL, index};
}

ag_status gltf_require(const gltf_reader *r, const gltf_value *parent, const char *key)
{
    gltf_value v = gltf_member(parent, key);
    return v.json ? AG_OK : gltf_error(r, &v, "is missing");
}

ag_status gltf_get_object(const gltf_reader *r, const gltf_value *parent, const char *key, gltf_value *out_value)
{
    *out_value = gltf_member(parent, key);
    return out_value->json && !json_is_object(out_value->json) ? wrong_type(r, out_value, "an object") : AG_OK;
}

ag_status gltf_get_array(const gltf_reader *r, const gltf_value *parent, const char *key, gltf_value *out_value)
{
    *out_value = gltf_member(parent, key);
    return out_value->json && !json_is_array(out_value->json) ? wrong_type(r, out_value, "an array") : AG_OK;
}

ag_status gltf_get_extension(const gltf_reader *r, const gltf_value *parent, const char *name,
                             gltf_value *extensions_frame, gltf_value *out_value)
{
    AG_TRY(gltf_get_object(r, parent, "extensions", extensions_frame));
    return gltf_get_object(r, extensions_frame, name, out_value);
}

ag_status gltf_get_element(const gltf_reader *r, const gltf_value *array, size_t index, gltf_value *out_value)
{
    *out_value = gltf_element(array, index);
    return json_is_object(out_value->json) ? AG_OK : wrong_type(r, out_value, "an object");
}

ag_status gltf_get_item(const gltf_reader *r, gltf_list list, uint32_t index, gltf_value *out_value)
{
    return gltf_get_element(r, &r->lists[list], index, out_value);
}

/* Values */

ag_status gltf_get_bool(const gltf_reader *r, const gltf_value *parent, const char *key, bool *value)
{
    gltf_value v = gltf_member(parent, key);
    if (!v.json)
        return AG_OK;
    if (!json_is_boolean(v.json))
        return wrong_type(r, &v, "true or false");
    *value = json_is_true(v.json);
    return AG_OK;
}

ag_status gltf_get_text(const gltf_reader *r, const gltf_value *parent, const char *key, const char **value)
{
    gltf_value v = gltf_member(parent, key);
    if (!v.json)
        return AG_OK;
    if (!json_is_string(v.json))
        return wrong_type(r, &v, "a string");
    *value = json_string_value(v.json);
    return AG_OK;
}

/* 5.0 is an integer too. */
static ag_status read_uint(const gltf_reader *r, const gltf_value *v, uint64_t *out_value)
{
    if (!json_is_number(v->json))
        return wrong_type(r, v, "an integer");
    double number = json_number_value(v->json);
    if (!(number >= 0.0 && number <= LARGEST_EXACT && number == floor(number)))
        return gltf_error(r, v, "%.17g should be an integer from 0 to 2^53", number);
    *out_value = (uint64_t)number;
    return AG_OK;
}

ag_status gltf_get_uint(const gltf_reader *r, const gltf_value *parent, const char *key, uint64_t *value)
{
    gltf_value v = gltf_member(parent, key);
    return v.json ? read_uint(r, &v, value) : AG_OK;
}

ag_status gltf_get_double(const gltf_reader *r, const gltf_value *parent, const char *key, double *value)
{
    gltf_value v = gltf_member(parent, key);
    if (!v.json)
        return AG_OK;
    if (!json_is_number(v.json))
        return wrong_type(r, &v, "a number");
    *value = json_number_value(v.json); /* the parser refuses what is not finite */
    return AG_OK;
}

ag_status gltf_get_doubles(const gltf_reader *r, const gltf_value *parent, const char *key, size_t count,
                           double *values)
{
    gltf_value array;
    AG_TRY(gltf_get_array(r, parent, key, &array));
    if (!array.json)
        return AG_OK;
    if (json_array_size(array.json) != count)
        return gltf_error(r, &array, "should have %zu numbers, but has %zu", count, json_array_size(array.json));
    for (size_t i = 0; i < count; i++) {
        gltf_value v = gltf_element(&array, i);
        if (!json_is_number(v.json))
            return wrong_type(r, &v, "a number");
        values[i] = json_number_value(v.json);
    }
    return AG_OK;
}

static float clamp_with_warning(const gltf_reader *r, const gltf_value *at, double value, double low, double high)
{
    double inside = double_clamp(value, low, high);
    if (inside != value && at->key)
        gltf_warn_once(r, at, at->key, "%g is beyond [%g, %g], and brought there", value, low, high);
    return (float)inside;
}

ag_status gltf_get_clamped(const gltf_reader *r, const gltf_value *parent, const char *key, double low, double high,
                           float *value)
{
    double number = (double)*value;
    gltf_value v = gltf_member(parent, key);
    AG_TRY(gltf_get_double(r, parent, key, &number));
    *value = clamp_with_warning(r, &v, number, low, high);
    return AG_OK;
}

ag_status gltf_get_factors(const gltf_reader *r, const gltf_value *parent, const char *key, double low, double high,
                           size_t count, float *values)
{
    double numbers[GLTF_MAX_FACTORS];
    gltf_value v = gltf_member(parent, key);
    for (size_t i = 0; i < count; i++)
        numbers[i] = (double)values[i];
    AG_TRY(gltf_get_doubles(r, parent, key, count, numbers));
    for (size_t i = 0; i < count; i++)
        values[i] = clamp_with_warning(r, &v, numbers[i], low, high);
    return AG_OK;
}

ag_status gltf_get_color(const gltf_reader *r, const gltf_value *parent, const char *key, double low, double high,
                         rgb *value)
{
    float numbers[3] = {value->r, value->g, value->b};
    AG_TRY(gltf_get_factors(r, parent, key, low, high, 3, numbers));
    *value = rgb_make(numbers[0], numbers[1], numbers[2]);
    return AG_OK;
}

ag_status gltf_read_index(const gltf_reader *r, const gltf_value *at, gltf_list list, uint32_t *out_index)
{
    uint64_t number = 0;
    AG_TRY(read_uint(r, at, &number));
    if (number >= r->list_counts[list])
        return gltf_error(r, at, "%llu is out of range: there are %u %s", (unsigned long long)number,
                          r->list_counts[list], LIST_NAMES[list]);
    *out_index = (uint32_t)number;
    return AG_OK;
}

ag_status gltf_get_index(const gltf_reader *r, const gltf_value *parent, const char *key, gltf_list list,
                         uint32_t *value)
{
    gltf_value v = gltf_member(parent, key);
    return v.json ? gltf_read_index(r, &v, list, value) : AG_OK;
}
