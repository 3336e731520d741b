/* fuzz.h: what the fuzz targets share: a folder of their own to stand in, a log that counts, checks that hold in every
 * build. A target is one LLVMFuzzerTestOneInput; libFuzzer calls it (preset "fuzz"), or fuzz_driver.c (all others).
 * Flow: bytes -> [a target] -> a reader. Threads: one. */
#ifndef AFTERGLOW_FUZZ_H
#define AFTERGLOW_FUZZ_H

#include "run_context.h"

#include <stddef.h>
#include <stdint.h>

/* Returns 0. Whatever the bytes are, the reader must neither crash, leak nor hang; what it accepts must be whole. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Goes, once, into an empty folder that is removed at exit: names of files that come of bytes mean nothing there. */
void fuzz_enter_folder(void);
/* A file in that folder. */
void fuzz_write(const char *name, const void *data, size_t size);

/* Ends the process, which makes a finding of the input. Not assert: it must also hold where that is compiled out. */
#define FUZZ_CHECK(condition) ((condition) ? (void)0 : fuzz_fail(#condition, __FILE__, __LINE__))
_Noreturn void fuzz_fail(const char *condition, const char *file, int line);

/* A run without threads, whose log counts the messages of each level and shows them where $FUZZ_VERBOSE is set. */
typedef struct fuzz_run {
    run_context context;
    log_sink *log;
    int count[4]; /* of messages by level */
} fuzz_run;

void fuzz_run_init(fuzz_run *run);
void fuzz_run_reset(fuzz_run *run);
/* Who fails says why, once; who is out of memory may say nothing. */
void fuzz_check_said(const fuzz_run *run, ag_status status);

#endif
