/* denoise.c: see denoise.h. */
#include "output/denoise.h"

#include "status.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Values of oidn.h, which are the same in releases 1 and 2. */
typedef struct oidn_device_object *oidn_device;
typedef struct oidn_filter_object *oidn_filter;
enum { OIDN_CPU = 1, OIDN_FLOAT3 = 3 };

typedef struct oidn_library {
    void *handle;
    oidn_device (*new_device)(int type);
    void (*set_device_int)(oidn_device device, const char *name, int value);
    void (*set_device_bool)(oidn_device device, const char *name, bool value);
    void (*commit_device)(oidn_device device);
    int (*device_error)(oidn_device device, const char **out_message);
    void (*release_device)(oidn_device device);
    oidn_filter (*new_filter)(oidn_device device, const char *type);
    void (*set_image)(oidn_filter filter, const char *name, void *pixels, int format, size_t width, size_t height,
                      size_t offset, size_t pixel_stride, size_t row_stride);
    void (*set_filter_bool)(oidn_filter filter, const char *name, bool value);
    void (*commit_filter)(oidn_filter filter);
    void (*execute)(oidn_filter filter);
    void (*release_filter)(oidn_filter filter);
} oidn_library;

/* Returns the function of the first of two names that the library has: release 2 renamed some, and kept the old names
 * in its header alone. */
static bool find(void *handle, void *out_function, const char *name, const char *old_name)
{
    void *found = dlsym(handle, name);
    if (!found && old_name)
        found = dlsym(handle, old_name);
    memcpy(out_function, &found, sizeof found); /* from object to function pointer, as POSIX has it */
    return found != NULL;
}

static ag_status open_library(oidn_library *out, char *message, size_t message_size)
{
    static const char *const names[] = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1",
                                        "libOpenImageDenoise.so"};
    *out = (oidn_library){0};
    for (size_t i = 0; i < sizeof names / sizeof *names && !out->handle; i++)
        out->handle = dlopen(names[i], RTLD_NOW | RTLD_LOCAL);
    if (!out->handle) {
        snprintf(message, message_size,
                 "denoising needs Open Image Denoise, and its library is not there: neither %s, %s nor %s is found "
                 "(www.openimagedenoise.org; LD_LIBRARY_PATH says where it is)",
                 names[0], names[1], names[2]);
        return AG_ERROR_SYSTEM;
    }
    void *h = out->handle;
    bool is_whole =
        find(h, &out->new_device, "oidnNewDevice", NULL) &&
        find(h, &out->set_device_int, "oidnSetDeviceInt", "oidnSetDevice1i") &&
        find(h, &out->set_device_bool, "oidnSetDeviceBool", "oidnSetDevice1b") &&
        find(h, &out->commit_device, "oidnCommitDevice", NULL) &&
        find(h, &out->device_error, "oidnGetDeviceError", NULL) &&
        find(h, &out->release_device, "oidnReleaseDevice", NULL) && find(h, &out->new_filter, "oidnNewFilter", NULL) &&
        find(h, &out->set_image, "oidnSetSharedFilterImage", NULL) &&
        find(h, &out->set_filter_bool, "oidnSetFilterBool", "oidnSetFilter1b") &&
        find(h, &out->commit_filter, "oidnCommitFilter", NULL) && find(h, &out->execute, "oidnExecuteFilter", NULL) &&
        find(h, &out->release_filter, "oidnReleaseFilter", NULL);
    if (is_whole)
        return AG_OK;
    snprintf(message, message_size, "the library Open Image Denoise that was found is of an unknown release");
    dlclose(out->handle);
    return AG_ERROR_SYSTEM;
}

ag_status denoise_check(char *message, size_t message_size)
{
    oidn_library library;
    AG_TRY(open_library(&library, message, message_size));
    dlclose(library.handle);
    return AG_OK;
}

/* Returns the first error since the last question; device NULL: the error of making one. */
static bool has_failed(const oidn_library *library, oidn_device device, char *message, size_t message_size)
{
    const char *reason = NULL;
    if (library->device_error(device, &reason) == 0)
        return false;
    snprintf(message, message_size, "Open Image Denoise: %s", reason ? reason : "it failed without saying why");
    return true;
}

static ag_status filter_picture(const oidn_library *library, oidn_device device, int width, int height, float *color,
                                const float *albedo, const float *normal, char *message, size_t message_size)
{
    size_t w = (size_t)width, h = (size_t)height, bytes = w * h * 3 * sizeof(float);
    float *images[3] = {malloc(bytes), albedo ? malloc(bytes) : NULL, normal ? malloc(bytes) : NULL};
    oidn_filter filter =
        library->new_filter(device, "RT"); /* NULL: calls with it do nothing, and the device has the error */
    bool fits = images[0] && (!albedo || images[1]) && (!normal || images[2]);
    if (fits) {
        library->set_image(filter, "color", color, OIDN_FLOAT3, w, h, 0, 0, 0);
        library->set_image(filter, "output", images[0], OIDN_FLOAT3, w, h, 0, 0, 0);
        if (albedo) {
            memcpy(images[1], albedo, bytes); /* a copy, since the interface does not promise to leave it as it is */
            library->set_image(filter, "albedo", images[1], OIDN_FLOAT3, w, h, 0, 0, 0);
        }
        if (normal) {
            memcpy(images[2], normal, bytes);
            library->set_image(filter, "normal", images[2], OIDN_FLOAT3, w, h, 0, 0, 0);
        }
        library->set_filter_bool(filter, "hdr", true);
        library->commit_filter(filter);
        library->execute(filter);
    }
    bool is_done = fits && !has_failed(library, device, message, message_size);
    if (is_done)
        memcpy(color, images[0], bytes);
    library->release_filter(filter);
    for (int i = 0; i < 3; i++)
        free(images[i]);
    return is_done ? AG_OK : fits ? AG_ERROR_SYSTEM : AG_ERROR_MEMORY;
}

ag_status denoise_picture(int width, int height, float *color, const float *albedo, const float *normal,
                          unsigned thread_count, char *message, size_t message_size)
{
    oidn_library library;
    snprintf(message, message_size, "%s", "");
    AG_TRY(open_library(&library, message, message_size));
    ag_status status;
    /* a GPU could not read our memory */
    oidn_device device = library.new_device(OIDN_CPU);
    if (!device) {
        if (!has_failed(&library, NULL, message, message_size))
            snprintf(message, message_size, "Open Image Denoise: it has no device for this CPU");
        status = AG_ERROR_SYSTEM;
    } else {
        library.set_device_int(device, "numThreads", (int)thread_count);
        library.set_device_bool(device, "setAffinity", false);
        library.commit_device(device);
        status = has_failed(&library, device, message, message_size)
                     ? AG_ERROR_SYSTEM
                     : filter_picture(&library, device, width, height, color, albedo, normal, message, message_size);
        library.release_device(device);
    }
    dlclose(library.handle);
    return status;
}
