/* irradiance_slot_threads.pml: the slot's protocol between processes of several threads each, which share a map's file.
 * Models photonmap/irradiance_slot.h (try_claim, take_over, publish), claim_owners.c (wait, renew, is_alive) and
 * irradiance_cache.c (get, await). Processes that begin in dead ones' entries are in irradiance_slot_shared.pml.
 * Run by test_irradiance_slot_model.sh. The BROKEN_... variants must be caught; they show that the properties can fail.
 *
 * All threads of a process write its number into their claims, so a waiting thread cannot tell which of them holds a
 * claim. A process that dies takes all of its threads with it. PATIENCE: a thread waits for a claim of its own process
 * for so many rounds, then gives the process a new number, with which the old claim counts as a dead one's. The holder
 * may still be at work, since any thread may stand still between two steps. LOST: the slot holds a claim of process 0
 * that nobody is at work on, as after the file was overwritten by a copy of itself.
 *
 * There is one slot here. In the program a thread may give its process a new number because of another slot, just before
 * a claim is made with the old one: that claim counts as a dead one's, and its estimate may be made twice. */

#ifndef WORKERS
#define WORKERS   4 /* threads of all processes */
#define PROCESSES 2
#define DEATHS    1 /* of processes, at most */
#endif

#define EMPTY     0
/* A claim: process and generation; READY: the thread that computed it. In the program all would compute the same bits,
 * here a second value would be seen to differ. */
#define CLAIMED   10
#define READY     100
#define claim_of(process, generation) (CLAIMED + 8 * (process) + generation)
#define is_claimed(word)    (word >= CLAIMED && word < READY)
#define is_ready(word)      (word >= READY)
#define process_of(word)    ((word - CLAIMED) / 8)
#define generation_of(word) ((word - CLAIMED) % 8)

byte slot = EMPTY;          /* in the file */
byte generation[PROCESSES]; /* in the file */
byte claim[PROCESSES];      /* in a process's memory: what its threads write into a slot that they claim */
bool lives[PROCESSES];      /* the kernel's lock on the process's entry */

/* What only the model sees. */
bool holds[WORKERS];        /* the thread is at work on the estimate */
byte begun = 0;             /* claims: those of an empty slot, and those taken over */
byte allowed = 1;           /* the first claim, and one for each claim that is orphaned or given up */
byte computed = 0;          /* estimates finished and published */
byte died = 0, ended = 0;

/* claim_owners_renew, in its two steps: the table in the file, then the process's own memory. */
inline renew(p, word)
{
    atomic {
        if
        :: generation[p] == generation_of(word) -> generation[p]++; allowed++; next = claim_of(p, generation[p])
        :: else -> next = EMPTY
        fi
    };
    if
    :: next != EMPTY -> atomic { claim[p] = next; next = EMPTY }
    :: else -> skip
    fi
}

/* claim_owners_wait: may the claim be taken over? */
inline wait_for(p, word, takes)
{
    if
    :: atomic { claim[p] == word -> /* another thread of this process is at it, or nobody is */
#ifdef BROKEN_OWN
            takes = true
#elif defined(PATIENCE)
            rounds++
#else
            skip
#endif
        }
    :: claim[p] != word ->
        atomic {
            if
            :: generation[process_of(word)] != generation_of(word) -> takes = true
            :: else -> skip
            fi
        };
        if
        :: atomic { !takes -> takes = !lives[process_of(word)] }
        :: takes
        fi
    fi;
#ifdef PATIENCE
    if
    :: rounds > PATIENCE -> renew(p, word); rounds = 0
    :: else -> skip
    fi
#endif
}

proctype worker(byte me; byte p)
{
    byte word = EMPTY, mine = EMPTY, next = EMPTY, rounds = 0;
    bool takes = false;
    {
        word = slot;
        do
        :: is_ready(word) -> break
        :: !is_ready(word) ->
#ifdef BROKEN_NUMBER
            mine = claim[p]; /* before the wait, in which another thread may renew it */
#endif
            if
            :: word == EMPTY -> takes = true
            :: is_claimed(word) -> wait_for(p, word, takes)
            fi;
            if
            :: atomic { !takes -> word = slot; mine = EMPTY }
            :: takes ->
#ifndef BROKEN_NUMBER
                mine = claim[p];
#endif
                atomic { /* try_claim, take_over: one compare-and-swap */
                    takes = false;
                    if
                    :: slot == word ->
                        slot = mine;
                        holds[me] = true;
                        begun++;
                        assert(computed == 0);
                        /* a claim is taken over once for each that was orphaned or given up, whoever waits for it */
                        assert(begun <= allowed)
                    :: else -> mine = EMPTY; word = slot
                    fi
                };
                if
                :: mine == EMPTY -> skip
                :: atomic { /* publish */
                        mine != EMPTY ->
                        holds[me] = false;
                        if
                        :: slot == mine -> slot = READY + me; computed++; mine = EMPTY
                        :: else -> skip
                        fi;
                        word = READY + me; /* what was computed answers this thread's request, whoever publishes */
                        assert(computed <= 1);
#ifndef PATIENCE
                        assert(computed == 1) /* no estimate is made for nothing */
#endif
                    };
                    if
                    :: mine != EMPTY -> renew(p, mine)
                    :: else -> skip
                    fi
                fi
            fi
        od
    } unless { !lives[p] };
    atomic { ended++; word = EMPTY; mine = EMPTY; next = EMPTY; rounds = 0; takes = false }
}

/* Ends processes at any moment; what they hold stays in the file. */
active proctype reaper()
{
    byte p = 0, i = 0;
    do
    :: atomic { died < DEATHS ->
            died++;
            if
            :: p = 0
#if PROCESSES > 1
            :: p = 1
#endif
            fi;
            lives[p] = false;
            i = p;
            do
            :: i < WORKERS ->
                if
                :: holds[i] -> holds[i] = false; allowed++
                :: else -> skip
                fi;
                i = i + PROCESSES
            :: else -> break
            od;
            p = 0;
            i = 0
        }
    :: break
    od
}

init
{
    byte i = 0;
    atomic {
        do
        :: i < PROCESSES -> lives[i] = true; generation[i] = 1; claim[i] = claim_of(i, 1); i++
        :: else -> break
        od;
#ifdef LOST
        slot = claim_of(0, 1);
        begun = 1;
#endif
        i = 0;
        do
        :: i < WORKERS -> run worker(i, i % PROCESSES); i++
        :: else -> break
        od
    }
}

/* Under weak fairness all end, or die with their process. */
ltl all_end { <> (ended == WORKERS) }

/* READY is final, whoever looks. */
ltl ready_is_final { [] (is_ready(slot) -> [] is_ready(slot)) }
