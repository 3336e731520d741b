/* utf8.h: where the characters of UTF-8 end. The program includes it too: there is nothing to link.
 * Threads: any. */
#ifndef AFTERGLOW_UTF8_H
#define AFTERGLOW_UTF8_H

#include <stdbool.h>
#include <stdint.h>

/* Returns the number of bytes, 1 to 4, of the character of UTF-8 at the beginning of a text, which ends with a zero
 * byte; 0: the first byte begins none. */
static inline int utf8_character_size(const char *text)
{
    static const uint32_t LEAST[] = {0, 0, 0x80, 0x800, 0x10000}; /* of a character of that size */
    const unsigned char *bytes = (const unsigned char *)text;
    const int size = bytes[0] < 0x80 ? 1 : bytes[0] >= 0xf0 ? 4 : bytes[0] >= 0xe0 ? 3 : bytes[0] >= 0xc0 ? 2 : 0;
    uint32_t code = size == 1 ? bytes[0] : bytes[0] & (0x7fu >> size);
    for (int i = 1; i < size; i++) {
        if ((bytes[i] & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (bytes[i] & 0x3f);
    }
    const bool is_surrogate = code >= 0xd800 && code < 0xe000;
    return size > 0 && bytes[0] < 0xf8 && code >= LEAST[size] && code <= 0x10ffff && !is_surrogate ? size : 0;
}

#endif
