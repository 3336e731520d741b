/* public_structs.h: public structs of the size that a program was compiled with: see afterglow/structs.h.
 * Threads: pure functions. */
#ifndef AFTERGLOW_PUBLIC_STRUCTS_INTERNAL_H
#define AFTERGLOW_PUBLIC_STRUCTS_INTERNAL_H

#include <stddef.h>

/* Writes struct_size bytes: a filled struct where that is its size, else zeros after the size. */
void public_struct_write(const void *filled, size_t filled_size, void *out_struct, size_t struct_size);

#endif
