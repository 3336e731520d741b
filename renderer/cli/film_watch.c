/* film_watch.c: see film_watch.h. */
#define _POSIX_C_SOURCE 200809L
#include "film_watch.h"

#include "passes.h"

#include <math.h>
#include <stdlib.h>

/* A terminal that is slow to draw is drawn to less often: a worker waits for it. */
static const double LEAST_INTERVAL_SECONDS = 0.25, INTERVALS_PER_DRAWING = 20.0;

void film_watch_begin(film_watch *w, ag_view *view, const terminal_abilities *abilities)
{
    film_watch_end(w);
    w->view = view;
    w->abilities = abilities;
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

void film_watch_leave(film_watch *w)
{
    w->drawn_rows = 0;
    w->version = 0; /* it is to be drawn again */
}

void film_watch_erase(film_watch *w, FILE *terminal)
{
    if (w->drawn_rows == 0)
        return;
    terminal_picture_erase(terminal, w->drawn_rows);
    film_watch_leave(w);
}

/* Fills in the size of a character where the system does not tell it with the window's size: the terminal's answer from
 * the beginning stands in, though the characters may have changed since. */
static void complete_size(const terminal_abilities *abilities, terminal_size *in_out_size)
{
    if (in_out_size->cell_width > 0 && in_out_size->cell_height > 0)
        return;
    in_out_size->cell_width = abilities->cell_width;
    in_out_size->cell_height = abilities->cell_height;
}

static bool is_same_size(const terminal_size *a, const terminal_size *b)
{
    return a->columns == b->columns && a->rows == b->rows && a->cell_width == b->cell_width &&
           a->cell_height == b->cell_height;
}

/* Draws the picture, and returns how many rows it has; 0: it could not be made. drawn_rows: those of the picture in
 * whose place it is drawn. */
static int write_picture(const film_watch *w, FILE *made, const terminal_size *size, int width, int height,
                         bool is_by_sixels, int drawn_rows)
{
    if (is_by_sixels)
        return terminal_picture_write_sixels(made, w->shown, width, height, size, w->abilities->color_count,
                                             drawn_rows);
    terminal_picture_erase(made, drawn_rows);
    return terminal_picture_write(made, w->shown, width, height);
}

static void draw(film_watch *w, FILE *terminal, terminal_size *size)
{
    int width, height;
    complete_size(w->abilities, size);
    const bool is_by_sixels = w->abilities->has_sixels && size->cell_width > 0 && size->cell_height > 0;
    terminal_picture_fit(w->width, w->height, size, is_by_sixels, &width, &height);
    terminal_picture_reduce(w->pixels, w->width, w->height, w->shown, width, height);
    if (ag_view_apply(w->view, w->shown, (size_t)width * (size_t)height) != AG_OK)
        return;
    char *text = NULL;
    size_t length;
    FILE *made = open_memstream(&text, &length);
    if (!made)
        return;
    /* after the terminal has changed its size, rows are wrapped or gone: the picture begins anew below them */
    const int drawn_rows = is_same_size(size, &w->drawn_in) ? w->drawn_rows : 0;
    const int rows = write_picture(w, made, size, width, height, is_by_sixels, drawn_rows);
    if (fclose(made) == 0 && rows > 0) { /* written at once, since standard error has no buffer */
        fwrite(text, 1, length, terminal);
        w->drawn_rows = rows;
        w->drawn_in = *size;
    }
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
