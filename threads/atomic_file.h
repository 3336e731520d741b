/* atomic_file.h: a file is there whole, or it is as it was before. Also for the program that is ended half-way.
 * Flow: bytes (a picture, statistics) -> [here] -> disk. Threads: any, each with its own path. */
#ifndef AFTERGLOW_ATOMIC_FILE_H
#define AFTERGLOW_ATOMIC_FILE_H

#include "afterglow/base.h"
#include "run_context.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Writes a temporary file ".NAME.afterglow-XXXXXX" in the folder of path, fsync, rename over path, fsync of the folder.
 * Temporary files of the same NAME that a killed process has left, so that none living owns them, are removed first. An
 * existing file keeps its permissions; a new one gets 0666 less the umask. A symbolic link stays, what it points to is
 * replaced. Where path is no regular file (a FIFO, a device) or names an open descriptor (/dev/stdout, /dev/fd/N), the
 * bytes are written to it directly; a FIFO's reader is waited for, until atomic_file_end_waits or until run is
 * cancelled (NULL: nothing cancels it). On failure nothing is left behind. Errors: AG_ERROR_OUTPUT, with path and
 * reason in message (always terminated), AG_CANCELLED (run is). */
ag_status atomic_file_write(const run_context *run, const char *path, const void *bytes, size_t size, char *message,
                            size_t message_size);

/* A part of a file's bytes; atomic_file_write_pieces writes pieces one behind the other. */
typedef struct atomic_file_piece {
    const void *bytes;
    size_t size;
} atomic_file_piece;
ag_status atomic_file_write_pieces(const run_context *run, const char *path, const atomic_file_piece *pieces, int count,
                                   char *message, size_t message_size);

/* Writes the file's bytes to the descriptor, which is open for writing alone and empty; returns 0 or an errno. For
 * atomic_file_write_by. */
typedef int atomic_file_fill(void *user, int descriptor);
ag_status atomic_file_write_by(const run_context *run, const char *path, atomic_file_fill *fill, void *user,
                               char *message, size_t message_size);

/* Returns whether atomic_file_write could begin now, by creating the temporary file and removing it. */
ag_status atomic_file_check(const char *path, char *message, size_t message_size);

/* Ends all waits from now on for the reader of a FIFO or of standard output: where one is not ready, the writing fails.
 * For the handler of a signal: async-signal-safe. */
void atomic_file_end_waits(void);

/* Removes the temporary files that are being written at this moment (of the first 8 writers). Async-signal-safe: for
 * the handler of a signal that ends the process. A write that goes on after it fails. */
void atomic_file_unlink_pending(void);

#ifdef __cplusplus
}
#endif
#endif
