/* texture_udim.h: a picture in tiles side by side, each a file of its own: `<UDIM>` in its name stands for 1001 + u +
 * 10 v of the tile that covers [u, u + 1) x [v, v + 1), u < 10, and `<UVTILE>` for u(u+1)_v(v+1).
 * Rests on: The Foundry, "UDIM UV mapping" (Mari's numbering, which Arnold, Blender, OpenImageIO share).
 * Flow: texture_image_load -> [here] -> texture_image_lookup, texture_filter. Threads: one loads; then any number look
 * up. */
#ifndef AFTERGLOW_TEXTURE_UDIM_H
#define AFTERGLOW_TEXTURE_UDIM_H

#include "afterglow/base.h"
#include "atomics.h"
#include "texture/texture_image.h"

struct log_sink;

enum {
    TEXTURE_UDIM_COLUMNS = 10,
    TEXTURE_UDIM_SLOTS = 8999, /* 1001 to 9999 */
    TEXTURE_UDIM_WORDS = TEXTURE_UDIM_SLOTS / 32 + 1
};

typedef struct texture_udim {
    uint32_t slot_count;   /* at most TEXTURE_UDIM_SLOTS */
    texture_image **tiles; /* [slot_count], borrowed from the scene; slot u + 10 v; NULL: there is no such file */
    bool has_mips;         /* all of its tiles have coarser levels */
    /* The slots without a file that were looked up, and whether a coordinate outside of all slots was. Relaxed: set by
     * lookups, read after the barrier of the pass. */
    atomic_u32 missed[TEXTURE_UDIM_WORDS], is_outside;
} texture_udim;

/* Returns whether a file name is a pattern of tiles. */
bool texture_udim_is_pattern(const char *path);
/* Whether more than one token stands in such a name: which tile a file is would be open. */
bool texture_udim_is_ambiguous(const char *path);

/* Finds the slots that have files, ascending; *out_slots is to be freed. None is no error. Errors: AG_ERROR_MEMORY. */
ag_status texture_udim_find(const char *path, uint16_t **out_slots, uint32_t *out_count);
/* The file of a slot; to be freed; NULL when out of memory. */
char *texture_udim_file(const char *path, uint32_t slot);

void texture_udim_destroy(texture_udim *u); /* NULL is fine */

/* From a picture in tiles and coordinates on it (t down from the top of tile 1001) to the tile there and the
 * coordinates on that, which ends at its edges. Within 1e-4 of an edge the neighbour stands in for a tile that is not
 * there, for corners of meshes lie on edges. false: there is none; it is noted. */
bool texture_udim_enter(const texture_image **in_out_picture, texture_wraps *out_wraps, float *in_out_s,
                        float *in_out_t);

/* Hashes the set of tiles; their pixels are hashed as pictures of their own. */
hash128 texture_udim_content(const texture_udim *u);

/* Warns, once for each name in the life of the log, of tiles that were asked for and are not there. */
void texture_udim_tell_missed(const texture_image *i, struct log_sink *log);

#endif
