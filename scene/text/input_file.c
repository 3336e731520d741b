/* input_file.c: see input_file.h.
 * Threads: see input_file.h. */
#define _GNU_SOURCE
#include "text/input_file.h"

#include "descriptor.h"
#include "math/hash128.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void input_files_reset(input_files *files)
{
    for (size_t i = 0; i < files->root_count; i++)
        free(files->roots[i]);
    free(files->roots);
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

/* --- confined scenes --- */

/* The folder of a path, without links; NULL with errno. To be freed. */
static char *resolve_folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
    char *resolved = folder ? realpath(folder, NULL) : NULL;
    int error = errno;
    free(folder);
    errno = error;
    return resolved;
}

bool input_files_confine(input_files *files, const char *scene, const char *const *folders, size_t count,
                         const char **out_wrong)
{
    *out_wrong = NULL;
    files->is_confined = true;
    files->scene = scene;
    files->roots = calloc(count + 1, sizeof *files->roots);
    if (!files->roots)
        return false;
    for (size_t i = 0; i <= count; i++) {
        bool is_scenes = i == count;
        char *root = is_scenes ? resolve_folder_of(strcmp(scene, "-") == 0 ? "./" : scene) : realpath(folders[i], NULL);
        if (!root && is_scenes)
            continue; /* it cannot be read either, which is said then */
        if (!root) {
            *out_wrong = folders[i];
            return false;
        }
        files->roots[files->root_count++] = root;
    }
    return true;
}

/* path: without links. */
static bool is_below_root(const input_files *files, const char *path)
{
    for (size_t i = 0; i < files->root_count; i++) {
        size_t length = strlen(files->roots[i]);
        if (length == 1 ||
            (strncmp(path, files->roots[i], length) == 0 && (path[length] == '/' || path[length] == '\0')))
            return true;
    }
    return false;
}

/* Whether a file may be read; one that is not there, by its folder, so that nothing is told of what lies elsewhere. */
static bool is_allowed(const input_files *files, const char *path)
{
    if (!files || !files->is_confined || strcmp(path, files->scene) == 0)
        return true;
    char *resolved = realpath(path, NULL);
    if (!resolved)
        resolved = resolve_folder_of(path);
    bool is_below = resolved && is_below_root(files, resolved);
    free(resolved);
    return is_below;
}

/* Links may change between the question and the opening, so the open file is asked after again. */
static bool is_opened_allowed(const input_files *files, const char *path, int descriptor)
{
    char link[64], target[PATH_MAX];
    if (!files || !files->is_confined || strcmp(path, files->scene) == 0)
        return true;
    snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    ssize_t length = readlink(link, target, sizeof target - 1);
    if (length <= 0)
        return false;
    target[length] = '\0';
    return is_below_root(files, target);
}

static bool note(input_files *files, const struct stat *status)
{
    struct input_file_number number = {(uint64_t)status->st_dev, (uint64_t)status->st_ino};
    if (!files || input_files_has(files, number.device, number.inode))
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

/* Whether an open file is a regular one that may be read. */
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

static const char OUTSIDE[] = "a confined scene may not read it: it lies outside of the scene's folder";

uint64_t input_file_version(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode))
        return 0;
    const uint64_t parts[] = {(uint64_t)status.st_dev, (uint64_t)status.st_ino, (uint64_t)status.st_size,
                              (uint64_t)status.st_mtim.tv_sec, (uint64_t)status.st_mtim.tv_nsec};
    hash128 hash = hash128_begin();
    hash128_add(&hash, parts, sizeof parts);
    return hash.bits[0] | 1; /* pictures in memory have even ones */
}

bool input_file_may_ask(const run_context *run, const char *path, char *error, size_t error_size)
{
    if (is_allowed(run ? run->inputs : NULL, path))
        return true;
    snprintf(error, error_size, "%s", OUTSIDE);
    return false;
}

int input_file_open(const run_context *run, const char *path, char *error, size_t error_size)
{
    const input_files *files = run ? run->inputs : NULL;
    if (!input_file_may_ask(run, path, error, error_size))
        return -1;
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
    if (!is_opened_allowed(files, path, descriptor))
        snprintf(error, error_size, "%s", OUTSIDE);
    else if (is_fit(run, descriptor, error, error_size))
        return descriptor;
    close(descriptor);
    return -1;
}

FILE *input_file_stream(const char *path)
{
    char error[128];
    const int descriptor = input_file_open(NULL, path, error, sizeof error);
    FILE *file = descriptor >= 0 ? fdopen(descriptor, "rb") : NULL;
    if (descriptor >= 0 && !file)
        close(descriptor);
    return file;
}

const char *input_file_opened_path(int descriptor, const char *path, char out_text[INPUT_FILE_OPENED_SIZE])
{
    snprintf(out_text, INPUT_FILE_OPENED_SIZE, "/proc/self/fd/%d", descriptor);
    return access(out_text, R_OK) == 0 ? out_text : path;
}

bool input_file_allow(const run_context *run, const char *path, char *error, size_t error_size)
{
    int descriptor = input_file_open(run, path, error, error_size);
    if (descriptor >= 0)
        close(descriptor);
    return descriptor >= 0;
}

bool input_file_allow_named(const run_context *run, const char *path, char *error, size_t error_size)
{
    input_files *files = run ? run->inputs : NULL;
    const bool is_confined = files && files->is_confined;
    if (files)
        files->is_confined = false;
    const bool is_fine = input_file_allow(run, path, error, error_size);
    if (files)
        files->is_confined = is_confined;
    return is_fine;
}
