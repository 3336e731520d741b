/* film_copy.h: what samples have brought a film so far, put aside, to go back to.
 * Flow: render -> [here]. Threads: one, while no tiles run. */
#ifndef AFTERGLOW_FILM_COPY_H
#define AFTERGLOW_FILM_COPY_H

#include "film/film.h"

/* Copies the film's planes to *copy, which is made where it is NULL, and is to be freed. Errors: AG_ERROR_MEMORY. */
ag_status film_copy_take(struct ag_film *film, unsigned char **copy);
/* The planes are as they were then; resolved. */
void film_copy_restore(struct ag_film *film, const unsigned char *copy);

#endif
