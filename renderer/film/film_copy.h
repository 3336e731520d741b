/* film_copy.h: what samples have brought a film so far, put aside, to go back to.
 * Flow: render -> [here]. Threads: one, while no tiles run. */
#ifndef AFTERGLOW_FILM_COPY_H
#define AFTERGLOW_FILM_COPY_H

#include "film/film.h"

/* Copies the film's planes to *in_out_copy, which is made where it is NULL, and is to be freed. Errors:
 * AG_ERROR_MEMORY. */
ag_status film_copy_take(struct ag_film *film, unsigned char **in_out_copy);
/* Gives the planes the values of a copy, and resolves the film. */
void film_copy_restore(struct ag_film *film, const unsigned char *copy);

#endif
