/* module_folders.h: where parts of Afterglow lie that are found while it runs: the image module, the import program.
 * Flow: image_module_loader, import_file (readers) -> [here]. Threads: any. */
#ifndef AFTERGLOW_MODULE_FOLDERS_H
#define AFTERGLOW_MODULE_FOLDERS_H

#include <limits.h>

enum { MODULE_FOLDERS_MAX = 4, MODULE_PATH_MAX = PATH_MAX + 64 };

/* Folders in the order in which they are to be tried. */
typedef struct module_folders {
    char paths[MODULE_FOLDERS_MAX][PATH_MAX + 32];
    int count;
} module_folders;

/* Finds the folders: $AFTERGLOW_MODULE_DIR, then afterglow/ and ../lib/afterglow/ beside the library or program that
 * this code is linked into, then the folder of installation. */
void module_folders_find(module_folders *out_folders);

#endif
