/* picture_layers.h: a film's channels and what it says of itself, as an EXR file holds them.
 * Rests on: OpenEXR's standard attributes (ImfStandardAttributes.h), pbrt-v4's and PRMan's names for the camera.
 * Flow: film -> [here] -> image_file. Threads: one. */
#ifndef AFTERGLOW_PICTURE_LAYERS_H
#define AFTERGLOW_PICTURE_LAYERS_H

#include "context.h"
#include "image/image.h"

typedef struct picture_layers {
    float *pixels; /* channel_count of a pixel */
    const char **names;
    image_sample_type *types;
    int channel_count;
    image_attribute *attributes; /* owned, with */
    char **texts;                /* the memory of the name and text of each, or NULL */
    int attribute_count, attribute_capacity;
    bool has_failed; /* there was no memory for an attribute */
    float render_time;
} picture_layers;

/* beauty: R, G and B as they are to be written. type: half or float, of the channels that may be either. What is not a
 * number becomes 0, and a warning says how many pixels had such, and how many were too bright for halves. Errors:
 * AG_ERROR_MEMORY.
 * out_layers is not to be moved: an attribute points into it. */
ag_status picture_layers_create(ag_context *context, const ag_film *film, const float *beauty,
                                const ag_output_settings *settings, image_sample_type type, const char *path,
                                picture_layers *out_layers);
/* Adds an attribute; name and numbers stay the caller's, and have to live as long. Errors: AG_ERROR_MEMORY. */
ag_status picture_layers_add_numbers(picture_layers *layers, const char *name, const float *numbers, int count);
void picture_layers_reset(picture_layers *layers);

#endif
