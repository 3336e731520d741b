/* json_text.c: see json_text.h. */
#include "json_text.h"

#include "utf8.h"

void json_text_put(FILE *file, const char *text)
{
    int size;
    fputc('"', file);
    for (; *text; text += size > 0 ? size : 1) {
        size = utf8_character_size(text);
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
