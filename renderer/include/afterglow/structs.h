/* structs.h: defaults of the structs that a program fills, by the size that it was compiled with.
 * Part of afterglow.h, which tells about threads and errors. Programs in C and C++ call the functions ag_default_...()
 * beside each struct, which are made of this; those in other languages call this. */
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

/* Bytes of the library's own struct; 0: it knows no such struct. */
AG_API size_t ag_struct_size(ag_struct which);

/* Writes struct_size bytes and no more: struct_size itself, and where it is the library's own size the defaults, else
 * zeros. Calls refuse a struct of another size than the library's. struct_size: at least that of a size_t. */
AG_API void ag_struct_fill(ag_struct which, void *out_struct, size_t struct_size);

/* Defines the default of a struct, of the size that the program knows. */
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
