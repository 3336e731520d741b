/* walk.h: the scene seen from elsewhere, from place to place as who watches it in a browser goes, on the photon map of
 * the picture, which waits meanwhile.
 * Flow: passes -> [here] -> ag_rendering_create_view. Threads: main's. */
#ifndef AFTERGLOW_WALK_H
#define AFTERGLOW_WALK_H

#include "options.h"
#include "page_server.h"

typedef struct walk {
    ag_context *context;
    const options *o;     /* with a page */
    ag_rendering *beside; /* the picture */
    int samples_most;     /* of a pixel */
} walk;

/* Notes what there is of a rendering, for the page. */
page_notes walk_notes(ag_rendering *rendering, page_mode mode, int samples_most);

/* Goes wherever it is wished, until it is wished to return, nobody watches any more, a signal wants the end, or the
 * time is up: *out_kept is NULL then, and no film is shown. Or until it is wished to stop: then it is the view, for the
 * caller to finish, with the samples of its last complete pass. A view that fails, for want of memory say, is told of
 * as a warning, and is returned from. Errors: AG_CANCELLED. */
ag_status walk_run(const walk *w, ag_rendering **out_kept);

#endif
