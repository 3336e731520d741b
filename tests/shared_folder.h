/* shared_folder.h: where the material for tests that is not part of the repository lies, if it is there.
 * A test that cannot do without it prints "SKIPPED: why" and exits with SHARED_FOLDER_SKIP. Threads: any. */
#ifndef AFTERGLOW_TESTS_SHARED_FOLDER_H
#define AFTERGLOW_TESTS_SHARED_FOLDER_H

#include <stddef.h>
#include <sys/stat.h>

enum { SHARED_FOLDER_SKIP = 77 };

/* The folder "shared" beside the source folder; NULL where there is none. */
static inline const char *shared_folder(void)
{
    static const char PATH[] = AG_SOURCE_DIR "/../shared";
    struct stat status;
    return stat(PATH, &status) == 0 && S_ISDIR(status.st_mode) ? PATH : NULL;
}

#endif
