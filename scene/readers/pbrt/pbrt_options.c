/* pbrt_options.c: Option of a pbrt-v4 scene.
 * Rests on pbrt-v4's list of options (scene.cpp); names are the same in any case, with and without '-' and '_'.
 * Flow: pbrt_parser -> [here] -> scene.hints. Threads: one per scene. */
#include "pbrt/pbrt_private.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum option_value { VALUE_BOOL, VALUE_NUMBER, VALUE_TEXT } option_value;

/* Why an option is not heeded, for a warning; "" where it makes no difference to the picture. */
static const struct {
    const char *name;
    option_value value;
    const char *ignored; /* NULL: heeded, by set_option */
} OPTIONS[] = {
    {"seed", VALUE_NUMBER, NULL},
    {"disablepixeljitter", VALUE_BOOL, NULL},
    {"disabletexturefiltering", VALUE_BOOL, ""}, /* no texture is filtered beyond its pixels' size */
    {"disablewavelengthjitter", VALUE_BOOL, ""}, /* light is RGB */
    {"wavefront", VALUE_BOOL, ""},
    {"rendercoordsys", VALUE_TEXT, ""},
    {"quiet", VALUE_BOOL, ""},
    {"forcediffuse", VALUE_BOOL, "materials stay as they are"},
    {"pixelstats", VALUE_BOOL, "no pictures of statistics are written"},
    {"displacementedgescale", VALUE_NUMBER, "no mesh is displaced by its edges' length"},
    {"msereferenceimage", VALUE_TEXT, "no error against a reference is written"},
    {"msereferenceout", VALUE_TEXT, "no error against a reference is written"},
};

static void normalize(const char *name, char *out_name, size_t size)
{
    size_t length = 0;
    for (; *name && length + 1 < size; name++)
        if (*name != '-' && *name != '_')
            out_name[length++] = *name >= 'A' && *name <= 'Z' ? (char)(*name - 'A' + 'a') : *name;
    out_name[length] = '\0';
}

static bool is_word(const pbrt_token *token, const char *word)
{
    return token->length == strlen(word) && memcmp(token->text, word, token->length) == 0;
}

static ag_status set_option(pbrt_parser *parser, size_t option, file_location where, const pbrt_token *value)
{
    const char *name = OPTIONS[option].name, *why = OPTIONS[option].ignored;
    double number = 0.0;
    bool is_number = pbrt_token_number(value, &number) && isfinite(number);
    bool is_true = is_word(value, "true");
    char key[64];
    if (OPTIONS[option].value == VALUE_BOOL && !is_true && !is_word(value, "false"))
        return pbrt_unexpected(parser, value, "Option", "true or false");
    if (OPTIONS[option].value == VALUE_NUMBER && !is_number)
        return pbrt_unexpected(parser, value, "Option", "a number");
    if (why) {
        snprintf(key, sizeof key, "option:%s", name);
        if (why[0] && (OPTIONS[option].value != VALUE_BOOL || is_true))
            log_at_once(parser->log, AG_LOG_WARNING, where, key, "Option \"%s\" is not supported: %s", name, why);
        return AG_OK;
    }
    scene_hints *hints = &parser->scene->hints;
    if (strcmp(name, "disablepixeljitter") == 0) {
        hints->disable_pixel_jitter = is_true;
        return AG_OK;
    }
    if (number != floor(number) || fabs(number) > 2147483648.0)
        return pbrt_error(parser, value->where, value->width, "the seed should be an integer of 32 bits");
    hints->seed = (integer_hint){true, (int64_t)number};
    return AG_OK;
}

ag_status pbrt_option(pbrt_parser *parser, file_location where)
{
    char *name, normal[64];
    file_location name_where;
    pbrt_token value;
    AG_TRY(pbrt_read_string(parser, "Option", "a quoted name", &name, &name_where));
    size_t width = strlen(name) + 2, option = 0, count = sizeof OPTIONS / sizeof *OPTIONS;
    normalize(name, normal, sizeof normal);
    free(name);
    while (option < count && strcmp(normal, OPTIONS[option].name) != 0)
        option++;
    if (option == count)
        return pbrt_error(parser, name_where, width, "unknown option \"%s\"", normal);
    AG_TRY(pbrt_next(parser, &value));
    if (value.kind != PBRT_TOKEN_WORD && value.kind != PBRT_TOKEN_STRING)
        return pbrt_unexpected(parser, &value, "Option", "a value");
    return set_option(parser, option, where, &value);
}
