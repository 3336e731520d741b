/* context.h: the insides of the public objects.
 * Threads: as in afterglow.h. */
#ifndef AFTERGLOW_CONTEXT_H
#define AFTERGLOW_CONTEXT_H

#include "film.h"
#include "run_context.h"
#include "scene.h"

struct ag_context {
    thread_pool *pool;
    log_sink *log;
    run_context run;
    char isa[16];
    double created_at; /* clock_seconds */
    ag_statistics statistics;
    ag_render_settings rendered; /* of the last ag_render, nothing left open */
};

struct ag_scene {
    scene *s;
};

/* Adds the time since `begin` (clock_seconds) to a phase, and says at info level how long it took. */
void context_end_phase(ag_context *context, ag_phase phase, double begin);

/* Whether settings are in range; says in the log which is not. */
ag_status render_settings_check(ag_context *context, const ag_render_settings *settings);

#endif
