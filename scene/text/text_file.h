/* text_file.h: a whole file in memory, unpacked if it is a gzip file.
 * Flow: scene files come in here; pbrt_lexer reads them. Threads: any; standard input belongs to one caller. */
#ifndef AFTERGLOW_TEXT_FILE_H
#define AFTERGLOW_TEXT_FILE_H

#include "afterglow/base.h"

#include <stddef.h>
#include <stdint.h>

typedef struct text_file {
    char *text;             /* owned; size bytes and a NUL behind them */
    size_t size;            /* bytes */
    uint64_t device, inode; /* say whether two files are the same */
} text_file;

/* path "-" is standard input. On failure *out_file is zeroed and error (of error_size bytes) says why, without the
 * path. Errors: AG_ERROR_INPUT, AG_ERROR_MEMORY. */
ag_status text_file_read(const char *path, char *error, size_t error_size, text_file *out_file);
void text_file_reset(text_file *file); /* frees the text; leaves it zeroed */

#endif
