/* file_system.h: whether a file is this machine's alone, so that locks and mapped memory tell all who use it.
 * Rests on: statfs(2). Threads: any. */
#ifndef AFTERGLOW_FILE_SYSTEM_H
#define AFTERGLOW_FILE_SYSTEM_H

#include <stdbool.h>

/* Returns whether an open file or folder lies on a network's file system, or on one of which that is not known. */
bool file_system_is_network(int descriptor);

#endif
