/* arithmetic.c: the program afterglow-arithmetic: a fixed amount of pure arithmetic on so many threads, which touches
 * no memory: what the machine itself gives those threads, and so the limit of anything that is to scale. Its work is
 * shared out as the renderer shares out its own. Prints "wall seconds, CPU seconds" as CSV. Flow: thread_scaling.sh ->
 * [here]. Threads: its own pool. */
#include "bench/bench_streams.h"

#include <stdio.h>
#include <stdlib.h>

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
    thread_pool *pool = NULL;
    ag_status status = thread_pool_create((unsigned)threads, &pool);
    if (status == AG_OK) {
        run_context run;
        stream_turn turn;
        run_context_init(&run, pool, NULL, NULL, NULL);
        status = stream_arithmetic(&run, units, &turn);
        if (status == AG_OK)
            printf("%.6f,%.6f\n", turn.seconds, turn.cpu_s);
        run_context_reset(&run);
    }
    thread_pool_destroy(pool);
    if (status != AG_OK)
        fprintf(stderr, "afterglow-arithmetic: error: %s\n", ag_status_text(status));
    return status == AG_OK ? 0 : 1;
}
