/* file_conflicts.h: one file cannot hold two things, and what is read must not be written over: found out before the
 * work, by name, and by device and inode where files are there.
 * Flow: options -> [here] -> main. Threads: main alone. */
#ifndef AFTERGLOW_FILE_CONFLICTS_H
#define AFTERGLOW_FILE_CONFLICTS_H

#include "options.h"

/* Returns whether two of the files to be written are one, or one of them is the scene's file or the colour config. Says
 * which, on standard error. */
bool file_conflicts_of_options(const options *o);

/* Returns AG_ERROR_ARGUMENT where a frame would write what another one reads or has written, and says which on standard
 * error; or AG_ERROR_MEMORY. */
ag_status file_conflicts_of_frames(const options *o);

/* Returns whether a file to be written is one that the scene was read from; at the first frame, also whether it is one
 * that a later frame is to write. Says which, on standard error. */
bool file_conflicts_with_scene(const options *o, const ag_scene *scene);

#endif
