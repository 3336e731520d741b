/* fuzz.c: see fuzz.h. Threads: one. */
#define _XOPEN_SOURCE 700
#include "fuzz.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ASan asks for this before main. An allocation that an input of some kilobytes has no right to fails, so that what the
 * reader does then is looked at too. new_delete_type_mismatch: OpenImageIO's own. */
__attribute__((visibility("default"))) const char *__asan_default_options(void);
const char *__asan_default_options(void)
{
    return "max_allocation_size_mb=96:allocator_may_return_null=1:new_delete_type_mismatch=0:detect_leaks=1";
}

/* OpenImageIO loses a text where libpng jumps out of it; the rest of the stack is not to be had. */
__attribute__((visibility("default"))) const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) { return "leak:std::__cxx11::basic_string<*>::_M_assign"; }

static char folder[64];

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *where)
{
    (void)info;
    (void)kind;
    (void)where;
    return remove(path);
}

static void leave_folder(void)
{
    if (chdir("/") == 0)
        nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
}

void fuzz_enter_folder(void)
{
    if (folder[0])
        return;
    strcpy(folder, "/tmp/afterglow_fuzz.XXXXXX");
    FUZZ_CHECK(mkdtemp(folder) && chdir(folder) == 0);
    FUZZ_CHECK(setenv("AFTERGLOW_MODULE_DIR", FUZZ_MODULE_DIR, 0) == 0);
    atexit(leave_folder);
}

void fuzz_write(const char *name, const void *data, size_t size)
{
    FILE *file = fopen(name, "wb");
    FUZZ_CHECK(file && fwrite(data, 1, size, file) == size);
    FUZZ_CHECK(fclose(file) == 0);
}

void fuzz_fail(const char *condition, const char *file, int line)
{
    fprintf(stderr, "%s:%d: does not hold: %s\n", file, line, condition);
    abort();
}

static void hear(void *user, ag_log_level level, const char *message)
{
    fuzz_run *run = user;
    run->count[level]++;
    if (getenv("FUZZ_VERBOSE"))
        fprintf(stderr, "%s\n", message);
}

void fuzz_run_init(fuzz_run *run)
{
    memset(run, 0, sizeof *run);
    run->log = log_create(hear, run);
    FUZZ_CHECK(run->log);
    run_context_init(&run->context, NULL, run->log, NULL, NULL);
}

void fuzz_run_reset(fuzz_run *run)
{
    run_context_reset(&run->context);
    log_destroy(run->log);
}

void fuzz_check_said(const fuzz_run *run, ag_status status)
{
    if (status == AG_OK)
        FUZZ_CHECK(run->count[AG_LOG_ERROR] == 0);
    else if (status != AG_ERROR_MEMORY)
        FUZZ_CHECK(run->count[AG_LOG_ERROR] == 1);
}
