/* import_confinement.h: a process reads below some folders alone, and writes nowhere: the kernel sees to it.
 * Rests on: landlock(7). Flow: import_program -> [here]. Threads: the only one of that process. */
#ifndef AFTERGLOW_IMPORT_CONFINEMENT_H
#define AFTERGLOW_IMPORT_CONFINEMENT_H

#include <stdbool.h>
#include <stddef.h>

/* Confines this process for good. Files that are open stay open. Returns false where the kernel cannot do it. */
bool import_confine_process(char *const *folders, size_t count);

#endif
