/* borrowed_arrays.h: whether the arrays that meshes borrow are still there: a host may have freed them.
 * Flow: a host's arrays -> shape -> [here] -> renderer, before it reads them again. Threads: any. */
#ifndef AFTERGLOW_BORROWED_ARRAYS_H
#define AFTERGLOW_BORROWED_ARRAYS_H

#include "shape/shape.h"

/* Notes how the borrowed arrays begin and end. No effect on a shape that borrows none. */
void borrowed_arrays_note(shape *s);
/* Returns whether all borrowed arrays can be read; true where none is borrowed. */
bool borrowed_arrays_are_mapped(const shape *s);
/* Returns whether borrowed arrays cannot be read any more, or begin or end with other bytes than were noted, since
 * allocators write there when an array is freed. Other writes are not seen; shape_hash_borrowed, which reads all bytes,
 * sees them. */
bool borrowed_arrays_are_lost(const shape *s);

#endif
