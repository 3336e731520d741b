/* context.h: the context: threads, log, progress and colour config, shared by all that is made with it.
 * Part of afterglow.h, which tells about threads and errors. */
#ifndef AFTERGLOW_PUBLIC_CONTEXT_H
#define AFTERGLOW_PUBLIC_CONTEXT_H

#include "afterglow/base.h"
#include "afterglow/structs.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ag_context ag_context;

typedef struct ag_context_settings {
    size_t struct_size;        /* see afterglow.h */
    unsigned thread_count;     /* 0: as many as the affinity mask and the cgroup's quota allow; default 0 */
    const char *isa;           /* widest instruction set of ray traversal: "sse2", "sse4.2", "avx", "avx2", "avx512";
                                  NULL: "avx2". Another set may give other bits. */
    const char *color_config;  /* path of an OpenColorIO config; NULL: $OCIO, else the built-in one. It is read when
                                  first needed; a config that cannot be used is an error of that call */
    const char *working_space; /* colour space of the config that light is computed in, by name, alias or role; NULL:
                                  the role rendering, else scene_linear (linear Rec. 709 in the built-in config). The
                                  scene's colours, spectra and pictures are converted to it as they are read */
    bool is_confined; /* for scenes that are not trusted: a scene may read files only below its own folder and below
                         the folders of confined_to. Formats that assimp reads are then read only where the kernel
                         can confine the importing process (Landlock). Default false */
    const char *const *confined_to; /* paths of folders, [confined_count], or NULL */
    size_t confined_count;
    ag_log_fn *log;           /* NULL: messages are dropped */
    ag_progress_fn *progress; /* may be NULL */
    void *user;               /* passed to log and progress */
} ag_context_settings;

AG_DEFAULT_STRUCT(context_settings, AG_STRUCT_CONTEXT_SETTINGS)
/* Copies the settings; NULL: the defaults. Errors: AG_ERROR_ARGUMENT (isa is not known; or struct_size is not the
 * library's, where nothing is logged, since the log member may be misplaced), AG_ERROR_MEMORY, AG_ERROR_SYSTEM (so many
 * threads cannot be had, as the log says). */
AG_API ag_status ag_context_create(const ag_context_settings *settings, ag_context **out_context);
/* To be called after everything that was made with it has been destroyed; NULL is fine. Where scenes are left, the log
 * says so, for the last time; the context is then cancelled for good, and freed with the last of its scenes. */
AG_API void ag_context_destroy(ag_context *context);
AG_API unsigned ag_context_thread_count(const ag_context *context);
/* Makes the call under way return AG_CANCELLED, and all later work with this context too, until
 * ag_context_clear_cancel. Work ends within some 50 ms of its threads' own time, which takes longer where they wait for
 * a CPU. A picture of a texture or light is read in pieces of a megabyte or what its file packs together, and reading
 * ends after such a piece; where its format is decoded as a whole (interlaced PNG, progressive JPEG, HEIF, AVIF, JPEG
 * 2000, WebP, GIF, compressed Targa, DDS and others) not before that is done. Safe in a signal handler. */
AG_API void ag_context_cancel(ag_context *context);
/* Ends a cancellation: work may begin again with the context and its scenes, and a rendering whose
 * ag_rendering_continue was cancelled may continue, to the same bits. Not to be called while work is under way. */
AG_API void ag_context_clear_cancel(ag_context *context);
/* Makes the ag_rendering_continue under way, else the next one, return AG_PAUSED within some 50 ms of its
 * threads' own time, after whole samples; it may then be called again. No other work is affected. Safe in a signal
 * handler. */
AG_API void ag_context_pause(ag_context *context);

/* Moves what `from` keeps of its last picture's photons to `context`, whose own is dropped; for programs that create a
 * context for each frame of an animation. A context keeps it from one picture to the next where photon_paths is set
 * (render_settings.h) and photon_map_file is not: irradiance is then recomputed only where photons or surfaces have
 * changed, and each picture has the bits of one that is rendered alone, even if the scene is another. It takes 28 bytes
 * per photon, until the photons of the next picture have been traced or the context is destroyed. NULL is fine. Does
 * nothing where the two contexts use different instruction sets. */
AG_API void ag_context_take_frame(ag_context *context, ag_context *from);

/* Writes the displays, views, looks, colour spaces and roles of the colour config as lines of text, which the context
 * owns. Errors: AG_ERROR_COLOR, AG_ERROR_MEMORY. */
AG_API ag_status ag_color_summary(ag_context *context, const char **out_text);

/* Writes a display of the colour config and one of its views, by number: 0 is the default of ag_output_settings, the
 * others follow in the config's order. The context owns the strings. Errors: AG_ERROR_ARGUMENT (index is past the
 * last), AG_ERROR_COLOR, AG_ERROR_MEMORY. */
AG_API ag_status ag_color_view_at(ag_context *context, size_t index, const char **out_display, const char **out_view);

#ifdef __cplusplus
}
#endif
#endif
