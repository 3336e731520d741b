/* texture_cache_folder.h: the folder of texture_cache.h: files without a name, names for them, and the bound of all.
 * Rests on: open(2), O_TMPFILE; linkat(2). Flow: texture_cache -> [here]. Threads: any, and any processes. */
#ifndef AFTERGLOW_TEXTURE_CACHE_FOLDER_H
#define AFTERGLOW_TEXTURE_CACHE_FOLDER_H

#include <stdint.h>

#define TEXTURE_CACHE_ENDING ".afterglow-tiles" /* of the names of its files; others there are left alone */

/* Opens an unnamed empty file in the folder, which is created where it is missing (its parent is not); returns -1 with
 * errno. The file disappears with the process, however it ends. */
int texture_cache_folder_open(const char *folder);

/* Gives such a file a name in its folder; where there is one of that name already, as another process may just have
 * made it, that one stays. Gives 0 or an errno. */
int texture_cache_folder_name(int descriptor, const char *path);

/* Removes those files that were not used for the longest time (that of their last change), until all together take no
 * more than so many bytes; not the one at own_path. */
void texture_cache_folder_bound(const char *folder, uint64_t bytes, const char *own_path);

#endif
