/* irradiance_slot.h: one atomic word per photon: who computes its irradiance, and then the irradiance. The lock-free
 * core. Rests on: Neilson, Yang, TR 04-21, 2004 (on demand, with a flag at the photon); the compare-and-swap makes it
 * safe for threads, and for processes that share a map file. Modelled in tests/models/irradiance_slot.pml, and with the
 * death of processes in tests/models/irradiance_slot_shared.pml.
 *
 *            try_claim (CAS on the flags)           publish (CAS)
 *   EMPTY ─────────────────────────────────▶ CLAIMED ─────────────▶ READY or READY_IN_SIGHT  (final)
 *          exactly one thread wins            computes the estimate  everyone reads
 *
 *   state           the other 30 bits     who may change the word
 *   EMPTY           0                     anybody: to CLAIMED, naming itself
 *   CLAIMED         the claimer's number  the claimer: to a ready state; where it is dead, anybody else: to CLAIMED,
 *                                         naming itself
 *   READY           exponent, mantissas   nobody; serves every point that the photon is the nearest to
 *   READY_IN_SIGHT  exponent, mantissas   nobody; a surface ends near by, so it serves those points only that see the
 *                                         photon
 *
 * A file's slot that is ready without its check byte is emptied by who opens the file.
 *
 * State and value are one word, so nobody can see half of a result, and zeroed memory is a valid empty cache.
 * Threads: any, at any time. */
#ifndef AFTERGLOW_IRRADIANCE_SLOT_H
#define AFTERGLOW_IRRADIANCE_SLOT_H

#include "atomics.h"

typedef atomic_u32 irradiance_slot;

typedef enum irradiance_state {
    IRRADIANCE_EMPTY = 0,
    IRRADIANCE_CLAIMED = 1,
    IRRADIANCE_READY = 2,
    IRRADIANCE_READY_IN_SIGHT = 3
} irradiance_state;

#define IRRADIANCE_STATE_SHIFT 30
#define IRRADIANCE_VALUE_MASK  0x3fffffffu

static inline irradiance_state irradiance_word_state(uint32_t word)
{
    return (irradiance_state)(word >> IRRADIANCE_STATE_SHIFT);
}

/* Returns whether the word holds a final value, of either kind. */
static inline bool irradiance_word_is_ready(uint32_t word)
{
    return word >> IRRADIANCE_STATE_SHIFT >= IRRADIANCE_READY;
}

static inline uint32_t irradiance_word(irradiance_state state, uint32_t value)
{
    return (uint32_t)state << IRRADIANCE_STATE_SHIFT | (value & IRRADIANCE_VALUE_MASK);
}

/* Reads the slot. Acquire, pairs with publish: a reader of READY also sees what the claimer wrote before. */
static inline uint32_t irradiance_slot_read(const irradiance_slot *slot) { return load_acquire_u32(slot); }

/* Claims an empty slot for a claimer, a number below 2^30. At most one caller ever gets true. *out_word: the word in
 * the slot now. Acquire: pairs with publish, where the caller loses and finds READY. Release: a reader of the claim
 * finds its claimer's entry in the table of claim_owners.h. */
static inline bool irradiance_slot_try_claim(irradiance_slot *slot, uint32_t claimer, uint32_t *out_word)
{
    uint32_t found = 0, claimed = irradiance_word(IRRADIANCE_CLAIMED, claimer);
    bool won = cas_acquire_release_u32(slot, &found, claimed);
    *out_word = won ? claimed : found;
    return won;
}

/* Takes over a claim that its claimer will not make ready: see claim_owners.h. *in_out_word: the word read before;
 * receives the word in the slot now. Returns false where the slot has changed since. Memory order as in try_claim. */
static inline bool irradiance_slot_take_over(irradiance_slot *slot, uint32_t *in_out_word, uint32_t claimer)
{
    uint32_t claimed = irradiance_word(IRRADIANCE_CLAIMED, claimer);
    if (!cas_acquire_release_u32(slot, in_out_word, claimed))
        return false;
    *in_out_word = claimed;
    return true;
}

/* Publishes the claimer's word, a ready one, which is then final. Release: pairs with read. Returns false where the
 * claim has been taken over, so that another thread computes the value too. That happens only in the map of a file, to
 * a process or a thread that had stood still for so long that it was considered dead; claims of its process carry
 * another number from then on (claim_owners_renew). */
static inline bool irradiance_slot_publish(irradiance_slot *slot, uint32_t claimer, uint32_t ready)
{
    uint32_t expected = irradiance_word(IRRADIANCE_CLAIMED, claimer);
    return cas_release_u32(slot, &expected, ready);
}

/* Returns the check byte that a map's file keeps beside a ready slot, to detect damaged words: never 0, and different
 * where one or two bits of the word or of its index differ (CRC-7 of both, polynomial x^7 + x^3 + 1). It is written
 * before the word is published; several threads may write it at once only with equal values. */
static inline uint8_t irradiance_word_check(uint32_t index, uint32_t word)
{
    static const uint8_t OF_NIBBLE[16] = {0x00, 0x12, 0x24, 0x36, 0x48, 0x5a, 0x6c, 0x7e,
                                          0x90, 0x82, 0xb4, 0xa6, 0xd8, 0xca, 0xfc, 0xee};
    uint64_t bits = (uint64_t)index << 32 | word;
    unsigned crc = 0; /* its seven bits are the upper ones of a byte */
    for (int shift = 60; shift >= 0; shift -= 4)
        crc = (crc << 4 & 0xff) ^ OF_NIBBLE[crc >> 4 ^ (unsigned)(bits >> shift & 15)];
    return (uint8_t)(0x80 | crc >> 1);
}

#endif
