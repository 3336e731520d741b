/* texture_file_levels.h: pictures whose files hold tiles and coarser levels: these are used as they are, in memory
 * where they fit, else read tile by tile as they are asked for. Flow: texture_image_load -> [here] -> image_levels,
 * texture_store. Threads: one loads; then any number look up. */
#ifndef AFTERGLOW_TEXTURE_FILE_LEVELS_H
#define AFTERGLOW_TEXTURE_FILE_LEVELS_H

#include "texture/texture_set.h"

typedef struct texture_file_levels texture_file_levels;

/* Fills *i, of which path and encoding are known so far, with pixels and mips; in the store of the set, where it is not
 * NULL and does not keep so large a picture. *out_is_read false, with AG_OK: the file holds no levels, or its colours
 * ask for more than a curve and a matrix; it is to be read whole. Errors: AG_ERROR_INPUT, AG_ERROR_COLOR,
 * AG_ERROR_MEMORY, AG_CANCELLED; text in message. */
ag_status texture_file_levels_read(run_context *run, const texture_set *set, texture_image *i, bool *out_is_read,
                                   char *message, size_t message_size);
void texture_file_levels_destroy(texture_file_levels *l); /* NULL is fine; after the tiles that were lent */

/* The fault of the file that tiles are read from, as the end of a sentence that begins with its name; or NULL. */
const char *texture_file_levels_problem(const texture_file_levels *l);

/* A fingerprint of a file's bytes; where it cannot be read, one like no other. */
hash128 texture_file_content(const char *path);

#endif
