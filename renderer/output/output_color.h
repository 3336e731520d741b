/* output_color.h: what becomes of the film's colours on their way to a file: a display and view, another colour space,
 * or nothing; and what the file says of them. Rests on: OpenColorIO. Flow: film -> [here] -> output -> image_file.
 * Threads: the caller's context; the transform runs on all its threads. */
#ifndef AFTERGLOW_OUTPUT_COLOR_H
#define AFTERGLOW_OUTPUT_COLOR_H

#include "context.h"

/* Checks that the settings have the library's size, and values in range; says in the log what is wrong. Errors:
 * AG_ERROR_ARGUMENT. */
ag_status output_settings_check(ag_context *context, const ag_output_settings *settings);

/* Checks that the settings name what the config has; says in the log what is wrong. The default view, which takes 10 ms
 * to make, is looked up only where the file is not scene_linear. Errors: AG_ERROR_COLOR, AG_ERROR_MEMORY. */
ag_status output_color_check(ag_context *context, const ag_output_settings *settings, bool scene_linear);

/* Converts count pixels of 3 floats in place: scene-linear ones to settings->color_space, where that is given; others
 * to display and view. The bits do not depend on the number of threads. Errors: AG_ERROR_COLOR,
 * AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status output_color_apply(ag_context *context, const ag_output_settings *settings, bool scene_linear, float *pixels,
                             uint64_t count);

/* Returns the colour space that a scene-linear file names. */
typedef struct output_color_tag {
    const char *color_space; /* for oiio:ColorSpace; lives as long as the context */
    bool has_chromaticities; /* not where it is no linear space */
    float chromaticities[8]; /* red, green, blue, white, each x and y */
} output_color_tag;

ag_status output_color_find_tag(ag_context *context, const ag_output_settings *settings, const ag_film *film,
                                output_color_tag *out_tag);

#endif
