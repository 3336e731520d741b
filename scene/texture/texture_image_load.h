/* texture_image_load.h: pictures of textures, from files into the set of a scene, each once.
 * Flow: readers -> [here] -> image_reader, texture_image, texture_store. Threads: one per scene; the run's work on
 * large pictures. */
#ifndef AFTERGLOW_TEXTURE_IMAGE_LOAD_H
#define AFTERGLOW_TEXTURE_IMAGE_LOAD_H

#include "run_context.h"
#include "texture/texture_set.h"

/* Loads a picture into the set's ownership, once for each path and encoding; of a name as texture_udim.h has them all
 * tiles that there are. Three channels or more are taken for red, green, blue and alpha, one or two for grey and alpha;
 * what is beyond is left out. Files are noted by the run, and may be refused by it. Errors: as of image_read,
 * AG_ERROR_COLOR, AG_CANCELLED; text in message. */
ag_status texture_image_load(run_context *run, texture_set *set, const char *path, image_encoding encoding,
                             uint32_t *out_index, char *message, size_t message_size);
/* Returns whether a file of that name exists, or one of its tiles; false where the scene is not allowed to look. */
bool texture_image_is_there(const run_context *run, const char *path);
/* From a PNG or JPEG file in memory, once for each name, which is to differ from all paths, and encoding. */
ag_status texture_image_load_memory(run_context *run, texture_set *set, const char *name, const unsigned char *bytes,
                                    size_t size, image_encoding encoding, uint32_t *out_index, char *message,
                                    size_t message_size);
/* From pixels, which are copied, once for each name, which is to differ from all paths, and encoding. version: of the
 * pixels of that name, which are kept from scene to scene as long as it is the same; 0: they are not. */
ag_status texture_image_load_pixels(run_context *run, texture_set *set, const char *name, const struct image *pixels,
                                    uint64_t version, image_encoding encoding, uint32_t *out_index, char *message,
                                    size_t message_size);

#endif
