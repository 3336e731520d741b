/* page_server.h: --serve: a page in a browser that shows the picture while it is rendered, tells how far it is, and
 * takes wishes: to stop and keep, and to look from elsewhere. What is written is what the command line names; no
 * request names a file.
 * Flow: main, passes, walk -> [here] -> http_server. Threads: main calls; requests are answered on a thread of the
 * server's, which no worker ever waits for. */
#ifndef AFTERGLOW_PAGE_SERVER_H
#define AFTERGLOW_PAGE_SERVER_H

#include "page_picture.h"
#include "page_state.h"
#include "page_wishes.h"

/* Seconds without a request after which nobody watches any more: a page that is seen asks twice a second. */
#define PAGE_PATIENCE_SECONDS 15.0
/* The seconds between two looks at signals while wishes are waited for. */
#define PAGE_LOOK_SECONDS 0.1

/* Bytes per pixel of a picture that is viewed: the picture, its copy under a view, a PNG under way, and those that are
 * kept. Another layer that is viewed takes 4 for each of its channels, and none where memory is short. */
enum { PAGE_BYTES_PER_PIXEL = 12 + 12 + 2 * 3 + 3 * PAGE_PICTURES_KEPT };

typedef struct page_server page_server;

/* Begins to listen, and tells the page's URL on standard error. Errors, with a message there: AG_ERROR_SYSTEM (it
 * cannot listen there, or there is no thread), AG_ERROR_MEMORY. */
ag_status page_server_start(const char *address, int port, const progress *told, page_server **out_server);
/* Ends all connections. server NULL is fine, here and below. */
void page_server_stop(page_server *server);

/* Shows a rendering of the context, and pauses it for wishes; borrowed until page_server_leave. Errors: those of
 * page_film_show. */
ag_status page_server_show(page_server *server, ag_context *context, const ag_rendering *rendering,
                           const ag_output_settings *output, const page_notes *notes);
/* To be called before the rendering ends; its film is still shown. */
void page_server_end_rendering(page_server *server);
/* Notes the state after a pass or in a pause, when no rendering is under way, and copies layers. */
void page_server_note(page_server *server, const page_notes *notes);
/* Copies layers alone, when no rendering is under way. */
void page_server_copy_layers(page_server *server);
void page_server_set_mode(page_server *server, page_mode mode);
/* Lets go of the film alone: another one is shown at once. */
void page_server_leave_film(page_server *server);
/* Lets go of the film, and of the memory that showing it takes. */
void page_server_empty_film(page_server *server);
/* Lets go of the film and the context; mode: what the page says meanwhile. */
void page_server_leave(page_server *server, page_mode mode);

/* Returns the wishes of those who watch. server: not NULL. */
page_wishes *page_server_wishes(page_server *server);

#endif
