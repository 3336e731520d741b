/* page_state.h: what a page tells beside the picture, as JSON: how far the work is, counters, threads, the camera; and
 * once for each film what can be chosen.
 * Flow: passes, walk (notes), progress -> [here] -> page_server. Threads: main notes, the server's reads; one lock. */
#ifndef AFTERGLOW_PAGE_STATE_H
#define AFTERGLOW_PAGE_STATE_H

#include "page_film.h"
#include "page_wishes.h"
#include "progress.h"

typedef enum page_mode {
    PAGE_WAITING,   /* no film is there yet */
    PAGE_RENDERING, /* the picture */
    PAGE_WALKING,   /* a view from elsewhere */
    PAGE_FINISHED   /* the picture is written */
} page_mode;

/* The state of the rendering, which the main thread notes between two passes. */
typedef struct page_notes {
    page_mode mode;
    ag_sample_counts samples; /* of the film that is shown */
    int samples_most;         /* that it is to have */
    double noise;             /* below 0: not known */
    bool has_place;
    page_place place;  /* of its camera */
    float right[3];    /* to the right in the picture */
    float fov_degrees; /* 0: the camera is not of a kind that --fov describes */
    ag_statistics counts;
} page_notes;

typedef struct page_state {
    pthread_mutex_t lock;
    page_notes notes;
    const progress *told; /* borrowed */
    int main_thread;
} page_state;

bool page_state_init(page_state *s, const progress *told);
void page_state_reset(page_state *s);
void page_state_note(page_state *s, const page_notes *notes);
bool page_state_has_place(page_state *s);
void page_state_set_mode(page_state *s, page_mode mode);

/* Returns the state as JSON, to be freed; NULL: no memory. film: of which the version is told. */
char *page_state_write(page_state *s, page_film *film, size_t *out_size);
/* Returns the layers, displays and views as JSON; NULL where there is no film, too. */
char *page_state_write_choices(page_film *film, size_t *out_size);

#endif
