/* input_file.h: the one way in which files of a scene are opened: what is no regular file is refused, nothing is waited
 * for, and it is noted which files were read.
 * Rests on: open(2). Flow: readers -> [here] -> text_file, ply_stream, gltf_buffers. Threads: one per scene. */
#ifndef AFTERGLOW_INPUT_FILE_H
#define AFTERGLOW_INPUT_FILE_H

#include "run_context.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Which files a scene was read from. A run that reads one points to it. */
typedef struct input_files {
    struct input_file_number {
        uint64_t device, inode;
    } * read; /* owned */
    size_t count, capacity;
    /* Of a scene that is not trusted: */
    bool is_confined;
    const char *scene; /* its path, which may be read wherever it lies; borrowed */
    char **roots;      /* [root_count], owned: the folders below which files may be read, without links */
    size_t root_count;
} input_files;

void input_files_reset(input_files *files);

/* From here on files are read below the scene's own folder, and below those named, alone. scene: borrowed; "-": the
 * working folder is its own. False: memory is short, or a folder is not there; *out_wrong is then that one, or NULL. */
bool input_files_confine(input_files *files, const char *scene, const char *const *folders, size_t count,
                         const char **out_wrong);
bool input_files_has(const input_files *files, uint64_t device, uint64_t inode);

/* A descriptor to read from, above the standard ones. run may be NULL; where it has input_files, the file is noted
 * there. Where it cannot be opened, is no regular file (a FIFO or a device could be waited for, or read, without end)
 * or lies where a confined scene may not read, whether there is such a file or not, -1 is returned and error, of
 * error_size bytes, says why, without the path. */
int input_file_open(const run_context *run, const char *path, char *error, size_t error_size);

/* Opens a file as a stream that has been opened or asked for before; returns NULL where it cannot be opened, or is no
 * regular file any more. */
FILE *input_file_stream(const char *path);

/* The path by which a library that opens files itself opens this very file, whatever its name leads to by now; path,
 * its name, where there is none (no /proc). Valid as long as the descriptor is open, and out_text. */
enum { INPUT_FILE_OPENED_SIZE = 64 };
const char *input_file_opened_path(int descriptor, const char *path, char out_text[INPUT_FILE_OPENED_SIZE]);

/* A number that differs where a file may have changed; 0 where that cannot be told. */
uint64_t input_file_version(const char *path);

/* Whether the scene may know if there is a file of that name; else error says why not. Asked before a folder is
 * searched, or a name tried: what it answers does not depend on whether there is such a file. */
bool input_file_may_ask(const run_context *run, const char *path, char *error, size_t error_size);

/* Whether a file may be read that a library opens by its name; notes it as input_file_open does. */
bool input_file_allow(const run_context *run, const char *path, char *error, size_t error_size);
/* input_file_open for a file that the user has named, not the scene, which may lie anywhere. */
bool input_file_allow_named(const run_context *run, const char *path, char *error, size_t error_size);

#endif
