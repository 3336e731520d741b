/* image_levels.c: see image_levels.h. */
#define _POSIX_C_SOURCE 200809L
#include "image/image_levels.h"

#include "atomics.h"
#include "image/image_module_loader.h"
#include "image/png_chunks.h"
#include "status.h"
#include "text/input_file.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { OPEN_MAX_COUNT = 64 }; /* files, each with two descriptors: the one it was opened by, and the module's own */

/* A file of which parts are read: the module's handle, and the descriptor by which it was opened. */
typedef struct open_levels {
    void *file; /* NULL: there is none */
    int descriptor;
} open_levels;

struct image_levels {
    char *path;
    const image_module *module;
    image_levels_header header;
    struct stat file; /* as it was when it was opened first */
    pthread_mutex_t lock;
    open_levels open; /* under the lock; of no file: it is opened when it is needed */
};

static atomic_u64 open_count; /* relaxed: it only limits how many files stay open */

static void leave_open(void) { fetch_add_relaxed_u64(&open_count, UINT64_MAX); }

static bool stay_open(void)
{
    if (fetch_add_relaxed_u64(&open_count, 1) < OPEN_MAX_COUNT)
        return true;
    leave_open();
    return false;
}

static bool is_same_file(const struct stat *a, const struct stat *b)
{
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino && a->st_size == b->st_size &&
           a->st_mtim.tv_sec == b->st_mtim.tv_sec && a->st_mtim.tv_nsec == b->st_mtim.tv_nsec;
}

bool image_levels_is_unchanged(const image_levels *l)
{
    struct stat now;
    return stat(l->path, &now) == 0 && is_same_file(&l->file, &now);
}

static void close_file(const image_module *module, open_levels *open)
{
    if (!open->file)
        return;
    module->close_levels(open->file);
    close(open->descriptor);
    open->file = NULL;
}

/* Opens the file as of input_file_open. wanted: which file it is to be, else nothing of it is read; NULL: any.
 * out_open->file is NULL where it is another, cannot be opened, holds no levels, or on failure; run: as there.
 * *out_file says which file it is. Errors: those of the module. */
static ag_status open_file(const run_context *run, const image_module *module, const char *path,
                           const struct stat *wanted, open_levels *out_open, image_levels_header *out_header,
                           struct stat *out_file)
{
    char message[1024], text[INPUT_FILE_OPENED_SIZE];
    const int descriptor = input_file_open(run, path, message, sizeof message);
    *out_open = (open_levels){.descriptor = descriptor};
    if (descriptor < 0)
        return AG_OK;
    const char *opened = input_file_opened_path(descriptor, path, text);
    ag_status status = AG_OK;
    if (fstat(descriptor, out_file) == 0 && (!wanted || is_same_file(wanted, out_file)) &&
        !png_file_chunks_wrong(opened))
        status = module->open_levels(opened, path, &out_open->file, out_header, message, sizeof message);
    if (!out_open->file)
        close(descriptor);
    return status;
}

ag_status image_levels_open(const run_context *run, const char *path, image_levels **out_levels)
{
    char message[1024];
    struct stat file;
    open_levels open = {0};
    image_levels_header header;
    *out_levels = NULL;
    const image_module *module = image_module_get(message, sizeof message);
    const ag_status status = module ? open_file(run, module, path, NULL, &open, &header, &file) : AG_OK;
    if (!open.file)
        return status == AG_ERROR_MEMORY ? status : AG_OK;
    image_levels *l = calloc(1, sizeof *l);
    char *copy = strdup(path);
    if (!l || !copy) {
        free(l);
        free(copy);
        close_file(module, &open);
        return AG_ERROR_MEMORY;
    }
    *l = (image_levels){.path = copy, .module = module, .header = header, .file = file};
    pthread_mutex_init(&l->lock, NULL);
    if (stay_open())
        l->open = open;
    else
        close_file(module, &open);
    *out_levels = l;
    return AG_OK;
}

void image_levels_close(image_levels *l)
{
    if (!l)
        return;
    if (l->open.file)
        leave_open();
    close_file(l->module, &l->open);
    pthread_mutex_destroy(&l->lock);
    free(l->path);
    free(l);
}

const image_levels_header *image_levels_describe(const image_levels *l) { return &l->header; }

static bool is_same_header(const image_levels_header *a, const image_levels_header *b)
{
    bool is_same = a->level_count == b->level_count && a->picture.channel_count == b->picture.channel_count &&
                   a->file_channel_count == b->file_channel_count && a->picture.type == b->picture.type;
    for (int k = 0; k < a->level_count && is_same; k++) {
        const image_level *of_a = &a->levels[k], *of_b = &b->levels[k];
        is_same = of_a->width == of_b->width && of_a->height == of_b->height &&
                  of_a->tile_width_bits == of_b->tile_width_bits && of_a->tile_height_bits == of_b->tile_height_bits;
    }
    return is_same;
}

/* Opens the picture to read one part; out_open->file is NULL where that fails. Whether the scene may read the file was
 * checked when it was opened first. Errors: as image_levels_read. */
static ag_status open_again(const image_levels *l, open_levels *out_open)
{
    struct stat file;
    image_levels_header header;
    AG_TRY(open_file(NULL, l->module, l->path, &l->file, out_open, &header, &file));
    if (out_open->file && !is_same_header(&l->header, &header)) /* it has changed since it was opened first */
        close_file(l->module, out_open);
    return out_open->file ? AG_OK : AG_ERROR_INPUT;
}

ag_status image_levels_read(image_levels *l, int level, int x, int y, int channel_begin, int channel_end, bool as_bytes,
                            void *out_pixels)
{
    pthread_mutex_lock(&l->lock);
    open_levels open = l->open;
    const bool was_open = open.file;
    ag_status status = was_open ? AG_OK : open_again(l, &open);
    if (status == AG_OK)
        status =
            l->module->read_tile(open.file, &l->header, level, x, y, channel_begin, channel_end, as_bytes, out_pixels);
    if (open.file && !was_open) {
        if (stay_open())
            l->open = open;
        else
            close_file(l->module, &open);
    }
    pthread_mutex_unlock(&l->lock);
    return status;
}
