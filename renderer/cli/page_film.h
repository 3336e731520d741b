/* page_film.h: the film that a page shows, for main and for requests: the picture as it is at any time, layers as main
 * has copied them last between two passes, for requests that have asked for them; and the views of OpenColorIO that
 * they are seen through.
 * Flow: passes, walk -> [here] -> page_picture. Threads: main and the server's; one lock, which a request may hold for
 * as long as a picture takes to be made. Main takes it where a film comes or goes, and requests stand back then. */
#ifndef AFTERGLOW_PAGE_FILM_H
#define AFTERGLOW_PAGE_FILM_H

#include "page_layers.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>

enum { PAGE_VIEWS = 4 }; /* kept at once */

/* A view that is kept, with what it was made of. */
typedef struct page_view {
    char *display, *view; /* owned; "": as the command line says */
    float exposure_stops;
    ag_view *made; /* owned; NULL: this one is free */
} page_view;

/* A layer's values, as they were copied last. */
typedef struct page_planes {
    float *values;        /* owned, [channel_count * pixels]; NULL: none */
    uint64_t version;     /* of the copies, from 1 on */
    double asked_seconds; /* when they were last asked for, as passes_seconds tells it; 0: never */
} page_planes;

typedef struct page_film {
    pthread_mutex_t lock; /* of all but the next */
    atomic_bool is_wanted_by_main;
    const ag_film *film;           /* borrowed; NULL: there is none */
    ag_context *context;           /* borrowed; NULL: there is none */
    const ag_rendering *rendering; /* borrowed: the rendering of the film; NULL: it has ended */
    ag_output_settings output;     /* the command line's: display, view, look, exposure */
    uint64_t turn;                 /* which of the films it is, from 1 on */
    int width, height;
    float *pixels;    /* owned: the picture as it was read last */
    uint64_t version; /* of those */
    page_layer *layers;
    size_t layer_count;
    page_planes *planes; /* [layer_count] */
    page_view views[PAGE_VIEWS];
    int next_view; /* to be replaced */
} page_film;

bool page_film_init(page_film *f);
void page_film_reset(page_film *f);

/* --- main --- */

/* Shows this rendering's film until page_film_leave. What was shown before stays, in the new size, until there are new
 * tiles over it. Errors: AG_ERROR_MEMORY, those of ag_view_create. */
ag_status page_film_show(page_film *f, ag_context *context, const ag_rendering *rendering,
                         const ag_output_settings *output);
/* To be called before the rendering ends; its film stays. */
void page_film_end_rendering(page_film *f);
/* Copies the layers that were asked for in the last half minute; not while the film is being rendered. Without memory
 * there are none. */
void page_film_copy_layers(page_film *f);
void page_film_leave(page_film *f);
/* Does what page_film_leave does, and frees all memory. */
void page_film_empty(page_film *f);

/* --- requests: between the two calls of each; begin is false where there is no film, or main waits --- */
bool page_film_begin(page_film *f);
void page_film_end(page_film *f);

/* Returns the layer of that name; NULL: there is none. "": the picture. */
const page_layer *page_film_find(const page_film *f, const char *name);
/* Returns the layer's values as planes, or for the picture its pixels, and their version; NULL: they have yet to be
 * copied. */
const float *page_film_values(page_film *f, const page_layer *layer, uint64_t *out_version);
/* Returns a view; display and view "": those of the command line. Errors: those of ag_view_create. */
ag_status page_film_view(page_film *f, const char *display, const char *view, float exposure_stops,
                         const ag_view **out_view);

#endif
