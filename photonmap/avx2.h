/* avx2.h: what the loops for AVX2 share. For their own files alone, on x86-64. Threads: pure functions. */
#ifndef AFTERGLOW_AVX2_H
#define AFTERGLOW_AVX2_H

#include <immintrin.h>
#include <stdbool.h>

/* The instructions that a function may use. */
#define AVX2 __attribute__((target("avx2,popcnt")))

/* Returns whether the processor has all of those instructions. */
static inline bool avx2_is_there(void) { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt"); }

#endif
