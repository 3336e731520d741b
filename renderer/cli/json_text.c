/* json_text.c: see json_text.h. */
#include "json_text.h"

#include <stdbool.h>
#include <stdint.h>

/* Returns the number of bytes, 1 to 4, of the character of UTF-8 at the beginning of a text that is not empty; 0: the
 * first byte begins none. */
static int character_size(const unsigned char *text)
{
    static const uint32_t LEAST[] = {0, 0, 0x80, 0x800, 0x10000}; /* of a character of that size */
    const int size = text[0] < 0x80 ? 1 : text[0] >= 0xf0 ? 4 : text[0] >= 0xe0 ? 3 : text[0] >= 0xc0 ? 2 : 0;
    uint32_t code = size == 1 ? text[0] : text[0] & (0x7fu >> size);
    for (int i = 1; i < size; i++) {
        if ((text[i] & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (text[i] & 0x3f);
    }
    const bool is_surrogate = code >= 0xd800 && code < 0xe000;
    return size > 0 && text[0] < 0xf8 && code >= LEAST[size] && code <= 0x10ffff && !is_surrogate ? size : 0;
}

void json_text_put(FILE *file, const char *text)
{
    int size;
    fputc('"', file);
    for (; *text; text += size > 0 ? size : 1) {
        size = character_size((const unsigned char *)text);
        if (*text == '"' || *text == '\\')
            fprintf(file, "\\%c", *text);
        else if (size == 0)
            fputs("\\ufffd", file);
        else if (size == 1 && *text < ' ')
            fprintf(file, "\\u%04x", (unsigned)*text);
        else
            fwrite(text, 1, (size_t)size, file);
    }
    fputc('"', file);
}
