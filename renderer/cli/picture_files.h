/* picture_files.h: a picture into all the files that were asked for, each with its mark while it is not complete.
 * Flow: passes -> [here] -> picture_mark, the library. Threads: main's. */
#ifndef AFTERGLOW_PICTURE_FILES_H
#define AFTERGLOW_PICTURE_FILES_H

#include "options.h"

/* Returns whether a picture is left out because it may not be written over, and all its files are there and
 * complete. */
bool picture_files_are_there(const options *o);

/* Writes the film to each of the options' files. is_last: the picture is complete, so that its marks go. is_view: the
 * film is another view of a picture that was complete before. Files that are not regular take one complete picture
 * alone. A file that cannot be written does not keep the others from being written. in_out_written: for each file,
 * whether a complete picture was written to it, all false before the first call.
 * Errors: AG_ERROR_OUTPUT (of one of the files, which has been told), AG_CANCELLED, AG_ERROR_MEMORY. */
ag_status picture_files_write(ag_context *context, const options *o, const ag_film *film, bool is_last, bool is_view,
                              bool *in_out_written);

#endif
