/* png_chunks.h: whether a PNG file's chunks fit into it. Its library takes the memory that a chunk's length promises,
 * up to 2 GiB of a file of some hundred bytes, before it finds that the file ends. PNG pictures
 * within .ico files are not looked at. Rests on: the PNG specification (second edition), 2003, 5. Flow: image_reader,
 * image_levels -> [here]. Threads: pure functions. */
#ifndef AFTERGLOW_PNG_CHUNKS_H
#define AFTERGLOW_PNG_CHUNKS_H

#include <stdbool.h>
#include <stddef.h>

/* Returns what is wrong with the chunks of a PNG file; NULL: nothing, or the bytes are no PNG file. */
const char *png_chunks_wrong(const unsigned char *bytes, size_t size);
/* Returns what is wrong with a file, as png_chunks_wrong does; NULL also where it cannot be read. */
const char *png_file_chunks_wrong(const char *path);

#endif
