/* settings_table.c: see settings_table.h. */
#include "settings_table.h"

#include "film/layer_table.h"
#include "text/decimal.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double WHOLE_WINDOW[4] = {0.0, 1.0, 0.0, 1.0};
static const int USUAL_SIZE[2] = {1280, 720};

static const void *value_of(const setting_row *row, const ag_render_settings *settings)
{
    return (const unsigned char *)settings + row->offset;
}

/* A setting that is one number, as a double. Seeds above 2^53 are rounded. */
static double number_of(const setting_row *row, const ag_render_settings *settings)
{
    const void *value = value_of(row, settings);
    switch (row->kind) {
    case SETTING_WORD: return *(const unsigned *)value;
    case SETTING_INTEGER: return *(const int *)value;
    case SETTING_COUNT:
    case SETTING_SEED: return (double)*(const uint64_t *)value;
    case SETTING_NUMBER: return (double)*(const float *)value;
    case SETTING_FLAG: return *(const bool *)value ? 1.0 : 0.0;
    case SETTING_LAYERS: return *(const uint32_t *)value;
    case SETTING_SIZE:
    case SETTING_WINDOW:
    case SETTING_FILE: break;
    }
    return 0.0;
}

static void set_number(const setting_row *row, double number, ag_render_settings *settings)
{
    void *value = (unsigned char *)settings + row->offset;
    switch (row->kind) {
    case SETTING_WORD: *(unsigned *)value = (unsigned)number; break;
    case SETTING_INTEGER: *(int *)value = (int)number; break;
    case SETTING_COUNT:
    case SETTING_SEED: *(uint64_t *)value = (uint64_t)number; break;
    case SETTING_NUMBER: *(float *)value = (float)number; break;
    case SETTING_FLAG: *(bool *)value = number != 0.0; break;
    case SETTING_LAYERS: *(uint32_t *)value = (uint32_t)number; break;
    case SETTING_SIZE: memcpy(value, USUAL_SIZE, sizeof USUAL_SIZE); break;
    case SETTING_WINDOW: memcpy(value, WHOLE_WINDOW, sizeof WHOLE_WINDOW); break;
    case SETTING_FILE: *(const char **)value = NULL; break;
    }
}

ag_render_settings settings_table_defaults(void)
{
    ag_render_settings settings;
    memset(&settings, 0, sizeof settings);
    settings.struct_size = sizeof settings;
    for (size_t i = 0; setting_at(i); i++)
        set_number(setting_at(i), setting_at(i)->initial, &settings);
    return settings;
}

/* --- ranges --- */

static bool is_in_range(const setting_row *row, double number)
{
    return (row->is_above_least ? number > row->least : number >= row->least) && number <= row->most;
}

static int word_count(const setting_row *row)
{
    int count = 0;
    while (row->words[count])
        count++;
    return count;
}

static bool is_valid(const setting_row *row, const ag_render_settings *settings)
{
    double number = number_of(row, settings);
    const void *value = value_of(row, settings);
    switch (row->kind) {
    case SETTING_WORD: return number < word_count(row);
    case SETTING_COUNT: /* a double would take the automatic value's neighbours for it */
        return *(const uint64_t *)value <= (uint64_t)row->most
                   ? is_in_range(row, number)
                   : row->has_automatic && *(const uint64_t *)value == (uint64_t)row->automatic;
    case SETTING_INTEGER:
    case SETTING_NUMBER: return is_in_range(row, number) || (row->has_automatic && number == row->automatic);
    case SETTING_LAYERS: return (*(const uint32_t *)value & ~layers_known()) == 0;
    case SETTING_SIZE: return is_in_range(row, ((const int *)value)[0]) && is_in_range(row, ((const int *)value)[1]);
    case SETTING_WINDOW: {
        const double *window = value;
        return window[0] >= row->least && window[0] < window[1] && window[1] <= row->most && window[2] >= row->least &&
               window[2] < window[3] && window[3] <= row->most;
    }
    case SETTING_SEED:
    case SETTING_FLAG:
    case SETTING_FILE: break;
    }
    return true;
}

static void describe_range(const setting_row *row, char *out, size_t size)
{
    const char *floor = row->is_above_least ? "above" : "at least";
    char automatic[40] = "";
    if (row->has_automatic && row->kind == SETTING_NUMBER) /* another kind's is a constant that has a name */
        snprintf(automatic, sizeof automatic, ", or %.10g", row->automatic);
    if (row->kind == SETTING_WORD) {
        size_t used = (size_t)snprintf(out, size, "one of");
        for (int i = 0; row->words[i] && used < size; i++)
            used += (size_t)snprintf(out + used, size - used, "%s %s", i > 0 ? "," : "", row->words[i]);
    } else if (row->kind == SETTING_LAYERS) {
        snprintf(out, size, "of the layers that there are");
    } else if (row->kind == SETTING_SIZE) {
        snprintf(out, size, "from %.10g to %.10g pixels along each edge", row->least, row->most);
    } else if (row->kind == SETTING_WINDOW) {
        snprintf(out, size, "X0 < X1 and Y0 < Y1, each from %.10g to %.10g", row->least, row->most);
    } else if (isinf(row->most)) {
        snprintf(out, size, "%s %.10g%s", floor, row->least, automatic);
    } else if (row->most == (double)FLT_MAX) {
        snprintf(out, size, "finite, and %s %.10g%s", floor, row->least, automatic);
    } else if (row->is_above_least) {
        snprintf(out, size, "above %.10g, and at most %.10g%s", row->least, row->most, automatic);
    } else {
        snprintf(out, size, "from %.7g to %.10g%s", row->least, row->most, automatic);
    }
}

bool setting_check(const setting_row *row, const ag_render_settings *settings, char *out, size_t size)
{
    char range[160];
    if (is_valid(row, settings))
        return true;
    describe_range(row, range, sizeof range);
    snprintf(out, size, "the %s must be %s", row->noun, range);
    return false;
}

/* --- values as text --- */

/* The shortest that gives the float back, with a point in every locale. */
static void format_float(float value, char out[SETTING_TEXT_MAX])
{
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(out, SETTING_TEXT_MAX, "%.*g", digits, (double)value);
        if (strtof(out, NULL) == value)
            break;
    }
    for (char *c = out; *c; c++)
        if (*c == ',')
            *c = '.';
}

void setting_format(const setting_row *row, const ag_render_settings *settings, char out[SETTING_TEXT_MAX])
{
    const void *value = value_of(row, settings);
    const int *size = value;
    const double *window = value;
    const char *const *file = value;
    switch (row->kind) {
    case SETTING_WORD: snprintf(out, SETTING_TEXT_MAX, "%s", row->words[*(const unsigned *)value]); break;
    case SETTING_INTEGER: snprintf(out, SETTING_TEXT_MAX, "%d", *(const int *)value); break;
    case SETTING_COUNT: snprintf(out, SETTING_TEXT_MAX, "%llu", (unsigned long long)*(const uint64_t *)value); break;
    case SETTING_SEED: /* a scene's may be below 0 */
        snprintf(out, SETTING_TEXT_MAX, "%lld", (long long)*(const uint64_t *)value);
        break;
    case SETTING_NUMBER: format_float(*(const float *)value, out); break;
    case SETTING_FLAG: snprintf(out, SETTING_TEXT_MAX, "%s", *(const bool *)value ? "true" : "false"); break;
    case SETTING_SIZE: snprintf(out, SETTING_TEXT_MAX, "%dx%d", size[0], size[1]); break;
    case SETTING_WINDOW:
        snprintf(out, SETTING_TEXT_MAX, "%.17g,%.17g,%.17g,%.17g", window[0], window[1], window[2], window[3]);
        break;
    case SETTING_LAYERS: snprintf(out, SETTING_TEXT_MAX, "0x%x", *(const uint32_t *)value); break;
    case SETTING_FILE: snprintf(out, SETTING_TEXT_MAX, "%s", *file ? *file : ""); break;
    }
}

static bool parse_number(const char *text, double *out_number)
{
    const char *end = decimal_parse(text, out_number);
    return end && *end == '\0' && isfinite(*out_number);
}

/* Four numbers with commas between them. */
static bool parse_window(const char *text, double out_window[4])
{
    for (int i = 0; i < 4; i++) {
        text = decimal_parse(text, &out_window[i]);
        if (!text || *text != (i < 3 ? ',' : '\0'))
            return false;
        text++;
    }
    return true;
}

static bool parse_size(const char *text, int out_size[2])
{
    int used = 0;
    return sscanf(text, "%6dx%6d%n", &out_size[0], &out_size[1], &used) == 2 && text[used] == '\0';
}

/* Digits alone: no sign. */
static bool parse_seed(const char *text, uint64_t *out_seed)
{
    char *end;
    errno = 0;
    unsigned long long seed = strtoull(text, &end, 10);
    *out_seed = seed;
    return text[0] >= '0' && text[0] <= '9' && *end == '\0' && errno == 0 && seed <= INT64_MAX;
}

/* An int as it is usually written: no point, no exponent. */
static bool parse_integer(const char *text, double *out_number)
{
    char *end;
    errno = 0;
    long value = strtol(text, &end, 10);
    *out_number = (double)value;
    return end != text && *end == '\0' && errno == 0;
}

static bool parse_word(const setting_row *row, const char *text, double *out_number)
{
    for (int i = 0; row->words[i]; i++)
        if (strcmp(row->words[i], text) == 0) {
            *out_number = i;
            return true;
        }
    return false;
}

/* Sets one setting; false where the text is no value of it, which then is anything. */
static bool set_text(const setting_row *row, const char *text, ag_render_settings *settings)
{
    void *value = (unsigned char *)settings + row->offset;
    double number = 1.0;
    uint32_t layers = 0;
    bool is_read = row->kind == SETTING_FLAG;
    if (is_read != (text == NULL))
        return false;
    switch (row->kind) {
    case SETTING_FLAG: break;
    case SETTING_WORD: is_read = parse_word(row, text, &number); break;
    case SETTING_INTEGER: is_read = parse_integer(text, &number) && is_in_range(row, number); break;
    case SETTING_COUNT:
        is_read = parse_number(text, &number) && is_in_range(row, number) && number == floor(number);
        break;
    case SETTING_NUMBER: /* as a float: 0.8 is no more than 0.8f */
        is_read = parse_number(text, &number) && is_in_range(row, (double)(float)number);
        break;
    case SETTING_LAYERS:
        is_read = ag_layers_parse(text, &layers) == AG_OK;
        number = *(const uint32_t *)value | layers;
        break;
    case SETTING_SEED: return parse_seed(text, value);
    case SETTING_SIZE: return parse_size(text, value) && is_valid(row, settings);
    case SETTING_WINDOW: return parse_window(text, value) && is_valid(row, settings);
    case SETTING_FILE: *(const char **)value = text; return true;
    }
    if (is_read)
        set_number(row, number, settings);
    return is_read;
}

/* --- by name --- */

const ag_setting *ag_setting_at(size_t index)
{
    for (size_t i = 0; setting_at(i); i++)
        if (setting_at(i)->text.name && index-- == 0)
            return &setting_at(i)->text;
    return NULL;
}

ag_status ag_render_settings_set(ag_render_settings *settings, const char *name, const char *value)
{
    if (!settings || settings->struct_size != sizeof *settings || !name)
        return AG_ERROR_ARGUMENT;
    for (size_t i = 0; setting_at(i); i++) {
        const setting_row *row = setting_at(i);
        if (!row->text.name || strcmp(row->text.name, name) != 0)
            continue;
        ag_render_settings changed = *settings;
        if (!set_text(row, value, &changed))
            return AG_ERROR_ARGUMENT;
        *settings = changed;
        return AG_OK;
    }
    return AG_ERROR_ARGUMENT;
}

/* --- what depends on them --- */

size_t settings_of_picture(const ag_render_settings *settings, unsigned char *out, size_t size)
{
    size_t used = 0;
    for (size_t i = 0; setting_at(i); i++) {
        const setting_row *row = setting_at(i);
        if (!(row->marks & SETTING_OF_PICTURE))
            continue;
        if (out && used + row->size <= size)
            memcpy(out + used, value_of(row, settings), row->size);
        used += row->size;
    }
    return used;
}

const char *settings_of_picture_difference(const unsigned char *one, const unsigned char *other)
{
    size_t at = 0;
    for (size_t i = 0; setting_at(i); i++) {
        const setting_row *row = setting_at(i);
        if (!(row->marks & SETTING_OF_PICTURE))
            continue;
        if (memcmp(one + at, other + at, row->size) != 0)
            return row->noun;
        at += row->size;
    }
    return NULL;
}

size_t settings_of_photon_map(const ag_render_settings *settings, char *out, size_t size)
{
    size_t used = 0;
    out[0] = '\0';
    for (size_t i = 0; setting_at(i); i++) {
        const setting_row *row = setting_at(i);
        char value[SETTING_TEXT_MAX];
        if (!row->text.is_of_photon_map)
            continue;
        setting_format(row, settings, value);
        used += (size_t)snprintf(used < size ? out + used : NULL, used < size ? size - used : 0, "%s: %s\n", row->noun,
                                 value);
    }
    return used;
}
