/* structs.h: initialises the structs that a program fills, of the size that the program was compiled with.
 * Part of afterglow.h, which tells about threads and errors. Programs in C and C++ call the functions ag_default_...()
 * beside each struct, which use ag_struct_fill; programs in other languages call it directly. */
#ifndef AFTERGLOW_PUBLIC_STRUCTS_H
#define AFTERGLOW_PUBLIC_STRUCTS_H

#include "afterglow/base.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The structs that begin with struct_size. */
typedef enum ag_struct {
    AG_STRUCT_CONTEXT_SETTINGS,
    AG_STRUCT_SCENE_SETTINGS,
    AG_STRUCT_RENDER_SETTINGS,
    AG_STRUCT_OUTPUT_SETTINGS,
    AG_STRUCT_IMAGE,
    AG_STRUCT_TEXTURE,
    AG_STRUCT_SHAPE,
    AG_STRUCT_INSTANCE,
    AG_STRUCT_LIGHT,
    AG_STRUCT_CAMERA
} ag_struct;

/* Returns the library's size of a struct, bytes; 0 for a value that is no struct's. */
AG_API size_t ag_struct_size(ag_struct which);

/* Writes struct_size bytes: the member struct_size, and behind it the defaults where the size is the library's, else
 * zeros. Calls refuse a struct of another size than the library's. struct_size: at least sizeof(size_t). */
AG_API void ag_struct_fill(ag_struct which, void *out_struct, size_t struct_size);

/* Defines ag_default_TYPE, which returns the struct's defaults with the size of the program's headers. */
#define AG_DEFAULT_STRUCT(type, which)                                                                                 \
    static inline ag_##type ag_default_##type(void)                                                                    \
    {                                                                                                                  \
        ag_##type filled;                                                                                              \
        ag_struct_fill(which, &filled, sizeof filled);                                                                 \
        return filled;                                                                                                 \
    }

#ifdef __cplusplus
}
#endif
#endif
