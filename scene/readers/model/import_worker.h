/* import_worker.h: the side of import_process.h that runs in the process of its own.
 * Flow: import_process starts a program -> [here], first of all in its main. Threads: the only one of that process. */
#ifndef AFTERGLOW_IMPORT_WORKER_H
#define AFTERGLOW_IMPORT_WORKER_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* The descriptors that the program inherits besides the standard three, which are /dev/null: its answer, and a pipe
 * without data, whose closing tells the caller that the process has ended. */
enum { IMPORT_ANSWER_DESCRIPTOR = 3, IMPORT_END_DESCRIPTOR = 4, IMPORT_DESCRIPTORS_END = 5 };

/* Sees to it that the process dies with its caller, leaves no core, and takes memory_bytes at most on top of what it
 * has. Returns the stream to write the answer to; NULL where it is not there, or the caller is gone already. */
FILE *import_worker_begin(uint64_t memory_bytes);

/* Ends the process at once, without freeing anything: with success where all that was written is there and is_sound. */
_Noreturn void import_worker_end(FILE *answer, bool is_sound);

#endif
