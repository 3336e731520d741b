/* picture_mark.h: the mark beside a picture that is not complete, and the names of files beside a picture.
 * Flow: main, passes -> [here]. Threads: main's. */
#ifndef AFTERGLOW_PICTURE_MARK_H
#define AFTERGLOW_PICTURE_MARK_H

#include "afterglow/base.h"

#include <stdbool.h>

/* Whether a picture is there, and complete: what was written on the way has a file beside it that says so. */
bool picture_mark_is_complete(const char *outfile);
/* Whether there are outfiles, and all of them are. */
bool picture_mark_all_are_complete(const char **outfiles, int count);

/* The names of the files beside an outfile: the checkpoint, beside the first one, and the mark of a picture that is not
 * complete. To be freed, NULL when out of memory. */
char *picture_mark_checkpoint(const char *outfile);
char *picture_mark_name(const char *outfile);

/* Before the first picture that is not the last one, so that whoever looks knows, whatever happens then. Without the
 * mark the picture would be taken for a finished one: it is not to be written. Errors, with a message on standard
 * error: AG_ERROR_OUTPUT, AG_ERROR_MEMORY. */
ag_status picture_mark_unfinished(const char *outfile);
/* The picture is complete: takes the mark away. */
void picture_mark_finished(const char *outfile);

#endif
