/* texture_cache_folder.c: see texture_cache_folder.h. */
#define _GNU_SOURCE
#include "texture/texture_cache_folder.h"

#include "descriptor.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int texture_cache_folder_open(const char *folder)
{
    if (mkdir(folder, 0777) != 0 && errno != EEXIST)
        return -1;
    return descriptor_beyond_standard(open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666));
}

int texture_cache_folder_name(int descriptor, const char *path)
{
    char own[64];
    snprintf(own, sizeof own, "/proc/self/fd/%d", descriptor);
    return linkat(AT_FDCWD, own, AT_FDCWD, path, AT_SYMLINK_FOLLOW) == 0 || errno == EEXIST ? 0 : errno;
}

typedef struct kept_file {
    char *path;
    uint64_t size_bytes;
    struct timespec used_at;
} kept_file;

typedef struct kept_files {
    kept_file *items;
    size_t count, capacity;
    uint64_t bytes;
} kept_files;

static bool has_ending(const char *name)
{
    const size_t length = strlen(name), ending = strlen(TEXTURE_CACHE_ENDING);
    return length > ending && strcmp(name + length - ending, TEXTURE_CACHE_ENDING) == 0;
}

/* False: out of memory. Files that are gone by now are left out. */
static bool add_file(kept_files *files, const char *folder, const char *name)
{
    struct stat status;
    char *path;
    if (asprintf(&path, "%s/%s", folder, name) < 0)
        return false;
    if (lstat(path, &status) != 0 || !S_ISREG(status.st_mode)) {
        free(path);
        return true;
    }
    if (files->count == files->capacity) {
        const size_t capacity = files->capacity ? 2 * files->capacity : 64;
        kept_file *larger = realloc(files->items, capacity * sizeof *larger);
        if (!larger) {
            free(path);
            return false;
        }
        files->items = larger;
        files->capacity = capacity;
    }
    files->items[files->count++] = (kept_file){path, (uint64_t)status.st_size, status.st_mtim};
    files->bytes += (uint64_t)status.st_size;
    return true;
}

static int by_use(const void *first, const void *second)
{
    const kept_file *a = first, *b = second;
    if (a->used_at.tv_sec != b->used_at.tv_sec)
        return a->used_at.tv_sec < b->used_at.tv_sec ? -1 : 1;
    return a->used_at.tv_nsec < b->used_at.tv_nsec ? -1 : a->used_at.tv_nsec > b->used_at.tv_nsec;
}

void texture_cache_folder_bound(const char *folder, uint64_t bytes, const char *own_path)
{
    kept_files files = {0};
    DIR *all = opendir(folder);
    bool is_good = all;
    for (struct dirent *entry; is_good && (entry = readdir(all));)
        if (has_ending(entry->d_name))
            is_good = add_file(&files, folder, entry->d_name);
    if (all)
        closedir(all);
    if (files.count > 1)
        qsort(files.items, files.count, sizeof *files.items, by_use);
    for (size_t k = 0; k < files.count; k++) {
        if (files.bytes > bytes && strcmp(files.items[k].path, own_path) != 0 && unlink(files.items[k].path) == 0)
            files.bytes -= files.items[k].size_bytes;
        free(files.items[k].path);
    }
    free(files.items);
}
