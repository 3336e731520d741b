/* environment_picture.h: pictures of environments, written for tests.
 * Flow: pixels -> [here] -> a file in the folder of the test -> LightSource "infinite". Threads: one. */
#ifndef AFTERGLOW_TESTS_ENVIRONMENT_PICTURE_H
#define AFTERGLOW_TESTS_ENVIRONMENT_PICTURE_H

#include "image_file.h"
#include "temporary_folder.h"

/* pixels: RGB, as they are to be stored. */
static inline const char *write_environment(const char *name, int width, int height, image_sample_type type,
                                            const float *pixels)
{
    static const char *const CHANNELS[] = {"R", "G", "B"};
    const image_description description = {.width = width,
                                           .height = height,
                                           .full_width = width,
                                           .full_height = height,
                                           .channel_count = 3,
                                           .channel_names = CHANNELS,
                                           .type = type};
    const char *path = in_folder(name);
    if (image_file_write(path, &description, pixels, message, sizeof message) != AG_OK)
        fail_msg("%s", message);
    return path;
}

#endif
