/* cpu_count.c: see cpu_count.h. Container engines and batch systems limit a job by affinity, by quota, or by both.
 * Rests on: sched_getaffinity(2), cgroups(7), proc(5) on mountinfo; Linux Documentation/admin-guide/cgroup-v1/ and -v2.
 * Flow: asked once, when a pool is made without a worker count.
 * Threads: any. */
#define _GNU_SOURCE
#include "cpu_count.h"

#include <errno.h>
#include <sched.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A part of a text that somebody else owns. */
typedef struct span {
    const char *begin, *end;
} span;

static span span_of(const char *text) { return (span){text, text + strlen(text)}; }
static size_t span_length(span s) { return (size_t)(s.end - s.begin); }

static bool span_equals(span s, const char *text)
{
    return span_length(s) == strlen(text) && memcmp(s.begin, text, span_length(s)) == 0;
}

/* Returns what stands before the next separator, or all, and removes it from the front of rest. */
static span take_until(span *rest, char separator)
{
    const char *found = rest->begin < rest->end ? memchr(rest->begin, separator, span_length(*rest)) : NULL;
    span head = {rest->begin, found ? found : rest->end};
    rest->begin = found ? found + 1 : rest->end;
    return head;
}

static bool list_contains(span comma_separated, const char *word)
{
    while (comma_separated.begin < comma_separated.end)
        if (span_equals(take_until(&comma_separated, ','), word))
            return true;
    return false;
}

static bool is_octal(char c) { return c >= '0' && c <= '7'; }

/* A path of mountinfo, where space, tab, line end and backslash are written as \ooo. The caller frees it. */
static char *unescaped(span s)
{
    char *result = malloc(span_length(s) + 1), *out = result;
    if (!result)
        return NULL;
    for (const char *p = s.begin; p < s.end; p++) {
        if (*p == '\\' && s.end - p >= 4 && is_octal(p[1]) && is_octal(p[2]) && is_octal(p[3])) {
            *out++ = (char)((p[1] - '0') * 64 + (p[2] - '0') * 8 + (p[3] - '0'));
            p += 3;
        } else {
            *out++ = *p;
        }
    }
    *out = '\0';
    return result;
}

static double tighter(double a, double b) { return a > 0.0 && (b <= 0.0 || a < b) ? a : b; }

/* Reads up to two words of directory/name; returns how many there are, 0 if there is no such file. */
static int read_two_words(const char *directory, const char *name, char first[32], char second[32])
{
    char *path = NULL;
    if (asprintf(&path, "%s/%s", directory, name) < 0)
        return 0;
    FILE *file = fopen(path, "re");
    free(path);
    if (!file)
        return 0;
    int word_count = fscanf(file, "%31s %31s", first, second);
    fclose(file);
    return word_count > 0 ? word_count : 0;
}

/* quota / period, both in microseconds; 0 for "max", -1 and whatever is not a quota. */
static double quota_of_directory(const char *directory, bool is_v2)
{
    char quota[32] = "", period[32] = "", ignored[32];
    if (is_v2) {
        if (read_two_words(directory, "cpu.max", quota, period) != 2)
            return 0.0;
    } else if (read_two_words(directory, "cpu.cfs_quota_us", quota, ignored) < 1 ||
               read_two_words(directory, "cpu.cfs_period_us", period, ignored) < 1) {
        return 0.0;
    }
    long long quota_us = strtoll(quota, NULL, 10), period_us = strtoll(period, NULL, 10);
    return quota_us > 0 && period_us > 0 ? (double)quota_us / (double)period_us : 0.0;
}

/* Returns the tightest quota of the cgroup at mount_point + below and of all that contain it, as far as the mount
 * shows, since each limits all below it. Directories that are not there are passed over, so a path that means nothing
 * inside a container ends at the mount itself, which is the container's own group. */
static double quota_of_hierarchy(const char *root, const char *mount_point, const char *below, bool is_v2)
{
    char *directory = NULL;
    if (asprintf(&directory, "%s%s%s", root, mount_point, below) < 0)
        return 0.0;
    size_t shortest = strlen(root) + strlen(mount_point);
    double quota = 0.0;
    for (;;) {
        quota = tighter(quota_of_directory(directory, is_v2), quota);
        char *slash = strrchr(directory + shortest, '/');
        if (!slash)
            break;
        *slash = '\0';
    }
    free(directory);
    return quota;
}

/* Returns the part of the cgroup's path below the part of the hierarchy that is mounted ("" or "/..."); NULL if the
 * mount shows another part, or if the path leaves a cgroup namespace by "..". */
static const char *path_below_mount(const char *cgroup_path, const char *mounted_part)
{
    size_t length = strcmp(mounted_part, "/") == 0 ? 0 : strlen(mounted_part);
    if (strncmp(cgroup_path, mounted_part, length) != 0)
        return NULL;
    const char *below = cgroup_path + length;
    if ((*below != '/' && *below != '\0') || strstr(below, "/.."))
        return NULL;
    return strcmp(below, "/") == 0 ? "" : below;
}

/* Returns the quota of one cgroup, by its path in the v2 hierarchy or in v1's with the cpu controller. */
static double quota_of_cgroup(const char *root, const char *cgroup_path, bool is_v2, const char *mountinfo)
{
    double quota = 0.0, quota_elsewhere = 0.0;
    bool is_shown = false;
    for (span rest = span_of(mountinfo); rest.begin < rest.end;) {
        /* id parent major:minor ROOT MOUNT-POINT options [optional fields] - TYPE source SUPER-OPTIONS */
        span line = take_until(&rest, '\n');
        for (int i = 0; i < 3; i++)
            take_until(&line, ' ');
        span mounted_part_field = take_until(&line, ' '), mount_point_field = take_until(&line, ' ');
        while (line.begin < line.end && !span_equals(take_until(&line, ' '), "-"))
            continue;
        span type = take_until(&line, ' ');
        take_until(&line, ' ');
        if (!(is_v2 ? span_equals(type, "cgroup2") : span_equals(type, "cgroup") && list_contains(line, "cpu")))
            continue;
        char *mounted_part = unescaped(mounted_part_field), *mount_point = unescaped(mount_point_field);
        if (mounted_part && mount_point) {
            const char *below = path_below_mount(cgroup_path, mounted_part);
            double found = quota_of_hierarchy(root, mount_point, below ? below : "", is_v2);
            if (below) {
                is_shown = true;
                quota = tighter(found, quota);
            } else {
                quota_elsewhere = tighter(found, quota_elsewhere);
            }
        }
        free(mounted_part);
        free(mount_point);
    }
    return is_shown ? quota : quota_elsewhere;
}

double cpu_quota_below(const char *root, const char *proc_self_cgroup, const char *mountinfo)
{
    double quota = 0.0;
    for (span rest = span_of(proc_self_cgroup); rest.begin < rest.end;) {
        /* id:controllers:path; v2's is 0::path, and a machine may have both */
        span line = take_until(&rest, '\n');
        span id = take_until(&line, ':'), controllers = take_until(&line, ':');
        bool is_v2 = span_equals(id, "0") && controllers.begin == controllers.end;
        if (line.begin == line.end || (!is_v2 && !list_contains(controllers, "cpu")))
            continue;
        char *cgroup_path = strndup(line.begin, span_length(line));
        if (cgroup_path)
            quota = tighter(quota_of_cgroup(root, cgroup_path, is_v2, mountinfo), quota);
        free(cgroup_path);
    }
    return quota;
}

/* Returns the number of CPUs that the kernel lets the calling thread run on; 0 if it does not say. */
static unsigned affinity_cpu_count(void)
{
    /* The kernel refuses (EINVAL) a mask shorter than its own, whose length it does not tell. */
    for (int cpu_capacity = 1024; cpu_capacity <= 1024 * 1024; cpu_capacity *= 2) {
        cpu_set_t *set = CPU_ALLOC((size_t)cpu_capacity);
        size_t size_bytes = CPU_ALLOC_SIZE((size_t)cpu_capacity);
        if (!set)
            return 0;
        int result = sched_getaffinity(0, size_bytes, set), error = errno;
        int cpu_count = result == 0 ? CPU_COUNT_S(size_bytes, set) : 0;
        CPU_FREE(set);
        if (result == 0)
            return (unsigned)cpu_count;
        if (error != EINVAL)
            return 0;
    }
    return 0;
}

/* Reads the whole of a file whose size is not known, as in /proc. NULL if it cannot be read; the caller frees it. */
static char *read_whole(const char *path)
{
    FILE *file = fopen(path, "re");
    if (!file)
        return NULL;
    char *text = NULL;
    size_t capacity = 0;
    ssize_t length = getdelim(&text, &capacity, '\0', file); /* there is no zero byte in these */
    fclose(file);
    if (length >= 0)
        return text;
    free(text);
    return NULL;
}

unsigned cpu_count_available(void)
{
    unsigned cpu_count = affinity_cpu_count();
    if (cpu_count == 0)
        cpu_count = 1;
    char *cgroup = read_whole("/proc/self/cgroup"), *mountinfo = read_whole("/proc/self/mountinfo");
    double quota = cgroup && mountinfo ? cpu_quota_below("", cgroup, mountinfo) : 0.0;
    free(cgroup);
    free(mountinfo);
    if (quota > 0.0 && quota < (double)cpu_count) {
        unsigned whole = (unsigned)quota;
        cpu_count = (double)whole < quota ? whole + 1 : whole; /* rounded up; at least 1, as quota > 0 */
    }
    return cpu_count;
}
