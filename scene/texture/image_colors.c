/* image_colors.c: see image_colors.h. Threads: pure functions. */
#include "texture/image_colors.h"

#include "color/color.h"
#include "image/image.h"
#include "status.h"

static const double SAME = 1e-4; /* of a matrix that is the unit matrix but for rounding */

static void set_matrix(const double m[9], image_colors *c)
{
    for (int i = 0; i < 9; i++) {
        c->matrix[i] = (float)m[i];
        c->has_matrix = c->has_matrix || fabs(m[i] - (i % 4 == 0 ? 1.0 : 0.0)) > SAME;
    }
}

static void set_from_rec709(const image_colors_target *target, const color_matrix *to_rec709, image_colors *c)
{
    color_matrix m = color_matrix_multiply(&target->space->from_rec709, to_rec709);
    double rows[9];
    for (int i = 0; i < 9; i++)
        rows[i] = m.m[i / 3][i % 3];
    set_matrix(rows, c);
}

image_encoding image_colors_rule(const image_colors_target *target, const char *path)
{
    const char *space = target->config ? color_config_rule(target->config, path) : NULL;
    return space ? (image_encoding){.curve = IMAGE_CURVE_SPACE, .space = space, .is_rule = true} : (image_encoding){0};
}

bool image_colors_parse(const image_colors_target *target, const char *text, image_encoding *out_encoding,
                        char *message, size_t message_size)
{
    if (image_encoding_parse(text, out_encoding))
        return true;
    const char *space = target->config ? color_config_find_space(target->config, text, message, message_size) : NULL;
    if (space)
        *out_encoding = (image_encoding){.curve = IMAGE_CURVE_SPACE, .space = space};
    return space;
}

static ag_status find_by_space(const image_colors_target *target, image_encoding encoding, bool is_integer,
                               image_colors *c, char *message, size_t message_size)
{
    color_curve curve;
    double m[9];
    AG_TRY(color_config_study_space(target->config, encoding.space, message, message_size, &curve, m));
    if (curve == COLOR_CURVE_SRGB && is_integer)
        c->encoding.curve = IMAGE_CURVE_SRGB;
    else if (curve == COLOR_CURVE_DATA || curve == COLOR_CURVE_LINEAR)
        c->encoding.curve = IMAGE_CURVE_LINEAR;
    else
        c->space = encoding.space;
    if (!c->space)
        set_matrix(m, c);
    return AG_OK;
}

ag_status image_colors_find(const image_colors_target *target, image_encoding encoding, const image *picture,
                            image_colors *out_colors, char *message, size_t message_size)
{
    image_colors c = {.encoding = encoding};
    const bool is_integer = picture->type == IMAGE_UINT8 || picture->type == IMAGE_UINT16;
    const bool is_said = encoding.curve == IMAGE_CURVE_SPACE && !encoding.is_rule;
    color_matrix to_rec709;
    ag_status status = AG_OK;
    if (!is_said && !is_integer && picture->has_chromaticities &&
        color_chromaticities_to_rec709(picture->chromaticities, &to_rec709)) {
        c.encoding = (image_encoding){.curve = IMAGE_CURVE_LINEAR};
        set_from_rec709(target, &to_rec709, &c);
    } else if (encoding.curve == IMAGE_CURVE_SPACE) {
        c.encoding = (image_encoding){.curve = IMAGE_CURVE_LINEAR};
        status = find_by_space(target, encoding, is_integer, &c, message, message_size);
    } else if (!target->space->is_rec709) {
        to_rec709 = color_space_to_rec709(COLOR_SPACE_SRGB, false);
        set_from_rec709(target, &to_rec709, &c);
    }
    *out_colors = c;
    return status;
}

ag_status image_colors_decode(const image_colors_target *target, const image_colors *colors, float *rgb_pixels,
                              size_t count, char *message, size_t message_size)
{
    color_processor *processor;
    AG_TRY(color_decoder_create(target->config, colors->space, message, message_size, &processor));
    const ag_status status = color_processor_apply(processor, rgb_pixels, count, message, message_size);
    color_processor_destroy(processor);
    return status;
}
