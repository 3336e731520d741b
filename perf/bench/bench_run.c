/* bench_run.c: see bench_run.h. */
#include "bench/bench_run.h"

#include "floating_point.h"

#include <stdio.h>
#include <stdlib.h>

/* The state of a run while it is measured. */
typedef struct measuring {
    bench_run *run;
    const bench_work *work;
    ag_context *loader; /* of the scenes: pinned nowhere, so that neither are threads of the libraries' */
    ag_context *contexts[BENCH_LEVELS_MAX];
    bench_stage stages[BENCH_SCENE_COUNT];
    bench_counters counters;
    void (*progress)(const char *what);
} measuring;

static void tell(const measuring *m, const char *what)
{
    if (m->progress)
        m->progress(what);
}

static void see_clock(bench_run *run)
{
    double mhz = bench_machine_clock_mhz(&run->machine);
    if (mhz > 0.0 && (run->clock_least_mhz <= 0.0 || mhz < run->clock_least_mhz))
        run->clock_least_mhz = mhz;
    if (mhz > run->clock_most_mhz)
        run->clock_most_mhz = mhz;
}

/* --- levels --- */

bench_level bench_level_describe(const bench_machine *machine, unsigned threads)
{
    bench_level l = {.threads = threads,
                     .is_oversubscribed = threads > machine->entitled,
                     .has_all_phases = threads == 1 || threads == machine->core_count ||
                                       threads == machine->cpu_count || threads >= machine->entitled};
    bench_machine_span(machine, threads, &l.cores, &l.numa_nodes);
    return l;
}

static ag_status create_context(unsigned threads, ag_log_fn *log, ag_context **out_context)
{
    ag_context_settings settings = ag_default_context_settings();
    settings.thread_count = threads;
    settings.log = log;
    return ag_context_create(&settings, out_context);
}

static ag_status load_stages(measuring *m, ag_log_fn *log)
{
    ag_status status = create_context(m->run->machine.entitled, log, &m->loader);
    if (status != AG_OK)
        return status;
    for (int i = 0; i < BENCH_SCENE_COUNT && status == AG_OK; i++)
        status = bench_stage_create((bench_scene)i, m->work, m->loader, &m->stages[i]);
    snprintf(m->run->isa, sizeof m->run->isa, "%s", m->loader->isa);
    return status;
}

static ag_status create_contexts(measuring *m, ag_log_fn *log)
{
    ag_status status = AG_OK;
    for (unsigned i = 0; i < m->run->level_count && status == AG_OK; i++)
        status = create_context(m->run->levels[i].threads, log, &m->contexts[i]);
    return status;
}

/* --- measuring --- */

static ag_status measure_streams(measuring *m, unsigned level, unsigned turn)
{
    const bench_work *work = m->work;
    bench_level *l = &m->run->levels[level];
    run_context *run = &m->contexts[level]->run;
    stream_turn t, sum = {0}, memory = {0};
    ag_status status;
    do {
        status = stream_arithmetic(run, work->arithmetic_units * l->threads, &t);
        sum = (stream_turn){sum.seconds + t.seconds, sum.cpu_s + t.cpu_s, sum.amount + t.amount};
    } while (status == AG_OK && sum.seconds < work->turn_s);
    while (status == AG_OK && (memory.amount <= 0.0 || memory.seconds < work->turn_s)) {
        status =
            stream_memory(run, work->stream_bytes + work->stream_thread_bytes * l->threads, work->stream_passes, &t);
        memory = (stream_turn){memory.seconds + t.seconds, memory.cpu_s + t.cpu_s, memory.amount + t.amount};
    }
    if (status != AG_OK)
        return status;
    double share = sum.cpu_s / (sum.seconds * l->threads);
    l->arithmetic[turn] = sum.amount / sum.seconds;
    l->memory[turn] = memory.amount / memory.seconds;
    l->arithmetic_share += share / m->run->turns;
    return AG_OK;
}

static void add_unit(bench_part *part, const bench_outcome *o)
{
    if (part->units == 0) {
        part->hash = o->hash;
        part->count = o->count;
        part->expected = o->expected;
        part->is_steady = part->is_sound = true;
    }
    part->is_steady = part->is_steady && hash128_is_equal(part->hash, o->hash) && part->count == o->count;
    part->is_sound = part->is_sound && o->is_sound;
    if (o->count != o->expected) {
        part->count = o->count;
        part->expected = o->expected;
    }
    part->units++;
    part->items += o->amount;
    part->seconds += o->seconds;
    part->cpu_s += o->cpu_s;
    part->duplicated += o->duplicated;
    part->requests += o->requests;
    part->computed += o->computed;
    part->deferred += o->deferred;
    part->waited += o->waited;
    part->waited_s += o->waited_s;
}

static ag_status measure_part(measuring *m, bench_scene where, bench_phase phase, unsigned level, unsigned turn)
{
    bench_part *part = &m->run->parts[where][phase][level];
    double seconds = part->seconds;
    uint64_t items = part->items;
    ag_status status;
    bench_counts before = bench_counters_read(&m->counters);
    do {
        bench_outcome o;
        status = bench_phase_run(&m->stages[where], m->contexts[level], phase, &o);
        if (status == AG_OK)
            add_unit(part, &o);
    } while (status == AG_OK && part->seconds - seconds < m->work->turn_s);
    bench_counts after = bench_counters_read(&m->counters);
    part->is_measured = status == AG_OK;
    part->counts.is_known = after.is_known && (turn == 0 || part->counts.is_known);
    part->counts.cycles += after.cycles - before.cycles;
    part->counts.instructions += after.instructions - before.instructions;
    if (part->seconds > seconds)
        part->rate[turn] = (double)(part->items - items) / (part->seconds - seconds);
    return status;
}

static ag_status measure_turn(measuring *m, unsigned turn)
{
    ag_status status = AG_OK;
    for (unsigned level = 0; level < m->run->level_count && status == AG_OK; level++) {
        bench_level *l = &m->run->levels[level];
        char what[96];
        /* each time: the caller is a worker of all levels, and some may leave it unpinned */
        l->is_pinned = bench_machine_pin(&m->run->machine, m->contexts[level]->pool) && !l->is_oversubscribed;
        snprintf(what, sizeof what, "turn %u of %u, %u thread%s", turn + 1, m->run->turns, l->threads,
                 l->threads == 1 ? "" : "s");
        tell(m, what);
        status = measure_streams(m, level, turn);
        for (int where = 0; where < BENCH_SCENE_COUNT && status == AG_OK; where++)
            for (int phase = 0; phase < BENCH_PHASE_COUNT && status == AG_OK; phase++)
                if (l->has_all_phases || phase == BENCH_PHASE_FRAME)
                    status = measure_part(m, (bench_scene)where, (bench_phase)phase, level, turn);
        see_clock(m->run);
    }
    return status;
}

static ag_status measure(measuring *m, ag_log_fn *log)
{
    bench_run *run = m->run;
    tell(m, "scenes");
    ag_status status = load_stages(m, log);
    if (status == AG_OK)
        status = create_contexts(m, log);
    bench_load_reading begin = bench_load_read(&run->machine);
    for (unsigned turn = 0; turn < run->turns && status == AG_OK; turn++)
        status = measure_turn(m, turn);
    bench_load_reading end = bench_load_read(&run->machine);
    run->load = bench_load_between(&begin, &end, run->machine.cpu_count);
    return status;
}

ag_status bench_run_measure(bench_machine *machine, bench_size size, const unsigned *levels, unsigned level_count,
                            ag_log_fn *log, void (*progress)(const char *what), bench_run *out_run)
{
    static measuring m;
    *out_run = (bench_run){.machine = *machine, .size = size, .level_count = level_count};
    *machine = (bench_machine){0};
    m = (measuring){.run = out_run, .work = bench_work_of(size), .progress = progress};
    out_run->turns = m.work->turns;
    for (unsigned i = 0; i < level_count; i++)
        out_run->levels[i] = bench_level_describe(&out_run->machine, levels[i]);
    double begin = clock_seconds();
    m.counters = bench_counters_open();
    unsigned arithmetic = floating_point_enter();
    ag_status status = measure(&m, log);
    floating_point_leave(arithmetic);
    for (unsigned i = 0; i < level_count; i++)
        ag_context_destroy(m.contexts[i]);
    for (int i = 0; i < BENCH_SCENE_COUNT; i++)
        bench_stage_reset(&m.stages[i]);
    ag_context_destroy(m.loader);
    bench_counters_close(&m.counters);
    out_run->seconds = clock_seconds() - begin;
    return status;
}

void bench_run_reset(bench_run *run)
{
    bench_machine_reset(&run->machine);
    *run = (bench_run){0};
}
