/* claim_owners.h: the processes that fill one map file together: which of them holds a claim, and whether it still
 * lives. Each has a place in a table in the file, a number that its claims carry, and a lock on a byte of the file,
 * which the kernel drops when the process ends, however it ends: the lock is what tells that it lives.
 * Rests on: fcntl(2), open file description locks. Flow: photon_file joins -> irradiance_cache waits. Modelled in
 * tests/models/irradiance_slot_shared.pml. Threads: join and leave by one; the others by any.
 *
 * A claim carries place and generation. Whoever takes a place that a dead process has left begins a new generation: so
 * no living process ever writes what a dead one's claim reads, and a claim taken over cannot be mistaken. */
#ifndef AFTERGLOW_CLAIM_OWNERS_H
#define AFTERGLOW_CLAIM_OWNERS_H

#include "irradiance_slot.h"

enum { CLAIM_OWNERS_MAX = 256 };

/* In the file. All zero: nobody yet. */
typedef struct claim_owner {
    atomic_u32 generation; /* of 22 bits; changed by the lock's holder alone, before its first claim */
    atomic_u32 process;    /* its id, for people who look into the file */
} claim_owner;

typedef struct claim_owners {
    claim_owner *table; /* [CLAIM_OWNERS_MAX], borrowed */
    int file;           /* borrowed: an open file description of our own, whose locks are ours */
    uint32_t claimer;   /* what our claims carry */
} claim_owners;

/* Takes a place. False where all are taken, or the file system has no such locks. The place is left when the file is
 * closed. */
bool claim_owners_join(int file, claim_owner *table, claim_owners *out_owners);

/* Whether the process that a claim names still lives. */
bool claim_owners_is_alive(const claim_owners *owners, uint32_t claimer);

/* One who waits; begin with {0}. */
typedef struct claim_wait {
    uint32_t word; /* the claim waited for */
    uint32_t rounds;
    double begin; /* clock_seconds */
} claim_wait;

/* To be called between two looks at a slot that is not ready: lets others run, or sleeps a while. True: nobody will
 * make this word ready, so it may be taken over: its claimer is dead, or has stood still for seconds (a process that
 * was stopped: its own publishing will then fail), or it is no claim that anybody has made. */
bool claim_owners_wait(const claim_owners *owners, claim_wait *wait, uint32_t word);

#endif
