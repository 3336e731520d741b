/* ply_stream.h: the bytes of a PLY file, unpacked if it is a gzip file: as lines, as numbers, and where one is in it.
 * Rests on: Turk, "The PLY Polygon File Format", 1994.
 * Flow: zlib -> [here] -> ply_header, ply_file. Threads: one per file. */
#ifndef AFTERGLOW_PLY_STREAM_H
#define AFTERGLOW_PLY_STREAM_H

#include "run_context.h"
#include "status.h"

#include <stddef.h>
#include <stdint.h>
#include <zlib.h>

typedef enum ply_format { PLY_NO_FORMAT, PLY_ASCII, PLY_LITTLE_ENDIAN, PLY_BIG_ENDIAN } ply_format;

typedef enum ply_type {
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_FLOAT32,
    PLY_FLOAT64
} ply_type;

static inline size_t ply_type_bytes(ply_type type) { return (size_t)1 << (type < PLY_FLOAT32 ? type / 2 : type - 4); }

typedef struct ply_stream {
    gzFile file;
    const run_context *run; /* may be NULL */
    unsigned char *bytes;   /* decompressed bytes; those not read yet are at next to end, followed by a NUL */
    size_t next, end;
    size_t mark;     /* of the value read last, for messages */
    uint64_t offset; /* of bytes[0] in the unpacked file */
    uint64_t size;   /* of a plain file; UINT64_MAX where it is not known beforehand */
    uint64_t packed; /* of a gzip file, its own size; 0: it is a plain one */
    bool is_at_end;  /* nothing comes behind end */
    ply_format format;
    char line_end;       /* '\n', or '\r' in files of the old Macintosh */
    uint64_t line;       /* from 1; of next, in the header and in ascii files */
    uint64_t line_begin; /* of that line in the unpacked file, in the body of ascii files */
    const char *path;    /* borrowed */
    const char *element; /* the kind of element that is read, borrowed; NULL in the header */
    uint64_t element_index;
    char *error; /* borrowed; takes one message */
    size_t error_size;
} ply_stream;

/* path, error and run are borrowed until the close. Errors, here and below: AG_ERROR_INPUT with a message in error,
 * AG_ERROR_MEMORY, AG_CANCELLED. On failure nothing is to be closed. */
ag_status ply_stream_open(const char *path, const run_context *run, char *error, size_t error_size,
                          ply_stream *out_stream);
void ply_stream_close(ply_stream *s);

/* Writes "PATH:LINE: message", in a file's body "PATH:LINE:COLUMN: vertex 7: message" or, where it is binary, "PATH:
 * vertex 7 (byte 1234): message"; elements and bytes count from 0, as indices do. Returns AG_ERROR_INPUT. */
ag_status ply_fail(ply_stream *s, const char *format, ...) AG_PRINTF(2, 3);

/* Reads on until `wanted` bytes (64 KiB at most) lie at next, or all that there are. */
ag_status ply_fill(ply_stream *s, size_t wanted);
/* Reads the next line of the header without its end, cut to size - 1 characters. *out_is_end: the file has ended. */
ag_status ply_read_line(ply_stream *s, char *line, size_t size, bool *out_is_end);
/* Returns a number of a binary file at the address where it lies. */
double ply_decode(const unsigned char *bytes, ply_type type, ply_format format);
/* Reads the next number of the body. */
ag_status ply_read_number(ply_stream *s, ply_type type, double *out_value);
/* Skips numbers. */
ag_status ply_skip_numbers(ply_stream *s, ply_type type, uint64_t count);
/* How many records of that many bytes there may be from here on; UINT64_MAX where the file's size is not known. */
uint64_t ply_room_for(const ply_stream *s, uint64_t record_bytes);

#endif
