/* path.h: a file's path within a folder.
 * Flow: forty_rooms, run_group -> [here]. Threads: any. */
#ifndef AFTERGLOW_PERF_PATH_H
#define AFTERGLOW_PERF_PATH_H

#include <stdbool.h>
#include <stdio.h>

#define PATH_SIZE 4096

/* False when it does not fit, told on standard error. */
static inline bool path_join(const char *folder, const char *name, char out_path[PATH_SIZE])
{
    const int length = snprintf(out_path, PATH_SIZE, "%s/%s", folder, name);
    if (length < 0 || length >= PATH_SIZE) {
        fprintf(stderr, "%s: error: the path is too long\n", folder);
        return false;
    }
    return true;
}

#endif
