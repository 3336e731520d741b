/* picture_files.c: see picture_files.h. */
#define _POSIX_C_SOURCE 200809L
#include "picture_files.h"

#include "picture_mark.h"
#include "status.h"

#include <stdio.h>
#include <sys/stat.h>

bool picture_files_are_there(const options *o)
{
    return o->no_clobber && picture_mark_all_are_complete(o->outfiles, o->outfile_count);
}

static bool is_regular(const char *outfile)
{
    struct stat info;
    return stat(outfile, &info) != 0 || S_ISREG(info.st_mode);
}

static bool is_pipe(const char *outfile)
{
    struct stat info;
    return stat(outfile, &info) == 0 && S_ISFIFO(info.st_mode);
}

static ag_status write_one(ag_context *context, const options *o, int index, const ag_film *film, bool is_last)
{
    const char *outfile = o->outfiles[index];
    if (!is_last)
        AG_TRY(picture_mark_unfinished(outfile));
    if (is_pipe(outfile) && o->verbosity >= 0)
        fprintf(stderr, "afterglow: '%s' is a pipe: it is written when somebody reads it\n", outfile);
    const ag_output_settings output = options_output(o, index);
    AG_TRY(ag_film_write(context, film, &output, outfile));
    if (is_last)
        picture_mark_finished(outfile);
    return AG_OK;
}

ag_status picture_files_write(ag_context *context, const options *o, const ag_film *film, bool is_last, bool is_view,
                              bool *in_out_written)
{
    ag_status status = AG_OK;
    for (int i = 0; i < o->outfile_count; i++) {
        if (!is_regular(o->outfiles[i]) && (!is_last || in_out_written[i])) {
            if (is_view && o->verbosity >= 0)
                fprintf(stderr, "afterglow: '%s' is no regular file: it has the picture, and not the view\n",
                        o->outfiles[i]);
            continue;
        }
        in_out_written[i] = false;
        ag_status written = write_one(context, o, i, film, is_last);
        in_out_written[i] = is_last && written == AG_OK;
        if (written != AG_OK && written != AG_ERROR_OUTPUT)
            return written;
        status = status == AG_OK ? written : status;
    }
    return status;
}
