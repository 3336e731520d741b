/* cryptomatte.h: which objects and materials a pixel shows, and how much of each, for mattes by name.
 * Rests on: Friedman, Jones, "Fully automatic ID mattes with support for motion blur and transparency", SIGGRAPH 2015
 * (posters); Psyop, "Cryptomatte Specification" 1.1.0: ids are MurmurHash3 of names, as the bits of a float.
 * Flow: scene's names, samples -> [here] -> film, files. Threads: made by one; a pixel's coverage belongs to one worker
 * at a time. */
#ifndef AFTERGLOW_CRYPTOMATTE_H
#define AFTERGLOW_CRYPTOMATTE_H

#include "scene.h"

/* Ranks in a file, two to a layer; ids of a pixel that are kept while rendering: what comes later has little to
 * show. */
enum { CRYPTOMATTE_RANKS = 6, CRYPTOMATTE_SLOTS = 10 };

typedef enum cryptomatte_kind { CRYPTOMATTE_OBJECT, CRYPTOMATTE_MATERIAL } cryptomatte_kind;
enum { CRYPTOMATTE_KIND_COUNT = CRYPTOMATTE_MATERIAL + 1 };

typedef struct cryptomatte {
    const char *layer; /* "CryptoObject", "CryptoMaterial" */
    uint32_t *hashes;  /* owned; of the things by first_hit's numbers, from 1 on */
    uint32_t count;
    char *manifest;              /* owned: JSON, the hash of each name in eight hexadecimal digits */
    char attribute_names[4][48]; /* of name, hash, conversion, manifest */
} cryptomatte;

/* Ids that a pixel's samples had, with the samples' signs summed; empty ones have hash 0. */
typedef struct cryptomatte_slot {
    uint32_t hash;
    int32_t signed_count;
} cryptomatte_slot;

/* Makes the hashes and the manifest of the scene's objects or materials. Errors: AG_ERROR_MEMORY. */
ag_status cryptomatte_create(const scene *s, cryptomatte_kind kind, cryptomatte *out_matte);
void cryptomatte_reset(cryptomatte *matte);

/* Gives the name of the thing with that id, which is its hash's bits, cut where it is longer than size - 1 bytes.
 * Returns false where there is none. */
bool cryptomatte_name(const cryptomatte *matte, float id, char *out_name, size_t size);

/* Adds a sample of the thing of that number, from 1 on. sign: 1 or -1, of the pixel filter. slots: the pixel's
 * [CRYPTOMATTE_SLOTS]; where all have other things the sample is left out. */
void cryptomatte_add(const cryptomatte *matte, uint32_t id, int sign, cryptomatte_slot *slots);

/* Gives the id as a float, and its share, [0, 1], of that rank from 0 on; 0 and 0 where there are not so many. total:
 * the pixel's samples, signs summed. */
void cryptomatte_rank(const cryptomatte_slot *slots, int rank, int64_t total, float *out_id, float *out_coverage);

/* Returns the name's hash with an exponent that is neither 0 nor that of infinity. */
uint32_t cryptomatte_hash(const char *name);

#endif
