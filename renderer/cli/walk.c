/* walk.c: see walk.h. */
#include "walk.h"

#include "passes.h"
#include "progress.h"
#include "signals.h"
#include "status.h"

#include <math.h>
#include <stdio.h>

/* After a move a coarse picture comes first, where that is worth it, with so many times fewer pixels in width and
 * height: it shows at once where the move has led. */
enum { REDUCTION = 4, WORTHWHILE_PIXELS = 1 << 15 };
/* The seconds that a pass takes, about, so that layers and counters follow. */
static const double PASS_SECONDS = 1.0;

page_notes walk_notes(ag_rendering *rendering, page_mode mode, int samples_most)
{
    page_notes n = {.mode = mode,
                    .samples = ag_rendering_sample_counts(rendering),
                    .samples_most = samples_most,
                    .noise = ag_rendering_noise(rendering).level,
                    .has_place = true,
                    .counts = ag_rendering_statistics(rendering)};
    ag_rendering_find_place(rendering, n.place.from, n.place.to, n.place.up, n.right, &n.fov_degrees);
    return n;
}

/* Where a walk is, and how far the picture there has come. */
typedef struct walk_state {
    ag_rendering *view; /* NULL: nowhere yet */
    page_place place;
    bool is_coarse;
    bool is_whole; /* no pass is under way */
    int samples;   /* that the next pass brings pixels to */
    bool is_done;
} walk_state;

/* Keeps the place as it was asked for, since the one computed back from the camera is rounded. */
static page_notes notes_of(const walk *w, const walk_state *s)
{
    page_notes n = walk_notes(s->view, PAGE_WALKING, w->samples_most);
    n.place = s->place;
    return n;
}

/* Goes to a place. Where the place makes no sense, says so in the log and stays. */
static ag_status go(const walk *w, const page_place *place, bool is_coarse, walk_state *s)
{
    ag_rendering *next = NULL;
    ag_status status =
        ag_rendering_create_view(w->beside, place->from, place->to, place->up, is_coarse ? REDUCTION : 1, &next);
    if (status == AG_ERROR_ARGUMENT)
        return AG_OK;
    AG_TRY(status);
    ag_rendering *before = s->view;
    *s = (walk_state){.view = next, .place = *place, .is_coarse = is_coarse, .samples = 1};
    const page_notes notes = notes_of(w, s);
    status = ag_rendering_keep_passes(next);
    if (status == AG_OK)
        status = page_server_show(w->o->page, w->context, next, &w->o->output, &notes);
    if (status != AG_OK)
        page_server_leave_film(w->o->page);
    ag_rendering_finish(before, NULL);
    return status;
}

/* Begins the whole picture, once the coarse one is there. */
static ag_status go_on(const walk *w, walk_state *s)
{
    const page_place place = s->place;
    return go(w, &place, false, s);
}

/* Renders a pass, or as much of it as there is before a wish. */
static ag_status refine(const walk *w, walk_state *s)
{
    const double begun = passes_seconds(), before = ag_rendering_sample_counts(s->view).mean;
    const ag_status status = ag_rendering_continue(s->view, s->samples);
    const ag_sample_counts counts = ag_rendering_sample_counts(s->view);
    s->is_whole = status == AG_OK;
    if (status != AG_OK)
        return status == AG_PAUSED ? AG_OK : status;
    const page_notes notes = notes_of(w, s);
    page_server_note(w->o->page, &notes);
    if (s->is_coarse)
        return page_wishes_has_move(page_server_wishes(w->o->page)) ? AG_OK : go_on(w, s);
    s->is_done = s->samples == w->samples_most;
    const double each = (passes_seconds() - begun) / fmax(counts.mean - before, 1e-9);
    const double more = fmin(fmax(1.0, PASS_SECONDS / fmax(each, 1e-9)), s->samples);
    const bool is_last = counts.most < s->samples || s->samples + more > w->samples_most;
    s->samples = is_last ? w->samples_most : s->samples + (int)more;
    return AG_OK;
}

/* Returns whether a walk is over without anything to keep. */
static bool is_over(const walk *w, page_wishes *wishes)
{
    return signals_stop() || page_wishes_take_return(wishes) || passes_seconds() >= w->o->deadline ||
           !page_wishes_is_watched(wishes, PAGE_PATIENCE_SECONDS);
}

/* Returns whether to stop, with samples that can be kept. */
static bool is_kept(page_wishes *wishes, walk_state *s)
{
    return s->view && !s->is_coarse && page_wishes_has_end(wishes) &&
           (ag_rendering_go_back(s->view) == AG_OK || s->is_whole);
}

static bool is_large(const ag_rendering *rendering)
{
    int width, height;
    ag_film_pixels(ag_rendering_film(rendering), &width, &height);
    return (size_t)width * (size_t)height >= WORTHWHILE_PIXELS;
}

static ag_status step(const walk *w, page_wishes *wishes, walk_state *s)
{
    page_place place;
    if (page_wishes_take_move(wishes, &place))
        AG_TRY(go(w, &place, is_large(w->beside), s));
    if (s->view && !s->is_done)
        AG_TRY(refine(w, s));
    else if (s->view)
        page_wishes_wait(wishes, PAGE_LOOK_SECONDS);
    if (page_wishes_take_layers(wishes))
        page_server_copy_layers(w->o->page);
    return AG_OK;
}

ag_status walk_run(const walk *w, ag_rendering **out_kept)
{
    page_wishes *wishes = page_server_wishes(w->o->page);
    walk_state s = {0};
    ag_status status = AG_OK;
    bool keeps = false;
    *out_kept = NULL;
    signals_set_timer(INFINITY); /* checkpoints are of the picture, not of a walk */
    do {
        status = step(w, wishes, &s);
        keeps = status == AG_OK && is_kept(wishes, &s);
    } while (status == AG_OK && !keeps && s.view && !is_over(w, wishes));
    if (keeps) {
        *out_kept = s.view;
        return AG_OK;
    }
    page_server_leave_film(w->o->page);
    ag_rendering_finish(s.view, NULL);
    if (status == AG_OK || status == AG_CANCELLED)
        return status;
    char text[256];
    snprintf(text, sizeof text, "--serve: the view from elsewhere is left: %s", ag_status_text(status));
    progress_log(w->o->told, AG_LOG_WARNING, text);
    return AG_OK;
}
