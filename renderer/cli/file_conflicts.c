/* file_conflicts.c: see file_conflicts.h.
 * Threads: main alone. */
#define _GNU_SOURCE
#include "file_conflicts.h"

#include "frame_options.h"
#include "name_hash.h"
#include "picture_files.h"
#include "picture_mark.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LINK_LIMIT = 40 };

/* The identity of the file that a path names: one that is there, or a name in a folder. */
typedef struct named_file {
    const char *path;
    bool is_there, is_regular;
    dev_t device; /* of the file, or of its folder */
    ino_t inode;
    char name[NAME_MAX + 1]; /* in that folder */
} named_file;

/* Returns the path where a file of this name would be made: what a chain of symbolic links ends at. Owned; NULL when
 * out of memory. */
static char *end_of_links(const char *path)
{
    char *end = strdup(path), target[PATH_MAX];
    for (int i = 0; end && i < LINK_LIMIT; i++) {
        const ssize_t length = readlink(end, target, sizeof target);
        if (length < 0)
            break;
        const char *slash = strrchr(end, '/');
        const int kept = target[0] == '/' || !slash ? 0 : (int)(slash + 1 - end);
        char *next;
        if (asprintf(&next, "%.*s%.*s", kept, end, (int)length, target) < 0)
            next = NULL;
        free(end);
        end = next;
    }
    return end;
}

/* Finds the identity of the file that a path names. A folder that is not there gives nothing to compare; the check of
 * the output itself reports it. */
static named_file find(const char *path)
{
    named_file file = {.path = path};
    struct stat status;
    if (stat(path, &status) == 0) {
        file.is_there = true;
        file.is_regular = S_ISREG(status.st_mode);
        file.device = status.st_dev;
        file.inode = status.st_ino;
        return file;
    }
    char *end = end_of_links(path);
    const char *slash = end ? strrchr(end, '/') : NULL;
    char *folder = slash ? strndup(end, (size_t)(slash - end) + 1) : strdup(".");
    if (end && folder && stat(folder, &status) == 0) {
        file.device = status.st_dev;
        file.inode = status.st_ino;
        snprintf(file.name, sizeof file.name, "%s", slash ? slash + 1 : end);
    }
    free(folder);
    free(end);
    return file;
}

/* Returns whether two names lead to one file. Devices and pipes may be named twice, since nothing is replaced there. */
static bool is_one_file(const named_file *a, const named_file *b)
{
    if (a->is_there && b->is_there)
        return a->is_regular && a->device == b->device && a->inode == b->inode;
    if (strcmp(a->path, b->path) == 0)
        return true;
    return !a->is_there && !b->is_there && a->name[0] != '\0' && a->device == b->device && a->inode == b->inode &&
           strcmp(a->name, b->name) == 0;
}

/* Lists the files to be written, those beside pictures included, ended by NULL. NULL when out of memory. */
typedef struct output_list {
    const char **paths; /* the first own_count are the options' own */
    char **made;        /* owned: those beside pictures */
    int count, made_count;
} output_list;

static void output_list_reset(output_list *list)
{
    for (int i = 0; i < list->made_count; i++)
        free(list->made[i]);
    free(list->made);
    free((void *)list->paths);
}

static bool output_list_create(const options *o, output_list *out)
{
    size_t most = 3 * (size_t)o->outfile_count + 3;
    *out = (output_list){.paths = calloc(most, sizeof *out->paths), .made = calloc(most, sizeof *out->made)};
    bool is_whole = out->paths && out->made;
    for (int i = 0; is_whole && i < o->outfile_count; i++) {
        out->paths[out->count++] = o->outfiles[i];
        char *mark = out->made[out->made_count++] = picture_mark_name(o->outfiles[i]);
        out->paths[out->count++] = mark;
        is_whole = mark != NULL;
        if (is_whole && i == 0 && (o->checkpoint_seconds > 0.0 || o->resume)) {
            char *checkpoint = out->made[out->made_count++] = picture_mark_checkpoint(o->outfiles[i]);
            out->paths[out->count++] = checkpoint;
            is_whole = checkpoint != NULL;
        }
    }
    const char *const others[] = {o->stats, o->photons_file, o->render.photon_map_file};
    for (int i = 0; is_whole && i < 3; i++)
        if (others[i])
            out->paths[out->count++] = others[i];
    return is_whole;
}

static void tell_twice(const named_file *a, const named_file *b)
{
    if (strcmp(a->path, b->path) == 0)
        fprintf(stderr, "afterglow: '%s' is to be written twice: give the two different names\n", a->path);
    else
        fprintf(stderr, "afterglow: '%s' and '%s' are one file, which is to be written twice: give two files\n",
                a->path, b->path);
}

static bool has_conflict(const options *o, const output_list *outputs)
{
    const char *config = o->context.color_config ? o->context.color_config : getenv("OCIO");
    const char *const inputs[] = {o->scene && strcmp(o->scene, "-") != 0 ? o->scene : NULL, config};
    for (int i = 0; i < outputs->count; i++) {
        named_file output = find(outputs->paths[i]);
        for (int k = 0; k < i; k++) {
            named_file other = find(outputs->paths[k]);
            if (is_one_file(&other, &output)) {
                tell_twice(&other, &output);
                return true;
            }
        }
        for (int k = 0; k < 2; k++) {
            named_file input = find(inputs[k] ? inputs[k] : "");
            if (inputs[k] && is_one_file(&input, &output)) {
                fprintf(stderr, "afterglow: '%s' is read, as '%s', and cannot be written as well: give another name\n",
                        output.path, input.path);
                return true;
            }
        }
    }
    return false;
}

bool file_conflicts_of_options(const options *o)
{
    output_list outputs;
    bool has = output_list_create(o, &outputs) && has_conflict(o, &outputs);
    output_list_reset(&outputs);
    return has;
}

static bool is_written_over(const options *o, const ag_scene *scene)
{
    output_list outputs;
    bool has = false, is_whole = output_list_create(o, &outputs);
    for (int i = 0; is_whole && i < outputs.count && !has; i++) {
        has = ag_scene_was_read_from(scene, outputs.paths[i]);
        if (has)
            fprintf(stderr,
                    "afterglow: '%s' is a file of the scene, and cannot be written as well: give another name\n",
                    outputs.paths[i]);
    }
    output_list_reset(&outputs);
    return has;
}

bool file_conflicts_with_scene(const options *o, const ag_scene *scene)
{
    const options *all = o->of_all_frames;
    if (is_written_over(o, scene))
        return true;
    bool has = false;
    /* the files that the first frame has read are likely to be those of the others, so all names to be written are
     * compared */
    for (int i = 1; all && o->frame == all->frames.numbers[0] && i < all->frames.count && !has; i++) {
        options other;
        has = frame_options_make(all, all->frames.numbers[i], &other) && !picture_files_are_there(&other) &&
              is_written_over(&other, scene);
        frame_options_reset(&other, all->outfile_count);
    }
    return has;
}

/* --- among frames --- */

/* A use of a file by a frame. Names that lead to one file give the same key. */
typedef struct file_use {
    dev_t device; /* of the file, or of its folder */
    ino_t inode;
    uint64_t name; /* a hash of the name in that folder; 0: the file is there */
    int frame;     /* as it counts in the list */
    int file;      /* of its outputs, or one of the inputs below */
} file_use;

enum { READ_SCENE = -1, READ_SKY = -2 };

typedef struct use_list {
    file_use *uses; /* owned */
    size_t count;
    bool has_common; /* files that all frames share are noted already */
} use_list;

static void add_use(use_list *list, const char *path, int frame, int file)
{
    const named_file f = find(path);
    if (f.is_there ? f.is_regular : f.name[0] != '\0')
        list->uses[list->count++] = (file_use){f.device, f.inode, f.is_there ? 0 : name_hash(f.name), frame, file};
}

/* A file that all frames read under one name is noted once, with the first of them that is rendered. */
static bool is_noted(const use_list *list, const char *pattern)
{
    return pattern && strcmp(pattern, "-") != 0 && (!list->has_common || frames_has_placeholder(pattern));
}

/* Notes the files of one frame. The list has room for all of them. */
static void note_uses(use_list *list, const options *o, const options *one, const output_list *outputs, int frame)
{
    if (is_noted(list, o->scene))
        add_use(list, one->scene, frame, READ_SCENE);
    if (is_noted(list, o->asked.sky_file))
        add_use(list, one->asked.sky_file, frame, READ_SKY);
    for (int i = 0; i < outputs->count; i++)
        if (outputs->paths[i] != one->render.photon_map_file || is_noted(list, o->render.photon_map_file))
            add_use(list, outputs->paths[i], frame, i);
    list->has_common = true;
}

static bool add_uses(use_list *list, const options *o, int frame)
{
    options one;
    output_list outputs = {0};
    const bool is_whole = frame_options_make(o, o->frames.numbers[frame], &one) && output_list_create(&one, &outputs);
    file_use *larger =
        is_whole ? realloc(list->uses, (list->count + (size_t)outputs.count + 2) * sizeof *larger) : NULL;
    if (larger) {
        list->uses = larger;
        if (!picture_files_are_there(&one))
            note_uses(list, o, &one, &outputs, frame);
    }
    output_list_reset(&outputs);
    frame_options_reset(&one, o->outfile_count);
    return larger != NULL;
}

static int compare_keys(const file_use *a, const file_use *b)
{
    if (a->device != b->device)
        return a->device < b->device ? -1 : 1;
    if (a->inode != b->inode)
        return a->inode < b->inode ? -1 : 1;
    return a->name < b->name ? -1 : a->name > b->name;
}

static int compare_uses(const void *a, const void *b)
{
    const file_use *of_a = a, *of_b = b;
    const int by_key = compare_keys(of_a, of_b);
    if (by_key != 0)
        return by_key;
    return of_a->file != of_b->file ? (of_a->file > of_b->file) - (of_a->file < of_b->file)
                                    : (of_a->frame > of_b->frame) - (of_a->frame < of_b->frame);
}

/* Returns whether one frame would write over what another one reads or writes. */
static bool is_conflict(const options *o, const file_use *a, const file_use *b)
{
    const int *numbers = o->frames.numbers;
    return compare_keys(a, b) == 0 && b->file >= 0 && (a->file < 0 || numbers[a->frame] != numbers[b->frame]);
}

static char *path_of(const options *o, const file_use *use)
{
    options one;
    output_list outputs = {0};
    char *path = NULL;
    if (frame_options_make(o, o->frames.numbers[use->frame], &one) && output_list_create(&one, &outputs))
        path = strdup(use->file == READ_SCENE ? one.scene
                      : use->file == READ_SKY ? one.asked.sky_file
                                              : outputs.paths[use->file]);
    output_list_reset(&outputs);
    frame_options_reset(&one, o->outfile_count);
    return path;
}

static ag_status tell_frames(const options *o, const file_use *a, const file_use *b)
{
    char *other = path_of(o, a), *output = path_of(o, b);
    const ag_status status = other && output ? AG_ERROR_ARGUMENT : AG_ERROR_MEMORY;
    if (status == AG_ERROR_ARGUMENT)
        fprintf(
            stderr, "afterglow: '%s' is to be written in frame %d, and %s in frame %d, as '%s': give another name\n",
            output, o->frames.numbers[b->frame], a->file < 0 ? "read" : "written", o->frames.numbers[a->frame], other);
    free(other);
    free(output);
    return status;
}

ag_status file_conflicts_of_frames(const options *o)
{
    use_list list = {0};
    ag_status status = AG_OK;
    for (int i = 0; i < o->frames.count && status == AG_OK; i++)
        status = add_uses(&list, o, i) ? AG_OK : AG_ERROR_MEMORY;
    if (status == AG_OK && list.count > 0)
        qsort(list.uses, list.count, sizeof *list.uses, compare_uses);
    for (size_t i = 1; i < list.count && status == AG_OK; i++)
        if (is_conflict(o, &list.uses[i - 1], &list.uses[i]))
            status = tell_frames(o, &list.uses[i - 1], &list.uses[i]);
    free(list.uses);
    return status;
}
