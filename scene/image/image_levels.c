/* image_levels.c: see image_levels.h. */
#define _POSIX_C_SOURCE 200809L
#include "image/image_levels.h"

#include "atomics.h"
#include "image/image_module_loader.h"
#include "image/png_chunks.h"
#include "status.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { OPEN_MAX_COUNT = 128 };

struct image_levels {
    char *path;
    const image_module *module;
    image_levels_header header;
    struct stat file; /* as it was when it was opened first */
    pthread_mutex_t lock;
    void *open; /* under the lock; NULL: opened when it is needed */
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

ag_status image_levels_open(const char *path, image_levels **out_levels)
{
    char message[1024];
    *out_levels = NULL;
    struct stat file;
    const image_module *module = image_module_get(message, sizeof message);
    if (!module || stat(path, &file) != 0 || !S_ISREG(file.st_mode) || png_file_chunks_wrong(path))
        return AG_OK;
    image_levels_header header;
    void *open;
    const ag_status status = module->open_levels(path, &open, &header, message, sizeof message);
    if (status != AG_OK || !open)
        return status == AG_ERROR_MEMORY ? status : AG_OK;
    image_levels *l = calloc(1, sizeof *l);
    char *copy = strdup(path);
    if (!l || !copy) {
        free(l);
        free(copy);
        module->close_levels(open);
        return AG_ERROR_MEMORY;
    }
    *l = (image_levels){.path = copy, .module = module, .header = header, .file = file};
    pthread_mutex_init(&l->lock, NULL);
    if (stay_open())
        l->open = open;
    else
        module->close_levels(open);
    *out_levels = l;
    return AG_OK;
}

void image_levels_close(image_levels *l)
{
    if (!l)
        return;
    if (l->open) {
        l->module->close_levels(l->open);
        leave_open();
    }
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

/* Opens the picture for the reading of one part; *out_open is NULL where that fails. Errors: as image_levels_read. */
static ag_status open_again(const image_levels *l, void **out_open)
{
    char message[1024];
    image_levels_header header;
    if (!image_levels_is_unchanged(l))
        return AG_ERROR_INPUT;
    AG_TRY(l->module->open_levels(l->path, out_open, &header, message, sizeof message));
    if (*out_open && !is_same_header(&l->header, &header)) { /* it has changed since it was asked after */
        l->module->close_levels(*out_open);
        *out_open = NULL;
    }
    return *out_open ? AG_OK : AG_ERROR_INPUT;
}

ag_status image_levels_read(image_levels *l, int level, int x, int y, int channel_begin, int channel_end, bool as_bytes,
                            void *out_pixels)
{
    pthread_mutex_lock(&l->lock);
    void *open = l->open;
    ag_status status = open ? AG_OK : open_again(l, &open);
    if (status == AG_OK)
        status = l->module->read_tile(open, &l->header, level, x, y, channel_begin, channel_end, as_bytes, out_pixels);
    if (open && !l->open) {
        if (stay_open())
            l->open = open;
        else
            l->module->close_levels(open);
    }
    pthread_mutex_unlock(&l->lock);
    return status;
}
