/* avx512.h: what the kernels for AVX-512 share. For their own files alone, on x86-64. Threads: pure functions. */
#ifndef AFTERGLOW_AVX512_H
#define AFTERGLOW_AVX512_H

#include <immintrin.h>
#include <stdbool.h>

/* The instructions that a function may use. */
#define AVX512 __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,popcnt,bmi2")))

/* Returns whether the processor has all of those instructions. */
static inline bool avx512_is_there(void)
{
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("popcnt") && __builtin_cpu_supports("bmi2");
}

/* Returns the number of each of sixteen lanes. */
AVX512 static inline __m512i avx512_lanes(void)
{
    return _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

#endif
