/* page_pixel.h: what a pixel of the picture is, for who points at it: the values of a layer, and by Cryptomatte the
 * objects and materials there.
 * Flow: requests -> [here] <- page_film. Threads: the server's alone. */
#ifndef AFTERGLOW_PAGE_PIXEL_H
#define AFTERGLOW_PAGE_PIXEL_H

#include "http_server.h"
#include "page_film.h"

/* GET /pixel: x, y from the upper left, layer. is_lacking: layers have yet to be copied, and the answer says so. */
http_answer page_pixel_answer(page_film *film, const http_request *request, bool *out_is_lacking);

#endif
