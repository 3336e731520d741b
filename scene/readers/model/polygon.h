/* polygon.h: plane polygons, concave ones too, cut into triangles.
 * Rests on: Meisters, "Polygons have ears", American Mathematical Monthly 82, 1975. Flow: obj_file. Threads: pure. */
#ifndef AFTERGLOW_POLYGON_H
#define AFTERGLOW_POLYGON_H

#include "math/vec3.h"

#include <stddef.h>
#include <stdint.h>

/* Twice the area, along the normal around which the corners run counter-clockwise (Newell's). */
void polygon_area_vector(const vec3 *corners, size_t count, double out_vector[3]);

/* Cuts count >= 3 corners into count - 2 triangles: 3 * (count - 2) numbers of corners. A convex polygon is cut into
 * the fan around its first corner; so is one that no ear can be cut off, or of more than 4096 corners. scratch has room
 * for count numbers. */
void polygon_triangulate(const vec3 *corners, size_t count, uint32_t *scratch, uint32_t *out_corners);

#endif
