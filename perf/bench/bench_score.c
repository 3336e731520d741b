/* bench_score.c: see bench_score.h. */
#include "bench/bench_score.h"

#include <math.h>

/* Items a second, about, of one thread of the reference machine: an AMD EPYC (Zen 4, 2.6 GHz; gcc 12, Embree 3.13.5,
 * AVX2), by CPU time. They are fixed: another machine, or a faster renderer, has other scores, not other references. */
static const double REFERENCE[BENCH_SIZE_COUNT][BENCH_SCENE_COUNT][BENCH_PHASE_COUNT] = {
    [BENCH_QUICK] = {{1, 1, 1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1, 1, 1}, {1, 1, 1, 1, 1, 1, 1, 1}},
    [BENCH_SMALL] = {{27e5, 52e5, 24e4, 63e5, 48e5, 90e4, 18e6, 1.65},
                     {18e5, 49e5, 31e4, 21e5, 69e5, 100e4, 17e6, 1.3},
                     {46e4, 50e5, 42e4, 68e5, 53e5, 96e4, 18e6, 1.13}},
    [BENCH_LARGE] = {{27e5, 42e5, 18e4, 32e5, 43e5, 86e4, 16e6, 0.174},
                     {20e5, 41e5, 37e4, 13e5, 69e5, 86e4, 16e6, 0.18},
                     {48e4, 44e5, 49e4, 32e5, 47e5, 90e4, 17e6, 0.133}},
};

bench_interval bench_interval_of(const double *values, unsigned count)
{
    double sorted[BENCH_TURNS_MAX] = {0};
    for (unsigned i = 0; i < count; i++) {
        unsigned at = i;
        for (; at > 0 && sorted[at - 1] > values[i]; at--)
            sorted[at] = sorted[at - 1];
        sorted[at] = values[i];
    }
    return (bench_interval){0.5 * (sorted[count / 2] + sorted[(count - 1) / 2]), sorted[0], sorted[count - 1]};
}

double bench_spread(bench_interval interval)
{
    return interval.median > 0.0 ? (interval.most - interval.least) / interval.median : 0.0;
}

bench_interval bench_score(const bench_run *run, bench_phase phase, unsigned level)
{
    double scores[BENCH_TURNS_MAX];
    for (unsigned turn = 0; turn < run->turns; turn++) {
        double sum = 0.0;
        for (int where = 0; where < BENCH_SCENE_COUNT; where++)
            sum += log(run->parts[where][phase][level].rate[turn] / REFERENCE[run->size][where][phase]);
        scores[turn] = 100.0 * exp(sum / BENCH_SCENE_COUNT);
    }
    return bench_interval_of(scores, run->turns);
}

bench_scaling bench_scaling_of(const bench_run *run, bench_scene where, bench_phase phase, unsigned level)
{
    double speedup[BENCH_TURNS_MAX], of_arithmetic[BENCH_TURNS_MAX], of_memory[BENCH_TURNS_MAX];
    const bench_part *one = &run->parts[where][phase][0], *part = &run->parts[where][phase][level];
    const bench_level *first = &run->levels[0], *l = &run->levels[level];
    for (unsigned turn = 0; turn < run->turns; turn++) {
        speedup[turn] = part->rate[turn] / one->rate[turn];
        of_arithmetic[turn] = speedup[turn] / (l->arithmetic[turn] / first->arithmetic[turn]);
        of_memory[turn] = speedup[turn] / (l->memory[turn] / first->memory[turn]);
    }
    double median = bench_interval_of(speedup, run->turns).median;
    return (bench_scaling){median, median / l->threads, bench_interval_of(of_arithmetic, run->turns).median,
                           bench_interval_of(of_memory, run->turns).median};
}

unsigned bench_best_level(const bench_run *run)
{
    unsigned best = 0;
    for (unsigned level = 1; level < run->level_count; level++)
        if (run->levels[level].has_all_phases && !run->levels[level].is_oversubscribed &&
            bench_score(run, BENCH_PHASE_FRAME, level).median > bench_score(run, BENCH_PHASE_FRAME, best).median)
            best = level;
    return best;
}

double bench_arithmetic_share(const bench_run *run)
{
    double least = 1.0;
    for (unsigned level = 0; level < run->level_count; level++)
        if (!run->levels[level].is_oversubscribed && run->levels[level].arithmetic_share < least)
            least = run->levels[level].arithmetic_share;
    return least;
}
