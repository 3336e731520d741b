/* large_alloc.c: see large_alloc.h. */
#define _DEFAULT_SOURCE
#include "large_alloc.h"

#include <stdint.h>
#include <stdlib.h>
#if defined(__linux__)
#include <sys/mman.h>
#endif

enum { SMALL_ALIGNMENT = 64, LARGE_PAGE = 1 << 21 };

void *large_alloc(size_t size_bytes)
{
    size_t alignment = size_bytes < LARGE_PAGE ? SMALL_ALIGNMENT : LARGE_PAGE;
    if (size_bytes > SIZE_MAX - alignment)
        return NULL;
    size_t whole = (size_bytes + SMALL_ALIGNMENT - 1) / SMALL_ALIGNMENT * SMALL_ALIGNMENT;
    void *memory = NULL;
    if (posix_memalign(&memory, alignment, whole ? whole : SMALL_ALIGNMENT) != 0)
        return NULL;
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    if (alignment == LARGE_PAGE)
        (void)madvise(memory, whole / LARGE_PAGE * LARGE_PAGE, MADV_HUGEPAGE); /* a wish: it may be refused */
#endif
    return memory;
}
