/* room_file.h: one of the forty rooms as a scene file in the pbrt-v4 format, self-contained.
 * Holds all that the paper does not say: reflectances, light power, camera; perf/pictures.md lists them.
 * Flow: room_layout -> [here] -> the renderer. Threads: any, on different paths. */
#ifndef AFTERGLOW_ROOM_FILE_H
#define AFTERGLOW_ROOM_FILE_H

#include "rooms/room_layout.h"

#include <stddef.h>

#define ROOM_PHOTON_COUNT 500000 /* that the global map is to hold, as in the paper */

/* The name of room number's file within its folder, "room-07.pbrt"; size at least 32 bytes. */
void room_file_name(int number, char *out_name, size_t size);

/* Writes the room that holds spheres[0 .. sphere_count). gather_samples >= 1 rays at each gather point.
 * An existing file is replaced. Errors: AG_ERROR_OUTPUT, with errno set. */
ag_status room_file_write(const char *path, const room_sphere *spheres, int sphere_count, int gather_samples);

#endif
