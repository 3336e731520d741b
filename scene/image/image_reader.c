/* image_reader.c: see image_reader.h.
 * Flow: file -> image_oiio.cpp -> [here]. Threads: any. */
#define _POSIX_C_SOURCE 200809L
#include "image/image_reader.h"

#include "image/image_module_loader.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static ag_status read_picture(const char *path, bool keep_bytes, image *out_image, char *message, size_t message_size)
{
    *out_image = (image){0};
    struct stat file;
    const bool is_there = stat(path, &file) == 0;
    if (!is_there || !S_ISREG(file.st_mode)) { /* a pipe that nobody writes to would be waited for */
        snprintf(message, message_size, "cannot read '%s': %s", path,
                 is_there ? "it is not a regular file" : strerror(errno));
        return AG_ERROR_INPUT;
    }
    const image_module *module = image_module_get(message, message_size);
    if (!module)
        return AG_ERROR_SYSTEM;
    char reason[1024];
    const ag_status status = module->decode(path, keep_bytes, out_image, reason, sizeof reason);
    if (status != AG_OK)
        snprintf(message, message_size, "cannot read '%s': %s", path, reason);
    return status;
}

ag_status image_read(const char *path, image *out_image, char *message, size_t message_size)
{
    return read_picture(path, false, out_image, message, message_size);
}

ag_status image_read_compact(const char *path, image *out_image, char *message, size_t message_size)
{
    return read_picture(path, true, out_image, message, message_size);
}

/* NULL: neither of the two that glTF knows. */
static const char *extension_of(const unsigned char *bytes, size_t size)
{
    static const unsigned char PNG[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}, JPEG[] = {0xff, 0xd8, 0xff};
    if (size >= sizeof PNG && memcmp(bytes, PNG, sizeof PNG) == 0)
        return "png";
    return size >= sizeof JPEG && memcmp(bytes, JPEG, sizeof JPEG) == 0 ? "jpg" : NULL;
}

ag_status image_read_memory(const char *name, const unsigned char *bytes, size_t size, image *out_image, char *message,
                            size_t message_size)
{
    *out_image = (image){0};
    const char *extension = extension_of(bytes, size);
    if (!extension) {
        snprintf(message, message_size, "cannot read '%s': it is neither a PNG nor a JPEG picture", name);
        return AG_ERROR_INPUT;
    }
    const image_module *module = image_module_get(message, message_size);
    if (!module)
        return AG_ERROR_SYSTEM;
    char reason[1024];
    const ag_status status = module->decode_memory(extension, bytes, size, true, out_image, reason, sizeof reason);
    if (status != AG_OK)
        snprintf(message, message_size, "cannot read '%s': %s", name, reason);
    return status;
}

void image_reset(image *picture)
{
    free(picture->pixels);
    free(picture->bytes);
    *picture = (image){0};
}
