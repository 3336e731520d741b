/* pbrt_colors.c: what rgb and spectrum parameters of a pbrt-v4 scene are, before anybody asks for them: the colour
 * space of the file becomes the working space, and spectra that are files become their values. Rests on the format's
 * description, pbrt.org/fileformat-v4, "Color Spaces" and "Spectra". Pictures have their own colour space, as in pbrt:
 * the directive does not concern them. Flow: pbrt_parameters -> [here] -> parameter_list. Threads: one per scene. */
#include "color/color_space.h"
#include "pbrt/pbrt_private.h"

#include <stdlib.h>
#include <string.h>

/* Converts a colour from the current colour space to the working space. The indices of metals become Rec. 709's
 * instead, and are converted with their absorption. What a space cannot hold is clipped. */
static ag_status convert_rgb(pbrt_parser *parser, parameter *p, size_t width)
{
    const working_space *space = &parser->scene->space;
    spectrum_use use = parameter_spectrum_use(p->name);
    const bool stays_rec709 = space->is_rec709 || use == SPECTRUM_INDEX;
    if (parser->state.rgb_space == COLOR_SPACE_SRGB && stays_rec709)
        return AG_OK;
    color_matrix m = color_space_to_rec709(parser->state.rgb_space, use == SPECTRUM_LIGHT);
    if (!stays_rec709)
        m = color_matrix_multiply(&space->from_rec709, &m);
    for (size_t i = 0; i + 2 < p->count; i += 3) {
        double *c = &p->numbers[i];
        if (c[0] < 0.0 || c[1] < 0.0 || c[2] < 0.0)
            return pbrt_error(parser, p->where, width, "\"rgb %s\" has a negative component", p->name);
        double largest = double_max(c[0], double_max(c[1], c[2]));
        p->most_in_file = double_max(p->most_in_file, largest);
        double bound = use == SPECTRUM_REFLECTANCE && largest <= 1.0 ? 1.0 : INFINITY;
        color_matrix_apply(&m, c, c);
        if (double_min(c[0], double_min(c[1], c[2])) < -1e-3 * largest ||
            double_max(c[0], double_max(c[1], c[2])) > bound + 1e-3)
            log_at_once(parser->log, AG_LOG_WARNING, p->where, "gamut",
                        "\"rgb %s\" is outside the colours of %s: it is clipped, as are any others", p->name,
                        stays_rec709 ? "Rec. 709" : "the working space");
        for (int k = 0; k < 3; k++)
            c[k] = double_clamp(c[k], 0.0, bound);
    }
    return AG_OK;
}

/* Tells an error in a file of numbers, with its line. */
static ag_status refuse_token(pbrt_parser *parser, const pbrt_lexer *lexer, const pbrt_token *token,
                              const char *message)
{
    char excerpt[320] = "";
    pbrt_lexer_excerpt(lexer, token->where, token->width, excerpt, sizeof excerpt);
    log_at(parser->log, AG_LOG_ERROR, token->where, "%s%s", message, excerpt);
    return AG_ERROR_SCENE;
}

static ag_status read_numbers(pbrt_parser *parser, pbrt_lexer *lexer, double **in_out_numbers, size_t *in_out_count)
{
    size_t capacity = 0;
    for (;;) {
        pbrt_token token;
        double number;
        ag_status status = pbrt_lexer_next(lexer, &token);
        if (status == AG_ERROR_SCENE)
            return refuse_token(parser, lexer, &token, lexer->error);
        if (status != AG_OK || token.kind == PBRT_TOKEN_END)
            return status;
        if (!pbrt_token_number(&token, &number) || !isfinite(number))
            return refuse_token(parser, lexer, &token, "a number should stand here");
        if (*in_out_count == capacity) {
            capacity = capacity ? 2 * capacity : 128;
            double *larger = realloc(*in_out_numbers, capacity * sizeof *larger);
            if (!larger)
                return AG_ERROR_MEMORY;
            *in_out_numbers = larger;
        }
        (*in_out_numbers)[(*in_out_count)++] = number;
    }
}

ag_status pbrt_read_number_file(pbrt_parser *parser, const char *name, file_location where, size_t width,
                                const char *hint, double **out_numbers, size_t *out_count)
{
    char error[128];
    text_file file;
    double *numbers = NULL;
    size_t count = 0;
    char *path = pbrt_find_file(parser, name);
    const char *interned = path ? scene_intern_file_name(parser->scene, path) : NULL;
    ag_status status = interned ? text_file_read(parser->run, path, error, sizeof error, &file) : AG_ERROR_MEMORY;
    free(path);
    if (status == AG_ERROR_INPUT)
        pbrt_error(parser, where, width, "cannot read the file \"%s\": %s%s", name, error, hint);
    if (status != AG_OK)
        return status;
    pbrt_lexer lexer;
    pbrt_lexer_init(&lexer, interned, file.text, file.size);
    status = read_numbers(parser, &lexer, &numbers, &count);
    pbrt_lexer_reset(&lexer);
    text_file_reset(&file);
    if (status != AG_OK) {
        free(numbers);
        return status;
    }
    *out_numbers = numbers;
    *out_count = count;
    return AG_OK;
}

/* Reads a file of wavelengths and values, unless the name is one of pbrt's. */
static ag_status read_spectrum(pbrt_parser *parser, parameter *p, size_t width)
{
    rgb ignored;
    double *numbers;
    size_t count;
    if (p->count != 1 || spectra_find_named(p->strings[0], NULL, &ignored) || spectra_is_missing(p->strings[0]))
        return AG_OK;
    AG_TRY(pbrt_read_number_file(parser, p->strings[0], p->where, width, "; nor has pbrt a spectrum of that name",
                                 &numbers, &count));
    if (count == 0 || count % 2 != 0) {
        free(numbers);
        return pbrt_error(parser, p->where, width,
                          "the file \"%s\" has %zu numbers: it should have wavelengths and values", p->strings[0],
                          count);
    }
    free(p->strings[0]);
    free(p->strings);
    p->strings = NULL;
    p->numbers = numbers;
    p->count = count;
    return AG_OK;
}

ag_status pbrt_settle_color(pbrt_parser *parser, parameter *p, size_t width)
{
    if (p->type == PARAMETER_RGB)
        return convert_rgb(parser, p, width);
    if (p->type == PARAMETER_SPECTRUM && p->strings)
        return read_spectrum(parser, p, width);
    return AG_OK;
}

ag_status pbrt_color_space(pbrt_parser *parser, file_location where)
{
    char *name;
    AG_TRY(pbrt_read_string(parser, "ColorSpace", "a quoted name", &name, NULL));
    ag_status status = AG_OK;
    if (!color_space_find(name, &parser->state.rgb_space))
        status =
            pbrt_error(parser, where, strlen("ColorSpace"),
                       "unknown colour space \"%s\"; known are srgb, dci-p3, rec2020, aces2065-1 and acescg", name);
    free(name);
    return status;
}
