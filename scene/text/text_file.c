/* text_file.c: see text_file.h. zlib reads plain and gzip files alike.
 * Threads: any. */
#define _GNU_SOURCE /* memfd_create */
#include "text/text_file.h"

#include "descriptor.h"
#include "text/input_file.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

static const size_t MAX_BYTES = (size_t)16 << 30;
static const size_t CHUNK_BYTES = (size_t)1 << 20;
enum { LOOK_UP_EVERY_MS = 50 }; /* for cancellation */

size_t text_file_max_bytes(void)
{
    long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    size_t half = pages > 0 && page_bytes > 0 ? (size_t)pages / 2 * (size_t)page_bytes : MAX_BYTES;
    return half < MAX_BYTES ? half : MAX_BYTES;
}

uint64_t text_file_max_unpacked_bytes(uint64_t packed_bytes)
{
    static const uint64_t ALWAYS_BYTES = (uint64_t)256 << 20, RATIO = 256;
    return packed_bytes > ALWAYS_BYTES / RATIO ? packed_bytes * RATIO : ALWAYS_BYTES;
}

static ag_status refuse_size(char *error, size_t error_size)
{
    snprintf(error, error_size, "it is larger than %zu MiB, which is the most", text_file_max_bytes() >> 20);
    return AG_ERROR_INPUT;
}

static bool is_cancelled(const run_context *run) { return run && run_is_cancelled(run); }

/* Moves what a pipe or a device brings into memory that is read like a file; zlib alone would wait for it, and not look
 * up when the run is cancelled. */
static ag_status take_stream(const run_context *run, int from, int to, char *error, size_t error_size)
{
    size_t taken = 0;
    char chunk[1 << 14];
    for (;;) {
        struct pollfd at = {.fd = from, .events = POLLIN};
        int ready = poll(&at, 1, LOOK_UP_EVERY_MS);
        if (is_cancelled(run))
            return AG_CANCELLED;
        if (ready == 0 || (ready < 0 && errno == EINTR))
            continue;
        ssize_t got = read(from, chunk, sizeof chunk);
        if (got < 0 && (errno == EINTR || errno == EAGAIN))
            continue;
        if (got == 0)
            return lseek(to, 0, SEEK_SET) == 0 ? AG_OK : AG_ERROR_INPUT;
        taken += got > 0 ? (size_t)got : 0;
        if (taken > text_file_max_bytes())
            return refuse_size(error, error_size);
        if (got < 0 || write(to, chunk, (size_t)got) != got) {
            snprintf(error, error_size, "%s", strerror(errno));
            return AG_ERROR_INPUT;
        }
    }
}

static ag_status open_standard_input(const run_context *run, char *error, size_t error_size, int *out_descriptor)
{
    struct stat status;
    *out_descriptor = fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0);
    if (*out_descriptor < 0 || fstat(*out_descriptor, &status) != 0) {
        snprintf(error, error_size, "%s", strerror(errno));
        return AG_ERROR_INPUT;
    }
    if (S_ISREG(status.st_mode))
        return AG_OK;
    int memory = descriptor_beyond_standard(memfd_create("afterglow standard input", MFD_CLOEXEC));
    ag_status result = AG_ERROR_MEMORY;
    if (memory >= 0)
        result = take_stream(run, *out_descriptor, memory, error, error_size);
    close(*out_descriptor);
    *out_descriptor = memory;
    return result;
}

/* expected_bytes: the file's size. Reads until the end; *file holds what there is, also on failure. */
static ag_status read_all(const run_context *run, gzFile stream, size_t expected_bytes, char *error, size_t error_size,
                          text_file *file)
{
    size_t capacity = expected_bytes + CHUNK_BYTES + 1;
    file->text = malloc(capacity);
    if (!file->text)
        return AG_ERROR_MEMORY;
    for (;;) {
        if (is_cancelled(run))
            return AG_CANCELLED;
        if (capacity - file->size - 1 < CHUNK_BYTES) {
            capacity = 2 * capacity;
            char *larger = realloc(file->text, capacity);
            if (!larger)
                return AG_ERROR_MEMORY;
            file->text = larger;
        }
        errno = 0;
        int count = gzread(stream, file->text + file->size, (unsigned)CHUNK_BYTES);
        int code = Z_OK;
        const char *text = gzerror(stream, &code);
        if (count < 0 || code == Z_BUF_ERROR) {
            if (code == Z_MEM_ERROR)
                return AG_ERROR_MEMORY;
            if (code == Z_ERRNO)
                snprintf(error, error_size, "%s", strerror(errno));
            else if (code == Z_BUF_ERROR)
                snprintf(error, error_size, "the gzip file is cut short");
            else
                snprintf(error, error_size, "the gzip file is damaged (%s)", text);
            return AG_ERROR_INPUT;
        }
        if (count == 0)
            break;
        file->size += (size_t)count;
        if (file->size > text_file_max_bytes())
            return refuse_size(error, error_size);
        if (!gzdirect(stream) && file->size > text_file_max_unpacked_bytes(expected_bytes)) {
            snprintf(error, error_size, "the gzip file holds more than %llu MiB, which is the most in one of %zu bytes",
                     (unsigned long long)text_file_max_unpacked_bytes(expected_bytes) >> 20, expected_bytes);
            return AG_ERROR_INPUT;
        }
    }
    file->text[file->size] = '\0';
    return AG_OK;
}

ag_status text_file_read(const run_context *run, const char *path, char *error, size_t error_size, text_file *out_file)
{
    memset(out_file, 0, sizeof *out_file);
    int descriptor = -1;
    struct stat status;
    ag_status result = AG_OK;
    if (strcmp(path, "-") == 0)
        result = open_standard_input(run, error, error_size, &descriptor);
    else if ((descriptor = input_file_open(run, path, error, error_size)) < 0)
        result = AG_ERROR_INPUT;
    if (!result && fstat(descriptor, &status) != 0) {
        snprintf(error, error_size, "%s", strerror(errno));
        result = AG_ERROR_INPUT;
    }
    gzFile stream = result ? NULL : gzdopen(descriptor, "rb");
    if (!stream) {
        if (descriptor >= 0)
            close(descriptor);
        return result ? result : AG_ERROR_MEMORY;
    }
    gzbuffer(stream, 1 << 17);
    size_t expected_bytes = status.st_size > 0 ? (size_t)status.st_size : 0;
    result = expected_bytes > text_file_max_bytes()
                 ? refuse_size(error, error_size)
                 : read_all(run, stream, expected_bytes, error, error_size, out_file);
    int closed = gzclose_r(stream);
    if (!result && closed != Z_OK) {
        snprintf(error, error_size,
                 closed == Z_BUF_ERROR ? "the gzip file is cut short" : "it cannot be read to its end");
        result = AG_ERROR_INPUT;
    }
    if (result) {
        text_file_reset(out_file);
        return result;
    }
    out_file->device = (uint64_t)status.st_dev;
    out_file->inode = (uint64_t)status.st_ino;
    return AG_OK;
}

void text_file_reset(text_file *file)
{
    free(file->text);
    memset(file, 0, sizeof *file);
}
