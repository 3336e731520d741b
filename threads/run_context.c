/* run_context.c: see run_context.h.
 * Flow: made by the program's render call, handed to every phase.
 * Threads: run_progress from any; the mutex serialises the callback, and who finds it taken moves on. */
#define _GNU_SOURCE
#include "run_context.h"

#include "clock.h"

static const double PROGRESS_INTERVAL_SECONDS = 0.05;
static const double LOOK_INTERVAL_SECONDS = 0.5;

void run_context_init(run_context *run, thread_pool *pool, log_sink *log, ag_progress_fn *progress, void *progress_user)
{
    run->pool = pool;
    run->log = log;
    run->progress = progress;
    run->progress_user = progress_user;
    pthread_mutex_init(&run->progress_mutex, NULL);
    run->progress_fraction = 0.0;
    run->progress_time = 0.0;
    run->progress_phase = AG_PHASE_COUNT; /* none yet */
    run->inputs = NULL;
    run->watch = NULL;
    store_relaxed_u64(&run->next_look, 0);
    store_relaxed_u32(&run->stop, 0);
}

void run_context_reset(run_context *run) { pthread_mutex_destroy(&run->progress_mutex); }

/* --- what is watched --- */

static uint64_t clock_ns(double ahead_seconds) { return (uint64_t)(1e9 * (clock_seconds() + ahead_seconds)); }

void run_begin_watch(run_context *run, run_watch_fn *watch, const void *watched)
{
    run->watch = watch;
    run->watched = watched;
    store_relaxed_u64(&run->next_look, clock_ns(LOOK_INTERVAL_SECONDS));
}

void run_look(run_context *run)
{
    if (!run->watch)
        return;
    uint64_t due = load_relaxed_u64(&run->next_look);
    bool is_turn = clock_ns(0.0) >= due && cas_relaxed_u64(&run->next_look, &due, clock_ns(LOOK_INTERVAL_SECONDS));
    if (!run->watch(run->watched, is_turn))
        run_break_off(run);
}

/* --- progress --- */

/* Under the mutex. */
static void tell(run_context *run, ag_phase phase, double fraction, double now)
{
    run->progress_phase = phase;
    run->progress_fraction = fraction;
    run->progress_time = now;
    run->progress(run->progress_user, phase, fraction);
}

void run_progress(run_context *run, ag_phase phase, double fraction)
{
    if (!run->progress)
        return;
    fraction = fraction > 0.0 ? (fraction < 1.0 ? fraction : 1.0) : 0.0; /* not-a-number becomes 0 */
    bool must_tell = fraction == 0.0 || fraction == 1.0;
    if (must_tell)
        pthread_mutex_lock(&run->progress_mutex);
    else if (pthread_mutex_trylock(&run->progress_mutex) != 0)
        return; /* another worker is telling something as new as this */

    double now = clock_seconds();
    if (phase != run->progress_phase)
        tell(run, phase, 0.0, now);
    /* Workers arrive out of order, and a fraction below the last one has been told already. */
    if (fraction > run->progress_fraction && (must_tell || now - run->progress_time >= PROGRESS_INTERVAL_SECONDS))
        tell(run, phase, fraction, now);
    pthread_mutex_unlock(&run->progress_mutex);
}
