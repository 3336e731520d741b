/* hash128.c: see hash128.h. */
#include "math/hash128.h"

#include "math/rng.h"

#include <string.h>

static void add_block(hash128 *h, const unsigned char *block)
{
    uint64_t words[2];
    memcpy(words, block, sizeof words);
    uint64_t a = (h->bits[0] ^ words[0]) * 0xbf58476d1ce4e5b9u, b = (h->bits[1] ^ words[1]) * 0x94d049bb133111ebu;
    a ^= a >> 32;
    b ^= b >> 29;
    h->bits[0] = a + (b << 23 | b >> 41);
    h->bits[1] = b ^ (a << 17 | a >> 47);
}

void hash128_add(hash128 *h, const void *bytes, size_t size)
{
    const unsigned char *next = bytes;
    size_t left = size;
    for (; left >= 16; left -= 16, next += 16)
        add_block(h, next);
    if (left > 0) {
        unsigned char last[16] = {0};
        memcpy(last, next, left);
        add_block(h, last);
    }
    /* short inputs must reach all bits too */
    h->bits[0] = hash_mix64(h->bits[0] + size);
    h->bits[1] = hash_mix64(h->bits[1] ^ h->bits[0]);
}

void hash128_add_text(hash128 *h, const char *text)
{
    if (text)
        hash128_add(h, text, strlen(text) + 1);
    else
        hash128_add(h, NULL, 0);
}
