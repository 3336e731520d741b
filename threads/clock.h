/* clock.h: monotonic time, CPU time and peak memory of the process. Threads: any. */
#ifndef AFTERGLOW_CLOCK_H
#define AFTERGLOW_CLOCK_H

#include <stdint.h>

double clock_seconds(void);             /* monotonic, from an arbitrary start */
double clock_process_cpu_seconds(void); /* user + system, all threads of the process */
double clock_thread_cpu_seconds(void);  /* the calling thread's alone */
uint64_t peak_memory_bytes(void);       /* peak resident set of the process; 0 if unknown */

#endif
