/* texture_tile_file.h: the temporary file of tiles that do not fit into memory.
 * Rests on: open(2), O_TMPFILE. Flow: texture_store -> [here]. Threads: any number write and read at once. */
#ifndef AFTERGLOW_TEXTURE_TILE_FILE_H
#define AFTERGLOW_TEXTURE_TILE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A descriptor of an empty file without a name in $TMPDIR, so that nothing is left behind however the process ends;
 * -1 with errno. */
int tile_file_open(void);
/* false with errno. */
bool tile_file_write(int file, const unsigned char *bytes, size_t size, uint64_t offset);
bool tile_file_read(int file, unsigned char *bytes, size_t size, uint64_t offset);

#endif
