/* arithmetic.c: the program afterglow-arithmetic: a fixed amount of pure arithmetic on so many threads, which touches
 * no memory: what the machine itself gives those threads, and so the limit of anything that is to scale. Its work is
 * shared out as the renderer shares out its own. Prints "wall seconds, CPU seconds" as CSV. Flow: thread_scaling.sh ->
 * [here]. Threads: its own pool. */
#include "clock.h"
#include "parallel_for.h"

#include <stdio.h>
#include <stdlib.h>

/* A block is some hundred microseconds, as a small tile is. */
enum { STEPS_PER_BLOCK = 100000, BLOCKS_PER_UNIT = 64 };

static void multiply(void *user, uint64_t begin, uint64_t end, uint64_t block, unsigned worker)
{
    (void)worker;
    uint64_t *sums = user;
    double x = 1.0 + (double)block * 1e-6, y = 0.5;
    for (uint64_t i = begin; i < end; i++)
        for (int k = 0; k < STEPS_PER_BLOCK; k++) {
            x = x * 0.999999 + 0.25;
            y = y * 0.999998 + x;
        }
    sums[block] = (uint64_t)(x + y); /* once a block: so that the work is not optimised away */
}

int main(int argc, char **argv)
{
    char *end = NULL;
    unsigned long threads = argc > 1 ? strtoul(argv[1], &end, 10) : 0;
    bool is_good = argc >= 2 && argc <= 3 && *end == '\0' && threads >= 1 && threads <= 4096;
    unsigned long units = argc > 2 ? strtoul(argv[2], &end, 10) : 16;
    if (!is_good || *end != '\0' || units < 1 || units > 100000) {
        fputs("usage: afterglow-arithmetic THREADS [UNITS]\n"
              "Does UNITS (16) of arithmetic on THREADS threads; prints wall and CPU seconds.\n",
              stderr);
        return 2;
    }
    uint64_t count = units * BLOCKS_PER_UNIT, *sums = calloc(count, sizeof *sums);
    thread_pool *pool = NULL;
    ag_status status = sums ? thread_pool_create((unsigned)threads, &pool) : AG_ERROR_MEMORY;
    if (status == AG_OK) {
        run_context run;
        run_context_init(&run, pool, NULL, NULL, NULL);
        double begin = clock_seconds(), cpu_begin = clock_process_cpu_seconds();
        status = parallel_for(&run, count, 1, multiply, sums, AG_PHASE_RENDER, 0.0, 0.0);
        double seconds = clock_seconds() - begin, cpu_seconds = clock_process_cpu_seconds() - cpu_begin;
        if (status == AG_OK)
            printf("%.6f,%.6f\n", seconds, cpu_seconds);
        run_context_reset(&run);
    }
    thread_pool_destroy(pool);
    free(sums);
    if (status != AG_OK)
        fprintf(stderr, "afterglow-arithmetic: error: %s\n", ag_status_text(status));
    return status == AG_OK ? 0 : 1;
}
