/* light_picture.h: pictures that lights throw, from their file to colours of the working space.
 * Flow: pbrt_light_pictures, scene_overrides -> [here] -> environment, projection. Threads: one per scene. */
#ifndef AFTERGLOW_LIGHT_PICTURE_H
#define AFTERGLOW_LIGHT_PICTURE_H

#include "scene.h"

struct environment;

#define LIGHT_PICTURE_OTHERS                                                                                           \
    "the file holds several pictures (parts, pages or frames), of which the first alone is used"

typedef struct light_picture {
    uint32_t width, height;
    rgb *pixels;              /* from malloc, top row first; finite and not negative; the caller's */
    bool is_first_of_several; /* its file holds other pictures, which are not used */
    size_t bad_count;         /* pixels that were not so in the file: what was wrong in them is 0 */
} light_picture;

/* Reads the picture of that path, which messages call name. run: whose inputs say what may be read, and which ends
 * reading; may be NULL. is_gray: its values are no colours. Errors: AG_ERROR_COLOR, AG_ERROR_INPUT, AG_ERROR_SYSTEM,
 * AG_ERROR_SCENE (too large), with the reason in message; AG_ERROR_MEMORY, AG_CANCELLED. */
ag_status light_picture_read(const run_context *run, const scene *s, const char *name, const char *path, bool is_gray,
                             light_picture *out_picture, char *message, size_t message_size);

struct image;

/* Works as light_picture_read, on floats in memory, which are taken, on failure too. */
ag_status light_picture_take(const scene *s, const char *name, struct image *pixels, bool is_gray,
                             light_picture *out_picture, char *message, size_t message_size);

/* Makes an environment, a picture of all directions: a square picture is octahedral, one twice as wide as high
 * latitude-longitude. Takes the pixels, on failure too. Errors: AG_ERROR_SCENE (another shape; the reason in message),
 * AG_ERROR_MEMORY. */
ag_status light_picture_surround(light_picture *picture, const char *name, struct environment **out_environment,
                                 char *message, size_t message_size);

/* Returns the picture of the scene before, with a holder added, if name, version (of the file of that name, 0: unknown)
 * and is_gray are the same; NULL: it must be read. */
struct environment *light_picture_find_kept(scene *s, const char *name, uint64_t version, bool is_gray);
/* Notes of one that was read what light_picture_find_kept asks for. */
void light_picture_note(scene *s, const char *name, uint64_t version, bool is_gray, struct environment *e);

#endif
