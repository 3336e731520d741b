/* page_film.c: see page_film.h. */
#define _POSIX_C_SOURCE 200809L
#include "page_film.h"

#include "passes.h"
#include "status.h"

#include <stdlib.h>
#include <string.h>

/* After this time without a request for it a layer is no longer copied, and its memory is freed. */
static const double LAYER_SECONDS = 30.0;

bool page_film_init(page_film *f)
{
    *f = (page_film){.output = ag_default_output_settings()};
    return pthread_mutex_init(&f->lock, NULL) == 0;
}

static void free_view(page_view *view)
{
    ag_view_destroy(view->made);
    free(view->display);
    free(view->view);
    *view = (page_view){0};
}

/* Forgets all that belongs to the film and its context; the picture stays. */
static void forget_film(page_film *f)
{
    for (int i = 0; i < PAGE_VIEWS; i++)
        free_view(&f->views[i]);
    for (size_t i = 0; f->planes && i < f->layer_count; i++)
        free(f->planes[i].values);
    free(f->planes);
    free(f->layers);
    f->planes = NULL;
    f->layers = NULL;
    f->layer_count = 0;
    f->film = NULL;
    f->context = NULL;
    f->rendering = NULL;
}

void page_film_reset(page_film *f)
{
    forget_film(f);
    free(f->pixels);
    pthread_mutex_destroy(&f->lock);
}

/* --- main --- */

static void take_lock(page_film *f)
{
    atomic_store(&f->is_wanted_by_main, true);
    pthread_mutex_lock(&f->lock);
    atomic_store(&f->is_wanted_by_main, false);
}

/* Resizes a picture by its nearest pixels, to be shown until new ones come. */
static void copy_resized(const float *from, int from_width, int from_height, float *to, int width, int height)
{
    for (int y = 0; y < height; y++) {
        const float *row = from + 3 * (size_t)((long)y * from_height / height) * (size_t)from_width;
        for (int x = 0; x < width; x++, to += 3)
            memcpy(to, row + 3 * ((long)x * from_width / width), 3 * sizeof *to);
    }
}

static ag_status take_film(page_film *f, ag_context *context, const ag_rendering *rendering,
                           const ag_output_settings *output)
{
    const ag_film *film = ag_rendering_film(rendering);
    const char *display, *view;
    int width, height;
    const ag_view *first;
    forget_film(f);
    ag_film_pixels(film, &width, &height);
    if (width != f->width || height != f->height || !f->pixels) {
        float *before = f->pixels;
        f->pixels = calloc(3 * (size_t)width * (size_t)height, sizeof *f->pixels);
        if (before && f->pixels)
            copy_resized(before, f->width, f->height, f->pixels, width, height);
        free(before);
    }
    f->width = width;
    f->height = height;
    f->version = 0;
    f->turn++;
    f->output = *output;
    f->layers = page_layers_list(film, &f->layer_count);
    f->planes = calloc(f->layer_count + 1, sizeof *f->planes);
    if (!f->pixels || !f->layers || !f->planes)
        return AG_ERROR_MEMORY;
    f->film = film;
    f->context = context;
    f->rendering = rendering;
    AG_TRY(ag_color_view_at(context, 0, &display, &view));            /* from here on any thread may ask */
    return page_film_view(f, "", "", output->exposure_stops, &first); /* so that an error in the view shows at once */
}

ag_status page_film_show(page_film *f, ag_context *context, const ag_rendering *rendering,
                         const ag_output_settings *output)
{
    take_lock(f);
    const ag_status status = take_film(f, context, rendering, output);
    if (status != AG_OK)
        forget_film(f);
    pthread_mutex_unlock(&f->lock);
    return status;
}

static void copy_layer(page_film *f, const page_layer *layer, page_planes *planes)
{
    const size_t count = (size_t)f->width * (size_t)f->height;
    if (!planes->values)
        planes->values = malloc((size_t)layer->channel_count * count * sizeof *planes->values);
    for (int c = 0; planes->values && c < layer->channel_count; c++)
        if (ag_film_read_channel(f->film, layer->channels[c], planes->values + (size_t)c * count) != AG_OK)
            memset(planes->values + (size_t)c * count, 0, count * sizeof *planes->values);
    planes->version++;
}

void page_film_copy_layers(page_film *f)
{
    const double now = passes_seconds();
    take_lock(f);
    for (size_t i = 0; f->film && i < f->layer_count; i++) {
        page_planes *planes = &f->planes[i];
        if (planes->asked_seconds > 0.0 && now - planes->asked_seconds < LAYER_SECONDS) {
            copy_layer(f, &f->layers[i], planes);
        } else {
            free(planes->values);
            planes->values = NULL;
        }
    }
    pthread_mutex_unlock(&f->lock);
}

void page_film_end_rendering(page_film *f)
{
    take_lock(f);
    f->rendering = NULL;
    pthread_mutex_unlock(&f->lock);
}

void page_film_leave(page_film *f)
{
    take_lock(f);
    forget_film(f);
    pthread_mutex_unlock(&f->lock);
}

void page_film_empty(page_film *f)
{
    take_lock(f);
    forget_film(f);
    free(f->pixels);
    f->pixels = NULL;
    pthread_mutex_unlock(&f->lock);
}

/* --- requests --- */

bool page_film_begin(page_film *f)
{
    if (atomic_load(&f->is_wanted_by_main))
        return false;
    pthread_mutex_lock(&f->lock);
    if (f->film)
        return true;
    pthread_mutex_unlock(&f->lock);
    return false;
}

void page_film_end(page_film *f) { pthread_mutex_unlock(&f->lock); }

const page_layer *page_film_find(const page_film *f, const char *name)
{
    for (size_t i = 0; i < f->layer_count; i++)
        if (strcmp(f->layers[i].name, name) == 0)
            return &f->layers[i];
    return name[0] == '\0' && f->layer_count > 0 ? &f->layers[0] : NULL;
}

const float *page_film_values(page_film *f, const page_layer *layer, uint64_t *out_version)
{
    if (layer->kind == PAGE_LAYER_PICTURE) {
        f->version = ag_film_read_picture(f->film, f->version, f->pixels);
        *out_version = f->version;
        return f->pixels;
    }
    page_planes *planes = &f->planes[layer - f->layers];
    planes->asked_seconds = passes_seconds();
    *out_version = planes->version;
    return planes->values;
}

static bool is_same(const page_view *kept, const char *display, const char *view, float exposure_stops)
{
    return kept->made && kept->exposure_stops == exposure_stops && strcmp(kept->display, display) == 0 &&
           strcmp(kept->view, view) == 0;
}

ag_status page_film_view(page_film *f, const char *display, const char *view, float exposure_stops,
                         const ag_view **out_view)
{
    for (int i = 0; i < PAGE_VIEWS; i++)
        if (is_same(&f->views[i], display, view, exposure_stops)) {
            *out_view = f->views[i].made;
            return AG_OK;
        }
    ag_output_settings output = f->output;
    output.exposure_stops = exposure_stops;
    if (display[0]) {
        output.display = display;
        output.view = view[0] ? view : NULL;
    }
    page_view made = {.display = strdup(display), .view = strdup(view), .exposure_stops = exposure_stops};
    ag_status status = made.display && made.view ? ag_view_create(f->context, &output, &made.made) : AG_ERROR_MEMORY;
    if (status != AG_OK) {
        free_view(&made);
        return status;
    }
    page_view *kept = &f->views[f->next_view];
    f->next_view = (f->next_view + 1) % PAGE_VIEWS;
    free_view(kept);
    *kept = made;
    *out_view = kept->made;
    return AG_OK;
}
