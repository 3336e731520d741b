/* excerpt.c: see excerpt.h. */
#include "text/excerpt.h"

#include <stdio.h>
#include <string.h>

void text_excerpt(const char *text, size_t text_size, file_location where, size_t width, char *out_excerpt,
                  size_t out_size)
{
    enum { CONTEXT = 60, WINDOW = 100 };
    const char *line = text, *end = text + text_size;
    if (text_size >= 3 && memcmp(line, "\xef\xbb\xbf", 3) == 0)
        line += 3;
    for (int i = 1; i < where.line && line; i++) {
        line = memchr(line, '\n', (size_t)(end - line));
        line = line ? line + 1 : NULL;
    }
    out_excerpt[0] = '\0';
    size_t left = line ? (size_t)(end - line) : 0, length = 0;
    size_t column = where.column > 0 ? (size_t)where.column - 1 : 0;
    size_t first = column > CONTEXT ? column - CONTEXT : 0;
    if (!line || column > left)
        return;
    while (first + length < left && length < WINDOW && line[first + length] != '\n' && line[first + length] != '\r')
        length++;
    char shown[WINDOW + 1], mark[WINDOW + 2];
    for (size_t i = 0; i < length; i++) {
        unsigned char c = (unsigned char)line[first + i];
        shown[i] = c == '\t' ? ' ' : c < ' ' || c == 0x7f ? '?' : (char)c;
    }
    shown[length] = '\0';
    size_t marks = 0;
    for (; marks < column - first; marks++)
        mark[marks] = ' ';
    mark[marks++] = '^';
    for (size_t i = 1; i < width && marks < length; i++)
        mark[marks++] = '~';
    mark[marks] = '\0';
    snprintf(out_excerpt, out_size, "\n    %s\n    %s", shown, mark);
}
