/* public_structs.c: see afterglow/structs.h. Flow: the program's struct, of the size that it was compiled with ->
 * [here]
 * -> defaults. Threads: pure functions. */
#include "public_structs.h"

#include "afterglow/afterglow.h"
#include "settings_table.h"

#include <string.h>

static const ag_context_settings CONTEXT_SETTINGS = {.struct_size = sizeof(ag_context_settings)};
static const ag_output_settings OUTPUT_SETTINGS = {.struct_size = sizeof(ag_output_settings)};
static const ag_scene_settings SCENE_SETTINGS = {.struct_size = sizeof(ag_scene_settings),
                                                 .texture_memory_bytes = AG_DEFAULT_TEXTURE_MEMORY_BYTES,
                                                 .texture_cache_bytes = AG_DEFAULT_TEXTURE_CACHE_BYTES,
                                                 .camera_fov_degrees = 45.0f,
                                                 .sun_elevation_degrees = 45.0f,
                                                 .sun_irradiance = 3.0f,
                                                 .sky_radiance = {1.0f, 1.0f, 1.0f}};
static const ag_image IMAGE = {.struct_size = sizeof(ag_image), .channel_count = 3};
static const ag_texture TEXTURE = {.struct_size = sizeof(ag_texture), .value = AG_TEXTURE_SPECTRUM};
static const ag_shape SHAPE = {.struct_size = sizeof(ag_shape), .end_count = 1};
static const ag_instance INSTANCE = {.struct_size = sizeof(ag_instance), .end_count = 1};
static const ag_light LIGHT = {.struct_size = sizeof(ag_light)};
static const ag_camera CAMERA = {.struct_size = sizeof(ag_camera), .type = "perspective"};

typedef struct known_struct {
    size_t size;
    const void *defaults; /* NULL: of the table of settings */
} known_struct;

static known_struct known_of(ag_struct which)
{
    switch (which) {
    case AG_STRUCT_CONTEXT_SETTINGS: return (known_struct){sizeof CONTEXT_SETTINGS, &CONTEXT_SETTINGS};
    case AG_STRUCT_SCENE_SETTINGS: return (known_struct){sizeof SCENE_SETTINGS, &SCENE_SETTINGS};
    case AG_STRUCT_RENDER_SETTINGS: return (known_struct){sizeof(ag_render_settings), NULL};
    case AG_STRUCT_OUTPUT_SETTINGS: return (known_struct){sizeof OUTPUT_SETTINGS, &OUTPUT_SETTINGS};
    case AG_STRUCT_IMAGE: return (known_struct){sizeof IMAGE, &IMAGE};
    case AG_STRUCT_TEXTURE: return (known_struct){sizeof TEXTURE, &TEXTURE};
    case AG_STRUCT_SHAPE: return (known_struct){sizeof SHAPE, &SHAPE};
    case AG_STRUCT_INSTANCE: return (known_struct){sizeof INSTANCE, &INSTANCE};
    case AG_STRUCT_LIGHT: return (known_struct){sizeof LIGHT, &LIGHT};
    case AG_STRUCT_CAMERA: return (known_struct){sizeof CAMERA, &CAMERA};
    }
    return (known_struct){0, NULL};
}

void public_struct_write(const void *filled, size_t filled_size, void *out_struct, size_t struct_size)
{
    if (struct_size == filled_size) {
        memcpy(out_struct, filled, filled_size);
        return;
    }
    memset(out_struct, 0, struct_size);
    if (struct_size >= sizeof struct_size)
        memcpy(out_struct, &struct_size, sizeof struct_size);
}

void public_struct_write_part(const void *made, size_t made_size, void *out_struct, size_t struct_size)
{
    if (!out_struct)
        return;
    memset(out_struct, 0, struct_size);
    if (struct_size < sizeof struct_size)
        return;
    if (made_size > 0)
        memcpy(out_struct, made, made_size < struct_size ? made_size : struct_size);
    memcpy(out_struct, &struct_size, sizeof struct_size);
}

size_t ag_struct_size(ag_struct which) { return known_of(which).size; }

void ag_struct_fill(ag_struct which, void *out_struct, size_t struct_size)
{
    const known_struct known = known_of(which);
    if (!out_struct)
        return;
    if (which == AG_STRUCT_RENDER_SETTINGS) {
        const ag_render_settings settings = settings_table_defaults();
        public_struct_write(&settings, sizeof settings, out_struct, struct_size);
        return;
    }
    public_struct_write(known.defaults, known.size, out_struct, struct_size);
}
