/* denoise.h: the picture through Open Image Denoise, with albedo and normals to tell noise from texture. The library is
 * opened when it is asked for: nothing of it is needed to build, and pictures without it never look for it.
 * Rests on: Open Image Denoise's documentation, "Open Image Denoise API" (filter "RT"). Flow: film -> [here] -> film.
 * Threads: one caller; the library's own, as many as the context has. */
#ifndef AFTERGLOW_DENOISE_H
#define AFTERGLOW_DENOISE_H

#include "afterglow/base.h"

#include <stdbool.h>
#include <stddef.h>

/* Checks whether the library is there. Errors: AG_ERROR_SYSTEM, with what was tried in message. */
ag_status denoise_check(char *message, size_t message_size);

/* Denoises a picture. color, scene-linear, is replaced; albedo and normal may be NULL; 3 floats a pixel each, packed.
 * Errors: AG_ERROR_SYSTEM, AG_ERROR_MEMORY. */
ag_status denoise_picture(int width, int height, float *color, const float *albedo, const float *normal,
                          unsigned thread_count, char *message, size_t message_size);

#endif
