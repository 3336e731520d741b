/* page_server.c: see page_server.h. */
#define _POSIX_C_SOURCE 200809L
#include "page_server.h"

#include "http_server.h"
#include "option_values.h"
#include "page_html.h"
#include "page_picture.h"
#include "page_pixel.h"
#include "status.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OK = 200, NO_CONTENT = 204, BAD_REQUEST = 400, NOT_FOUND = 404, NOT_ALLOWED = 405, UNAVAILABLE = 503 };

struct page_server {
    http_server *http;
    page_film film;
    page_wishes wishes;
    page_state state;
    page_pictures pictures;
};

/* --- requests --- */

static http_answer say(unsigned status, const char *text) { return (http_answer){.status = status, .text = text}; }

static http_answer answer_page(page_server *s, const http_request *request)
{
    (void)s, (void)request;
    return (http_answer){.status = OK, .type = "text/html; charset=utf-8", .text = (const char *)page_html};
}

static http_answer json(char *text, size_t size)
{
    shared_bytes *held = shared_bytes_take((unsigned char *)text, size, NULL);
    return held ? (http_answer){.status = OK, .type = "application/json", .held = held}
                : say(UNAVAILABLE, "There is nothing to tell now: ask again.\n");
}

static http_answer answer_state(page_server *s, const http_request *request)
{
    size_t size = 0;
    char *text = page_state_write(&s->state, &s->film, &size);
    (void)request;
    page_wishes_hear(&s->wishes);
    return json(text, size);
}

static http_answer answer_choices(page_server *s, const http_request *request)
{
    size_t size = 0;
    char *text = page_state_write_choices(&s->film, &size);
    (void)request;
    return json(text, size);
}

static http_answer answer_picture(page_server *s, const http_request *request)
{
    bool is_lacking;
    const http_answer answer = page_pictures_answer(&s->pictures, request, &is_lacking);
    if (is_lacking)
        page_wishes_layers(&s->wishes);
    return answer;
}

static http_answer answer_pixel(page_server *s, const http_request *request)
{
    bool is_lacking;
    const http_answer answer = page_pixel_answer(&s->film, request, &is_lacking);
    if (is_lacking)
        page_wishes_layers(&s->wishes);
    return answer;
}

static http_answer answer_stop(page_server *s, const http_request *request)
{
    (void)request;
    page_wishes_end(&s->wishes);
    return say(NO_CONTENT, "");
}

/* Parses a place, nine numbers with commas between: from, to and up. */
static http_answer answer_camera(page_server *s, const http_request *request)
{
    enum { NUMBERS = 9 };
    float numbers[NUMBERS];
    page_place place;
    int count = 0;
    if (!parse_floats(request->body, NUMBERS, numbers, &count) || count != NUMBERS)
        return say(BAD_REQUEST, "A camera is nine numbers: from, to and up.\n");
    if (!page_state_has_place(&s->state))
        return say(UNAVAILABLE, "There is no picture yet that could be seen from elsewhere.\n");
    memcpy(place.from, numbers, sizeof place.from);
    memcpy(place.to, numbers + 3, sizeof place.to);
    memcpy(place.up, numbers + 6, sizeof place.up);
    page_wishes_move(&s->wishes, &place);
    return say(NO_CONTENT, "");
}

static http_answer answer_return(page_server *s, const http_request *request)
{
    (void)request;
    page_wishes_return(&s->wishes);
    return say(NO_CONTENT, "");
}

/* A path, and the function that answers it; a request that changes something is a POST. */
static const struct {
    const char *path;
    bool is_post;
    http_answer (*answer)(page_server *s, const http_request *request);
} ROUTES[] = {
    {"/", false, answer_page},           {"/state", false, answer_state},  {"/choices", false, answer_choices},
    {"/picture", false, answer_picture}, {"/pixel", false, answer_pixel},  {"/stop", true, answer_stop},
    {"/camera", true, answer_camera},    {"/return", true, answer_return},
};

static http_answer answer(void *user, const http_request *request)
{
    for (size_t i = 0; i < sizeof ROUTES / sizeof *ROUTES; i++)
        if (strcmp(request->path, ROUTES[i].path) == 0)
            return request->is_post == ROUTES[i].is_post
                       ? ROUTES[i].answer(user, request)
                       : say(NOT_ALLOWED,
                             ROUTES[i].is_post ? "This is asked for by POST.\n" : "This is asked for by GET.\n");
    return say(NOT_FOUND, "There is no such page.\n");
}

/* --- main --- */

static bool init_parts(page_server *s, const progress *told)
{
    if (!page_film_init(&s->film))
        return false;
    if (page_wishes_init(&s->wishes)) {
        if (page_state_init(&s->state, told))
            return true;
        page_wishes_reset(&s->wishes);
    }
    page_film_reset(&s->film);
    return false;
}

static void reset_parts(page_server *s)
{
    page_pictures_reset(&s->pictures);
    page_state_reset(&s->state);
    page_wishes_reset(&s->wishes);
    page_film_reset(&s->film);
}

ag_status page_server_start(const char *address, int port, const progress *told, page_server **out_server)
{
    char url[512], why[256];
    page_server *s = calloc(1, sizeof *s);
    if (!s || !init_parts(s, told)) {
        free(s);
        fprintf(stderr, "afterglow: error: --serve: %s\n", ag_status_text(AG_ERROR_MEMORY));
        return AG_ERROR_MEMORY;
    }
    page_pictures_init(&s->pictures, &s->film);
    s->http = http_server_start(address, port, answer, s, url, sizeof url, why, sizeof why);
    if (!s->http) {
        fprintf(stderr, "afterglow: error: --serve: cannot listen at %s, port %d: %s\n", address, port, why);
        reset_parts(s);
        free(s);
        return AG_ERROR_SYSTEM;
    }
    fprintf(stderr, "afterglow: the picture is at %s\n", url);
    *out_server = s;
    return AG_OK;
}

void page_server_stop(page_server *server)
{
    if (!server)
        return;
    http_server_stop(server->http);
    reset_parts(server);
    free(server);
}

ag_status page_server_show(page_server *server, ag_context *context, const ag_rendering *rendering,
                           const ag_output_settings *output, const page_notes *notes)
{
    if (!server)
        return AG_OK;
    page_state_note(&server->state, notes);
    AG_TRY(page_film_show(&server->film, context, rendering, output));
    page_wishes_attend(&server->wishes, context);
    return AG_OK;
}

void page_server_note(page_server *server, const page_notes *notes)
{
    if (!server)
        return;
    page_state_note(&server->state, notes);
    page_film_copy_layers(&server->film);
}

void page_server_copy_layers(page_server *server) { page_film_copy_layers(&server->film); }

void page_server_set_mode(page_server *server, page_mode mode)
{
    if (server)
        page_state_set_mode(&server->state, mode);
}

void page_server_end_rendering(page_server *server)
{
    if (server)
        page_film_end_rendering(&server->film);
}

void page_server_leave_film(page_server *server) { page_film_leave(&server->film); }

void page_server_empty_film(page_server *server) { page_film_empty(&server->film); }

void page_server_leave(page_server *server, page_mode mode)
{
    if (!server)
        return;
    page_wishes_attend(&server->wishes, NULL);
    page_film_leave(&server->film);
    page_state_set_mode(&server->state, mode);
}

page_wishes *page_server_wishes(page_server *server) { return &server->wishes; }
