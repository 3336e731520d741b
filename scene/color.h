/* color.h: from encoded images to scene-linear RGB, and from that to what a display shows, by OpenColorIO. A bridge:
 * plain C outside, C++ inside.
 * Flow: image file -> [here] -> texture; film -> [here] -> image file. Threads: a config may be read by many; a
 * processor applied by many at once. */
#ifndef AFTERGLOW_COLOR_H
#define AFTERGLOW_COLOR_H

#include "afterglow/base.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct color_config color_config;
typedef struct color_processor color_processor;

/* The order: path (NULL: none) > $OCIO > the config compiled in. A config that is named but cannot be used is an error,
 * with OpenColorIO's own text; there is no silent fallback. Errors: AG_ERROR_COLOR, AG_ERROR_MEMORY; the text goes to
 * message (always terminated). */
ag_status color_config_create(const char *path, char *message, size_t message_size, color_config **out_config);
/* The config compiled in, whatever $OCIO says: what a scene file means by its encodings. Errors: as above. */
ag_status color_config_create_builtin(char *message, size_t message_size, color_config **out_config);
void color_config_destroy(color_config *config); /* NULL is fine */

/* For the metadata: the config's name (or file) and the hash of its contents. Owned by the config. */
const char *color_config_name(const color_config *config);
const char *color_config_hash(const color_config *config);

/* For the log: the config's colour space that our pixels are taken to be in (or the one they reach by a matrix of ours,
 * ACES2065-1). Where the config has no Rec. 709 space, its role rendering or scene_linear. Owned by the config. */
const char *color_config_input_space(const color_config *config);

/* Scene-linear RGB is taken as linear Rec. 709 primaries. display, view NULL: the config's defaults.
 * Unknown names are an error that lists the known ones. */
ag_status color_processor_create(const color_config *config, const char *display, const char *view, char *message,
                                 size_t message_size, color_processor **out_processor);

/* From a colour space of the config, by its name or an alias ("sRGB - Texture", "srgb_tx"), to linear Rec. 709; by the
 * exact curves, not their fast approximations. Errors: AG_ERROR_COLOR (an unknown space), AG_ERROR_MEMORY. */
ag_status color_decoder_create(const color_config *config, const char *space, char *message, size_t message_size,
                               color_processor **out_processor);
void color_processor_destroy(color_processor *processor); /* NULL is fine */

/* In place: count pixels of 3 packed floats. Every part of a picture may be done apart, with the same bits. */
ag_status color_processor_apply(const color_processor *processor, float *rgb_pixels, size_t count, char *message,
                                size_t message_size);

#ifdef __cplusplus
}
#endif
#endif
