/* cpu_count.h: how many threads this process is entitled to.
 * Rests on sched_getaffinity(2) and the Linux kernel's cgroup documentation (cpu.cfs_quota_us in v1, cpu.max in v2).
 * Threads: any. */
#ifndef AFTERGLOW_CPU_COUNT_H
#define AFTERGLOW_CPU_COUNT_H

/* Returns the number of CPUs in the affinity mask, at most the cgroup's CPU quota rounded up; at least 1. */
unsigned cpu_count_available(void);

/* The cgroup's CPU quota read below another root ("" is the machine's own): `proc_self_cgroup` and `mountinfo` are
 * the texts of /proc/self/cgroup and /proc/self/mountinfo, paths in them are looked up below `root`.
 * Returns the quota in CPUs, 0 where there is none. For tests. */
double cpu_quota_below(const char *root, const char *proc_self_cgroup, const char *mountinfo);

#endif
