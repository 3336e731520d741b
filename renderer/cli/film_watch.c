/* film_watch.c: see film_watch.h. */
#define _POSIX_C_SOURCE 200809L
#include "film_watch.h"

#include "passes.h"

#include <math.h>
#include <stdlib.h>

/* A terminal that is slow to draw is drawn to less often: a worker waits for it. */
static const double LEAST_INTERVAL_SECONDS = 0.25, INTERVALS_PER_DRAWING = 20.0;

void film_watch_begin(film_watch *w, ag_view *view)
{
    film_watch_end(w);
    w->view = view;
}

void film_watch_end(film_watch *w)
{
    ag_view_destroy(w->view);
    free(w->pixels);
    free(w->shown);
    *w = (film_watch){0};
}

ag_status film_watch_show(film_watch *w, const ag_film *film)
{
    if (!w->view)
        return AG_OK;
    ag_film_pixels(film, &w->width, &w->height);
    const size_t count = 3 * (size_t)w->width * (size_t)w->height;
    w->pixels = calloc(count, sizeof *w->pixels);
    w->shown = calloc(count, sizeof *w->shown);
    w->film = w->pixels && w->shown ? film : NULL;
    return w->film ? AG_OK : AG_ERROR_MEMORY;
}

void film_watch_erase(film_watch *w, FILE *terminal)
{
    if (w->drawn_rows == 0)
        return;
    terminal_picture_erase(terminal, w->drawn_rows);
    w->drawn_rows = 0;
    w->version = 0; /* it is to be drawn again */
}

static void draw(film_watch *w, FILE *terminal, const terminal_size *size)
{
    int width, height;
    terminal_picture_fit(w->width, w->height, size, &width, &height);
    terminal_picture_reduce(w->pixels, w->width, w->height, w->shown, width, height);
    if (ag_view_apply(w->view, w->shown, (size_t)width * (size_t)height) != AG_OK)
        return;
    char *text;
    size_t length;
    FILE *made = open_memstream(&text, &length);
    if (!made)
        return;
    /* in a terminal of another size the rows have wrapped or gone: the picture begins anew below them */
    if (size->columns != w->drawn_in.columns || size->rows != w->drawn_in.rows)
        w->drawn_rows = 0;
    terminal_picture_erase(made, w->drawn_rows);
    w->drawn_rows = terminal_picture_write(made, w->shown, width, height);
    w->drawn_in = *size;
    if (fclose(made) == 0) /* at once: standard error has no buffer */
        fwrite(text, 1, length, terminal);
    free(text);
}

void film_watch_draw(film_watch *w, FILE *terminal, double now_seconds, bool is_last)
{
    terminal_size size;
    if (!w->film || (!is_last && now_seconds < w->next_seconds))
        return;
    const uint64_t version = ag_film_read_picture(w->film, w->version, w->pixels);
    const bool is_new = version != w->version;
    w->version = version;
    if ((is_new || is_last) && terminal_picture_room(fileno(terminal), &size)) {
        draw(w, terminal, &size);
        fflush(terminal);
    }
    w->next_seconds =
        now_seconds + fmax(LEAST_INTERVAL_SECONDS, INTERVALS_PER_DRAWING * (passes_seconds() - now_seconds));
}
