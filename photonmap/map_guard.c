/* map_guard.c: see map_guard.h. The handler replaces the whole mapping by empty memory, so that the read that failed
 * succeeds when it is repeated, and later ones do not fail one by one.
 * Threads: any; the handler runs on the thread that touched the memory. */
#define _GNU_SOURCE
#include "map_guard.h"

#include "atomics.h"

#include <pthread.h>
#include <signal.h>
#include <sys/mman.h>

enum { GUARDS_MAX = 64 };
enum { GUARD_FREE, GUARD_TAKEN, GUARD_WATCHES, GUARD_LOST };

typedef struct guard {
    atomic_u32 state; /* the handler acquires GUARD_WATCHES, which is released behind the other two */
    void *memory;
    size_t size_bytes;
} guard;

static guard guards[GUARDS_MAX];
static pthread_mutex_t handler_mutex = PTHREAD_MUTEX_INITIALIZER; /* who installs the handler */
/* The handlers that ours has replaced: the last one, which may call ours in turn, and the first one, which cannot. */
static struct sigaction replaced_last, replaced_first;
static bool is_installed;
static _Thread_local volatile sig_atomic_t is_passed_on; /* the fault is the other handler's */

/* Replaces the guarded memory that an address lies in by empty memory. Returns false where it lies in none. */
static bool replace_lost(const char *at)
{
    for (int i = 0; i < GUARDS_MAX; i++) {
        guard *g = &guards[i];
        uint32_t state = load_acquire_u32(&g->state);
        if (state != GUARD_WATCHES && state != GUARD_LOST)
            continue;
        const char *begin = g->memory;
        if (at < begin || at >= begin + g->size_bytes)
            continue;
        store_release_u32(&g->state, GUARD_LOST);
        if (mmap(g->memory, g->size_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) !=
            MAP_FAILED)
            return true;
    }
    return false;
}

/* Does with a fault elsewhere what would be done if our handler were not there. */
static void pass_on(int number, siginfo_t *info, void *context)
{
    const sig_atomic_t was_passed_on = is_passed_on;
    const struct sigaction *other = was_passed_on ? &replaced_first : &replaced_last;
    if (!(other->sa_flags & SA_SIGINFO) && (other->sa_handler == SIG_DFL || other->sa_handler == SIG_IGN)) {
        signal(number, SIG_DFL);
        raise(number);
        return;
    }
    is_passed_on = 1;
    if (other->sa_flags & SA_SIGINFO)
        other->sa_sigaction(number, info, context);
    else
        other->sa_handler(number);
    is_passed_on = was_passed_on;
}

static void on_bus_error(int number, siginfo_t *info, void *context)
{
    if (!replace_lost(info->si_addr))
        pass_on(number, info, context);
}

/* Installs our handler, also where another one has replaced it since the last mapping was guarded. */
static void install_handler(void)
{
    struct sigaction action = {.sa_sigaction = on_bus_error, .sa_flags = SA_SIGINFO | SA_RESTART}, now;
    sigemptyset(&action.sa_mask);
    pthread_mutex_lock(&handler_mutex);
    if (sigaction(SIGBUS, NULL, &now) == 0 && !(now.sa_flags & SA_SIGINFO && now.sa_sigaction == on_bus_error)) {
        if (!is_installed)
            replaced_first = now;
        is_installed = true;
        replaced_last = now;
        sigaction(SIGBUS, &action, NULL);
    }
    pthread_mutex_unlock(&handler_mutex);
}

int map_guard_add(void *memory, size_t size_bytes)
{
    install_handler();
    for (int i = 0; i < GUARDS_MAX; i++) {
        uint32_t expected = GUARD_FREE;
        if (!cas_acquire_u32(&guards[i].state, &expected, GUARD_TAKEN))
            continue;
        guards[i].memory = memory;
        guards[i].size_bytes = size_bytes;
        store_release_u32(&guards[i].state, GUARD_WATCHES);
        return i;
    }
    return -1;
}

void map_guard_remove(int number)
{
    if (number >= 0)
        store_release_u32(&guards[number].state, GUARD_FREE);
}

bool map_guard_is_lost(int number) { return number >= 0 && load_acquire_u32(&guards[number].state) == GUARD_LOST; }
