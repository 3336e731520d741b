/* shared_bytes.h: bytes that several answers to requests hold at once: they go with the last of them. How many there
 * are in all is counted, so that readers who take long cannot make them pile up.
 * Flow: page_picture -> [here] -> http_server. Threads: the server's alone. */
#ifndef AFTERGLOW_SHARED_BYTES_H
#define AFTERGLOW_SHARED_BYTES_H

#include <stddef.h>

typedef struct shared_bytes {
    unsigned char *bytes; /* owned, by malloc */
    size_t size;
    unsigned holders;
    unsigned *living; /* borrowed: counts the shared bytes of one kind; NULL: not counted */
} shared_bytes;

/* Makes shared bytes with one holder of bytes that it takes over, on failure too. NULL: no memory. */
shared_bytes *shared_bytes_take(unsigned char *bytes, size_t size, unsigned *living);
shared_bytes *shared_bytes_hold(shared_bytes *shared);
void shared_bytes_drop(shared_bytes *shared); /* NULL is fine */

#endif
