/* text_file.h: a whole file in memory, unpacked if it is a gzip file.
 * Flow: scene files come in here; pbrt_lexer reads them. Threads: any; standard input belongs to one caller. */
#ifndef AFTERGLOW_TEXT_FILE_H
#define AFTERGLOW_TEXT_FILE_H

#include "run_context.h"

#include <stddef.h>
#include <stdint.h>

typedef struct text_file {
    char *text;             /* owned; size bytes and a NUL behind them */
    size_t size;            /* bytes */
    uint64_t device, inode; /* say whether two files are the same */
} text_file;

/* Text is at most so large, unpacked: 16 GiB, or half of the machine's memory where that is less. A small gzip file can
 * hold any amount, and a device or a pipe does not end. */
size_t text_file_max_bytes(void);

/* A gzip file holds at most 256 MiB, or 256 times its own size where that is more: text and meshes seldom pack to a
 * twentieth, and what packs to a thousandth would fill the memory. */
uint64_t text_file_max_unpacked_bytes(uint64_t packed_bytes);

/* path "-" is standard input, which may be anything; all else is a regular file (input_file.h). run may be NULL; where
 * it is cancelled the reading ends, also while it waits for standard input. On failure *out_file is zeroed and error
 * (of error_size bytes) says why, without the path. Errors: AG_ERROR_INPUT, AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status text_file_read(const run_context *run, const char *path, char *error, size_t error_size, text_file *out_file);
void text_file_reset(text_file *file); /* frees the text; leaves it zeroed */

#endif
