/* page_picture.h: what a page shows, as a PNG: the picture or a layer, through a view. The last ones are kept, since
 * several pages may ask for them, and their number in all is bounded, those among them that slow readers still take.
 * Flow: requests -> [here] <- page_film. Threads: the server's alone. */
#ifndef AFTERGLOW_PAGE_PICTURE_H
#define AFTERGLOW_PAGE_PICTURE_H

#include "http_server.h"
#include "page_film.h"

enum { PAGE_PICTURES_KEPT = 3, PAGE_PICTURES_MOST = 12 };

/* A picture that is kept, with what it shows. */
typedef struct page_picture {
    char key[512];
    uint64_t turn, version;
    shared_bytes *png; /* NULL: this one is free */
} page_picture;

typedef struct page_pictures {
    page_film *film; /* borrowed */
    page_picture kept[PAGE_PICTURES_KEPT];
    int next; /* to be replaced */
    unsigned living;
} page_pictures;

void page_pictures_init(page_pictures *p, page_film *film);
void page_pictures_reset(page_pictures *p);

/* GET /picture: layer, display, view, exposure. is_lacking: the layer has yet to be copied, and the answer says so. */
http_answer page_pictures_answer(page_pictures *p, const http_request *request, bool *out_is_lacking);

#endif
