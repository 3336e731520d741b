/* film_copy.c: see film_copy.h. */
#include "film/film_copy.h"

#include <stdlib.h>
#include <string.h>

ag_status film_copy_take(ag_film *film, unsigned char **copy)
{
    film_plane planes[FILM_PLANES_MAX];
    const int count = film_planes(film, planes);
    size_t size = 0, at = 0;
    for (int i = 0; i < count; i++)
        size += planes[i].size;
    if (!*copy)
        *copy = malloc(size);
    if (!*copy)
        return AG_ERROR_MEMORY;
    for (int i = 0; i < count; i++, at += planes[i - 1].size)
        memcpy(*copy + at, planes[i].bytes, planes[i].size);
    return AG_OK;
}

void film_copy_restore(ag_film *film, const unsigned char *copy)
{
    film_plane planes[FILM_PLANES_MAX];
    const int count = film_planes(film, planes);
    size_t at = 0;
    for (int i = 0; i < count; i++, at += planes[i - 1].size)
        memcpy(planes[i].bytes, copy + at, planes[i].size);
    film_resolve(film);
}
