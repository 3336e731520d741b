/* context.h: the insides of the public objects.
 * Threads: as in afterglow.h. */
#ifndef AFTERGLOW_CONTEXT_H
#define AFTERGLOW_CONTEXT_H

#include "clock.h"
#include "color/color.h"
#include "film/film.h"
#include "math/hash128.h"
#include "run_context.h"
#include "scene.h"
#include "text/input_file.h"

struct ag_context {
    thread_pool *pool;
    log_sink *log;
    run_context run;
    char isa[16];
    double created_at; /* clock_seconds */
    ag_statistics statistics;
    ag_prediction prediction;                     /* the last that was made */
    ag_render_settings rendered;                  /* of the last ag_render, nothing left open */
    char *color_config_path, *working_space_name; /* as in ag_context_settings */
    color_config *color_config;                   /* NULL until it is asked for */
    working_space working_space;                  /* of that */
    uint64_t host_bytes;                          /* of ag_context_expect_host_memory */
    bool is_confined;
    char **confined_to; /* owned */
    size_t confined_count;
    char *color_summary;           /* of ag_color_summary, or NULL */
    struct last_frame *last_frame; /* of fixed photon paths; NULL: there is none */
    size_t scene_count;            /* those made with it that have not been freed */
    bool is_dropped;               /* it goes with the last of them */
    char *color_views;             /* of ag_color_view_at, as color_config_list_views has them, or NULL */
    hash128 estimates;             /* of context_estimates, where has_estimates */
    bool has_estimates;
};

struct ag_scene {
    ag_context *context; /* borrowed */
    scene *s;            /* NULL until it is committed */
    input_files inputs;  /* what it was read from */
    struct scene_making
        *making;              /* then, and where it can be changed: see making/scene_making.h; NULL: it is complete */
    uint64_t camera_calls;    /* of ag_scene_set_camera, since it is complete */
    unsigned rendering_count; /* those that borrow it */
    bool is_dropped;          /* it goes with the last of them */
};

/* Whether two contexts have the same instruction set, colour config and working space: a scene of the one renders alike
 * with the other. */
bool context_is_alike(const ag_context *a, const ag_context *b);

/* The first is called when a scene of the context has been made, the second when it has been freed. A context that the
 * host destroyed while it had scenes is freed with the last of them. */
void context_add_scene(ag_context *context);
void context_remove_scene(ag_context *context);

/* Whether a scene can be rendered with a context; says in the log why not. Errors: AG_ERROR_ARGUMENT.
 * (making/scene_memory.c) */
ag_status scene_check_complete(ag_context *context, const ag_scene *made);

/* When a phase began. */
typedef struct phase_begin {
    double time_s, cpu_s; /* clock_seconds, clock_process_cpu_seconds */
} phase_begin;

static inline phase_begin context_begin_phase(void)
{
    return (phase_begin){clock_seconds(), clock_process_cpu_seconds()};
}

/* Adds the time since `begin` to a phase; gives the seconds. */
double context_add_to_phase(ag_context *context, ag_phase phase, phase_begin begin);

/* Adds the time since `begin` to a phase, and says at info level how long it took. */
void context_end_phase(ag_context *context, ag_phase phase, phase_begin begin);

/* Notes in the statistics how much memory the scene's textures take. */
void context_count_textures(ag_context *context, const scene *s);
/* Notes them too, and checks that all textures could be read: a picture made with one that could not is not to be used.
 * Errors: AG_ERROR_SYSTEM, AG_ERROR_MEMORY, with a message in the log. */
ag_status context_check_textures(ag_context *context, const scene *s);

/* The context's colour config, and with it context->working_space; read when first asked for. What is wrong is said in
 * the log. Errors: AG_ERROR_COLOR, AG_ERROR_MEMORY. (output_color.c) */
ag_status context_color_config(ag_context *context, const color_config **out_config);

/* The fingerprint of the program's photons and irradiance estimates (estimate_fingerprint), computed when first asked
 * for. Errors: AG_ERROR_MEMORY, AG_ERROR_RAY_TRACING. */
ag_status context_estimates(ag_context *context, hash128 *out_hash);

/* Whether a struct of the caller's, of that type, has the size that the library knows: to be asked before any other
 * member is read. Errors: AG_ERROR_ARGUMENT, with a message. */
ag_status context_check_struct(ag_context *context, const char *type, size_t size, size_t known_size);

/* Whether settings are in range; says in the log which is not. */
ag_status render_settings_check(ag_context *context, const ag_render_settings *settings);

#endif
