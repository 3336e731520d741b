/* large_alloc.h: memory that is read here and there: on large pages where the system gives them, so that finding where
 * a page is does not cost more than reading it (12 MB of photons are 3,000 small pages).
 * Rests on: madvise(2), MADV_HUGEPAGE; elsewhere it is aligned_alloc alone. Threads: any. */
#ifndef AFTERGLOW_LARGE_ALLOC_H
#define AFTERGLOW_LARGE_ALLOC_H

#include <stddef.h>

/* Aligned to 64 bytes at least, contents undefined; for free(). NULL when out of memory. */
void *large_alloc(size_t size_bytes);

#endif
