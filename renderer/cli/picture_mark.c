/* picture_mark.c: see picture_mark.h. */
#define _POSIX_C_SOURCE 200809L
#include "picture_mark.h"

#include "name_hash.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char UNFINISHED[] = ".afterglow-unfinished", CHECKPOINT[] = ".afterglow-checkpoint";

/* Returns the picture's name with the suffix, or NULL; to be freed. Where that is longer than a file's name may be, the
 * end of the picture's name is replaced by a hash of all of it (FNV-1a). */
static char *beside(const char *outfile, const char *suffix)
{
    enum { HASH_LENGTH = 17 }; /* a hyphen and 16 digits */
    const char *slash = strrchr(outfile, '/'), *base = slash ? slash + 1 : outfile;
    size_t folder = (size_t)(base - outfile), length = strlen(base), suffix_length = strlen(suffix);
    size_t kept = length;
    char hash[HASH_LENGTH + 1] = "";
    if (length + suffix_length > NAME_MAX) {
        snprintf(hash, sizeof hash, "-%016llx", (unsigned long long)name_hash(base));
        kept = NAME_MAX - suffix_length - HASH_LENGTH;
    }
    size_t size = folder + kept + sizeof hash + suffix_length;
    char *name = malloc(size);
    if (name)
        snprintf(name, size, "%.*s%s%s", (int)(folder + kept), outfile, hash, suffix);
    return name;
}

char *picture_mark_checkpoint(const char *outfile) { return beside(outfile, CHECKPOINT); }

char *picture_mark_name(const char *outfile) { return beside(outfile, UNFINISHED); }

/* Writes the mark; returns 0, or -1 with errno. A new mark that cannot be filled is removed, for the unfinished picture
 * is not written then, and the one before it, which stays, may be complete. */
static int write_mark(const char *name)
{
    static const char TEXT[] = "The picture beside this file is what there was before its render was complete.\n";
    const int how = O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
    int file = open(name, how | O_EXCL, 0666);
    const bool is_new = file >= 0;
    if (!is_new && errno == EEXIST)
        file = open(name, how, 0666);
    if (file < 0)
        return -1;
    bool is_written = write(file, TEXT, sizeof TEXT - 1) == (ssize_t)sizeof TEXT - 1 && fsync(file) == 0;
    int error = errno;
    if (close(file) == 0 && is_written)
        return 0;
    error = is_written ? errno : error;
    if (is_new)
        unlink(name);
    errno = error;
    return -1;
}

ag_status picture_mark_unfinished(const char *outfile)
{
    char *name = picture_mark_name(outfile);
    if (!name)
        return AG_ERROR_MEMORY;
    ag_status status = AG_OK;
    if (write_mark(name) != 0) {
        fprintf(
            stderr,
            "afterglow: error: cannot write '%s': %s; without this mark '%s' would be taken for a finished picture, "
            "so the unfinished one is not written\n",
            name, strerror(errno), outfile);
        status = AG_ERROR_OUTPUT;
    }
    free(name);
    return status;
}

void picture_mark_finished(const char *outfile)
{
    char *name = picture_mark_name(outfile);
    if (name && unlink(name) != 0 && errno != ENOENT)
        fprintf(stderr, "afterglow: warning: '%s' is complete, but its mark cannot be removed: '%s': %s\n", outfile,
                name, strerror(errno));
    free(name);
}

bool picture_mark_is_complete(const char *outfile)
{
    struct stat info;
    char *mark = picture_mark_name(outfile);
    bool is_marked = !mark || access(mark, F_OK) == 0;
    free(mark);
    return !is_marked && stat(outfile, &info) == 0 && S_ISREG(info.st_mode) && info.st_size > 0;
}

bool picture_mark_all_are_complete(const char **outfiles, int count)
{
    for (int i = 0; i < count; i++)
        if (!picture_mark_is_complete(outfiles[i]))
            return false;
    return count > 0;
}
