/* film_copy.c: see film_copy.h. */
#include "film/film_copy.h"

#include <stdlib.h>
#include <string.h>

ag_status film_copy_take(ag_film *film, unsigned char **in_out_copy)
{
    film_plane planes[FILM_PLANES_MAX];
    const int count = film_planes(film, planes);
    size_t size = 0, at = 0;
    for (int i = 0; i < count; i++)
        size += planes[i].size;
    if (!*in_out_copy)
        *in_out_copy = malloc(size);
    if (!*in_out_copy)
        return AG_ERROR_MEMORY;
    for (int i = 0; i < count; i++, at += planes[i - 1].size)
        memcpy(*in_out_copy + at, planes[i].bytes, planes[i].size);
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
