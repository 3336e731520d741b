/* import_process.h: a program run in a process of its own, whose end, however it comes, is only an error here.
 * Libraries that read files of strangers may crash, hang or ask for all memory; from there they can do no harm.
 * Flow: import_file -> [here] -> import_worker, in the process -> the bytes it has written. Threads: any. */
#ifndef AFTERGLOW_IMPORT_PROCESS_H
#define AFTERGLOW_IMPORT_PROCESS_H

#include "run_context.h"

#include <stddef.h>
#include <stdint.h>

typedef struct import_answer {
    const unsigned char *bytes;
    size_t size;
} import_answer;

/* Runs the program, by its path, whose main begins with import_worker_begin, and waits for its end. arguments: as its
 * main gets them, from the program's name on, with NULL at the end. It has the default actions of all signals and
 * nowhere to write but its answer. *out_answer is to be reset; on failure it is empty, and message says what became of
 * the process. Errors: AG_ERROR_INPUT (the program failed, crashed, or wrote nothing), AG_CANCELLED (the run is; the
 * process is ended), AG_ERROR_MEMORY, AG_ERROR_SYSTEM (it cannot be started). */
ag_status import_process_run(const run_context *run, const char *program, const char *const *arguments,
                             import_answer *out_answer, char *message, size_t message_size);
void import_answer_reset(import_answer *answer);

#endif
