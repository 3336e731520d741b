/* import_file.c: see import_file.h. */
#define _POSIX_C_SOURCE 200809L
#include "model/import_file.h"

#include "image/module_folders.h"
#include "model/import_process.h"
#include "model/import_scene.h"
#include "status.h"
#include "text/input_file.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define PROGRAM_NAME "afterglow-import"
enum { TRIED_SIZE = 1024 };

static ag_status refuse(const run_context *run, const char *path, const char *what, const char *reason)
{
    log_at(run->log, AG_LOG_ERROR, (file_location){path, 0, 0}, "%s: %s", what, reason);
    return AG_ERROR_INPUT;
}

/* The memory that the program may take: some formats are packed, but none by more than this for each byte of
 * the file. */
static ag_status find_memory_limit(const run_context *run, const char *path, uint64_t *out_bytes)
{
    const uint64_t base = UINT64_C(2) << 30, per_byte = 64;
    struct stat info;
    char error[128];
    int file = input_file_open(run, path, error, sizeof error);
    if (file < 0)
        return refuse(run, path, "cannot read the file", error);
    bool is_known = fstat(file, &info) == 0;
    close(file);
    if (!is_known)
        return AG_ERROR_MEMORY;
    *out_bytes = base + per_byte * (uint64_t)(info.st_size > 0 ? info.st_size : 0);
    return AG_OK;
}

/* Finds the program's path, or NULL and where it was looked for. */
static const char *find_program(char *path, size_t path_size, char tried[TRIED_SIZE])
{
    module_folders folders;
    size_t length = 0;
    tried[0] = '\0';
    module_folders_find(&folders);
    for (int i = 0; i < folders.count; i++) {
        if (snprintf(path, path_size, "%s/%s", folders.paths[i], PROGRAM_NAME) >= (int)path_size)
            continue;
        if (access(path, X_OK) == 0)
            return path;
        if (length < TRIED_SIZE)
            length += (size_t)snprintf(tried + length, TRIED_SIZE - length, "%s'%s'", i ? ", " : "", path);
    }
    return NULL;
}

bool import_finds_program(const run_context *run, ag_log_level level)
{
    char path[MODULE_PATH_MAX], tried[TRIED_SIZE];
    if (find_program(path, sizeof path, tried))
        return true;
    log_message(run->log, level, "the program " PROGRAM_NAME ", which reads other formats, is not there: %s", tried);
    return false;
}

ag_status import_reads_extension(const run_context *run, const char *extension, bool *out_reads)
{
    char path[MODULE_PATH_MAX], tried[TRIED_SIZE], message[512];
    import_answer answer;
    *out_reads = false;
    if (!find_program(path, sizeof path, tried))
        return AG_OK;
    const char *const arguments[] = {PROGRAM_NAME, "reads", extension, NULL};
    ag_status status = import_process_run(run, path, arguments, &answer, message, sizeof message);
    if (status == AG_OK)
        *out_reads = answer.bytes[0] == 1;
    else if (status != AG_CANCELLED)
        log_message(run->log, AG_LOG_ERROR, "%s", message[0] != '\0' ? message : "memory is short");
    import_answer_reset(&answer);
    return status;
}

static ag_status read_records(run_context *run, const char *path, uint64_t memory_bytes, import_answer *out_answer)
{
    const input_files *inputs = run->inputs;
    const bool is_confined = inputs && inputs->is_confined;
    const size_t folder_count = is_confined ? inputs->root_count : 0;
    char program[MODULE_PATH_MAX], tried[TRIED_SIZE], memory[32], message[512];
    if (!find_program(program, sizeof program, tried)) {
        import_finds_program(run, AG_LOG_ERROR);
        return AG_ERROR_SYSTEM;
    }
    const char **arguments = calloc(folder_count + 5, sizeof *arguments);
    if (!arguments)
        return AG_ERROR_MEMORY;
    snprintf(memory, sizeof memory, "%" PRIu64, memory_bytes);
    arguments[0] = PROGRAM_NAME;
    arguments[1] = is_confined ? "confined" : "model";
    arguments[2] = memory;
    arguments[3] = path;
    for (size_t i = 0; i < folder_count; i++)
        arguments[4 + i] = inputs->roots[i];
    ag_status status = import_process_run(run, program, arguments, out_answer, message, sizeof message);
    free(arguments);
    if (status != AG_OK && status != AG_CANCELLED && message[0] != '\0')
        refuse(run, path, "assimp cannot read the file", message);
    return status;
}

ag_status import_file_load(run_context *run, const char *path, scene *out_scene)
{
    import_answer answer = {0};
    uint64_t memory_bytes = 0;
    AG_TRY(find_memory_limit(run, path, &memory_bytes));
    run_progress(run, AG_PHASE_LOAD, 0.0);
    ag_status status = read_records(run, path, memory_bytes, &answer);
    if (status == AG_OK)
        status = import_scene_fill(run, path, answer.bytes, answer.size, out_scene);
    import_answer_reset(&answer);
    if (status == AG_OK)
        run_progress(run, AG_PHASE_LOAD, 1.0);
    return status;
}
