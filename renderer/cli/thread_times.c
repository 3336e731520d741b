/* thread_times.c: see thread_times.h. */
#define _GNU_SOURCE
#include "thread_times.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int thread_times_self(void) { return (int)gettid(); }

/* Parses a thread's line: its number, its name in brackets, which may hold any character, and then 50 numbers, of which
 * the 12th and 13th are ticks in user and kernel mode. */
static int read_task(int self, const char *task, thread_time *out)
{
    char path[64], line[1024];
    unsigned long user, kernel;
    snprintf(path, sizeof path, "/proc/self/task/%.20s/stat", task);
    FILE *file = fopen(path, "re");
    if (!file)
        return 0;
    const size_t size = fread(line, 1, sizeof line - 1, file);
    fclose(file);
    line[size] = '\0';
    const char *name = strchr(line, '('), *end = strrchr(line, ')');
    if (!name || !end || sscanf(end + 1, " %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu", &user, &kernel) != 2)
        return 0;
    out->cpu_seconds = (double)(user + kernel) / (double)sysconf(_SC_CLK_TCK);
    if (atoi(task) == self)
        out->number = 0;
    else if (sscanf(name, "(afterglow-%d)", &out->number) != 1)
        return 0;
    return 1;
}

static int by_number(const void *a, const void *b)
{
    const thread_time *first = a, *second = b;
    return (first->number > second->number) - (first->number < second->number);
}

int thread_times_read(int self, thread_time out_times[THREAD_TIMES_MOST])
{
    int count = 0;
    DIR *tasks = opendir("/proc/self/task");
    if (!tasks)
        return 0;
    for (const struct dirent *task; count < THREAD_TIMES_MOST && (task = readdir(tasks));)
        if (task->d_name[0] != '.')
            count += read_task(self, task->d_name, &out_times[count]);
    closedir(tasks);
    qsort(out_times, (size_t)count, sizeof *out_times, by_number);
    return count;
}
