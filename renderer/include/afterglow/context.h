/* context.h: what a program has one of, or several side by side: threads, log, progress, colour config.
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
    size_t struct_size;        /* of all settings: see afterglow.h */
    unsigned thread_count;     /* 0: as many as the affinity mask and the cgroup's quota allow; default 0 */
    const char *isa;           /* widest instruction set of ray traversal: "sse2", "sse4.2", "avx", "avx2", "avx512";
                                  NULL: "avx2". Another set may give other bits. */
    const char *color_config;  /* an OpenColorIO config; NULL: $OCIO, else the one compiled in. Read when it is first
                                  needed; one that cannot be used is an error of that call */
    const char *working_space; /* colour space of the config that light is carried in, by name, alias or role; NULL: its
                                  role rendering, else scene_linear (linear Rec. 709 in the one compiled in). The
                                  scene's colours, spectra and pictures are converted to it as they are read */
    bool is_confined; /* scenes are not trusted: of their files only those are read that lie below the scene's own
                         folder, or below those of confined_to; of formats that assimp reads, where the kernel
                         (Landlock) holds its process there, else none. Default false */
    const char *const *confined_to; /* [confined_count], or NULL */
    size_t confined_count;
    ag_log_fn *log;           /* NULL: messages are dropped */
    ag_progress_fn *progress; /* or NULL */
    void *user;               /* handed to both */
} ag_context_settings;

AG_DEFAULT_STRUCT(context_settings, AG_STRUCT_CONTEXT_SETTINGS)
/* Copies the settings; NULL for the defaults. Errors: AG_ERROR_ARGUMENT (isa is not known, or struct_size is not the
 * library's; the log may not be where it should then, and says nothing), AG_ERROR_MEMORY, AG_ERROR_SYSTEM. */
AG_API ag_status ag_context_create(const ag_context_settings *settings, ag_context **out_context);
AG_API void ag_context_destroy(ag_context *context); /* after all that was made with it; NULL is fine */
AG_API unsigned ag_context_thread_count(const ag_context *context);
/* The work under way returns AG_CANCELLED, within 50 ms; so does all later work with this context, until
 * ag_context_clear_cancel. Safe in a signal handler. */
AG_API void ag_context_cancel(ag_context *context);
/* Work may begin again after a cancellation, with the context and the scenes that are there; so may a rendering whose
 * ag_rendering_continue was cancelled go on, to the same bits. Not while work is under way. */
AG_API void ag_context_clear_cancel(ag_context *context);
/* The ag_rendering_continue under way, else the next, returns AG_PAUSED, within 50 ms and with whole samples; it may be
 * called again. No other work is touched. Safe in a signal handler. */
AG_API void ag_context_pause(ag_context *context);

/* What is kept of the last picture's photons, where settings say photon_paths, goes from one context to another, in
 * place of what that has: for programs that give each frame of an animation a context of its own. A context keeps it
 * from one picture to the next by itself, also where the scene is another: irradiance is then not computed anew where
 * neither photons nor surfaces have changed, and the picture has the bits of one that is rendered alone. It takes 28
 * bytes a photon until the next picture's photons are traced, or the context is destroyed. Nothing is kept of a
 * photon_map_file. NULL is fine; contexts of other instruction sets take nothing. */
AG_API void ag_context_take_frame(ag_context *context, ag_context *from);

/* Lists what the colour config has, as lines of text: displays and their views, looks, colour spaces, roles. The
 * context's. Errors: AG_ERROR_COLOR, AG_ERROR_MEMORY. */
AG_API ag_status ag_color_summary(ag_context *context, const char **out_text);

/* A display of the colour config and one of its views, by number: number 0 is what ag_output_settings takes where they
 * name none, the others follow as the config has them. The strings are the context's. Errors: AG_ERROR_ARGUMENT (there
 * are no more), AG_ERROR_COLOR, AG_ERROR_MEMORY. */
AG_API ag_status ag_color_view_at(ag_context *context, size_t index, const char **out_display, const char **out_view);

#ifdef __cplusplus
}
#endif
#endif
