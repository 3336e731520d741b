/* claim_owners.c: see claim_owners.h. */
#define _GNU_SOURCE /* F_OFD_SETLK */
#include "claim_owners.h"

#include "clock.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <time.h>
#include <unistd.h>

enum { PLACE_BITS = 8, GENERATION_MASK = (1 << 22) - 1 };
_Static_assert(CLAIM_OWNERS_MAX == 1 << PLACE_BITS, "a claim's 30 bits are place and generation");

/* Beyond what any map file holds, for locks need no bytes; other programs that lock whole files stay out of it. */
static const int64_t LOCKS_AT = (int64_t)1 << 60;

/* An estimate takes a millisecond at most; who holds a claim so long has been stopped. */
static const double STANDSTILL_SECONDS = 3.0;
enum { ROUNDS_AWAKE = 64, SLEEP_NANOSECONDS = 200000 };

static struct flock lock_of(uint32_t place)
{
    return (struct flock){
        .l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = (off_t)(LOCKS_AT + (int64_t)place), .l_len = 1};
}

bool claim_owners_join(int file, claim_owner *table, claim_owners *out_owners)
{
    for (uint32_t place = 0; place < CLAIM_OWNERS_MAX; place++) {
        struct flock lock = lock_of(place);
        if (fcntl(file, F_OFD_SETLK, &lock) != 0) {
            if (errno == EAGAIN || errno == EACCES)
                continue; /* somebody lives there */
            return false;
        }
        claim_owner *own = &table[place];
        uint32_t generation = (load_relaxed_u32(&own->generation) + 1) & GENERATION_MASK;
        store_relaxed_u32(&own->process, (uint32_t)getpid());
        /* Ordered by our claims, which release: who acquires a claim of this generation finds it in the table. */
        store_relaxed_u32(&own->generation, generation);
        *out_owners = (claim_owners){table, file, generation << PLACE_BITS | place};
        return true;
    }
    return false;
}

bool claim_owners_is_alive(const claim_owners *owners, uint32_t claimer)
{
    if (claimer == owners->claimer)
        return true;
    uint32_t place = claimer & (CLAIM_OWNERS_MAX - 1);
    if (load_relaxed_u32(&owners->table[place].generation) != claimer >> PLACE_BITS)
        return false; /* another has taken the place since */
    struct flock lock = lock_of(place);
    /* where the kernel does not say, it lives: STANDSTILL_SECONDS then helps */
    return fcntl(owners->file, F_OFD_GETLK, &lock) != 0 || lock.l_type != F_UNLCK;
}

bool claim_owners_wait(const claim_owners *owners, claim_wait *wait, uint32_t word)
{
    if (irradiance_word_state(word) != IRRADIANCE_CLAIMED)
        return true;
    if (wait->word != word)
        *wait = (claim_wait){.word = word, .begin = clock_seconds()};
    uint32_t claimer = word & IRRADIANCE_VALUE_MASK;
    bool is_ours = claimer == owners->claimer;
    if (++wait->rounds < ROUNDS_AWAKE || (is_ours && wait->rounds % ROUNDS_AWAKE != 0)) {
        sched_yield(); /* the claimer may need this processor */
        return false;
    }
    if (!claim_owners_is_alive(owners, claimer) || clock_seconds() - wait->begin > STANDSTILL_SECONDS)
        return true;
    if (is_ours)
        return false;
    const struct timespec nap = {0, SLEEP_NANOSECONDS};
    nanosleep(&nap, NULL);
    return false;
}
