/* jpeg_end.c: see jpeg_end.h. */
#include "image/jpeg_end.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { START = 0xd8, SCAN = 0xda, END = 0xd9 };

bool jpeg_is_cut_short(const unsigned char *bytes, size_t size)
{
    size_t at = 2;
    if (size < 4 || bytes[0] != 0xff || bytes[1] != START)
        return false;
    while (at + 4 <= size && bytes[at] == 0xff && bytes[at + 1] != SCAN) { /* small pictures within are stepped over */
        if (bytes[at + 1] == 0xff) {
            at++; /* a byte of filling */
            continue;
        }
        at += 2 + ((size_t)bytes[at + 2] << 8 | bytes[at + 3]);
    }
    if (at + 4 > size)
        return true;
    for (; at + 1 < size; at++) { /* within a scan 0xff is followed by 0, or by a marker */
        const unsigned char *next = memchr(bytes + at, 0xff, size - 1 - at);
        if (!next)
            return true;
        at = (size_t)(next - bytes);
        if (bytes[at + 1] == END)
            return false;
    }
    return true;
}

bool jpeg_file_is_cut_short(const char *path)
{
    unsigned char *bytes = NULL, begin[2];
    bool is_cut = false;
    FILE *file = fopen(path, "rb");
    if (!file)
        return false;
    if (fread(begin, 1, 2, file) == 2 && begin[0] == 0xff && begin[1] == START && fseek(file, 0, SEEK_END) == 0) {
        const long size = ftell(file);
        bytes = size > 0 ? malloc((size_t)size) : NULL;
        rewind(file);
        is_cut = bytes && fread(bytes, 1, (size_t)size, file) == (size_t)size && jpeg_is_cut_short(bytes, (size_t)size);
    }
    free(bytes);
    fclose(file);
    return is_cut;
}
