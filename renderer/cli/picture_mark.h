/* picture_mark.h: the mark beside a picture that is not complete, and the names of files beside a picture.
 * Flow: main, passes -> [here]. Threads: main's. */
#ifndef AFTERGLOW_PICTURE_MARK_H
#define AFTERGLOW_PICTURE_MARK_H

#include "afterglow/base.h"

#include <stdbool.h>

/* Returns whether a picture is there and complete: a picture that was written on the way has a mark, a file
 * beside it. */
bool picture_mark_is_complete(const char *outfile);
/* Returns whether there are outfiles, and all of them are there and complete. */
bool picture_mark_all_are_complete(const char **outfiles, int count);

/* Return the names of the files beside an outfile: the checkpoint, beside the first one, and the mark of a picture that
 * is not complete. To be freed, NULL when out of memory. */
char *picture_mark_checkpoint(const char *outfile);
char *picture_mark_name(const char *outfile);

/* To be called before a picture is written for the first time that is not the final one, so that others can tell,
 * whatever happens afterwards. Where the mark cannot be written, the picture is not to be written either, since it
 * would be taken for a finished one. Errors, with a message on standard error: AG_ERROR_OUTPUT, AG_ERROR_MEMORY. */
ag_status picture_mark_unfinished(const char *outfile);
/* Removes the mark, once the picture is complete. */
void picture_mark_finished(const char *outfile);

#endif
