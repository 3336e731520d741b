/* photon_file_header.h: how a map file begins, and where its parts lie.
 * Flow: photon_file, photon_file_write -> [here]. Threads: any. */
#ifndef AFTERGLOW_PHOTON_FILE_HEADER_H
#define AFTERGLOW_PHOTON_FILE_HEADER_H

#include "photon_file.h"

/* Raise this whenever the layout changes, or the tracing of photons where estimate_fingerprint does not see it: by
 * meshes, curves, pictures, and the pilot that aims them. A change of the estimates shows in that fingerprint. */
enum { PHOTON_FILE_LAYOUT = 24 };
enum {
    PHOTON_FILE_PAGE = 4096,
    PHOTON_FILE_OWNERS_AT = PHOTON_FILE_PAGE, /* the header has the first page */
    PHOTON_FILE_CHUNK = 1 << 22               /* what is read, written or hashed between two looks at the cancel flag */
};

/* The maps of a file, and its trees: those of the maps, and one of the global map's irradiance photons. */
enum { PHOTON_FILE_GLOBAL, PHOTON_FILE_CAUSTIC, PHOTON_FILE_MAP_COUNT };
enum { PHOTON_FILE_IRRADIANCE = PHOTON_FILE_MAP_COUNT, PHOTON_FILE_TREE_COUNT };

typedef struct photon_file_tree {
    uint64_t blocks_at, nodes_at; /* bytes from the file's beginning */
    uint32_t count, depth;
} photon_file_tree;

typedef struct photon_file_map {
    uint64_t emitted_paths, rays, rays_cut;
    energy_balance balance;
    uint32_t nearest;
    float max_radius, min_radius_squared, mean_radius;
    int32_t flux_exponent_max, irradiance_bias;
    uint32_t is_steady, reserved;
} photon_file_map;

typedef struct photon_file_header {
    char magic[16];
    uint32_t byte_order, layout;
    uint32_t header_bytes, block_bytes, node_bytes, reserved;
    uint64_t file_bytes;
    uint64_t nonce; /* at random: no two files have the same */
    photon_file_key key;
    photon_file_tree trees[PHOTON_FILE_TREE_COUNT]; /* the third is empty where all are irradiance photons */
    uint64_t checks_at; /* of the irradiance photons' check bytes, from the file's beginning */
    photon_file_map maps[PHOTON_FILE_MAP_COUNT];
    hash128 content; /* of the photons and the nodes */
    hash128 self;    /* of all above */
} photon_file_header;

/* Initialises a header: zeros, except the magic and the members that describe this machine's layout. */
void photon_file_header_init(photon_file_header *out_header);
/* Returns whether the first bytes of a file are those of a map file; size: the number of bytes read, at most a
 * header. */
bool photon_file_header_is_ours(const photon_file_header *h, size_t size);
/* Returns whether the file is complete by its length and header, and fits the key (NULL: any); else the message says
 * why not. got_bytes: of the header. */
bool photon_file_header_is_valid(const photon_file_header *h, uint64_t got_bytes, uint64_t file_bytes,
                                 const photon_file_key *key, char *message, size_t message_size);
hash128 photon_file_header_hash(const photon_file_header *h); /* Returns what `self` should be. */

/* Sets the offsets of the trees and of the check bytes, from counts and depths. Returns the file's size. */
uint64_t photon_file_lay_out(photon_file_tree trees[PHOTON_FILE_TREE_COUNT], uint64_t *out_checks_at);
uint64_t photon_file_to_page(uint64_t bytes); /* rounded up to whole pages */
uint64_t photon_file_blocks_bytes(const photon_file_tree *t);
uint64_t photon_file_nodes_bytes(const photon_file_tree *t);

/* Hashes the photons and the nodes, which never change. Returns false when cancelled. */
bool photon_file_hash_content(const run_context *run, const photon_tree trees[PHOTON_FILE_TREE_COUNT],
                              hash128 *out_hash);

#endif
