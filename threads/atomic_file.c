/* atomic_file.c: temporary file beside the target, fsync, rename.
 * Flow: bytes (a picture, statistics) -> [here] -> disk. Threads: any; the slots of pending names are claimed
 * atomically, and may be read by a signal handler at any moment. */
#define _GNU_SOURCE /* O_PATH, strerror_r that returns its text */
#include "atomic_file.h"

#include "atomics.h"
#include "descriptor.h"
#include "file_system.h"
#include "status.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { PENDING_COUNT = 8, LINK_LIMIT = 40, NAME_TRIES = 100 };
static const char TEMPORARY[] = ".afterglow-";
enum { LETTERS = 6, SUFFIX_LENGTH = sizeof TEMPORARY - 1 + LETTERS };
enum { LOOK_UP_EVERY_MS = 20 }; /* while a reader is waited for */

static atomic_u32 no_more_waits; /* independent of other data, so relaxed */

/* Returns 0 where a reader may be waited for, else the errno that says why not. run: NULL, or what may be cancelled. */
static int end_of_waits(const run_context *run)
{
    if (load_relaxed_u32(&no_more_waits))
        return EINTR;
    return run && run_is_cancelled(run) ? ECANCELED : 0;
}

void atomic_file_end_waits(void) { store_relaxed_u32(&no_more_waits, 1); }

/* A temporary file that a signal handler can remove. A writer claims a slot, fills it, and then shows it. A handler
 * takes a shown slot for as long as it reads it, and the writer waits to hide it until then, so that meanwhile neither
 * the name nor the folder can become another file's. */
enum { SLOT_FREE, SLOT_CLAIMED, SLOT_SHOWN, SLOT_TAKEN };
typedef struct pending_slot {
    atomic_u32 state;
    int folder_fd;
    char name[NAME_MAX + 1];
} pending_slot;
static pending_slot pending[PENDING_COUNT];

/* Where the bytes go: to a temporary name in the folder, or (folder_fd < 0) straight into fd. */
typedef struct output {
    int folder_fd;
    int fd;
    pending_slot *slot; /* NULL: all were taken */
    char name[NAME_MAX + 1];
    char temporary_name[NAME_MAX + 1];
} output;

static ag_status failure(const char *path, const char *what, int error, char *message, size_t message_size)
{
    char text[128];
    snprintf(message, message_size, "cannot write '%s': %s%s", path, what, strerror_r(error, text, sizeof text));
    return error == ECANCELED ? AG_CANCELLED : AG_ERROR_OUTPUT;
}

static int close_quietly(int fd)
{
    if (fd < 0)
        return 0;
    /* On Linux, close has closed the descriptor even where it returns EINTR. */
    return close(fd) == 0 || errno == EINTR ? 0 : -1;
}

/* Opens a pipe or device without waiting in open itself, which no signal would end. */
static int open_special(const run_context *run, const char *path)
{
    for (;;) {
        int fd = descriptor_beyond_standard(open(path, O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK));
        if (fd >= 0 || errno != ENXIO) /* ENXIO: a FIFO that nobody reads, or a device that is not there */
            return fd;
        struct stat status;
        const int end = end_of_waits(run);
        if (end != 0 || stat(path, &status) != 0 || !S_ISFIFO(status.st_mode)) {
            errno = end == ECANCELED ? end : ENXIO;
            return -1;
        }
        const struct timespec nap = {0, LOOK_UP_EVERY_MS * 1000000L};
        nanosleep(&nap, NULL);
    }
}

/* Waits until a pipe or device takes something. Returns 0, or an errno. */
static int wait_until_writable(const run_context *run, int fd)
{
    for (;;) {
        struct pollfd at = {.fd = fd, .events = POLLOUT};
        int ready = poll(&at, 1, LOOK_UP_EVERY_MS);
        if (ready > 0)
            return 0; /* where there is an error, write says which */
        if (ready < 0 && errno != EINTR)
            return errno;
        const int end = end_of_waits(run);
        if (end != 0)
            return end;
    }
}

static pending_slot *show_pending(int folder_fd, const char *name)
{
    for (int i = 0; i < PENDING_COUNT; i++) {
        uint32_t expected = SLOT_FREE;
        if (cas_acquire_u32(&pending[i].state, &expected, SLOT_CLAIMED)) {
            pending[i].folder_fd = folder_fd;
            memcpy(pending[i].name, name, strlen(name) + 1);
            store_release_u32(&pending[i].state, SLOT_SHOWN); /* pairs with the load in atomic_file_unlink_pending */
            return &pending[i];
        }
    }
    return NULL;
}

static void hide_pending(pending_slot *slot)
{
    for (;;) {
        uint32_t expected = SLOT_SHOWN;
        /* pairs with the claim in show_pending */
        if (!slot || cas_acquire_release_u32(&slot->state, &expected, SLOT_FREE))
            return;
        sched_yield(); /* the handler runs on another thread, and has only to remove the file */
    }
}

void atomic_file_unlink_pending(void)
{
    const int saved_errno = errno;
    for (int i = 0; i < PENDING_COUNT; i++) {
        uint32_t expected = SLOT_SHOWN;
        if (cas_acquire_u32(&pending[i].state, &expected, SLOT_TAKEN)) { /* pairs with the store in show_pending */
            unlinkat(pending[i].folder_fd, pending[i].name, 0);
            store_release_u32(&pending[i].state, SLOT_SHOWN); /* pairs with hide_pending */
        }
    }
    errno = saved_errno;
}

/* Returns the number of the open descriptor that a path like /dev/stdout stands for, or -1. Opening such a path again
 * would begin at offset 0 of a redirected file; and renaming over it would replace a link in /dev. */
static int descriptor_of(const char *path)
{
    static const char *const folders[] = {"/dev/fd/", "/proc/self/fd/"};
    if (strcmp(path, "/dev/stdout") == 0)
        return STDOUT_FILENO;
    if (strcmp(path, "/dev/stderr") == 0)
        return STDERR_FILENO;
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        const size_t length = strlen(folders[i]);
        if (strncmp(path, folders[i], length) == 0 && path[length] >= '0' && path[length] <= '9') {
            char *end;
            const long number = strtol(path + length, &end, 10);
            if (*end == '\0' && number <= INT_MAX)
                return (int)number;
        }
    }
    return -1;
}

/* Follows symbolic links of the last component, also one that dangles: the link stays, what it names is (re)made. */
static int resolve(const char *path, char out_path[PATH_MAX])
{
    if (strlen(path) >= PATH_MAX) {
        errno = ENAMETOOLONG;
        return -1;
    }
    strcpy(out_path, path);
    for (int i = 0; i < LINK_LIMIT; i++) {
        char target[PATH_MAX];
        if (descriptor_of(out_path) >= 0)
            return 0;
        const ssize_t length = readlink(out_path, target, sizeof target - 1);
        if (length < 0)
            return 0; /* no link, or not there */
        target[length] = '\0';
        char *slash = strrchr(out_path, '/');
        const size_t kept = target[0] == '/' || !slash ? 0 : (size_t)(slash + 1 - out_path);
        if (kept + (size_t)length >= PATH_MAX) {
            errno = ENAMETOOLONG;
            return -1;
        }
        memcpy(out_path + kept, target, (size_t)length + 1);
    }
    errno = ELOOP;
    return -1;
}

static void make_temporary_name(const char *name, char out_name[NAME_MAX + 1])
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz0123456789";
    uint64_t bits = 0;
    if (getrandom(&bits, sizeof bits, GRND_NONBLOCK) != (ssize_t)sizeof bits) {
        struct timespec now;
        clock_gettime(CLOCK_MONOTONIC, &now);
        bits = ((uint64_t)now.tv_nsec ^ ((uint64_t)getpid() << 32)) * 0x9e3779b97f4a7c15u >> 8;
    }
    char suffix[LETTERS + 1] = "";
    for (int i = 0; i < LETTERS; i++, bits /= sizeof letters - 1)
        suffix[i] = letters[bits % (sizeof letters - 1)];
    snprintf(out_name, NAME_MAX + 1, ".%.*s%s%s", NAME_MAX - SUFFIX_LENGTH - 1, name, TEMPORARY, suffix);
}

/* Returns whether make_temporary_name could have made this name for that file. */
static bool is_temporary_name(const char *of_name, const char *name)
{
    char prefix[NAME_MAX + 1];
    int length = snprintf(prefix, sizeof prefix, ".%.*s%s", NAME_MAX - SUFFIX_LENGTH - 1, of_name, TEMPORARY);
    return strncmp(name, prefix, (size_t)length) == 0 && strlen(name + length) == LETTERS &&
           strspn(name + length, "abcdefghijklmnopqrstuvwxyz0123456789") == LETTERS;
}

/* Removes a temporary file that no process writes any more: its writer holds a lock, which the kernel releases when the
 * process ends, however it ends, so that a file that can be locked here is an orphan. */
static void remove_if_orphaned(int folder_fd, const char *name)
{
    struct stat status;
    const int fd =
        descriptor_beyond_standard(openat(folder_fd, name, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY));
    if (fd < 0)
        return;
    if (fstat(fd, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid() &&
        flock(fd, LOCK_EX | LOCK_NB) == 0)
        unlinkat(folder_fd, name, 0);
    close_quietly(fd);
}

/* On a network's file system the lock of another machine's process need not be seen: nothing is removed there. */
static void remove_orphans(const output *out)
{
    if (file_system_is_network(out->folder_fd))
        return;
    const int fd = openat(out->folder_fd, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *folder = fd >= 0 ? fdopendir(fd) : NULL;
    if (!folder) { /* it may be written, not listed */
        close_quietly(fd);
        return;
    }
    for (const struct dirent *entry = readdir(folder); entry; entry = readdir(folder))
        if (is_temporary_name(out->name, entry->d_name))
            remove_if_orphaned(out->folder_fd, entry->d_name);
    closedir(folder);
}

/* Marks a new temporary file as a living process's. False: somebody took it for an orphan just before. */
static bool lock_temporary(int fd)
{
    struct stat status;
    if (flock(fd, LOCK_EX | LOCK_NB) != 0)
        return errno != EWOULDBLOCK; /* a file system without locks: then nobody removes it either */
    return fstat(fd, &status) != 0 || status.st_nlink > 0;
}

/* open() under a fresh name instead of mkostemp: the kernel then applies the umask, which cannot be read without
 * changing it for all threads. The name is shown first, so that no signal can come between the file and its slot. */
static int create_temporary(output *out)
{
    for (int i = 0; i < NAME_TRIES; i++) {
        make_temporary_name(out->name, out->temporary_name);
        out->slot = show_pending(out->folder_fd, out->temporary_name);
        out->fd =
            openat(out->folder_fd, out->temporary_name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
        out->fd = descriptor_beyond_standard(out->fd);
        const bool is_ours = out->fd >= 0 && lock_temporary(out->fd);
        if (is_ours)
            return 0;
        const int error = out->fd >= 0 ? EEXIST : errno;
        close_quietly(out->fd);
        out->fd = -1;
        hide_pending(out->slot);
        out->slot = NULL;
        errno = error;
        if (error != EEXIST && error != EINTR)
            return -1;
    }
    return -1;
}

/* Removes whatever is unfinished and closes all. */
static void abandon(output *out)
{
    close_quietly(out->fd);
    if (out->folder_fd >= 0) {
        unlinkat(out->folder_fd, out->temporary_name, 0);
        hide_pending(out->slot);
        close_quietly(out->folder_fd);
    }
}

/* Opens what path stands for; *out is to be finished or abandoned only after AG_OK. */
static ag_status begin(const run_context *run, const char *path, output *out, char *message, size_t message_size)
{
    char resolved[PATH_MAX];
    struct stat status;
    *out = (output){.folder_fd = -1, .fd = -1};
    if (resolve(path, resolved) != 0)
        return failure(path, "", errno, message, message_size);

    /* 1. An open descriptor, or what is no regular file: directly. */
    const int descriptor = descriptor_of(resolved);
    if (descriptor >= 0) {
        const int flags = fcntl(descriptor, F_GETFL);
        if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY)
            return failure(path, "", EBADF, message, message_size);
        out->fd = fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
        return out->fd >= 0 ? AG_OK : failure(path, "", errno, message, message_size);
    }
    const bool exists = stat(resolved, &status) == 0;
    if (exists && S_ISDIR(status.st_mode))
        return failure(path, "", EISDIR, message, message_size);
    if (exists && !S_ISREG(status.st_mode)) {
        out->fd = open_special(run, resolved);
        const bool has_no_reader = out->fd < 0 && errno == ENXIO && S_ISFIFO(status.st_mode);
        const char *what = has_no_reader ? "it is a pipe that nobody reads: " : "";
        return out->fd >= 0 ? AG_OK : failure(path, what, errno, message, message_size);
    }
    if (!exists && errno != ENOENT && errno != ENOTDIR && errno != EACCES)
        return failure(path, "", errno, message, message_size);

    /* 2. A regular file, or none yet: a temporary file in its folder. */
    char *slash = strrchr(resolved, '/');
    const char *name = slash ? slash + 1 : resolved;
    if (*name == '\0')
        return failure(path, "", *path == '\0' ? ENOENT : EISDIR, message, message_size);
    if (strlen(name) > NAME_MAX)
        return failure(path, "", ENAMETOOLONG, message, message_size);
    strcpy(out->name, name);
    if (slash)
        slash[slash == resolved ? 1 : 0] = '\0';
    const char *folder = slash ? resolved : ".";
    out->folder_fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (out->folder_fd < 0 && errno == EACCES)
        out->folder_fd = open(folder, O_PATH | O_DIRECTORY | O_CLOEXEC); /* it may be writable, though not readable */
    if (out->folder_fd < 0)
        return failure(path, "its folder cannot be opened: ", errno, message, message_size);
    if (exists && faccessat(out->folder_fd, out->name, W_OK, AT_EACCESS) != 0) { /* rename alone would not mind */
        const int error = errno;
        close_quietly(out->folder_fd);
        return failure(path, "", error, message, message_size);
    }
    remove_orphans(out);
    if (create_temporary(out) != 0) {
        const int error = errno;
        close_quietly(out->folder_fd);
        return failure(path, "no file can be made in its folder: ", error, message, message_size);
    }
    if (exists && fchmod(out->fd, status.st_mode & 0777) != 0) {
        const int error = errno;
        abandon(out);
        return failure(path, "", error, message, message_size);
    }
    return AG_OK;
}

static int write_all(const run_context *run, int fd, const void *bytes, size_t size)
{
    const char *next = bytes;
    struct stat status;
    const bool may_wait = fstat(fd, &status) == 0 && !S_ISREG(status.st_mode);
    while (size > 0) {
        const int error = may_wait ? wait_until_writable(run, fd) : 0;
        if (error != 0)
            return error;
        /* what poll promises fits at least PIPE_BUF bytes, also where the descriptor would wait for more */
        const ssize_t written = write(fd, next, may_wait && size > PIPE_BUF ? PIPE_BUF : size);
        if (written < 0 && (errno == EINTR || errno == EAGAIN))
            continue;
        if (written <= 0)
            return written < 0 ? errno : ENOSPC;
        next += written;
        size -= (size_t)written;
    }
    return 0;
}

typedef struct piece_list {
    const run_context *run;
    const atomic_file_piece *pieces;
    int count;
} piece_list;

static int write_pieces(void *user, int fd)
{
    const piece_list *all = user;
    int error = 0;
    for (int i = 0; i < all->count && error == 0; i++)
        error = write_all(all->run, fd, all->pieces[i].bytes, all->pieces[i].size);
    return error;
}

/* Does everything from the first byte to the rename. Returns 0, or -1 with errno. */
static int fill_and_rename(output *out, atomic_file_fill *fill, void *user)
{
    const int error = fill(user, out->fd);
    if (error != 0) {
        errno = error;
        return -1;
    }
    if (out->folder_fd >= 0 && fsync(out->fd) != 0)
        return -1;
    const int lock_fd = fcntl(out->fd, F_DUPFD_CLOEXEC, 0); /* keeps the lock until the file has its name */
    const int closed = close_quietly(out->fd);
    out->fd = lock_fd;
    if (closed != 0) /* the last call where a network file system tells of a failed write */
        return -1;
    const int renamed =
        out->folder_fd < 0 ? 0 : renameat(out->folder_fd, out->temporary_name, out->folder_fd, out->name);
    const int rename_error = errno;
    close_quietly(lock_fd);
    out->fd = -1;
    errno = rename_error;
    return renamed;
}

ag_status atomic_file_write(const run_context *run, const char *path, const void *bytes, size_t size, char *message,
                            size_t message_size)
{
    const atomic_file_piece whole = {bytes, size};
    return atomic_file_write_pieces(run, path, &whole, 1, message, message_size);
}

ag_status atomic_file_write_pieces(const run_context *run, const char *path, const atomic_file_piece *pieces, int count,
                                   char *message, size_t message_size)
{
    piece_list all = {run, pieces, count};
    return atomic_file_write_by(run, path, write_pieces, &all, message, message_size);
}

ag_status atomic_file_write_by(const run_context *run, const char *path, atomic_file_fill *fill, void *user,
                               char *message, size_t message_size)
{
    output out;
    snprintf(message, message_size, "%s", "");
    AG_TRY(begin(run, path, &out, message, message_size));
    ag_status status = AG_OK;
    if (fill_and_rename(&out, fill, user) != 0) {
        const int error = errno;
        abandon(&out);
        return failure(path, "", error, message, message_size);
    }
    if (out.folder_fd >= 0) {
        hide_pending(out.slot);
        /* EBADF: the folder was opened by O_PATH. EINVAL, ENOTSUP: its file system has no fsync of folders. The file is
         * whole in any case. */
        if (fsync(out.folder_fd) != 0 && errno != EBADF && errno != EINVAL && errno != ENOTSUP)
            status =
                failure(path, "it has its name, but its folder cannot be synchronised: ", errno, message, message_size);
        close_quietly(out.folder_fd);
    }
    return status;
}

ag_status atomic_file_check(const char *path, char *message, size_t message_size)
{
    /* A target that is no regular file is only looked at: opening a FIFO would wait for its reader, and end its
     * reading. */
    char resolved[PATH_MAX];
    struct stat status;
    snprintf(message, message_size, "%s", "");
    if (resolve(path, resolved) == 0 && descriptor_of(resolved) < 0 && stat(resolved, &status) == 0 &&
        !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode))
        return faccessat(AT_FDCWD, resolved, W_OK, AT_EACCESS) == 0 ? AG_OK
                                                                    : failure(path, "", errno, message, message_size);
    output out;
    const ag_status result = begin(NULL, path, &out, message, message_size);
    if (result == AG_OK)
        abandon(&out);
    return result;
}
