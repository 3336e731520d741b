/* page_picture.c: see page_picture.h. */
#include "page_picture.h"

#include "option_values.h"
#include "png_picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OK = 200, BAD_REQUEST = 400, NOT_FOUND = 404, UNAVAILABLE = 503 };

static http_answer refusal(unsigned status, const char *text) { return (http_answer){.status = status, .text = text}; }

void page_pictures_init(page_pictures *p, page_film *film) { *p = (page_pictures){.film = film}; }

void page_pictures_reset(page_pictures *p)
{
    for (int i = 0; i < PAGE_PICTURES_KEPT; i++)
        shared_bytes_drop(p->kept[i].png);
}

/* The picture that a request asks for. */
typedef struct asked_picture {
    const page_layer *layer;
    const char *display, *view;
    float exposure_stops;
    char key[sizeof((page_picture *)0)->key];
} asked_picture;

/* A display with one of its views, of those that the config has. */
static bool is_known_view(ag_context *context, const char *display, const char *view)
{
    const char *display_there, *view_there;
    if (!display[0] && !view[0])
        return true;
    for (size_t i = 0; ag_color_view_at(context, i, &display_there, &view_there) == AG_OK; i++)
        if (strcmp(display, display_there) == 0 && strcmp(view, view_there) == 0)
            return true;
    return false;
}

/* A refusal for an answer; status 0: there is nothing wrong. */
static http_answer parse(const page_film *film, const http_request *request, asked_picture *out)
{
    const char *layer = http_request_value(request, "layer"), *display = http_request_value(request, "display"),
               *view = http_request_value(request, "view"), *exposure = http_request_value(request, "exposure");
    *out = (asked_picture){.layer = page_film_find(film, layer ? layer : ""),
                           .display = display ? display : "",
                           .view = view ? view : "",
                           .exposure_stops = film->output.exposure_stops};
    if (!out->layer)
        return refusal(NOT_FOUND, "There is no such layer.\n");
    if (exposure && !(parse_float(exposure, &out->exposure_stops) && fabsf(out->exposure_stops) <= 100.0f))
        return refusal(BAD_REQUEST, "The exposure is a number of stops.\n");
    if (!is_known_view(film->context, out->display, out->view))
        return refusal(NOT_FOUND, "There is no such display and view.\n");
    const int length = snprintf(out->key, sizeof out->key, "%s\n%s\n%s\n%a", out->layer->name, out->display, out->view,
                                (double)out->exposure_stops);
    return length < (int)sizeof out->key ? (http_answer){0} : refusal(BAD_REQUEST, "These names are too long.\n");
}

/* Makes pixels of a layer's values: colours stay as they are, page_layer_draw makes colours of all else. */
static void fill_pixels(const page_film *film, const page_layer *layer, const float *values, float *out)
{
    const size_t count = (size_t)film->width * (size_t)film->height;
    if (layer->kind == PAGE_LAYER_PICTURE) {
        memcpy(out, values, 3 * count * sizeof *out);
    } else if (layer->kind == PAGE_LAYER_COLOR) {
        for (size_t c = 0; c < 3; c++)
            for (size_t i = 0; i < count; i++)
                out[3 * i + c] = values[(c < (size_t)layer->channel_count ? c : 0) * count + i];
    } else {
        page_layer_draw(layer, values, count, out);
    }
}

static shared_bytes *make_png(page_pictures *p, const asked_picture *asked, const float *values)
{
    page_film *film = p->film;
    const size_t count = (size_t)film->width * (size_t)film->height;
    const bool is_seen = asked->layer->kind == PAGE_LAYER_PICTURE || asked->layer->kind == PAGE_LAYER_COLOR;
    const ag_view *view;
    size_t size;
    float *pixels = malloc(3 * count * sizeof *pixels);
    if (!pixels)
        return NULL;
    fill_pixels(film, asked->layer, values, pixels);
    const bool is_shown =
        !is_seen || (page_film_view(film, asked->display, asked->view, asked->exposure_stops, &view) == AG_OK &&
                     ag_view_apply(view, pixels, count) == AG_OK);
    unsigned char *png = is_shown ? png_picture_encode(pixels, film->width, film->height, &size) : NULL;
    free(pixels);
    return png ? shared_bytes_take(png, size, &p->living) : NULL;
}

static http_answer show(shared_bytes *png)
{
    return (http_answer){.status = OK, .type = "image/png", .held = shared_bytes_hold(png)};
}

static http_answer answer_of_film(page_pictures *p, const http_request *request, bool *out_is_lacking)
{
    asked_picture asked;
    uint64_t version;
    const http_answer refused = parse(p->film, request, &asked);
    if (refused.status != 0)
        return refused;
    const float *values = page_film_values(p->film, asked.layer, &version);
    *out_is_lacking = !values;
    if (!values)
        return refusal(UNAVAILABLE, "The layer is on its way: ask again.\n");
    for (int i = 0; i < PAGE_PICTURES_KEPT; i++) {
        const page_picture *kept = &p->kept[i];
        if (kept->png && kept->turn == p->film->turn && kept->version == version && strcmp(kept->key, asked.key) == 0)
            return show(kept->png);
    }
    if (p->living >= PAGE_PICTURES_MOST)
        return refusal(UNAVAILABLE, "Too many pictures are on their way to slow readers: ask again.\n");
    shared_bytes *png = make_png(p, &asked, values);
    if (!png)
        return refusal(UNAVAILABLE, "The picture cannot be made: there is no memory, or the view has failed.\n");
    page_picture *kept = &p->kept[p->next];
    p->next = (p->next + 1) % PAGE_PICTURES_KEPT;
    shared_bytes_drop(kept->png);
    *kept = (page_picture){.turn = p->film->turn, .version = version, .png = png};
    memcpy(kept->key, asked.key, sizeof kept->key);
    return show(png);
}

http_answer page_pictures_answer(page_pictures *p, const http_request *request, bool *out_is_lacking)
{
    *out_is_lacking = false;
    if (!page_film_begin(p->film))
        return refusal(UNAVAILABLE, "There is no picture now: ask again.\n");
    const http_answer answer = answer_of_film(p, request, out_is_lacking);
    page_film_end(p->film);
    return answer;
}
