/* descriptor.h: files that are opened here never become standard input, output or error. A process may have been
 * started with one of the three closed; the next file opened would take its number, and messages would be written into
 * that file. Rests on: fcntl(2). Threads: any. */
#ifndef AFTERGLOW_DESCRIPTOR_H
#define AFTERGLOW_DESCRIPTOR_H

/* Takes a descriptor over and returns one for the same open file, above the standard three and closed by exec. -1 stays
 * -1, with its errno; on failure the descriptor is closed, -1 is returned, and errno says why. */
int descriptor_beyond_standard(int descriptor);

#endif
