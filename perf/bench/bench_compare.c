/* bench_compare.c: see bench_compare.h. */
#include "bench/bench_compare.h"

#include <jansson.h>
#include <stdbool.h>
#include <string.h>

static const char *text_at(const json_t *object, const char *name)
{
    const char *text = json_string_value(json_object_get(object, name));
    return text ? text : "?";
}

static double rate_of(const json_t *part, const char *which)
{
    return json_number_value(json_object_get(json_object_get(part, "rate"), which));
}

/* NULL: message says why. */
static json_t *load(const char *path, char *message, size_t message_size)
{
    json_error_t error;
    json_t *root = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    if (!root) {
        snprintf(message, message_size, "%s:%d:%d: error: %s", path, error.line, error.column, error.text);
        return NULL;
    }
    if (strcmp(text_at(root, "program"), "afterglow-bench") == 0 && json_is_array(json_object_get(root, "parts")))
        return root;
    snprintf(message, message_size, "%s: error: no result of afterglow-bench", path);
    json_decref(root);
    return NULL;
}

static bool is_alike(const json_t *a, const json_t *b)
{
    return strcmp(text_at(a, "scene"), text_at(b, "scene")) == 0 &&
           strcmp(text_at(a, "phase"), text_at(b, "phase")) == 0 &&
           json_integer_value(json_object_get(a, "threads")) == json_integer_value(json_object_get(b, "threads"));
}

static const json_t *find_alike(const json_t *parts, const json_t *part)
{
    size_t i;
    json_t *other;
    json_array_foreach(parts, i, other)
    {
        if (is_alike(part, other))
            return other;
    }
    return NULL;
}

static void print_head(FILE *out, char name, const json_t *result)
{
    const json_t *c = json_object_get(result, "certificate"), *best = json_object_get(result, "score_best");
    fprintf(out, "%c: %s, size %s, certificate %s %.8s", name, text_at(json_object_get(result, "machine"), "cpu"),
            text_at(result, "size"), json_is_true(json_object_get(c, "valid")) ? "valid" : "NOT VALID",
            text_at(c, "hash"));
    if (json_is_object(best))
        fprintf(out, ", score %.0f, on %d threads %.0f",
                json_number_value(
                    json_object_get(json_object_get(json_object_get(result, "score_one"), "whole"), "median")),
                (int)json_integer_value(json_object_get(best, "threads")),
                json_number_value(json_object_get(json_object_get(best, "whole"), "median")));
    else
        fputs(", no score", out);
    fputc('\n', out);
}

static void print_table(FILE *out, const json_t *a, const json_t *b)
{
    size_t i;
    json_t *part;
    fprintf(out, "%-10s %-10s %7s %12s %12s %7s\n", "scene", "phase", "threads", "A, 1/s", "B, 1/s", "B / A");
    json_array_foreach(json_object_get(a, "parts"), i, part)
    {
        const json_t *other = find_alike(json_object_get(b, "parts"), part);
        if (!other)
            continue;
        double of_a = rate_of(part, "median"), of_b = rate_of(other, "median");
        bool is_parted =
            rate_of(part, "least") > rate_of(other, "most") || rate_of(part, "most") < rate_of(other, "least");
        fprintf(out, "%-10s %-10s %7d %12.4g %12.4g %7.3f%s\n", text_at(part, "scene"), text_at(part, "phase"),
                (int)json_integer_value(json_object_get(part, "threads")), of_a, of_b, of_a > 0.0 ? of_b / of_a : 0.0,
                is_parted ? "" : "  within the turns' spread");
    }
}

ag_status bench_compare(const char *path_a, const char *path_b, FILE *out, char *message, size_t message_size)
{
    json_t *a = load(path_a, message, message_size), *b = a ? load(path_b, message, message_size) : NULL;
    ag_status status = a && b ? AG_OK : AG_ERROR_INPUT;
    if (status == AG_OK &&
        (strcmp(text_at(a, "size"), text_at(b, "size")) != 0 ||
         json_integer_value(json_object_get(a, "format")) != json_integer_value(json_object_get(b, "format")))) {
        snprintf(message, message_size,
                 "%s and %s are of different work: sizes %s and %s, formats %d and %d: there is nothing to compare",
                 path_a, path_b, text_at(a, "size"), text_at(b, "size"),
                 (int)json_integer_value(json_object_get(a, "format")),
                 (int)json_integer_value(json_object_get(b, "format")));
        status = AG_ERROR_INPUT;
    }
    if (status == AG_OK) {
        print_head(out, 'A', a);
        print_head(out, 'B', b);
        bool same = strcmp(text_at(json_object_get(a, "certificate"), "hash"),
                           text_at(json_object_get(b, "certificate"), "hash")) == 0;
        fprintf(out, "%s\n", same ? "Both made the same bits." : "They made different bits: builds or makers differ.");
        print_table(out, a, b);
    }
    json_decref(a);
    json_decref(b);
    return status;
}
