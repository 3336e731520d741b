/* photon_file.h: finished photon maps in a file, mapped by any number of processes, which fill its irradiances
 * together. An irradiance depends on the map alone, so those of one picture serve the next. Flow: photon_map -> [write]
 * -> file -> [open] -> photon_map, irradiance_cache. Threads: one thread writes or opens; the maps are then like any
 * others.
 *
 *     header       what it is, what it was made of, constants of the maps, checksum: never changes
 *     owners       the processes at work on it (claim_owners.h)
 *     blocks       of the global map, the caustic map, and the global map's irradiance photons where they
 *                  are not all photons: photons never change, slots do
 *     nodes        of their trees: never change
 *     checks       a byte for each irradiance photon: irradiance_word_check of its slot, written before the slot is
 *                  ready
 *
 * The layout is the machine's own: byte order and sizes are in the header, and another machine's file is refused. What
 * never changes is under a checksum. A slot that is ready without its check byte is emptied when the file is opened,
 * and computed again; a claim that no living process holds is taken over. The checks tell damage; they do not protect
 * from malice. */
#ifndef AFTERGLOW_PHOTON_FILE_H
#define AFTERGLOW_PHOTON_FILE_H

#include "claim_owners.h"
#include "math/hash128.h"
#include "photon_map.h"

enum { PHOTON_FILE_SETTINGS_MAX = 1024 };

/* Everything that photons and irradiances depend on: a file holds for one key alone. It has no gaps, and is zeroed
 * before it is filled. */
typedef struct photon_file_key {
    hash128 scene;                           /* scene_hash_of_light */
    hash128 aim_view;                        /* the view that photons are aimed at; zeros: none */
    hash128 estimates;                       /* estimate_fingerprint: the program's photons and irradiances */
    char settings[PHOTON_FILE_SETTINGS_MAX]; /* all other settings that it depends on, lines "NOUN: VALUE" */
    char program[56];                        /* version and compiler */
    char machine[56]; /* all that may change bits: kind and maker of the processor, instruction set of ray traversal */
} photon_file_key;

typedef struct photon_file {
    void *memory; /* the whole file: mapped, or a copy */
    size_t size_bytes;
    int descriptor; /* of the mapped file; holds this process's lock */
    bool is_shared; /* other processes see results, and the file keeps them */
    int guard;      /* map_guard.h */
    uint64_t nonce; /* of the file that was opened */
    claim_owners owners;
    uint32_t damaged; /* number of irradiances without their check byte when it was opened; they are computed again */
} photon_file;

typedef enum photon_file_result {
    PHOTON_FILE_OPEN,
    PHOTON_FILE_ABSENT,
    PHOTON_FILE_FOREIGN,  /* no photon map, and not empty: must not be replaced */
    PHOTON_FILE_REFUSED,  /* damaged, or made with another key; the message says which */
    PHOTON_FILE_FAILED,   /* cannot be read, or memory is short; the message says why */
    PHOTON_FILE_CANCELLED /* no message */
} photon_file_result;

/* Opens the maps, which borrow the file, and have no surfaces yet. Where the file cannot be shared (it may not be
 * written, it is on a network's file system, or its owners' table is full) it is copied into memory: is_shared is
 * false, and its claims count as empty. message: one line, always terminated; for OPEN, why it is not shared. */
photon_file_result photon_file_open(const run_context *run, const char *path, const photon_file_key *key,
                                    photon_file *out_file, photon_map *out_global, photon_map *out_caustic,
                                    char *message, size_t message_size);
/* Reads a photon map with any key, as a private copy in memory; its claims count as empty. *out_fixed: a fingerprint of
 * all that never changes in it, its key included: maps with equal ones have the same irradiances. Results and message
 * are those of photon_file_open. */
photon_file_result photon_file_read(const run_context *run, const char *path, photon_file_key *out_key,
                                    hash128 *out_fixed, photon_file *out_file, photon_map *out_global,
                                    photon_map *out_caustic, char *message, size_t message_size);

/* Returns whether the file is still the one that was opened. It may be truncated or overwritten while it is mapped:
 * data read since this was last true may then not be the maps'. A copy in memory is always intact. */
bool photon_file_is_intact(const photon_file *file);
/* Returns whether no part of the mapping has been lost so far: the part of photon_file_is_intact that costs nothing. */
bool photon_file_has_memory(const photon_file *file);

/* Closes the file, after the maps, when this process holds no claim. {0} is fine. */
void photon_file_close(photon_file *file);

/* Writes maps into an empty file that is open for writing, space reserved first. Returns 0, or an errno; ECANCELED when
 * the run was cancelled. */
int photon_file_write(const run_context *run, int descriptor, const photon_file_key *key, const photon_map *global,
                      const photon_map *caustic);

#endif
