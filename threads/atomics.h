/* atomics.h: C11 atomics under names that carry the memory order, so that every ordering decision can be read at its
 * call. Each use says with whom it pairs. Threads: any. */
#ifndef AFTERGLOW_ATOMICS_H
#define AFTERGLOW_ATOMICS_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define AFTERGLOW_TSAN 1
#endif
#elif defined(__SANITIZE_THREAD__)
#define AFTERGLOW_TSAN 1
#endif
/* Declared by hand: with gcc, <sanitizer/tsan_interface.h> defines __has_feature, as if this were clang. */
#ifdef AFTERGLOW_TSAN
void __tsan_acquire(void *address);
void __tsan_release(void *address);
#endif

typedef _Atomic uint8_t atomic_u8;
typedef _Atomic uint32_t atomic_u32;
typedef _Atomic uint64_t atomic_u64;

static inline uint8_t load_relaxed_u8(const atomic_u8 *a) { return atomic_load_explicit(a, memory_order_relaxed); }
static inline void store_relaxed_u8(atomic_u8 *a, uint8_t v) { atomic_store_explicit(a, v, memory_order_relaxed); }

static inline uint32_t load_relaxed_u32(const atomic_u32 *a) { return atomic_load_explicit(a, memory_order_relaxed); }
static inline uint32_t load_acquire_u32(const atomic_u32 *a) { return atomic_load_explicit(a, memory_order_acquire); }
static inline void store_relaxed_u32(atomic_u32 *a, uint32_t v) { atomic_store_explicit(a, v, memory_order_relaxed); }
static inline void store_release_u32(atomic_u32 *a, uint32_t v) { atomic_store_explicit(a, v, memory_order_release); }

/* Strong compare-and-swap; acquire both ways. On failure *expected holds what was found. */
static inline bool cas_acquire_u32(atomic_u32 *a, uint32_t *expected, uint32_t desired)
{
    return atomic_compare_exchange_strong_explicit(a, expected, desired, memory_order_acquire, memory_order_acquire);
}

/* Strong compare-and-swap, acquire and release on success: who acquires the new value sees what was written before. */
static inline bool cas_acquire_release_u32(atomic_u32 *a, uint32_t *expected, uint32_t desired)
{
    return atomic_compare_exchange_strong_explicit(a, expected, desired, memory_order_acq_rel, memory_order_acquire);
}

/* Strong, with release on success: what was written before is seen by whoever acquires the new value. */
static inline bool cas_release_u32(atomic_u32 *a, uint32_t *expected, uint32_t desired)
{
    return atomic_compare_exchange_strong_explicit(a, expected, desired, memory_order_release, memory_order_relaxed);
}

/* Strong compare-and-swap that orders no other access. */
static inline bool cas_relaxed_u64(atomic_u64 *a, uint64_t *expected, uint64_t desired)
{
    return atomic_compare_exchange_strong_explicit(a, expected, desired, memory_order_relaxed, memory_order_relaxed);
}

static inline uint32_t fetch_or_relaxed_u32(atomic_u32 *a, uint32_t v)
{
    return atomic_fetch_or_explicit(a, v, memory_order_relaxed);
}
static inline uint32_t fetch_and_relaxed_u32(atomic_u32 *a, uint32_t v)
{
    return atomic_fetch_and_explicit(a, v, memory_order_relaxed);
}

static inline uint64_t load_relaxed_u64(const atomic_u64 *a) { return atomic_load_explicit(a, memory_order_relaxed); }
static inline void store_relaxed_u64(atomic_u64 *a, uint64_t v) { atomic_store_explicit(a, v, memory_order_relaxed); }
static inline uint64_t fetch_add_relaxed_u64(atomic_u64 *a, uint64_t v)
{
    return atomic_fetch_add_explicit(a, v, memory_order_relaxed);
}

/* Tells TSan of an order that a library keeps by locks which TSan does not see, since libraries are not instrumented,
 * when it calls back from a thread of its own. Without TSan it does nothing. */
static inline void order_before_library(void *a)
{
#ifdef AFTERGLOW_TSAN
    __tsan_release(a);
#else
    (void)a;
#endif
}

static inline void order_after_library(void *a)
{
#ifdef AFTERGLOW_TSAN
    __tsan_acquire(a);
#else
    (void)a;
#endif
}

#endif
