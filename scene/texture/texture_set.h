/* texture_set.h: the textures of a scene and the pictures that they refer to, with what loading and looking them up
 * takes from the scene. Flow: texture_image_load, readers -> [here] -> texture; the scene owns it. Threads: one fills
 * it; then any number look up. */
#ifndef AFTERGLOW_TEXTURE_SET_H
#define AFTERGLOW_TEXTURE_SET_H

#include "texture/texture.h"

/* Where pictures that do not fit into memory lie. All zero: memory is not limited. */
typedef struct texture_limits {
    uint64_t memory_bytes; /* of all pictures; 0: no limit */
    const char *cache;     /* a folder that keeps those beyond it; borrowed while pictures are loaded; NULL: none */
    uint64_t cache_bytes;  /* of all in that folder */
} texture_limits;

struct texture_set {
    image_colors_target colors; /* of all pictures */
    texture_limits limits;
    const texture_set *before; /* of the scene that this one's replaces, whose pictures are shared where they would be
                                  the same; borrowed while pictures are loaded; NULL: none */
    texture *items;
    uint32_t count;
    texture_image **images; /* those that textures refer to, each file and encoding once */
    uint32_t image_count;
    texture_store *store;            /* of those that are too large for memory; NULL: memory is not limited */
    uint64_t read_count, kept_count; /* of pictures that were read, and that the set before had */
};

/* Adds a copy of *item and writes its index. Its inputs must have been added before. Errors: AG_ERROR_MEMORY,
 * AG_ERROR_SCENE (it costs more than TEXTURE_MAX_COST). */
ag_status texture_set_add(texture_set *set, const texture *item, uint32_t *out_index);
/* For texture_image_load, which first looks for an equal picture. The set takes the picture over, on failure too, when
 * it is destroyed. Errors: AG_ERROR_MEMORY. */
ag_status texture_set_add_image(texture_set *set, texture_image *item, uint32_t *out_index);
/* Frees what the set owns. */
void texture_set_reset(texture_set *set);

#endif
