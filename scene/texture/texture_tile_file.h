/* texture_tile_file.h: files of tiles that do not fit into memory: a temporary one, or one that is kept
 * (texture_cache). Rests on: open(2), O_TMPFILE. Flow: texture_store -> [here]. Threads: any number write and read at
 * once. */
#ifndef AFTERGLOW_TEXTURE_TILE_FILE_H
#define AFTERGLOW_TEXTURE_TILE_FILE_H

#include "atomics.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Where tiles are put one behind the other. */
typedef struct tile_file {
    int descriptor;        /* -1: not made yet */
    bool is_checked;       /* each tile has a checksum */
    atomic_u64 size_bytes; /* relaxed: each addition claims a part of the file */
    atomic_u32 is_damaged; /* relaxed: a checksum was wrong; read behind a barrier of the pass */
} tile_file;

/* A descriptor of an empty file without a name in $TMPDIR, so that nothing is left behind however the process ends;
 * -1 with errno. */
int tile_file_open(void);
/* false with errno. */
bool tile_file_write(int file, const unsigned char *bytes, size_t size, uint64_t offset);
bool tile_file_read(int file, unsigned char *bytes, size_t size, uint64_t offset);

#endif
