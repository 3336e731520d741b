/* public_structs.h: public structs of the size that a program was compiled with: see afterglow/structs.h.
 * Threads: pure functions. */
#ifndef AFTERGLOW_PUBLIC_STRUCTS_INTERNAL_H
#define AFTERGLOW_PUBLIC_STRUCTS_INTERNAL_H

#include <stddef.h>

/* Writes struct_size bytes: a filled struct where that is its size, else zeros after the size. */
void public_struct_write(const void *filled, size_t filled_size, void *out_struct, size_t struct_size);

/* Writes struct_size bytes of a struct that the library makes: the size itself, the members that both sides know, and
 * zeros beyond those of the library. made_size 0: all else is zeros. out_struct NULL: nothing is written. */
void public_struct_write_part(const void *made, size_t made_size, void *out_struct, size_t struct_size);

#endif
