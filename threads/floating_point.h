/* floating_point.h: the floating-point state that all our arithmetic runs in: exceptions masked, round to nearest,
 * denormals flushed (FTZ and DAZ, as Embree's manual asks). It is set as a whole: what a caller or a library left there
 * would otherwise reach the picture. Threads: each has its own state. */
#ifndef AFTERGLOW_FLOATING_POINT_H
#define AFTERGLOW_FLOATING_POINT_H

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

/* Sets the state of this thread; gives what it was, for floating_point_leave. */
static inline unsigned floating_point_enter(void)
{
#if defined(__SSE__)
    enum { ALL_EXCEPTIONS_MASKED = 0x1f80, FLUSH_TO_ZERO = 0x8000, DENORMALS_ARE_ZERO = 0x0040 };
    unsigned before = _mm_getcsr();
    _mm_setcsr(ALL_EXCEPTIONS_MASKED | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO);
    return before;
#else
    return 0;
#endif
}

static inline void floating_point_leave(unsigned before)
{
#if defined(__SSE__)
    _mm_setcsr(before);
#else
    (void)before;
#endif
}

#endif
