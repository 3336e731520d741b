/* text_file.c: see text_file.h. zlib reads plain and gzip files alike.
 * Threads: any. */
#define _POSIX_C_SOURCE 200809L
#include "text/text_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

/* A small gzip file can hold any amount; no scene's text is as large as this. */
static const size_t MAX_BYTES = (size_t)16 << 30;
static const size_t CHUNK_BYTES = (size_t)1 << 20;

static int open_descriptor(const char *path)
{
    if (strcmp(path, "-") == 0)
        return dup(STDIN_FILENO);
    return open(path, O_RDONLY | O_CLOEXEC);
}

/* Reads until the end; *file holds what there is, also on failure. */
static ag_status read_all(gzFile stream, size_t expected_bytes, char *error, size_t error_size, text_file *file)
{
    size_t capacity = expected_bytes + CHUNK_BYTES + 1;
    file->text = malloc(capacity);
    if (!file->text)
        return AG_ERROR_MEMORY;
    for (;;) {
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
        if (file->size > MAX_BYTES) {
            snprintf(error, error_size, "it is larger than %zu GiB", MAX_BYTES >> 30);
            return AG_ERROR_INPUT;
        }
    }
    file->text[file->size] = '\0';
    return AG_OK;
}

ag_status text_file_read(const char *path, char *error, size_t error_size, text_file *out_file)
{
    memset(out_file, 0, sizeof *out_file);
    int descriptor = open_descriptor(path);
    struct stat status;
    if (descriptor < 0 || fstat(descriptor, &status) != 0) {
        snprintf(error, error_size, "%s", strerror(errno));
        if (descriptor >= 0)
            close(descriptor);
        return AG_ERROR_INPUT;
    }
    gzFile stream = gzdopen(descriptor, "rb");
    if (!stream) {
        close(descriptor);
        return AG_ERROR_MEMORY;
    }
    gzbuffer(stream, 1 << 17);
    size_t expected_bytes = S_ISREG(status.st_mode) && status.st_size > 0 ? (size_t)status.st_size : 0;
    ag_status result = expected_bytes > MAX_BYTES ? AG_ERROR_INPUT : AG_OK;
    if (result)
        snprintf(error, error_size, "it is larger than %zu GiB", MAX_BYTES >> 30);
    else
        result = read_all(stream, expected_bytes, error, error_size, out_file);
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
