/* claim_owners.c: see claim_owners.h. */
#define _GNU_SOURCE /* F_OFD_SETLK */
#include "claim_owners.h"

#include "clock.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

enum { INDEX_BITS = 8, GENERATION_MASK = (1 << 22) - 1 };
_Static_assert(CLAIM_OWNERS_MAX == 1 << INDEX_BITS, "a claim's 30 bits are index and generation");

/* Beyond what any map file holds, for locks need no bytes; other programs that lock whole files stay out of it. */
static const int64_t LOCKS_AT = (int64_t)1 << 60;

/* An estimate takes a millisecond at most; who holds a claim so long has been stopped. */
static const double STANDSTILL_SECONDS = 3.0;
enum { ROUNDS_AWAKE = 64, SLEEP_NANOSECONDS = 200000 };
/* Of naps in which this process was not stopped, for a claim of its own: some four seconds. */
enum { OWN_ROUNDS_AWAKE = 20000, OWN_NAPS = 15000 };

static struct flock lock_of(uint32_t index)
{
    return (struct flock){
        .l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = (off_t)(LOCKS_AT + (int64_t)index), .l_len = 1};
}

/* Never 0, so that no claim is all zero. */
static uint32_t next_generation(uint32_t generation)
{
    uint32_t next = (generation + 1) & GENERATION_MASK;
    return next > 0 ? next : 1;
}

bool claim_owners_join(int file, claim_owner *table, claim_owners *out_owners)
{
    for (uint32_t index = 0; index < CLAIM_OWNERS_MAX; index++) {
        struct flock lock = lock_of(index);
        if (fcntl(file, F_OFD_SETLK, &lock) != 0) {
            if (errno == EAGAIN || errno == EACCES)
                continue; /* another living process has it */
            return false;
        }
        atomic_u32 *stalled = calloc(CLAIM_OWNERS_MAX, sizeof *stalled);
        if (!stalled)
            return false;
        claim_owner *own = &table[index];
        uint32_t generation = next_generation(load_relaxed_u32(&own->generation));
        store_relaxed_u32(&own->process, (uint32_t)getpid());
        /* Ordered by our claims, which release: who acquires a claim of this generation finds it in the table. */
        store_relaxed_u32(&own->generation, generation);
        *out_owners = (claim_owners){table, file, generation << INDEX_BITS | index, stalled};
        return true;
    }
    return false;
}

void claim_owners_reset(claim_owners *owners)
{
    free(owners->stalled);
    *owners = (claim_owners){.file = -1};
}

void claim_owners_renew(claim_owners *owners, uint32_t claimer)
{
    uint32_t index = claimer & (CLAIM_OWNERS_MAX - 1), before = claimer >> INDEX_BITS, next = next_generation(before);
    /* The table is written first: a reader of a claim with the new number finds it there, since claims release. Where
     * another thread has written it, the number is the same; where the file was overwritten, what is there is void. */
    cas_acquire_release_u32(&owners->table[index].generation, &before, next);
    cas_acquire_release_u32(&owners->claimer, &claimer, next << INDEX_BITS | index);
}

bool claim_owners_is_alive(const claim_owners *owners, uint32_t claimer)
{
    if (claimer == load_relaxed_u32(&owners->claimer))
        return true;
    uint32_t index = claimer & (CLAIM_OWNERS_MAX - 1);
    if (load_relaxed_u32(&owners->table[index].generation) != claimer >> INDEX_BITS)
        return false; /* another has taken the entry since */
    struct flock lock = lock_of(index);
    /* where the kernel does not say, it lives: STANDSTILL_SECONDS then helps */
    return fcntl(owners->file, F_OFD_GETLK, &lock) != 0 || lock.l_type != F_UNLCK;
}

static void take_nap(void)
{
    const struct timespec nap = {0, SLEEP_NANOSECONDS};
    nanosleep(&nap, NULL);
}

/* Another thread of ours goes on as we do. Where the claim stands for seconds nonetheless, no thread has it, since the
 * file was overwritten by a copy that was made while the claim was held; or its thread alone stands still. With a new
 * number of ours it is a dead one's. */
static void wait_for_own(claim_owners *owners, claim_wait *wait, uint32_t word)
{
    if (wait->word != word)
        *wait = (claim_wait){.word = word};
    wait->rounds++;
    if (wait->rounds < OWN_ROUNDS_AWAKE)
        sched_yield();
    else
        take_nap();
    if (wait->rounds > OWN_ROUNDS_AWAKE + OWN_NAPS)
        claim_owners_renew(owners, word & IRRADIANCE_VALUE_MASK);
}

bool claim_owners_wait(claim_owners *owners, claim_wait *wait, uint32_t word)
{
    if (irradiance_word_state(word) != IRRADIANCE_CLAIMED)
        return true;
    uint32_t claimer = word & IRRADIANCE_VALUE_MASK;
    if (claimer == load_relaxed_u32(&owners->claimer)) {
        wait_for_own(owners, wait, word);
        return false;
    }
    atomic_u32 *stalled = &owners->stalled[claimer & (CLAIM_OWNERS_MAX - 1)];
    if (load_relaxed_u32(stalled) == claimer)
        return true;
    if (wait->word != word)
        *wait = (claim_wait){.word = word, .begin = clock_seconds()};
    if (++wait->rounds < ROUNDS_AWAKE) {
        sched_yield(); /* the claimer may need this processor */
        return false;
    }
    if (!claim_owners_is_alive(owners, claimer))
        return true;
    if (clock_seconds() - wait->begin > STANDSTILL_SECONDS) {
        store_relaxed_u32(stalled, claimer);
        return true;
    }
    take_nap();
    return false;
}
