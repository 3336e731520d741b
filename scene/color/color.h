/* color.h: from encoded images to scene-linear RGB, and from that to what a display shows, by OpenColorIO. A bridge:
 * plain C outside, C++ inside.
 * Flow: image file -> [here] -> texture; film -> [here] -> image file. Threads: a config may be read by many; a
 * processor applied by many at once. */
#ifndef AFTERGLOW_COLOR_H
#define AFTERGLOW_COLOR_H

#include "afterglow/base.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

struct log_sink;

typedef struct color_config color_config;
typedef struct color_processor color_processor;

/* The order: path (NULL: none) > $OCIO > the config compiled in. A config that is named but cannot be used is an error,
 * with OpenColorIO's own text; there is no silent fallback. working_space: the colour space that light is carried in,
 * by name, alias or role; NULL: the config's role rendering, else scene_linear, else linear Rec. 709 by its known
 * names. log: what OpenColorIO itself says meanwhile, and whenever the config or a processor of it is at work, each
 * thing once; borrowed for as long as these live; NULL: it is dropped. Errors: AG_ERROR_COLOR (also: the working space
 * is unknown or not linear), AG_ERROR_MEMORY; the text goes to message (always terminated). */
ag_status color_config_create(const char *path, const char *working_space, struct log_sink *log, char *message,
                              size_t message_size, color_config **out_config);
/* The config compiled in, whatever $OCIO says: what a scene file means by its encodings. Errors: as above. */
ag_status color_config_create_builtin(char *message, size_t message_size, color_config **out_config);
void color_config_destroy(color_config *config); /* NULL is fine */

/* The text for the metadata: the config's name (or file) and the hash of its contents. Owned by the config. */
const char *color_config_name(const color_config *config);
const char *color_config_hash(const color_config *config);

/* The working space, as the config spells it. Owned by the config. */
const char *color_config_working_space(const color_config *config);
/* To it from linear Rec. 709, row by row. False, and the unit matrix, where the config names neither linear Rec. 709
 * nor an interchange space: what its primaries are is not known. */
bool color_config_from_rec709(const color_config *config, double out_matrix[9]);

/* Lists the config's displays with their views, looks, colour spaces and roles as lines of text, to be freed. */
ag_status color_config_describe(const color_config *config, char *message, size_t message_size, char **out_text);

/* Lists pairs of a display and a view, each a string with a zero behind it; an empty string ends the list: first the
 * pair that is taken where none is asked for, then all others as the config has them. To be freed. */
ag_status color_config_list_views(const color_config *config, char *message, size_t message_size, char **out_pairs);

/* The colour space of that name, alias or role, as the config spells it; NULL where there is none. Owned by the config.
 * Where message is not NULL, what there is goes there. */
const char *color_config_find_space(const color_config *config, const char *name, char *message, size_t message_size);
/* The colour space that the config's file rules give to a file, as the config spells it; NULL where only the rule for
 * all other files fits, which says nothing of this one. Owned by the config. */
const char *color_config_rule(const color_config *config, const char *path);

/* How a colour space's values relate to the working space's. */
typedef enum color_curve {
    COLOR_CURVE_DATA,   /* no colours: never converted */
    COLOR_CURVE_LINEAR, /* a matrix leads to the working space */
    COLOR_CURVE_SRGB,   /* IEC 61966-2-1, then a matrix */
    COLOR_CURVE_OTHER   /* what a decoder does */
} color_curve;

/* The colour space's curve, and the matrix, row by row, to the working space; a unit matrix where there is none. The
 * space's name, an alias or a role. Errors: AG_ERROR_COLOR (an unknown space), AG_ERROR_MEMORY. */
ag_status color_config_study_space(const color_config *config, const char *space, char *message, size_t message_size,
                                   color_curve *out_curve, double out_matrix[9]);

/* How a picture is shown. */
typedef struct color_view {
    const char *display, *view; /* NULL: the config's defaults */
    const char *look;           /* instead of the view's own: names with commas between them, each with a - before it
                                 * undone; "none": none; NULL: the view's own */
    float exposure;             /* stops: values are first multiplied by 2^exposure */
} color_view;

/* From the working space to a display. Unknown names are an error that lists the known ones. */
ag_status color_processor_create(const color_config *config, const color_view *view, char *message, size_t message_size,
                                 color_processor **out_processor);

/* From a colour space of the config, by its name or an alias ("sRGB - Texture", "srgb_tx"), to the working space; by
 * the exact curves, not their fast approximations. Errors: AG_ERROR_COLOR (an unknown space), AG_ERROR_MEMORY. */
ag_status color_decoder_create(const color_config *config, const char *space, char *message, size_t message_size,
                               color_processor **out_processor);
/* The way back: from the working space. */
ag_status color_encoder_create(const color_config *config, const char *space, char *message, size_t message_size,
                               color_processor **out_processor);
void color_processor_destroy(color_processor *processor); /* NULL is fine */

/* Converts count pixels of 3 packed floats in place. Every part of a picture may be done apart, with the same bits. */
ag_status color_processor_apply(const color_processor *processor, float *rgb_pixels, size_t count, char *message,
                                size_t message_size);

#ifdef __cplusplus
}
#endif
#endif
