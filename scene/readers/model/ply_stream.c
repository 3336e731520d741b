/* ply_stream.c: see ply_stream.h. Reads are larger than zlib's own buffer, so a plain file goes straight into ours.
 * Threads: one per file. */
#define _POSIX_C_SOURCE 200809L
#include "model/ply_stream.h"

#include "text/decimal.h"
#include "text/input_file.h"
#include "text/text_file.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { BUFFER_BYTES = 1 << 20, ZLIB_BYTES = 1 << 17, NUMBER_BYTES = 400 };

static ag_status fail_reading(ply_stream *s, const char *reason)
{
    snprintf(s->error, s->error_size, "%s: %s", s->path, reason);
    return AG_ERROR_INPUT;
}

ag_status ply_stream_open(const char *path, const run_context *run, char *error, size_t error_size,
                          ply_stream *out_stream)
{
    ply_stream *s = out_stream;
    *s = (ply_stream){.run = run, .size = UINT64_MAX, .line_end = '\n', .line = 1, .path = path};
    s->error = error;
    s->error_size = error_size;
    struct stat status;
    char reason[128];
    int descriptor = input_file_open(run, path, reason, sizeof reason);
    if (descriptor < 0)
        return fail_reading(s, reason);
    if (fstat(descriptor, &status) != 0) {
        fail_reading(s, strerror(errno));
        close(descriptor);
        return AG_ERROR_INPUT;
    }
    s->bytes = malloc(BUFFER_BYTES + 1);
    s->file = s->bytes ? gzdopen(descriptor, "rb") : NULL;
    if (!s->file) {
        free(s->bytes);
        close(descriptor);
        return AG_ERROR_MEMORY;
    }
    s->bytes[0] = '\0';
    gzbuffer(s->file, ZLIB_BYTES);
    if (S_ISREG(status.st_mode) && gzdirect(s->file))
        s->size = (uint64_t)status.st_size;
    else
        s->packed = (uint64_t)status.st_size;
    return AG_OK;
}

void ply_stream_close(ply_stream *s)
{
    gzclose_r(s->file);
    free(s->bytes);
}

ag_status ply_fail(ply_stream *s, const char *format, ...)
{
    char message[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    unsigned long long index = s->element_index;
    if (!s->element)
        snprintf(s->error, s->error_size, "%s:%llu: %s", s->path, (unsigned long long)s->line, message);
    else if (s->format == PLY_ASCII)
        snprintf(s->error, s->error_size, "%s:%llu:%llu: %s %llu: %s", s->path, (unsigned long long)s->line,
                 (unsigned long long)(s->offset + s->mark + 1 - s->line_begin), s->element, index, message);
    else
        snprintf(s->error, s->error_size, "%s: %s %llu (byte %llu): %s", s->path, s->element, index,
                 (unsigned long long)(s->offset + s->mark), message);
    return AG_ERROR_INPUT;
}

ag_status ply_fill(ply_stream *s, size_t wanted)
{
    if (s->end - s->next >= wanted || s->is_at_end)
        return AG_OK;
    if (s->run && run_is_cancelled(s->run))
        return AG_CANCELLED;
    memmove(s->bytes, s->bytes + s->next, s->end - s->next);
    s->offset += s->next;
    s->end -= s->next;
    s->next = s->mark = 0;
    while (s->end < wanted && !s->is_at_end) {
        errno = 0;
        int count = gzread(s->file, s->bytes + s->end, (unsigned)(BUFFER_BYTES - s->end)), code = Z_OK;
        const char *text = gzerror(s->file, &code);
        if (count < 0 || code == Z_BUF_ERROR) {
            if (code == Z_MEM_ERROR)
                return AG_ERROR_MEMORY;
            if (code == Z_ERRNO)
                return fail_reading(s, strerror(errno));
            return fail_reading(s, code == Z_BUF_ERROR ? "the gzip file is cut short" : text);
        }
        if (s->packed > 0 && s->offset + s->end > text_file_max_unpacked_bytes(s->packed)) {
            char reason[128];
            snprintf(reason, sizeof reason,
                     "the gzip file holds more than %llu MiB, which is the most in one of its size",
                     (unsigned long long)text_file_max_unpacked_bytes(s->packed) >> 20);
            return fail_reading(s, reason);
        }
        s->is_at_end = count == 0;
        s->end += (size_t)count;
    }
    s->bytes[s->end] = '\0';
    return AG_OK;
}

ag_status ply_read_line(ply_stream *s, char *line, size_t size, bool *out_is_end)
{
    size_t length = 0;
    for (;;) {
        AG_TRY(ply_fill(s, 1));
        *out_is_end = s->next == s->end && length == 0;
        if (s->next == s->end)
            break;
        char c = (char)s->bytes[s->next++];
        if (c == s->line_end)
            break;
        if (length + 1 < size)
            line[length++] = c;
    }
    if (length > 0 && line[length - 1] == '\r')
        length--;
    line[length] = '\0';
    s->line_begin = s->offset + s->next;
    return AG_OK;
}

static uint16_t load16(const unsigned char *b, bool big)
{
    return (uint16_t)(big ? b[0] << 8 | b[1] : b[1] << 8 | b[0]);
}

static uint32_t load32(const unsigned char *b, bool big)
{
    if (big)
        return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
    return (uint32_t)b[3] << 24 | (uint32_t)b[2] << 16 | (uint32_t)b[1] << 8 | b[0];
}

double ply_decode(const unsigned char *b, ply_type type, ply_format format)
{
    bool big = format == PLY_BIG_ENDIAN;
    uint32_t word;
    uint64_t pair;
    float single;
    double value;
    switch (type) {
    case PLY_INT8: return (int8_t)b[0];
    case PLY_UINT8: return b[0];
    case PLY_INT16: return (int16_t)load16(b, big);
    case PLY_UINT16: return load16(b, big);
    case PLY_INT32: return (int32_t)load32(b, big);
    case PLY_UINT32: return load32(b, big);
    case PLY_FLOAT32:
        word = load32(b, big);
        memcpy(&single, &word, sizeof single);
        return (double)single;
    case PLY_FLOAT64: break;
    }
    pair = (uint64_t)load32(b, big) << (big ? 32 : 0) | (uint64_t)load32(b + 4, big) << (big ? 0 : 32);
    memcpy(&value, &pair, sizeof value);
    return value;
}

static bool is_space(unsigned char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

static ag_status read_decimal(ply_stream *s, double *out_value)
{
    for (;;) {
        AG_TRY(ply_fill(s, NUMBER_BYTES));
        for (; s->next < s->end && is_space(s->bytes[s->next]); s->next++)
            if ((char)s->bytes[s->next] == s->line_end) {
                s->line++;
                s->line_begin = s->offset + s->next + 1;
            }
        if (s->next < s->end || s->is_at_end)
            break;
    }
    AG_TRY(ply_fill(s, NUMBER_BYTES)); /* the number must not be cut by the buffer's end */
    s->mark = s->next;
    if (s->next == s->end)
        return ply_fail(s, "the file ends here");
    const char *text = (const char *)s->bytes + s->next, *behind = decimal_parse(text, out_value);
    size_t left = s->end - s->next, length = behind ? (size_t)(behind - text) : 0;
    if (!behind || (length < left && !is_space((unsigned char)*behind)) || length >= NUMBER_BYTES) {
        int shown = 0;
        while (shown < 24 && (size_t)shown < left && text[shown] > ' ' && text[shown] <= '~')
            shown++;
        return ply_fail(s, "\"%.*s\" is no number", shown, text);
    }
    s->next += length;
    return AG_OK;
}

ag_status ply_read_number(ply_stream *s, ply_type type, double *out_value)
{
    if (s->format == PLY_ASCII)
        return read_decimal(s, out_value);
    size_t bytes = ply_type_bytes(type);
    AG_TRY(ply_fill(s, bytes));
    s->mark = s->next;
    if (s->end - s->next < bytes)
        return ply_fail(s, "the file ends here");
    *out_value = ply_decode(s->bytes + s->next, type, s->format);
    s->next += bytes;
    return AG_OK;
}

ag_status ply_skip_numbers(ply_stream *s, ply_type type, uint64_t count)
{
    double ignored;
    if (s->format == PLY_ASCII) {
        for (; count > 0; count--)
            AG_TRY(read_decimal(s, &ignored));
        return AG_OK;
    }
    for (uint64_t left = count * ply_type_bytes(type); left > 0;) {
        AG_TRY(ply_fill(s, 1));
        s->mark = s->next;
        uint64_t there = s->end - s->next, step = there < left ? there : left;
        if (step == 0)
            return ply_fail(s, "the file ends here");
        s->next += (size_t)step;
        left -= step;
    }
    return AG_OK;
}

uint64_t ply_room_for(const ply_stream *s, uint64_t record_bytes)
{
    uint64_t here = s->offset + s->next;
    if (s->size == UINT64_MAX || record_bytes == 0)
        return UINT64_MAX;
    /* the last line of an ascii file may lack its end */
    uint64_t left = (s->size > here ? s->size - here : 0) + (s->format == PLY_ASCII);
    return left / record_bytes;
}
