/* claim_owners.h: the processes that fill one map file together: which of them holds a claim, and whether it still
 * lives. Each has an entry in a table in the file, a number that its claims carry, and a lock on a byte of the file,
 * which the kernel drops when the process ends, however it ends: the lock is what tells that it lives.
 * Rests on: fcntl(2), open file description locks. Flow: photon_file joins -> irradiance_cache waits. Modelled in
 * tests/models/irradiance_slot_shared.pml. Threads: join and leave by one; the others by any.
 *
 * A claim carries the entry's index and a generation. Whoever takes an entry that a dead process has left begins a new
 * generation: so no living process ever writes what a dead one's claim reads, and a claim taken over cannot be
 * mistaken. All threads of a process share its number: none of them takes over a claim of its own process, whose holder
 * is another thread at work, so of the threads that wait for one claim no more than one computes it. */
#ifndef AFTERGLOW_CLAIM_OWNERS_H
#define AFTERGLOW_CLAIM_OWNERS_H

#include "irradiance_slot.h"

enum { CLAIM_OWNERS_MAX = 256 };

/* A process's entry in the file. All zero: nobody has taken it yet. */
typedef struct claim_owner {
    atomic_u32 generation; /* of 22 bits; changed by the lock's holder alone, before its first claim */
    atomic_u32 process;    /* its id, for people who look into the file */
} claim_owner;

typedef struct claim_owners {
    claim_owner *table;  /* [CLAIM_OWNERS_MAX], borrowed */
    int file;            /* borrowed: an open file description of our own, whose locks are ours */
    atomic_u32 claimer;  /* what our claims carry, never 0; stands alone, so relaxed */
    atomic_u32 *stalled; /* [CLAIM_OWNERS_MAX], owned: for each entry its claimer that was seen to stand still, 0:
                            none; stand alone, so relaxed */
} claim_owners;

/* Takes an entry. False where all are taken, the file system has no such locks, or memory is short. The entry is left
 * when the file is closed. */
bool claim_owners_join(int file, claim_owner *table, claim_owners *out_owners);
void claim_owners_reset(claim_owners *owners); /* frees what is owned; all zero is fine */

/* After a claim of ours, which carried this number, turned out to have been taken over: we have stood still, and
 * others remember it. Our further claims carry a new number, and are waited for again. By any thread; the first one
 * does it. */
void claim_owners_renew(claim_owners *owners, uint32_t claimer);

/* Whether the process that a claim names still lives. */
bool claim_owners_is_alive(const claim_owners *owners, uint32_t claimer);

/* One who waits; begin with {0}. */
typedef struct claim_wait {
    uint32_t word; /* the claim waited for */
    uint32_t rounds;
    double begin; /* clock_seconds */
} claim_wait;

/* To be called between two looks at a slot that is not ready: lets others run, or sleeps for a fraction of a
 * millisecond. True: nobody will make this word ready, so it may be taken over: its claimer is dead, or has stood still
 * for seconds (a process that was stopped: its own publishing will then fail), or it is no claim that anybody has made.
 * The seconds are waited for once for each claimer, not for each of its claims. */
bool claim_owners_wait(const claim_owners *owners, claim_wait *wait, uint32_t word);

#endif
