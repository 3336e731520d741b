/* import_process.h: work done in a process of its own, whose end, however it comes, is only an error here.
 * Libraries that read files of strangers may crash, hang or ask for all memory; from there they can do no harm.
 * Flow: mesh_import_assimp -> [here] -> the bytes it has written. Threads: any. */
#ifndef AFTERGLOW_IMPORT_PROCESS_H
#define AFTERGLOW_IMPORT_PROCESS_H

#include "run_context.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Runs in the process: a copy of the caller's, with one thread, the signals' default actions, no output, and so much
 * memory as it is given. Writes its answer; returns whether it could. */
typedef bool import_task(void *user, FILE *answer);

typedef struct import_answer {
    const unsigned char *bytes;
    size_t size;
} import_answer;

/* Runs the task, which may take memory_bytes, and waits for its end. *out_answer is to be reset; on failure it is
 * empty, and message says what became of the process. Errors: AG_ERROR_INPUT (the task failed, crashed, or wrote
 * nothing), AG_CANCELLED (the run is; the process is ended), AG_ERROR_MEMORY, AG_ERROR_SYSTEM. */
ag_status import_process_run(const run_context *run, import_task *task, void *user, uint64_t memory_bytes,
                             import_answer *out_answer, char *message, size_t message_size);
void import_answer_reset(import_answer *answer);

#endif
