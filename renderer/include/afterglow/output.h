/* output.h: writes films to files.
 * Part of afterglow.h, which tells about threads and errors. */
#ifndef AFTERGLOW_PUBLIC_OUTPUT_H
#define AFTERGLOW_PUBLIC_OUTPUT_H

#include "afterglow/film.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum ag_sample_type {
    AG_SAMPLE_DEFAULT,
    AG_SAMPLE_UINT8,
    AG_SAMPLE_UINT16,
    AG_SAMPLE_HALF,
    AG_SAMPLE_FLOAT
} ag_sample_type;

typedef struct ag_output_settings {
    size_t struct_size;
    ag_sample_type type;      /* default: half for EXR, float for Radiance and PFM, 16 bit for TIFF, 8 bit for others */
    bool tiled;               /* EXR in tiles of 64 x 64 pixels; default: in lines */
    bool reproducible;        /* leaves out of EXR headers what differs from run to run, so that equal pictures are
                                 equal files */
    const char *command_line; /* recorded in EXR headers; NULL: none */
    const char *color_space;  /* of EXR, Radiance and PFM files, by the config's name, an alias or a role; NULL: the
                                 working space */
    /* For all other formats: */
    const char *display;  /* NULL: the config's default */
    const char *view;     /* NULL: the display's default */
    const char *look;     /* looks in place of the view's own: names separated by commas, with a leading - for the
                             inverse; "none": no look; NULL: the view's own */
    float exposure_stops; /* light is multiplied by 2^exposure_stops before the view; default 0 */
} ag_output_settings;

AG_DEFAULT_STRUCT(output_settings, AG_STRUCT_OUTPUT_SETTINGS)

/* Checks, before a long render, that a file could be written with these settings: its extension is known, its folder
 * exists, and the colour config has what they name. Errors: AG_ERROR_ARGUMENT (extension or type), AG_ERROR_OUTPUT,
 * AG_ERROR_COLOR. */
AG_API ag_status ag_output_check(ag_context *context, const ag_output_settings *settings, const char *path);

/* Writes the film: scene-linear, with its layers and chromaticities, for .exr; scene-linear for .hdr (which clips
 * negative values) and .pfm, neither of which records its colour space; through look, display and view for .png, .tif,
 * .jpg. The file appears complete or not at all; the reader of a FIFO is waited for, until ag_context_cancel or
 * ag_end_waits. settings NULL: the defaults. */
AG_API ag_status ag_film_write(ag_context *context, const ag_film *film, const ag_output_settings *settings,
                               const char *path);

/* The colour transform from the working space to a display, as ag_film_write applies it for .png: for programs that
 * show pictures themselves. */
typedef struct ag_view ag_view;
/* Uses display, view, look and exposure_stops of the settings; NULL: the defaults. The view must be destroyed before
 * the context. Once a context has made one view, any thread may make more at any time. Errors: AG_ERROR_ARGUMENT,
 * AG_ERROR_COLOR, AG_ERROR_MEMORY; *out_view is NULL then. */
AG_API ag_status ag_view_create(ag_context *context, const ag_output_settings *settings, ag_view **out_view);
AG_API void ag_view_destroy(ag_view *view); /* NULL is fine */
/* Converts count pixels of 3 floats in place; the display shows the range [0, 1]. Any number of threads may call it at
 * once. Errors: AG_ERROR_ARGUMENT, AG_ERROR_COLOR. */
AG_API ag_status ag_view_apply(const ag_view *view, float *pixels, size_t count);

/* Stops all contexts from waiting for the reader of a FIFO or of standard output: from now on a write fails where the
 * reader is not ready. For the handler of a signal that ends the process in order; safe in a signal handler. */
AG_API void ag_end_waits(void);

/* Removes the temporary files of writes under way, in all contexts. For the handler of a signal that ends the process
 * at once; safe in a signal handler. */
AG_API void ag_abandon_files(void);

#ifdef __cplusplus
}
#endif
#endif
