/* jpeg_end.c: see jpeg_end.h. */
#include "image/jpeg_end.h"

#include "text/input_file.h"

#include <stdio.h>
#include <string.h>

enum { START = 0xd8, SCAN = 0xda, END = 0xd9 };

/* What the next byte is. */
typedef enum jpeg_state { SEGMENT_BEGIN, SEGMENT_CODE, LENGTH_HIGH, LENGTH_LOW, IN_SCANS, AT_END } jpeg_state;

typedef struct walk {
    jpeg_state at;
    size_t to_skip; /* of a segment: small pictures within are stepped over */
    unsigned char before;
} walk;

static void step(walk *w, unsigned char byte)
{
    switch (w->at) {
    case SEGMENT_BEGIN: w->at = byte == 0xff ? SEGMENT_CODE : IN_SCANS; break;
    case SEGMENT_CODE:
        if (byte != 0xff) /* a byte of filling */
            w->at = byte == SCAN ? IN_SCANS : LENGTH_HIGH;
        break;
    case LENGTH_HIGH: w->at = LENGTH_LOW; break;
    case LENGTH_LOW: {
        const size_t length = (size_t)w->before << 8 | byte; /* with its own two bytes */
        w->to_skip = length > 2 ? length - 2 : 0;
        w->at = SEGMENT_BEGIN;
        break;
    }
    case IN_SCANS: /* 0xff is followed by 0, or by a marker */
        if (w->before == 0xff && byte == END)
            w->at = AT_END;
        break;
    case AT_END: break;
    }
    w->before = byte;
}

/* Takes in the next bytes of a file; the first call begins behind the file's first marker. */
static void go_on(walk *w, const unsigned char *bytes, size_t size)
{
    for (size_t k = 0; k < size && w->at != AT_END; k++) {
        if (w->to_skip > 0) {
            const size_t skipped = w->to_skip < size - k ? w->to_skip : size - k;
            w->to_skip -= skipped;
            k += skipped - 1;
            continue;
        }
        if (w->at == IN_SCANS && w->before != 0xff) {
            const unsigned char *next = memchr(bytes + k, 0xff, size - k);
            k = next ? (size_t)(next - bytes) : size - 1;
        }
        step(w, bytes[k]);
    }
}

bool jpeg_is_cut_short(const unsigned char *bytes, size_t size)
{
    walk w = {.at = SEGMENT_BEGIN};
    if (size < 2 || bytes[0] != 0xff || bytes[1] != START)
        return false;
    go_on(&w, bytes + 2, size - 2);
    return w.at != AT_END;
}

bool jpeg_file_is_cut_short(const char *path)
{
    unsigned char block[16384];
    walk w = {.at = SEGMENT_BEGIN};
    FILE *file = input_file_stream(path);
    if (!file)
        return false;
    size_t size = fread(block, 1, 2, file);
    bool is_cut = size == 2 && block[0] == 0xff && block[1] == START;
    while (is_cut && (size = fread(block, 1, sizeof block, file)) > 0) {
        go_on(&w, block, size);
        is_cut = w.at != AT_END;
    }
    is_cut = is_cut && !ferror(file);
    fclose(file);
    return is_cut;
}
