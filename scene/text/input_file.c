/* input_file.c: see input_file.h.
 * Threads: see input_file.h. */
#define _POSIX_C_SOURCE 200809L
#include "text/input_file.h"

#include "descriptor.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void input_files_reset(input_files *files)
{
    free(files->read);
    *files = (input_files){0};
}

bool input_files_has(const input_files *files, uint64_t device, uint64_t inode)
{
    for (size_t i = 0; i < files->count; i++)
        if (files->read[i].inode == inode && files->read[i].device == device)
            return true;
    return false;
}

static bool note(input_files *files, const struct stat *status)
{
    struct input_file_number number = {(uint64_t)status->st_dev, (uint64_t)status->st_ino};
    if (!files || (files->count > 0 && files->read[files->count - 1].inode == number.inode &&
                   files->read[files->count - 1].device == number.device))
        return true;
    if (files->count == files->capacity) {
        size_t capacity = files->capacity > 0 ? 2 * files->capacity : 16;
        struct input_file_number *larger = realloc(files->read, capacity * sizeof *larger);
        if (!larger)
            return false;
        files->read = larger;
        files->capacity = capacity;
    }
    files->read[files->count++] = number;
    return true;
}

/* Of an open file. */
static bool is_fit(const run_context *run, int descriptor, char *error, size_t error_size)
{
    struct stat status;
    bool is_known = fstat(descriptor, &status) == 0;
    if (!is_known)
        snprintf(error, error_size, "%s", strerror(errno));
    else if (S_ISDIR(status.st_mode))
        snprintf(error, error_size, "%s", strerror(EISDIR));
    else if (!S_ISREG(status.st_mode))
        snprintf(error, error_size, "it is not a regular file");
    else if (!note(run ? run->inputs : NULL, &status))
        snprintf(error, error_size, "out of memory");
    else
        return true;
    return false;
}

int input_file_open(const run_context *run, const char *path, char *error, size_t error_size)
{
    /* O_NONBLOCK: a FIFO would wait for its writer; it means nothing for regular files */
    int descriptor = descriptor_beyond_standard(open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (descriptor < 0) {
        /* a FIFO that may only be written, a socket */
        struct stat status;
        int reason = errno;
        bool is_odd = stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
        snprintf(error, error_size, "%s", is_odd ? "it is not a regular file" : strerror(reason));
        return -1;
    }
    if (is_fit(run, descriptor, error, error_size))
        return descriptor;
    close(descriptor);
    return -1;
}

bool input_file_allow(const run_context *run, const char *path, char *error, size_t error_size)
{
    int descriptor = input_file_open(run, path, error, error_size);
    if (descriptor >= 0)
        close(descriptor);
    return descriptor >= 0;
}
