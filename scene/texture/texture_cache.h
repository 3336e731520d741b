/* texture_cache.h: tiles of pictures that do not fit into memory, kept between runs: in a folder, a file for each
 * picture, named by the bytes that it was decoded from. A file is written without a name and gets it once it is whole,
 * so that a process that is killed leaves nothing behind and any number may use the folder at once; those that were
 * not used for the longest time go when the folder grows beyond its bound, and stay with whoever has them open.
 * Rests on: open(2), O_TMPFILE; linkat(2). Flow: texture_image_load -> [here] -> texture_store. Threads: one loads. */
#ifndef AFTERGLOW_TEXTURE_CACHE_H
#define AFTERGLOW_TEXTURE_CACHE_H

#include "run_context.h"
#include "texture/texture_set.h"

typedef struct texture_kept texture_kept; /* a picture's file there, open */

/* Returns the key that names a picture's file: a hash of the bytes of the file at path, or of those in memory where
 * bytes is not NULL, and of their encoding. */
hash128 texture_cache_key(const char *path, const unsigned char *bytes, size_t size, image_encoding encoding);

/* Fills *i, of which path and encoding are known, with what texture_cache_finish has written for such a key, and makes
 * it one of those last used. *out_is_found false: there is none, it is damaged, or the picture fits into memory.
 * set->limits names the folder. Errors: AG_ERROR_COLOR, AG_ERROR_MEMORY; text in message. */
ag_status texture_cache_find(run_context *run, const texture_set *set, hash128 key, texture_image *i,
                             bool *out_is_found, char *message, size_t message_size);

/* A file to put tiles into, in the folder that set->limits names. NULL, and told once, where there can be none. */
texture_kept *texture_cache_begin(run_context *run, const texture_set *set);
tile_file *texture_kept_file(texture_kept *k);

/* Gives the file its name: *i holds its tiles, and was made of a picture of that description, which would take
 * whole_bytes in memory. Where that fails, the file is this process's alone. */
void texture_cache_finish(run_context *run, const texture_set *set, texture_kept *k, hash128 key,
                          const texture_image *i, const struct image *description, uint64_t whole_bytes);

void texture_kept_destroy(texture_kept *k); /* NULL is fine; after its tiles. Removes the file if it is damaged */
bool texture_kept_is_damaged(const texture_kept *k);

#endif
