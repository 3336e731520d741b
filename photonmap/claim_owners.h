/* claim_owners.h: the processes that fill one map file together: which of them holds a claim, and whether it is alive.
 * Each process has an entry in a table in the file, a number that its claims carry, and a lock on one byte of the file.
 * The kernel releases the lock however the process ends, so the lock tells whether it is alive.
 * Rests on: fcntl(2), open file description locks.
 * Flow: photon_file joins -> irradiance_cache waits. Modelled in tests/models/irradiance_slot_shared.pml and
 * irradiance_slot_threads.pml.
 * Threads: one thread joins and leaves; any may call the others.
 *
 * A claim carries the entry's index and a generation. A process that takes the entry of a dead one begins a new
 * generation, so that no living process writes the number that a dead one's claim carries, and a claim that was taken
 * over cannot be mistaken. All threads of a process share its number, and none of them takes over a claim of that
 * number, whose holder is another working thread; so at most one of the threads that wait for a claim computes it.
 * Where such a claim stands for some four seconds of waiting, as after the file was overwritten by a copy of itself,
 * the process takes a new number: then its claims may be taken over, and a holder that had stood still computes what
 * another computes, too (irradiance_slot_publish tells it). */
#ifndef AFTERGLOW_CLAIM_OWNERS_H
#define AFTERGLOW_CLAIM_OWNERS_H

#include "irradiance_slot.h"

enum { CLAIM_OWNERS_MAX = 256 };

/* A process's entry in the file. All zero: the entry has never been taken. */
typedef struct claim_owner {
    atomic_u32 generation; /* 22 bits; written only by the holder of the lock, before its first claim */
    atomic_u32 process;    /* its process id, for inspection of the file */
} claim_owner;

typedef struct claim_owners {
    claim_owner *table;  /* [CLAIM_OWNERS_MAX], borrowed */
    int file;            /* borrowed: an open file description of our own, whose locks are ours */
    atomic_u32 claimer;  /* the number in this process's claims, never 0; independent of other data, so relaxed */
    atomic_u32 *stalled; /* [CLAIM_OWNERS_MAX], owned: for each entry the claimer that has stalled, 0: none; independent
                            of other data, so relaxed */
} claim_owners;

/* Takes an entry of the table; the entry is left when the file is closed. Returns false where all entries are taken,
 * the file system has no such locks, or memory is short. */
bool claim_owners_join(int file, claim_owner *table, claim_owners *out_owners);
void claim_owners_reset(claim_owners *owners); /* frees what is owned; all zero is fine */

/* To be called when a claim of this process, which carried this number, has been taken over, since the process had
 * stalled, or when nobody holds it. Its further claims carry a new number and are waited for again. Any thread may call
 * it; the first call takes effect. */
void claim_owners_renew(claim_owners *owners, uint32_t claimer);

/* Returns whether the process that a claim names is alive. */
bool claim_owners_is_alive(const claim_owners *owners, uint32_t claimer);

/* The state of a waiting thread; initialise with {0}. */
typedef struct claim_wait {
    uint32_t word; /* the claim waited for */
    uint32_t rounds;
    double begin; /* clock_seconds */
} claim_wait;

/* To be called between two reads of a slot that is not ready: yields, or sleeps for a fraction of a millisecond.
 * Returns true when the claim may be taken over: its claimer is dead, has stalled for seconds (a stopped process, whose
 * publishing will then fail), or the word is no valid claim. The seconds are waited for once for each claimer, not for
 * each of its claims. */
bool claim_owners_wait(claim_owners *owners, claim_wait *wait, uint32_t word);

#endif
