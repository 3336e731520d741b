/* large_stack.h: the program runs on a stack that is large enough, whatever `ulimit -s` says: a small one would end it
 * by a segmentation fault without a word.
 * Threads: called by main, before all else. */
#ifndef AFTERGLOW_LARGE_STACK_H
#define AFTERGLOW_LARGE_STACK_H

typedef int large_stack_fn(int argc, char **argv);

/* Calls fn, in a thread of its own where the limit on the stack is low; that thread's memory does not count
 * against the limit. Threads that libraries start then have large stacks, too. Where no thread can be had,
 * says so and returns 3. */
int large_stack_call(large_stack_fn *fn, int argc, char **argv);

#endif
