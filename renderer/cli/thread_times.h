/* thread_times.h: how much CPU time each of the renderer's threads has had, as the kernel counts it.
 * Rests on: proc(5), /proc/self/task. Flow: page_state -> [here]. Threads: any. */
#ifndef AFTERGLOW_THREAD_TIMES_H
#define AFTERGLOW_THREAD_TIMES_H

enum { THREAD_TIMES_MOST = 256 };

typedef struct thread_time {
    int number; /* of the worker; 0: the one that the program runs on */
    double cpu_seconds;
} thread_time;

/* Notes that the calling thread is the one that the program runs on. */
int thread_times_self(void);
/* Finds the workers' times, by their numbers, and returns how many there are. self: what thread_times_self
 * gave there. */
int thread_times_read(int self, thread_time out_times[THREAD_TIMES_MOST]);

#endif
