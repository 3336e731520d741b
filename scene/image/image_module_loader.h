/* image_module_loader.h: finds and opens the image module, once.
 * Flow: image_reader.c, image_file.c (renderer) -> [here] -> image_oiio.cpp. Threads: any. */
#ifndef AFTERGLOW_IMAGE_MODULE_LOADER_H
#define AFTERGLOW_IMAGE_MODULE_LOADER_H

#include "image/image_module.h"

/* Returns the module, which the first call opens: from $AFTERGLOW_MODULE_DIR, then from afterglow/ and
 * ../lib/afterglow/ beside the library or program that this code is linked into, then from where it is installed. NULL
 * on failure, with every path that was tried in message; the next call tries again. */
const image_module *image_module_get(char *message, size_t message_size);

/* Opens the module as image_module_get does, from these folders only, and without remembering it. */
const image_module *image_module_open_from(const char *const *folders, int folder_count, char *message,
                                           size_t message_size);

#endif
