/* frame_options.h: the options of one frame of several: its number in all names and values.
 * Flow: options, frames -> [here] -> main, file_conflicts. Threads: main alone. */
#ifndef AFTERGLOW_FRAME_OPTIONS_H
#define AFTERGLOW_FRAME_OPTIONS_H

#include "options.h"

/* Makes the options of one frame. Returns false when out of memory; *out_one is to be reset in either case, before o
 * is. */
bool frame_options_make(const options *o, int frame, options *out_one);

/* outfile_count: as of the options that it was made of; a name that was added is not freed. */
void frame_options_reset(options *one, int outfile_count);

#endif
