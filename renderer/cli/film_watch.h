/* film_watch.h: a film that is shown in a terminal while it is rendered, through the view that a .png would have.
 * Flow: passes, progress -> [here] -> terminal_picture. Threads: one at a time, as progress sees to. */
#ifndef AFTERGLOW_FILM_WATCH_H
#define AFTERGLOW_FILM_WATCH_H

#include "afterglow/afterglow.h"
#include "sixel.h"
#include "terminal_picture.h"
#include "terminal_query.h"

#include <stdbool.h>
#include <stdio.h>

enum { FILM_WATCH_BYTES_PER_PIXEL = 6 * sizeof(float) + SIXEL_BYTES_PER_PIXEL }; /* with the two pictures below */

typedef struct film_watch {
    ag_view *view;                       /* owned; NULL: nothing is watched */
    const terminal_abilities *abilities; /* borrowed */
    const ag_film *film;                 /* borrowed; NULL: there is none to be shown */
    int width, height;                   /* the film's */
    float *pixels;                       /* owned: the film as it was read last */
    float *shown;                        /* owned: reduced, and seen through the view; as large as pixels */
    uint64_t version;                    /* of the pixels */
    double next_seconds;                 /* when the picture may be drawn again */
    int drawn_rows;                      /* that stand above the cursor's line; 0: none */
    terminal_size drawn_in;
} film_watch;

/* Takes the view over. abilities: those of the terminal, which live as long. */
void film_watch_begin(film_watch *w, ag_view *view, const terminal_abilities *abilities);
/* Forgets the view and the film; what is drawn stays. */
void film_watch_end(film_watch *w);

/* Shows this film from now on. Errors: AG_ERROR_MEMORY. */
ag_status film_watch_show(film_watch *w, const ag_film *film);

/* Draws the picture in place of the one before, where there is a new one and drawing has not just been done; is_last:
 * in any case. The cursor is then at the line below, which is empty. */
void film_watch_draw(film_watch *w, FILE *terminal, double now_seconds, bool is_last);
/* Leaves what is drawn where it stands: the next picture begins below the cursor. */
void film_watch_leave(film_watch *w);
/* Takes the picture away, so that a message can stand there. */
void film_watch_erase(film_watch *w, FILE *terminal);

#endif
