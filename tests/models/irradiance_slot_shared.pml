/* irradiance_slot_shared.pml: irradiance_slot.pml's protocol between processes that share a map's file, and die or are
 * stopped at any moment. Models photonmap/irradiance_slot.h (try_claim, take_over, publish), claim_owners.c (entries,
 * generations, the lock that the kernel drops) and irradiance_cache.c (get, await).
 * Run by test_irradiance_slot_model.sh. The BROKEN_... variants must be caught; they show that the properties can fail.
 *
 * Processes of one thread each ask for slots; irradiance_slot_threads.pml has several threads in each. One that dies is
 * gone; another may then begin in its entry, with a new generation: the entry's lock is free. STOPS: one may be stopped
 * instead of dying; others lose patience with it after a while, take its claim over, and later it goes on. Two
 * processes, and one in a dead one's entry, take a second; set FIRST to 3, SLOTS and REQUESTS to 2 for a minute's
 * search. */

#ifndef FIRST
#define FIRST    2 /* processes that begin at once */
#define SLOTS    1
#define REQUESTS 1
#endif
#ifdef STOPS
#define ALL      FIRST
#define DEATHS   0
#else
#define ALL      (FIRST + 1) /* one more, in an entry that is free again */
#define DEATHS   2
#endif
#define ENTRIES   3

#define EMPTY    0
/* A claim: entry and generation; READY: the number of the process that computed it. In the program all would compute
 * the same bits, here a second value would be seen to differ. */
#define CLAIMED  10
#define READY    100
#ifdef BROKEN_GENERATION
#define claim_of(entry, generation) (CLAIMED + 8 * entry)
#else
#define claim_of(entry, generation) (CLAIMED + 8 * entry + generation)
#endif
#define is_claimed(word)    (word >= CLAIMED && word < READY)
#define is_ready(word)      (word >= READY)
#define entry_of(word)      ((word - CLAIMED) / 8)
#define generation_of(word) ((word - CLAIMED) % 8)

byte slot[SLOTS];          /* in the file */
byte generation[ENTRIES];   /* in the file */
bool locked[ENTRIES];       /* the kernel's: true while the process in the entry lives */

/* What only the model sees. */
byte begun = 0, ended = 0, died = 0;
byte holders[SLOTS];       /* living processes at work on a slot's estimate */
byte computed[SLOTS];      /* estimates finished and published */
byte reclaimed[SLOTS];     /* claims taken over */
byte orphaned[SLOTS];          /* claims that the dead have left */
byte wasted[SLOTS];        /* estimates finished for nothing: publish failed */
bool stands[4]; /* processes that have been stopped */
byte stops = 0, impatience = 0;

/* claim_owners_is_alive, in its two steps: the table, then the lock. */
inline ask_alive(word, alive)
{
#ifdef BROKEN_LOCK
    alive = true /* the dead are never found */
#elif defined(BROKEN_GENERATION)
    alive = locked[entry_of(word)]
#else
    atomic {
        if
        :: generation[entry_of(word)] != generation_of(word) -> alive = false
        :: else -> alive = true
        fi
    };
    if
    :: alive -> alive = locked[entry_of(word)]
    :: else -> skip
    fi
#endif
}

/* A stop, or the end, wherever it is called; a dead process leaves all as it is. */
inline may_die(holds, index)
{
#ifdef STOPS
    atomic {
        if
        :: stops < 1 -> stops++; stands[me] = true
        :: true -> skip
        fi
    };
    !stands[me]
#else
    if
    :: atomic { died < DEATHS ->
            died++;
            if
            :: holds -> holders[index]--; orphaned[index]++
            :: else -> skip
            fi;
            locked[entry] = false;
            goto dead
        }
    :: true
    fi
#endif
}

proctype process(byte me)
{
    byte i = 0, index = 0, word = EMPTY, entry = 0, found = EMPTY, mine = EMPTY;
    bool alive, takes;

    /* claim_owners_join: an entry whose lock is free; then its generation */
    atomic {
        if
        :: !locked[0] -> entry = 0
        :: locked[0] && !locked[1] -> entry = 1
        :: locked[0] && locked[1] && !locked[2] -> entry = 2
        fi;
        locked[entry] = true
    };
    atomic { generation[entry]++; mine = claim_of(entry, generation[entry]) };

    do
    :: i == REQUESTS -> break
    :: i < REQUESTS ->
        atomic {
            if
            :: index = 0
#if SLOTS > 1
            :: index = 1
#endif
            fi;
            word = slot[index]
        };
        /* irradiance_cache_get, then await */
        do
        :: is_ready(word) -> break
        :: !is_ready(word) ->
            takes = false;
            if
            :: word == EMPTY -> takes = true
            :: is_claimed(word) ->
                ask_alive(word, alive);
                if
                :: !alive -> takes = true
#ifdef STOPS
                :: atomic { /* patience may end as long as one stands, if it does not go on before */
                        alive && word != mine && impatience < 3 && (stands[0] || stands[1] || stands[2]) ->
                        impatience++;
                        takes = true
                    }
                :: alive
#endif
                :: else -> skip
                fi
            fi;
            if
            :: !takes -> atomic { word = slot[index] } /* it sleeps, and looks again */
            :: takes ->
                atomic { /* try_claim, take_over: one compare-and-swap */
                    found = slot[index];
                    if
                    :: found == word ->
                        slot[index] = mine;
                        holders[index]++;
                        if
                        :: word != EMPTY -> reclaimed[index]++
                        :: else -> skip
                        fi
#ifdef BROKEN_TAKE_OVER
                    :: found != word && word != EMPTY -> slot[index] = mine; found = word; holders[index]++ /* without comparing */
                    :: found != word && word == EMPTY -> skip
#else
                    :: else -> skip
#endif
                    fi
                };
                if
                :: found != word -> atomic { word = found; found = EMPTY }
                :: else ->
                    atomic {
#ifndef STOPS
                        /* nobody computes what another living process is computing, or what is there already */
                        assert(holders[index] == 1 && computed[index] == 0);
                        /* a claim is taken over once for each that was left */
                        assert(reclaimed[index] <= orphaned[index]);
#endif
                        found = EMPTY
                    };
                    may_die(true, index);
                    atomic { /* publish */
                        holders[index]--;
                        if
#ifdef BROKEN_PUBLISH
                        :: true -> assert(!is_ready(slot[index])); slot[index] = READY + me; computed[index]++
#else
                        :: slot[index] == mine -> slot[index] = READY + me; computed[index]++
                        :: else -> wasted[index]++
#endif
                        fi;
                        word = slot[index];
#ifndef STOPS
                        assert(wasted[index] == 0);
#endif
                        /* an estimate is made for nothing only by one that was thought dead */
                        assert(wasted[index] <= reclaimed[index]);
                        assert(computed[index] <= 1)
                    }
                fi
            fi
        od;
        may_die(false, index);
        atomic { i++; index = 0; word = EMPTY }
    od;
    locked[entry] = false; /* the file is closed */
dead:
    atomic { ended++; mine = EMPTY; entry = 0; i = 0; index = 0; word = EMPTY }
}

#ifdef STOPS
/* Whoever was stopped goes on some time. */
active proctype shell()
{
    do
    :: atomic { stands[0] -> stands[0] = false }
    :: atomic { stands[1] -> stands[1] = false }
    :: atomic { stands[2] -> stands[2] = false }
    :: ended == ALL -> break
    od
}
#endif

init
{
    atomic {
        run process(0);
        run process(1)
#if FIRST > 2
        ;
        run process(2)
#endif
    };
#ifndef STOPS
    atomic { died + ended > 0 -> run process(FIRST) } /* an entry is free again */
#endif
}

/* Under weak fairness all end: nobody waits for ever for a claim that a dead process has left. */
ltl all_end { <> (ended == ALL) }

/* READY is final, whoever looks. */
ltl ready_is_final { [] (is_ready(slot[0]) -> [] is_ready(slot[0])) }
