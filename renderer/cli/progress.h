/* progress.h: how far the work is, for a person, a farm, or a program.
 * Threads: the callback's calls are serialised by the library; messages go through the same lock. */
#ifndef AFTERGLOW_PROGRESS_H
#define AFTERGLOW_PROGRESS_H

#include "film_watch.h"
#include "options.h"

#include <stdbool.h>

typedef struct progress {
    progress_style style; /* never PROGRESS_AUTO */
    int verbosity;
    bool bar_is_shown;
    int told_percent;    /* the last one told, -1 before the first */
    double line_seconds; /* when the last line was told, in passes_seconds */
    bool has_precompute; /* its share of the work */
    bool has_photons;
    int frame, frame_count; /* which of the pictures, from 0 on */
    int frame_number;       /* its own */
    ag_phase phase;         /* the one told last */
    double phase_begun;     /* s, when it was told first, and how far it was then */
    double phase_begun_at;
    double begun, frame_begun;              /* s, passes_seconds */
    double phase_seconds[AG_PHASE_COUNT];   /* of the phases of this picture that are over */
    double learned_seconds[AG_PHASE_COUNT]; /* of all pictures before, in sum */
    int learned_count;                      /* of those pictures */
    film_watch watch;                       /* of PROGRESS_PICTURE */
    terminal_abilities abilities;           /* for it */
    double fraction, seconds_left;          /* as told last */
    int percent;
} progress;

/* How far the work is, as it was told last. */
typedef struct progress_state {
    ag_phase phase;                       /* AG_PHASE_COUNT: none has begun */
    double fraction;                      /* of the phase */
    int percent;                          /* of all */
    double seconds;                       /* since the program began */
    double seconds_left;                  /* below 0: not known yet */
    int frame, frame_count, frame_number; /* as in progress */
} progress_state;

/* Settles AUTO: a bar on a terminal, whole lines elsewhere; nothing when quiet. So it does PICTURE, with a warning,
 * where none can be shown; where one can, it asks the terminal how (terminal_query). */
void progress_init(progress *p, const options *o);

/* Begins the next of frame_count pictures; progress is told of all of them together. */
void progress_begin_frame(progress *p, int frame, int frame_count, int frame_number);

/* Tells which of the files were written and how long this picture took, where progress is told at all; nothing where
 * none was. */
void progress_tell_written(progress *p, const char *const *files, const bool *is_written, int file_count);

/* The progress callback of ag_context_settings, whose user is a progress. Messages go to standard error. */
void progress_tell(void *user, ag_phase phase, double fraction);
progress_state progress_read(const progress *p); /* any thread */
void progress_log(void *user, ag_log_level level, const char *message);

/* For PROGRESS_PICTURE, else they do nothing: makes the view, before there is a film; shows a film from now on; draws
 * it for the last time, where is_drawn, and forgets it: what is drawn stays. The film lives until then. Errors: those
 * of ag_view_create. */
ag_status progress_prepare_film(progress *p, ag_context *context, const ag_output_settings *output);
ag_status progress_show_film(progress *p, const ag_film *film);
void progress_leave_film(progress *p, bool is_drawn);

/* Takes the bar away, and a late answer of the terminal's. */
void progress_finish(progress *p);

#endif
