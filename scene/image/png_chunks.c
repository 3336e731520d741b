/* png_chunks.c: see png_chunks.h. */
#define _POSIX_C_SOURCE 200809L
#include "image/png_chunks.h"

#include "text/input_file.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/types.h>

enum { SIGNATURE_SIZE = 8, HEAD_SIZE = 8, CHECKSUM_SIZE = 4 };

static uint64_t number_at(const unsigned char *bytes)
{
    return (uint64_t)bytes[0] << 24 | (uint64_t)bytes[1] << 16 | (uint64_t)bytes[2] << 8 | bytes[3];
}

static const char *find_wrong(FILE *file)
{
    static const char SIGNATURE[] = "\x89PNG\r\n\x1a\n";
    unsigned char head[HEAD_SIZE];
    if (fread(head, 1, SIGNATURE_SIZE, file) != SIGNATURE_SIZE || memcmp(head, SIGNATURE, SIGNATURE_SIZE) != 0 ||
        fseeko(file, 0, SEEK_END) != 0)
        return NULL;
    const uint64_t size = (uint64_t)ftello(file);
    for (uint64_t at = SIGNATURE_SIZE; at + HEAD_SIZE <= size;) {
        if (fseeko(file, (off_t)at, SEEK_SET) != 0 || fread(head, 1, HEAD_SIZE, file) != HEAD_SIZE ||
            memcmp(head + 4, "IEND", 4) == 0)
            return NULL;
        const uint64_t length = number_at(head);
        if (length > size - at - HEAD_SIZE)
            return "the PNG file is cut short, or damaged: one of its chunks goes on beyond its end";
        at += HEAD_SIZE + length + CHECKSUM_SIZE;
    }
    return NULL;
}

const char *png_chunks_wrong(const unsigned char *bytes, size_t size)
{
    FILE *file =
        size > 0 ? fmemopen((void *)bytes, size, "rb") : NULL; /* opened to read only, so the bytes stay const */
    const char *wrong = file ? find_wrong(file) : NULL;
    if (file)
        fclose(file);
    return wrong;
}

const char *png_file_chunks_wrong(const char *path)
{
    FILE *file = input_file_stream(path);
    const char *wrong = file ? find_wrong(file) : NULL;
    if (file)
        fclose(file);
    return wrong;
}
