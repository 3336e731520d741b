/* frames.h: frame numbers of a sequence, and the names of files with a frame's number in them.
 * Flow: options -> [here] -> main. Threads: main's. */
#ifndef AFTERGLOW_FRAMES_H
#define AFTERGLOW_FRAMES_H

#include <stdbool.h>

typedef struct frame_list {
    int *numbers; /* owned */
    int count;
} frame_list;

enum { FRAMES_MAX = 1000000 };

/* Parses "1-100", "1-100x2", "10-1", "7", and several of these with commas between; numbers from 0 on. Returns false
 * where the text is none of these, or says more frames than FRAMES_MAX. */
bool frames_parse(const char *text, frame_list *out_frames);
void frames_reset(frame_list *frames);

/* Returns whether a name has a placeholder for the number: %d, %04d, or a run of #, one for each digit at least. */
bool frames_has_placeholder(const char *name);
/* Returns the name with the number in every placeholder; to be freed, NULL when out of memory. */
char *frames_name(const char *name, int frame);

#endif
