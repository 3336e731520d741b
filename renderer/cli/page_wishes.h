/* page_wishes.h: what those ask for who watch the render in a browser: to stop and keep the picture, to see the scene
 * from elsewhere, to go back to the picture, to see a layer. A wish pauses the rendering, so that main looks here.
 * Flow: page_server (requests) -> [here] -> passes, walk. Threads: any; one lock, which is held for no work. */
#ifndef AFTERGLOW_PAGE_WISHES_H
#define AFTERGLOW_PAGE_WISHES_H

#include "afterglow/afterglow.h"

#include <pthread.h>
#include <stdbool.h>

/* From where, to where and which way up a camera looks, in world space. */
typedef struct page_place {
    float from[3], to[3], up[3];
} page_place;

typedef struct page_wishes {
    pthread_mutex_t lock; /* of all that follows */
    pthread_cond_t changed;
    ag_context *context; /* borrowed; whose rendering is to pause; NULL: there is none */
    bool wants_end;      /* to stop, and keep the picture */
    bool has_ended;      /* it was wished to stop at some time */
    bool wants_return;   /* from a walk to the picture */
    bool wants_move;     /* to this place */
    bool wants_layers;   /* to have layers copied from the film */
    page_place place;
    double heard_seconds; /* when there was a request last, as passes_seconds tells it; below 0: never */
} page_wishes;

/* Returns false where the system gives no lock. */
bool page_wishes_init(page_wishes *w);
void page_wishes_reset(page_wishes *w);

/* --- requests --- */
void page_wishes_end(page_wishes *w);
void page_wishes_return(page_wishes *w);
void page_wishes_move(page_wishes *w, const page_place *place);
void page_wishes_layers(page_wishes *w);
void page_wishes_hear(page_wishes *w);

/* --- main --- */
/* Sets the context whose rendering a wish pauses. NULL: none, and what was wished for is forgotten. A wish to end that
 * comes before there is a film is kept for the next one. */
void page_wishes_attend(page_wishes *w, ag_context *context);
/* Return whether there is such a wish. Those with `take` in their names also remove it. */
bool page_wishes_has_end(page_wishes *w);
/* Returns whether anybody has ever wished to stop, also for a picture before this one. */
bool page_wishes_has_ended(page_wishes *w);
bool page_wishes_has_move(page_wishes *w);
bool page_wishes_take_return(page_wishes *w);
bool page_wishes_take_move(page_wishes *w, page_place *out_place);
bool page_wishes_take_layers(page_wishes *w);
/* Returns when there is a wish, or after so many seconds. */
void page_wishes_wait(page_wishes *w, double seconds);
/* Returns whether somebody watches: there has been a request within so many seconds. */
bool page_wishes_is_watched(page_wishes *w, double seconds);

#endif
