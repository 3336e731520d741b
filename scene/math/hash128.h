/* hash128.h: a fingerprint of 128 bits, for telling whether two things are the same; no protection against malice.
 * Rests on: multiply and shift as in SplitMix64 (Steele, Lea, Flood 2014), in two lanes that feed each other.
 * Each piece is added with its length, so that what lies where matters. Not the same on machines of another byte order.
 * Threads: pure functions. */
#ifndef AFTERGLOW_HASH128_H
#define AFTERGLOW_HASH128_H

#include <stddef.h>
#include <stdint.h>

typedef struct hash128 {
    uint64_t bits[2];
} hash128;

static inline hash128 hash128_begin(void) { return (hash128){{0x9e3779b97f4a7c15u, 0xd1b54a32d192ed03u}}; }

/* bytes may be NULL if size is 0. */
void hash128_add(hash128 *hash, const void *bytes, size_t size);
/* Adds the text with its terminator; NULL is another than "". */
void hash128_add_text(hash128 *hash, const char *text);

static inline int hash128_is_equal(hash128 a, hash128 b) { return a.bits[0] == b.bits[0] && a.bits[1] == b.bits[1]; }

/* A value without gaps in its type: a number, an array, or a struct of members of one size. */
#define HASH128_ADD(hash, value) hash128_add((hash), &(value), sizeof(value))

#endif
