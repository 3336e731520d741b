/* irradiance_slot.pml: the protocol of the photons' irradiance slots, for spin to look at every interleaving.
 * Models photonmap/irradiance_slot.h (one word: EMPTY, CLAIMED, READY), irradiance_cache.c (get, retry) and the loop of
 * renderer/integrator/final_gather.c: ask for all, set aside what another thread is computing, come back, then sum.
 * Run by test_irradiance_slot_model.sh. The BROKEN_... variants must be caught; they show that the properties can fail.
 *
 * A step of a thread holds one access to the slots, as the C code's atomics do. What is computed carries its computer's
 * number: in the program all would compute the same bits, here a second result would be seen to differ. */

#define THREADS  3
#define SLOTS    2
#define REQUESTS 2
#define NONE     255

/* A slot's word: 0, CLAIMED + thread, READY + thread (the thread stands for the value). */
#define EMPTY    0
#define CLAIMED  10
#define READY    20
#define is_claimed(word) (word >= CLAIMED && word < READY)
#define is_ready(word)   (word >= READY)

byte slot[SLOTS];         /* zeroed memory is an empty cache */
byte ended = 0;           /* threads that have summed */

/* What only the model sees. */
byte computing[SLOTS];    /* threads at work on a slot's estimate */
byte computed[SLOTS];     /* estimates finished */
byte first_read[SLOTS];   /* the value that was seen first */

/* A request is answered: with the value that everybody else has read, and will read. */
inline answer(index, word)
{
    assert(is_ready(word));
    if
    :: first_read[index] == 0 -> first_read[index] = word
    :: else -> assert(first_read[index] == word)
    fi;
    answered++
}

/* irradiance_slot_try_claim: word is what is there afterwards. */
inline try_claim(index, word)
{
#ifdef BROKEN_CLAIM
    word = slot[index]; /* read, and then write: another thread may come between */
    if
    :: word == EMPTY -> atomic { word = CLAIMED + _pid; slot[index] = word }
    :: else -> skip
    fi
#else
    atomic {
        if
        :: slot[index] == EMPTY -> slot[index] = CLAIMED + _pid
        :: else -> skip
        fi;
        word = slot[index]
    }
#endif
}

/* compute(): the claim is held from try_claim to publish. */
inline compute(index, word)
{
    atomic {
        computing[index]++;
        assert(computing[index] == 1 && computed[index] == 0)
    };
#ifdef BROKEN_NESTING
    do /* wants another slot's value while it holds this one */
    :: is_ready(slot[1 - index]) || slot[1 - index] == EMPTY -> break
    :: else -> skip
    od;
#endif
    atomic {
        computing[index]--;
        computed[index]++;
        word = READY + _pid
#ifndef BROKEN_RELEASE
        ;
        assert(slot[index] == CLAIMED + _pid); /* the publishing compare-and-swap does not fail */
        slot[index] = word
#endif
    }
}

active [THREADS] proctype gather()
{
    byte aside[REQUESTS] = NONE; /* slots that another thread was computing */
    byte i = 0, answered = 0;
    byte index = NONE, word = EMPTY; /* put back where they say nothing any more: fewer states */

    /* irradiance_cache_get, for each gather ray; a ray may meet any photon */
    do
    :: atomic {
            i < REQUESTS;
            if
            :: index = 0
            :: index = 1
            fi;
            word = slot[index]
        };
        if
        :: word == EMPTY ->
            try_claim(index, word);
            if
            :: word == CLAIMED + _pid -> compute(index, word)
            :: else -> skip
            fi
        :: else -> skip
        fi;
        atomic {
            if
            :: is_ready(word) -> answer(index, word)
            :: else -> aside[i] = index
            fi;
            i++;
            index = NONE;
            word = EMPTY
        }
    :: atomic { i == REQUESTS -> i = 0; break }
    od;

    /* irradiance_cache_retry, for those set aside; nothing is claimed here */
    do
    :: atomic { i < REQUESTS && aside[i] == NONE -> i++ }
    :: atomic { i < REQUESTS && aside[i] != NONE -> word = slot[aside[i]] };
        do
        :: atomic { !is_ready(word) -> word = slot[aside[i]] } /* sched_yield: others may run */
        :: atomic { is_ready(word) ->
                answer(aside[i], word);
                aside[i] = NONE;
                word = EMPTY;
                break
            }
        od
    :: atomic { i == REQUESTS -> break }
    od;

    atomic {
        assert(answered == REQUESTS);
        ended++
    }
}

/* Under weak fairness every request ends; no wake-up can be lost. */
ltl every_request_ends { <> (ended == THREADS) }

/* READY is final, whoever looks. */
ltl ready_is_final { [] (is_ready(slot[0]) -> [] is_ready(slot[0])) }
