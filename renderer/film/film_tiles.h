/* film_tiles.h: the developed picture as others see it while it is rendered: its tiles, each with the version that
 * tells whether it has changed, behind one lock that is held for no longer than it takes to copy a tile. Flow:
 * render_tiles -> [here] -> ag_film_read_tile. Threads: film_show by the thread that owns the pixels, of others than
 * those of any other call; reading by any thread. */
#ifndef AFTERGLOW_FILM_TILES_H
#define AFTERGLOW_FILM_TILES_H

#include "film/film.h"

/* Makes all tiles of a picture of that many pixels, which is black. Returns NULL when out of memory. */
film_tiles *film_tiles_create(int width, int height);
void film_tiles_destroy(film_tiles *tiles); /* NULL is fine */

/* Develops the pixels of an area of the full picture, as far as the film's crop has them, for all to see. */
void film_show(struct ag_film *film, film_area area);

/* Between the two nobody else sees the pixels, and all of them count as changed afterwards. */
void film_tiles_begin_change(film_tiles *tiles);
void film_tiles_end_change(film_tiles *tiles);

#endif
